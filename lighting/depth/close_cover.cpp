// See close_cover.h.
#include "lighting/depth/close_cover.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

constexpr std::size_t kLanes = 8;
constexpr float kShootFaces = 0.25f, kShootProjection = 0.5f, kPiF = static_cast<float>(kPi);

double radius_m(const Prototype& prototype) {
  double area = 0.0, moment = 0.0;
  for (const FoliageElement& e : prototype.foliage) {
    area += e.area_m2;
    moment += e.area_m2 * std::sqrt(e.area_m2);
  }
  return area > 0.0 ? kCloseSides * moment / area : 0.0;
}

// Leaves as the kernel wants them. Of a shoot the normal is 0 and `even` what stands in for cosines.
struct Leaves {
  std::vector<float> x, y, z, nx, ny, nz, area, even;
  explicit Leaves(std::size_t count) {
    for (auto* v : {&x, &y, &z, &nx, &ny, &nz, &area, &even}) v->resize(count + kLanes);
  }
  void set(std::size_t i, const FoliageElement& e) {
    const Vec3 normal = e.shape == ElementShape::kShoot ? Vec3(0) : element_normal(e);
    x[i] = e.centre_m.x, y[i] = e.centre_m.y, z[i] = e.centre_m.z;
    nx[i] = static_cast<float>(normal.x);
    ny[i] = static_cast<float>(normal.y);
    nz[i] = static_cast<float>(normal.z);
    area[i] = static_cast<float>(e.area_m2);
    even[i] = e.shape == ElementShape::kShoot ? kShootProjection : 0.0f;
  }
};

// Sums of shares on the front and on the back, lane by lane.
struct Sums {
  std::array<float, kLanes> front{}, back{};
};

// Adds the leaves [begin, end) to the view of leaf `i`, `count` of them at most.
void add_row(const Leaves& l, std::size_t i, std::size_t begin, std::size_t count, float radius2,
             float weight, Sums& sums) {
  const float both_faces = l.even[i] > 0.0f ? kShootFaces : 0.0f;
  const auto filled = static_cast<int>(std::min(count, kLanes));
  for (int k = 0; k < static_cast<int>(kLanes); ++k) {
    const std::size_t j = begin + static_cast<std::size_t>(k);
    const float dx = l.x[j] - l.x[i], dy = l.y[j] - l.y[i], dz = l.z[j] - l.z[i];
    const float r2 = dx * dx + dy * dy + dz * dz, r = std::sqrt(r2);
    const float ahead = dx * l.nx[i] + dy * l.ny[i] + dz * l.nz[i];
    const float seen = std::fabs(dx * l.nx[j] + dy * l.ny[j] + dz * l.nz[j]) + l.even[j] * r;
    const float counts =
        (r2 < radius2 ? 1.0f : 0.0f) * (r2 > 0.0f ? weight : 0.0f) * (k < filled ? 1.0f : 0.0f);
    const float share = counts * l.area[j] * seen / (r2 * (kPiF * r2 + l.area[j]) + 1e-30f);
    sums.front[static_cast<std::size_t>(k)] += share * (std::max(ahead, 0.0f) + both_faces * r);
    sums.back[static_cast<std::size_t>(k)] += share * (std::max(-ahead, 0.0f) + both_faces * r);
  }
}

float of_both(const Sums& sums) {
  float front = 0.0f, back = 0.0f;
  for (std::size_t k = 0; k < kLanes; ++k) front += sums.front[k], back += sums.back[k];
  return 2.0f - std::exp(-front) - std::exp(-back);
}

// Leaves sorted into cells at least as wide as the radius, x fastest.
class CloseLeaves {
 public:
  CloseLeaves(const Prototype& prototype, double radius_m)
      : radius2_(static_cast<float>(radius_m * radius_m)), leaves_(prototype.foliage.size()) {
    choose_cells(prototype, radius_m);
    sort(prototype);
  }

  // Of the leaf at this place of the order.
  float cover(std::size_t i) const {
    const std::array<int, 3> c = cell_of({leaves_.x[i], leaves_.y[i], leaves_.z[i]});
    Sums sums;
    for (int z = std::max(0, c[2] - 1); z <= std::min(cells_[2] - 1, c[2] + 1); ++z)
      for (int y = std::max(0, c[1] - 1); y <= std::min(cells_[1] - 1, c[1] + 1); ++y)
        add(i, first_[flat(std::max(0, c[0] - 1), y, z)],
            first_[flat(std::min(cells_[0] - 1, c[0] + 1), y, z) + 1], sums);
    return of_both(sums);
  }
  std::size_t element(std::size_t i) const { return order_[i]; }

 private:
  void choose_cells(const Prototype& prototype, double radius_m) {
    Box box;
    for (const FoliageElement& e : prototype.foliage) box.include(Vec3(e.centre_m));
    lo_ = Vec3f(box.lo);
    const Vec3 size = box.size();
    const double few = std::cbrt(size.x * size.y * size.z / static_cast<double>(leaves_.x.size()));
    const double longest = std::max({size.x, size.y, size.z});
    cell_m_ = static_cast<float>(std::max({radius_m, few, longest / 1000.0}) * 1.0001);
    for (int axis = 0; axis < 3; ++axis)
      cells_[static_cast<std::size_t>(axis)] = static_cast<int>(size[axis] / cell_m_) + 1;
  }

  std::array<int, 3> cell_of(const Vec3f& p) const {
    std::array<int, 3> cell{};
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      cell[axis] = std::clamp(static_cast<int>((p[a] - lo_[a]) / cell_m_), 0, cells_[axis] - 1);
    }
    return cell;
  }
  std::size_t flat(int x, int y, int z) const {
    return static_cast<std::size_t>(x) +
           static_cast<std::size_t>(cells_[0]) *
               (static_cast<std::size_t>(y) +
                static_cast<std::size_t>(cells_[1]) * static_cast<std::size_t>(z));
  }

  void sort(const Prototype& prototype) {
    const std::size_t cells = flat(cells_[0] - 1, cells_[1] - 1, cells_[2] - 1) + 1;
    std::vector<std::uint32_t> cell(prototype.foliage.size());
    first_.assign(cells + 1, 0);
    for (std::size_t e = 0; e < cell.size(); ++e) {
      const auto [x, y, z] = cell_of(prototype.foliage[e].centre_m);
      cell[e] = static_cast<std::uint32_t>(flat(x, y, z));
      ++first_[cell[e] + 1];
    }
    for (std::size_t c = 0; c < cells; ++c) first_[c + 1] += first_[c];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    order_.resize(cell.size());
    for (std::size_t e = 0; e < cell.size(); ++e) {
      const std::uint32_t i = next[cell[e]]++;
      order_[i] = static_cast<std::uint32_t>(e);
      leaves_.set(i, prototype.foliage[e]);
    }
  }

  void add(std::size_t i, std::size_t begin, std::size_t end, Sums& sums) const {
    const std::size_t stride = std::max<std::size_t>(1, (end - begin) / kMostInRow);
    for (std::size_t k = begin; k < end; k += stride * kLanes)
      add_row(leaves_, i, k, end - k, radius2_, static_cast<float>(stride), sums);
  }

  float radius2_, cell_m_ = 1;
  Vec3f lo_{0};
  std::array<int, 3> cells_{1, 1, 1};
  Leaves leaves_;
  std::vector<std::uint32_t> first_, order_;
};

}  // namespace

std::vector<float> close_cover(const Prototype& prototype, const RunControl& control) {
  std::vector<float> cover(prototype.foliage.size());
  const double radius = radius_m(prototype);
  if (!(radius > 0.0)) return cover;
  const CloseLeaves leaves(prototype, radius);
  for_each_chunk(cover.size(), 1024, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) cover[leaves.element(i)] = leaves.cover(i);
  });
  return cover;
}

std::vector<float> close_cover(const Forest& forest, const RunControl& control) {
  std::vector<std::vector<float>> of_prototype;
  for (const Prototype& p : forest.prototypes) of_prototype.push_back(close_cover(p, control));
  std::vector<float> cover;
  cover.reserve(ForestIndex(forest).element_count());
  for (const Instance& i : forest.instances) {
    const std::vector<float>& own = of_prototype[i.prototype.value];
    cover.insert(cover.end(), own.begin(), own.end());
  }
  return cover;
}

double close_cover_plain(const Prototype& prototype, std::size_t element) {
  const double radius = radius_m(prototype);
  const FoliageElement& own = prototype.foliage[element];
  double front = 0.0, back = 0.0;
  for (const FoliageElement& e : prototype.foliage) {
    const Vec3 d = Vec3(e.centre_m) - Vec3(own.centre_m);
    const double r = glm::length(d);
    if (!(r > 0.0 && r < radius)) continue;
    const bool of_shoot = own.shape == ElementShape::kShoot, to_shoot = e.shape == ElementShape::kShoot;
    const double seen = to_shoot ? 0.5 : std::abs(glm::dot(d, element_normal(e))) / r;
    const double ahead = of_shoot ? 0.0 : glm::dot(d, element_normal(own)) / r;
    const double share = e.area_m2 * seen / (kPi * r * r + e.area_m2);
    front += share * (of_shoot ? 0.25 : std::max(0.0, ahead));
    back += share * (of_shoot ? 0.25 : std::max(0.0, -ahead));
  }
  return 2.0 - std::exp(-front) - std::exp(-back);
}

}  // namespace sunfleck
