#include "lighting/plan/growth_light.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lighting/transport/grid_estimator.h"
#include "sim/plant/flat_elements.h"

namespace sunfleck {
namespace {

constexpr double kProbeRadius_m = 1e-3;
constexpr double kSky_w_m2 = 100;

// Points at the middles of cells over [lo, hi].
struct Lattice {
  Vec3 lo{0}, step{1};
  std::array<int, 3> size{1, 1, 1};
  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size[1]) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size[0]) +
           static_cast<std::size_t>(x);
  }
  std::size_t count() const {
    return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
           static_cast<std::size_t>(size[2]);
  }
  Vec3 point(std::size_t i) const {
    const auto nx = static_cast<std::size_t>(size[0]), ny = static_cast<std::size_t>(size[1]);
    const Vec3 cell(static_cast<double>(i % nx), static_cast<double>(i / nx % ny),
                    static_cast<double>(i / (nx * ny)));
    return lo + (cell + 0.5) * step;
  }
};

// Over the site's width where it repeats, else over the leaves and a cell around them; up to a cell above.
Lattice lattice_of(const GrowthSite& site, std::span<const LeafPlace> leaves) {
  Box box;
  for (const LeafPlace& leaf : leaves) box.include(leaf.position_m);
  Vec3 lo = box.lo - site.cell_m, hi = box.hi + site.cell_m;
  lo.z = 0;
  if (site.period_m)
    lo.x = site.room.lo.x, lo.y = site.room.lo.y, hi.x = site.room.hi.x, hi.y = site.room.hi.y;
  Lattice lattice;
  lattice.lo = lo;
  for (int i = 0; i < 3; ++i) {
    lattice.size[static_cast<std::size_t>(i)] =
        std::max(1, static_cast<int>(std::ceil((hi[i] - lo[i]) / site.cell_m)));
    lattice.step[i] = (hi[i] - lo[i]) / lattice.size[static_cast<std::size_t>(i)];
  }
  return lattice;
}

// One prototype: the leaves, then the probes.
Forest scene_of(const GrowthSite& site, std::span<const LeafPlace> leaves, const Lattice& lattice) {
  Forest forest;
  forest.name = "growing";
  forest.materials.push_back({"leaf", {{"PAR", site.leaf_reflectance, site.leaf_transmittance, 0.1}}});
  Prototype stand;
  stand.name = "stand";
  stand.materials = {"leaf"};
  const Vec3 origin(site.room.lo.x, site.room.lo.y, 0);
  stand.foliage.reserve(leaves.size() + lattice.count());
  for (const LeafPlace& leaf : leaves)
    stand.foliage.push_back(make_disc(leaf.position_m - origin, leaf.normal, std::sqrt(leaf.area_m2 / kPi)));
  for (std::size_t i = 0; i < lattice.count(); ++i)
    stand.foliage.push_back(make_disc(lattice.point(i) - origin, {0, 0, 1}, kProbeRadius_m));
  forest.prototypes.push_back(std::move(stand));
  Instance instance;
  instance.position_m = origin;
  forest.instances.push_back(instance);
  if (site.period_m) forest.period = Period{{origin.x, origin.y}, *site.period_m};
  return forest;
}

class LightField {
 public:
  LightField(GrowthSite site, RunControl control) : site_(std::move(site)), control_(std::move(control)) {}

  void new_year(std::span<const LeafPlace> all) {
    control_.check();
    share_.clear();
    std::vector<LeafPlace> leaves(all.begin(), all.end());
    std::erase_if(leaves, [](const LeafPlace& leaf) { return leaf.position_m.z <= 0; });  // in the ground
    if (leaves.empty()) return;
    lattice_ = lattice_of(site_, leaves);
    const Forest forest = scene_of(site_, leaves, lattice_);
    Illumination light;
    light.sky = SkyModel::kUniform;
    light.bands = {{0.0, kSky_w_m2}};
    GridOptions options;
    options.cell_m = site_.cell_m;
    const LightMap map = grid_light_map(forest, OpticsTable(forest, {{"PAR"}, {site_.soil_albedo}, {}}),
                                        light, options, {control_.stop, {}});
    for (std::size_t i = 0; i < lattice_.count(); ++i) {
      const double here = map.bands[0].elements[leaves.size() + i].front.total() / kSky_w_m2;
      share_.push_back(static_cast<float>(std::clamp(here, 0.0, 1.0)));
    }
  }

  double at(const Vec3& position_m) const {
    if (position_m.z <= 0) return 0;  // in the ground
    if (share_.empty()) return 1;
    const Vec3 place = (position_m - lattice_.lo) / lattice_.step - 0.5, corner = glm::floor(place);
    if (corner.z >= lattice_.size[2]) return 1;  // above all leaves
    double sum = 0;
    for (int i = 0; i < 8; ++i) {
      const Vec3 step(i & 1, (i >> 1) & 1, i >> 2);
      const Vec3 near = 1.0 - glm::abs(place - (corner + step));
      sum += near.x * near.y * near.z * share_[node(corner + step)];
    }
    return std::clamp(sum, 0.0, 1.0);
  }

 private:
  // Round the period's edge; beyond the leaves as at their edge.
  std::size_t node(const Vec3& cell) const {
    std::array<int, 3> i{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const auto wanted = static_cast<int>(std::clamp(cell[axis], -1e6, 1e6));
      const bool repeats = site_.period_m && axis < 2;
      i[a] = repeats ? ((wanted % lattice_.size[a]) + lattice_.size[a]) % lattice_.size[a]
                     : std::clamp(wanted, 0, lattice_.size[a] - 1);
    }
    return lattice_.index(i[0], i[1], i[2]);
  }

  GrowthSite site_;
  RunControl control_;
  Lattice lattice_;
  std::vector<float> share_;  // of open sky, per lattice point
};

}  // namespace

BudLight growth_light_by_grid(const GrowthSite& site, const RunControl& control) {
  const auto field = std::make_shared<LightField>(site, control);
  return {[field](std::span<const LeafPlace> leaves) { field->new_year(leaves); },
          [field](const Vec3& position_m) { return field->at(position_m); }};
}

Forest grow_lit_forest(const ForestSpec& spec, const SpeciesLibrary& species, const RunControl& control,
                       std::vector<std::string>* notes) {
  return grow_forest(spec, species, control, notes, growth_light_by_grid);
}

}  // namespace sunfleck
