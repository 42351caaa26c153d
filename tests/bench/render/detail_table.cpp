// The table that pictures choose levels of detail by, measured anew (lighting/shade/detail_rows.cpp):
//   lighting_render_detail_table [paths per picture [band [footprint [tree ...]]]]
// For each tree, footprint in leaf sides and level: RMS error and bias of the path-traced picture in units of
// its white, and CPU time per camera ray and its sun ray. At the end the rows in their form as code: the
// worst tree, the mean cost. Trees: latin names (30 cm DBH) or sphere_100k. NIR, where leaves are brightest,
// shows the largest errors.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "tests/bench/render/detail_scenes.h"

namespace sunfleck {
namespace {

constexpr Detail kLevels[] = {Detail::kExplicit, Detail::kPruned4, Detail::kPruned16, Detail::kPruned64};

struct Row {
  double worst_rms = 0, cost_ns = 0;
  int trees = 0;
};
using Rows = std::map<std::pair<Detail, double>, Row>;

// Enlarged leaves of more than a pixel err by more than pictures allow, those of less than a tenth hardly.
bool is_worth_measuring(Detail detail, double footprint) {
  const int level = static_cast<int>(detail) - static_cast<int>(Detail::kExplicit);
  const double enlarged_px = std::pow(2.0, level) / footprint;
  return enlarged_px <= 1.01 && (detail == Detail::kExplicit || enlarged_px > 0.09);
}

PictureDetail forced(Detail detail) {
  return {.mode = detail == Detail::kExplicit ? DetailMode::kFull : DetailMode::kForced, .forced = detail};
}

void measure(const std::string& name, double footprint, const std::string& band, double paths, Rows& rows) {
  const Forest forest = test::detail_tree(name);
  const OpticsTable optics = test::detail_optics(forest, band);
  const double pixel_m = footprint * leaf_side_m(forest.prototypes[0].foliage);
  Camera camera = test::detail_view(forest, pixel_m, 16);
  const double pixels = static_cast<double>(camera.width_px) * camera.height_px;
  camera.samples_per_pixel = 16 * std::clamp(static_cast<int>(paths / pixels / 16), 2, 256);
  const test::PicturePair truth = test::path_traced_pair(forest, optics, camera, {});
  for (const Detail level : kLevels) {
    if (!is_worth_measuring(level, footprint)) continue;
    const PictureScene scene(forest, {}, {},
                             choose_details(forest, camera, test::detail_light(), forced(level), {}));
    const double cost_ns = test::ray_cost_ns(scene, camera, std::max(4, static_cast<int>(2e5 / pixels)));
    test::DetailError e;
    if (level != Detail::kExplicit)
      e = test::detail_error(test::path_traced_pair(forest, optics, camera, forced(level)), truth);
    Row& row = rows[{level, footprint}];
    row.worst_rms = std::max(row.worst_rms, e.rms);
    row.cost_ns += cost_ns, ++row.trees;
    std::printf("%-18s %5.2f leaf sides  %3d px  %-9s %s  rms %.4f  bias %+.4f  %5.0f ns\n", name.c_str(),
                footprint, camera.height_px, to_string(level).c_str(), band.c_str(), e.rms, e.bias, cost_ns);
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace sunfleck

int main(int argc, char** argv) {
  using namespace sunfleck;
  const double paths = argc > 1 ? std::atof(argv[1]) : 2e5;
  const std::string band = argc > 2 ? argv[2] : "NIR";
  const double only = argc > 3 ? std::atof(argv[3]) : 0;
  std::vector<std::string> trees(argv + std::min(argc, 4), argv + argc);
  if (trees.empty()) trees = {"Fagus sylvatica", "Betula pendula", "sphere_100k"};
  Rows rows;
  for (const std::string& tree : trees)
    for (const double footprint : {2.5, 5.0, 10.0, 20.0, 40.0})
      if (only == 0 || only == footprint) measure(tree, footprint, band, paths, rows);
  for (const auto& [key, row] : rows)
    std::printf("{%s, %g, %.4f, %.0f},\n", to_string(key.first).c_str(), key.second, row.worst_rms,
                row.cost_ns / row.trees);
}
