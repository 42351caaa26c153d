// Trees that grow up together: each year the foliage of all goes to the light, then the buds of all ask for
// it. Nobody sees this year's leaves of another, so the trees grow in parallel: the same stand for any number
// of threads.
//
// Besides light there is room: crowns push past the middle between two stems by 15 % of the stems' distance
// and no more (they wear each other's buds off), as far up as the neighbour reaches. Level ground. What a
// tree lacks below ground, wind, snow and deer are not known here.
#pragma once

#include <optional>
#include <vector>

#include "sim/growth/grow_in_light.h"

namespace sunfleck {

struct Seedling {
  const Species* species = nullptr;
  std::filesystem::path grammar;  // one with ?E(light), see configs/grammars/README.md
  Vec2 place_m{0};
  double yaw_rad = 0;  // world = place + Rz(yaw) * tree
  std::uint64_t seed = 1;
};

// Where the stand is, for whoever answers with light: `room` holds all that can grow in it (above z = 0).
struct GrowthSite {
  Box room;
  std::optional<Vec2> period_m;    // the stand repeats; `room` is then one period
  double cell_m = 0.4;             // wished resolution
  double leaf_reflectance = 0.08;  // of PAR, mean of the species
  double leaf_transmittance = 0.06;
  double soil_albedo = 0.1;
};
// The leaf-area grid (light_grid.h) over the site. Throws Error(kInvalidInput) for a site that repeats in
// anything but a square, and for more than 2e7 cells.
BudLight openness_light(const GrowthSite& site);

// The room of seedlings: as wide as their places and a margin, as high as `years` shoots can get.
GrowthSite site_of(std::span<const Seedling> seedlings, std::optional<Vec2> period_m, int years);

struct GrownStand {
  std::vector<Prototype> trees;  // as the seedlings; without foliage: died
  int years = 0;
};

// `light` is asked in the frame of the places; `site.period_m` says who neighbours whom. options.seed is not
// used (seedlings have their own), most_leaves holds for each tree; stops in the year in which the tallest
// reaches stop_height_m. Throws as grow_in_light() does, and for no seedlings at all.
GrownStand grow_together(std::span<const Seedling> seedlings, const GrowthSite& site, const BudLight& light,
                         const GrowthOptions& options, const RunControl& control = {});

}  // namespace sunfleck
