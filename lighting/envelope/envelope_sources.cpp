// See envelope_sources.h.
#include "lighting/envelope/envelope_sources.h"

#include <algorithm>
#include <cmath>

#include "lighting/envelope/closed_forms.h"
#include "sim/base/parallel.h"

namespace sunfleck::envelope {

namespace {

// Steeper changes of depth than this happen at borders only, where the depth is near 0 anyway.
constexpr double kMostApproach = 100.0;

float approach_of(double cosine, double light_projection, double sector_projection) {
  return static_cast<float>(
      std::clamp(cosine * light_projection / sector_projection, -kMostApproach, kMostApproach));
}

// By wood area; 0 without wood.
double mean_bark_reflectance(const Prototype& prototype, PrototypeId id, const OpticsTable& optics,
                             std::size_t band) {
  double area = 0.0, reflected = 0.0;
  const auto add = [&](double m2, std::uint32_t material) {
    area += m2;
    reflected += m2 * optics.material(band, id, material).bark_reflectance;
  };
  for (const WoodSegment& s : prototype.wood)
    add((s.radius_from_m + s.radius_to_m) * glm::length(Vec3(s.to_m) - Vec3(s.from_m)), s.material);
  for (const WoodTriangle& t : prototype.wood_mesh)
    add(glm::length(glm::cross(Vec3(t.b_m - t.a_m), Vec3(t.c_m - t.a_m))) / kPi, t.material);
  return area > 0.0 ? reflected / area : 0.0;
}

// How fast the way out along `light` shortens per way along `sector`: 1 - by one metre per metre - where both
// are the same.
double shortening(const Vec3& sector, const Vec3& light, const std::optional<Vec3>& level_normal) {
  if (!level_normal) return glm::dot(sector, light);  // Eq. 22
  const double rise = glm::dot(light, *level_normal);
  return std::abs(rise) > 1e-9 ? glm::dot(sector, *level_normal) / rise : glm::dot(sector, light);
}

void set_approaches(PrototypeMedium& medium, const Scattering& scattering, const Sources& s,
                    const SectorSet& set) {
  medium.approach.assign(set.count() * s.row, 0.0f);
  medium.sun_approach.assign(s.row, 0.0f);
  for (std::size_t j = 0; j < set.count(); ++j) {
    const Vec3& along = set.to_source[j];
    for (std::size_t k = 0; k < set.count(); ++k)
      medium.approach[j * s.row + k] = approach_of(shortening(along, set.to_source[k], s.level_normal),
                                                   scattering.projection[k], scattering.projection[j]);
    if (!s.sun) continue;
    // c_j of Eq. 25 for an interpolated sun.
    const double to_sun = s.sun_weights.empty() ? shortening(along, s.to_sun, s.level_normal)
                                                : approach_towards<double>(set.to_source, s.sun_weights, j);
    medium.sun_approach[j] = approach_of(to_sun, scattering.sun_projection, scattering.projection[j]);
  }
}

BandMedium band_medium(const Scattering& scattering, const Sources& s) {
  BandMedium medium{.turn = std::vector<float>(scattering.count * s.row),
                    .sun_turn = std::vector<float>(s.row),
                    .albedo = scattering.albedo};
  for (std::size_t j = 0; j < scattering.count; ++j) {
    medium.sun_turn[j] = static_cast<float>(scattering.sun_turn[j]);
    for (std::size_t k = 0; k < scattering.count; ++k)
      medium.turn[j * s.row + k] = static_cast<float>(scattering.turn[j * scattering.count + k]);
  }
  return medium;
}

PrototypeMedium prototype_medium(const Forest& forest, const OpticsTable& optics, const PreparedParts& parts,
                                 const Sources& s, std::size_t p) {
  const PrototypeId id{static_cast<std::uint32_t>(p)};
  PrototypeMoments moments{.set = parts.moments[p], .sun = {}};
  for (const AngleSample& sample : parts.angles[p].samples)
    if (s.sun) moments.sun.push_back(light_moments(sample, parts.set, s.to_sun));
  PrototypeMedium medium;
  for (std::size_t b = 0; b < optics.band_count(); ++b) {
    std::vector<LeafOptics> leaf;
    for (const AngleSample& sample : parts.angles[p].samples)
      leaf.push_back(optics.material(b, id, sample.material).leaf);
    const double bark = mean_bark_reflectance(forest.prototypes[p], id, optics, b);
    const Scattering found = scattering(parts.angles[p], moments, parts.set, s.to_sun, leaf, bark);
    if (b == 0) set_approaches(medium, found, s, parts.set);
    medium.bands.push_back(band_medium(found, s));
  }
  return medium;
}

void set_sun(Sources& s, const PreparedParts& parts, const RunControl& control) {
  if (parts.options.sun == EnvelopeSun::kPublished) {
    s.sun_weights.resize(parts.set.count());
    interpolation_weights<double>(parts.set.to_source, s.to_sun, s.sun_weights);
  } else if (!parts.field->ends_on_ground(s.to_sun)) {
    s.sun_grid.emplace(*parts.field, s.to_sun, control);
  }
}

BandSource band_source(const BandLight& light, bool sun, double soil_albedo, const SectorSky& sky,
                       double ground_cosine) {
  BandSource source;
  source.beam_w_m2 = sun ? light.beam_normal_w_m2 : 0.0;
  for (const double radiance : sky.sky_radiance)
    source.sky_radiance.push_back(static_cast<float>(radiance * light.diffuse_horizontal_w_m2));
  const double on_ground =
      light.diffuse_horizontal_w_m2 * sky.open_ground_irradiance + ground_cosine * source.beam_w_m2;
  source.ground_radiance.push_back(static_cast<float>(soil_albedo * on_ground / kPi));
  return source;
}

}  // namespace

Sources sources(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                const PreparedParts& parts, bool sun, const RunControl& control) {
  Sources s;
  s.sun = sun;
  s.to_sun = light.to_sun;
  s.row = padded(parts.set.count());
  const EnvelopeBorder border = parts.options.border;
  if (border == EnvelopeBorder::kLevel || (border == EnvelopeBorder::kByScene && forest.period))
    s.level_normal = forest.terrain.normal();
  if (sun) set_sun(s, parts, control);
  const SectorSky sky = sector_sky(parts.set, sky_radiance(light), forest.terrain.normal());
  for (const double share : sky.ground_share) s.ground_share.push_back(static_cast<float>(share));
  const double ground_cosine = sun ? std::max(0.0, glm::dot(light.to_sun, forest.terrain.normal())) : 0.0;
  for (std::size_t b = 0; b < light.bands.size(); ++b)
    s.bands.push_back(band_source(light.bands[b], sun, optics.soil_albedo(b), sky, ground_cosine));
  s.media.resize(forest.prototypes.size());
  for_each_chunk(s.media.size(), 1, control, {}, [&](std::size_t p, std::size_t) {
    s.media[p] = prototype_medium(forest, optics, parts, s, p);
  });
  return s;
}

double interpolated_sun_depth(const Sources& s, std::span<const float> sector_depths) {
  double depth = 0.0;
  for (std::size_t j = 0; j < sector_depths.size(); ++j) depth += s.sun_weights[j] * sector_depths[j];
  return depth;  // Eq. 7, in depths
}

}  // namespace sunfleck::envelope
