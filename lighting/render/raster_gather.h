// Sky and scattered light on wood and ground, asked once per place and kept: what Shader finds with one ray
// per sample, found with many rays at nodes and interpolated between them.
//
//   ground  nodes on a lattice, bilinear. About 0.75 m apart where the camera is near; where a pixel is wider
//           or camera or trees are far, twice, four times ... that.
//   stems   four nodes around a segment, linear between them; segments whose middles share a cube of 0.75 m
//           share nodes, longer ones have their own, one every 0.75 m.
//   twigs   (below 3 cm of radius, leaves within 2 m) without rays: light has come to the leaves nearby
//           already. Six directions, in each the stored light of their faces weighed by their cosine squared.
//
// What a node holds depends on its place alone: the same for any number of threads and order.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "lighting/render/raster_figures.h"
#include "lighting/render/shader.h"

namespace sunfleck {

class GatheredLight {
 public:
  // All must outlive it.
  GatheredLight(const ShadingParts& parts, const Shader& shader, const FigureTable& table);

  // W m-2 on the ground at a place of the base cell, seen from `distance_m` (0: from everywhere alike) by
  // pixels `pixel_m` wide there.
  Vec3 on_ground(const Vec3& point_m, double pixel_m, double distance_m);
  // On wood that was met (RayHit of kind kWood or kWoodMesh, on_original_m, normal).
  Vec3 on_wood(const RayHit& hit);

 private:
  using AmbientCube = std::array<Vec3, 6>;  // towards +x, -x, +y, -y, +z, -z
  // A map in parts with a lock each. Two threads may find the same value twice.
  template <class Value>
  class Kept {
   public:
    template <class Find>
    Value get(std::uint64_t key, const Find& find);

   private:
    struct Part {
      std::mutex lock;
      std::unordered_map<std::uint64_t, Value> values;
    };
    std::array<Part, 64> parts_;
  };
  struct Node {
    Vec3 irradiance_w_m2{0};
    double share = 0;  // of its rays that did not start inside wood
  };

  Node ground_node(std::uint64_t level, std::int64_t x, std::int64_t y, const Vec2& spacing_m) const;
  void find_leaves(const Prototype& prototype, const PrototypeFigures& figures);
  void share_stems(const Prototype& prototype);
  Node gather(const RayHit& from, std::uint64_t key, std::uint32_t rays) const;
  Vec3 stem(const RayHit& hit);
  AmbientCube cube(std::uint32_t instance, std::uint32_t leaf_cluster) const;

  const ShadingParts& parts_;
  const Shader& shader_;
  const FigureTable& table_;
  Vec2 lattice_m_{0.75};
  // Per shown prototype and wood segment: 1 + cluster of leaves nearby, 0 none; the segment whose nodes
  // serve.
  std::vector<std::vector<std::uint32_t>> leaves_near_, stem_of_;
  Kept<Node> nodes_;
  Kept<AmbientCube> cubes_;
};

}  // namespace sunfleck
