// Two tables, on one core: `auto` against `reference` at the same measured error, and what a change of the
// request costs in a session against a call by itself. Answers are checked before they are timed: sessions
// must give the bytes of calls by themselves.
//
//   plan_bench auto [hectare]        plan_bench changes
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <string>

#include "lighting/plan/light_session.h"
#include "tests/bench/plan/plan_scenes.h"

namespace sunfleck {
namespace {

double cpu_now_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

struct Run {
  LightMap map;
  double cpu_s = 0;
};

// Median of three.
template <class Call>
Run timed(int repeats, const Call& call) {
  std::vector<double> times;
  Run run;
  for (int i = 0; i < repeats; ++i) {
    const double start = cpu_now_s();
    run.map = call();
    times.push_back(cpu_now_s() - start);
  }
  std::sort(times.begin(), times.end());
  run.cpu_s = times[times.size() / 2];
  return run;
}

std::string setting(const LightMap& map, const std::string& key) {
  for (const auto& [name, value] : map.provenance.settings)
    if (name == key) return value;
  return "-";
}

void print_stages(const LightMap& map) {
  for (const StageTime& t : map.provenance.times)
    std::printf("      %-24s %7.4f s\n", t.stage.c_str(), t.cpu_s);
}

void auto_against_reference(const Forest& forest, int repeats) {
  std::printf("%s, %zu elements, PAR, one core\n", forest.name.c_str(), ForestIndex(forest).element_count());
  for (const double tolerance : {0.10, 0.20}) {
    LightRequest asked = par_request(Method::kAuto);
    asked.automatic.tolerance = tolerance;
    const Run run = timed(repeats, [&] { return compute_light_map(forest, asked, {.threads = 1}, {}); });
    std::printf("  auto %.2f: %.3f s, measured %s, chose %s; tried %s; %s\n", tolerance, run.cpu_s,
                setting(run.map, "measured_element_rms.PAR").c_str(),
                setting(run.map, "chosen_method").c_str(), setting(run.map, "tried_methods").c_str(),
                setting(run.map, "correction.PAR").c_str());
    print_stages(run.map);
  }
  for (const int rays : {64}) {
    LightRequest asked = par_request(Method::kReference);
    asked.reference.rays_per_face = asked.reference.sun_rays_per_element = rays;
    asked.probes = ProbePlan{};
    const LightMap measured = compute_light_map(forest, asked, {.threads = 1}, {});
    asked.probes.reset();
    const Run run = timed(repeats, [&] { return compute_light_map(forest, asked, {.threads = 1}, {}); });
    std::printf("  reference %d rays: %.3f s, measured %s\n", rays, run.cpu_s,
                setting(measured, "measured_element_rms.PAR").c_str());
    if (rays == 64) print_stages(run.map);
  }
}

struct Change {
  const char* what;
  void (*apply)(LightRequest&);
};

constexpr Change kChanges[] = {
    {"sun", [](LightRequest& r) { r.light.to_sun = direction_from_azimuth_zenith(2.0, 0.9); }},
    {"sky model", [](LightRequest& r) { r.light.sky = SkyModel::kStandardOvercast; }},
    {"strengths",
     [](LightRequest& r) {
       r.light.bands[0] = {100, 300};
     }},
    {"leaf optics",
     [](LightRequest& r) {
       r.optics.overrides = {{"*", "PAR", {{0.12, 0.12, 0.06, 0.06}, 0.1}}};
     }},
    {"soil albedo", [](LightRequest& r) { r.optics.soil_albedo = {0.3}; }}};

bool equal_bytes(const LightMap& a, const LightMap& b) {
  const auto &x = a.bands[0].elements, &y = b.bands[0].elements;
  return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof x[0]) == 0;
}

void changes_of(Method method) {
  const Forest forest = clumped_crown();
  const LightRequest base = par_request(method);
  std::printf("%-18s", to_string(method).c_str());
  for (const Change& change : kChanges) {
    LightRequest asked = base;
    change.apply(asked);
    const Run fresh = timed(1, [&] { return compute_light_map(forest, asked, {.threads = 1}, {}); });
    const LightSession session(forest);
    session.compute(base, {.threads = 1}, {});
    const Run again = timed(1, [&] { return session.compute(asked, {.threads = 1}, {}); });
    if (!equal_bytes(fresh.map, again.map)) {
      std::printf(" WRONG ANSWER after a change of %s\n", change.what);
      return;
    }
    std::printf("  %.3f / %.3f", again.cpu_s, fresh.cpu_s);
  }
  std::printf("\n");
}

void all_changes() {
  std::printf(
      "clumped crown, 40,000 leaves, PAR, one core: CPU seconds after a change in a session / fresh\n%18s",
      "");
  for (const Change& change : kChanges) std::printf("  %-13s", change.what);
  std::printf("\n");
  for (const std::string& name : method_names()) changes_of(method_from_string(name, "bench"));
}

}  // namespace
}  // namespace sunfleck

int main(int count, char** words) {
  using namespace sunfleck;
  const std::string what = count > 1 ? words[1] : "auto";
  const bool stand = count > 2 && std::string(words[2]) == "hectare";
  if (what == "changes") all_changes();
  if (what == "auto") auto_against_reference(stand ? hectare() : clumped_crown(), stand ? 1 : 3);
  return 0;
}
