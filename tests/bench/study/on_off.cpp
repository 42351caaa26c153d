// What each part of a stand's physics does at its measured sensors:
//   study_on_off SCENE REALISATIONS ["key=value;key=value" ...]
// One row of a table per argument: agreement of the mean over the realisations with the measured light, each
// figure with its standard error over the realisations (jackknife), and of single realisations.
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <string>

#include "lighting/study/stand_study.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"
#include "sim/config/config_table.h"
#include "sim/forest/forest_spec.h"

namespace sunfleck::bench {
namespace {

using Setter = std::function<void(ForestSpec&, StandStudySpec&, double)>;
const std::map<std::string, Setter>& setters() {
  static const std::map<std::string, Setter> all{
      {"allometry",
       [](auto& f, auto&, double v) {
         f.leaf_area = v > 0 ? LeafAreaSource::kAllometry : LeafAreaSource::kDensity;
       }},
      {"element", [](auto& f, auto&, double v) { f.element_area_m2 = v; }},
      {"clump", [](auto& f, auto&, double v) { f.clumps.radius_m = v; }},
      {"rim", [](auto& f, auto&, double v) { f.rim_power = v; }},
      {"height", [](auto& f, auto&, double v) { f.height_power = v; }},
      {"branch", [](auto& f, auto&, double v) { f.branch_share = v; }},
      {"understorey", [](auto& f, auto&, double v) { f.understorey.add = v > 0; }},
      {"stems", [](auto& f, auto&, double v) { f.understorey.stems_factor = v; }},
      {"leaf_area", [](auto& f, auto&, double v) { f.leaf_area_factor = v; }},
      {"surroundings",
       [](auto& f, auto&, double v) { f.surroundings = static_cast<Surroundings>(static_cast<int>(v)); }},
      {"sky", [](auto&, auto& s, double v) { s.sky = static_cast<SkyModel>(static_cast<int>(v)); }}};
  return all;
}

void apply_row(const std::string& row, ForestSpec& forest, StandStudySpec& study) {
  for (std::size_t at = 0; at < row.size();) {
    const std::size_t end = std::min(row.find(';', at), row.size()), eq = row.find('=', at);
    const auto found = eq < end ? setters().find(row.substr(at, eq - at)) : setters().end();
    if (found == setters().end()) throw_invalid("row " + row, "has an unknown key", "see on_off.cpp");
    found->second(forest, study, std::stod(row.substr(eq + 1, end - eq - 1)));
    at = end + 1;
  }
}

struct Figures {
  double rmse = 0, bias = 0, correlation = 0;
};
Figures figures(const std::vector<double>& modelled, const std::vector<double>& measured) {
  const SensorFit fit = sensor_fit(modelled, measured);
  return {fit.rmse, fit.bias, fit.correlation};
}

// Mean over all realisations but one (none left out: past the end).
std::vector<double> mean_without(const std::vector<std::vector<double>>& light, std::size_t left_out) {
  std::vector<double> mean(light.front().size());
  const double n = static_cast<double>(light.size()) - (left_out < light.size() ? 1 : 0);
  for (std::size_t k = 0; k < light.size(); ++k)
    for (std::size_t s = 0; s < mean.size(); ++s) mean[s] += k == left_out ? 0 : light[k][s] / n;
  return mean;
}

void print_row(const std::string& row, const std::vector<std::vector<double>>& light,
               const std::vector<double>& measured) {
  const Figures all = figures(mean_without(light, light.size()), measured);
  double single = 0, rmse2 = 0, correlation2 = 0;
  const double n = static_cast<double>(light.size());
  for (std::size_t k = 0; k < light.size(); ++k) {
    single += figures(light[k], measured).rmse / n;
    if (light.size() < 3) continue;
    const Figures without = figures(mean_without(light, k), measured);
    rmse2 += std::pow(without.rmse - all.rmse, 2) * (n - 1) / n;
    correlation2 += std::pow(without.correlation - all.correlation, 2) * (n - 1) / n;
  }
  std::printf("%-50s rmse %.4f +- %.4f  bias %+.4f  correlation %.3f +- %.3f  single rmse %.4f\n",
              row.c_str(), all.rmse, std::sqrt(rmse2), all.bias, all.correlation, std::sqrt(correlation2),
              single);
  std::fflush(stdout);
}

void run(const std::string& scene_file, int realisations, const std::vector<std::string>& rows) {
  const ConfigTable scene = ConfigTable::from_file(scene_file);
  const auto species = SpeciesLibrary::load(std::filesystem::path(SUNFLECK_SOURCE_DIR) / "configs/species");
  for (const std::string& row : rows) {
    ForestSpec forest = read_forest_spec(scene.table("forest"));
    StandStudySpec study = read_stand_study(scene.table("stand_light"));
    study.engine = StandEngine::kRays;
    study.intervals = IntervalKind::kPeriod;
    study.scattering = study.canopy_views = false;
    study.rays_per_cell = 2;
    study.tree_relative_error = 0;
    apply_row(row, forest, study);
    std::vector<double> measured;
    for (const SensorRow& sensor : study.sensors) measured.push_back(sensor.pacl.value());
    std::vector<std::vector<double>> light;
    for (int k = 0; k < realisations; ++k) {
      ForestSpec one = forest;
      if (k > 0) one.seed = mix_seed(forest.seed, static_cast<std::uint64_t>(k));
      const StandStudy answer = run_stand_study(grow_forest(one, species, {}, nullptr), study, {});
      const IntervalTable& pacl = answer.period->sensors.pacl_total;
      light.emplace_back(pacl.value.begin(), pacl.value.end());
    }
    print_row(row, light, measured);
  }
}

}  // namespace
}  // namespace sunfleck::bench

int main(int argc, char** argv) try {
  if (argc < 4) return std::printf("study_on_off SCENE REALISATIONS \"key=value;...\" ...\n"), 2;
  const std::vector<std::string> rows(argv + 3, argv + argc);
  sunfleck::with_threads(0, [&] { sunfleck::bench::run(argv[1], std::stoi(argv[2]), rows); });
  return 0;
} catch (const std::exception& error) {
  return std::printf("%s\n", error.what()), 1;
}
