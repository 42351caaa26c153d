#include "lighting/plan/light_config.h"

#include <cmath>

#include "lighting/sky/sun_position.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

Vec3 read_sun_by_place(const ConfigTable& sun) {
  const Place place{sun.number("latitude_deg", {-90, 90}), sun.number("longitude_deg", {-180, 180}),
                    sun.number_or("elevation_m", 0, {-500, 9000}),
                    sun.number_or("pressure_hpa", 1013.25, {0, 1100}),
                    sun.number_or("temperature_c", 10, {-90, 60})};
  return sun_position(place, parse_utc_time(sun.text("time"), sun.where("time"))).to_sun();
}

Vec3 read_to_sun(const ConfigTable& sun) {
  if (sun.has("latitude_deg") || sun.has("time")) {
    for (const char* key : {"zenith_deg", "azimuth_deg"})
      if (sun.has(key))
        throw_invalid(sun.where(key), "the sun is given by place and time as well",
                      "either latitude_deg, longitude_deg and time, or zenith_deg and azimuth_deg");
    return read_sun_by_place(sun);
  }
  return direction_from_azimuth_zenith(radians_from_degrees(sun.number("azimuth_deg", {-360, 360})),
                                       radians_from_degrees(sun.number("zenith_deg", {0, 180})));
}

void read_sky(const ConfigTable& sky, Illumination& light) {
  const std::string model = sky.choice("model", {"uniform", "standard_overcast", "perez"});
  light.sky = model == "uniform" ? SkyModel::kUniform
              : model == "perez" ? SkyModel::kPerez
                                 : SkyModel::kStandardOvercast;
  if (light.sky != SkyModel::kPerez) return;
  light.sky_clearness = sky.number("clearness", {1, 1000});
  light.sky_brightness = sky.number("brightness", {0, 1});
}

BandLight read_strengths(const ConfigTable& band, const Vec3& to_sun) {
  constexpr Range kStrength{0, 1e6};
  BandLight light;
  light.diffuse_horizontal_w_m2 = band.number_or("diffuse_horizontal_w_m2", 0, kStrength);
  if (band.has("direct_horizontal_w_m2")) {
    if (band.has("beam_normal_w_m2"))
      throw_invalid(band.where("beam_normal_w_m2"), "direct_horizontal_w_m2 is given as well",
                    "one of the two");
    const double horizontal = band.number("direct_horizontal_w_m2", kStrength);
    if (horizontal > 0 && to_sun.z < 1e-3)
      throw_invalid(band.where("direct_horizontal_w_m2"), "the sun is at or below the horizon",
                    "beam_normal_w_m2, or 0");
    light.beam_normal_w_m2 = horizontal > 0 ? horizontal / to_sun.z : 0.0;
  } else {
    light.beam_normal_w_m2 = band.number_or("beam_normal_w_m2", 0, kStrength);
  }
  return light;
}

OpticsOverride read_override(const ConfigTable& table) {
  constexpr Range kShare{0, 1};
  OpticsOverride o{table.text_or("material", "*"), table.text("band"), {}};
  LeafOptics& leaf = o.optics.leaf;
  const auto both = [&](const char* key, double& front, double& back) {
    const std::string name(key);
    if (table.has(name)) {
      front = back = table.number(name, kShare);
    } else {
      front = table.number(name + "_front", kShare);
      back = table.number(name + "_back", kShare);
    }
  };
  both("leaf_reflectance", leaf.reflectance_front, leaf.reflectance_back);
  both("leaf_transmittance", leaf.transmittance_front, leaf.transmittance_back);
  o.optics.bark_reflectance = table.number_or("bark_reflectance", 0, kShare);
  if (leaf.albedo_front() > 1 || leaf.albedo_back() > 1)
    throw_invalid(table.where("leaf_transmittance"), "leaf reflectance + transmittance is over 1",
                  "r + t <= 1");
  return o;
}

ReferenceOptions read_reference(const ConfigTable& table) {
  ReferenceOptions o;
  o.seed = static_cast<std::uint64_t>(table.integer_or("seed", 1, {0, 9e15}));
  o.rays_per_face = static_cast<int>(table.integer_or("rays_per_face", o.rays_per_face, {1, 65536}));
  o.sun_rays_per_element =
      static_cast<int>(table.integer_or("sun_rays_per_element", o.sun_rays_per_element, {1, 65536}));
  o.target_relative_error = table.number_or("target_relative_error", 0, {0, 1});
  o.max_rays_per_face =
      static_cast<int>(table.integer_or("max_rays_per_face", o.max_rays_per_face, {1, 65536}));
  o.ground_cell_m = table.number_or("ground_cell_m", 0, {0, 1e5});
  if (o.target_relative_error > 0 && o.max_rays_per_face < o.rays_per_face)
    throw_invalid(table.where("max_rays_per_face"), "is below rays_per_face", "at least as many");
  const double gib = table.number_or("memory_limit_gib", 8, {0.001, 4096});
  o.memory_limit_bytes = static_cast<std::uint64_t>(std::llround(gib * 1024.0 * 1024.0 * 1024.0));
  return o;
}

SppOptions read_spp(const ConfigTable& table) {
  SppOptions o;
  o.sample_directions =
      static_cast<int>(table.integer_or("sample_directions", o.sample_directions, {16, 22}));
  if (o.sample_directions != 16 && o.sample_directions != 22)
    throw_invalid(table.where("sample_directions"), "must be 16 or 22", "16 or 22");
  o.map_resolution = static_cast<int>(table.integer_or("map_resolution", o.map_resolution, {8, 1024}));
  o.grid_resolution = static_cast<int>(table.integer_or("grid_resolution", o.grid_resolution, {2, 64}));
  return o;
}

GridOptions read_grid(const ConfigTable& table) {
  GridOptions o;
  o.directions = static_cast<int>(table.integer_or("directions", o.directions, {8, 26}));
  if (o.directions != 8 && o.directions != 14 && o.directions != 26)
    throw_invalid(table.where("directions"), "there is no set of " + std::to_string(o.directions),
                  "8, 14 or 26");
  o.cell_m = table.number_or("cell_m", o.cell_m, {0, 1000});
  o.convergence = table.number_or("convergence", o.convergence, {1e-9, 1});
  o.max_iterations = static_cast<int>(table.integer_or("max_iterations", o.max_iterations, {1, 10000}));
  return o;
}

template <class Enum>
Enum one_of(const ConfigTable& table, const char* key, Enum fallback, const std::vector<Enum>& values) {
  std::vector<std::string> names;
  for (const Enum value : values) names.push_back(to_string(value));
  const std::string chosen = table.choice_or(key, to_string(fallback), names);
  for (const Enum value : values)
    if (to_string(value) == chosen) return value;
  return fallback;
}

EnvelopeFullOptions read_envelope_full(const ConfigTable& table) {
  EnvelopeFullOptions o;
  o.directions = static_cast<int>(table.integer_or("directions", o.directions, {8, 50}));
  o.sun = one_of(table, "sun", o.sun, {EnvelopeSun::kMarched, EnvelopeSun::kPublished});
  o.angles = one_of(table, "angles", o.angles, {EnvelopeAngles::kMeasured, EnvelopeAngles::kSpherical});
  o.bounces = one_of(table, "bounces", o.bounces,
                     {EnvelopeBounces::kAll, EnvelopeBounces::kOnce, EnvelopeBounces::kSunOnce});
  o.ground = one_of(table, "ground", o.ground, {EnvelopeGround::kShaded, EnvelopeGround::kFullyLit});
  o.weights = one_of(table, "weights", o.weights, {EnvelopeWeights::kCosine, EnvelopeWeights::kPlain});
  o.own_leaf = one_of(table, "own_leaf", o.own_leaf, {EnvelopeOwnLeaf::kRemoved, EnvelopeOwnLeaf::kKept});
  o.border = one_of(table, "border", o.border,
                    {EnvelopeBorder::kByScene, EnvelopeBorder::kRound, EnvelopeBorder::kLevel});
  o.cell_m = table.number_or("cell_m", 0, {0, 1000});
  check(o);
  return o;
}

LinksOptions read_links(const ConfigTable& table) {
  LinksOptions o;
  o.seed = static_cast<std::uint64_t>(table.integer_or("seed", 1, {0, 9e15}));
  o.links_per_face = static_cast<int>(table.integer_or("links_per_face", o.links_per_face, {16, 256}));
  o.convergence = table.number_or("convergence", o.convergence, {1e-9, 1});
  o.ground_cell_m = table.number_or("ground_cell_m", 0, {0, 1e5});
  return o;
}

WorldOptions read_world(const ConfigTable& table) {
  WorldOptions o;
  o.directions = static_cast<int>(table.integer_or("directions", o.directions, {8, 26}));
  o.cell_m = table.number_or("cell_m", o.cell_m, {0, 1000});
  return o;
}

// Trees by their numbers, or [] for all.
Selection read_selection(const ConfigTable& table) {
  Selection selection;
  for (const double id : table.numbers("trees", {0, 4294967295.0})) {
    const TreeId tree{static_cast<std::uint32_t>(id)};
    if (static_cast<double>(tree.value) != id)
      throw_invalid(table.where("trees"), "holds what is no whole number", "numbers of trees");
    selection.trees.push_back(tree);
  }
  selection.far_trees_share = table.number_or("far_trees_share", selection.far_trees_share, {0, 1});
  return selection;
}

SppMarchedOptions read_marched(const ConfigTable& table) {
  SppMarchedOptions o;
  o.phase = table.choice_or("phase", "leaf_angles", {"leaf_angles", "isotropic"}) == "isotropic"
                ? SppPhase::kIsotropic
                : SppPhase::kLeafAngles;
  o.paths = table.choice_or("paths", "true_boundary", {"true_boundary", "slab"}) == "slab"
                ? SppPaths::kSlab
                : SppPaths::kTrueBoundary;
  o.cell_m = table.number_or("cell_m", 0, {0, 1000});
  return o;
}

ProbePlan read_probes(const ConfigTable& table) {
  constexpr Range kRays{2, 65536};
  ProbePlan p;
  p.count = static_cast<int>(table.integer_or("count", p.count, {16, 1000000}));
  p.paths_per_face = static_cast<int>(table.integer_or("paths_per_face", p.paths_per_face, kRays));
  p.sun_rays = static_cast<int>(table.integer_or("sun_rays", p.sun_rays, kRays));
  p.seed = static_cast<std::uint64_t>(table.integer_or("seed", 1, {0, 9e15}));
  return p;
}

AutoOptions read_auto(const ConfigTable& table) {
  AutoOptions o;
  if (table.has("tolerance") && table.has("time_s"))
    throw_invalid(table.where("time_s"), "a tolerance is given as well",
                  "one of them: what the answer must be worth, or how long it may take");
  if (table.has("tolerance")) o.tolerance = table.number("tolerance", {1e-6, 1});
  if (table.has("time_s")) o.time_s = table.number("time_s", {1e-6, 1e7});
  o.measure =
      *auto_measure_from_string(table.choice_or("measure", to_string(o.measure), auto_measure_names()));
  o.layer_m = table.number_or("layer_m", o.layer_m, {1e-3, 1e6});
  o.layers = static_cast<int>(table.integer_or("layers", o.layers, {0, 10000}));
  return o;
}

}  // namespace

LightRequest read_light_request(const ConfigTable& table) {
  LightRequest request;
  request.method = method_from_string(table.text_or("method", "reference"), table.where("method"));
  request.skip =
      table.choice_or("skip", "auto", {"auto", "never"}) == "auto" ? Skipping::kAuto : Skipping::kNever;
  Illumination& light = request.light;
  if (const auto sun = table.table_if("sun")) {
    light.to_sun = read_to_sun(*sun);
    light.sun_half_angle_rad = radians_from_degrees(sun->number_or("half_angle_deg", 0.265, {0, 5}));
  }
  if (const auto sky = table.table_if("sky")) read_sky(*sky, light);
  for (const ConfigTable& band : table.tables("bands")) {
    request.optics.bands.push_back(band.text("name"));
    request.optics.soil_albedo.push_back(band.number_or("soil_albedo", 0.15, {0, 1}));
    light.bands.push_back(read_strengths(band, light.to_sun));
    if (light.bands.back().beam_normal_w_m2 > 0 && !table.has("sun"))
      throw_invalid(band.where("name"), "has sunlight, but the sun has no place", "a [light.sun] table");
  }
  if (light.bands.empty())
    throw_invalid(table.where("bands"), "no band is given", "at least one [[light.bands]] with a name");
  for (const ConfigTable& o : table.tables("optics")) request.optics.overrides.push_back(read_override(o));
  if (const auto knobs = table.table_if("reference")) request.reference = read_reference(*knobs);
  if (const auto knobs = table.table_if("spp")) request.spp = read_spp(*knobs);
  if (const auto knobs = table.table_if("envelope"))
    request.envelope.cell_m = knobs->number_or("cell_m", 0, {0, 1000});
  if (const auto knobs = table.table_if("spp_marched")) request.spp.marched = read_marched(*knobs);
  if (const auto knobs = table.table_if("envelope_full")) request.envelope_full = read_envelope_full(*knobs);
  if (const auto knobs = table.table_if("links")) request.links = read_links(*knobs);
  if (const auto knobs = table.table_if("world")) request.world = read_world(*knobs);
  if (table.has("trees")) request.selection = read_selection(table);
  if (const auto knobs = table.table_if("grid")) request.grid = read_grid(*knobs);
  if (const auto knobs = table.table_if("auto")) request.automatic = read_auto(*knobs);
  if (const auto knobs = table.table_if("probes")) request.probes = read_probes(*knobs);
  return request;
}

}  // namespace sunfleck
