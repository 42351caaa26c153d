// Light inside a growing tree, from its own leaf area and what stands round it: the fast approximation that
// growth uses where nobody answers with better light. It knows the sky only (no sun, no scattering).
//
// Leaf area lies in cubic cells. Light at a point is the share of a uniform sky's light on a level surface
// that comes through: 13 directions (the zenith for the inner fifth of sin^2(zenith), 4 at 39 degrees for the
// next two, 8 at 63 degrees for the last two fifths), each dimmed by Beer's law, exp(-0.5 LAI along it). The
// cell of the point itself does not shade it, nor does what lies outside the grid. Good to about a tenth in
// crowns of many cells; a coarse cell smears single leaves.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "sim/base/vec.h"

namespace sunfleck {

struct LeafPlace {
  Vec3 position_m;
  double area_m2;
  Vec3 normal{0, 0, 1};  // unit; the grid knows no angles, other light does
};

struct LightGridOptions {
  double cell_m = 0.4;
  double half_width_m = 12;        // the grid reaches so far from the stem to all sides ...
  double height_m = 40;            // ... and so high
  std::optional<double> period_m;  // instead of the width: equal trees stand so far apart, in a square
  std::vector<Box> walls;          // opaque
};

class LightGrid {
 public:
  // Throws Error(kInvalidInput) for sizes that are not positive or a grid of more than 2e7 cells.
  explicit LightGrid(LightGridOptions options);
  // Forgets the leaves there were and takes these; those outside the grid are left out (with a period: taken
  // back into it).
  void set_leaves(std::span<const LeafPlace> leaves);
  // 0 (dark, inside a wall or the ground, z <= 0) to 1 (open sky).
  double openness(const Vec3& position_m) const;
  // False where equal trees stand around and the place is theirs: crowns push past each other by 15 % of the
  // distance and no more (they wear each other's buds off), so farther than 0.65 of the period from the stem.
  bool has_room(const Vec3& position_m) const;

 private:
  std::optional<std::size_t> cell_at(const Vec3& position_m) const;
  bool behind_wall(const Vec3& from_m, const Vec3& to_sky) const;
  double optical_depth(const Vec3& from_m, const Vec3& to_sky) const;

  LightGridOptions options_;
  double width_m_;
  int across_, up_;
  std::vector<float> density_per_m_;  // leaf area per volume, [z][y][x]
};

}  // namespace sunfleck
