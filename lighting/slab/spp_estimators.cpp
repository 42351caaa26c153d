// Puts depths, closed form and compensation together into a light map, in the stages of [SPP] Fig. 9:
// preprocess (depths of all cells in all sample directions), sky, sun, evaluate.
//
// Light on a leaf is direct (e^-depth of its own place in the sun's map), straight from the sky (the cell's
// transmission for each sample direction) and scattered (closed form; uniform in the hemisphere of the source
// and in the other one, so a face with cosine c to the source gets D (1 + c) / 4 + U (1 - c) / 4). With the
// compensation factor scattered light is multiplied by it, direct light is not ([SPP] Eq. 28, not
// section 5.3). single_scattering is I0 of the paper: leaves reflect and transmit what comes straight from
// sun and sky, and light scattered onto them is left out.
#include "lighting/slab/spp_estimators.h"

#include <cmath>
#include <cstdio>

#include "lighting/base/summaries.h"
#include "lighting/slab/sky_light.h"
#include "lighting/slab/sun_depths.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

void check_options(const SppOptions& o) {
  if (o.sample_directions != 16 && o.sample_directions != 22)
    throw_invalid("spp.sample_directions", "is " + std::to_string(o.sample_directions), "16 or 22");
  if (o.map_resolution < 8 || o.map_resolution > 1024)
    throw_invalid("spp.map_resolution", "is " + std::to_string(o.map_resolution), "8 to 1024 texels");
  if (o.grid_resolution < 2 || o.grid_resolution > 64)
    throw_invalid("spp.grid_resolution", "is " + std::to_string(o.grid_resolution), "2 to 64 cells");
}

std::string method_name(SppVariant variant) {
  switch (variant) {
    case SppVariant::kSingleScattering:
      return "single_scattering";
    case SppVariant::kSpp:
      return "spp";
    case SppVariant::kSppG:
      break;
  }
  return "spp_g";
}

std::string text_of(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

// Light of one source on the two faces of an element, per normal irradiance of the source.
struct FaceShares {
  double front = 0.25, back = 0.25;  // a needle's faces look everywhere alike
};

FaceShares face_shares(const Vec3& normal, bool needles, const Vec3& to_source) {
  if (needles) return {};
  const double c = glm::dot(normal, to_source);
  return {std::max(c, 0.0), std::max(-c, 0.0)};
}

// One call of spp_light_map.
class Estimate {
 public:
  Estimate(const Forest& forest, const OpticsTable& optics, const Illumination& light,
           const SppOptions& options, const RunControl& control)
      : forest_(forest),
        optics_(optics),
        light_(checked(light, optics.band_count())),
        options_(options),
        control_(control),
        index_(forest),
        media_(canopy_optics(forest, optics)) {
    for (const BandLight& band : light_.bands) has_sky_ = has_sky_ || band.diffuse_horizontal_w_m2 > 0.0;
    const double above_slope = glm::dot(light_.to_sun, forest.terrain.normal());
    has_sun_ = light_.sun_is_up() && above_slope > 0.0 && index_.element_count() > 0;
  }

  LightMap run() {
    map_.provenance.method = method_name(options_.variant);
    note_skips();
    preprocess();
    light_from_sky();
    light_from_sun();
    evaluate();
    note_settings();
    summarize(forest_, index_, optics_, map_);
    return std::move(map_);
  }

 private:
  bool is(SppVariant variant) const { return options_.variant == variant; }
  bool has_ground() const {
    for (std::size_t b = 0; b < optics_.band_count(); ++b)
      if (optics_.soil_albedo(b) > 0.0) return true;
    return false;
  }
  bool needs_cells() const { return has_sky_ || (has_sun_ && is(SppVariant::kSppG)); }

  void preprocess() {
    const StageTimer timer(map_.provenance, "preprocess");
    if (!needs_cells()) return;
    grids_ = make_forest_grids(forest_, options_.grid_resolution);
    const int resolution = std::min(options_.map_resolution, 2 * options_.grid_resolution);
    cells_ = measure_cell_depths(forest_, grids_, options_.sample_directions, resolution, control_);
    if (is(SppVariant::kSppG) && has_sky_) sky_compensation_ = sky_compensation(cells_, control_);
  }

  void light_from_sky() {
    const StageTimer timer(map_.provenance, "sky");
    sky_.resize(optics_.band_count());
    if (!has_sky_) return;
    sources_ = sky_sources(cells_.directions, light_.sky, forest_.terrain.normal());
    for (std::size_t b = 0; b < sky_.size(); ++b)
      if (light_.bands[b].diffuse_horizontal_w_m2 > 0.0 && !is(SppVariant::kSingleScattering))
        sky_[b] = scattered_sky_light(forest_, grids_, cells_, media_[b], optics_.soil_albedo(b), sources_,
                                      sky_compensation_, control_);
  }

  void light_from_sun() {
    const StageTimer timer(map_.provenance, "sun");
    if (!has_sun_) return;
    sun_ = measure_sun_depths(forest_, index_, light_.to_sun, options_.map_resolution, control_);
    if (is(SppVariant::kSppG))
      sun_compensation_ =
          sunfleck::sun_compensation(forest_, index_, grids_, cells_, sun_, light_.to_sun, control_);
  }

  void evaluate() {
    const StageTimer timer(map_.provenance, "evaluate");
    map_.sunlit_fraction.assign(index_.element_count(), 0.0f);
    for (const std::string& band : optics_.bands()) {
      BandLightMap& result = map_.bands.emplace_back();
      result.band = band;
      result.elements.resize(index_.element_count());
    }
    for_each_chunk(index_.element_count(), 1024, control_, "evaluate",
                   [&](std::size_t begin, std::size_t end) {
                     ForestIndex::Place place = index_.place(begin);
                     for (std::size_t e = begin; e < end; ++e, ++place.local) {
                       if (e >= index_.first_element(place.instance + 1)) place = index_.place(e);
                       evaluate_element(e, place);
                     }
                   });
  }

  void evaluate_element(std::size_t e, const ForestIndex::Place& place) {
    const Instance& instance = forest_.instances[place.instance];
    const FoliageElement& element = forest_.prototypes[instance.prototype.value].foliage[place.local];
    const bool needles = element.shape == ElementShape::kShoot;
    const Vec3 normal = needles ? Vec3(0.0) : world_direction_from_tree(instance, element_normal(element));
    std::size_t cell = 0;
    if (needs_cells())
      cell = grids_.first_cell[place.instance] +
             grids_.prototypes[instance.prototype.value].cell_of_element[place.local];
    const double sunlit = has_sun_ ? std::exp(-static_cast<double>(sun_.before[e])) : 0.0;
    map_.sunlit_fraction[e] = static_cast<float>(sunlit);
    const FaceShares sun_share = face_shares(normal, needles, light_.to_sun);
    const FaceShares sky_share = has_sky_ ? sky_on_faces(cell, normal, needles) : FaceShares{0, 0};
    for (std::size_t b = 0; b < map_.bands.size(); ++b) {
      ElementLight& light = map_.bands[b].elements[e];
      const BandLight& strength = light_.bands[b];
      add_straight(light, strength, sunlit, sun_share, sky_share);
      if (is(SppVariant::kSingleScattering)) continue;
      if (!sky_[b].empty()) add_scattered(light, sky_[b][cell], normal, strength.diffuse_horizontal_w_m2);
      if (has_sun_ && strength.beam_normal_w_m2 > 0.0)
        add_scattered(light, scattered_sunlight(e, place.instance, cell, b), normal,
                      strength.beam_normal_w_m2);
    }
  }

  // Straight from the sky, per diffuse horizontal irradiance.
  FaceShares sky_on_faces(std::size_t cell, const Vec3& normal, bool needles) const {
    FaceShares sum{0.0, 0.0};
    for (std::size_t j = 0; j < sources_.size(); ++j) {
      const double irradiance = sources_[j] * cells_.transmission[cell * sources_.size() + j];
      const FaceShares share = face_shares(normal, needles, cells_.directions.upward(j));
      sum.front += irradiance * share.front;
      sum.back += irradiance * share.back;
    }
    return sum;
  }

  static void add_straight(ElementLight& light, const BandLight& strength, double sunlit,
                           const FaceShares& sun, const FaceShares& sky) {
    light.front.direct_w_m2 = static_cast<float>(strength.beam_normal_w_m2 * sunlit * sun.front);
    light.back.direct_w_m2 = static_cast<float>(strength.beam_normal_w_m2 * sunlit * sun.back);
    light.front.sky_w_m2 = static_cast<float>(strength.diffuse_horizontal_w_m2 * sky.front);
    light.back.sky_w_m2 = static_cast<float>(strength.diffuse_horizontal_w_m2 * sky.back);
  }

  static void add_scattered(ElementLight& light, const ScatteredLight& scattered, const Vec3& normal,
                            double strength_w_m2) {
    light.front.scattered_w_m2 += static_cast<float>(strength_w_m2 * scattered.on_face(normal));
    light.back.scattered_w_m2 += static_cast<float>(strength_w_m2 * scattered.on_face(-normal));
  }

  // [SPP] Eq. 19 for the element's own depths, Eq. 28 for its cell.
  ScatteredLight scattered_sunlight(std::size_t e, std::size_t instance, std::size_t cell, std::size_t band) {
    const std::uint32_t prototype = forest_.instances[instance].prototype.value;
    const auto medium = media_[band][prototype].medium(sun_.turn_ratio[instance], optics_.soil_albedo(band));
    const SlabLight<double> slab = spp<double>(sun_.before[e], sun_.behind[e], medium);
    const double scale = sun_compensation_.empty() ? 1.0 : sun_compensation_[cell];
    ScatteredLight light;
    add_hemispheres(light, light_.to_sun, scale * slab.down, scale * slab.up);
    return light;
  }

  void note_skips() {
    if (!has_sky_) map_.provenance.skipped.push_back({"sky light", "no diffuse irradiance in any band", 0.0});
    if (!light_.sun_is_up())
      map_.provenance.skipped.push_back({"sunlight", "the sun is below the horizon", 0.0});
    else if (!has_sun_ && index_.element_count() > 0)
      map_.provenance.skipped.push_back({"sunlight", "the sun is behind the slope", 0.0});
  }

  void note_settings() {
    auto& settings = map_.provenance.settings;
    settings.emplace_back("sample_directions", std::to_string(options_.sample_directions));
    settings.emplace_back("grid_resolution_cells", std::to_string(options_.grid_resolution));
    settings.emplace_back("cells", std::to_string(needs_cells() ? grids_.cells() : 0));
    settings.emplace_back("map_resolution_texels", std::to_string(options_.map_resolution));
    if (has_sun_) {
      settings.emplace_back("sun_map_resolution_texels", std::to_string(sun_.map_resolution));
      settings.emplace_back("sun_map_texel_m", text_of(sun_.texel_m));
      settings.emplace_back("sun_maps", std::to_string(sun_.maps));
      settings.emplace_back("sun_yaw_step_rad", text_of(sun_.yaw_step_rad));
    }
    if ((has_sun_ && !sun_.complete) || (needs_cells() && !cells_.complete))
      map_.provenance.notes.push_back(
          "light from low directions: trees farther than 32 periods are left out");
    if (!is(SppVariant::kSingleScattering))
      map_.provenance.notes.push_back(
          "scattered light is that of a slab: expect tens of percent per leaf on isolated crowns");
    if (light_.sun_half_angle_rad > 0.0)
      map_.provenance.notes.push_back("the sun is taken as a point; maps blur its shadows by a texel");
    if (has_ground())
      map_.provenance.notes.push_back(
          is(SppVariant::kSppG)
              ? "ground light is part of the slab: compensation takes it away too where a crown stands alone"
              : "ground light is part of the slab: it arrives along the light's own axis, not from below");
  }

  const Forest& forest_;
  const OpticsTable& optics_;
  Illumination light_;
  const SppOptions& options_;
  const RunControl& control_;
  ForestIndex index_;
  std::vector<std::vector<CanopyOptics>> media_;  // [band][prototype]
  bool has_sky_ = false, has_sun_ = false;

  ForestGrids grids_;
  CellDepths cells_{SampleDirections(22, 0.0), {}, {}, {}, true};
  std::vector<float> sky_compensation_, sun_compensation_;  // empty: 1
  std::vector<double> sources_;
  std::vector<std::vector<ScatteredLight>> sky_;  // [band][cell]
  SunDepths sun_;
  LightMap map_;
};

}  // namespace

LightMap spp_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                       const SppOptions& options, const RunControl& control) {
  check_options(options);
  return Estimate(forest, optics, light, options, control).run();
}

}  // namespace sunfleck
