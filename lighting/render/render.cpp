// The two ways to a picture. Every sample draws from the stream of its own (pixel, unit), so the picture is
// the same for any number of threads. Layers other than colour come from one ray through the pixel's centre.
#include "lighting/render/render.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "lighting/render/camera_rays.h"
#include "lighting/render/leaf_flecks.h"
#include "lighting/render/path_tracer.h"
#include "lighting/render/raster_choice.h"
#include "lighting/render/raster_image.h"
#include "lighting/render/render_passes.h"
#include "lighting/render/seen_trees.h"
#include "lighting/render/shader.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

constexpr char kPar[] = "PAR";
constexpr int kSamplesPerUnit = 4;

void refuse_map(const std::string& problem) {
  throw_invalid("map", problem, "give the light map that was computed for this forest and these bands");
}

std::string counts(std::size_t found, const char* what, std::size_t wanted) {
  return "has " + std::to_string(found) + " " + what + ", " + std::to_string(wanted) + " are needed";
}

void require_match(const ForestIndex& index, const OpticsTable& optics, const LightMap& map) {
  if (map.bands.size() != optics.band_count())
    refuse_map(counts(map.bands.size(), "bands", optics.band_count()));
  if (map.sunlit_fraction.size() != index.element_count())
    refuse_map(counts(map.sunlit_fraction.size(), "sunlit shares", index.element_count()));
  for (std::size_t b = 0; b < map.bands.size(); ++b) {
    const BandLightMap& band = map.bands[b];
    if (band.band != optics.bands()[b])
      refuse_map("has band " + band.band + " where the optics have " + optics.bands()[b]);
    if (band.elements.size() != index.element_count())
      refuse_map(counts(band.elements.size(), "elements", index.element_count()));
  }
}

void refuse_blind_camera(const Forest& forest, const Camera& camera) {
  if (camera.kind == CameraKind::kOrthographic) return;
  const Inside inside = what_holds(forest, camera.position_m);
  if (inside.wood)
    throw_invalid(
        "camera.position_m",
        "lies inside the wood of tree " + std::to_string(forest.instances[inside.instance].tree.value),
        "a place in the open");
  if (inside.below_ground) throw_invalid("camera.position_m", "lies below the ground", "a place above it");
}

std::size_t picture_band(const OpticsTable& optics) {
  const auto& bands = optics.bands();
  const auto par = std::find(bands.begin(), bands.end(), kPar);
  return par == bands.end() ? 0 : static_cast<std::size_t>(par - bands.begin());
}

// What both ways need, made once per picture.
struct Stage {
  Illumination light;
  std::size_t band;
  PictureColour colour;
  PictureScene scene;
  PictureLight sources;
  SurfaceTable surfaces;
  CameraRays rays;

  Stage(const Forest& forest, const OpticsTable& optics, const RenderRequest& request,
        const RunControl& control)
      : light(checked(request.light, optics.band_count())),
        band(picture_band(optics)),
        colour(picture_colour(optics.bands()[band] == kPar ? PictureBand::kPar : PictureBand::kOther, light,
                              band)),
        scene(forest, request.look, control,
              choose_details(forest, request.camera, light, request.detail, control)),
        sources(light, band, colour),
        surfaces(scene, optics, band, colour, request.look),
        rays(request.camera) {}
};

void write_layers(const Stage& stage, const RayHit& hit, std::size_t pixel, Image& image,
                  const BandLightMap* map, const ForestIndex& index) {
  if (hit.kind == HitKind::kSky) return;
  image.depth_m[pixel] = static_cast<float>(hit.distance_m);
  for (int c = 0; c < 3; ++c)
    image.normal[3 * pixel + static_cast<std::size_t>(c)] = static_cast<float>(hit.normal[c]);
  if (hit.kind == HitKind::kGround) return;
  image.instance_id[pixel] = static_cast<float>(hit.instance);
  if (hit.kind != HitKind::kFoliage || map == nullptr) return;
  const ElementLight& light =
      map->elements[index.first_element(hit.instance) + stage.scene.original_element(hit)];
  image.irradiance_w_m2[pixel] = light.front.total() + light.back.total();
}

void look_through_centre(const Stage& stage, int x, int y, std::size_t pixel, Image& image,
                         const BandLightMap* map, const ForestIndex& index) {
  const auto ray = stage.rays.through(x + 0.5, y + 0.5);
  if (!ray) return;
  write_layers(stage, stage.scene.closest_hit(ray->origin_m, ray->direction), pixel, image, map, index);
}

void count_details(const PictureScene& scene, Image& image) {
  for (std::uint32_t i = 0; i < scene.forest().instances.size(); ++i)
    ++image.trees_at[static_cast<std::size_t>(scene.detail_of(i))];
}

Image run(const Stage& stage, const RenderRequest& request, int samples_per_unit, const UnitSampler& sample,
          const BandLightMap* map, const ForestIndex& index, const RunControl& control,
          const TileSink& tiles) {
  const LayerFill layers = [&](int x, int y, std::size_t pixel, Image& image) {
    look_through_centre(stage, x, y, pixel, image, map, index);
  };
  Image image = run_passes(request.camera, plan_passes(request.camera, request.effort, samples_per_unit),
                           sample, layers, control, tiles);
  count_details(stage.scene, image);
  return image;
}

// Units of four low-discrepancy samples; with fewer than four units of them there is no error to state.
int samples_per_unit(const RenderRequest& request) {
  if (request.effort.noise > 0.0) return kSamplesPerUnit;
  return std::clamp(request.camera.samples_per_pixel / 4, 1, kSamplesPerUnit);
}

// Samples of a pixel take the scene's casts in turn, from one of the pixel's own.
std::uint8_t cast_of(const Stage& stage, std::uint64_t seed, std::size_t pixel, std::uint32_t sample) {
  const std::size_t casts = stage.scene.casts();
  return casts == 1 ? 0 : static_cast<std::uint8_t>((mix_seed(seed, pixel) + sample) % casts);
}

// The mean of one unit of samples of what `look` sees along the camera's rays. Both ways to a picture look
// through the same places of a pixel, at the same points of the sun's disc.
template <class Look>
UnitSampler unit_sampler(const Stage& stage, const RenderRequest& request, int samples, Look look) {
  return [&stage, seed = request.camera.seed, samples, look](int x, int y, std::size_t pixel,
                                                             std::uint32_t unit) {
    Vec3 sum(0.0);
    for (int s = 0; s < samples; ++s) {
      PathSamples numbers(seed, pixel, unit, static_cast<std::uint32_t>(s));
      const auto place = numbers.next();
      const auto ray = stage.rays.through(x + place[0], y + place[1]);
      const auto sample = unit * static_cast<std::uint32_t>(samples) + static_cast<std::uint32_t>(s);
      if (ray) sum += look(*ray, numbers, cast_of(stage, seed, pixel, sample));
    }
    return sum / static_cast<double>(samples);
  };
}

}  // namespace

void validate(const RenderRequest& request) {
  validate(request.camera);
  validate(request.detail);
  const auto within = [](double x, double lo, double hi) { return x >= lo && x <= hi; };
  if (!within(request.effort.noise, 0.0, 1.0))
    throw_invalid("render.noise", "is " + std::to_string(request.effort.noise), "0 (none) to 1");
  if (!within(request.effort.max_samples_per_pixel, 1, 1 << 20))
    throw_invalid("render.max_samples_per_pixel",
                  "is " + std::to_string(request.effort.max_samples_per_pixel), "1 to 1048576");
  if (!within(request.look.leaf_gloss, 0.0, 1.0))
    throw_invalid("render.leaf_gloss", "is " + std::to_string(request.look.leaf_gloss), "0 to 1");
  if (!within(request.look.gloss_exponent, 1.0, 1000.0))
    throw_invalid("render.gloss_exponent", "is " + std::to_string(request.look.gloss_exponent), "1 to 1000");
  if (!within(request.look.bark_width_m, 1e-3, 100.0))
    throw_invalid("render.bark_width_m", "is " + std::to_string(request.look.bark_width_m), "0.001 to 100 m");
}

Image render(const Forest& forest, const OpticsTable& optics, const LightMap& map,
             const RenderRequest& request, const RunControl& control, const TileSink& tiles) {
  validate(request);
  const ForestIndex index(forest);
  require_match(index, optics, map);
  refuse_blind_camera(forest, request.camera);
  control.check();
  const Stage stage(forest, optics, request, control);
  const PictureColour grey;
  const PictureLight grey_light(stage.light, stage.band, grey);
  const SurfaceTable grey_surfaces(stage.scene, optics, stage.band, grey, request.look);
  const BandLightMap& band = map.bands[stage.band];
  std::optional<LeafFlecks> flecks;
  if (request.leaf_sun == LeafSun::kTile && stage.sources.has_beam())
    flecks.emplace(forest, stage.scene, map, stage.light.to_sun, control);
  const LeafFlecks* of_leaves = flecks ? &*flecks : nullptr;
  const double reach_m =
      forest.period ? std::numeric_limits<double>::infinity() : gather_reach_m(stage.scene.box());
  const ShadingParts parts{stage.scene,      index,   band,     stage.surfaces, stage.sources, stage.colour,
                           request.leaf_sun, reach_m, of_leaves};
  const ShadingParts grey_parts{stage.scene,      index,   band,     grey_surfaces, grey_light, grey,
                                request.leaf_sun, reach_m, of_leaves};
  const NearTrees near =
      near_trees(request.camera, instance_boxes(outline_of(forest)), forest.period.has_value());
  const Shader shader(parts, find_mean_light(parts, grey_parts, near));
  const int samples = samples_per_unit(request);
  if (const auto raster = chosen_raster(stage.scene, request, stage.light)) {
    const HitLayers layers = [&](const RayHit& hit, std::size_t pixel, Image& image) {
      write_layers(stage, hit, pixel, image, &map.bands.front(), index);
    };
    Image image = rasterise(*raster, parts, shader, request.camera, stage.light,
                            plan_passes(request.camera, request.effort, samples), layers, control, tiles);
    image.visibility = Visibility::kRaster;
    count_details(stage.scene, image);
    return image;
  }
  const UnitSampler sample = unit_sampler(
      stage, request, samples, [&](const CameraRay& ray, PathSamples& numbers, std::uint8_t cast) {
        return shader.radiance(stage.scene.closest_hit(ray.origin_m, ray.direction, {.cast = cast}),
                               ray.direction, numbers);
      });
  return run(stage, request, samples, sample, &map.bands.front(), index, control, tiles);
}

Image render_path_traced(const Forest& forest, const OpticsTable& optics, const RenderRequest& request,
                         const RunControl& control, const TileSink& tiles) {
  validate(request);
  refuse_blind_camera(forest, request.camera);
  control.check();
  const ForestIndex index(forest);
  const Stage stage(forest, optics, request, control);
  const PathTracer tracer(stage.scene, stage.surfaces, stage.sources);
  const int paths = samples_per_unit(request);
  const UnitSampler sample =
      unit_sampler(stage, request, paths, [&](const CameraRay& ray, PathSamples& numbers, std::uint8_t cast) {
        return tracer.radiance(ray.origin_m, ray.direction, numbers, cast);
      });
  return run(stage, request, paths, sample, nullptr, index, control, tiles);
}

}  // namespace sunfleck
