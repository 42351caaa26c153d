// Served renders equal local ones: the files byte by byte, the tiles as half floats; together the tiles cover
// the image once.
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "server/convert/half.h"
#include "tests/server/served.h"
#include "tests/support/golden.h"

namespace sunfleck::test {
namespace {

std::string bytes_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

TEST(RenderService, ServedEqualsLocalByteByByte) {
  const ForestSpec spec = row_of_trees(3, 300);
  const LightRequest light = noon(Method::kSppG);
  const Camera camera = small_camera();
  const Forest forest = grow_forest(spec, species(), {});
  const LightMap map = compute_light_map(forest, light, {}, {});
  const Image local = render(forest, OpticsTable(forest, light.optics), map, {camera, light.light}, {});
  const std::filesystem::path folder = scratch_dir();
  save_exr(local, folder / "local.exr");
  save_png(local, folder / "local.png");

  ServedProcess server;
  Client client = server.client();
  std::set<std::pair<int, int>> pixels;
  std::size_t wrong = 0, covered = 0;
  const auto check = [&](const RemoteTile& tile) {
    EXPECT_LE(tile.width_px, 64);
    EXPECT_LE(tile.height_px, 64);
    for (int y = 0; y < tile.height_px; ++y) {
      for (int x = 0; x < 3 * tile.width_px; ++x) {
        const std::size_t there =
            static_cast<std::size_t>(3 * ((tile.y0_px + y) * camera.width_px + tile.x0_px) + x);
        const float got = tile.rgb.at(static_cast<std::size_t>(y * 3 * tile.width_px + x));
        if (got != float_from_half_bits(half_bits(local.rgb[there]))) ++wrong;
        if (x % 3 == 0) pixels.insert({tile.x0_px + x / 3, tile.y0_px + y});
      }
    }
    covered += static_cast<std::size_t>(tile.width_px * tile.height_px);
  };
  const RemoteRender served =
      client.render(client.create_scene(spec).name, light, camera, {}, Client::Files::kExrAndPng, {}, check);
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(covered, 150u * 100u);
  EXPECT_EQ(pixels.size(), 150u * 100u);
  EXPECT_EQ(served.tiles, 6u);  // 3 columns x 2 rows
  EXPECT_EQ(served.width_px, 150);
  EXPECT_TRUE(served.exr == bytes_of(folder / "local.exr"));
  EXPECT_TRUE(served.png == bytes_of(folder / "local.png"));
  EXPECT_GT(served.mean_rgb, 0.0);
}

TEST(RenderService, UsesTheLightMapThatWasStreamedBefore) {
  ServedProcess server;
  Client client = server.client();
  const std::string scene = client.create_scene(row_of_trees(2, 200)).name;
  const LightRequest light = noon(Method::kReference);
  client.light_map(scene, light);
  client.render(scene, light, small_camera(), {}, Client::Files::kNone);
  EXPECT_EQ(load_of(client, "light_maps"), 1u);
}

}  // namespace
}  // namespace sunfleck::test
