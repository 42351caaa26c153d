// Sunflecks from the tile: the stored share on every leaf, the shadow's statistics of a crown, equal pictures
// for any number of threads.
#include "lighting/render/leaf_flecks.h"

#include <gtest/gtest.h>

#include "lighting/render/image_difference.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/forest/generated_scenes.h"
#include "tests/lighting/render/bush_scene.h"

namespace sunfleck {
namespace {

struct Crown {
  test::RenderScene scene = test::traced_bush();
  LightMap map;
  ForestIndex index{scene.forest};
  PictureScene picture{scene.forest, scene.look, {}};
  explicit Crown(double share) : map(scene.map()) {
    map.sunlit_fraction.assign(index.element_count(), static_cast<float>(share));
  }
  Crown(const Crown&) = delete;
};

RayHit place_on(const Forest& forest, std::uint32_t leaf, double a, double b) {
  const FoliageElement& e = forest.prototypes[0].foliage[leaf];
  RayHit hit;
  hit.kind = HitKind::kFoliage;
  hit.local = leaf;
  hit.on_original_m = hit.position_m = Vec3(e.centre_m) + a * Vec3(e.half_u_m) + b * Vec3(e.half_v_m);
  return hit;
}

// Share of a leaf's points that are lit, 24 x 24 of them; mean and spread over all leaves.
struct Shares {
  double mean = 0, rms_off = 0;
};
Shares shares_of(const Crown& c, const LeafFlecks& flecks, double stored) {
  Shares s;
  const auto leaves = static_cast<std::uint32_t>(c.index.element_count());
  for (std::uint32_t leaf = 0; leaf < leaves; ++leaf) {
    int lit = 0;
    for (int i = 0; i < 24; ++i)
      for (int j = 0; j < 24; ++j)
        lit +=
            flecks.lit(place_on(c.scene.forest, leaf, (2 * i + 1) / 24.0 - 1, (2 * j + 1) / 24.0 - 1), leaf);
    s.mean += lit / 576.0 / leaves;
    s.rms_off += (lit / 576.0 - stored) * (lit / 576.0 - stored) / leaves;
  }
  s.rms_off = std::sqrt(s.rms_off);
  return s;
}

// Every leaf shows the share that is stored for it: as 20 points tell its quantile, sqrt(T (1 - T) / 21) if
// they were random (and half more, since points within a leaf hang together), and in the mean over 500 leaves
// far better: .02, for leaves that are all turned alike.
TEST(LeafFlecks, ALeafShowsItsStoredShare) {
  for (const double share : {0.05, 0.2, 0.5, 0.8, 0.95}) {
    const Crown c(share);
    const LeafFlecks flecks(c.scene.forest, c.picture, c.map, c.scene.light.to_sun, {});
    const Shares s = shares_of(c, flecks, share);
    std::cout << "stored " << share << ": mean " << s.mean << ", RMS " << s.rms_off << "\n";
    EXPECT_NEAR(s.mean, share, 0.02) << share;
    EXPECT_LT(s.rms_off, 1.5 * std::sqrt(share * (1 - share) / 21)) << share;
  }
}

TEST(LeafFlecks, NoneAndAll) {
  for (const double share : {0.0, 1.0}) {
    const Crown c(share);
    const LeafFlecks flecks(c.scene.forest, c.picture, c.map, c.scene.light.to_sun, {});
    EXPECT_NEAR(shares_of(c, flecks, share).mean, share, 1e-9);  // a sum of 500
  }
}

// Smooth shares: the mean over leaves is the share, and leaves differ as the tile's patches do.
TEST(LeafFlecks, SmoothSharesLeaveLeavesDifferent) {
  Crown c(0.3);
  c.map.provenance.method = "grid";
  EXPECT_FALSE(knows_single_leaves(c.map));
  const LeafFlecks flecks(c.scene.forest, c.picture, c.map, c.scene.light.to_sun, {});
  const Shares s = shares_of(c, flecks, 0.3);
  // Shares of a leaf spread by .46 sqrt(.6) = .35; 500 leaves: .016, three of them.
  EXPECT_NEAR(s.mean, 0.3, 0.048);
  EXPECT_GT(s.rms_off, 0.2);  // twice what leaves of a stored share may be off
}

// Between traced and stored sunlight: the same light in the mean, no rays; the picture differs from the
// traced one by where flecks lie. The bush is 48 pixels wide, a leaf 2 to 3.
TEST(LeafFlecks, APictureKeepsItsLight) {
  const test::RenderScene scene = test::traced_bush();
  const LightMap map = test::reference_map(scene);
  const OpticsTable optics(scene.forest, scene.optics_request);
  const auto picture = [&](LeafSun sun) {
    return render(scene.forest, optics, map, {test::bush_view(64), scene.light, scene.look, {}, sun}, {});
  };
  const Image traced = picture(LeafSun::kTraced), tile = picture(LeafSun::kTile);
  const ImageDifference d = image_difference(tile, traced);
  std::cout << "tile against traced: mean " << d.bias << ", absolute " << d.mean_absolute << ", SSIM "
            << d.ssim << ", FLIP " << d.flip << "\n";
  EXPECT_LT(std::abs(d.bias), 0.01);
  EXPECT_LT(d.mean_absolute, 0.1);
  EXPECT_GT(d.ssim, 0.9);
  Image one, many;
  with_threads(1, [&] { one = picture(LeafSun::kTile); });
  with_threads(3, [&] { many = picture(LeafSun::kTile); });
  EXPECT_EQ(one.rgb, many.rgb);
}

TEST(LeafFlecks, AMapWithoutSharesIsRefused) {
  const test::RenderScene scene = test::traced_bush();
  LightMap map = scene.map();
  map.sunlit_fraction.clear();
  EXPECT_THROW(render(scene.forest, OpticsTable(scene.forest, scene.optics_request), map,
                      {test::bush_view(1), scene.light, scene.look, {}, LeafSun::kTile}, {}),
               Error);
}

}  // namespace
}  // namespace sunfleck
