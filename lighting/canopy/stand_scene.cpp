// See stand_scene.h.
#include "lighting/canopy/stand_scene.h"

#include <algorithm>
#include <cmath>

#include "sim/base/error.h"
#include "sim/forest/forest_spec.h"

namespace sunfleck {

namespace {

constexpr double kMostCells = 4e6, kMostLayers = 10000;
constexpr std::size_t kElementsSummed = 20'000'000;

void check_options(const StandSceneOptions& o) {
  if (!(o.ground_cell_m > 0.0 && std::isfinite(o.ground_cell_m)))
    throw_invalid("stand.ground_cell_m", "a cell cannot be " + std::to_string(o.ground_cell_m) + " m",
                  "a length above 0 in metres");
  if (!(o.layer_m > 0.0 && std::isfinite(o.layer_m)))
    throw_invalid("stand.layer_m", "a layer cannot be " + std::to_string(o.layer_m) + " m",
                  "a thickness above 0 in metres");
  if (o.map_lo_m.has_value() != o.map_hi_m.has_value())
    throw_invalid("stand.map", "has one corner only", "both corners, or none");
  if (o.map_lo_m && !(o.map_lo_m->x < o.map_hi_m->x && o.map_lo_m->y < o.map_hi_m->y))
    throw_invalid("stand.map", "has its corners the wrong way round", "south-west, then north-east");
}

}  // namespace

bool StandGround::contains(double x_m, double y_m) const {
  const Vec2 hi = lo_m + size_m();
  return x_m >= lo_m.x && x_m <= hi.x && y_m >= lo_m.y && y_m <= hi.y;
}

std::size_t StandGround::cell_at(double x_m, double y_m) const {
  if (!periodic && !contains(x_m, y_m)) return count();
  const auto along = [](double offset_cells, std::uint32_t n) {
    const double in_map = offset_cells - n * std::floor(offset_cells / n);
    return static_cast<std::size_t>(std::clamp(std::floor(in_map), 0.0, n - 1.0));
  };
  if (!periodic) {
    const auto inside = [](double k, std::uint32_t n) {
      return static_cast<std::size_t>(std::clamp(std::floor(k), 0.0, n - 1.0));
    };
    return inside((y_m - lo_m.y) / cell_m.y, ny) * nx + inside((x_m - lo_m.x) / cell_m.x, nx);
  }
  return along((y_m - lo_m.y) / cell_m.y, ny) * nx + along((x_m - lo_m.x) / cell_m.x, nx);
}

StandScene::StandScene(const Forest& forest, const StandSceneOptions& options, const RunControl& control)
    : forest_(forest), bounds_(forest_bounds(forest)), layer_m_(options.layer_m) {
  check_options(options);
  if (forest.instances.empty() || bounds_.empty())
    throw_invalid("forest", "has no trees", "at least one tree with leaves");
  fit_ground(options);
  measure_height();
  choose_region();
  sum_leaf_area();
  rays_ = std::make_unique<RayScene>(forest, RayScene::Options{}, control);
}

void StandScene::fit_ground(const StandSceneOptions& options) {
  Vec2 lo = options.map_lo_m.value_or(Vec2(bounds_.lo)), hi = options.map_hi_m.value_or(Vec2(bounds_.hi));
  if (forest_.period) {
    lo = forest_.period->origin_m;
    hi = lo + forest_.period->size_m;
  }
  const Vec2 size = glm::max(hi - lo, Vec2(1e-6));
  const Vec2 cells = glm::max(glm::round(size / options.ground_cell_m), Vec2(1.0));
  if (cells.x * cells.y > kMostCells)
    throw Error(
        ErrorKind::kLimitExceeded, "stand.ground_cell_m",
        "gives " + std::to_string(static_cast<long long>(cells.x * cells.y)) + " ground cells",
        "at most 4 million: " + std::to_string(std::sqrt(size.x * size.y / kMostCells)) + " m or more");
  ground_.lo_m = lo;
  ground_.nx = static_cast<std::uint32_t>(cells.x);
  ground_.ny = static_cast<std::uint32_t>(cells.y);
  ground_.cell_m = size / cells;
  ground_.normal = forest_.terrain.normal();
  ground_.periodic = forest_.period.has_value();
}

// Top of the highest tree above the ground under it.
void StandScene::measure_height() {
  std::vector<double> top_m(forest_.prototypes.size()), reach_m(forest_.prototypes.size());
  for (std::size_t p = 0; p < top_m.size(); ++p) {
    const Box box = prototype_bounds(forest_.prototypes[p]);
    top_m[p] = box.empty() ? 0.0 : box.hi.z;
    reach_m[p] = prototype_reach_m(forest_.prototypes[p]);
  }
  const double fall = std::tan(forest_.terrain.slope_rad);
  for (const Instance& tree : forest_.instances)
    ceiling_m_ = std::max(
        ceiling_m_, height_above_ground(tree.position_m) +
                        tree.scale * (top_m[tree.prototype.value] + fall * reach_m[tree.prototype.value]));
  ceiling_m_ = std::max(ceiling_m_, 1e-6) * (1.0 + 1e-6);
  if (ceiling_m_ / layer_m_ > kMostLayers)
    throw Error(ErrorKind::kLimitExceeded, "stand.layer_m", "makes more than 10,000 layers",
                std::to_string(ceiling_m_ / kMostLayers) + " m or more");
}

void StandScene::choose_region() {
  for (const Instance& tree : forest_.instances) asked_.push_back(is_virtual(tree.tree) ? 0 : 1);
  const auto asked = static_cast<std::size_t>(std::count(asked_.begin(), asked_.end(), 1));
  if (asked == 0) asked_.assign(asked_.size(), 1);
  region_ = bounds_;
  if (asked == 0 || asked == asked_.size() || ground_.periodic) return;
  has_surroundings_ = true;
  const double margin_m = 0.5 * ceiling_m_;
  Vec2 lo = ground_.lo_m, hi = ground_.lo_m + ground_.size_m();
  for (std::size_t i = 0; i < asked_.size(); ++i) {
    const Instance& tree = forest_.instances[i];
    if (asked_[i] == 0) continue;
    const double reach_m = tree.scale * prototype_reach_m(forest_.prototypes[tree.prototype.value]);
    lo = glm::min(lo, Vec2(tree.position_m) - reach_m);
    hi = glm::max(hi, Vec2(tree.position_m) + reach_m);
  }
  region_.lo = {glm::max(lo - margin_m, Vec2(bounds_.lo)), bounds_.lo.z};
  region_.hi = {glm::min(hi + margin_m, Vec2(bounds_.hi)), bounds_.hi.z};
}

std::size_t StandScene::layer_at(const Vec3& point_m) const {
  const double layer = std::floor(height_above_ground(point_m) / layer_m_);
  return static_cast<std::size_t>(std::clamp(layer, 0.0, static_cast<double>(layer_count() - 1)));
}

// Layers of very large stands: every n-th element stands for n, so that the sum stays short.
void StandScene::sum_leaf_area() {
  layer_leaf_area_m2_.assign(static_cast<std::size_t>(std::ceil(ceiling_m_ / layer_m_)), 0.0);
  tree_leaf_area_m2_.assign(forest_.instances.size(), 0.0);
  std::vector<double> area_m2(forest_.prototypes.size());
  for (std::size_t p = 0; p < area_m2.size(); ++p) area_m2[p] = leaf_area_m2(forest_.prototypes[p]);
  const std::size_t stride = ForestIndex(forest_).element_count() / kElementsSummed + 1;
  for (std::size_t i = 0; i < forest_.instances.size(); ++i) {
    const Instance& tree = forest_.instances[i];
    const auto& foliage = forest_.prototypes[tree.prototype.value].foliage;
    tree_leaf_area_m2_[i] = area_m2[tree.prototype.value] * tree.scale * tree.scale;
    double looked_at_m2 = 0.0;
    for (std::size_t e = i % stride; e < foliage.size(); e += stride) looked_at_m2 += foliage[e].area_m2;
    if (!(looked_at_m2 > 0.0)) continue;
    const double share = tree_leaf_area_m2_[i] / looked_at_m2;
    for (std::size_t e = i % stride; e < foliage.size(); e += stride)
      layer_leaf_area_m2_[layer_at(world_from_tree(tree, Vec3(foliage[e].centre_m)))] +=
          share * foliage[e].area_m2;
  }
}

}  // namespace sunfleck
