#include "lighting/render/reflectance_factor.h"

#include <cmath>

#include "lighting/render/path_tracer.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

struct TopPlane {
  Vec2 lo_m, size_m;
  double z_m;
};

TopPlane top_of(const Forest& forest) {
  const Box box = forest_bounds(forest);
  const double top_m = (box.empty() ? forest.terrain.elevation_m : box.hi.z) + 1e-3;
  if (forest.period) return {forest.period->origin_m, forest.period->size_m, top_m};
  if (box.empty())
    throw_invalid("forest", "is empty and does not repeat: it has no top", "trees, or a period");
  return {Vec2(box.lo), Vec2(box.size()), top_m};
}

void check_direction(const Vec3& direction, const char* name) {
  if (!is_finite(direction) || !(direction.z > 0.0))
    throw_invalid(name, "is not above the horizon", "a direction with z > 0");
}

// Sum over the samples of one group, for one view.
double group_mean(const PathTracer& tracer, const TopPlane& plane, const Vec3& to_view, std::uint64_t seed,
                  std::uint32_t group, int samples, const RunControl& control) {
  double sum = 0.0;
  for (int s = 0; s < samples; ++s) {
    if (s % 64 == 0) control.check();
    PathSamples numbers(seed, group, 0, static_cast<std::uint32_t>(s));
    const auto place = numbers.next();
    const Vec2 at = plane.lo_m + plane.size_m * Vec2(place[0], place[1]);
    sum += tracer.radiance({at.x, at.y, plane.z_m}, -to_view, numbers).x;
  }
  return sum / samples;
}

ReflectanceFactor factor_of(std::span<const double> group_means) {
  double mean = 0.0, squares = 0.0;
  const auto n = static_cast<double>(group_means.size());
  for (const double m : group_means) mean += m / n;
  for (const double m : group_means) squares += (m - mean) * (m - mean);
  return {mean, std::sqrt(squares / (n - 1.0) / n)};
}

}  // namespace

std::vector<ReflectanceFactor> bidirectional_reflectance(const Forest& forest, const OpticsTable& optics,
                                                         const Vec3& to_sun, std::span<const Vec3> to_views,
                                                         const ReflectanceOptions& options,
                                                         const RunControl& control) {
  check_direction(to_sun, "to_sun");
  for (const Vec3& view : to_views) check_direction(view, "to_views");
  if (options.band >= optics.band_count())
    throw_invalid("band", "is not in the optics table", "one of its bands");
  // A beam of pi / cos zenith makes radiance the factor itself.
  Illumination light;
  light.to_sun = glm::normalize(to_sun);
  light.bands.assign(optics.band_count(), {kPi / light.to_sun.z, 0.0});
  const PictureColour grey;
  const PictureScene scene(forest, options.look, control);
  const PictureLight sources(light, options.band, grey);
  const SurfaceTable surfaces(scene, optics, options.band, grey, options.look);
  const PathTracer tracer(scene, surfaces, sources);
  const TopPlane plane = top_of(forest);

  const int samples = std::max(1, (options.samples_per_view + kReflectanceGroups - 1) / kReflectanceGroups);
  std::vector<double> means(to_views.size() * kReflectanceGroups);
  for_each_chunk(means.size(), 1, control, "tracing reflectance", [&](std::size_t i, std::size_t) {
    const std::size_t view = i / kReflectanceGroups;
    means[i] = group_mean(tracer, plane, glm::normalize(to_views[view]), mix_seed(options.seed, view),
                          static_cast<std::uint32_t>(i % kReflectanceGroups), samples, control);
  });
  std::vector<ReflectanceFactor> factors;
  for (std::size_t v = 0; v < to_views.size(); ++v)
    factors.push_back(factor_of(std::span(means).subspan(v * kReflectanceGroups, kReflectanceGroups)));
  return factors;
}

}  // namespace sunfleck
