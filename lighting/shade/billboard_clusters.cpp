#include "lighting/shade/billboard_clusters.h"

#include <algorithm>
#include <cmath>

#include "lighting/shade/symmetric_eigen.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

struct LeafShape {
  Vec3 centre{0}, half_u{0}, half_v{0}, normal{0};
};

struct Sizes {
  double half_edge_m = 0, crown_radius_m = 0;
};

LeafShape leaf_shape(const FoliageElement& e) {
  LeafShape leaf{Vec3(e.centre_m), Vec3(e.half_u_m), Vec3(e.half_v_m), Vec3(0)};
  const Vec3 across = glm::cross(leaf.half_u, leaf.half_v);
  leaf.normal = glm::length(across) > 0 ? glm::normalize(across) : Vec3(0, 0, 1);
  return leaf;
}

Sizes sizes_of(const std::vector<LeafShape>& leaves) {
  Sizes sizes;
  Box box;
  for (const LeafShape& leaf : leaves) {
    box.include(leaf.centre);
    sizes.half_edge_m +=
        0.5 * (glm::length(leaf.half_u) + glm::length(leaf.half_v)) / static_cast<double>(leaves.size());
  }
  sizes.crown_radius_m = std::max(0.5 * glm::length(box.size()), sizes.half_edge_m);
  return sizes;
}

double cost(const LeafShape& leaf, const LeafPlane& plane, const Sizes& sizes,
            const ClusterOptions& options) {
  const Vec3 off = leaf.centre - plane.centre;
  const double h = glm::dot(off, plane.normal);
  const double a = glm::dot(leaf.half_u, plane.normal), b = glm::dot(leaf.half_v, plane.normal);
  return (h * h + 0.5 * (a * a + b * b)) / (sizes.half_edge_m * sizes.half_edge_m) +
         options.angle_weight * (1 - std::abs(glm::dot(leaf.normal, plane.normal))) +
         options.centre_weight * glm::dot(off, off) / (sizes.crown_radius_m * sizes.crown_radius_m);
}

struct Assignment {
  std::uint32_t plane = 0;
  double cost = 0;
};

void assign(const std::vector<LeafShape>& leaves, const std::vector<LeafPlane>& planes, const Sizes& sizes,
            const ClusterOptions& options, const RunControl& control, std::vector<Assignment>& assigned) {
  for_each_chunk(leaves.size(), 256, control, "", [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      assigned[i] = {0, cost(leaves[i], planes[0], sizes, options)};
      for (std::uint32_t k = 1; k < planes.size(); ++k) {
        const double c = cost(leaves[i], planes[k], sizes, options);
        if (c < assigned[i].cost) assigned[i] = {k, c};
      }
    }
  });
}

// The plane that costs its leaves least: through the mean of their centres, normal the least axis of their
// corners' scatter and of what their own normals lack.
void fit_plane(const std::vector<LeafShape>& leaves, const Sizes& sizes, const ClusterOptions& options,
               LeafPlane& plane) {
  const double share = 1 / static_cast<double>(plane.leaves.size());
  plane.centre = Vec3(0);
  for (const std::uint32_t i : plane.leaves) plane.centre += share * leaves[i].centre;
  const double per_area = share / (sizes.half_edge_m * sizes.half_edge_m);
  Symmetric3 scatter;
  for (const std::uint32_t i : plane.leaves) {
    scatter.add(leaves[i].centre - plane.centre, per_area);
    scatter.add(leaves[i].half_u, 0.5 * per_area);
    scatter.add(leaves[i].half_v, 0.5 * per_area);
    scatter.add(leaves[i].normal, -options.angle_weight * share);
  }
  plane.normal = least_axis(scatter);
}

// A plane of its own for the worst-fitting leaf, whose cost then counts as settled.
void reseed(LeafPlane& plane, const std::vector<LeafShape>& leaves, std::vector<Assignment>& assigned) {
  const auto worst = std::max_element(assigned.begin(), assigned.end(),
                                      [](const auto& a, const auto& b) { return a.cost < b.cost; });
  const LeafShape& leaf = leaves[static_cast<std::size_t>(worst - assigned.begin())];
  plane.centre = leaf.centre;
  plane.normal = leaf.normal;
  worst->cost = 0;
}

void gather(std::vector<LeafPlane>& planes, const std::vector<Assignment>& assigned) {
  for (LeafPlane& plane : planes) plane.leaves.clear();
  for (std::uint32_t i = 0; i < assigned.size(); ++i) planes[assigned[i].plane].leaves.push_back(i);
}

void check(std::span<const FoliageElement> foliage, const ClusterOptions& options) {
  if (foliage.empty()) throw_invalid("billboards", "a plant without leaves", "foliage to stand for");
  if (options.planes < 1 || options.planes > 4096)
    throw_invalid("billboard planes", std::to_string(options.planes), "1 to 4096");
  if (options.iterations < 1)
    throw_invalid("billboard iterations", std::to_string(options.iterations), "at least 1");
  if (!(options.angle_weight >= 0) || !(options.centre_weight >= 0))
    throw_invalid("billboard weights", "negative or undefined", ">= 0");
}

}  // namespace

std::vector<LeafPlane> cluster_leaves(std::span<const FoliageElement> foliage, const ClusterOptions& options,
                                      const RunControl& control) {
  check(foliage, options);
  std::vector<LeafShape> leaves;
  for (const FoliageElement& e : foliage) leaves.push_back(leaf_shape(e));
  const Sizes sizes = sizes_of(leaves);
  if (!(sizes.half_edge_m > 0)) throw_invalid("billboards", "leaves without extent", "leaves with an area");
  std::vector<LeafPlane> planes(
      std::min<std::size_t>(static_cast<std::size_t>(options.planes), leaves.size()));
  RandomStream random(options.seed, 0, RandomPurpose::kBillboards);
  for (LeafPlane& plane : planes) {
    const LeafShape& leaf = leaves[random.below(static_cast<std::uint32_t>(leaves.size()))];
    plane.centre = leaf.centre;
    plane.normal = leaf.normal;
  }
  std::vector<Assignment> assigned(leaves.size());
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    assign(leaves, planes, sizes, options, control, assigned);
    gather(planes, assigned);
    for (LeafPlane& plane : planes)
      if (plane.leaves.empty())
        reseed(plane, leaves, assigned);
      else
        fit_plane(leaves, sizes, options, plane);
  }
  assign(leaves, planes, sizes, options, control, assigned);
  gather(planes, assigned);
  std::erase_if(planes, [](const LeafPlane& plane) { return plane.leaves.empty(); });
  return planes;
}

}  // namespace sunfleck
