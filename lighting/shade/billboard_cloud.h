// A tree's foliage as textured planes: layered indirect texturing of [Garcia07]. For export to real-time
// viewers and for comparison. On a CPU ray tracer it does NOT pay: slower per ray than the instanced leaves
// at nearly every size, and with bias (design sheet section 7); prune.h is what far trees should use.
//
// Each plane has a grid of cells (the paper's hash texture): where its list of leaves begins, and how many it
// has. Lists hold indexes of leaf records in order of height over the plane, so that they are read from
// either end by the side the plane is seen from. A record places one leaf: position and the two half edges on
// the plane, leaf type, and an ambient term at its four corners. The leaf's outline comes from a mask per
// type. A low-resolution texture of one texel per cell holds cover and mean normal, for far views.
//
// Beyond the paper, every entry keeps its leaf's height over the plane (6 bits), and a query shifts the leaf
// by it as the view does ("relief"): what moving leaves into their plane costs in a picture (more than half
// of the squared error) is gone but for grazing views, and the leaves of a plane shade each other.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lighting/shade/billboard_clusters.h"

namespace sunfleck {

// Outline of a leaf type: 64 x 64 bits over a half_u + b half_v, a, b in [-1, 1]; 512 bytes.
struct LeafMask {
  std::array<std::uint64_t, 64> row{};
  bool covers(double a, double b) const {
    if (!(a >= -1 && a < 1 && b >= -1 && b < 1)) return false;
    const auto x = static_cast<unsigned>((a + 1) * 32), y = static_cast<unsigned>((b + 1) * 32);
    return (row[y] >> x) & 1;
  }
};
// Of the element's shape (triangles by their own bounds, shoots as their outline).
LeafMask leaf_mask(ElementShape shape);

struct Billboard {
  Vec3 corner_m{0};             // of the rectangle, tree frame
  Vec3 along_u{0}, along_v{0};  // unit; along_u x along_v = normal
  Vec3 normal{0};
  double width_m = 0, height_m = 0;
  int cells_u = 0, cells_v = 0;
  double relief_m = 0;           // largest height of a leaf over or under the plane; 0 as published
  std::uint32_t first_cell = 0;  // in BillboardCloud::cell and low_res
  std::uint32_t first_record = 0;
};

// 16 bytes. Position in 65535ths of the rectangle, half edges in 32767ths of BillboardCloud::edge_scale_m.
struct LeafRecord {
  std::array<std::uint16_t, 2> position{};
  std::array<std::int16_t, 4> edges{};  // half_u along u and v, half_v along u and v
  // Type: bits 0-1. Height over the plane: bits 2-7, from -relief_m (0) to relief_m (63). Ambient of the
  // corners (-,-) (+,-) (-,+) (+,+): 6 bits each.
  std::uint32_t type_and_ambient = 0;
  unsigned type() const { return type_and_ambient & 3u; }
  double height_m(double relief_m) const {
    return (static_cast<double>((type_and_ambient >> 2) & 63u) / 31.5 - 1) * relief_m;
  }
};
static_assert(sizeof(LeafRecord) == 16);

// Cover (0 to 255) and mean leaf normal, tree frame (-127 to 127), turned to the side of the plane's normal.
struct LowResTexel {
  std::uint8_t cover = 0;
  std::array<std::int8_t, 3> normal{};
};

struct BillboardCloud {
  std::vector<Billboard> plane;
  std::vector<std::uint32_t> cell;  // offset << 8 | count; 0 where empty
  std::vector<std::uint16_t> list;  // record numbers within the plane, by rising height over it
  std::vector<LeafRecord> record;
  std::vector<std::uint32_t> leaf;   // of each record: index into the prototype's foliage
  std::vector<LowResTexel> low_res;  // one per cell
  std::array<LeafMask, 4> mask{};    // by ElementShape
  double edge_scale_m = 1;           // largest half edge
  double relief_tangent = 0;         // of the options
  bool low_res_only = false;         // coarsest cloud: lists are left out
  std::size_t left_out = 0;          // entries of lists beyond 255 per cell: not drawn
};

struct BillboardOptions {
  ClusterOptions clusters;
  double cell_half_edges = 4;   // cell size in mean half edges of leaves, [1, 64]
  bool turn_into_plane = true;  // leaves lie flat in their plane, area kept; false: projected, as published
  // Views up to this tangent from the plane's normal see the leaves at their heights, others as at it: [0,
  // 8]. Lists grow with it. 0: leaves lie in the plane, as published.
  double relief_tangent = 3;
  bool low_res_only = false;
};

// As published: leaves projected into their planes. Loses 2 % of cover at 260 planes, 9 % at 60.
BillboardOptions published_billboards(int planes);

// ambient: four values in [0, 1] per leaf at its corners (-u-v, +u-v, -u+v, +u+v); or empty, meaning 1.
// Throws Error(kInvalidInput) for options out of range, kLimitExceeded above 16.7 million list entries or
// 65,535 leaves on one plane.
BillboardCloud build_billboard_cloud(const Prototype& prototype, const BillboardOptions& options,
                                     std::span<const std::array<float, 4>> ambient = {},
                                     const RunControl& control = {});

struct BillboardMemory {
  std::size_t cells = 0, lists = 0, records = 0, low_res = 0, planes = 0, masks = 0;
  std::size_t total() const { return cells + lists + records + low_res + planes + masks; }
};
BillboardMemory billboard_memory(const BillboardCloud& cloud);

// Values at the corners (-,-) (+,-) (-,+) (+,+) whose bilinear mixture fits values known at points (a, b) of
// a leaf best ([Garcia07] 5.2, least squares; towards their mean where the points do not say).
struct AmbientPoint {
  double a = 0, b = 0, value = 0;
};
std::array<double, 4> fit_corner_ambient(std::span<const AmbientPoint> points);

}  // namespace sunfleck
