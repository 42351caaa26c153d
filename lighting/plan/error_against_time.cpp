#include "lighting/plan/error_against_time.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "sim/base/contract.h"

namespace sunfleck {
namespace {

constexpr int kCellsPerAxis = 4;

double total(const ElementLight& light) {
  return static_cast<double>(light.front.total()) + light.back.total();
}

double diffuse(const ElementLight& light) {
  return static_cast<double>(light.front.sky_w_m2) + light.front.scattered_w_m2 + light.back.sky_w_m2 +
         light.back.scattered_w_m2;
}

double mean_square(const std::vector<float>& values) {
  double sum = 0.0;
  for (const float v : values) sum += static_cast<double>(v) * v;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

// The cell of the scene's box an element's centre lies in.
std::vector<std::size_t> cells_of_elements(const Forest& forest) {
  const ForestIndex index(forest);
  const Box box = forest_bounds(forest);
  std::vector<std::size_t> cells(index.element_count());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto place = index.place(i);
    const Vec3 share = (world_element(forest, place.instance, place.local).centre_m - box.lo) /
                       glm::max(box.size(), Vec3(1e-300));
    std::size_t cell = 0;
    for (int axis = 0; axis < 3; ++axis)
      cell = cell * kCellsPerAxis + static_cast<std::size_t>(std::clamp(
                                        static_cast<int>(share[axis] * kCellsPerAxis), 0, kCellsPerAxis - 1));
    cells[i] = cell;
  }
  return cells;
}

// RMS of the cell means' difference, cells weighted by their elements, relative to the truth's mean.
double cell_rms(const Forest& forest, const BandLightMap& estimate, const BandLightMap& truth,
                double truth_mean) {
  constexpr std::size_t kCells = kCellsPerAxis * kCellsPerAxis * kCellsPerAxis;
  std::array<double, kCells> difference{}, count{};
  const std::vector<std::size_t> cells = cells_of_elements(forest);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    difference[cells[i]] += total(estimate.elements[i]) - total(truth.elements[i]);
    count[cells[i]] += 1.0;
  }
  double sum = 0.0;
  for (std::size_t c = 0; c < kCells; ++c)
    if (count[c] > 0) sum += difference[c] * difference[c] / count[c];
  return std::sqrt(sum / static_cast<double>(cells.size())) / truth_mean;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

struct Timed {
  LightMap map;
  double wall_s = 0, cpu_s = 0, setup_s = 0;
};

bool is_setup(const std::string& stage) {
  static const std::set<std::string> kSetup = {"preprocess", "building ray scene", "tracing rays",
                                               "leaf-area grid", "sector depths"};
  return kSetup.contains(stage);
}

Timed run_timed(const Forest& forest, const LightRequest& request, const BenchmarkPlan& plan,
                const RunControl& control) {
  std::vector<double> wall, cpu, setup;
  Timed timed;
  for (int i = 0; i < plan.repeats; ++i) {
    timed.map = compute_light_map(forest, request, plan.cost, control);
    double wall_s = 0, cpu_s = 0, setup_s = 0;
    for (const StageTime& t : timed.map.provenance.times) {
      wall_s += t.wall_s;
      cpu_s += t.cpu_s;
      if (is_setup(t.stage)) setup_s += t.wall_s;
    }
    wall.push_back(wall_s);
    cpu.push_back(cpu_s);
    setup.push_back(setup_s);
  }
  timed.wall_s = median(wall);
  timed.cpu_s = median(cpu);
  timed.setup_s = median(setup);
  return timed;
}

void add_rows(const Forest& forest, const LightRequest& request, const std::string& knob,
              const LightMap& truth, const BenchmarkPlan& plan, const RunControl& control,
              std::vector<BenchmarkRow>& rows) {
  const Timed timed = run_timed(forest, request, plan, control);
  for (std::size_t b = 0; b < truth.bands.size(); ++b) {
    BenchmarkRow row;
    row.scene = forest.name;
    row.band = truth.bands[b].band;
    row.method = to_string(request.method);
    row.knob = knob;
    row.elements = truth.bands[b].elements.size();
    row.error = compare(forest, timed.map.bands[b], truth.bands[b]);
    row.truth_noise =
        std::sqrt(mean_square(truth.bands[b].standard_error_w_m2)) / truth.bands[b].mean_irradiance_w_m2;
    row.wall_s = timed.wall_s;
    row.cpu_s = timed.cpu_s;
    row.setup_s = timed.setup_s;
    rows.push_back(row);
  }
}

}  // namespace

ErrorFigures compare(const Forest& forest, const BandLightMap& estimate, const BandLightMap& truth) {
  SUNFLECK_EXPECTS(estimate.elements.size() == truth.elements.size() && !truth.elements.empty());
  const double n = static_cast<double>(truth.elements.size());
  double mean = 0, diffuse_mean = 0, bias = 0, squares = 0, diffuse_squares = 0;
  for (std::size_t i = 0; i < truth.elements.size(); ++i) {
    const double d = total(estimate.elements[i]) - total(truth.elements[i]);
    const double dd = diffuse(estimate.elements[i]) - diffuse(truth.elements[i]);
    mean += total(truth.elements[i]) / n;
    diffuse_mean += diffuse(truth.elements[i]) / n;
    bias += d / n;
    squares += d * d / n;
    diffuse_squares += dd * dd / n;
  }
  SUNFLECK_EXPECTS(mean > 0.0);
  // The truth's own variance adds to every square: take it out. Of the diffuse part it is at most the whole
  // variance.
  const double noise = mean_square(truth.standard_error_w_m2);
  ErrorFigures figures;
  figures.bias = bias / mean;
  figures.element_rms = std::sqrt(std::max(0.0, squares - noise)) / mean;
  figures.cell_rms = cell_rms(forest, estimate, truth, mean);
  figures.scattered_rms = diffuse_mean > 0 ? std::sqrt(diffuse_squares) / diffuse_mean : 0.0;
  return figures;
}

std::vector<BenchmarkRow> error_against_time(const Forest& forest, const LightRequest& request,
                                             const BenchmarkPlan& plan, const RunControl& control) {
  LightRequest truth_request = request;
  truth_request.method = Method::kReference;
  truth_request.reference.seed = request.reference.seed + 1000;  // its noise is independent of the rows'
  truth_request.reference.rays_per_face = truth_request.reference.sun_rays_per_element = plan.truth_rays;
  const LightMap truth = compute_light_map(forest, truth_request, {.threads = 0}, control);
  std::vector<BenchmarkRow> rows;
  for (const Method method : plan.methods) {
    LightRequest asked = request;
    asked.method = method;
    add_rows(forest, asked, "default", truth, plan, control, rows);
  }
  for (const int rays : {4, 16, 64}) {
    LightRequest asked = truth_request;
    asked.reference.seed = request.reference.seed;
    asked.reference.rays_per_face = asked.reference.sun_rays_per_element = rays;
    add_rows(forest, asked, std::to_string(rays) + " rays", truth, plan, control, rows);
  }
  return rows;
}

}  // namespace sunfleck
