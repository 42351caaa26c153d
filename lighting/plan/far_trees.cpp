#include "lighting/plan/far_trees.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lighting/plan/far_paths.h"
#include "lighting/trace/probe_path.h"
#include "sim/base/contract.h"

namespace sunfleck {
namespace {

using far_trees::PathRecords;

constexpr double kNormal99 = 2.326, kThree99 = 4.605;  // one-sided 99 in 100

// Trees by what they may bring to the selected ones, the least first: how many of them can go?
class Chooser {
 public:
  Chooser(const PathRecords& choosing, const PathRecords& checking, std::vector<std::uint32_t> candidates)
      : choosing_(choosing), checking_(checking), order_(std::move(candidates)) {
    const std::vector<double> brings = choosing.sums();
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return brings[a] < brings[b]; });
  }

  // The most trees whose bound stays within `most` on both halves.
  std::size_t most_that_can_go(double most) {
    std::size_t low = 0, high = order_.size();
    while (low < high) {
      const std::size_t middle = (low + high + 1) / 2;
      if (bound(choosing_, middle) <= most)
        low = middle;
      else
        high = middle - 1;
    }
    while (low > 0 && bound(checking_, low) > most) low -= (low + 15) / 16;
    return low;
  }
  double bound_of(std::size_t count) { return bound(checking_, count); }
  const std::vector<std::uint32_t>& order() const { return order_; }

 private:
  // Two independent halves of an element's paths: the mean of their product is the mean square of the
  // change, without the noise of either.
  double bound(const PathRecords& records, std::size_t count) {
    std::vector<bool> gone(records.trees());
    for (std::size_t i = 0; i < count; ++i) gone[order_[i]] = true;
    const double n = static_cast<double>(records.elements());
    double sum = 0, squares = 0;
    for (std::size_t e = 0; e < records.elements(); ++e) {
      const auto [first, second] = records.change(e, gone);
      sum += first * second;
      squares += first * second * first * second;
    }
    const double mean = sum / n, error = std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1));
    const double unseen = kThree99 / static_cast<double>(records.paths()) * records.largest();
    return std::sqrt(mean + kNormal99 * error) + 2 * unseen;
  }

  const PathRecords &choosing_, &checking_;
  std::vector<std::uint32_t> order_;
};

struct Ball {
  Vec3 centre_m{0};
  double radius_m = 0;
};

Ball ball_round(const Forest& forest, std::uint32_t tree) {
  const Instance& instance = forest.instances[tree];
  const Prototype& prototype = forest.prototypes[instance.prototype.value];
  const Box box = prototype_bounds(prototype);
  const double scale = instance.scale, half_m = 0.5 * (box.hi.z - box.lo.z);
  return {instance.position_m + Vec3(0, 0, scale * (box.lo.z + half_m)),
          scale * std::hypot(half_m, prototype_reach_m(prototype))};
}

bool hides(const Ball& by, const Ball& from, const Illumination& light) {
  const Vec3 way = by.centre_m - from.centre_m;
  const double reach_m = by.radius_m + from.radius_m, along_m = glm::dot(way, light.to_sun);
  if (along_m < -reach_m) return false;
  const double beside_m = glm::length(way - along_m * light.to_sun);
  return beside_m <= reach_m + (along_m + reach_m) * std::tan(light.sun_half_angle_rad);
}

// Any copy of `by` in a forest that repeats; suns so low that copies beyond counting matter hide everything.
bool any_copy_hides(const Forest& forest, Ball by, const Ball& from, const Illumination& light) {
  if (!forest.period) return hides(by, from, light);
  constexpr double kMostCopies = 30;
  const Vec2 size_m = forest.period->size_m;
  const double elevation =
      std::asin(std::clamp(light.to_sun.z, 0.0, 1.0)) - light.sun_half_angle_rad - forest.terrain.slope_rad;
  if (elevation <= 0) return true;
  const double far_m = 2 * (by.radius_m + from.radius_m) / std::sin(elevation) + glm::length(size_m);
  const double nx = std::ceil(far_m / size_m.x), ny = std::ceil(far_m / size_m.y);
  if (nx > kMostCopies || ny > kMostCopies) return true;
  const Vec3 home = by.centre_m;
  for (double x = -nx; x <= nx; ++x)
    for (double y = -ny; y <= ny; ++y) {
      const Vec2 by_m = Vec2(x, y) * size_m;
      const double rise_m = forest.terrain.height_at(by_m.x, by_m.y) - forest.terrain.height_at(0, 0);
      by.centre_m = home + Vec3(by_m.x, by_m.y, rise_m);
      if (hides(by, from, light)) return true;
    }
  return false;
}

// Neither selected nor a possible shade of the selected trees.
std::vector<std::uint32_t> candidates_of(const Forest& forest, const Illumination& light,
                                         const std::vector<std::uint32_t>& selected) {
  std::vector<Ball> wanted;
  for (const std::uint32_t i : selected) wanted.push_back(ball_round(forest, i));
  std::vector<std::uint32_t> candidates;
  const bool beam = trace::has_beam(light);
  for (std::uint32_t i = 0; i < forest.instances.size(); ++i) {
    if (std::binary_search(selected.begin(), selected.end(), i)) continue;
    const Ball by = beam ? ball_round(forest, i) : Ball{};
    if (beam && std::any_of(wanted.begin(), wanted.end(),
                            [&](const Ball& from) { return any_copy_hides(forest, by, from, light); }))
      continue;
    candidates.push_back(i);
  }
  return candidates;
}

}  // namespace

bool may_hide_sun(const Forest& forest, const Illumination& light, std::uint32_t by, std::uint32_t from) {
  return any_copy_hides(forest, ball_round(forest, by), ball_round(forest, from), light);
}

FarTrees find_far_trees(const ProbeScene& scene, const OpticsTable& optics, const Illumination& light,
                        const std::vector<std::uint32_t>& selected, const FarTreesOptions& options,
                        const RunControl& control) {
  SUNFLECK_EXPECTS(options.most_change > 0 && options.elements >= 20 && options.paths_per_face >= 2);
  const Forest& forest = scene.receivers().forest();
  FarTrees answer;
  answer.near.resize(forest.instances.size());
  std::iota(answer.near.begin(), answer.near.end(), 0u);
  std::vector<std::uint32_t> candidates = candidates_of(forest, light, selected);
  if (candidates.empty()) return answer;
  const far_trees::PathPlan plan(scene, optics, light, selected, options, control);
  const PathRecords choosing = plan.trace(0), checking = plan.trace(1);
  answer.paths = choosing.paths() + checking.paths();
  Chooser chooser(choosing, checking, std::move(candidates));
  const std::size_t count = chooser.most_that_can_go(options.most_change);
  if (count == 0) return answer;
  answer.bound = chooser.bound_of(count);
  answer.far.assign(chooser.order().begin(), chooser.order().begin() + static_cast<std::ptrdiff_t>(count));
  std::sort(answer.far.begin(), answer.far.end());
  answer.near.clear();
  for (std::uint32_t i = 0; i < forest.instances.size(); ++i)
    if (!std::binary_search(answer.far.begin(), answer.far.end(), i)) answer.near.push_back(i);
  return answer;
}

}  // namespace sunfleck
