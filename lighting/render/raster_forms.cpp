#include "lighting/render/raster_forms.h"

namespace sunfleck {
namespace {

LinearForm sum(const LinearForm& f, const LinearForm& g, float times) {
  return {f.at_corner + times * g.at_corner, f.per_x + times * g.per_x, f.per_y + times * g.per_y};
}

std::optional<FlatForms> perspective_forms(const RasterFrame& frame, const Vec3& c, const Vec3& u,
                                           const Vec3& v, const Vec2& corner_px) {
  const Vec3 n = glm::cross(u, v);
  const double way = glm::dot(n, c);
  if (!(way * way > 1e-24 * glm::dot(n, n) * glm::dot(c, c))) return std::nullopt;
  const double inverse = 1.0 / way, per_px = 1.0 / frame.px_per_unit;
  const Vec2 ray = (corner_px - frame.centre_px) * per_px;
  return FlatForms{form_of(inverse * glm::cross(v, c), ray, per_px),
                   form_of(inverse * glm::cross(c, u), ray, per_px), form_of(inverse * n, ray, per_px)};
}

std::optional<FlatForms> orthographic_forms(const RasterFrame& frame, const Vec3& c, const Vec3& u,
                                            const Vec3& v, const Vec2& corner_px) {
  const double det = u.x * v.y - u.y * v.x;
  if (!(det * det > 1e-24 * glm::dot(u, u) * glm::dot(v, v))) return std::nullopt;
  const double inverse = 1.0 / det, per_px = 1.0 / frame.px_per_unit;
  const Vec2 from = (corner_px - frame.centre_px) * per_px - Vec2(c);
  const Vec3 a(v.y * inverse, -v.x * inverse, 0.0), b(-u.y * inverse, u.x * inverse, 0.0);
  const Vec3 near(-(a.x * u.z + b.x * v.z), -(a.y * u.z + b.y * v.z), -c.z);
  return FlatForms{form_of(a, from, per_px), form_of(b, from, per_px), form_of(near, from, per_px)};
}

}  // namespace

std::optional<FlatForms> flat_forms(const RasterFrame& frame, const Vec3& centre, const Vec3& u,
                                    const Vec3& v, const Vec2& corner_px) {
  return frame.perspective ? perspective_forms(frame, centre, u, v, corner_px)
                           : orthographic_forms(frame, centre, u, v, corner_px);
}

RoundForms round_forms(const RasterFrame& frame, const RoundFigure& figure, const Vec3& base,
                       const Vec3& axis, double scale, const Vec2& corner_px) {
  const double per_px = 1.0 / frame.px_per_unit;
  const Vec2 corner = (corner_px - frame.centre_px) * per_px;
  const Vec3 view = frame.perspective ? base : Vec3(0, 0, 1);
  Vec3 across = glm::cross(axis, view);
  const double sine = glm::length(across);
  across = sine > 1e-6 * glm::length(view) ? across / sine : basis_around(axis).tangent;
  const Vec3 beside = glm::cross(across, axis);
  RoundForms f;
  const auto split = [&](const Vec3& part, LinearForm& point, LinearForm& way) {
    if (frame.perspective) {
      way = form_of(part, corner, per_px);
      // depth * ray - base, counted from the base's own place so that nothing large is subtracted.
      const Vec2 from = base.z * corner - Vec2(base);
      point = {static_cast<float>(part.x * from.x + part.y * from.y),
               static_cast<float>(part.x * per_px * base.z), static_cast<float>(part.y * per_px * base.z)};
    } else {
      way = {static_cast<float>(part.z), 0.0f, 0.0f};
      const Vec2 from = corner - Vec2(base);
      point = {static_cast<float>(part.x * from.x + part.y * from.y), static_cast<float>(part.x * per_px),
               static_cast<float>(part.y * per_px)};
    }
  };
  split(across, f.across, f.run_across);
  split(beside, f.beside, f.run_beside);
  split(axis, f.along, f.rise);
  f.depth_m = static_cast<float>(base.z);
  f.radius_m = static_cast<float>(scale * figure.radius);
  f.taper = figure.taper;
  f.length_m = static_cast<float>(scale * figure.length);
  f.extinction_per_m = static_cast<float>(figure.extinction_per_m / scale);
  return f;
}

RowCuts cuts_of(const FlatForms& f, FlatShape shape, bool perspective) {
  RowCuts cuts;
  const LinearForm most = perspective ? f.nearness : LinearForm{1.0f, 0.0f, 0.0f};
  if (shape == FlatShape::kTriangle) {
    cuts.keep(f.a);
    cuts.keep(f.b);
    cuts.keep(sum(sum(most, f.a, -1.0f), f.b, -1.0f));
    return cuts;
  }
  for (const LinearForm* side : {&f.a, &f.b}) {
    cuts.keep(sum(most, *side, 1.0f));
    cuts.keep(sum(most, *side, -1.0f));
  }
  return cuts;
}

RowCuts cuts_of(const RasterFrame& frame, const Vec3& base, const Vec3& tip, double widest_m,
                const Vec2& corner_px) {
  RowCuts cuts;
  const auto place = [&](const Vec3& p) {
    return frame.centre_px - corner_px + frame.px_per_unit / (frame.perspective ? p.z : 1.0) * Vec2(p);
  };
  // In perspective a ball of radius r at z spreads to r / (z - r) and less than its slant adds.
  const double nearest_z = std::min(base.z, tip.z) - widest_m;
  if (frame.perspective && !(nearest_z > widest_m)) return cuts;
  const Vec2 from = place(base), to = place(tip);
  const double length = glm::length(to - from);
  if (!(length > 1e-6)) return cuts;
  double half_px = frame.px_per_unit * widest_m;
  if (frame.perspective) {
    const Vec2 widest_tangent = glm::max(glm::abs(Vec2(base) / base.z), glm::abs(Vec2(tip) / tip.z));
    half_px *= std::sqrt(1.0 + glm::dot(widest_tangent, widest_tangent)) / nearest_z;
  }
  half_px = 1.001 * half_px + 1e-3;
  const Vec2 normal = Vec2(from.y - to.y, to.x - from.x) / length;
  const double at = glm::dot(normal, from);
  const auto fx = static_cast<float>(normal.x), fy = static_cast<float>(normal.y);
  cuts.keep({static_cast<float>(half_px - at), fx, fy});
  cuts.keep({static_cast<float>(half_px + at), -fx, -fy});
  return cuts;
}

}  // namespace sunfleck
