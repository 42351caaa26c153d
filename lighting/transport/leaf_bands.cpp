// See leaf_bands.h.
#include "lighting/transport/leaf_bands.h"

#include "sim/base/vec.h"

namespace sunfleck::transport {

std::vector<LeafBand> leaf_bands(const Forest& forest, const OpticsTable& optics, std::size_t band) {
  std::vector<LeafBand> bands;
  for (std::size_t p = 0; p < forest.prototypes.size(); ++p) {
    for (std::size_t m = 0; m < forest.prototypes[p].materials.size(); ++m) {
      const LeafOptics& leaf = optics.material(band, {static_cast<std::uint32_t>(p)}, m).leaf;
      bands.push_back({.reflectance_front = static_cast<float>(leaf.reflectance_front),
                       .reflectance_back = static_cast<float>(leaf.reflectance_back),
                       .transmittance_front = static_cast<float>(leaf.transmittance_front),
                       .transmittance_back = static_cast<float>(leaf.transmittance_back),
                       .albedo = static_cast<float>(leaf.albedo())});
    }
  }
  return bands;
}

double mean_bark_reflectance(const Forest& forest, const OpticsTable& optics, std::size_t band) {
  double area = 0.0, reflected = 0.0;
  for (std::size_t p = 0; p < forest.prototypes.size(); ++p) {
    const auto add = [&](double part_m2, std::uint32_t material) {
      area += part_m2;
      reflected +=
          part_m2 * optics.material(band, {static_cast<std::uint32_t>(p)}, material).bark_reflectance;
    };
    for (const WoodSegment& s : forest.prototypes[p].wood)
      add(kPi * (s.radius_from_m + s.radius_to_m) * glm::length(Vec3(s.to_m) - Vec3(s.from_m)), s.material);
    for (const WoodTriangle& t : forest.prototypes[p].wood_mesh)
      add(0.5 * glm::length(glm::cross(Vec3(t.b_m) - Vec3(t.a_m), Vec3(t.c_m) - Vec3(t.a_m))), t.material);
  }
  return area > 0.0 ? reflected / area : 0.0;
}

}  // namespace sunfleck::transport
