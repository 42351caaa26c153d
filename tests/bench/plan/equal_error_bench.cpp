// `auto` against `reference` at the same measured error, on one core: CPU times of both and their ratio, per
// scene. Both errors (RMS over leaves, worst band) are measured by the same probes, many more than `auto`
// draws for itself and other ones; the reference's rays are chosen so that its error is that of the answer of
// `auto`, to a few percent. Times: medians of repeated whole calls, nothing kept between them.
//
//   equal_error_bench [scenes [bands [tolerance [repeats]]]]
//
// scenes: names of named_forest.h, separated by commas; bands: PAR, NIR, or both separated by a comma.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>

#include "lighting/bench/error_against_time.h"
#include "lighting/bench/stopwatch.h"
#include "lighting/plan/auto_probe.h"
#include "tests/bench/plan/named_forest.h"

namespace sunfleck {
namespace {

constexpr ProbePlan kJudges{.count = 4000, .paths_per_face = 128, .sun_rays = 256, .seed = 424242};
constexpr int kMostRays = 1024;

// Of leaves in the worst band, relative; and its standard error.
struct Measured {
  double error = 0, uncertainty = 0;
};

class Judges {
 public:
  Judges(const Forest& forest, const LightRequest& request)
      : probes_(draw_probes(ProbeScene(forest, request.reference.ground, {}),
                            OpticsTable(forest, request.optics),
                            checked(request.light, request.light.bands.size()), kJudges, {})) {}

  Measured measure(const LightMap& map) const {
    Measured worst;
    for (std::size_t b = 0; b < map.bands.size(); ++b) {
      const PointError e = point_error(sample_error(probes_, map.bands[b], b));
      // resolution is 1.96 standard errors of the square, rooted.
      const double square_error = e.resolution * e.resolution / 1.96;
      if (e.element_rms >= worst.error) worst = {e.element_rms, 0.5 * square_error / e.element_rms};
    }
    return worst;
  }

  // Root mean square errors of direct and of diffuse light, in shares of the total mean.
  std::pair<double, double> parts(const LightMap& map, std::size_t b) const {
    double direct = 0, diffuse = 0, mean = 0;
    for (const ProbeLight& p : probes_.probes) {
      const ProbeBand& truth = p.bands[b];
      const LightParts t = parts_of(truth), e = parts_of(map.bands[b].elements[p.element]);
      direct += std::pow(e.direct_w_m2 - t.direct_w_m2, 2) - truth.direct_variance_w2_m4;
      diffuse += std::pow(e.diffuse() - t.diffuse(), 2) - truth.diffuse_variance_w2_m4;
      mean += t.total();
    }
    const auto n = static_cast<double>(probes_.probes.size());
    return {std::sqrt(std::max(0.0, direct / n)) / (mean / n),
            std::sqrt(std::max(0.0, diffuse / n)) / (mean / n)};
  }

 private:
  ProbeSet probes_;
};

struct Timed {
  LightMap map;
  double cpu_s = 0;
};

Timed run(const Forest& forest, const LightRequest& request, int repeats) {
  Timed timed;
  std::vector<double> cpu;
  for (int i = 0; i < repeats; ++i) {
    const Stopwatch watch;
    timed.map = compute_light_map(forest, request, {.threads = 1}, {});
    cpu.push_back(watch.cpu_s());
  }
  timed.cpu_s = median(cpu);
  return timed;
}

LightRequest with_rays(LightRequest request, int rays) {
  request.method = Method::kReference;
  request.reference.rays_per_face = request.reference.sun_rays_per_element = rays;
  return request;
}

// By the power law through the last two trials, the first with the usual exponent.
int rays_for(const Forest& forest, const LightRequest& request, const Judges& judges, double error) {
  double rays = 32, exponent = 0.6, last_rays = 0, last_error = 0;
  for (int trial = 0; trial < 4; ++trial) {
    const double found = judges.measure(run(forest, with_rays(request, static_cast<int>(rays)), 1).map).error;
    if (last_rays > 0.0 && std::abs(std::log(rays / last_rays)) > 0.1)
      exponent = std::clamp(std::log(last_error / found) / std::log(rays / last_rays), 0.3, 1.0);
    if (std::abs(found / error - 1.0) < 0.02) break;
    last_rays = rays;
    last_error = found;
    rays = std::clamp(std::round(rays * std::pow(found / error, 1.0 / exponent)), 2.0,
                      static_cast<double>(kMostRays));
    if (rays == last_rays) break;
  }
  return static_cast<int>(rays);
}

std::string setting(const LightMap& map, const std::string& key) {
  for (const auto& [name, value] : map.provenance.settings)
    if (name == key) return value;
  return "-";
}

void print_details(const LightMap& map, const Judges& judges) {
  std::printf("    tried %s\n", setting(map, "tried_methods").c_str());
  for (std::size_t b = 0; b < map.bands.size(); ++b) {
    const auto [direct, diffuse] = judges.parts(map, b);
    std::printf("    %s: said %s; direct light %.4f, diffuse %.4f; %s\n", map.bands[b].band.c_str(),
                setting(map, "measured_element_rms." + map.bands[b].band).c_str(), direct, diffuse,
                setting(map, "correction." + map.bands[b].band).c_str());
  }
  std::printf("   ");
  for (const StageTime& t : map.provenance.times) std::printf(" %s %.4f;", t.stage.c_str(), t.cpu_s);
  std::printf("\n");
}

void compare(const Forest& forest, LightRequest request, double tolerance, int repeats) {
  const Judges judges(forest, request);
  LightRequest automatic = request;
  automatic.method = Method::kAuto;
  automatic.automatic.tolerance = tolerance;
  const Timed cheap = run(forest, automatic, repeats);
  const Measured error = judges.measure(cheap.map);
  std::printf("%-10s %7zu leaves: auto %.3f s, error %.4f +- %.4f\n", forest.name.c_str(),
              cheap.map.sunlit_fraction.size(), cheap.cpu_s, error.error, error.uncertainty);
  print_details(cheap.map, judges);
  std::fflush(stdout);
  if (repeats < 3) return;
  const int rays = rays_for(forest, request, judges, error.error);
  const Timed traced = run(forest, with_rays(request, rays), repeats);
  const Measured same = judges.measure(traced.map);
  std::printf("    reference of %d rays %.3f s, error %.4f +- %.4f: auto is %.1f times cheaper\n", rays,
              traced.cpu_s, same.error, same.uncertainty, traced.cpu_s / cheap.cpu_s);
  std::fflush(stdout);
}

}  // namespace
}  // namespace sunfleck

int main(int count, char** words) {
  using namespace sunfleck;
  const auto word = [&](int i, const char* usual) { return std::string(count > i ? words[i] : usual); };
  const double tolerance = std::stod(word(3, "0.10"));
  const int repeats = std::stoi(word(4, "5"));
  std::istringstream names(word(1, "sphere,clumped,stand,beech"));
  std::printf("tolerance %.2f, %s, CPU seconds of one core, medians of %d; repeats below 3: no reference\n",
              tolerance, word(2, "PAR").c_str(), repeats);
  for (std::string name; std::getline(names, name, ',');) {
    const Forest forest = named_forest(name);
    compare(forest, bench_light(forest, word(2, "PAR")), tolerance, repeats);
  }
  return 0;
}
