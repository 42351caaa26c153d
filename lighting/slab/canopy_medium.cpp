// Area-weighted optics of prototypes; see canopy_medium.h.
#include "lighting/slab/canopy_medium.h"

#include <algorithm>

namespace sunfleck {
namespace {

struct Areas {
  std::vector<double> leaf_m2, wood_m2;  // per material of a prototype
};

Areas areas_of(const Prototype& p) {
  Areas areas{std::vector<double>(p.materials.size(), 0.0), std::vector<double>(p.materials.size(), 0.0)};
  for (const FoliageElement& e : p.foliage) areas.leaf_m2[e.material] += e.area_m2;
  for (const WoodSegment& w : p.wood) {
    const double length_m = glm::length(Vec3(w.to_m) - Vec3(w.from_m));
    areas.wood_m2[w.material] += 0.5 * kPi * length_m * (w.radius_from_m + w.radius_to_m);
  }
  for (const WoodTriangle& t : p.wood_mesh) {
    const Vec3 a(t.a_m);
    areas.wood_m2[t.material] += 0.25 * glm::length(glm::cross(Vec3(t.b_m) - a, Vec3(t.c_m) - a));
  }
  return areas;
}

CanopyOptics mean_optics(const Areas& areas, const OpticsTable& optics, std::size_t band, PrototypeId id) {
  double area = 0.0, reflected = 0.0, transmitted = 0.0, absorbed = 0.0;
  for (std::size_t m = 0; m < areas.leaf_m2.size(); ++m) {
    const MaterialOptics& material = optics.material(band, id, m);
    const double leaf = areas.leaf_m2[m], wood = areas.wood_m2[m];
    area += leaf + wood;
    reflected += leaf * material.leaf.reflectance() + wood * material.bark_reflectance;
    transmitted += leaf * material.leaf.transmittance();
    absorbed += leaf * (1.0 - material.leaf.albedo()) + wood * (1.0 - material.bark_reflectance);
  }
  if (!(area > 0.0)) return {};
  const double scattered = reflected + transmitted;
  return {std::clamp(absorbed / area, 0.0, 1.0),
          scattered > 0.0 ? (reflected - transmitted) / scattered : 0.0};
}

}  // namespace

SlabMedium<double> CanopyOptics::medium(double turn_ratio, double ground_albedo) const {
  return {absorption, std::clamp(0.5 + 0.5 * turn * turn_ratio, 0.0, 1.0), ground_albedo};
}

std::vector<std::vector<CanopyOptics>> canopy_optics(const Forest& forest, const OpticsTable& optics) {
  std::vector<std::vector<CanopyOptics>> result(optics.band_count());
  for (std::uint32_t p = 0; p < forest.prototypes.size(); ++p) {
    const Areas areas = areas_of(forest.prototypes[p]);
    for (std::size_t b = 0; b < result.size(); ++b)
      result[b].push_back(mean_optics(areas, optics, b, PrototypeId{p}));
  }
  return result;
}

}  // namespace sunfleck
