// The links of a forest: what each of K rays from every face meets. Independent of sun, sky and bands.
//
// What a ray meets within its own tree is kept once per prototype, in numbers of the tree; what it meets
// beyond, or the sky it sees, once per instance. Rows are sorted: own leaves, own wood, then what lies
// beyond: first the faces met there, then the ends that give no light back (sky, ground beyond the cells, the
// ground from below). Faces and surfaces are numbered as by trace::Receivers.
//
// Bytes: 4 K + 12 per face of a prototype, and for each instance of one that stands more than once 4 per ray
// that leaves the tree (a fifth to a half of them) + 2 per face; 4 K + 2 per ground cell.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace sunfleck::links {

// Links within one tree: faces are numbered by foliage, then wood, as Receivers of the tree alone would.
struct TreeLinks {
  std::uint32_t foliage = 0, wood = 0;  // surfaces of two faces each
  std::vector<std::uint32_t> rows;      // [face][ray]; wood hits counted from the first face of wood
  std::vector<std::uint16_t> leaf_hits, own_hits;  // per face: own leaves; own leaves and wood
  std::vector<std::uint64_t> first_exit;  // per face, and the end: rays that leave the tree, before it
  std::vector<std::uint8_t> is_shoot;     // per foliage element
  // The tree stands once: the last part of each row holds the ends of the only instance. Else it holds the
  // numbers of the rays that leave.
  bool stands_once = false;

  std::size_t faces() const { return 2 * (std::size_t{foliage} + wood); }
};

// Ends of the rays that leave one instance; empty where they lie in the rows of its tree.
struct InstanceEnds {
  std::vector<std::uint32_t> ends;       // by TreeLinks::first_exit; of the ground: K per cell
  std::vector<std::uint16_t> faces_met;  // per face: ends that are faces
};

// Where the faces of an instance are among all.
struct InstanceFaces {
  std::uint32_t prototype = 0;
  std::size_t first_leaf = 0, first_wood = 0;
};

struct FaceLinks {
  std::span<const std::uint32_t> own_leaves, own_wood, met, lost;
};

struct LinkTable {
  int links_per_face = 0;
  std::vector<TreeLinks> trees;          // per prototype; empty where none stands
  std::vector<InstanceFaces> instances;  // in the order of the forest
  std::vector<InstanceEnds> beyond;      // per instance
  InstanceEnds ground;                   // one face per cell

  FaceLinks of_tree_face(std::size_t instance, std::size_t face) const;
  FaceLinks of_ground(std::size_t cell) const;
  std::uint64_t bytes() const;
};

// Sum of `radiosity` over what a face's links meet. `leaves`, `wood`: those of its own instance; `all`: of
// all faces.
double sum_met(const FaceLinks& links, const float* leaves, const float* wood, const float* all);

}  // namespace sunfleck::links
