// The way of a ray through a scene that may end at a ground plane and may repeat: straight pieces inside the
// base cell, each with its own origin there, so that no piece is far from its numbers. Coordinates are the
// scene's (moved by its centre). Height is measured above the ground plane; outside [floor, ceiling] of that
// height there is nothing to hit.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "lighting/trace/embree_scene.h"

namespace sunfleck::trace {

struct Surroundings {
  bool ground = true;
  double ground_at_centre_m = 0;  // height of the ground plane at (0, 0)
  Vec2 ground_rise{0};            // its slope per metre of x and y
  double floor_m = 0, ceiling_m = 0;
  double rounding_m = 0;  // distances below this are noise of the coordinates
  bool periodic = false;
  Vec2 cell_lo{0}, cell_size{0};
  int max_wraps = 10'000;

  double height_above_ground(const Vec3& p) const {
    return p.z - ground_at_centre_m - ground_rise.x * p.x - ground_rise.y * p.y;
  }
};

struct Piece {
  Vec3 origin;
  double near_m, far_m;  // along the piece
  double before_m;       // of the ray before the piece's origin
  Cell cell;
};

struct RayEnd {
  enum Kind { kStopped, kSky, kGround, kGroundFromBelow } kind = kSky;
  double distance_m = 0;
};

// Where a ray that meets nothing ends.
inline RayEnd free_end(const Surroundings& s, const Vec3& origin, const Vec3& direction) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double height = s.height_above_ground(origin);
  const double climb = direction.z - s.ground_rise.x * direction.x - s.ground_rise.y * direction.y;
  if (s.ground && height >= -4.0 * s.rounding_m) {
    if (climb < 0.0) return {RayEnd::kGround, std::max(0.0, -height / climb)};
  } else if (s.ground && climb > 0.0) {
    return {RayEnd::kGroundFromBelow, -height / climb};
  }
  if (climb > 0.0) return {RayEnd::kSky, std::max(0.0, (s.ceiling_m - height) / climb)};
  if (climb < 0.0) return {RayEnd::kSky, std::max(0.0, (s.floor_m - height) / climb)};
  return {RayEnd::kSky, height > s.ceiling_m || height < s.floor_m ? 0.0 : kNever};
}

// The point of the base cell that stands for p, which lies `cell` away; heights above ground are kept.
inline Vec3 into_base_cell(const Surroundings& s, const Vec3& p, const Cell& cell) {
  const double dx = cell.x * s.cell_size.x, dy = cell.y * s.cell_size.y;
  return {p.x - dx, p.y - dy, p.z - s.ground_rise.x * dx - s.ground_rise.y * dy};
}

inline Cell cell_of(const Surroundings& s, const Vec3& p) {
  return {static_cast<std::int32_t>(std::floor((p.x - s.cell_lo.x) / s.cell_size.x)),
          static_cast<std::int32_t>(std::floor((p.y - s.cell_lo.y) / s.cell_size.y))};
}

// Distance along a ray to the border it leaves a cell [lo, lo + size] by, on one axis.
inline double distance_to_border(double lo, double size, double p, double d) {
  if (d > 0.0) return std::max(0.0, (lo + size - p) / d);
  if (d < 0.0) return std::max(0.0, (lo - p) / d);
  return std::numeric_limits<double>::infinity();
}

// Steps a piece into the next cell.
inline void cross_border(const Surroundings& s, const Vec3& direction, double leave_m, bool crosses_x,
                         Piece& piece) {
  const Vec3 p = piece.origin + leave_m * direction;
  Cell step;
  if (crosses_x)
    step.x = direction.x > 0.0 ? 1 : -1;
  else
    step.y = direction.y > 0.0 ? 1 : -1;
  piece.origin = into_base_cell(s, p, step);
  // Exactly on or inside the borders, so that rounding cannot trap the ray.
  const Vec2 hi = s.cell_lo + s.cell_size;
  if (step.x != 0) piece.origin.x = step.x > 0 ? s.cell_lo.x : hi.x;
  if (step.y != 0) piece.origin.y = step.y > 0 ? s.cell_lo.y : hi.y;
  piece.origin.x = std::clamp(piece.origin.x, s.cell_lo.x, hi.x);
  piece.origin.y = std::clamp(piece.origin.y, s.cell_lo.y, hi.y);
  piece.before_m += leave_m;
  piece.near_m = std::max(0.0, piece.near_m - leave_m);
  piece.cell.x += step.x;
  piece.cell.y += step.y;
}

// Calls visit(piece) for each straight piece until it returns true (then the end is kStopped).
template <class Visit>
RayEnd walk(const Surroundings& s, const Vec3& origin, const Vec3& direction, double min_m, Visit&& visit) {
  const RayEnd end = free_end(s, origin, direction);
  // A leaf that lies on the ground is met before the ground.
  const double last_m = end.distance_m + s.rounding_m;
  Piece piece{origin, min_m, last_m, 0.0, {}};
  if (!s.periodic) return visit(piece) ? RayEnd{RayEnd::kStopped, 0.0} : end;
  piece.cell = cell_of(s, origin);
  piece.origin = into_base_cell(s, origin, piece.cell);
  for (int wraps = 0; wraps <= s.max_wraps; ++wraps) {
    const double x_m = distance_to_border(s.cell_lo.x, s.cell_size.x, piece.origin.x, direction.x);
    const double y_m = distance_to_border(s.cell_lo.y, s.cell_size.y, piece.origin.y, direction.y);
    const double leave_m = std::min(x_m, y_m), rest_m = last_m - piece.before_m;
    piece.far_m = std::min(leave_m + s.rounding_m, rest_m);
    if (piece.far_m > piece.near_m && visit(piece)) return {RayEnd::kStopped, 0.0};
    if (leave_m >= rest_m) return end;
    cross_border(s, direction, leave_m, x_m <= y_m, piece);
  }
  return end;
}

}  // namespace sunfleck::trace
