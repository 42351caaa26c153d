// What levels of detail save in a picture of a stand: every level and the choice by tolerance against all
// leaves, trees of 16 and 8 pixels, in one run.
//   lighting_render_detail_stand [trees per side [samples per pixel [tree ...]]]
// For each: CPU time per camera ray and sun ray (bare), of the path-traced picture and of the picture from a
// light map, less that of building the scene, as ratios to all leaves; scene building; RMS error and bias.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "sim/base/parallel.h"
#include "tests/bench/render/detail_scenes.h"

namespace sunfleck {
namespace {

struct Costs {
  double build_s = 0, ray_ns = 0, traced_ns = 0, mapped_ns = 0;
};

// Every leaf in the same light: what it is does not matter for the time.
LightMap even_map(const Forest& forest, const OpticsTable& optics) {
  LightMap map;
  map.bands.resize(1);
  map.bands[0].band = optics.bands()[0];
  const std::size_t count = ForestIndex(forest).element_count();
  map.sunlit_fraction.assign(count, 0.5f);
  map.bands[0].elements.assign(count, {{100, 30, 20}, {50, 30, 20}, 0});
  return map;
}

Costs costs_of(const Forest& forest, const OpticsTable& optics, const LightMap& map,
               const RenderRequest& request) {
  Costs costs;
  const Camera& camera = request.camera;
  const double began = test::cpu_seconds();
  {
    const PictureScene scene(forest, request.look, {},
                             choose_details(forest, camera, request.light, request.detail, {}));
    costs.build_s = test::cpu_seconds() - began;
    costs.ray_ns = test::ray_cost_ns(scene, camera, 2 * camera.samples_per_pixel);
  }
  const auto per_sample_ns = [&](auto&& draw) {  // twice the samples less once
    const auto seconds = [&](int times) {
      RenderRequest more = request;
      more.camera.samples_per_pixel *= times;
      const double start = test::cpu_seconds();
      draw(more);
      return test::cpu_seconds() - start;
    };
    const double once = seconds(1), thrice = seconds(3);
    return (thrice - once) / (2.0 * camera.width_px * camera.height_px * camera.samples_per_pixel) * 1e9;
  };
  costs.traced_ns = per_sample_ns([&](const RenderRequest& r) { render_path_traced(forest, optics, r, {}); });
  costs.mapped_ns = per_sample_ns([&](const RenderRequest& r) { render(forest, optics, map, r, {}); });
  return costs;
}

void compare(const Forest& forest, const OpticsTable& optics, double tree_px, int samples) {
  const LightMap map = even_map(forest, optics);
  const double tree_m = prototype_bounds(forest.prototypes[0]).size().z;
  RenderRequest request{test::detail_view(forest, tree_m / tree_px, samples), test::detail_light()};
  Camera sharp = request.camera;
  sharp.samples_per_pixel = 4 * samples;
  const test::PicturePair truth = test::path_traced_pair(forest, optics, sharp, {});
  const Costs all = costs_of(forest, optics, map, request);
  std::printf(
      "trees of %g px, %d x %d px, %d samples; all leaves: rays %.0f, path-traced %.0f, from map %.0f ns per "
      "sample, built in %.1f s\n",
      tree_px, sharp.width_px, sharp.height_px, samples, all.ray_ns, all.traced_ns, all.mapped_ns,
      all.build_s);
  for (const char* word : {"auto", "pruned_16", "pruned_64"}) {
    request.detail = picture_detail_named(word, "bench");
    const Costs c = costs_of(forest, optics, map, request);
    const test::DetailError e =
        test::detail_error(test::path_traced_pair(forest, optics, sharp, request.detail), truth);
    std::printf(
        "  %-9s rays %.2fx  path-traced %.2fx  from map %.2fx  built in %.1f s  rms %.4f  bias %+.4f\n", word,
        all.ray_ns / c.ray_ns, all.traced_ns / c.traced_ns, all.mapped_ns / c.mapped_ns, c.build_s, e.rms,
        e.bias);
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace sunfleck

int main(int argc, char** argv) {
  using namespace sunfleck;
  const int side = argc > 1 ? std::atoi(argv[1]) : 16, samples = argc > 2 ? std::atoi(argv[2]) : 4;
  std::vector<std::string> trees(argv + std::min(argc, 3), argv + argc);
  if (trees.empty()) trees = {"sphere_100k", "Fagus sylvatica"};
  const Forest forest = test::detail_stand(trees, side);
  for (const Prototype& p : forest.prototypes)
    std::printf("%s: %zu leaves or shoots of %.3f m, %zu wood segments\n", p.name.c_str(), p.foliage.size(),
                leaf_side_m(p.foliage), p.wood.size());
  std::fflush(stdout);
  const OpticsTable optics = test::detail_optics(forest, "NIR");
  with_threads(1, [&] {
    for (const double tree_px : {16.0, 8.0}) compare(forest, optics, tree_px, samples);
  });
}
