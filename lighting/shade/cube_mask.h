// The shadow masks of [LeafMask] as published: one cube map of leaves round a leaf's centre, read where the
// way to the sun leaves a sphere; one layer, or four concentric ones. KEPT TO COMPARE: the distance form
// misses the mean by up to 0.16 and gives shadows that are correlated over too long or too short a way
// (design sheet 7.3); shadow_tile.h is what to use. The rank form of the cube (mean right, shadows still too
// large) is here too.
//
// A point P1 of a leaf centred at P looks at w = q + t l, q = P1 - P, |w| = r_k. It is lit in layer k if
//   distance form: the first leaf of the shell along w is farther than s, the way to the crown's border;
//   rank form: the rank of that distance in the map, by solid angle, is above 1 - T_k.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lighting/shade/mask_leaves.h"
#include "sim/base/run_control.h"

namespace sunfleck {

enum class MaskForm { kDistance, kRank };
inline constexpr int kMostMaskLayers = 4;

struct CubeMask {
  MaskForm form = MaskForm::kDistance;
  int side = 0, layers = 0;
  std::array<double, kMostMaskLayers + 1> shell_m{};  // borders of the layers
  std::array<double, kMostMaskLayers> radius_m{};     // of the sphere each is read on
  std::vector<float> value;  // [layer][face][row][column]: metres (no leaf: infinity), or rank in (0, 1), 2
};

struct CubeMaskOptions {
  MaskForm form = MaskForm::kDistance;
  int layers = 1;  // 1 or 4
  int side = 128;  // texels of a face, 16 .. 1024
  std::uint64_t seed = 1;
};
// Leaves in a ball of four free paths. Throws Error(kInvalidInput) for options out of range, and
// Error(kLimitExceeded) above 20 million leaves (leaves tiny against their free path).
CubeMask build_cube_mask(const MaskLeaves& leaves, const CubeMaskOptions& options,
                         const RunControl& control = {});

struct CubeQuery {
  Vec3 from_centre_m{0};  // q
  Vec3 to_light{0, 0, 1};
  double way_m = 0;  // s, to the crown's border: distance form, and the layers that count
  std::array<float, kMostMaskLayers> transmittance{1, 1, 1, 1};  // T_k: rank form
  std::uint32_t leaf = 0;  // 0: the map as it is; else turned at random by this number
};
bool cube_lit(const CubeMask& mask, const CubeQuery& query);

// T_k of a way of length s through leaves of even extinction: layer by layer.
std::array<float, kMostMaskLayers> layer_transmittances(const CubeMask& mask, double extinction_per_m,
                                                        double way_m);

}  // namespace sunfleck
