#include "server/apps/summary.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "server/apps/terminal.h"

namespace sunfleck {
namespace {

double total_wall_s(const Provenance& provenance) {
  double sum = 0.0;
  for (const StageTime& t : provenance.times) sum += t.wall_s;
  return sum;
}

// Rounds of the same stage added up, in the order they first appear.
std::vector<StageTime> stage_sums(const Provenance& provenance) {
  std::vector<StageTime> sums;
  for (const StageTime& t : provenance.times) {
    const auto same =
        std::find_if(sums.begin(), sums.end(), [&](const StageTime& s) { return s.stage == t.stage; });
    if (same == sums.end()) {
      sums.push_back(t);
    } else {
      same->wall_s += t.wall_s;
      same->cpu_s += t.cpu_s;
    }
  }
  return sums;
}

void print_band(const BandLightMap& band) {
  double absorbed_w = 0.0, area_m2 = 0.0;
  for (const TreeLight& tree : band.trees) {
    absorbed_w += tree.absorbed_w;
    area_m2 += tree.leaf_area_m2;
  }
  const bool has_error = !band.standard_error_w_m2.empty();
  std::printf("%-12s mean absorbed %.4g W per m2 of leaf (%.6g W in all)\n", (band.band + ":").c_str(),
              area_m2 > 0 ? absorbed_w / area_m2 : 0.0, absorbed_w);
  std::printf("             mean irradiance, both faces, %.5g W m-2", band.mean_irradiance_w_m2);
  if (has_error && band.mean_irradiance_standard_error_w_m2 > 0)
    std::printf(" +- %.2g (standard error)\n", band.mean_irradiance_standard_error_w_m2);
  else if (has_error)  // of a selection: errors of single elements only
    std::printf("\n");
  else
    std::printf("; no error estimate of its own\n");
  if (has_error) {
    double squares = 0.0;
    for (const float e : band.standard_error_w_m2) squares += static_cast<double>(e) * e;
    const double rms = std::sqrt(squares / static_cast<double>(band.standard_error_w_m2.size()));
    std::printf("             per element, standard error %.1f %% of the mean (RMS)\n",
                band.mean_irradiance_w_m2 > 0 ? 100 * rms / band.mean_irradiance_w_m2 : 0.0);
  }
  if (band.has_budget && band.budget.incident_w > 0)
    std::printf("             energy: residual %.3f %% of the light coming in (standard error %.3f %%)\n",
                100 * band.budget.residual_w / band.budget.incident_w,
                100 * band.budget.residual_standard_error_w / band.budget.incident_w);
}

}  // namespace

void print_forest(const Forest& forest) {
  const ForestIndex index(forest);
  std::size_t with_leaves = 0;
  for (const Instance& i : forest.instances)
    with_leaves += !forest.prototypes[i.prototype.value].foliage.empty();
  const Box box = forest_bounds(forest);
  std::printf("forest       %s\n", forest.name.c_str());
  std::printf("trees        %s (%s prototypes)\n", grouped(forest.instances.size()).c_str(),
              grouped(forest.prototypes.size()).c_str());
  std::printf("leaves       %s foliage elements, %.6g m2 of one-sided leaf area\n",
              grouped(index.element_count()).c_str(), forest_leaf_area_m2(forest));
  if (!box.empty())
    std::printf("extent       %.1f x %.1f m, %.1f m high\n", box.size().x, box.size().y, box.size().z);
  if (forest.period)
    std::printf("repeats      every %g x %g m\n", forest.period->size_m.x, forest.period->size_m.y);
  std::printf("hash         %s\n", content_hash(forest).c_str());
}

void print_light(const LightMap& map, const Forest& forest) {
  std::printf("method       %s (seed %llu, version %s)\n", map.provenance.method.c_str(),
              static_cast<unsigned long long>(map.provenance.seed), map.provenance.version.c_str());
  const ForestIndex index(forest);
  std::printf("trees        %s with %s foliage elements\n", grouped(forest.instances.size()).c_str(),
              grouped(index.element_count()).c_str());
  for (const BandLightMap& band : map.bands) print_band(band);
  for (const auto& [name, value] : map.provenance.settings)
    if (name.starts_with("measured_") || name == "chosen_method")
      std::printf("%-12s %s = %s\n", name.starts_with("measured_") ? "error" : "auto", name.c_str(),
                  value.c_str());
  for (const SkipNote& s : map.provenance.skipped)
    std::printf("skipped      %s: %s (bound: %.2g of the mean)\n", s.what.c_str(), s.reason.c_str(),
                s.relative_bound);
  for (const std::string& note : map.provenance.notes) std::printf("note         %s\n", note.c_str());
  std::printf("time         %s", seconds_text(total_wall_s(map.provenance)).c_str());
  const char* separator = " (";
  for (const StageTime& t : stage_sums(map.provenance)) {
    std::printf("%s%s %s", separator, t.stage.c_str(), seconds_text(t.wall_s).c_str());
    separator = ", ";
  }
  std::printf("%s\n", map.provenance.times.empty() ? "" : ")");
}

}  // namespace sunfleck
