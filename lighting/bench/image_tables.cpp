#include "lighting/bench/image_tables.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace sunfleck {
namespace {

template <class... Parts>
std::string formatted(const char* format, Parts... parts) {
  char text[512];
  std::snprintf(text, sizeof text, format, parts...);
  return text;
}

std::string number_or_dash(const char* format, double value) {
  return std::isfinite(value) ? formatted(format, value) : "-";
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

// Empty where it is not known.
std::string field(double value) {
  std::ostringstream out;
  if (std::isfinite(value)) out << value;
  return out.str();
}

void add_line(const ImageBenchmark& b, const ImageRow& r, const std::string& tail, std::ostringstream& out) {
  out << r.scene << ',' << r.way << ',' << r.samples << ',' << r.width_px << ',' << r.height_px << ','
      << r.elements << ',' << r.instances << ',' << r.error.bias << ',' << r.error.bias_standard_error << ','
      << r.error.rmse << ',' << r.error.noise << ',' << r.error.floor << ',' << r.error.ssim << ','
      << r.error.flip << ',' << r.wall_s << ',' << r.cpu_s << ',' << field(r.path_traced_rmse_at_equal_time)
      << ',' << field(r.times_cheaper_at_equal_error) << ',' << b.reference_samples << ','
      << b.reference_noise << ',' << b.light_map_method << ',' << b.light_map_cpu_s << ','
      << r.peak_memory_bytes << ',' << r.seed << ',' << tail << '\n';
}

PlotSeries way_series(const ImageBenchmark& benchmark, const std::string& way) {
  PlotSeries series{.name = way};
  for (const ImageRow& r : benchmark.rows) {
    if (r.way != way || !(r.error.rmse > 0.0)) continue;
    series.x.push_back(r.cpu_s);
    series.y.push_back(100 * r.error.rmse);
    series.labels.push_back(std::to_string(r.samples));
  }
  return series;
}

std::vector<std::string> ways_of(const ImageBenchmark& benchmark) {
  std::vector<std::string> ways;
  for (const ImageRow& r : benchmark.rows)
    if (std::find(ways.begin(), ways.end(), r.way) == ways.end()) ways.push_back(r.way);
  return ways;
}

}  // namespace

std::string image_table(const ImageBenchmark& benchmark) {
  std::string text =
      formatted("%-10s %-22s %7s %17s %8s %7s %7s %7s %7s %9s %9s %12s %8s\n", "scene", "way", "samples",
                "bias", "RMSE", "noise", "floor", "SSIM", "FLIP", "wall s", "CPU s", "path-traced", "times");
  text += formatted("%99s %9s %12s %8s\n", "", "", "same time", "cheaper");
  for (const ImageRow& r : benchmark.rows)
    text += formatted("%-10s %-22s %7d %+8.2f +- %5.2f %8.2f %7.2f %7.2f %7.4f %7.4f %9.3f %9.3f %12s %8s\n",
                      r.scene.c_str(), r.way.c_str(), r.samples, 100 * r.error.bias,
                      100 * r.error.bias_standard_error, 100 * r.error.rmse, 100 * r.error.noise,
                      100 * r.error.floor, r.error.ssim, r.error.flip, r.wall_s, r.cpu_s,
                      number_or_dash("%.2f", 100 * r.path_traced_rmse_at_equal_time).c_str(),
                      number_or_dash("%.2f", r.times_cheaper_at_equal_error).c_str());
  return text;
}

std::string image_csv(const std::vector<ImageBenchmark>& benchmarks, int threads,
                      const MachineFacts& machine) {
  std::ostringstream out, tail;
  tail << threads << ',' << machine.commit << ',' << machine.date_utc << ',' << quoted(machine.compiler)
       << ',' << quoted(machine.processor);
  out << "scene,way,samples,width_px,height_px,elements,instances,bias,bias_standard_error,rmse,noise,floor,"
         "ssim,flip,wall_s,cpu_s,path_traced_rmse_at_equal_time,times_cheaper_at_equal_error,reference_"
         "samples,"
         "reference_noise,light_map_method,light_map_cpu_s,peak_memory_bytes,seed,threads,commit,date_utc,"
         "compiler,processor\n";
  for (const ImageBenchmark& b : benchmarks)
    for (const ImageRow& r : b.rows) add_line(b, r, tail.str(), out);
  return out.str();
}

PlotPage image_page(const std::vector<ImageBenchmark>& benchmarks, const MachineFacts& machine) {
  PlotPage page;
  page.columns = std::min<int>(2, static_cast<int>(benchmarks.size()));
  for (const ImageBenchmark& b : benchmarks) {
    if (b.rows.empty()) continue;
    PlotPanel panel;
    panel.title = b.rows.front().scene + " (" + machine.date_utc + ", " + machine.commit + ")";
    panel.remarks.push_back("samples per pixel beside the points; without the time of the light map");
    panel.x = {"CPU time (s)", AxisScale::kLog};
    panel.y = {"RMSE (% of the mean brightness)", AxisScale::kLog};
    for (const std::string& way : ways_of(b)) panel.series.push_back(way_series(b, way));
    page.panels.push_back(std::move(panel));
  }
  return page;
}

}  // namespace sunfleck
