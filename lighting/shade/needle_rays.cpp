#include "lighting/shade/needle_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

constexpr int kBlocks = 20;  // groups of rays, for the standard error
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Where a ray enters a solid needle `apex + s axis`, 0 <= s <= length, of radius r, beyond min_distance;
// infinity if it does not. Its side, or one of its flat ends.
double needle_distance(const Vec3& from_apex, const Vec3& direction, const Vec3& axis, double length,
                       double r, double min_distance) {
  const double along_d = glm::dot(direction, axis), along_o = glm::dot(from_apex, axis);
  const double a = std::max(1 - along_d * along_d, 1e-18);
  const double b = glm::dot(from_apex, direction) - along_o * along_d;
  const double c = glm::dot(from_apex, from_apex) - along_o * along_o - r * r;
  const double discriminant = b * b - a * c;
  if (discriminant <= 0) return kInfinity;
  const double root = std::sqrt(discriminant), side = (-b - root) / a;
  const double s = along_o + side * along_d;
  if (s >= 0 && s <= length) return side > min_distance ? side : kInfinity;
  // Met beyond an end: perhaps it comes in through that end, before it leaves the side.
  const double end = ((s < 0 ? 0 : length) - along_o) / along_d;
  return end > side && end < (-b + root) / a && end > min_distance ? end : kInfinity;
}

// Length along z that a ray and everything it meets stays within: the bough's width at that slope.
double slope_reach(const Bough& bough, const Vec3& direction) {
  const double across = std::max(std::hypot(direction.x, direction.y), 1e-6);
  const double radius = bough.cone.length * std::sin(bough.cone.aperture_rad) + bough.cone.radius;
  return 2 * radius * std::abs(direction.z) / across;
}

struct StripView {
  Vec3 origin{0}, side{0}, ray{0}, to_light{0};
  double half_width = 0, lowest = 0, highest = 0;  // heights where rays pass the axis plane
};

StripView strip_view(const NeedleRays& needles, double half_width, const Vec3& to_viewer,
                     const Vec3& to_light) {
  const Bough& bough = needles.bough();
  const double across = std::hypot(to_viewer.x, to_viewer.y);
  if (!(across > 0))
    throw_invalid("to_viewer", "along the branch: a strip has no width there", "off the axis");
  const double high = bough.cone.length * std::cos(bough.cone.aperture_rad);
  const double margin = slope_reach(bough, to_viewer) + slope_reach(bough, to_light) + high;
  StripView view;
  view.lowest = margin;
  view.highest = (bough.cones - 1) * bough.spacing - margin + high;
  if (!(view.highest - view.lowest > bough.spacing))
    throw_invalid("bough.cones", "too few whorls for these angles to see an endless bough",
                  "at least " + std::to_string(static_cast<int>(2 * margin / bough.spacing) + 3));
  view.side = Vec3(to_viewer.y, -to_viewer.x, 0) / across;
  view.ray = -to_viewer;
  view.to_light = to_light;
  view.half_width = half_width;
  return view;
}

struct BlockSums {
  double hits = 0, light = 0;
};

BlockSums trace_block(const NeedleRays& needles, const StripView& view, int rays, std::uint64_t seed,
                      std::uint64_t block) {
  RandomStream random(seed, block, RandomPurpose::kNeedlePhases);
  const double radius = needles.bough().cone.radius;
  const double across = std::hypot(view.ray.x, view.ray.y);
  BlockSums sums;
  for (int i = 0; i < rays; ++i) {
    const double x = view.half_width * random.uniform(-1, 1);
    const Vec3 middle = x * view.side + Vec3(0, 0, random.uniform(view.lowest, view.highest));
    const double back = 2 * (needles.bough().cone.length + radius) / across;
    const Vec3 origin = middle - back * view.ray;
    const auto hit = needles.closest_hit(origin, view.ray, 0);
    if (!hit) continue;
    sums.hits += 1;
    const double cosine = glm::dot(hit->normal, view.to_light);
    const Vec3 point = origin + hit->distance * view.ray + 1e-6 * radius * hit->normal;
    if (cosine > 0 && !needles.occluded(point, view.to_light, 0)) sums.light += cosine;
  }
  return {sums.hits / rays, sums.light / rays};
}

}  // namespace

NeedleRays::NeedleRays(const Bough& bough, std::uint64_t seed) : bough_(bough) {
  validate(bough, "bough");
  if (bough.cones < 1) throw_invalid("bough.cones", "an endless bough has no list of needles", "at least 1");
  const double s = std::sin(bough.cone.aperture_rad), c = std::cos(bough.cone.aperture_rad);
  for (int whorl = 0; whorl < bough.cones; ++whorl) {
    const double phase =
        RandomStream(seed, static_cast<std::uint64_t>(whorl) + 1000, RandomPurpose::kNeedlePhases)
            .uniform(0, 2 * kPi);
    for (int i = 0; i < bough.cone.needles; ++i) {
      const double azimuth = phase + 2 * kPi * i / bough.cone.needles;
      axis_.emplace_back(s * std::cos(azimuth), s * std::sin(azimuth), c);
    }
  }
}

NeedleRays::WhorlRange NeedleRays::whorls(const Vec3& o, const Vec3& d) const {
  const NeedleCone& cone = bough_.cone;
  const double outer = cone.length * std::sin(cone.aperture_rad) + cone.radius;
  const double a = d.x * d.x + d.y * d.y, b = o.x * d.x + o.y * d.y;
  const double c = o.x * o.x + o.y * o.y - outer * outer;
  double lo = o.z, hi = o.z;
  if (a < 1e-18) {
    if (c > 0) return {};
    (d.z > 0 ? hi : lo) = d.z > 0 ? kInfinity : -kInfinity;
  } else {
    const double discriminant = b * b - a * c;
    if (discriminant <= 0) return {};
    const double far = (-b + std::sqrt(discriminant)) / a;
    if (far < 0) return {};
    const double near = std::max(0.0, (-b - std::sqrt(discriminant)) / a);
    lo = o.z + std::min(near * d.z, far * d.z);
    hi = o.z + std::max(near * d.z, far * d.z);
  }
  const double high = cone.length * std::cos(cone.aperture_rad) + cone.radius;
  const double first = (lo - high) / bough_.spacing, last = (hi + cone.radius) / bough_.spacing;
  const double most = bough_.cones - 1;
  return {static_cast<int>(std::floor(std::clamp(first, 0.0, most))),
          static_cast<int>(std::ceil(std::clamp(last, -1.0, most)))};
}

std::optional<NeedleHit> NeedleRays::closest_hit(const Vec3& origin, const Vec3& direction,
                                                 double min_distance) const {
  const NeedleCone& cone = bough_.cone;
  const WhorlRange range = whorls(origin, direction);
  double nearest = kInfinity;
  Vec3 apex(0), axis(0);
  for (int whorl = range.first; whorl <= range.last; ++whorl) {
    const Vec3 foot(0, 0, whorl * bough_.spacing);
    for (int i = 0; i < cone.needles; ++i) {
      const Vec3& a = axis_[static_cast<std::size_t>(whorl * cone.needles + i)];
      const double distance =
          needle_distance(origin - foot, direction, a, cone.length, cone.radius, min_distance);
      if (distance < nearest) nearest = distance, apex = foot, axis = a;
    }
  }
  if (!(nearest < kInfinity)) return std::nullopt;
  const Vec3 from_apex = origin + nearest * direction - apex;
  const double along = glm::dot(from_apex, axis);
  const Vec3 radial = from_apex - along * axis;
  if (glm::length(radial) > (1 - 1e-9) * cone.radius) return NeedleHit{nearest, glm::normalize(radial)};
  return NeedleHit{nearest, along > 0.5 * cone.length ? axis : -axis};
}

bool NeedleRays::occluded(const Vec3& origin, const Vec3& direction, double min_distance) const {
  const NeedleCone& cone = bough_.cone;
  const WhorlRange range = whorls(origin, direction);
  for (int whorl = range.first; whorl <= range.last; ++whorl) {
    const Vec3 from_apex = origin - Vec3(0, 0, whorl * bough_.spacing);
    for (int i = 0; i < cone.needles; ++i)
      if (needle_distance(from_apex, direction, axis_[static_cast<std::size_t>(whorl * cone.needles + i)],
                          cone.length, cone.radius, min_distance) < kInfinity)
        return true;
  }
  return false;
}

TracedBough trace_bough_strip(const NeedleRays& needles, double half_width, const Vec3& to_viewer,
                              const Vec3& to_light, int rays, std::uint64_t seed, const RunControl& control) {
  const StripView view = strip_view(needles, half_width, to_viewer, to_light);
  std::vector<BlockSums> blocks(kBlocks);
  const int per_block = std::max(1, rays / kBlocks);
  for_each_chunk(kBlocks, 1, control, "", [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) blocks[i] = trace_block(needles, view, per_block, seed, i);
  });
  TracedBough result;
  for (const BlockSums& b : blocks) {
    result.opacity += b.hits / kBlocks;
    result.reflected += b.light / kBlocks;
  }
  for (const BlockSums& b : blocks) {
    result.opacity_se += (b.hits - result.opacity) * (b.hits - result.opacity);
    result.reflected_se += (b.light - result.reflected) * (b.light - result.reflected);
  }
  result.opacity_se = std::sqrt(result.opacity_se / (kBlocks * (kBlocks - 1)));
  result.reflected_se = std::sqrt(result.reflected_se / (kBlocks * (kBlocks - 1)));
  return result;
}

}  // namespace sunfleck
