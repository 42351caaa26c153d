// Figures as numbers that a place of the picture is put into: whether it shows the figure, and how near.
//
// A plane figure c + a u + b v seen through place (x, y): in perspective the place's ray is t (x', y', 1) and
//   a = (v x c) . r / n . r,  b = (c x u) . r / n . r,  1 / t = n . r / n . c,   r = (x', y', 1), n = u x v
// (homogeneous rasterising, Olano and Greer 1997): three linear forms over the picture, no division, right
// for figures that reach behind the camera. Orthographic: a, b and depth are linear themselves. A cone's side
// or a cylinder: the point of the ray at the base's depth and the ray's direction, each split along the axis,
// along the normal of axis and view, and across both: six linear forms, then the quadratic. Forms count
// places from a corner near the figure, so that single precision keeps its digits.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "lighting/render/raster_figures.h"
#include "lighting/render/raster_frame.h"

namespace sunfleck {

struct LinearForm {
  float at_corner = 0, per_x = 0, per_y = 0;
};

struct FlatForms {
  LinearForm a, b, nearness;  // a and b times the nearness in perspective
};

struct RoundForms {
  LinearForm across, beside, along;         // of the ray's point at the depth of the base, m
  LinearForm run_across, run_beside, rise;  // of the ray's direction, per metre of depth
  float depth_m = 0;                        // of the base
  float radius_m = 0, taper = 0, length_m = 0, extinction_per_m = 0;
};

// Rows of the picture that a figure may touch, cut by up to four lines: x in [lo, hi] of row y.
struct RowCuts {
  struct Line {
    float at_corner, per_row;  // x of the line where the row begins, counted from the corner
    bool is_lower;
  };
  std::array<Line, 4> lines;
  int count = 0;

  // Places with f >= 0 belong to the figure. The row spans y to y + 1: the more generous edge counts.
  void keep(const LinearForm& f) {
    if (!(std::abs(f.per_x) > 1e-30f)) return;
    const float inverse = -1.0f / f.per_x;
    lines[static_cast<std::size_t>(count++)] = {(f.at_corner + std::max(0.0f, f.per_y)) * inverse,
                                                f.per_y * inverse, f.per_x > 0.0f};
  }
  void cut(float row, float& lo, float& hi) const {
    for (int i = 0; i < count; ++i) {
      const Line& l = lines[static_cast<std::size_t>(i)];
      const float x = l.at_corner + row * l.per_row;
      if (l.is_lower)
        lo = std::max(lo, x);
      else
        hi = std::min(hi, x);
    }
  }
};

// A tree as the frame sees it: rows over tree coordinates.
struct PlacedView {
  Vec3 x_row, y_row, z_row;  // per metre of the tree
  Vec3 foot;                 // in the frame
  double scale = 1;

  PlacedView(const RasterFrame& frame, const Instance& at, const Vec3& shift_m) : scale(at.scale) {
    const double c = std::cos(static_cast<double>(at.yaw_rad)) * scale,
                 s = std::sin(static_cast<double>(at.yaw_rad)) * scale;
    const auto row = [&](const Vec3& axis) {
      return Vec3(c * axis.x + s * axis.y, c * axis.y - s * axis.x, scale * axis.z);
    };
    x_row = row(frame.right), y_row = row(frame.down), z_row = row(frame.forward);
    foot = frame.from_world(at.position_m + shift_m);
  }
  Vec3 direction(const Vec3f& d) const {
    const Vec3 p(d);
    return {glm::dot(x_row, p), glm::dot(y_row, p), glm::dot(z_row, p)};
  }
  Vec3 point(const Vec3f& p) const { return direction(p) + foot; }
  // Half the box round a box of these half sides.
  Vec3 reach(const Vec3& half) const {
    return {glm::dot(glm::abs(x_row), half), glm::dot(glm::abs(y_row), half),
            glm::dot(glm::abs(z_row), half)};
  }
};

inline LinearForm form_of(const Vec3& w, const Vec2& ray_at_corner, double per_px) {
  return {static_cast<float>(w.x * ray_at_corner.x + w.y * ray_at_corner.y + w.z),
          static_cast<float>(w.x * per_px), static_cast<float>(w.y * per_px)};
}

// `corner_px`: the place from which forms count. None where the figure is seen edge-on.
std::optional<FlatForms> flat_forms(const RasterFrame& frame, const Vec3& centre, const Vec3& u,
                                    const Vec3& v, const Vec2& corner_px);
RoundForms round_forms(const RasterFrame& frame, const RoundFigure& figure, const Vec3& base,
                       const Vec3& axis, double scale, const Vec2& corner_px);

RowCuts cuts_of(const FlatForms& forms, FlatShape shape, bool perspective);
// The band across the picture that holds a frustum whose ends do not reach behind the camera.
RowCuts cuts_of(const RasterFrame& frame, const Vec3& base, const Vec3& tip, double widest_m,
                const Vec2& corner_px);

}  // namespace sunfleck
