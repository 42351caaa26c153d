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
#include <optional>

#include "lighting/base/summaries.h"
#include "lighting/slab/sky_light.h"
#include "lighting/slab/slab_rows.h"
#include "lighting/slab/spp_marched.h"
#include "lighting/slab/spp_prepare.h"
#include "lighting/slab/spp_suitability.h"
#include "lighting/slab/sun_depths.h"
#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

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

// Scattered sunlight of a band as fluences of two hemispheres per normal irradiance of the sun: of every
// element, for SPP-H of every cell.
struct SunResponse {
  std::vector<float> down, up;
};

// One call of spp_light_map.
class Estimate {
 public:
  Estimate(const Forest& forest, const OpticsTable& optics, const Illumination& light,
           const RunControl& control)
      : forest_(forest),
        optics_(optics),
        light_(checked(light, optics.band_count())),
        control_(control),
        index_(forest),
        media_(canopy_optics(forest, optics)) {
    for (const BandLight& band : light_.bands) has_sky_ = has_sky_ || band.diffuse_horizontal_w_m2 > 0.0;
    const double above_slope = glm::dot(light_.to_sun, forest.terrain.normal());
    has_sun_ = light_.sun_is_up() && above_slope > 0.0 && index_.element_count() > 0;
  }

  LightMap run(const SppOptions& options) {
    {
      const StageTimer timer(map_.provenance, "preprocess");
      own_ = prepare_spp_cells(forest_, options);
      const bool compensated = options.variant == SppVariant::kSppG;
      const bool marched = options.variant == SppVariant::kSppMarched;
      if (marched || has_sky_ || (has_sun_ && compensated)) prepare_spp_depths(forest_, *own_, control_);
      if (has_sky_ && compensated) prepare_spp_compensation(*own_, control_);
    }
    return run(*own_);
  }

  LightMap run(const SppPrepared& prepared) {
    prepared_ = &prepared;
    map_.provenance.method = method_name(variant());
    note_skips();
    light_from_sky();
    light_from_sun();
    evaluate();
    note_settings();
    note_limits();
    summarize(forest_, index_, optics_, map_);
    return std::move(map_);
  }

 private:
  SppVariant variant() const { return prepared_->options.variant; }
  bool is(SppVariant variant) const { return prepared_->options.variant == variant; }
  bool has_ground() const {
    for (std::size_t b = 0; b < optics_.band_count(); ++b)
      if (optics_.soil_albedo(b) > 0.0) return true;
    return false;
  }
  ResponseMedium medium_of(std::size_t band) const {
    return {media_[band], optics_.soil_albedo(band), is(SppVariant::kSppH) ? &prepared_->angles : nullptr};
  }

  void light_from_sky() {
    const StageTimer timer(map_.provenance, "sky");
    sky_.resize(optics_.band_count());
    if (!has_sky_) return;
    const CellDepths& cells = prepared_->cells;
    sources_ = sky_sources(cells.directions, sky_radiance(light_), forest_.terrain.normal());
    for (std::size_t b = 0; b < sky_.size(); ++b)
      if (light_.bands[b].diffuse_horizontal_w_m2 > 0.0 && !is(SppVariant::kSingleScattering))
        sky_[b] = scattered_sky_light(forest_, prepared_->grids, cells, medium_of(b), prepared_->compensation,
                                      sources_, control_);
  }

  void light_from_sun() {
    const StageTimer timer(map_.provenance, "sun");
    sun_response_.resize(optics_.band_count());
    refined_.resize(optics_.band_count());
    if (!has_sun_) return;
    if (is(SppVariant::kSppMarched)) return marched_light_from_sun();
    sun_ = measure_sun_depths(forest_, index_, light_.to_sun, prepared_->options.map_resolution, control_);
    CellSun cell_sun;
    if (is(SppVariant::kSppG) || is(SppVariant::kSppH))
      cell_sun = mean_over_cells(forest_, index_, prepared_->grids, sun_, control_);
    if (is(SppVariant::kSppG))
      sun_compensation_ = sunfleck::sun_compensation(prepared_->cells, cell_sun, light_.to_sun, control_);
    for (std::size_t b = 0; b < sun_response_.size(); ++b)
      if (light_.bands[b].beam_normal_w_m2 > 0.0 && !is(SppVariant::kSingleScattering))
        sun_response_[b] = is(SppVariant::kSppH) ? response_of_cells(b, cell_sun) : response_of_elements(b);
  }

  void marched_light_from_sun() {
    sun_ = march_sun_depths(forest_, *prepared_, light_.to_sun, control_);
    for (std::size_t b = 0; b < refined_.size(); ++b)
      if (light_.bands[b].beam_normal_w_m2 > 0.0)
        refined_[b] = refined_sunlight(forest_, *prepared_, sun_, light_.to_sun, media_[b],
                                       optics_.soil_albedo(b), control_);
  }

  // [SPP] Eq. 19 for the elements' own depths.
  SunResponse response_of_elements(std::size_t band) const {
    SunResponse response{std::vector<float>(sun_.before.size()), std::vector<float>(sun_.before.size())};
    for_each_chunk(forest_.instances.size(), 4, control_, {}, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::size_t first = index_.first_element(i), count = index_.first_element(i + 1) - first;
        const CanopyOptics& optics = media_[band][forest_.instances[i].prototype.value];
        spp_row(std::span(sun_.before).subspan(first, count), std::span(sun_.behind).subspan(first, count),
                row_medium(optics.medium(sun_.turn_ratio[i], optics_.soil_albedo(band))),
                std::span(response.down).subspan(first, count), std::span(response.up).subspan(first, count));
      }
    });
    return response;
  }

  SunResponse response_of_cells(std::size_t band, const CellSun& sun) const {
    SunResponse response{std::vector<float>(sun.before.size()), std::vector<float>(sun.before.size())};
    const CanopyOptics mean = forest_optics(forest_, media_[band]);
    const HemisphereMedium medium =
        prepared_->angles.medium(glm::dot(light_.to_sun, forest_.terrain.normal()), mean.absorption,
                                 mean.turn, optics_.soil_albedo(band));
    for_each_chunk(sun.before.size(), 4096, control_, {}, [&](std::size_t begin, std::size_t end) {
      const std::size_t count = end - begin;
      spp_h_row(std::span(sun.before).subspan(begin, count), std::span(sun.behind).subspan(begin, count),
                medium, std::span(response.down).subspan(begin, count),
                std::span(response.up).subspan(begin, count));
    });
    return response;
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
    const ForestGrids& grids = prepared_->grids;
    const std::size_t cell = grids.first_cell[place.instance] +
                             grids.prototypes[instance.prototype.value].cell_of_element[place.local];
    const double sunlit = has_sun_ ? std::exp(-static_cast<double>(sun_.before[e])) : 0.0;
    map_.sunlit_fraction[e] = static_cast<float>(sunlit);
    const FaceShares sun_share = face_shares(normal, needles, light_.to_sun);
    const FaceShares sky_share = has_sky_ ? sky_on_faces(cell, normal, needles) : FaceShares{0, 0};
    for (std::size_t b = 0; b < map_.bands.size(); ++b) {
      ElementLight& light = map_.bands[b].elements[e];
      const BandLight& strength = light_.bands[b];
      add_straight(light, strength, sunlit, sun_share, sky_share);
      if (!sky_[b].empty()) add_scattered(light, sky_[b].at(cell), normal, strength.diffuse_horizontal_w_m2);
      if (!sun_response_[b].down.empty())
        add_scattered(light, scattered_sunlight(e, cell, b), normal, strength.beam_normal_w_m2);
      if (!refined_[b].front.empty()) {
        light.front.scattered_w_m2 += static_cast<float>(strength.beam_normal_w_m2) * refined_[b].front[e];
        light.back.scattered_w_m2 += static_cast<float>(strength.beam_normal_w_m2) * refined_[b].back[e];
      }
    }
  }

  // Straight from the sky, per diffuse horizontal irradiance.
  FaceShares sky_on_faces(std::size_t cell, const Vec3& normal, bool needles) const {
    FaceShares sum{0.0, 0.0};
    for (std::size_t j = 0; j < sources_.size(); ++j) {
      const double irradiance = sources_[j] * prepared_->cells.transmissions(j)[cell];
      const FaceShares share = face_shares(normal, needles, prepared_->cells.directions.upward(j));
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

  // [SPP] Eq. 28 with the compensation of the element's cell.
  ScatteredLight scattered_sunlight(std::size_t e, std::size_t cell, std::size_t band) const {
    const SunResponse& response = sun_response_[band];
    const bool by_cell = is(SppVariant::kSppH);
    const std::size_t at = by_cell ? cell : e;
    double scale = sun_compensation_.empty() ? 1.0 : sun_compensation_[cell];
    if (by_cell) scale = prepared_->angles.fluence_scale(glm::dot(light_.to_sun, forest_.terrain.normal()));
    return of_hemispheres(by_cell ? forest_.terrain.normal() : light_.to_sun, scale * response.down[at],
                          scale * response.up[at]);
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
    const SppOptions& options = prepared_->options;
    settings.emplace_back("sample_directions", std::to_string(options.sample_directions));
    if (is(SppVariant::kSppMarched)) return note_marched();
    settings.emplace_back("grid_resolution_cells", std::to_string(options.grid_resolution));
    settings.emplace_back("cells", std::to_string(prepared_->cells.cells));
    settings.emplace_back("map_resolution_texels", std::to_string(options.map_resolution));
    if (!has_sun_) return;
    settings.emplace_back("sun_map_resolution_texels", std::to_string(sun_.map_resolution));
    settings.emplace_back("sun_map_texel_m", text_of(sun_.texel_m));
    settings.emplace_back("sun_maps", std::to_string(sun_.maps));
    settings.emplace_back("sun_yaw_step_rad", text_of(sun_.yaw_step_rad));
  }

  void note_marched() {
    auto& settings = map_.provenance.settings;
    const SppMarchedOptions& options = prepared_->options.marched;
    settings.emplace_back("phase", options.phase == SppPhase::kIsotropic ? "isotropic" : "leaf_angles");
    settings.emplace_back("paths", options.paths == SppPaths::kSlab ? "slab" : "true_boundary");
    if (has_sun_) settings.emplace_back("cell_m", text_of(sun_.texel_m));
  }

  void note_limits() {
    auto& notes = map_.provenance.notes;
    if ((has_sun_ && !sun_.complete) || !prepared_->cells.complete)
      notes.push_back("light from low directions: trees farther than 32 periods are left out");
    if (light_.sun_half_angle_rad > 0.0)
      notes.push_back("the sun is taken as a point; maps blur its shadows by a texel");
    if (is(SppVariant::kSppH)) {
      const SppHSuitability suitability = spp_h_suitability(forest_, prepared_->grids);
      map_.provenance.settings.emplace_back("open_side_share", text_of(suitability.open_side_share));
      map_.provenance.settings.emplace_back("crown_cover", text_of(suitability.crown_cover));
      if (!suitability.suitable()) notes.push_back("outside its range: " + suitability.reason());
    } else if (!is(SppVariant::kSingleScattering)) {
      notes.push_back(
          "scattered light is that of a slab: expect tens of percent per leaf on isolated crowns");
      if (has_ground())
        notes.push_back(
            is(SppVariant::kSppG)
                ? "ground light is part of the slab: compensation takes it away too where a crown stands "
                  "alone"
                : "ground light is part of the slab: it arrives along the light's own axis, not from below");
    }
  }

  const Forest& forest_;
  const OpticsTable& optics_;
  Illumination light_;
  const RunControl& control_;
  ForestIndex index_;
  std::vector<std::vector<CanopyOptics>> media_;  // [band][prototype]
  bool has_sky_ = false, has_sun_ = false;

  std::optional<SppPrepared> own_;  // of a call that prepares for itself
  const SppPrepared* prepared_ = nullptr;
  std::vector<double> sources_;
  std::vector<ScatteredCells> sky_;  // [band], empty: none
  SunDepths sun_;
  std::vector<float> sun_compensation_;  // empty: 1
  std::vector<SunResponse> sun_response_;
  std::vector<FaceResponse> refined_;  // spp_marched
  LightMap map_;
};

}  // namespace

LightMap spp_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                       const SppPrepared& prepared, const RunControl& control) {
  return Estimate(forest, optics, light, control).run(prepared);
}

LightMap spp_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                       const SppOptions& options, const RunControl& control) {
  check_options(options);
  return Estimate(forest, optics, light, control).run(options);
}

}  // namespace sunfleck
