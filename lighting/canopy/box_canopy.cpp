// See box_canopy.h.
#include "lighting/canopy/box_canopy.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "sim/base/error.h"
#include "sim/base/parallel.h"

namespace sunfleck {

namespace {

// A cylinder 2 r wide and L long turned any way shows pi/4 2 r L on average, a leaf half its area.
constexpr double kLeafPerWood = 0.5 * kPi;

struct LumpSums {
  Vec3 moment{0};
  double area_m2 = 0;
};

class Lumps {
 public:
  explicit Lumps(double size_m) : size_m_(size_m) {}
  void add(const Vec3& p, double area_m2) {
    const auto cell = [&](double x) { return static_cast<int>(std::floor(x / size_m_)); };
    LumpSums& sums = cells_[{cell(p.z), cell(p.y), cell(p.x)}];
    sums.moment += area_m2 * p;
    sums.area_m2 += area_m2;
  }
  std::vector<AreaLump> result() const {
    std::vector<AreaLump> out;
    for (const auto& [cell, sums] : cells_)
      if (sums.area_m2 > 0.0)
        out.push_back({Vec3f(sums.moment / sums.area_m2), static_cast<float>(sums.area_m2)});
    return out;
  }

 private:
  double size_m_;
  std::map<std::tuple<int, int, int>, LumpSums> cells_;
};

// Leaves larger than half a lump are spread over their surface.
void add_leaf(const FoliageElement& e, double size_m, Lumps& lumps) {
  const double longest = 2.0 * std::max(glm::length(Vec3(e.half_u_m)), glm::length(Vec3(e.half_v_m)));
  const int n = static_cast<int>(std::clamp(std::ceil(2.0 * longest / size_m), 1.0, 16.0));
  if (n == 1 || e.shape == ElementShape::kTriangle) return lumps.add(Vec3(e.centre_m), e.area_m2);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double u = (2.0 * i + 1.0) / n - 1.0, v = (2.0 * j + 1.0) / n - 1.0;
      lumps.add(Vec3(e.centre_m) + u * Vec3(e.half_u_m) + v * Vec3(e.half_v_m), e.area_m2 / (n * n));
    }
}

void add_wood(const WoodSegment& w, double size_m, Lumps& lumps) {
  const Vec3 from(w.from_m), axis = Vec3(w.to_m) - from;
  const double length = glm::length(axis);
  const int n = static_cast<int>(std::clamp(std::ceil(2.0 * length / size_m), 1.0, 4096.0));
  for (int i = 0; i < n; ++i) {
    const double part = (i + 0.5) / n;
    const double width = 2.0 * (w.radius_from_m + part * (w.radius_to_m - w.radius_from_m));
    lumps.add(from + part * axis, kLeafPerWood * width * length / n);
  }
}

double height_over_ground(const Forest& forest, const Vec3& p) {
  return p.z - forest.terrain.height_at(p.x, p.y);
}

class CanopyBuilder {
 public:
  CanopyBuilder(const Forest& forest, double voxel_m, const RunControl& control)
      : forest_(forest), control_(control) {
    canopy_.voxel_m = voxel_m;
    lumps_.resize(forest.prototypes.size());
    for_each_chunk(lumps_.size(), 1, control, "thinning prototypes", [&](std::size_t p, std::size_t) {
      lumps_[p] = area_lumps(forest.prototypes[p], 0.5 * voxel_m);
    });
  }

  BoxCanopy build() {
    lay_out();
    std::vector<std::vector<CanopyEntry>> of_tree(forest_.instances.size());
    for_each_chunk(of_tree.size(), 64, control_, "boxes", [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) of_tree[t] = entries_of(forest_.instances[t]);
    });
    sort_trees();
    canopy_.first_entry.push_back(0);
    for (const std::uint32_t t : canopy_.order) {
      auto& entries = of_tree[t];
      canopy_.entries.insert(canopy_.entries.end(), entries.begin(), entries.end());
      canopy_.first_entry.push_back(canopy_.entries.size());
      std::vector<CanopyEntry>().swap(entries);
    }
    return std::move(canopy_);
  }

 private:
  // A tile's boxes, 16 by 16 columns, are about as many as a core's second cache holds.
  void sort_trees() {
    constexpr double kTileBoxes = 16;
    const auto tile = [&](std::uint32_t t) {
      const Vec2 at = (Vec2(forest_.instances[t].position_m) - canopy_.lo_m) / (kTileBoxes * canopy_.edge_m);
      return std::pair(std::floor(at.y), std::floor(at.x));
    };
    for (std::uint32_t t = 0; t < forest_.instances.size(); ++t) canopy_.order.push_back(t);
    std::stable_sort(canopy_.order.begin(), canopy_.order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return tile(a) < tile(b); });
  }

  void lay_out() {
    const Box box = forest_bounds(forest_);
    if (forest_.instances.empty() || box.empty())
      throw_invalid("forest", "has no trees", "at least one tree with leaves");
    Vec2 lo(box.lo), size(box.size());
    if (forest_.period) {
      lo = forest_.period->origin_m;
      size = forest_.period->size_m;
    }
    double top_m = 0.0;
    for (const Instance& tree : forest_.instances)
      for (const AreaLump& lump : lumps_[tree.prototype.value])
        top_m = std::max(top_m, height_over_ground(forest_, world_from_tree(tree, Vec3(lump.centre_m))));
    const double v = canopy_.voxel_m;
    const Vec2 cells = glm::max(forest_.period ? glm::round(size / v) : glm::ceil(size / v), Vec2(1.0));
    const double nz = std::floor(top_m / v) + 1.0;
    if (cells.x * cells.y * nz > 4e8)
      throw Error(ErrorKind::kLimitExceeded, "large_stand.voxel_m", "gives more than 400 million boxes",
                  std::to_string(v * std::cbrt(cells.x * cells.y * nz / 4e8)) + " m or more");
    canopy_.lo_m = lo;
    canopy_.nx = static_cast<std::uint32_t>(cells.x);
    canopy_.ny = static_cast<std::uint32_t>(cells.y);
    canopy_.nz = static_cast<std::uint32_t>(nz);
    canopy_.edge_m = forest_.period ? size / cells : Vec2(v);
    canopy_.height_m = v;
    canopy_.periodic = forest_.period.has_value();
    canopy_.ground_normal = forest_.terrain.normal();
  }

  std::uint32_t along(double cells, std::uint32_t n) const {
    if (canopy_.periodic) cells -= n * std::floor(cells / n);
    return static_cast<std::uint32_t>(std::clamp(std::floor(cells), 0.0, n - 1.0));
  }

  std::vector<CanopyEntry> entries_of(const Instance& tree) const {
    std::vector<CanopyEntry> all;
    const float scale2 = tree.scale * tree.scale;
    for (const AreaLump& lump : lumps_[tree.prototype.value]) {
      const Vec3 p = world_from_tree(tree, Vec3(lump.centre_m));
      const std::uint32_t x = along((p.x - canopy_.lo_m.x) / canopy_.edge_m.x, canopy_.nx);
      const std::uint32_t y = along((p.y - canopy_.lo_m.y) / canopy_.edge_m.y, canopy_.ny);
      const auto z = static_cast<std::uint32_t>(
          std::clamp(std::floor(height_over_ground(forest_, p) / canopy_.height_m), 0.0, canopy_.nz - 1.0));
      all.push_back({(z * canopy_.ny + y) * canopy_.nx + x, scale2 * lump.area_m2});
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const CanopyEntry& a, const CanopyEntry& b) { return a.voxel < b.voxel; });
    std::vector<CanopyEntry> merged;
    for (const CanopyEntry& e : all)
      if (!merged.empty() && merged.back().voxel == e.voxel)
        merged.back().area_m2 += e.area_m2;
      else
        merged.push_back(e);
    return merged;
  }

  const Forest& forest_;
  const RunControl& control_;
  std::vector<std::vector<AreaLump>> lumps_;
  BoxCanopy canopy_;
};

}  // namespace

std::vector<AreaLump> area_lumps(const Prototype& prototype, double size_m) {
  Lumps lumps(size_m);
  for (const FoliageElement& e : prototype.foliage) add_leaf(e, size_m, lumps);
  for (const WoodSegment& w : prototype.wood) add_wood(w, size_m, lumps);
  for (const WoodTriangle& t : prototype.wood_mesh) {
    const Vec3 a(t.a_m), b(t.b_m), c(t.c_m);
    // Closed meshes: a ray enters and leaves, each triangle blocks half of what it shows.
    lumps.add((a + b + c) / 3.0, 0.25 * glm::length(glm::cross(b - a, c - a)));
  }
  return lumps.result();
}

BoxCanopy box_canopy(const Forest& forest, double voxel_m, const RunControl& control) {
  if (!(voxel_m > 0.0 && std::isfinite(voxel_m)))
    throw_invalid("large_stand.voxel_m", "a box cannot be " + std::to_string(voxel_m) + " m",
                  "a length above 0");
  return CanopyBuilder(forest, voxel_m, control).build();
}

}  // namespace sunfleck
