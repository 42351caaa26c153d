#include "lighting/bench/error_against_time.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <sstream>

#include "lighting/bench/machine.h"
#include "lighting/bench/stopwatch.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

// Stages that a change of sun, sky or band does not repeat, by the names the estimators give them.
bool is_setup(const std::string& stage) {
  static const std::set<std::string> kSetup = {"preprocess",     "building ray scene", "tracing rays",
                                               "leaf-area grid", "sector depths",      "tracing links"};
  return kSetup.contains(stage);
}

double setup_seconds(const LightMap& map) {
  double sum = 0;
  for (const StageTime& t : map.provenance.times)
    if (is_setup(t.stage)) sum += t.wall_s;
  return sum;
}

std::uint64_t counted_rays(const LightMap& map) {
  for (const auto& [name, value] : map.provenance.settings)
    if (name == "rays_traced") return std::stoull(value);
  return 0;
}

bool same_light(const LightMap& a, const LightMap& b) {
  for (std::size_t band = 0; band < a.bands.size(); ++band)
    if (std::memcmp(a.bands[band].elements.data(), b.bands[band].elements.data(),
                    a.bands[band].elements.size() * sizeof(ElementLight)) != 0)
      return false;
  return true;
}

struct Timed {
  LightMap map;
  double wall_s = 0, cpu_s = 0, setup_s = 0;
  std::uint64_t peak_bytes = 0;
};

Timed run_timed(const Forest& forest, const LightRequest& request, const BenchmarkPlan& plan,
                const RunControl& control) {
  std::vector<double> wall, cpu, setup;
  Timed timed;
  for (int i = 0; i < plan.repeats; ++i) {
    reset_peak_memory();
    const Stopwatch watch;
    LightMap map = compute_light_map(forest, request, plan.cost, control);
    wall.push_back(watch.wall_s());
    cpu.push_back(watch.cpu_s());
    setup.push_back(setup_seconds(map));
    timed.peak_bytes = std::max(timed.peak_bytes, peak_memory_bytes());
    if (i > 0 && !same_light(map, timed.map))
      throw ContractViolation(to_string(request.method) + " gave two answers to one question");
    timed.map = std::move(map);
  }
  timed.wall_s = median(wall);
  timed.cpu_s = median(cpu);
  timed.setup_s = median(setup);
  return timed;
}

// 5 standard errors: a false alarm in 2e6 honest rows.
void refuse_wrong_mean(const BandLightMap& estimate, const BandLightMap& truth, const std::string& method) {
  if (method != "reference") return;
  const double allowed = 5 * std::hypot(estimate.mean_irradiance_standard_error_w_m2,
                                        truth.mean_irradiance_standard_error_w_m2) +
                         0.01 * truth.mean_irradiance_w_m2;  // leaves taken as evenly lit
  if (std::fabs(estimate.mean_irradiance_w_m2 - truth.mean_irradiance_w_m2) > allowed)
    throw ContractViolation("the reference misses its own truth");
}

double truth_noise(const BandLightMap& truth) {
  double squares = 0;
  for (const float e : truth.standard_error_w_m2) squares += static_cast<double>(e) * e;
  return std::sqrt(squares / static_cast<double>(truth.standard_error_w_m2.size())) /
         truth.mean_irradiance_w_m2;
}

struct Truth {
  LightMap map;
  ErrorGroups groups;
};

void add_rows(const Forest& forest, const LightRequest& request, const std::string& knob, const Truth& truth,
              const BenchmarkPlan& plan, const RunControl& control, std::vector<BenchmarkRow>& rows) {
  const Timed timed = run_timed(forest, request, plan, control);
  for (std::size_t b = 0; b < truth.map.bands.size(); ++b) {
    const BandLightMap& band = truth.map.bands[b];
    BenchmarkRow row;
    row.scene = forest.name;
    row.band = band.band;
    row.method = to_string(request.method);
    row.knob = knob;
    row.elements = band.elements.size();
    row.instances = forest.instances.size();
    refuse_wrong_mean(timed.map.bands[b], band, row.method);
    row.error = compare(truth.groups, timed.map.bands[b], band);
    row.truth_noise = truth_noise(band);
    row.wall_s = timed.wall_s;
    row.cpu_s = timed.cpu_s;
    row.setup_s = timed.setup_s;
    row.rays = counted_rays(timed.map);
    row.peak_memory_bytes = timed.peak_bytes;
    row.seed = request.reference.seed;
    rows.push_back(row);
  }
}

struct BenchBand {
  const char* name;
  double soil_albedo;
  bool only_generated;  // species files have no numbers for it
  LeafOptics leaf;
};
constexpr BenchBand kBands[] = {{"VIS", 0.10, true, {.25, .25, .25, .25}},
                                {"PAR", 0.10, false, {.10, .10, .05, .05}},
                                {"NIR", 0.25, false, {.45, .45, .45, .45}},
                                {"WHITE", 0.25, true, {.50, .50, .50, .50}}};

bool is_asked(const BenchBand& band, const std::string& bands) {
  std::istringstream in(bands);
  for (std::string name; std::getline(in, name, ',');)
    if (name == band.name || name == "all") return true;
  return false;
}

}  // namespace

LightRequest bench_light(const Forest& forest, const std::string& bands) {
  LightRequest request;
  request.light.to_sun = direction_from_azimuth_zenith(radians_from_degrees(160), radians_from_degrees(35));
  const bool generated = forest.materials.size() == 1 && forest.materials[0].name == "leaf";
  for (const BenchBand& band : kBands) {
    if (!is_asked(band, bands) || (band.only_generated && !generated)) continue;
    request.optics.bands.push_back(band.name);
    request.optics.soil_albedo.push_back(band.soil_albedo);
    request.light.bands.push_back({400 / request.light.to_sun.z, 100});
    if (band.only_generated) request.optics.overrides.push_back({"*", band.name, {band.leaf, 0.3}});
  }
  if (request.light.bands.empty())
    throw_invalid("--bands", "there is no band '" + bands + "' for scene " + forest.name,
                  "PAR, NIR, for generated crowns also VIS and WHITE, or all");
  return request;
}

std::vector<BenchmarkRow> error_against_time(const Forest& forest, const LightRequest& request,
                                             const BenchmarkPlan& plan, std::vector<std::string>& refused,
                                             const RunControl& control) {
  LightRequest truth_request = request;
  truth_request.method = Method::kReference;
  truth_request.reference.seed = request.reference.seed + 1000;  // its noise is independent of the rows'
  truth_request.reference.rays_per_face = truth_request.reference.sun_rays_per_element = plan.truth_rays;
  const Truth truth{compute_light_map(forest, truth_request, {.threads = 0}, control),
                    error_groups(forest, request.light.to_sun, control)};
  std::vector<BenchmarkRow> rows;
  for (const MethodStep& step : plan.steps) {
    LightRequest asked = request;
    step.set(asked);
    try {
      add_rows(forest, asked, step.knob, truth, plan, control, rows);
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::kCancelled) throw;
      refused.push_back(forest.name + ", " + to_string(step.method) + " (" + step.knob +
                        "): " + error.what());
    }
  }
  return rows;
}

}  // namespace sunfleck
