#include "lighting/bench/cost_growth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "lighting/bench/bench_scenes.h"
#include "lighting/bench/error_against_time.h"
#include "lighting/bench/stopwatch.h"
#include "lighting/plan/auto_probe.h"
#include "lighting/plan/light_session.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

constexpr ProbePlan kProbes{.count = 400, .paths_per_face = 64, .sun_rays = 128, .seed = 7};

std::vector<double> counts_of(GrowthKind kind) {
  switch (kind) {
    case GrowthKind::kLeaves:
      return {1e3, 1e4, 1e5, 1e6};
    case GrowthKind::kInstances:
      return {1, 10, 100, 1000, 10000};
    case GrowthKind::kBands:
      return {1, 2, 4, 8, 16};
    case GrowthKind::kSuns:
      return {1, 10, 100};
  }
  return {};
}

Forest forest_of(GrowthKind kind, double count, std::uint64_t seed) {
  const int n = static_cast<int>(count);
  if (kind == GrowthKind::kInstances) return crowns_in_rows({.count = n, .leaves = 1000, .seed = seed});
  return generated_crown({.leaves = kind == GrowthKind::kLeaves ? n : 20000, .seed = seed});
}

LightRequest light_of(GrowthKind kind, double count, const Forest& forest) {
  LightRequest request = bench_light(forest, "PAR");
  if (kind != GrowthKind::kBands) return request;
  // Copies of PAR under other names: the same work for each.
  for (int b = 1; b < static_cast<int>(count); ++b) {
    const std::string name = "PAR" + std::to_string(b + 1);
    request.optics.bands.push_back(name);
    request.optics.soil_albedo.push_back(request.optics.soil_albedo[0]);
    request.optics.overrides.push_back({"*", name, {{.10, .10, .05, .05}, 0.1}});
    request.light.bands.push_back(request.light.bands[0]);
  }
  return request;
}

struct Question {
  Forest forest;
  LightRequest light;
  ProbeSet probes;
};

Question question_of(GrowthKind kind, double count, std::uint64_t seed, const RunControl& control) {
  Question q{forest_of(kind, count, seed), {}, {}};
  q.light = light_of(kind, count, q.forest);
  const OpticsTable optics(q.forest, q.light.optics);
  const Illumination light = checked(q.light.light, optics.band_count());
  const ProbeScene scene(q.forest, true, control);
  q.probes = draw_probes(scene, optics, light, kProbes, control);
  return q;
}

// Other places of the sun along an arc; their answers are not looked at.
void ask_other_suns(const LightSession& session, LightRequest request, int count, const GrowthPlan& plan,
                    const RunControl& control) {
  for (int i = 0; i < count; ++i) {
    const double way = (i + 0.5) / count;
    request.light.to_sun = direction_from_azimuth_zenith(
        radians_from_degrees(90 + 180 * way), radians_from_degrees(30 + 40 * std::fabs(way - 0.5)));
    session.compute(request, plan.cost, control);
  }
}

GrowthRow measured(GrowthKind kind, double count, const Question& q, const MethodStep& step,
                   const GrowthPlan& plan, const RunControl& control) {
  LightRequest request = q.light;
  step.set(request);
  GrowthRow row{.kind = kind, .method = to_string(step.method), .knob = step.knob, .count = count};
  std::vector<double> wall, cpu;
  LightMap map;
  for (int i = 0; i < plan.repeats; ++i) {
    const Stopwatch watch;
    const LightSession session(q.forest);
    if (kind == GrowthKind::kSuns)
      ask_other_suns(session, request, static_cast<int>(count) - 1, plan, control);
    map = session.compute(request, plan.cost, control);
    wall.push_back(watch.wall_s());
    cpu.push_back(watch.cpu_s());
  }
  row.wall_s = median(wall);
  row.cpu_s = median(cpu);
  row.elements = map.bands[0].elements.size();
  const ErrorBar bar =
      error_bar(sample_error(q.probes, map.bands[0], 0), Resamples(q.probes.probes.size(), kProbes.seed));
  row.bias = bar.bias.value;
  row.bias_low = bar.bias.low;
  row.bias_high = bar.bias.high;
  row.element_rms = bar.element_rms.value;
  row.element_rms_low = bar.element_rms.low;
  row.element_rms_high = bar.element_rms.high;
  return row;
}

const char* axis_of(GrowthKind kind) {
  switch (kind) {
    case GrowthKind::kLeaves:
      return "leaves";
    case GrowthKind::kInstances:
      return "instances of 1,000 leaves";
    case GrowthKind::kBands:
      return "bands";
    case GrowthKind::kSuns:
      return "places of the sun";
  }
  return "";
}

}  // namespace

std::string to_string(GrowthKind kind) {
  constexpr const char* kNames[] = {"leaves", "instances", "bands", "suns"};
  return kNames[static_cast<int>(kind)];
}

std::vector<GrowthRow> cost_growth(GrowthKind kind, const GrowthPlan& plan, const RunControl& control) {
  std::vector<GrowthRow> rows;
  std::vector<bool> too_slow(plan.steps.size(), false);
  for (const double count : counts_of(kind)) {
    const double elements = kind == GrowthKind::kInstances ? 1000 * count : count;
    if (kind != GrowthKind::kBands && kind != GrowthKind::kSuns &&
        elements > static_cast<double>(plan.most_elements))
      break;
    const Question q = question_of(kind, count, plan.seed, control);
    for (std::size_t s = 0; s < plan.steps.size(); ++s) {
      if (too_slow[s]) continue;
      rows.push_back(measured(kind, count, q, plan.steps[s], plan, control));
      too_slow[s] = rows.back().wall_s > plan.longest_s;
    }
  }
  return rows;
}

double growth_exponent(const std::vector<GrowthRow>& rows, const std::string& method, const std::string& knob,
                       double from) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const GrowthRow& r : rows) {
    if (r.method != method || r.knob != knob || r.count < from) continue;
    const double lx = std::log(r.count), ly = std::log(r.cpu_s);
    n += 1, x += lx, y += ly, xx += lx * lx, xy += lx * ly;
  }
  if (n < 2) return std::numeric_limits<double>::quiet_NaN();
  return (n * xy - x * y) / (n * xx - x * x);
}

std::string growth_csv(const std::vector<GrowthRow>& rows, int threads, const MachineFacts& machine) {
  std::ostringstream out;
  out << "growing,count,elements,method,knob,wall_s,cpu_s,bias,bias_low,bias_high,element_rms,"
         "element_rms_low,element_rms_high,threads,commit,date_utc,processor\n";
  for (const GrowthRow& r : rows)
    out << to_string(r.kind) << ',' << r.count << ',' << r.elements << ',' << r.method << ",\"" << r.knob
        << "\"," << r.wall_s << ',' << r.cpu_s << ',' << r.bias << ',' << r.bias_low << ',' << r.bias_high
        << ',' << r.element_rms << ',' << r.element_rms_low << ',' << r.element_rms_high << ',' << threads
        << ',' << machine.commit << ',' << machine.date_utc << ",\"" << machine.processor << "\"\n";
  return out.str();
}

PlotPage growth_page(const std::vector<GrowthRow>& rows, const MachineFacts& machine) {
  PlotPage page;
  page.columns = 2;
  for (const GrowthKind kind :
       {GrowthKind::kLeaves, GrowthKind::kInstances, GrowthKind::kBands, GrowthKind::kSuns}) {
    PlotPanel panel;
    panel.title = "cost against " + to_string(kind) + " (" + machine.date_utc + ", " + machine.commit + ")";
    panel.x = {axis_of(kind), AxisScale::kLog};
    panel.y = {"CPU time (s)", AxisScale::kLog};
    for (const GrowthRow& r : rows) {
      if (r.kind != kind) continue;
      const std::string name = r.knob == "default" ? r.method : r.method + ", " + r.knob;
      auto found = std::find_if(panel.series.begin(), panel.series.end(),
                                [&](const PlotSeries& s) { return s.name == name; });
      if (found == panel.series.end()) found = panel.series.insert(found, {.name = name});
      found->x.push_back(r.count);
      found->y.push_back(r.cpu_s);
    }
    if (!panel.series.empty()) page.panels.push_back(std::move(panel));
  }
  return page;
}

}  // namespace sunfleck
