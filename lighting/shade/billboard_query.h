// Rays against a billboard cloud: plane, cell, first leaf of its list that covers the point ([Garcia07] 5).
// Plain loops over the planes; a renderer puts the rectangles in its own tree and calls billboard_at.
#pragma once

#include <limits>
#include <optional>

#include "lighting/shade/billboard_cloud.h"

namespace sunfleck {

inline constexpr std::uint32_t kNoLeaf = std::numeric_limits<std::uint32_t>::max();

struct BillboardHit {
  double distance_m = 0;
  std::uint32_t plane = 0;
  std::uint32_t leaf = kNoLeaf;  // index into the foliage; kNoLeaf where the low-resolution texture answered
  Vec3 normal{0};                // of the low-resolution texel, turned to the plane's normal; 0 for leaves
  float ambient = 1;
};

// What a ray leaves, so that it does not meet it: the leaf; where leaves have no height of their own (or only
// the low-resolution texture answered) the whole plane.
struct BillboardStart {
  std::uint32_t plane = kNoLeaf, leaf = kNoLeaf;
};

// How much of the lists is read (5.1).
struct BillboardDetail {
  int entries = 255;   // of a list; 0: low resolution only
  double uniform = 0;  // in [0, 1): draws the low-resolution texture's cover
};

// What the plane shows where the ray meets it, at any distance > min_distance_m. A ray along the plane's
// normal reads the list from its low end, against it from its high end. A list longer than `entries` goes on
// with the low-resolution texture, which holds all leaves (as published: cover is a little too high in
// between).
std::optional<BillboardHit> billboard_at(const BillboardCloud& cloud, std::uint32_t plane, const Vec3& origin,
                                         const Vec3& direction, double min_distance_m,
                                         const BillboardDetail& detail = {}, const BillboardStart& from = {});
// Nearest over all planes.
std::optional<BillboardHit> closest_billboard(const BillboardCloud& cloud, const Vec3& origin,
                                              const Vec3& direction, double min_distance_m,
                                              const BillboardDetail& detail = {},
                                              const BillboardStart& from = {});

// Entries to read where a cell's diagonal is `diagonal_px` pixels: the published product, rounded up; none
// below half an entry.
int list_entries(double diagonal_px, double entries_per_px);

// Three clouds of one tree, from near to far; the last has the low-resolution texture only.
struct BillboardTree {
  std::array<BillboardCloud, 3> cloud;
};
BillboardTree build_billboard_tree(const Prototype& prototype, const BillboardOptions& nearest,
                                   const std::array<int, 3>& planes = {260, 130, 60},
                                   std::span<const std::array<float, 4>> ambient = {},
                                   const RunControl& control = {});
// Which of them at a cell diagonal in pixels: the first from 4 pixels up, the second from 1, then the third;
// blended over the last 40 % before each threshold by one choice (`uniform` in [0, 1)).
int choose_billboard_cloud(double diagonal_px, double uniform);

}  // namespace sunfleck
