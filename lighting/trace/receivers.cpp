#include "lighting/trace/receivers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/base/error.h"

namespace sunfleck::trace {
namespace {

double side_area_m2(const WoodSegment& s) {
  const double length = glm::length(Vec3(s.to_m) - Vec3(s.from_m));
  const double r0 = s.radius_from_m, r1 = s.radius_to_m;
  return length > 0.0 ? kPi * (r0 + r1) * std::hypot(length, r1 - r0) : 0.0;
}

double triangle_area_m2(const WoodTriangle& t) {
  return 0.5 * glm::length(glm::cross(Vec3(t.b_m) - Vec3(t.a_m), Vec3(t.c_m) - Vec3(t.a_m)));
}

SurfaceOptics leaf_optics(const LeafOptics& leaf) {
  return {static_cast<float>(leaf.reflectance_front), static_cast<float>(leaf.reflectance_back),
          static_cast<float>(leaf.transmittance_front), static_cast<float>(leaf.transmittance_back)};
}

SurfaceOptics opaque(double reflectance) {
  return {static_cast<float>(reflectance), static_cast<float>(reflectance), 0.0f, 0.0f};
}

double length_m(const WoodSegment& s) { return glm::length(Vec3(s.to_m) - Vec3(s.from_m)); }

double square(double x) { return x * x; }

}  // namespace

WoodGroups group_wood(const Prototype& prototype) {
  constexpr double kLongest_m = 1.0;
  WoodGroups groups;
  double length = 0.0;
  for (std::uint32_t i = 0; i < prototype.wood.size(); ++i) {
    const WoodSegment& s = prototype.wood[i];
    const bool fits = i > 0 && length + length_m(s) <= kLongest_m &&
                      s.material == prototype.wood[i - 1].material &&
                      glm::length(Vec3(s.from_m) - Vec3(prototype.wood[i - 1].to_m)) <= kLongest_m;
    if (!fits) {
      groups.first_segment.push_back(i);
      length = 0.0;
    }
    length += length_m(s);
    groups.group_of_segment.push_back(static_cast<std::uint32_t>(groups.first_segment.size() - 1));
  }
  groups.first_segment.push_back(static_cast<std::uint32_t>(prototype.wood.size()));
  return groups;
}

std::size_t Receivers::wood_surfaces(PrototypeId prototype) const {
  return wood_groups_[prototype.value].count() + forest_.prototypes[prototype.value].wood_mesh.size();
}

Receivers::Receivers(const Forest& forest, const GroundCells& ground)
    : forest_(forest), ground_(ground), index_(forest) {
  for (const Prototype& p : forest.prototypes) wood_groups_.push_back(group_wood(p));
  wood_first_.push_back(0);
  for (const Instance& i : forest.instances)
    wood_first_.push_back(wood_first_.back() + wood_surfaces(i.prototype));
  if (2.0 * static_cast<double>(two_faced_count()) + ground.count() > 4.2e9)
    throw Error(ErrorKind::kLimitExceeded, "forest",
                std::to_string(two_faced_count()) + " elements and wood surfaces are more than ids",
                "at most 2.1e9; split the forest or use a faster method");
  area_m2_.reserve(surface_count());
  add_foliage_areas();
  add_wood_areas();
  area_m2_.resize(surface_count(), static_cast<float>(ground.cell_area_m2()));
}

void Receivers::add_foliage_areas() {
  for (const Instance& i : forest_.instances)
    for (const FoliageElement& e : forest_.prototypes[i.prototype.value].foliage)
      area_m2_.push_back(static_cast<float>(square(i.scale) * e.area_m2));
}

void Receivers::add_wood_areas() {
  for (const Instance& i : forest_.instances) {
    const Prototype& p = forest_.prototypes[i.prototype.value];
    const WoodGroups& groups = wood_groups_[i.prototype.value];
    for (std::size_t g = 0; g < groups.count(); ++g) {
      double area = 0.0;
      for (std::uint32_t s = groups.first_segment[g]; s < groups.first_segment[g + 1]; ++s)
        area += side_area_m2(p.wood[s]);
      area_m2_.push_back(static_cast<float>(square(i.scale) * area));
    }
    for (const WoodTriangle& t : p.wood_mesh)
      area_m2_.push_back(static_cast<float>(square(i.scale) * triangle_area_m2(t)));
  }
}

std::uint32_t Receivers::met_by(const RayHit& hit) const {
  std::size_t surface = 0;
  switch (hit.kind) {
    case HitKind::kSky:
      return sky();
    case HitKind::kGround: {
      if (!hit.front) return dark();
      const std::uint32_t cell = ground_.cell_at(hit.position_m);
      if (cell >= ground_.count()) return ground_beyond();
      return static_cast<std::uint32_t>(2 * two_faced_count() + cell);
    }
    case HitKind::kFoliage:
      surface = index_.first_element(hit.instance) + hit.local;
      break;
    case HitKind::kWood:
      surface =
          foliage_count() + wood_first_[hit.instance] + groups_of(hit.instance).group_of_segment[hit.local];
      break;
    case HitKind::kWoodMesh:
      surface = foliage_count() + wood_first_[hit.instance] + groups_of(hit.instance).count() + hit.local;
      break;
  }
  return static_cast<std::uint32_t>(2 * surface + (hit.front ? 0 : 1));
}

RayStart Receivers::object(std::size_t surface) const {
  if (is_ground(surface))
    return {HitKind::kGround, true, 0, static_cast<std::uint32_t>(surface - two_faced_count())};
  if (surface < foliage_count()) {
    const ForestIndex::Place place = index_.place(surface);
    return {HitKind::kFoliage, true, place.instance, place.local};
  }
  const std::size_t wood = surface - foliage_count();
  const auto after = std::upper_bound(wood_first_.begin(), wood_first_.end(), wood);
  const auto instance = static_cast<std::size_t>(after - wood_first_.begin()) - 1;
  const std::size_t local = wood - wood_first_[instance];
  const WoodGroups& groups = groups_of(instance);
  const auto number = static_cast<std::uint32_t>(instance);
  if (local < groups.count()) return {HitKind::kWood, true, number, groups.first_segment[local]};
  return {HitKind::kWoodMesh, true, number, static_cast<std::uint32_t>(local - groups.count())};
}

SegmentRange Receivers::wood_group(PrototypeId prototype, std::uint32_t first_segment) const {
  const WoodGroups& groups = wood_groups_[prototype.value];
  return {first_segment, groups.first_segment[groups.group_of_segment[first_segment] + 1]};
}

std::vector<SurfaceOptics> Receivers::optics(const OpticsTable& table, std::size_t band) const {
  std::vector<SurfaceOptics> all;
  all.reserve(surface_count());
  for (const Instance& i : forest_.instances)
    for (const FoliageElement& e : forest_.prototypes[i.prototype.value].foliage)
      all.push_back(leaf_optics(table.material(band, i.prototype, e.material).leaf));
  for (const Instance& i : forest_.instances) {
    const Prototype& p = forest_.prototypes[i.prototype.value];
    const WoodGroups& groups = wood_groups_[i.prototype.value];
    for (std::size_t g = 0; g < groups.count(); ++g)
      all.push_back(opaque(
          table.material(band, i.prototype, p.wood[groups.first_segment[g]].material).bark_reflectance));
    for (const WoodTriangle& t : p.wood_mesh)
      all.push_back(opaque(table.material(band, i.prototype, t.material).bark_reflectance));
  }
  all.resize(surface_count(), opaque(table.soil_albedo(band)));
  return all;
}

}  // namespace sunfleck::trace
