#include "lighting/bench/benchmark_tables.h"

#include <algorithm>
#include <set>
#include <sstream>

namespace sunfleck {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

using SceneBand = std::pair<std::string, std::string>;

std::vector<SceneBand> scenes_and_bands(const std::vector<BenchmarkRow>& rows) {
  std::vector<SceneBand> list;
  for (const BenchmarkRow& r : rows)
    if (std::find(list.begin(), list.end(), SceneBand(r.scene, r.band)) == list.end())
      list.emplace_back(r.scene, r.band);
  return list;
}

PlotSeries method_series(const std::vector<BenchmarkRow>& rows, const SceneBand& which,
                         const std::string& method) {
  PlotSeries series{.name = method};
  for (const BenchmarkRow& r : rows)
    if (r.scene == which.first && r.band == which.second && r.method == method) {
      series.x.push_back(r.cpu_s);
      series.y.push_back(100 * r.error.element_rms);
    }
  return series;
}

PlotSeries front_series(const std::vector<BenchmarkRow>& rows, const SceneBand& which) {
  PlotSeries series{"front", PlotStyle::kLines, {}, {}, {}, "#bbbbbb"};
  for (const std::size_t i : pareto_front(rows, which.first, which.second)) {
    series.x.push_back(rows[i].cpu_s);
    series.y.push_back(100 * rows[i].error.element_rms);
  }
  return series;
}

}  // namespace

std::string benchmark_csv(const std::vector<BenchmarkRow>& rows, int threads, const MachineFacts& machine) {
  std::ostringstream out;
  out << "scene,band,method,knob,elements,instances,bias,element_rms,cell_rms,class_rms,diffuse_rms,"
         "truth_noise,wall_s,cpu_s,setup_s,rays,peak_memory_bytes,seed,threads,commit,date_utc,compiler,"
         "processor\n";
  for (const BenchmarkRow& r : rows)
    out << r.scene << ',' << r.band << ',' << r.method << ',' << quoted(r.knob) << ',' << r.elements << ','
        << r.instances << ',' << r.error.bias << ',' << r.error.element_rms << ',' << r.error.cell_rms << ','
        << r.error.class_rms << ',' << r.error.diffuse_rms << ',' << r.truth_noise << ',' << r.wall_s << ','
        << r.cpu_s << ',' << r.setup_s << ',' << r.rays << ',' << r.peak_memory_bytes << ',' << r.seed << ','
        << threads << ',' << machine.commit << ',' << machine.date_utc << ',' << quoted(machine.compiler)
        << ',' << quoted(machine.processor) << '\n';
  return out.str();
}

std::vector<std::size_t> pareto_front(const std::vector<BenchmarkRow>& rows, const std::string& scene,
                                      const std::string& band) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].scene == scene && rows[i].band == band) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rows[a].cpu_s < rows[b].cpu_s; });
  std::vector<std::size_t> front;
  for (const std::size_t i : order)
    if (front.empty() || rows[i].error.element_rms < rows[front.back()].error.element_rms) front.push_back(i);
  return front;
}

PlotPage pareto_page(const std::vector<BenchmarkRow>& rows, const MachineFacts& machine) {
  PlotPage page;
  page.columns = 2;
  std::vector<std::string> methods;
  for (const BenchmarkRow& r : rows)
    if (std::find(methods.begin(), methods.end(), r.method) == methods.end()) methods.push_back(r.method);
  for (const SceneBand& which : scenes_and_bands(rows)) {
    PlotPanel panel;
    panel.title = which.first + ", " + which.second + " (" + machine.date_utc + ", " + machine.commit + ")";
    panel.x = {"CPU time (s)", AxisScale::kLog};
    panel.y = {"RMS error per element (% of the mean)", AxisScale::kLog};
    panel.series.push_back(front_series(rows, which));
    for (const std::string& method : methods) panel.series.push_back(method_series(rows, which, method));
    page.panels.push_back(std::move(panel));
  }
  return page;
}

}  // namespace sunfleck
