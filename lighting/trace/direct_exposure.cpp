#include "lighting/trace/direct_exposure.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numeric>

#include "lighting/trace/element_error.h"
#include "lighting/trace/probe_sun.h"
#include "sim/base/parallel.h"

namespace sunfleck {

using namespace trace;

namespace {

// Measured on crowns of 40,000 leaves, a grown spruce and a periodic stand of 480,000 leaves.
constexpr double kPerRecord_s = 0.25e-6, kPerPixel_s = 5e-9, kPerCloudPixel_s = 150e-9;
constexpr double kPerRay_s = 0.22e-6, kPerRayAmongShoots_s = 0.4e-6, kPerBuilt_s = 0.6e-6;
// Relative error of a picture whose pixel is as wide as a leaf; it falls with pixel^1.5.
constexpr double kErrorAtOneSide = 1.9;

struct Contents {
  double records = 0, elements = 0, leaf_m2 = 0, shoot_m2 = 0;  // areas seen by the sun, on average
};

Contents contents_of(const Forest& forest) {
  std::vector<Contents> of_prototype;
  for (const Prototype& p : forest.prototypes) {
    Contents c;
    c.elements = static_cast<double>(p.foliage.size());
    c.records = c.elements + static_cast<double>(p.wood.size() + p.wood_mesh.size());
    for (const FoliageElement& e : p.foliage)
      if (e.shape == ElementShape::kShoot)  // a quarter of the cylinder's surface
        c.shoot_m2 += 0.5 * kPi * glm::length(Vec3(e.half_v_m)) *
                      (2.0 * glm::length(Vec3(e.half_u_m)) + glm::length(Vec3(e.half_v_m)));
      else
        c.leaf_m2 += 0.5 * e.area_m2;
    of_prototype.push_back(c);
  }
  Contents all;
  for (const Instance& i : forest.instances) {
    const Contents& c = of_prototype[i.prototype.value];
    const double scale2 = static_cast<double>(i.scale) * i.scale;
    all.elements += c.elements;
    all.records += c.records;
    all.leaf_m2 += scale2 * c.leaf_m2;
    all.shoot_m2 += scale2 * c.shoot_m2;
  }
  return all;
}

double picture_s(const Contents& c, double pixel_m) {
  return c.records * kPerRecord_s +
         (c.leaf_m2 * kPerPixel_s + c.shoot_m2 * kPerCloudPixel_s) / (pixel_m * pixel_m);
}

// One element by 8 lattices, each right on average and independent of the others.
constexpr int kLattices = 8;
void cast(const ProbeScene& scene, const Illumination& light, std::size_t element, int rays,
          std::uint64_t seed, SunExposure& out) {
  const SurfaceSampler surface(scene.receivers(), element);
  RandomStream random(seed, element, RandomPurpose::kSunRays);
  double sum = 0.0, squares = 0.0;
  for (int g = 0; g < kLattices; ++g) {
    const double seen =
        sun_on_surface(scene.rays(), surface, light, rays / kLattices, SunPoints::kSpread, random).seen;
    sum += seen;
    squares += seen * seen;
  }
  const double mean = sum / kLattices, n = kLattices;
  const double spread = std::max(0.0, squares / n - mean * mean) / (n - 1.0);
  // All alike: the next ray may still be of the other kind.
  const double unseen = spread > 0.0 ? 0.0 : fraction_variance(0.0, rays);
  out.sunlit_fraction[element] = static_cast<float>(mean);
  out.standard_error[element] = static_cast<float>(std::sqrt(spread + unseen));
}

SunExposure by_rays(const Forest& forest, const ForestIndex& index, const ProbeScene* scene,
                    const Illumination& light, std::span<const std::size_t> wanted, int rays,
                    std::uint64_t seed, const RunControl& control) {
  std::unique_ptr<ProbeScene> own;
  if (scene == nullptr) own = std::make_unique<ProbeScene>(forest, true, control), scene = own.get();
  SunExposure out;
  out.sunlit_fraction.resize(index.element_count());
  out.standard_error.resize(index.element_count());
  const std::size_t count = wanted.empty() ? index.element_count() : wanted.size();
  const auto chunk = static_cast<std::size_t>(std::max(1, 4096 / rays));
  for_each_chunk(count, chunk, control, "tracing sun", [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      cast(*scene, light, wanted.empty() ? i : wanted[i], rays, seed, out);
  });
  double squares = 0.0, lit = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t e = wanted.empty() ? i : wanted[i];
    const ForestIndex::Place place = index.place(e);
    const double beam = beam_on_faces(forest, place.instance, place.local, light.to_sun).both();
    squares += std::pow(beam * out.standard_error[e], 2);
    lit += beam * out.sunlit_fraction[e];
  }
  const auto n = static_cast<double>(count);
  out.relative_error = lit > 0.0 ? std::sqrt(squares / n) / (lit / n) : 0.0;
  return out;
}

}  // namespace

RasterCost estimate_raster_cost(const Forest& forest, const ForestIndex& index, double half_angle_rad,
                                const SunRasterOptions& options) {
  const Contents c = contents_of(forest);
  RasterCost cost;
  if (!(c.elements > 0.0)) return cost;
  cost.sun_directions = options.sun_directions > 0 ? options.sun_directions
                                                   : chosen_sun_directions(forest, index, half_angle_rad);
  const double side_m = std::sqrt(forest_leaf_area_m2(forest) / c.elements);
  cost.pixel_m =
      options.pixel_m > 0.0
          ? options.pixel_m
          : side_m *
                std::pow(options.target_error * std::sqrt(cost.sun_directions) / kErrorAtOneSide, 2.0 / 3.0);
  cost.cpu_s = cost.sun_directions * picture_s(c, cost.pixel_m);
  if (!(options.pixel_m > 0.0)) cost.cpu_s += picture_s(c, 0.3 * side_m);  // the first look
  return cost;
}

double estimate_shadow_ray_cost(const Forest& forest, const ForestIndex&, std::size_t elements, int rays,
                                bool scene_ready) {
  const Contents c = contents_of(forest);
  double built = 0.0;  // prototypes once
  for (const Prototype& p : forest.prototypes)
    built += static_cast<double>(p.foliage.size() + p.wood.size() + p.wood_mesh.size());
  built += 4.0 * static_cast<double>(forest.instances.size());
  return static_cast<double>(elements) * rays * (c.shoot_m2 > 0.0 ? kPerRayAmongShoots_s : kPerRay_s) +
         (scene_ready ? 0.0 : built * kPerBuilt_s);
}

int shadow_rays_for(double target_error) {
  // 64 spread rays err by 6.3 % on a sphere of 40,000 leaves, falling with rays^0.7.
  const double rays = 64.0 * std::pow(0.063 / target_error, 1.0 / 0.7);
  return kLattices * static_cast<int>(std::clamp(std::ceil(rays / kLattices), 1.0, 8192.0));
}

DirectExposure direct_sun_exposure(const Forest& forest, const ForestIndex& index, const ProbeScene* scene,
                                   const Illumination& light, std::span<const std::size_t> wanted,
                                   const SunRasterOptions& options, const RunControl& control) {
  DirectExposure out;
  const std::size_t count = wanted.empty() ? index.element_count() : wanted.size();
  const double raster_s = estimate_raster_cost(forest, index, light.sun_half_angle_rad, options).cpu_s;
  out.rays = shadow_rays_for(options.target_error);
  const double rays_s = estimate_shadow_ray_cost(forest, index, count, out.rays, scene != nullptr);
  // A scene of rays has the ground.
  out.by_raster = raster_s <= rays_s || !light.sun_is_up() || !options.ground;
  char reason[160];
  std::snprintf(reason, sizeof reason, "%s: drawing all %zu elements %.2g s, %d rays to %zu of them %.2g s",
                out.by_raster ? "drawn" : "by rays", index.element_count(), raster_s, out.rays, count,
                rays_s);
  out.reason = reason;
  if (out.by_raster) {
    out.rays = 0;
    out.sun = raster_sun(forest, index, light.to_sun, light.sun_half_angle_rad, options, control);
  } else {
    out.sun = by_rays(forest, index, scene, light, wanted, out.rays, options.seed, control);
  }
  return out;
}

}  // namespace sunfleck
