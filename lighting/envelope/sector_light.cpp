// See sector_light.h.
#include "lighting/envelope/sector_light.h"

#include <algorithm>
#include <cmath>

namespace sunfleck::envelope {

namespace {

void set_background(BandSectors& band, double diffuse_w_m2, double ground_radiance, double sky_radiance,
                    const BlockerField& field) {
  for (std::size_t j = 0; j < 8; ++j) {
    const Vec3& to_sector = cube_directions<double>()[j];
    if (field.ends_on_ground(to_sector))
      band.ground_radiance[j] = ground_radiance;
    else if (to_sector.z > 0.0)
      band.sky_radiance[j] = sky_radiance * diffuse_w_m2;
  }
}

void set_bounce(BandSectors& band, const Forest& forest, const OpticsTable& optics, std::size_t index,
                const Vec3& to_sun) {
  band.bounce_radiance.resize(forest.prototypes.size());
  for (std::size_t p = 0; p < forest.prototypes.size(); ++p) {
    const LeafSums<double> leaf = mean_leaf(forest, optics, index, p);
    for (std::size_t j = 0; j < 8; ++j) {
      const auto angles = angle_between<double>(cube_directions<double>()[j], to_sun);
      band.bounce_radiance[p][j] = one_bounce_sector(1.0, scattering_lobe(leaf, angles), band.beam_w_m2, 1.0);
    }
  }
}

std::array<double, 8> sun_approach(const Vec3& to_sun, EnvelopeSun method) {
  const auto& directions = cube_directions<double>();
  std::array<double, 8> approach, weights;
  interpolation_weights<double>(directions, to_sun, weights);
  for (std::size_t j = 0; j < 8; ++j) {
    approach[j] = method == EnvelopeSun::kPublished
                      ? approach_towards<double>(directions, weights, j)  // c_j of Eq. 25
                      : glm::dot(directions[j], to_sun);  // exact where the depth is the sun's own
  }
  return approach;
}

// pi M(n.w_j) / sum M(n.w_k) for both faces of a flat element.
void set_flat_transfer(LeafTransfer& leaf, const Vec3& normal) {
  double front = 0.0, back = 0.0;
  for (std::size_t j = 0; j < 8; ++j) {
    const double cosine = glm::dot(normal, cube_directions<double>()[j]);
    leaf.front[j] = std::max(0.0, cosine);
    leaf.back[j] = std::max(0.0, -cosine);
    front += leaf.front[j];
    back += leaf.back[j];
  }
  for (std::size_t j = 0; j < 8; ++j) {
    leaf.front[j] *= kPi / front;  // the sums stay in [1.63, 2.31]
    leaf.back[j] *= kPi / back;
  }
}

void set_shoot_transfer(LeafTransfer& leaf, const FieldElement& shoot) {
  for (std::size_t j = 0; j < 8; ++j) {
    const double past_own = own_transmittance(shoot, cube_directions<double>()[j]);
    leaf.front[j] = leaf.back[j] = 0.25 * kSectorSolidAngle * past_own;
  }
}

void set_sun_transfer(LeafTransfer& leaf, const FieldElement& element, double depth,
                      const SectorLight& light) {
  const double seen = std::exp(-depth) * own_transmittance(element, light.to_sun);
  const double cosine = element.is_shoot() ? 0.0 : glm::dot(Vec3(element.axis), light.to_sun);
  leaf.sunlit = seen;
  leaf.sun_front = seen * (element.is_shoot() ? 0.25 : std::max(0.0, cosine));  // Eq. 8
  leaf.sun_back = seen * (element.is_shoot() ? 0.25 : std::max(0.0, -cosine));
}

FaceLight face_light(const LeafTransfer& leaf, const std::array<double, 8>& face, double sun,
                     const BandSectors& band, std::size_t prototype) {
  double sky = 0.0, scattered = 0.0;
  for (std::size_t j = 0; j < 8; ++j) {
    sky += face[j] * leaf.transmittance[j] * band.sky_radiance[j];  // Eq. 6
    scattered += face[j] * (leaf.transmittance[j] * band.ground_radiance[j] +
                            leaf.bounce[j] * band.bounce_radiance[prototype][j]);  // Eq. 11
  }
  return {static_cast<float>(sun * band.beam_w_m2), static_cast<float>(sky), static_cast<float>(scattered)};
}

}  // namespace

double octant_sky_radiance(const SkyRadiance& sky) {
  // Mean over solid angle: even steps of the cosine. Midpoints are exact for radiance linear in it.
  constexpr int kSteps = 64;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) sum += sky.ring_mean((i + 0.5) / kSteps);
  return sum / kSteps;
}

LeafSums<double> mean_leaf(const Forest& forest, const OpticsTable& optics, std::size_t band,
                           std::size_t prototype) {
  LeafSums<double> sums;
  double area = 0.0;
  for (const FoliageElement& e : forest.prototypes[prototype].foliage) {
    const LeafOptics& leaf = optics.material(band, {static_cast<std::uint32_t>(prototype)}, e.material).leaf;
    area += e.area_m2;
    sums.reflectance += e.area_m2 * (leaf.reflectance_front + leaf.reflectance_back);
    sums.transmittance += e.area_m2 * (leaf.transmittance_front + leaf.transmittance_back);
  }
  if (!(area > 0.0)) return {};
  return {sums.reflectance / area, sums.transmittance / area};
}

SectorLight sector_light(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                         const BlockerField& field, EnvelopeSun method, bool sun) {
  SectorLight sectors{
      .sun = sun, .to_sun = light.to_sun, .bands = std::vector<BandSectors>(light.bands.size())};
  if (sun) sectors.approach = sun_approach(light.to_sun, method);
  const double sky_radiance = octant_sky_radiance(sunfleck::sky_radiance(light));
  const double ground_cosine = sun ? std::max(0.0, glm::dot(light.to_sun, forest.terrain.normal())) : 0.0;
  for (std::size_t b = 0; b < light.bands.size(); ++b) {
    BandSectors& band = sectors.bands[b];
    band.beam_w_m2 = sun ? light.bands[b].beam_normal_w_m2 : 0.0;
    const double diffuse = light.bands[b].diffuse_horizontal_w_m2;
    const double on_ground = diffuse + ground_cosine * band.beam_w_m2;
    set_background(band, diffuse, optics.soil_albedo(b) * on_ground / kPi, sky_radiance, field);
    set_bounce(band, forest, optics, b, light.to_sun);
  }
  return sectors;
}

LeafTransfer leaf_transfer(const FieldElement& element, const LeafDepths& depths, const SectorLight& light) {
  LeafTransfer leaf;
  if (element.is_shoot())
    set_shoot_transfer(leaf, element);
  else
    set_flat_transfer(leaf, Vec3(element.axis));
  for (std::size_t j = 0; j < 8; ++j) {
    leaf.transmittance[j] = std::exp(-static_cast<double>(depths.sectors[j]));
    if (!light.sun) continue;
    leaf.bounce[j] = one_bounce_integral<double>(depths.sun, light.approach[j], depths.sectors[j]);
  }
  if (light.sun) set_sun_transfer(leaf, element, depths.sun, light);
  return leaf;
}

ElementLight element_light(const LeafTransfer& leaf, const BandSectors& band, std::size_t prototype) {
  return {.front = face_light(leaf, leaf.front, leaf.sun_front, band, prototype),
          .back = face_light(leaf, leaf.back, leaf.sun_back, band, prototype),
          .absorbed_w = 0};
}

}  // namespace sunfleck::envelope
