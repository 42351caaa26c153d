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
#include "lighting/transport/grid_limits.h"
#include "lighting/transport/grid_parts.h"
#include "sim/base/contract.h"
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

class GridEstimate {
 public:
  GridEstimate(const Forest& forest, const OpticsTable& optics, Illumination light,
               const GridOptions& options, const GridPrepared& prepared, const GridSources& sources,
               const RunControl& control)
      : forest_(forest),
        index_(forest),
        optics_(optics),
        light_(std::move(light)),
        options_(options),
        prepared_(prepared),
        scene_(*prepared.scene),
        sun_(sources.sun ? &sources.sun->light : nullptr),
        sun_is_given_(sources.sun && sources.sun->given),
        sky_(*sources.sky),
        control_(control) {
    SUNFLECK_EXPECTS(scene_.field->elements().size() == index_.element_count());
    SUNFLECK_EXPECTS(!sources.sun || sources.sun->to_sun == light_.to_sun);
    SUNFLECK_EXPECTS(sky_.key == sky_key(light_));
  }

  LightMap run() {
    start();
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
    map_.sunlit_fraction =
        sun_ != nullptr ? sun_->sunlit_fraction : std::vector<float>(index_.element_count());
    for (const std::string& band : optics_.bands()) {
      BandLightMap& added = map_.bands.emplace_back();
      added.band = band;
      added.elements.resize(index_.element_count());
    }
    map_.provenance.method = "grid";
    map_.provenance.version = kVersion;
    map_.provenance.forest_hash = prepared_.forest_hash;
    if (sun_ == nullptr)
      map_.provenance.skipped.push_back(
          {"direct sun",
           light_.sun_is_up() ? "no band has direct sunlight" : "the sun is not above the horizon", 0.0});
    if (std::ranges::none_of(light_.bands, [](const BandLight& b) { return b.diffuse_horizontal_w_m2 > 0; }))
      map_.provenance.skipped.push_back({"sky sweeps", "no band has diffuse light", 0.0});
  }

  void fill_band(std::size_t b) {
    const double bands = static_cast<double>(optics_.band_count());
    control_.report("sweeps", static_cast<double>(b) / bands);
    const double face_m2 = std::pow(scene_.layout.mean_cell_m(), 2);
    std::vector<LeafBand> leaf = leaf_bands(forest_, optics_, b);
    const LeafScattering leaves(scene_.contents, scene_.lanes, scene_.set.half(), face_m2, leaf,
                                mean_bark_reflectance(forest_, optics_, b));
    const BandProblem problem{
        .beam_w_m2 = sun_ != nullptr ? light_.bands[b].beam_normal_w_m2 : 0.0,
        .diffuse_w_m2 = light_.bands[b].diffuse_horizontal_w_m2,
        .soil_albedo = optics_.soil_albedo(b),
        .sectors = &sky_.sectors,
        .sky = &sky_.radiance,
        .sun = sun_,
        .scattered_from = scene_.periodic || sun_is_given_ ? CellValue::kMean : CellValue::kMiddle};
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
        const FacePair direct = sun_ != nullptr ? sun_->elements[e] : FacePair{};
        elements[e].front = face(problem.beam_w_m2 * direct.front,
                                 problem.diffuse_w_m2 * sky_.on_elements[e].front, scattered[e].front);
        elements[e].back = face(problem.beam_w_m2 * direct.back,
                                problem.diffuse_w_m2 * sky_.on_elements[e].back, scattered[e].back);
        if (scene_.field->elements()[e].is_shoot())
          add_light_inside_shoot(scene_.contents, e, leaf, elements[e]);
      }
    });
  }

  // A period is closed but for the sky: what the parts of the estimate do not agree on is the residual.
  void start_budget(std::size_t b, const BandProblem& problem, const LeafScattering& leaves,
                    const BandSolution& solution) {
    EnergyBudget& budget = map_.bands[b].budget;
    const double area = scene_.ground->cell_area_m2();
    const double cells = static_cast<double>(scene_.ground->count());
    budget.incident_w = area * cells *
                        (problem.diffuse_w_m2 * sky_.sectors.open_ground_irradiance +
                         problem.beam_w_m2 * (sun_ != nullptr ? sun_->open_ground : 0.0));
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
      const double weight = sky_.sectors.ground_weight_sr[d];
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
                  {"cell_m", number(scene_.layout.mean_cell_m())},
                  {"cells", std::to_string(scene_.cells())},
                  {"direct_sun", sun_is_given_ ? "given" : "marched"},
                  {"convergence", number(options_.convergence)},
                  {"iterations", std::to_string(iterations_)}};
    p.notes.insert(p.notes.end(), prepared_.notes.begin(), prepared_.notes.end());
  }

  const Forest& forest_;
  const ForestIndex index_;
  const OpticsTable& optics_;
  const Illumination light_;
  const GridOptions& options_;
  const GridPrepared& prepared_;
  const TransportScene& scene_;
  const DirectSun* const sun_;
  const bool sun_is_given_;
  const GridSky& sky_;
  const RunControl& control_;
  int iterations_ = 0;
  LightMap map_;
};

}  // namespace

LightMap grid_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                        const GridOptions& options, const GridPrepared& prepared, const GridSources& sources,
                        const RunControl& control) {
  check_grid_options(options);
  SUNFLECK_EXPECTS(prepared.scene != nullptr && sources.sky != nullptr);
  return GridEstimate(forest, optics, checked(light, optics.band_count()), options, prepared, sources,
                      control)
      .run();
}

LightMap grid_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                        const GridOptions& options, const GridPrepared& prepared, const RunControl& control) {
  Provenance provenance;
  GridSources sources;
  const Illumination good = checked(light, optics.band_count());
  {
    const StageTimer timer(provenance, "sun and sky");
    sources = grid_sources(forest, good, prepared, {}, control);
  }
  LightMap map = grid_light_map(forest, optics, good, options, prepared, sources, control);
  map.provenance.times.insert(map.provenance.times.begin(), provenance.times.begin(), provenance.times.end());
  return map;
}

LightMap grid_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                        const GridOptions& options, const RunControl& control) {
  const Illumination good = checked(light, optics.band_count());
  const GridPrepared prepared = prepare_grid(forest, options, control);
  LightMap map = grid_light_map(forest, optics, good, options, prepared, control);
  map.provenance.times.insert(map.provenance.times.begin(), prepared.times.begin(), prepared.times.end());
  return map;
}

}  // namespace sunfleck
