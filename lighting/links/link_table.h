// The links of a forest: what each of the rays from every face meets, K per face on average (link_lobes.h).
// Independent of sun, sky and bands.
//
// What a ray meets within its own tree is kept once per prototype, in numbers of the tree; what it meets
// beyond, or the sky it sees, once per instance. Links of a lobe are sorted: own leaves, own wood, then what
// lies beyond: the faces met there, ground without light of its own (beyond the cells, or from below), the
// sky. Which share of a lobe is sky is known from more rays than are kept. Faces and surfaces are numbered as
// by trace::Receivers.
//
// Bytes: 4 K + 24 per face of a prototype (+ 16 where it stands more than once), and for each instance 12 per
// face, and where the prototype stands more than once 4 per ray that leaves the tree (a fifth to a half of
// them) and 12 per link of the tree that a neighbour cuts where crowns interlock; 4 K + 6 per ground cell.
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "lighting/links/link_lobes.h"

namespace sunfleck::links {

// Links within one tree: surfaces are numbered by foliage, then wood, as Receivers of the tree alone would.
struct TreeLinks {
  std::uint32_t foliage = 0, wood = 0;  // surfaces of two faces each
  std::vector<std::uint32_t> rows;  // [surface][2 K], lobe by lobe; wood hits count from the first of wood
  // Per lobe, [surface][Lobe].
  std::vector<std::uint16_t> links, cast;          // rays kept; all rays
  std::vector<std::uint16_t> leaf_hits, own_hits;  // own leaves; own leaves and wood
  std::vector<float> weight;                       // of the lobe in the irradiance of its face
  // Rays that leave the tree before each lobe, and all. Empty for a tree that stands once: the last part of
  // each lobe holds the ends of the only instance. Else it holds the numbers of the rays that leave.
  std::vector<std::uint64_t> first_exit;
  std::vector<std::uint8_t> is_shoot;  // per foliage element

  std::size_t surfaces() const { return std::size_t{foliage} + wood; }
};

// A link within a tree that meets a neighbour first.
struct CutLink {
  std::uint32_t lobe = 0;  // of the tree, surface by surface
  std::uint32_t own = 0;   // the face in the row, among all
  std::uint32_t met = 0;   // the face met instead
  auto operator<=>(const CutLink&) const = default;
};

// What one instance has for itself: ends of the rays that leave it, and links of its tree that are cut.
struct InstanceEnds {
  std::vector<std::uint32_t> ends;  // by TreeLinks::first_exit; of the ground: K per cell
  // Per lobe (ground: cell): ends that are faces; that are not the sky; rays of all cast that see the sky.
  std::vector<std::uint16_t> faces_met, not_sky, sky_rays;
  std::vector<CutLink> cut;  // in their order
};

// Where the faces of an instance are among all.
struct InstanceFaces {
  std::uint32_t prototype = 0;
  std::size_t first_leaf = 0, first_wood = 0;
};

struct LobeLinks {
  std::span<const std::uint32_t> own_leaves, own_wood, met, dark_ground, sky;
  double per_hit = 0, per_sky = 0;  // weights of an end, in the irradiance of the face
};

struct LinkTable {
  int links_per_face = 0;
  std::vector<TreeLinks> trees;          // per prototype; empty where none stands
  std::vector<InstanceFaces> instances;  // in the order of the forest
  std::vector<InstanceEnds> beyond;      // per instance
  InstanceEnds ground;                   // one lobe per cell

  LobeLinks of_lobe(std::size_t instance, std::size_t surface, Lobe lobe) const;
  LobeLinks of_ground(std::size_t cell) const;
  std::uint64_t bytes() const;
};

// Where the links of a lobe lie in the row of its surface.
std::size_t lobe_begin(const TreeLinks& tree, std::size_t surface, Lobe lobe);

// Sum of `radiosity` over what links meet. `leaves`, `wood`: those of its own instance; `all`: of all faces.
double sum_met(const LobeLinks& links, const float* leaves, const float* wood, const float* all);

}  // namespace sunfleck::links
