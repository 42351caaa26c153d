#include "lighting/shade/billboard_query.h"

#include <algorithm>
#include <cmath>

namespace sunfleck {
namespace {

// Where a ray meets a plane's rectangle: metres from its corner.
struct PlanePoint {
  double distance_m = 0, u_m = 0, v_m = 0;
  bool along_normal = false;
  Vec2 shift{0};   // on the plane, per height over it
  double way = 0;  // along the ray, per height
};

std::optional<PlanePoint> plane_point(const Billboard& board, const Vec3& origin, const Vec3& direction,
                                      double relief_tangent) {
  const double facing = glm::dot(direction, board.normal);
  if (std::abs(facing) < 1e-12) return std::nullopt;
  const Vec3 off = board.corner_m - origin;
  const double distance = glm::dot(off, board.normal) / facing;
  const Vec3 there = distance * direction - off;
  const double u = glm::dot(there, board.along_u), v = glm::dot(there, board.along_v);
  if (!(u >= 0 && u < board.width_m && v >= 0 && v < board.height_m)) return std::nullopt;
  PlanePoint at{distance, u, v, facing > 0};
  if (board.relief_m > 0) {
    const Vec2 across(glm::dot(direction, board.along_u), glm::dot(direction, board.along_v));
    const double tangent = glm::length(across) / std::abs(facing);
    // Views more grazing than relief_tangent are taken as if they were at it.
    const double kept = tangent > relief_tangent ? relief_tangent / tangent : 1.0;
    at.shift = kept / facing * across;
    at.way = kept / facing;
  }
  return at;
}

// Coordinates of a point on the plane in the leaf's own frame; nothing for a leaf seen edge on.
std::optional<Vec2> leaf_point(const BillboardCloud& cloud, const Billboard& board, const LeafRecord& record,
                               const PlanePoint& at) {
  const double scale = cloud.edge_scale_m / 32767;
  const Vec2 u = scale * Vec2(record.edges[0], record.edges[1]),
             v = scale * Vec2(record.edges[2], record.edges[3]);
  const double determinant = u.x * v.y - u.y * v.x;
  if (determinant == 0) return std::nullopt;
  const double height = record.height_m(board.relief_m);
  const Vec2 d(at.u_m + height * at.shift.x - record.position[0] * board.width_m / 65535,
               at.v_m + height * at.shift.y - record.position[1] * board.height_m / 65535);
  return Vec2((d.x * v.y - d.y * v.x) / determinant, (u.x * d.y - u.y * d.x) / determinant);
}

float ambient_at(const LeafRecord& record, const Vec2& p) {
  const auto corner = [&](int k) { return ((record.type_and_ambient >> (8 + 6 * k)) & 63u) / 63.0; };
  const double a = 0.5 * (p.x + 1), b = 0.5 * (p.y + 1);
  return static_cast<float>((1 - b) * ((1 - a) * corner(0) + a * corner(1)) +
                            b * ((1 - a) * corner(2) + a * corner(3)));
}

}  // namespace

std::optional<BillboardHit> billboard_at(const BillboardCloud& cloud, std::uint32_t plane, const Vec3& origin,
                                         const Vec3& direction, double min_distance_m,
                                         const BillboardDetail& detail, const BillboardStart& from) {
  const Billboard& board = cloud.plane[plane];
  if (plane == from.plane && (from.leaf == kNoLeaf || board.relief_m == 0)) return std::nullopt;
  const auto at = plane_point(board, origin, direction, cloud.relief_tangent);
  if (!at || !(at->distance_m + board.relief_m * std::abs(at->way) > min_distance_m)) return std::nullopt;
  const int column = std::min(static_cast<int>(at->u_m / board.width_m * board.cells_u), board.cells_u - 1);
  const int row = std::min(static_cast<int>(at->v_m / board.height_m * board.cells_v), board.cells_v - 1);
  const std::size_t cell = board.first_cell + static_cast<std::size_t>(row * board.cells_u + column);
  std::uint32_t count = 0;
  if (!cloud.low_res_only) {
    const std::uint32_t first = cloud.cell[cell] >> 8;
    count = cloud.cell[cell] & 255u;
    const std::uint32_t read = std::min(count, static_cast<std::uint32_t>(std::max(detail.entries, 0)));
    for (std::uint32_t i = 0; i < read; ++i) {
      const std::uint32_t number =
          board.first_record + cloud.list[first + (at->along_normal ? i : count - 1 - i)];
      const LeafRecord& record = cloud.record[number];
      const double distance_m = at->distance_m + record.height_m(board.relief_m) * at->way;
      if (!(distance_m > min_distance_m) || cloud.leaf[number] == from.leaf) continue;
      const auto p = leaf_point(cloud, board, record, *at);
      if (p && cloud.mask[record.type()].covers(p->x, p->y))
        return BillboardHit{distance_m, plane, cloud.leaf[number], Vec3(0), ambient_at(record, *p)};
    }
    if (read == count || !(at->distance_m > min_distance_m)) return std::nullopt;
  }
  const LowResTexel& texel = cloud.low_res[cell];
  const double lot = detail.uniform + 0.6180339887498949 * plane;  // every plane draws its own
  if (!((lot - std::floor(lot)) * 255 < texel.cover)) return std::nullopt;
  return BillboardHit{at->distance_m, plane, kNoLeaf,
                      Vec3(texel.normal[0], texel.normal[1], texel.normal[2]) / 127.0, 1};
}

std::optional<BillboardHit> closest_billboard(const BillboardCloud& cloud, const Vec3& origin,
                                              const Vec3& direction, double min_distance_m,
                                              const BillboardDetail& detail, const BillboardStart& from) {
  std::optional<BillboardHit> nearest;
  for (std::uint32_t k = 0; k < cloud.plane.size(); ++k) {
    const auto hit = billboard_at(cloud, k, origin, direction, min_distance_m, detail, from);
    if (hit && (!nearest || hit->distance_m < nearest->distance_m)) nearest = hit;
  }
  return nearest;
}

int list_entries(double diagonal_px, double entries_per_px) {
  const double entries = diagonal_px * entries_per_px;
  return entries < 0.5 ? 0 : static_cast<int>(std::ceil(std::min(entries, 255.0)));
}

BillboardTree build_billboard_tree(const Prototype& prototype, const BillboardOptions& nearest,
                                   const std::array<int, 3>& planes,
                                   std::span<const std::array<float, 4>> ambient, const RunControl& control) {
  BillboardTree tree;
  for (std::size_t k = 0; k < tree.cloud.size(); ++k) {
    BillboardOptions options = nearest;
    options.clusters.planes = planes[k];
    options.low_res_only = k + 1 == tree.cloud.size();
    tree.cloud[k] = build_billboard_cloud(prototype, options, ambient, control);
  }
  return tree;
}

int choose_billboard_cloud(double diagonal_px, double uniform) {
  const double seen = diagonal_px * (1 + 0.4 * uniform);
  return seen >= 4 ? 0 : seen >= 1 ? 1 : 2;
}

}  // namespace sunfleck
