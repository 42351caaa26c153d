// One tree at 128 to 8 pixels, from left to right, with all its leaves (top) and at every level below: a PNG
// of pixels drawn as large as makes the trees equally high, and a table of error and time.
//   lighting_render_detail_strips OUT.png [tree [samples per pixel]]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "sim/base/parallel.h"
#include "tests/bench/render/detail_scenes.h"

namespace sunfleck {
namespace {

constexpr int kTileWidth = 96, kTileHeight = 128, kGap = 2;

Image sheet(int columns, int rows) {
  Image image;
  image.width_px = columns * (kTileWidth + kGap) - kGap;
  image.height_px = rows * (kTileHeight + kGap) - kGap;
  image.rgb.assign(3 * static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px),
                   0.f);
  return image;
}

// Every pixel of `from` as a square of `times` pixels.
void put(const Image& from, int times, int column, int row, Image& to) {
  for (int y = 0; y < kTileHeight; ++y)
    for (int x = 0; x < kTileWidth; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        const auto source = static_cast<std::size_t>(y / times * from.width_px + x / times);
        const int at = (row * (kTileHeight + kGap) + y) * to.width_px + column * (kTileWidth + kGap) + x;
        to.rgb[3 * static_cast<std::size_t>(at) + c] = from.rgb[3 * source + c];
      }
}

void draw(const char* path, const std::string& tree, int samples) {
  const Forest forest = test::detail_tree(tree);
  const OpticsTable optics = test::detail_optics(forest, "PAR");
  const double tree_m = prototype_bounds(forest.prototypes[0]).size().z;
  Image all = sheet(5, 4);
  std::printf(
      "| pixels | leaf, pixels | level | error (RMS) | bias | CPU time per sample | of all leaves |\n"
      "|---|---|---|---|---|---|---|\n");
  int column = 0;
  for (const int px : {128, 64, 32, 16, 8}) {
    const double pixel_m = 1.1 * tree_m / px;
    Camera camera = test::detail_view(forest, pixel_m, samples * std::min(16, 128 * 128 / px / px));
    camera.width_px = px * kTileWidth / kTileHeight, camera.height_px = px;
    camera.ortho_height_m = pixel_m * px;
    test::PicturePair truth;
    double all_ns = 0;
    int row = 0;
    for (const char* word : {"full", "pruned_4", "pruned_16", "pruned_64"}) {
      const PictureDetail detail = picture_detail_named(word, "bench");
      const PictureScene scene(forest, {}, {},
                               choose_details(forest, camera, test::detail_light(), detail, {}));
      const double ns = test::ray_cost_ns(scene, camera, std::max(4, 400000 / (px * px)));
      const test::PicturePair shown = test::path_traced_pair(forest, optics, camera, detail);
      if (row == 0) truth = shown, all_ns = ns;
      const test::DetailError e = row == 0 ? test::DetailError{} : test::detail_error(shown, truth);
      std::printf("| %d | %.2f | %s | %.3f | %+.3f | %.0f ns | %.2f |\n", px,
                  leaf_side_m(forest.prototypes[0].foliage) / pixel_m, word, e.rms, e.bias, ns, ns / all_ns);
      std::fflush(stdout);
      put(shown.a, kTileHeight / px, column, row++, all);
    }
    ++column;
  }
  save_png(all, path);
}

}  // namespace
}  // namespace sunfleck

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  sunfleck::with_threads(1, [&] {
    sunfleck::draw(argv[1], argc > 2 ? argv[2] : "Fagus sylvatica", argc > 3 ? std::atoi(argv[3]) : 16);
  });
}
