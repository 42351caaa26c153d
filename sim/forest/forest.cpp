#include "sim/forest/forest.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "sim/base/contract.h"
#include "sim/base/error.h"
#include "sim/base/sha256.h"
#include "sim/forest/forest_outline.h"

namespace sunfleck {
namespace {

// A tree is repeated as often as the period fits into it, in x and in y.
constexpr double kMostPeriodsPerTree = 1000;

Vec3 turned(double yaw_rad, const Vec3& v) {
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

Vec3 downhill(const Terrain& terrain) {
  return {std::sin(terrain.aspect_rad), std::cos(terrain.aspect_rad), 0.0};
}

void check_material(const Material& material) {
  for (const MaterialBand& b : material.bands) {
    const std::string where = "materials." + material.name + "." + b.band;
    const auto in_unit = [](double x) { return x >= 0.0 && x <= 1.0; };
    if (!in_unit(b.leaf_reflectance) || !in_unit(b.leaf_transmittance) || !in_unit(b.bark_reflectance))
      throw_invalid(where, "reflectance or transmittance outside [0, 1]", "numbers between 0 and 1");
    if (b.leaf_reflectance + b.leaf_transmittance > 1.0 + 1e-12)
      throw_invalid(where, "leaf reflectance + transmittance is over 1", "r + t <= 1: leaves do not shine");
  }
}

void check_instance(const Forest& forest, std::size_t i) {
  const Instance& instance = forest.instances[i];
  const std::string where = "instance " + std::to_string(i);
  if (instance.prototype.value >= forest.prototypes.size())
    throw_invalid(where, "names prototype " + std::to_string(instance.prototype.value),
                  "there are " + std::to_string(forest.prototypes.size()));
  if (!is_finite(instance.position_m) || !std::isfinite(instance.yaw_rad))
    throw_invalid(where, "position or yaw is not finite", "numbers in metres and radians");
  if (!(instance.scale > 0.0f && instance.scale <= 1e6f))
    throw_invalid(where, "scale is " + std::to_string(instance.scale), "more than 0, at most 1e6");
}

void check_ground(const Forest& forest) {
  const Terrain& t = forest.terrain;
  if (!std::isfinite(t.elevation_m) || !std::isfinite(t.aspect_rad) ||
      !(t.slope_rad >= 0.0 && t.slope_rad <= radians_from_degrees(80.0)))
    throw_invalid("terrain", "slope outside [0, 80] degrees or a number that is not finite", "a plane slope");
  if (!forest.period) return;
  const Period& p = *forest.period;
  const bool sane = std::isfinite(p.origin_m.x) && std::isfinite(p.origin_m.y) && std::isfinite(p.size_m.x) &&
                    std::isfinite(p.size_m.y) && p.size_m.x > 0.0 && p.size_m.y > 0.0;
  if (!sane)
    throw_invalid("period", "origin not finite or size not positive", "size_x_m and size_y_m above 0");
}

// Widest prototype in its own frame, by the largest scale at which it stands.
double widest_tree_m(const Forest& forest) {
  std::vector<double> scales(forest.prototypes.size(), 0.0);
  for (const Instance& i : forest.instances)
    scales[i.prototype.value] = std::max(scales[i.prototype.value], static_cast<double>(i.scale));
  double widest_m = 0;
  for (std::size_t p = 0; p < forest.prototypes.size(); ++p) {
    const Vec3 size_m = prototype_bounds(forest.prototypes[p]).size();
    widest_m = std::max({widest_m, scales[p] * size_m.x, scales[p] * size_m.y});
  }
  return widest_m;
}

void check_period_holds_trees(const Forest& forest) {
  if (!forest.period) return;
  const Vec2 size_m = forest.period->size_m;
  if (widest_tree_m(forest) > kMostPeriodsPerTree * std::min(size_m.x, size_m.y))
    throw_invalid("period", "a tree reaches over more than 1000 periods", "a larger size_x_m and size_y_m");
}

template <class T>
void add_all(Sha256& hash, const std::vector<T>& items) {
  hash.add_value(static_cast<std::uint64_t>(items.size()));
  if (!items.empty()) hash.add_bytes(items.data(), items.size() * sizeof(T));
}

void add_text(Sha256& hash, const std::string& text) {
  hash.add_value(static_cast<std::uint64_t>(text.size()));
  hash.add(text);
}

void add_material(Sha256& hash, const Material& material) {
  add_text(hash, material.name);
  hash.add_value(static_cast<std::uint64_t>(material.bands.size()));
  for (const MaterialBand& b : material.bands) {
    add_text(hash, b.band);
    for (const double x : {b.leaf_reflectance, b.leaf_transmittance, b.bark_reflectance}) hash.add_value(x);
  }
}

void add_prototype(Sha256& hash, const Prototype& prototype) {
  add_text(hash, prototype.name);
  hash.add_value(static_cast<std::uint64_t>(prototype.materials.size()));
  for (const std::string& m : prototype.materials) add_text(hash, m);
  add_all(hash, prototype.foliage);
  add_all(hash, prototype.wood);
  add_all(hash, prototype.wood_mesh);
  hash.add_value(prototype.stated_dbh_m);
}

}  // namespace

// These structs are hashed and stored as bytes: they must have no padding.
static_assert(sizeof(WoodSegment) == 36 && sizeof(WoodTriangle) == 40);

double Terrain::height_at(double x_m, double y_m) const {
  const Vec3 down = downhill(*this);
  return elevation_m - std::tan(slope_rad) * (down.x * x_m + down.y * y_m);
}

Vec3 Terrain::normal() const {
  return std::cos(slope_rad) * Vec3(0, 0, 1) + std::sin(slope_rad) * downhill(*this);
}

ForestIndex::ForestIndex(const Forest& forest) {
  first_.reserve(forest.instances.size() + 1);
  first_.push_back(0);
  for (const Instance& instance : forest.instances)
    first_.push_back(first_.back() + forest.prototypes[instance.prototype.value].foliage.size());
}

ForestIndex::Place ForestIndex::place(std::size_t element) const {
  SUNFLECK_EXPECTS(element < element_count());
  const auto after = std::upper_bound(first_.begin(), first_.end(), element);
  const auto instance = static_cast<std::size_t>(after - first_.begin()) - 1;
  return {static_cast<std::uint32_t>(instance), static_cast<std::uint32_t>(element - first_[instance])};
}

Vec3 world_direction_from_tree(const Instance& instance, const Vec3& direction) {
  return turned(instance.yaw_rad, direction);
}
Vec3 tree_direction_from_world(const Instance& instance, const Vec3& direction) {
  return turned(-static_cast<double>(instance.yaw_rad), direction);
}
Vec3 world_from_tree(const Instance& instance, const Vec3& p) {
  return instance.position_m + static_cast<double>(instance.scale) * turned(instance.yaw_rad, p);
}
Vec3 tree_from_world(const Instance& instance, const Vec3& p) {
  return tree_direction_from_world(instance, p - instance.position_m) / static_cast<double>(instance.scale);
}

WorldElement world_element(const Forest& forest, std::size_t instance_index, std::size_t local) {
  const Instance& instance = forest.instances[instance_index];
  const FoliageElement& e = forest.prototypes[instance.prototype.value].foliage[local];
  const double scale = instance.scale;
  return {world_from_tree(instance, e.centre_m),
          scale * world_direction_from_tree(instance, e.half_u_m),
          scale * world_direction_from_tree(instance, e.half_v_m),
          scale * scale * e.area_m2,
          e.shape,
          e.material};
}

Box forest_bounds(const Forest& forest) {
  std::vector<PrototypeOutline> outlines;
  for (const Prototype& p : forest.prototypes) {
    PrototypeOutline& outline = outlines.emplace_back();
    outline.bounds = prototype_bounds(p);
    outline.reach_m = prototype_reach_m(p);
  }
  Box bounds;
  for (const Instance& instance : forest.instances) {
    const PrototypeOutline& outline = outlines[instance.prototype.value];
    if (!outline.bounds.empty()) bounds.include(instance_box(instance, outline));
  }
  return bounds;
}

double forest_leaf_area_m2(const Forest& forest) {
  std::vector<double> areas;
  for (const Prototype& p : forest.prototypes) areas.push_back(leaf_area_m2(p));
  double sum = 0.0;
  for (const Instance& i : forest.instances)
    sum += areas[i.prototype.value] * static_cast<double>(i.scale) * static_cast<double>(i.scale);
  return sum;
}

void validate(const Forest& forest) {
  check_ground(forest);
  std::set<std::string> known;
  for (const Material& m : forest.materials) {
    check_material(m);
    if (!known.insert(m.name).second)
      throw_invalid("materials." + m.name, "is there twice", "one entry per name");
  }
  for (const Prototype& p : forest.prototypes) {
    validate(p, "prototype '" + p.name + "'");
    for (const std::string& m : p.materials)
      if (!known.contains(m))
        throw_invalid("prototype '" + p.name + "'", "uses material '" + m + "'",
                      "add it to the forest's materials");
  }
  for (std::size_t i = 0; i < forest.instances.size(); ++i) check_instance(forest, i);
  check_period_holds_trees(forest);
}

std::string content_hash(const Forest& forest) {
  Sha256 hash;
  add_text(hash, forest.name);
  hash.add_value(static_cast<std::uint64_t>(forest.materials.size()));
  for (const Material& m : forest.materials) add_material(hash, m);
  hash.add_value(static_cast<std::uint64_t>(forest.prototypes.size()));
  for (const Prototype& p : forest.prototypes) add_prototype(hash, p);
  add_all(hash, forest.instances);
  for (const double x : {forest.terrain.elevation_m, forest.terrain.slope_rad, forest.terrain.aspect_rad})
    hash.add_value(x);
  if (forest.period)
    for (const double x : {forest.period->origin_m.x, forest.period->origin_m.y, forest.period->size_m.x,
                           forest.period->size_m.y})
      hash.add_value(x);
  return hash.hex();
}

std::string content_hash(const Prototype& prototype) {
  Sha256 hash;
  add_prototype(hash, prototype);
  return hash.hex();
}

std::string content_hash(const std::vector<Instance>& instances) {
  Sha256 hash;
  add_all(hash, instances);
  return hash.hex();
}

}  // namespace sunfleck
