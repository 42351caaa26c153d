// See large_stand_check.h.
#include "lighting/canopy/large_stand_check.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "lighting/trace/ray_scene.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"

namespace sunfleck {

namespace {

constexpr std::uint64_t kCells = 1, kTrees = 2, kDraw = 3;
constexpr int kRaysPerTree = 4;  // times the rays of a cell: a tree fills a tenth of its disc
constexpr double kOverGroundM = 1e-3, kSlackM = 1e-3;

void check_options(const LargeStandCheckOptions& o) {
  if (o.cells < 0 || o.cells > 10'000 || o.trees < 0 || o.trees > 10'000 || o.rays < 1 || o.rays > 1000)
    throw_invalid("large_stand.check", "is out of range", "0 to 10,000 cells and trees, 1 to 1000 rays");
}

// `wanted` of `count` things, by lot, rising.
std::vector<std::size_t> drawn(std::size_t count, int wanted, std::uint64_t seed) {
  std::vector<std::size_t> all(count);
  std::iota(all.begin(), all.end(), 0);
  RandomStream random(seed, kDraw, RandomPurpose::kStandRays);
  const std::size_t kept = std::min(count, static_cast<std::size_t>(wanted));
  for (std::size_t i = 0; i < kept; ++i)
    std::swap(all[i], all[i + random.below(static_cast<std::uint32_t>(count - i))]);
  all.resize(kept);
  std::sort(all.begin(), all.end());
  return all;
}

struct Estimate {
  double value = 0, variance = 0;
};

// Sum over all directions that bring light of weight times the share of rays for which `sees` is true.
using Weight = std::function<double(const Vec3& to_source)>;
using Sees = std::function<bool(const Vec3& to_source, RandomStream&)>;
Estimate estimate(const StandSky& sky, int rays, const Weight& weight, const Sees& sees, RandomStream& random,
                  const RunControl& control) {
  Estimate sum;
  for (const LightSource* source : {&sky.sun, &sky.sky}) {
    const std::vector<double> strength = total_strength(*source);
    for (std::size_t d = 0; d < source->size(); ++d) {
      const double w = strength[d] * weight(source->to_source[d]);
      if (!(w > 0.0)) continue;
      control.check();
      int seen = 0;
      for (int k = 0; k < rays; ++k) seen += sees(source->to_source[d], random) ? 1 : 0;
      const double p = static_cast<double>(seen) / rays, smoothed = (seen + 0.5) / (rays + 1.0);
      sum.value += w * p;
      sum.variance += w * w * smoothed * (1.0 - smoothed) / rays;
    }
  }
  return sum;
}

Estimate cell_light(const RayScene& scene, const Forest& forest, const StandGround& map, std::size_t cell,
                    const StandSky& sky, int rays, RandomStream& random, const RunControl& control) {
  const auto sees = [&](const Vec3& to, RandomStream& lot) {
    const Vec2 at = map.centre_m(cell) + map.cell_m * (Vec2(lot.uniform(), lot.uniform()) - 0.5);
    const Vec3 point(at, forest.terrain.height_at(at.x, at.y) + kOverGroundM);
    return !scene.occluded(point, to);
  };
  return estimate(
      sky, rays, [&](const Vec3& to) { return map.facing(to); }, sees, random, control);
}

// Rays over the disc that hides the ball round the tree; light counts where it meets this tree first.
class TreeRays {
 public:
  TreeRays(const RayScene& scene, const Forest& forest, std::size_t tree, double top_m)
      : scene_(scene),
        tree_(tree),
        instance_(forest.instances[tree]),
        box_(prototype_bounds(forest.prototypes[instance_.prototype.value])),
        top_m_(top_m) {
    centre_m_ = world_from_tree(instance_, 0.5 * (box_.lo + box_.hi));
    radius_m_ = 0.5 * instance_.scale * glm::length(box_.size());
  }
  double disc_m2() const { return kPi * radius_m_ * radius_m_; }
  bool operator()(const Vec3& to, RandomStream& random) const {
    const Basis across = basis_around(to);
    const double r = radius_m_ * std::sqrt(random.uniform()), turn = 2.0 * kPi * random.uniform();
    const Vec3 aim = centre_m_ + r * (std::cos(turn) * across.tangent + std::sin(turn) * across.bitangent);
    const double way_m = std::max(radius_m_, (top_m_ - aim.z) / to.z);
    const RayHit hit = scene_.closest_hit(aim + way_m * to, -to);
    if (hit.kind == HitKind::kSky || hit.kind == HitKind::kGround || hit.instance != tree_) return false;
    const Vec3 at =
        tree_from_world(instance_, aim + (way_m - hit.distance_m) * to);  // not another copy of it
    return glm::all(glm::greaterThanEqual(at, box_.lo - kSlackM)) &&
           glm::all(glm::lessThanEqual(at, box_.hi + kSlackM));
  }

 private:
  const RayScene& scene_;
  std::size_t tree_;
  const Instance& instance_;
  Box box_;
  double top_m_, radius_m_ = 0;
  Vec3 centre_m_{0};
};

struct Sample {
  double boxes = 0;
  Estimate rays;
};
struct Difference {
  double bias = 0, error = 0;
};
// Mean of boxes - rays, and its root mean square without the rays' noise, or the standard error of that mean
// square where it is more.
Difference difference(const std::vector<Sample>& samples) {
  Difference d;
  const double n = static_cast<double>(samples.size());
  double mean = 0.0, squares = 0.0;
  for (const Sample& s : samples) {
    const double off = s.boxes - s.rays.value, square = off * off - s.rays.variance;
    d.bias += off / n;
    mean += square / n;
    squares += square * square / n;
  }
  if (samples.size() < 2) return d;
  const double own_error = std::sqrt(std::max(0.0, squares - mean * mean) / (n - 1.0));
  d.error = std::sqrt(std::max(mean, own_error));
  return d;
}

// Relative to the sample's light: its mean for the bias, its root mean square for the error.
Difference relative(Difference d, const std::vector<Sample>& samples) {
  double sum = 0.0, squares = 0.0;
  const double n = static_cast<double>(samples.size());
  for (const Sample& s : samples) sum += s.boxes / n, squares += s.boxes * s.boxes / n;
  if (!(sum > 0.0)) return {};
  return {d.bias / sum, d.error / std::sqrt(squares)};
}

double sum_over_intervals(const IntervalTable& table, std::size_t target) {
  double sum = 0.0;
  for (std::size_t i = 0; i < table.intervals; ++i) sum += table.at(i, target);
  return sum;
}

std::vector<double> open_light(const StandSky& sky, const StandGround& map) {
  std::vector<double> open = open_energy(sky.sun, map.normal / map.normal.z);
  const std::vector<double> diffuse = open_energy(sky.sky, map.normal / map.normal.z);
  for (std::size_t i = 0; i < open.size(); ++i) open[i] += diffuse[i];
  return open;
}

}  // namespace

LargeStandCheck check_large_stand(const Forest& forest, const LargeStandPrepared& prepared,
                                  const StandSky& given, const LargeStandLight& light,
                                  const LargeStandCheckOptions& options, const RunControl& control) {
  check_options(options);
  const StandSky sky = checked(given);
  const std::uint64_t seed = mix_seed(prepared.options.seed, 17);
  const auto cells = drawn(prepared.map.count(), options.cells, mix_seed(seed, kCells));
  const auto trees = drawn(forest.instances.size(), options.trees, mix_seed(seed, kTrees));
  const RayScene scene(forest, {}, control);
  const BoxCanopy& canopy = prepared.canopy;
  const double fall_m =
      std::tan(forest.terrain.slope_rad) * glm::length(Vec2(canopy.nx, canopy.ny) * canopy.edge_m);
  const double top_m = forest_bounds(forest).hi.z + (canopy.periodic ? fall_m : 0.0);
  double open = 0.0;
  for (const double o : open_light(sky, prepared.map)) open += o;
  std::vector<Sample> ground(cells.size()), tree(trees.size());
  for_each_chunk(
      cells.size() + trees.size(), 1, control, "rays beside boxes", [&](std::size_t i, std::size_t) {
        if (i < cells.size()) {
          RandomStream random(mix_seed(seed, kCells), i, RandomPurpose::kStandRays);
          ground[i] = {sum_over_intervals(light.ground_total, cells[i]),
                       cell_light(scene, forest, prepared.map, cells[i], sky, options.rays, random, control)};
          return;
        }
        const std::size_t k = i - cells.size();
        RandomStream random(mix_seed(seed, kTrees), k, RandomPurpose::kStandRays);
        const TreeRays sees(scene, forest, trees[k], top_m);
        const auto disc = [&](const Vec3& to) { return to.z > 0.0 ? sees.disc_m2() : 0.0; };
        tree[k] = {sum_over_intervals(light.tree_intercepted, trees[k]),
                   estimate(sky, kRaysPerTree * options.rays, disc, sees, random, control)};
      });
  const Difference on_ground = difference(ground), on_trees = relative(difference(tree), tree);
  const double per_open = open > 0.0 ? 1.0 / open : 0.0;
  return {cells.size(),  trees.size(),  per_open * on_ground.bias, per_open * on_ground.error,
          on_trees.bias, on_trees.error};
}

void set_errors(const LargeStandCheck& check, const StandSky& sky, LargeStandLight& light) {
  const std::vector<double> open = open_light(sky, light.map);
  IntervalTable& ground = light.ground_total;
  for (std::size_t e = 0; e < ground.value.size(); ++e)
    ground.standard_error[e] = static_cast<float>(check.ground_error * open[e / ground.targets]);
  IntervalTable& trees = light.tree_intercepted;
  for (std::size_t e = 0; e < trees.value.size(); ++e)
    trees.standard_error[e] = static_cast<float>(check.tree_error) * trees.value[e];
}

}  // namespace sunfleck
