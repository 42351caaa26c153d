// Is what `auto` says of its own answer true: over seeds of its probes, how often its 95 % intervals hold the
// error that 6,000 other probes find, how often that error is within the tolerance, what it cost.
//
//   auto_honesty_bench [scenes [bands [seeds [tolerance]]]]
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>

#include "lighting/bench/error_against_time.h"
#include "lighting/bench/stopwatch.h"
#include "lighting/plan/auto_probe.h"
#include "lighting/plan/light_session.h"
#include "tests/bench/plan/named_forest.h"

namespace sunfleck {
namespace {

constexpr ProbePlan kJudges{.count = 6000, .paths_per_face = 64, .sun_rays = 128, .seed = 31337};

struct Said {
  double value = 0, low = 0, high = 0;
};

Said said(const LightMap& map, const std::string& key) {
  Said s;
  for (const auto& [name, value] : map.provenance.settings)
    if (name == key) std::sscanf(value.c_str(), "%lf [%lf, %lf]", &s.value, &s.low, &s.high);
  return s;
}

std::string setting(const LightMap& map, const std::string& key) {
  for (const auto& [name, value] : map.provenance.settings)
    if (name == key) return value;
  return "-";
}

// The probes that `auto` chose for itself; a second look took four times as many.
ProbePlan own_plan(const LightMap& map) {
  ProbePlan plan;
  const int looks = setting(map, "tried_methods").find("again") == std::string::npos ? 1 : 4;
  plan.count = std::stoi(setting(map, "probes")) / looks;
  plan.paths_per_face = std::stoi(setting(map, "probe_paths_per_face"));
  plan.sun_rays = std::stoi(setting(map, "probe_sun_rays"));
  return plan;
}

void count(const Forest& forest, LightRequest request, int seeds, double tolerance) {
  const OpticsTable optics(forest, request.optics);
  const Illumination light = checked(request.light, request.light.bands.size());
  const ProbeSet judges =
      draw_probes(ProbeScene(forest, request.reference.ground, {}), optics, light, kJudges, {});
  request.method = Method::kAuto;
  request.automatic.tolerance = tolerance;
  int inside_rms = 0, inside_bias = 0, bars = 0, within = 0, rungs = 0;
  double cpu_s = 0.0, squares = 0.0;
  const LightMap first = compute_light_map(forest, request, {.threads = 1}, {});
  request.probes = own_plan(first);
  for (int seed = 1; seed <= seeds; ++seed) {
    request.probes->seed = static_cast<std::uint64_t>(seed);
    const Stopwatch watch;
    const LightMap map = compute_light_map(forest, request, {.threads = 1}, {});
    cpu_s += watch.cpu_s();
    for (const char c : setting(map, "tried_methods")) rungs += c == ';';
    double worst = 0.0;
    for (std::size_t b = 0; b < map.bands.size(); ++b, ++bars) {
      const PointError truth = point_error(sample_error(judges, map.bands[b], b));
      const Said rms = said(map, "measured_element_rms." + map.bands[b].band),
                 bias = said(map, "measured_bias." + map.bands[b].band);
      inside_rms += rms.low <= truth.element_rms && truth.element_rms <= rms.high;
      inside_bias += bias.low <= truth.bias.value && truth.bias.value <= bias.high;
      worst = std::max(worst, truth.element_rms);
    }
    within += worst <= tolerance;
    squares += worst * worst;
  }
  std::printf(
      "%-26s %d bars: rms held %.1f %%, bias %.1f %%; worst band %.4f RMS over seeds, within %.2f in %d of "
      "%d; %.2f rungs, %.3f s\n",
      forest.name.c_str(), bars, 100.0 * inside_rms / bars, 100.0 * inside_bias / bars,
      std::sqrt(squares / seeds), tolerance, within, seeds, 1.0 + static_cast<double>(rungs) / seeds,
      cpu_s / seeds);
  std::fflush(stdout);
}

}  // namespace
}  // namespace sunfleck

int main(int count_of_words, char** words) {
  using namespace sunfleck;
  const auto word = [&](int i, const char* usual) {
    return std::string(count_of_words > i ? words[i] : usual);
  };
  std::istringstream names(word(1, "crown:clumped:10000:5:21,crown:sphere:10000:5:22,pine"));
  for (std::string name; std::getline(names, name, ',');) {
    const Forest forest = named_forest(name);
    count(forest, bench_light(forest, word(2, "PAR")), std::stoi(word(3, "40")), std::stod(word(4, "0.10")));
  }
  return 0;
}
