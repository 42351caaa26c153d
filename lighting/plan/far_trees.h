// Trees that an answer for a few selected trees can do without, and a bound on what leaving them out
// changes.
//
// Every change of the light on a selected element goes along a path of light that begins there and meets a
// tree that was left out: traced backwards, a path that meets none of them is the same with and without
// them. So paths are traced from random selected elements through the whole forest. What a path with weight k
// may bring in direction w, once it meets a tree that is left out, is an upper limit of its change,
//
//   k max(pi L_sky(w), a E0 / (1 - a))
//
// the most that sky or surfaces send, with E0 the sun and sky on a face turned any way and a the largest
// albedo, as in plan.h; where such a tree hides the sun from a place on the path, so is the sunlight lost.
// Direct sun on the selected trees is treated apart, without chance: a tree whose shadow could fall on one of
// them, by their enclosing balls and the sun's disc, stays.
//
// The bound is on the root mean square over the selected elements of the change of front + back irradiance,
// relative to their mean, in the band where it is largest. It is an upper limit that holds about 99 times in
// 100 (normal approximation over elements, and the rule of three for what no path met). The trees are chosen
// with one half of the elements and the bound comes from the other. It is about light, not about a method's
// own errors: fewer trees can mean finer cells and other random numbers.
//
// Geometry alone bounds nothing of use: not knowing what hides a tree, all trees beyond a radius fill the
// band of the sky below their height, which for trees of 20 m still holds 1 % of an even sky's light on an
// upright leaf at 2.5 km.
#pragma once

#include <cstdint>
#include <vector>

#include "lighting/optics/optics.h"
#include "lighting/sky/illumination.h"
#include "lighting/trace/probe_light.h"
#include "sim/base/run_control.h"
#include "sim/forest/forest.h"

namespace sunfleck {

struct FarTreesOptions {
  double most_change = 0.005;  // relative, as above; > 0
  int elements = 2000;         // drawn by lot, half for choosing, half for the bound
  int paths_per_face = 64;     // even: in two independent halves
  std::uint64_t seed = 1;
};

struct FarTrees {
  std::vector<std::uint32_t> far, near;  // instances, rising; near: all others, the selected ones among them
  double bound = 0;                      // of leaving `far` out; at most most_change
  std::size_t paths = 0;                 // that were traced
  bool any() const { return !far.empty(); }
};

// `scene`: of the whole forest; `selected`: instances, rising; `light` as returned by checked(). The same
// answer for any number of threads. Stage "finding far trees".
FarTrees find_far_trees(const ProbeScene& scene, const OpticsTable& optics, const Illumination& light,
                        const std::vector<std::uint32_t>& selected, const FarTreesOptions& options,
                        const RunControl& control);

// Whether direct sun may be hidden from `from` by `by`, by their enclosing balls; both may be the same tree.
// In a forest that repeats: by any copy.
bool may_hide_sun(const Forest& forest, const Illumination& light, std::uint32_t by, std::uint32_t from);

}  // namespace sunfleck
