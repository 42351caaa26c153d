#include "sim/exchange/gltf_mesh.h"

#include <algorithm>

namespace sunfleck {
namespace {

constexpr std::size_t kLookBack = 32;  // corners of one prism

// A corner of the same prism is taken again; leaves share none.
std::uint32_t corner_at(GltfPrimitive& primitive, const Vec3f& p) {
  auto& all = primitive.positions_m;
  if (primitive.part != PlantPart::kLeaf)
    for (std::size_t back = 1; back <= std::min(kLookBack, all.size()); ++back)
      if (all[all.size() - back] == p) return static_cast<std::uint32_t>(all.size() - back);
  all.push_back(p);
  return static_cast<std::uint32_t>(all.size() - 1);
}

// As the file will hold it: corners that differ by less than a float are one, and the triangle is none.
void add_triangle(GltfPrimitive& primitive, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  if (a == b || b == c || a == c) return;
  for (const Vec3f& p : {a, b, c}) primitive.corners.push_back(corner_at(primitive, p));
}

// Leaves and prism sides are convex: a fan. Corners of a leaf are shared within it.
void add_face(GltfPrimitive& primitive, const PlantFace& face) {
  const auto& p = face.corners_m;
  if (face.part != PlantPart::kLeaf || p.size() == 3) {
    for (std::size_t i = 2; i < p.size(); ++i)
      add_triangle(primitive, Vec3f(p[0]), Vec3f(p[i - 1]), Vec3f(p[i]));
    return;
  }
  const auto first = static_cast<std::uint32_t>(primitive.positions_m.size());
  for (const Vec3& corner : p) primitive.positions_m.emplace_back(corner);
  for (std::uint32_t i = 2; i < p.size(); ++i)
    for (const std::uint32_t corner : {0u, i - 1, i}) primitive.corners.push_back(first + corner);
}

}  // namespace

std::vector<GltfPrimitive> gltf_primitives(const Prototype& prototype) {
  std::vector<GltfPrimitive> primitives;
  for_each_face(prototype, [&](const PlantFace& face) {
    const auto same = [&](const GltfPrimitive& p) {
      return p.part == face.part && p.material == face.material;
    };
    auto found = std::find_if(primitives.begin(), primitives.end(), same);
    if (found == primitives.end())
      found = primitives.insert(found, GltfPrimitive{face.part, face.material, {}, {}});
    add_face(*found, face);
  });
  std::erase_if(primitives, [](const GltfPrimitive& p) { return p.corners.empty(); });
  return primitives;
}

}  // namespace sunfleck
