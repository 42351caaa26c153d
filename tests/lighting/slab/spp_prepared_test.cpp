// Prepared once, asked often: the same bytes as one call; light by cell as the mean of light by leaf; a
// change of sky as a sum; and no more work per instance when there are more of them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "lighting/depth/opacity_neighbours.h"
#include "lighting/slab/compensation.h"
#include "lighting/slab/sun_depths.h"
#include "tests/lighting/slab/estimator_scene.h"

namespace sunfleck {
namespace {

using namespace test;

Forest stand(int side) {
  Forest forest = generated_crown({CrownKind::kSphere, 300, 1.0, 3.0, 8});
  const Instance first = forest.instances[0];
  forest.instances.clear();
  for (int i = 0; i < side * side; ++i) {
    Instance tree = first;
    tree.position_m += Vec3(1.9 * (i % side), 1.9 * (i / side), 0.0);
    tree.yaw_rad = 0.9f * static_cast<float>(i);
    tree.tree = TreeId{static_cast<std::uint32_t>(i)};
    forest.instances.push_back(tree);
  }
  return forest;
}

TEST(SppPrepared, AnswersLikeOneCall) {
  const Forest forest = stand(2);
  const OpticsTable optics = optics_of(forest, 0.3, 0.3, 0.2);
  for (const SppVariant variant : kAllVariants) {
    SppOptions options;
    options.variant = variant;
    const SppPrepared prepared = prepare_spp(forest, options, {});
    for (const double zenith : {20.0, 65.0}) {
      const Illumination light = light_of(sun_at(zenith), 700, 200, SkyModel::kStandardOvercast);
      const LightMap one = spp_light_map(forest, optics, light, options, {});
      const LightMap two = spp_light_map(forest, optics, light, prepared, {});
      const auto &a = one.bands[0].elements, &b = two.bands[0].elements;
      ASSERT_EQ(a.size(), b.size());
      EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]), 0);
      EXPECT_EQ(one.provenance.settings, two.provenance.settings);
    }
  }
}

// The vector code of the pipeline against sums of closed forms in double, cell by cell: 1e-5 of the mean
// (float rows and 11 float additions).
TEST(SppPrepared, SkyLightIsTheSumOfClosedForms) {
  const Forest forest = stand(2);
  const OpticsTable table = optics_of(forest, 0.45, 0.40);
  SppOptions options;
  options.variant = SppVariant::kSppG;
  const SppPrepared prepared = prepare_spp(forest, options, {});
  const auto optics = canopy_optics(forest, table)[0];
  const CellDepths& cells = prepared.cells;
  const std::size_t axes = cells.directions.axes();
  const auto sources = sky_sources(cells.directions, SkyModel::kUniform, {0, 0, 1});
  const ScatteredCells light = scattered_sky_light(
      sky_response(forest, prepared.grids, cells, {optics, 0.2, nullptr}, prepared.compensation, {}), sources,
      {});
  for (std::size_t c = 0; c < cells.cells; ++c) {
    const Instance& instance = forest.instances[prepared.grids.instance_of(c)];
    double sum = 0.0;
    for (std::size_t s = 0; s < axes; ++s) {
      std::vector<float> depths;
      std::vector<double> cosines;
      for (std::size_t j = 0; j < cells.directions.directions(); ++j) {
        depths.push_back(cells.depths(j)[c]);
        cosines.push_back(
            std::clamp(glm::dot(cells.directions.direction(j), cells.directions.upward(s)), -1.0, 1.0));
      }
      const double g = compensation(depths[s], depths[axes + s], depths, cosines);
      EXPECT_NEAR(prepared.compensation[s * cells.cells + c], g, 5e-6);
      const auto slab = spp<double>(depths[s], depths[axes + s],
                                    optics[0].medium(cells.turn_ratio_of(0, s, instance.yaw_rad), 0.2));
      sum += sources[s] * g * (slab.down + slab.up);
    }
    ASSERT_NEAR(light.sum[c], sum, 1e-5);
  }
}

// Sky of a new band in one pass: the same additions in the same order as with the response kept.
TEST(SppPrepared, SkyInOnePassIsTheSumOfItsKeptParts) {
  const Forest forest = stand(2);
  const auto optics = canopy_optics(forest, optics_of(forest, 0.45, 0.40))[0];
  for (const SppVariant variant : {SppVariant::kSpp, SppVariant::kSppG, SppVariant::kSppH}) {
    SppOptions options;
    options.variant = variant;
    const SppPrepared prepared = prepare_spp(forest, options, {});
    const ResponseMedium medium{optics, 0.2, variant == SppVariant::kSppH ? &prepared.angles : nullptr};
    const auto sources =
        sky_sources(prepared.cells.directions, SkyModel::kStandardOvercast, forest.terrain.normal());
    const ScatteredCells kept = scattered_sky_light(
        sky_response(forest, prepared.grids, prepared.cells, medium, prepared.compensation, {}), sources, {});
    const ScatteredCells at_once = scattered_sky_light(forest, prepared.grids, prepared.cells, medium,
                                                       prepared.compensation, sources, {});
    for (std::size_t c = 0; c < prepared.cells.cells; ++c) {
      // Rows are cut into registers at other places: last bits.
      ASSERT_NEAR(at_once.sum[c], kept.sum[c], 1e-6f);
      ASSERT_NEAR(at_once.drift_x[c], kept.drift_x[c], 1e-6f);
      ASSERT_NEAR(at_once.drift_z[c], kept.drift_z[c], 1e-6f);
    }
  }
}

// Depths by cell are measured with neighbours at the cell's centre, by leaf at each leaf: the same on
// average. Over 4 trees of 300 leaves the means of light agree to 2 %.
TEST(SppPrepared, SunByCellIsTheMeanOfSunByLeaf) {
  const Forest forest = stand(2);
  const ForestIndex index(forest);
  const SppPrepared prepared = prepare_spp(forest, {SppVariant::kSpp, 22, 64, 16, {}}, {});
  const auto optics = canopy_optics(forest, optics_of(forest, 0.45, 0.45))[0];
  const CellSun by_cell = measure_cell_sun(forest, prepared.grids, sun_at(50), 64, {});
  const CellSun by_leaf = mean_over_cells(forest, index, prepared.grids,
                                          measure_sun_depths(forest, index, sun_at(50), 64, {}), {});
  const auto mean_light = [&](const CellSun& sun) {
    const ScatteredCells light =
        scattered_sunlight(forest, prepared.grids, sun, {optics, 0.0, nullptr}, sun_at(50), {}, {});
    double sum = 0.0;
    for (const float v : light.sum) sum += v;
    return sum / static_cast<double>(light.sum.size());
  };
  EXPECT_NEAR(mean_light(by_cell), mean_light(by_leaf), 0.02 * mean_light(by_leaf));
  // A cell that holds one leaf, of a tree alone, has that leaf's depth.
  Forest lone = stand(1);
  const SppPrepared alone = prepare_spp(lone, {SppVariant::kSpp, 22, 64, 64, {}}, {});
  const ForestIndex one(lone);
  const CellSun cell = measure_cell_sun(lone, alone.grids, sun_at(50), 64, {});
  const SunDepths leaf = measure_sun_depths(lone, one, sun_at(50), 64, {});
  for (std::size_t c = 0; c < alone.grids.cells(); ++c) {
    const PrototypeGrid& grid = alone.grids.prototypes[0];
    if (grid.first[c + 1] - grid.first[c] == 1) {
      ASSERT_EQ(cell.before[c], leaf.before[grid.elements[grid.first[c]]]);
    }
  }
}

// Neighbours an instance looks at do not grow with the stand: work is linear in instances.
TEST(SppPrepared, LooksAtAsManyNeighboursInAnyStand) {
  const auto most_neighbours = [](int side) {
    const Forest forest = stand(side);
    const OpacityMap map(forest.prototypes[0], sun_at(50), 32, {});
    std::vector<PlacedMap> placed;
    for (const Instance& i : forest.instances)
      placed.push_back({&map, i.position_m, 1.0, 0.0, 1.0, prototype_bounds(forest.prototypes[0])});
    const OpacityNeighbours neighbours(forest, placed, sun_at(50));
    std::size_t most = 0;
    for (std::size_t i = 0; i < placed.size(); ++i) most = std::max(most, neighbours.around(i).size());
    return most;
  };
  // 12 trees are 23 m: lines at 50 degrees leave the crowns, 3 m high, long before.
  const std::size_t small = most_neighbours(12), large = most_neighbours(40);
  EXPECT_GT(small, 0u);
  EXPECT_EQ(large, small);
}

}  // namespace
}  // namespace sunfleck
