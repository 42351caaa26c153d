// The grid method: leaf-area grid, direct sun, sky sweeps, then per band all bounces and the light of every
// element. Cell sizes under 1.5 leaf sides and plants of few leaves are where it stops being true: notes say
// so. Differences from the sheets' prototype: leaves scatter one by one instead of by a mean kernel, a cell
// passes light in two halves with its own source function, the rest of the series of bounces is added.
#include "lighting/transport/grid_estimator.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "lighting/base/summaries.h"
#include "lighting/transport/band_solver.h"
#include "lighting/transport/element_gather.h"
#include "lighting/transport/grid_notes.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/base/version.h"

namespace sunfleck {

namespace {

using namespace transport;

std::string number(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

void check_options(const GridOptions& o) {
  if (o.directions != 8 && o.directions != 14 && o.directions != 26)
    throw_invalid("grid.directions", std::to_string(o.directions) + " directions are not built",
                  "8, 14 or 26");
  if (!(o.cell_m >= 0.0 && std::isfinite(o.cell_m)))
    throw_invalid("grid.cell_m", "a cell cannot be " + number(o.cell_m) + " m",
                  "a length in metres, best 2 to 4 leaf sides, or 0 to have it chosen");
  if (!(o.convergence > 0.0 && o.convergence <= 0.5))
    throw_invalid("grid.convergence", number(o.convergence) + " is out of range",
                  "more than 0, at most 0.5; 0.002 is usual");
  if (o.max_iterations < 1 || o.max_iterations > 10000)
    throw_invalid("grid.max_iterations", std::to_string(o.max_iterations) + " is out of range", "1 to 10000");
}

class GridEstimate {
 public:
  GridEstimate(const Forest& forest, const OpticsTable& optics, Illumination light,
               const GridOptions& options, const RunControl& control)
      : forest_(forest),
        index_(forest),
        optics_(optics),
        light_(std::move(light)),
        options_(options),
        control_(control) {}

  LightMap run() {
    start();
    build_scene();
    light_directly();
    for (std::size_t b = 0; b < optics_.band_count(); ++b) fill_band(b);
    summarize(forest_, index_, optics_, map_);
    if (scene_.periodic)
      for (std::size_t b = 0; b < optics_.band_count(); ++b) complete_budget(b);
    state_settings();
    SUNFLECK_ENSURES(find_violation(map_, index_).empty());
    return std::move(map_);
  }

 private:
  void start() {
    map_.sunlit_fraction.resize(index_.element_count());
    for (const std::string& band : optics_.bands()) {
      BandLightMap& added = map_.bands.emplace_back();
      added.band = band;
      added.elements.resize(index_.element_count());
    }
    map_.provenance.method = "grid";
    map_.provenance.version = kVersion;
    map_.provenance.forest_hash = content_hash(forest_);
  }

  bool any(double BandLight::*strength) const {
    return std::ranges::any_of(light_.bands, [&](const BandLight& b) { return b.*strength > 0.0; });
  }

  void build_scene() {
    const StageTimer timer(map_.provenance, "leaf-area grid");
    control_.report("leaf-area grid", 0.0);
    scene_ = transport_scene(forest_, index_, light_, options_.directions, options_.cell_m, control_);
    control_.report("leaf-area grid", 1.0);
  }

  void light_directly() {
    if (light_.sun_is_up() && any(&BandLight::beam_normal_w_m2)) {
      const StageTimer timer(map_.provenance, "sun");
      sun_ = direct_sun(scene_, forest_, light_.to_sun, control_);
      map_.sunlit_fraction = sun_.sunlit_fraction;
      has_sun_ = true;
    } else {
      map_.provenance.skipped.push_back(
          {"direct sun",
           light_.sun_is_up() ? "no band has direct sunlight" : "the sun is not above the horizon", 0.0});
    }
    if (any(&BandLight::diffuse_horizontal_w_m2)) {
      const StageTimer timer(map_.provenance, "sky sweeps");
      sky_ = sky_radiance(scene_, control_);
      sky_on_elements_ = gather(scene_, sky_, {}, control_);
    } else {
      map_.provenance.skipped.push_back({"sky sweeps", "no band has diffuse light", 0.0});
      sky_.assign(scene_.set.count() * scene_.cells(), 0.0f);
      sky_on_elements_.resize(index_.element_count());
    }
  }

  void fill_band(std::size_t b) {
    const double bands = static_cast<double>(optics_.band_count());
    control_.report("sweeps", static_cast<double>(b) / bands);
    const double face_m2 = std::pow(scene_.field->layout().mean_cell_m(), 2);
    std::vector<LeafBand> leaf = leaf_bands(forest_, optics_, b);
    const LeafScattering leaves(scene_.contents, scene_.lanes, scene_.set.half(), face_m2, leaf,
                                mean_bark_reflectance(forest_, optics_, b));
    const BandProblem problem{.beam_w_m2 = has_sun_ ? light_.bands[b].beam_normal_w_m2 : 0.0,
                              .diffuse_w_m2 = light_.bands[b].diffuse_horizontal_w_m2,
                              .soil_albedo = optics_.soil_albedo(b),
                              .sky = &sky_,
                              .sun = has_sun_ ? &sun_ : nullptr};
    BandSolution solution;
    {
      const StageTimer timer(map_.provenance, "sweeps");
      solution =
          solve_band(scene_, leaves, problem, {options_.convergence, options_.max_iterations}, control_);
    }
    {
      const StageTimer timer(map_.provenance, "leaf gather");
      fill_elements(b, problem, leaf, gather(scene_, solution.scattered, solution.part_radiosity, control_));
    }
    if (scene_.periodic) start_budget(b, problem, leaves, solution);
    iterations_ = std::max(iterations_, solution.iterations);
    if (!solution.converged)
      map_.provenance.notes.push_back("band " + optics_.bands()[b] + " had not converged after " +
                                      std::to_string(solution.iterations) + " iterations");
    control_.report("sweeps", static_cast<double>(b + 1) / bands);
  }

  static FaceLight face(double direct, double sky, double scattered) {
    return {static_cast<float>(direct), static_cast<float>(sky), static_cast<float>(scattered)};
  }

  void fill_elements(std::size_t b, const BandProblem& problem, const std::vector<LeafBand>& leaf,
                     const std::vector<FacePair>& scattered) {
    std::vector<ElementLight>& elements = map_.bands[b].elements;
    for_each_chunk(elements.size(), 8192, control_, {}, [&](std::size_t begin, std::size_t end) {
      for (std::size_t e = begin; e < end; ++e) {
        const FacePair direct = has_sun_ ? sun_.elements[e] : FacePair{};
        elements[e].front = face(problem.beam_w_m2 * direct.front,
                                 problem.diffuse_w_m2 * sky_on_elements_[e].front, scattered[e].front);
        elements[e].back = face(problem.beam_w_m2 * direct.back,
                                problem.diffuse_w_m2 * sky_on_elements_[e].back, scattered[e].back);
        if (scene_.field->elements()[e].is_shoot()) add_light_inside_shoot(e, leaf, elements[e]);
      }
    });
  }

  // Needles of a shoot light each other.
  void add_light_inside_shoot(std::size_t e, const std::vector<LeafBand>& leaf, ElementLight& light) const {
    const CellContents& contents = scene_.contents;
    if (contents.first_part_of_element[e] == contents.first_part_of_element[e + 1]) return;
    const LeafPart& part = contents.parts[contents.parts_of_element[contents.first_part_of_element[e]]];
    const float gain = shoot_gain(leaf[part.optics].albedo, contents.shoots[part.shoot - 1].escape) - 1.0f;
    const float inside = gain * 0.5f * (light.front.total() + light.back.total());
    light.front.scattered_w_m2 += inside;
    light.back.scattered_w_m2 += inside;
  }

  // A period is closed but for the sky: what the parts of the estimate do not agree on is the residual.
  void start_budget(std::size_t b, const BandProblem& problem, const LeafScattering& leaves,
                    const BandSolution& solution) {
    EnergyBudget& budget = map_.bands[b].budget;
    const double area = scene_.ground->cell_area_m2();
    const double cells = static_cast<double>(scene_.ground->count());
    budget.incident_w = area * cells *
                        (problem.diffuse_w_m2 * scene_.sectors.open_ground_irradiance +
                         problem.beam_w_m2 * (has_sun_ ? sun_.open_ground : 0.0));
    for (const float e : solution.ground_irradiance)
      budget.absorbed_ground_w += area * (1.0 - problem.soil_albedo) * e;
    const double bark = mean_bark_reflectance(forest_, optics_, b);
    for (std::size_t w = 0; w < solution.wood_radiance.size(); ++w)
      budget.absorbed_wood_w += (1.0 - bark) * leaves.wood_intake_m2_sr(w) * solution.wood_radiance[w];
    budget.escaped_w = area * upwards_at_top(solution.scattered);
  }

  // Sum of the upward irradiance over the cells of the top layer.
  double upwards_at_top(const std::vector<float>& radiance) const {
    const std::size_t cells = scene_.cells(), top = cells - scene_.ground->count(), half = scene_.set.half();
    double sum = 0.0;
    for (std::size_t d = 0; d < scene_.set.count(); ++d) {
      const double weight = scene_.sectors.ground_weight_sr[d];
      const std::size_t upwards = (d + half) % scene_.set.count();
      for (std::size_t c = top; c < cells && weight > 0.0; ++c) sum += weight * radiance[upwards * cells + c];
    }
    return sum;
  }

  void complete_budget(std::size_t b) {
    EnergyBudget& budget = map_.bands[b].budget;
    for (const TreeLight& tree : map_.bands[b].trees) budget.absorbed_foliage_w += tree.absorbed_w;
    budget.residual_w = budget.incident_w - budget.absorbed_foliage_w - budget.absorbed_wood_w -
                        budget.absorbed_ground_w - budget.escaped_w;
    map_.bands[b].has_budget = true;
  }

  void state_settings() {
    Provenance& p = map_.provenance;
    p.settings = {{"directions", std::to_string(scene_.set.count())},
                  {"cell_m", number(scene_.field->layout().mean_cell_m())},
                  {"cells", std::to_string(scene_.cells())},
                  {"convergence", number(options_.convergence)},
                  {"iterations", std::to_string(iterations_)}};
    const auto notes = grid_notes(forest_, scene_);
    p.notes.insert(p.notes.end(), notes.begin(), notes.end());
  }

  const Forest& forest_;
  const ForestIndex index_;
  const OpticsTable& optics_;
  const Illumination light_;
  const GridOptions& options_;
  const RunControl& control_;
  TransportScene scene_;
  bool has_sun_ = false;
  DirectSun sun_;
  std::vector<float> sky_;
  std::vector<FacePair> sky_on_elements_;
  int iterations_ = 0;
  LightMap map_;
};

}  // namespace

LightMap grid_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                        const GridOptions& options, const RunControl& control) {
  check_options(options);
  validate(forest);
  if (ForestIndex(forest).element_count() == 0)
    throw_invalid("forest", "it has no foliage element, so there is nothing to compute light for",
                  "give a forest with at least one tree that has leaves or shoots");
  return GridEstimate(forest, optics, checked(light, optics.band_count()), options, control).run();
}

}  // namespace sunfleck
