// A forest: prototypes, where they stand, the ground, and the repetition at its borders. Knows nothing of
// light; materials carry plain numbers per band for whoever needs them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/base/ids.h"
#include "sim/base/vec.h"
#include "sim/plant/prototype.h"

namespace sunfleck {

// A prototype turned by yaw about +z (counter-clockwise seen from above), scaled, and moved: 40 bytes.
struct Instance {
  Vec3 position_m{0};  // world position of the stem foot
  PrototypeId prototype;
  float yaw_rad = 0;
  float scale = 1;
  TreeId tree;
};
static_assert(sizeof(Instance) == 40);

// Plane ground: through (0, 0, elevation_m), falling by slope_rad towards aspect_rad (azimuth clockwise from
// north).
struct Terrain {
  double elevation_m = 0;
  double slope_rad = 0;
  double aspect_rad = 0;

  double height_at(double x_m, double y_m) const;
  Vec3 normal() const;  // unit, upwards
  bool operator==(const Terrain&) const = default;
};

// The scene repeats every size_m in x and y; the base cell starts at origin_m. On a slope the copies follow
// the ground.
struct Period {
  Vec2 origin_m{0};
  Vec2 size_m{0};
  bool operator==(const Period&) const = default;
};

struct MaterialBand {
  std::string band;             // "PAR", "NIR", ...
  double leaf_reflectance = 0;  // of both faces
  double leaf_transmittance = 0;
  double bark_reflectance = 0;
  bool operator==(const MaterialBand&) const = default;
};

struct Material {
  std::string name;  // usually the latin name of the species
  std::vector<MaterialBand> bands;
  bool operator==(const Material&) const = default;
};

struct Forest {
  std::string name;
  std::vector<Material> materials;
  std::vector<Prototype> prototypes;
  std::vector<Instance> instances;
  Terrain terrain;
  std::optional<Period> period;
};

// Numbers every foliage element of a forest: instance by instance, in prototype order.
class ForestIndex {
 public:
  explicit ForestIndex(const Forest& forest);
  std::size_t element_count() const { return first_.back(); }
  std::size_t instance_count() const { return first_.size() - 1; }
  std::size_t first_element(std::size_t instance) const { return first_[instance]; }
  struct Place {
    std::uint32_t instance, local;
  };
  Place place(std::size_t element) const;  // O(log instances)

 private:
  std::vector<std::size_t> first_;
};

// world = position + scale * Rz(yaw) * p; directions without position and scale.
Vec3 world_from_tree(const Instance& instance, const Vec3& p);
Vec3 tree_from_world(const Instance& instance, const Vec3& p);
Vec3 world_direction_from_tree(const Instance& instance, const Vec3& direction);
Vec3 tree_direction_from_world(const Instance& instance, const Vec3& direction);

// A foliage element where it stands: world coordinates in double, area and edges scaled.
struct WorldElement {
  Vec3 centre_m, half_u_m, half_v_m;
  double area_m2;
  ElementShape shape;
  std::uint16_t material;  // index into its Prototype::materials
};
WorldElement world_element(const Forest& forest, std::size_t instance, std::size_t local);

// Box that holds all instances; empty for an empty forest. For each, the box of its prototype turned and
// moved, cut by the cylinder round its stem axis that holds the prototype: never too small, for round crowns
// hardly too wide.
Box forest_bounds(const Forest& forest);
double forest_leaf_area_m2(const Forest& forest);

// Throws Error(kInvalidInput): bad prototype, prototype id out of range, scale not in (0, 1e6], position not
// finite, slope outside [0, 80] degrees, period not positive, a prototype material missing from `materials`,
// r + t > 1. An empty forest is valid here; whoever needs trees says so.
void validate(const Forest& forest);

// SHA-256 of the whole content (names, geometry, instances, terrain, materials): the forest's identity.
std::string content_hash(const Forest& forest);

}  // namespace sunfleck
