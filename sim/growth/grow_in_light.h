// A tree that grows year by year by the light its buds get: an open L-system whose ?E modules light answers.
//
// Each year the tree's foliage is handed to the light; then every bud asks how much there is (?E, 0 dark to 1
// open sky) and the grammar decides its fate: a long shoot, a short one, or death. Leaves live a year, so a
// branch whose buds have died is bare and is shed: light makes the clear bole, the length of the crown and
// its sides. Nothing is fitted: height, crown and leaf area are what grew; wood follows from the pipe model
// with twigs of a given thickness. Deciduous trees only (the grammars let all leaves fall every year).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

#include "sim/base/run_control.h"
#include "sim/growth/light_grid.h"
#include "sim/plant/prototype.h"
#include "sim/plant/species.h"

namespace sunfleck {

// How growth asks for light: sim computes none but its own approximation; any estimator can answer.
struct BudLight {
  // Once a year, before buds ask: this year's foliage of the tree.
  std::function<void(std::span<const LeafPlace>)> new_year;
  // Light at a bud relative to open sky, 0 to 1. Safe from many threads at once.
  std::function<double(const Vec3& position_m)> at;
};
// The grid's openness where there is room, else 0. The grid must live as long as the answers are used.
BudLight light_of(LightGrid& grid);

struct GrowthOptions {
  int years = 25;            // 1 to 500
  double stop_height_m = 0;  // above 0: stops in the year that reaches it
  std::uint64_t seed = 1;
  double twig_radius_m = 0.0006;             // of the wood below a single leaf
  std::size_t most_leaves = 500000;          // of a tree; more: Error(kLimitExceeded)
  std::size_t most_leaves_in_all = 4000000;  // of a stand that grows together: about 1 GB
};

// Throw Error(kInvalidInput) naming "growth: <field>": a number out of range; an answer that is missing.
void validate(const GrowthOptions& options);
void validate(const BudLight& light);

struct GrownTree {
  Prototype tree;
  int years = 0;  // that it grew
};

// `grammar` is one with ?E(light) behind its buds, such as configs/grammars/fagus_sylvatica_in_light.lsys;
// leaves have the size of the species' template. Throws Error(kInvalidInput) for options out of range and for
// light that is not a number from 0 to 1, Error(kCancelled) when stopped.
GrownTree grow_in_light(const Species& species, const std::filesystem::path& grammar, const BudLight& light,
                        const GrowthOptions& options, const RunControl& control = {});

}  // namespace sunfleck
