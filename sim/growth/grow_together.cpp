#include "sim/growth/grow_together.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/growth/growing_tree.h"

namespace sunfleck {
namespace {

constexpr double kReachShare = 0.65;  // of the way to a neighbour's stem, as in light_grid.h
constexpr double kFarthestNeighbour_m = 30;
constexpr double kMargin_m = 8;       // crowns reach beyond the outer stems
constexpr double kMostShoot_m = 0.6;  // of a year, and a little
constexpr double kTallest_m = 45;

Vec3 world_from(const Seedling& s, const Vec3& p) {
  const double c = std::cos(s.yaw_rad), n = std::sin(s.yaw_rad);
  return {s.place_m.x + c * p.x - n * p.y, s.place_m.y + n * p.x + c * p.y, p.z};
}

Vec3 turned(const Seedling& s, const Vec3& p) { return world_from(s, p) - Vec3(s.place_m.x, s.place_m.y, 0); }

// Stems near enough to push, of the tree itself too where the stand repeats.
struct Neighbour {
  std::size_t tree;
  Vec2 place_m;
};

std::vector<Neighbour> neighbours_of(std::span<const Seedling> seedlings, std::size_t tree,
                                     const std::optional<Vec2>& period_m) {
  std::vector<Neighbour> near;
  const auto copies = [&](double size_m) {
    return period_m ? static_cast<int>(std::ceil(kFarthestNeighbour_m / size_m)) : 0;
  };
  const int nx = period_m ? copies(period_m->x) : 0, ny = period_m ? copies(period_m->y) : 0;
  for (std::size_t other = 0; other < seedlings.size(); ++other)
    for (int i = -nx; i <= nx; ++i)
      for (int j = -ny; j <= ny; ++j) {
        if (other == tree && i == 0 && j == 0) continue;
        const Vec2 place = seedlings[other].place_m + (period_m ? Vec2(i, j) * *period_m : Vec2(0));
        if (glm::distance(place, seedlings[tree].place_m) < kFarthestNeighbour_m)
          near.push_back({other, place});
      }
  return near;
}

class Stand {
 public:
  Stand(std::span<const Seedling> seedlings, const GrowthSite& site, const RunControl& control)
      : seedlings_(seedlings), heights_m_(seedlings.size(), 0.0) {
    std::map<std::filesystem::path, std::shared_ptr<const lsystem::Grammar>> grammars;
    for (std::size_t i = 0; i < seedlings.size(); ++i) {
      auto& grammar = grammars[seedlings[i].grammar];
      if (!grammar)
        grammar = std::make_shared<const lsystem::Grammar>(lsystem::Grammar::load(seedlings[i].grammar));
      trees_.emplace_back(*seedlings[i].species, grammar, seedlings[i].seed, control);
      near_.push_back(neighbours_of(seedlings, i, site.period_m));
    }
  }

  std::vector<LeafPlace> leaves(std::size_t most_of_a_tree, std::size_t most_in_all) const {
    std::vector<LeafPlace> all;
    for (std::size_t i = 0; i < trees_.size(); ++i)
      for (LeafPlace leaf : trees_[i].leaves(most_of_a_tree)) {
        leaf.position_m = world_from(seedlings_[i], leaf.position_m);
        leaf.normal = turned(seedlings_[i], leaf.normal);
        all.push_back(leaf);
      }
    if (all.size() > most_in_all)
      throw Error(ErrorKind::kLimitExceeded, "growth", std::to_string(all.size()) + " leaves in all",
                  "fewer trees or years");
    return all;
  }

  void grow_a_year(const BudLight& light, const RunControl& control) {
    const RunControl stop_only{control.stop, {}};
    for (std::size_t i = 0; i < trees_.size(); ++i) heights_m_[i] = trees_[i].height_m();
    for_each_chunk(trees_.size(), 1, stop_only, "", [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        trees_[i].grow_a_year([&, i](const Vec3& p) { return light_for(i, p, light); }, stop_only);
    });
  }

  double height_m() const {
    double height_m = 0;
    for (const growth::GrowingTree& tree : trees_) height_m = std::max(height_m, tree.height_m());
    return height_m;
  }

  Prototype finished(std::size_t i, double twig_radius_m) { return trees_[i].finished(twig_radius_m); }

 private:
  double light_for(std::size_t tree, const Vec3& in_tree_m, const BudLight& light) const {
    const Vec3 world_m = world_from(seedlings_[tree], in_tree_m);
    return has_room(tree, world_m) ? light.at(world_m) : 0.0;
  }

  // A crown ends at kReachShare of the way to each other stem, in a line across it.
  bool has_room(std::size_t tree, const Vec3& world_m) const {
    const Vec2 from_stem = Vec2(world_m.x, world_m.y) - seedlings_[tree].place_m;
    return std::none_of(near_[tree].begin(), near_[tree].end(), [&](const Neighbour& other) {
      const Vec2 between = other.place_m - seedlings_[tree].place_m;
      return heights_m_[other.tree] >= world_m.z &&
             glm::dot(from_stem, between) > kReachShare * glm::dot(between, between);
    });
  }

  std::span<const Seedling> seedlings_;
  std::vector<growth::GrowingTree> trees_;
  std::vector<std::vector<Neighbour>> near_;
  std::vector<double> heights_m_;  // at the end of last year
};

}  // namespace

GrowthSite site_of(std::span<const Seedling> seedlings, std::optional<Vec2> period_m, int years) {
  GrowthSite site;
  site.period_m = period_m;
  const double height_m = std::min(kTallest_m, 2 + kMostShoot_m * years);
  for (const Seedling& s : seedlings) {
    site.room.include(Vec3(s.place_m.x, s.place_m.y, 0));
    site.room.include(Vec3(s.place_m.x, s.place_m.y, height_m));
  }
  if (period_m) {
    const Vec3 middle = 0.5 * (site.room.lo + site.room.hi), half(0.5 * period_m->x, 0.5 * period_m->y, 0);
    site.room.lo = {middle.x - half.x, middle.y - half.y, 0};
    site.room.hi = {middle.x + half.x, middle.y + half.y, height_m};
  } else {
    site.room.lo -= Vec3(kMargin_m, kMargin_m, 0);
    site.room.hi += Vec3(kMargin_m, kMargin_m, 0);
  }
  double reflect = 0, pass = 0;
  for (const Seedling& s : seedlings)
    for (const MaterialBand& band : s.species->material.bands)
      if (band.band == "PAR") reflect += band.leaf_reflectance, pass += band.leaf_transmittance;
  const auto count = static_cast<double>(std::max<std::size_t>(1, seedlings.size()));
  site.leaf_reflectance = reflect / count;
  site.leaf_transmittance = pass / count;
  return site;
}

BudLight openness_light(const GrowthSite& site) {
  const Vec3 size = site.room.hi - site.room.lo;
  LightGridOptions options;
  options.cell_m = site.cell_m;
  options.height_m = site.room.hi.z;
  options.half_width_m = 0.5 * std::max(size.x, size.y);
  if (site.period_m) {
    if (std::abs(site.period_m->x - site.period_m->y) > 1e-6 * site.period_m->x)
      throw_invalid("forest.period", "is not a square", "a square, or another light for growing");
    options.period_m = site.period_m->x;
  }
  const auto grid = std::make_shared<LightGrid>(options);
  const Vec3 middle(0.5 * (site.room.lo.x + site.room.hi.x), 0.5 * (site.room.lo.y + site.room.hi.y), 0);
  return {[grid, middle](std::span<const LeafPlace> leaves) {
            std::vector<LeafPlace> moved(leaves.begin(), leaves.end());
            for (LeafPlace& leaf : moved) leaf.position_m -= middle;
            grid->set_leaves(moved);
          },
          [grid, middle](const Vec3& position_m) { return grid->openness(position_m - middle); }};
}

GrownStand grow_together(std::span<const Seedling> seedlings, const GrowthSite& site, const BudLight& light,
                         const GrowthOptions& options, const RunControl& control) {
  validate(options);
  validate(light);
  if (seedlings.empty()) throw_invalid("growth", "there is no seedling", "at least one");
  Stand stand(seedlings, site, control);
  GrownStand grown;
  while (grown.years < options.years) {
    control.check();
    light.new_year(stand.leaves(options.most_leaves, options.most_leaves_in_all));
    stand.grow_a_year(light, control);
    control.report("growing in light", static_cast<double>(++grown.years) / options.years);
    if (options.stop_height_m > 0 && stand.height_m() >= options.stop_height_m) break;
  }
  grown.trees.resize(seedlings.size());
  for_each_chunk(seedlings.size(), 1, {control.stop, {}}, "", [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      grown.trees[i] = stand.finished(i, options.twig_radius_m);
      validate(grown.trees[i], seedlings[i].grammar.string());
    }
  });
  return grown;
}

}  // namespace sunfleck
