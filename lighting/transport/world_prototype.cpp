// See world_prototype.h.
#include "lighting/transport/world_prototype.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lighting/depth/blocker_field.h"
#include "lighting/depth/spread_points.h"
#include "lighting/transport/cell_contents.h"

namespace sunfleck::transport {

namespace {

constexpr double kFineSides = 2.5;  // leaf sides per fine cell
constexpr int kMostFine = 8;        // fine cells along a crown cell
constexpr std::size_t kMostWood = 256;

FieldElement element_of(const FoliageElement& e) {
  FieldElement element;
  const bool shoot = e.shape == ElementShape::kShoot;
  element.area_m2 = e.area_m2;
  element.axis = shoot ? e.half_u_m : Vec3f(element_normal(e));
  element.shoot_radius_m = shoot ? glm::length(e.half_v_m) : 0.0f;
  return element;
}

// Mean over all directions; wood convex and closed: a quarter of its surface.
double mean_cover_m2(const FieldElement& e) {
  if (!e.is_shoot()) return 0.5 * e.area_m2;
  double sum = 0.0;
  for (const Vec3& w : cubic_directions(14).to_source) sum += projected_area_m2(e, w) / 14.0;
  return sum;
}

struct WoodPiece {
  Vec3 vector;
  double width_m, area_m2;
  std::uint32_t material;
  std::vector<SpreadPoint> points;
};

std::vector<WoodPiece> wood_pieces(const Prototype& prototype, double cell_m) {
  std::vector<WoodPiece> pieces;
  for (const WoodSegment& s : prototype.wood) {
    const double width = s.radius_from_m + s.radius_to_m, length = glm::length(Vec3(s.to_m) - Vec3(s.from_m));
    if (!(width * length > 0.0)) continue;
    pieces.push_back(
        {Vec3(s.to_m) - Vec3(s.from_m), width, kPi / 4 * width * length, s.material,
         spread_cylinder({Vec3(s.from_m), Vec3(s.to_m), s.radius_from_m, s.radius_to_m}, cell_m)});
  }
  for (const WoodTriangle& t : prototype.wood_mesh) {
    const Vec3 a(t.a_m), b(t.b_m), c(t.c_m), normal = 0.25 * glm::cross(b - a, c - a);
    if (!(glm::length(normal) > 0.0)) continue;
    pieces.push_back({normal, 0.0, 0.5 * glm::length(normal), t.material, spread_triangle(a, b, c, cell_m)});
  }
  return pieces;
}

// Depth of every fine cell, plain and as independent parts shade, and the area of every crown cell.
class CrownGrid {
 public:
  CrownGrid(const Box& bounds, double cell_m, double side_m)
      : fine_(std::clamp(static_cast<int>(std::lround(cell_m / (kFineSides * side_m))), 1, kMostFine)),
        cell_m_(cell_m),
        fine_m_(cell_m / fine_),
        lo_m_(bounds.lo) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double size = bounds.size()[static_cast<int>(axis)];
      cells_[axis] = static_cast<int>(std::floor(size / cell_m)) + 1;
    }
    const auto count = static_cast<std::size_t>(cells_[0]) * static_cast<std::size_t>(cells_[1]) *
                       static_cast<std::size_t>(cells_[2]);
    leaf_m2_.resize(count);
    wood_m2_.resize(count);
    const auto per_cell = static_cast<std::size_t>(fine_ * fine_ * fine_);
    plain_.resize(count * per_cell);
    depth_.resize(count * per_cell);
  }

  void add(const Vec3& point_m, double cover_m2, double area_m2, bool wood) {
    const std::array<int, 3> fine = fine_of(point_m);
    const double q = cover_m2 / (fine_m_ * fine_m_);
    const std::size_t at = fine_index(fine);
    plain_[at] += static_cast<float>(q);
    depth_[at] += depth_of_cover(std::min(static_cast<float>(q), kLargestPartCover));
    const std::size_t cell =
        (static_cast<std::size_t>(fine[2] / fine_) * static_cast<std::size_t>(cells_[1]) +
         static_cast<std::size_t>(fine[1] / fine_)) *
            static_cast<std::size_t>(cells_[0]) +
        static_cast<std::size_t>(fine[0] / fine_);
    (wood ? wood_m2_ : leaf_m2_)[cell] += area_m2;
  }

  std::vector<CrownCell> cells(const RunControl& control) const {
    std::vector<CrownCell> cells;
    std::size_t i = 0;
    for (int z = 0; z < cells_[2]; ++z) {
      control.check();
      for (int y = 0; y < cells_[1]; ++y)
        for (int x = 0; x < cells_[0]; ++x, ++i) {
          if (!(leaf_m2_[i] + wood_m2_[i] > 0.0)) continue;
          const double counts = share_that_counts({x, y, z});
          cells.push_back({Vec3f(lo_m_ + (Vec3(x, y, z) + 0.5) * cell_m_),
                           static_cast<float>(counts * leaf_m2_[i]),
                           static_cast<float>(counts * wood_m2_[i])});
        }
    }
    return cells;
  }

 private:
  std::array<int, 3> fine_of(const Vec3& p) const {
    std::array<int, 3> f;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<int>(a);
      f[a] = std::clamp(static_cast<int>(std::floor((p[axis] - lo_m_[axis]) / fine_m_)), 0,
                        cells_[a] * fine_ - 1);
    }
    return f;
  }
  std::size_t fine_index(const std::array<int, 3>& f) const {
    return (static_cast<std::size_t>(f[2]) * static_cast<std::size_t>(cells_[1] * fine_) +
            static_cast<std::size_t>(f[1])) *
               static_cast<std::size_t>(cells_[0] * fine_) +
           static_cast<std::size_t>(f[0]);
  }

  // Over a block twice as wide as the cell around its middle.
  double share_that_counts(const std::array<int, 3>& cell) const {
    const int n = 2 * fine_;
    std::array<std::vector<float>, 3> columns;
    for (auto& c : columns) c.assign(static_cast<std::size_t>(n * n), 0.0f);
    double plain = 0.0;
    for (int z = 0; z < n; ++z)
      for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
          const std::array<int, 3> f{cell[0] * fine_ - fine_ / 2 + x, cell[1] * fine_ - fine_ / 2 + y,
                                     cell[2] * fine_ - fine_ / 2 + z};
          bool inside = true;
          for (std::size_t a = 0; a < 3; ++a) inside &= f[a] >= 0 && f[a] < cells_[a] * fine_;
          if (!inside) continue;
          const std::size_t at = fine_index(f);
          plain += plain_[at];
          columns[0][static_cast<std::size_t>(z * n + y)] += depth_[at];
          columns[1][static_cast<std::size_t>(z * n + x)] += depth_[at];
          columns[2][static_cast<std::size_t>(y * n + x)] += depth_[at];
        }
    if (!(plain > 0.0)) return 1.0;
    double counted = 0.0;
    for (const auto& axis : columns) {
      double lost = 0.0;
      for (const float depth : axis) lost += -std::expm1(-static_cast<double>(depth));
      counted += -std::log1p(-std::min(0.9999, lost / (n * n))) / 3.0;
    }
    return counted / (plain / (n * n));
  }

  int fine_;
  double cell_m_, fine_m_;
  Vec3 lo_m_;
  std::array<int, 3> cells_{};
  std::vector<double> leaf_m2_, wood_m2_;
  std::vector<float> plain_, depth_;
};

std::vector<AngleSample> angle_samples(const Prototype& prototype) {
  std::vector<AngleSample> samples;
  const std::size_t count = prototype.foliage.size(), kept = std::min(count, kMostAngles);
  double area = 0.0;
  for (std::size_t i = 0; i < kept; ++i) {
    // An odd stride through all elements: neighbours in a file grow side by side.
    const FoliageElement& e = prototype.foliage[(2 * i + 1) * count / (2 * kept)];
    const FieldElement f = element_of(e);
    samples.push_back({Vec3(f.axis), f.shoot_radius_m, e.area_m2, e.area_m2, e.material, f.is_shoot()});
    area += e.area_m2;
  }
  for (AngleSample& s : samples) s.share = area > 0.0 ? s.share / area : 1.0 / static_cast<double>(kept);
  return samples;
}

}  // namespace

double prototype_leaf_side(const Prototype& prototype) {
  double area = 0.0, sum = 0.0;
  for (const FoliageElement& e : prototype.foliage) {
    area += e.area_m2;
    sum += e.area_m2 * element_side_m(element_of(e));
  }
  return area > 0.0 ? sum / area : 0.0;
}

WorldPrototype world_prototype(const Prototype& prototype, double cell_m, const RunControl& control) {
  WorldPrototype result;
  result.bounds = prototype_bounds(prototype);
  result.leaf_side_m = prototype_leaf_side(prototype);
  result.crown_width_m = 2.0 * prototype_reach_m(prototype);
  if (result.bounds.empty()) return result;
  CrownGrid grid(result.bounds, cell_m, std::max(result.leaf_side_m, 1e-3 * cell_m));
  std::size_t count = 0;
  for (const FoliageElement& e : prototype.foliage) {
    if (++count % 16384 == 0) control.check();
    grid.add(Vec3(e.centre_m), mean_cover_m2(element_of(e)), e.area_m2, false);
    result.leaf_area_m2 += e.area_m2;
  }
  std::vector<WoodPiece> wood = wood_pieces(prototype, 0.5 * cell_m);
  for (const WoodPiece& piece : wood) {
    result.wood_area_m2 += piece.area_m2;
    for (const SpreadPoint& p : piece.points)
      grid.add(p.point_m, p.share * piece.area_m2, p.share * piece.area_m2, true);
  }
  std::ranges::stable_sort(wood, std::greater<>{}, &WoodPiece::area_m2);
  for (std::size_t i = 0; i < std::min(wood.size(), kMostWood); ++i)
    result.wood.push_back({wood[i].vector, wood[i].width_m, wood[i].area_m2, wood[i].material});
  result.angles = angle_samples(prototype);
  result.cells = grid.cells(control);
  return result;
}

}  // namespace sunfleck::transport
