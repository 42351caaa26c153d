#include "lighting/shade/billboard_leaf.h"

#include <algorithm>
#include <cmath>

namespace sunfleck {
namespace {

// Smallest rotation that lays `normal` onto the plane's (either side), applied to v.
Vec3 turned_into(const Vec3& v, const Vec3& normal, const Vec3& onto) {
  const Vec3 axis = glm::cross(normal, onto);
  const double cosine = glm::dot(normal, onto);
  return v * cosine + glm::cross(axis, v) + axis * (glm::dot(axis, v) / (1 + cosine));
}

std::int16_t packed_edge(double edge_m, double scale_m) {
  return static_cast<std::int16_t>(std::lround(std::clamp(edge_m / scale_m, -1.0, 1.0) * 32767));
}

}  // namespace

Basis spread_axes(std::span<const FoliageElement> foliage, const LeafPlane& plane) {
  const Basis any = basis_around(plane.normal);
  double xx = 0, xy = 0, yy = 0;
  for (const std::uint32_t i : plane.leaves) {
    const Vec3 off = Vec3(foliage[i].centre_m) - plane.centre;
    const double x = glm::dot(off, any.tangent), y = glm::dot(off, any.bitangent);
    xx += x * x, xy += x * y, yy += y * y;
  }
  const double turn = 0.5 * std::atan2(2 * xy, xx - yy);
  const Vec3 u = std::cos(turn) * any.tangent + std::sin(turn) * any.bitangent;
  return {u, glm::cross(plane.normal, u)};
}

FlatLeaf flat_leaf(const FoliageElement& e, const LeafPlane& plane, const Basis& axes, bool turn) {
  FlatLeaf flat;
  Vec3 u(e.half_u_m), v(e.half_v_m);
  const Vec3 across = glm::cross(u, v), centre = Vec3(e.centre_m) - plane.centre;
  flat.normal = glm::length(across) > 0 ? glm::normalize(across) : plane.normal;
  if (glm::dot(flat.normal, plane.normal) < 0) flat.normal = -flat.normal;
  flat.height = glm::dot(centre, plane.normal);
  if (turn) {
    u = turned_into(u, flat.normal, plane.normal);
    v = turned_into(v, flat.normal, plane.normal);
  } else if (const double lift = glm::dot(flat.normal, plane.normal); lift > 0.05) {
    flat.rise = -Vec2(glm::dot(flat.normal, axes.tangent), glm::dot(flat.normal, axes.bitangent)) / lift;
  }
  flat.centre = {glm::dot(centre, axes.tangent), glm::dot(centre, axes.bitangent)};
  flat.half_u = {glm::dot(u, axes.tangent), glm::dot(u, axes.bitangent)};
  flat.half_v = {glm::dot(v, axes.tangent), glm::dot(v, axes.bitangent)};
  flat.shape = e.shape;
  return flat;
}

Bounds2 bounds_of(const FlatLeaf& leaf) {
  const Vec2 reach = glm::abs(leaf.half_u) + glm::abs(leaf.half_v);
  return {leaf.centre - reach, leaf.centre + reach};
}

bool covers(const FlatLeaf& leaf, const LeafMask& mask, const Vec2& p) {
  const double determinant = leaf.half_u.x * leaf.half_v.y - leaf.half_u.y * leaf.half_v.x;
  if (determinant == 0) return false;
  const Vec2 d = p - leaf.centre;
  return mask.covers((d.x * leaf.half_v.y - d.y * leaf.half_v.x) / determinant,
                     (leaf.half_u.x * d.y - leaf.half_u.y * d.x) / determinant);
}

LeafRecord packed(const FlatLeaf& leaf, const Billboard& board, const Vec2& corner, double scale_m,
                  const std::array<float, 4>& ambient) {
  const auto place = [](double at, double size) {
    return static_cast<std::uint16_t>(std::lround(std::clamp(at / size, 0.0, 1.0) * 65535));
  };
  LeafRecord record;
  record.position = {place(leaf.centre.x - corner.x, board.width_m),
                     place(leaf.centre.y - corner.y, board.height_m)};
  record.edges = {packed_edge(leaf.half_u.x, scale_m), packed_edge(leaf.half_u.y, scale_m),
                  packed_edge(leaf.half_v.x, scale_m), packed_edge(leaf.half_v.y, scale_m)};
  const double lift = board.relief_m > 0 ? std::clamp(leaf.height / board.relief_m, -1.0, 1.0) : 0.0;
  record.type_and_ambient = static_cast<std::uint32_t>(leaf.shape) |
                            static_cast<std::uint32_t>(std::lround((lift + 1) * 31.5)) << 2;
  for (int k = 0; k < 4; ++k)
    record.type_and_ambient |=
        static_cast<std::uint32_t>(std::lround(std::clamp(ambient[k], 0.0f, 1.0f) * 63.0f)) << (8 + 6 * k);
  return record;
}

}  // namespace sunfleck
