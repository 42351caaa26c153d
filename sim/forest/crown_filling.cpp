#include "sim/forest/crown_filling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sim/plant/crown_shape.h"
#include "sim/plant/grow_foliage.h"
#include "sim/plant/grow_wood.h"

namespace sunfleck {
namespace {

constexpr int kSlices = 24, kSectors = 8;
constexpr double kLeastBaseShare = 0.01;  // grammars need a stem below the crown
constexpr double kLeastOutlineShare = 0.05;

// Linear between the lowest and the highest foliage, and from the ground to the lowest.
struct HeightWarp {
  double lowest_m, highest_m, base_m, top_m;
  double operator()(double z) const {
    if (z <= lowest_m) return lowest_m > 0 ? z * (base_m / lowest_m) : z;
    return base_m + (z - lowest_m) * (top_m - base_m) / (highest_m - lowest_m);
  }
};

template <class Move>
void move_all(Prototype& tree, const Move& move) {
  for (FoliageElement& e : tree.foliage) move(e.centre_m);
  for (WoodSegment& s : tree.wood) move(s.from_m), move(s.to_m);
}

// How far the grown foliage reaches, by height over the crown's base and by azimuth. Each cell holds the
// farthest of itself and its neighbours: what is interpolated between cells is nowhere less than the foliage.
class Outline {
  using Cells = std::array<std::array<double, kSectors>, kSlices>;
  template <class C>
  static auto& at(C& cells, int slice, int sector) {
    return cells[static_cast<std::size_t>(slice)][static_cast<std::size_t>((sector + kSectors) % kSectors)];
  }

 public:
  Outline(const Prototype& tree, const CrownShape& crown)
      : base_m_(crown.base_m), length_m_(crown.height_m - crown.base_m) {
    Cells own{};
    double farthest = 0;
    for (const FoliageElement& e : tree.foliage) {
      const Vec3 p(e.centre_m);
      const double reach = std::hypot(p.x, p.y);
      const auto slice = static_cast<std::size_t>(std::clamp(std::floor(slice_of(p.z)), 0.0, kSlices - 1.0));
      double& cell = own[slice][static_cast<std::size_t>(std::floor(sector_of(p))) % kSectors];
      cell = std::max(cell, reach);
      farthest = std::max(farthest, reach);
    }
    for (int i = 0; i < kSlices; ++i)
      for (int k = 0; k < kSectors; ++k) {
        double& cell = at(cells_, i, k);
        cell = kLeastOutlineShare * farthest;
        for (int di = -1; di <= 1; ++di)
          for (int dk = -1; dk <= 1; ++dk)
            if (i + di >= 0 && i + di < kSlices) cell = std::max(cell, at(own, i + di, k + dk));
      }
  }

  // Bilinear between the middles of cells.
  double reach_m(const Vec3& p) const {
    const double slice = std::clamp(slice_of(p.z) - 0.5, 0.0, kSlices - 1.0), sector = sector_of(p) - 0.5;
    const int i = std::min(static_cast<int>(slice), kSlices - 2), k = static_cast<int>(std::floor(sector));
    const double u = slice - i, v = sector - k;
    return (1 - u) * ((1 - v) * at(cells_, i, k) + v * at(cells_, i, k + 1)) +
           u * ((1 - v) * at(cells_, i + 1, k) + v * at(cells_, i + 1, k + 1));
  }

 private:
  double slice_of(double z) const { return kSlices * (z - base_m_) / length_m_; }
  static double sector_of(const Vec3& p) { return kSectors * (std::atan2(p.y, p.x) / (2 * kPi) + 0.5); }

  double base_m_, length_m_;
  Cells cells_{};
};

HeightWarp height_warp(const Prototype& tree, const CrownShape& crown) {
  HeightWarp warp{std::numeric_limits<double>::infinity(), 0, crown.base_m, crown.height_m};
  for (const FoliageElement& e : tree.foliage) {
    warp.lowest_m = std::min(warp.lowest_m, double{e.centre_m.z});
    warp.highest_m = std::max(warp.highest_m, double{e.centre_m.z});
  }
  warp.highest_m = std::max(warp.highest_m, warp.lowest_m + 1e-3);
  return warp;
}

}  // namespace

double crown_reach_m(const CrownShape& crown, double height_m, const Vec2& towards) {
  const double off = height_m - crown.widest_m;
  const double semi = off >= 0 ? crown.height_m - crown.widest_m : crown.widest_m - crown.base_m;
  const double part = off == 0 ? 0 : semi > 0 ? off / semi : 2;
  if (std::abs(part) > 1) return 0;
  const auto& r = crown.radius_nesw_m;
  const double x = towards.x / (towards.x >= 0 ? r[1] : r[3]), y = towards.y / (towards.y >= 0 ? r[0] : r[2]);
  return std::sqrt(1 - part * part) / std::hypot(x, y);
}

void warp_into_crown(Prototype& tree, const CrownShape& crown) {
  const HeightWarp height = height_warp(tree, crown);
  move_all(tree, [&](Vec3f& p) { p.z = static_cast<float>(height(p.z)); });
  const Outline outline(tree, crown);
  move_all(tree, [&](Vec3f& p) {
    const double away = std::hypot(double{p.x}, double{p.y});
    if (!(away > 0)) return;
    const double z = std::clamp(double{p.z}, crown.base_m, crown.height_m);
    const double reach = crown_reach_m(crown, z, Vec2(p.x, p.y) / away);
    const double factor = std::min(reach / away, reach / outline.reach_m(Vec3(p)));
    p.x = static_cast<float>(factor * p.x), p.y = static_cast<float>(factor * p.y);
  });
}

Prototype grown_crown(const Species& species, const CrownShape& crown, double leaf_area_m2, int elements,
                      std::uint64_t seed, const RunControl& control) {
  validate(crown, species.latin);
  double radius_m = 0;
  for (const double r : crown.radius_nesw_m) radius_m += 0.25 * r;
  const TreeSize size{crown.dbh_m, crown.height_m,
                      std::clamp(crown.base_m, kLeastBaseShare * crown.height_m, 0.95 * crown.height_m),
                      radius_m, leaf_area_m2};
  const double detail = std::clamp(elements * template_area_m2(species.foliage) / leaf_area_m2, 1e-6, 1.0);
  Prototype tree = grow_prototype(species, size, seed, detail, control);
  warp_into_crown(tree, crown);
  scale_wood_to_dbh(tree, crown.dbh_m);
  tree.stated_dbh_m = crown.dbh_m;
  return tree;
}

}  // namespace sunfleck
