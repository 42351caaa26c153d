#include "lighting/sky/sky_patches.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/base/contract.h"

namespace sunfleck {
namespace {

Vec3 at_height(double z, double azimuth_rad) {
  const double across = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {across * std::sin(azimuth_rad), across * std::cos(azimuth_rad), z};
}

double cos_deg(double degrees) { return std::cos(radians_from_degrees(degrees)); }

// Means over each patch, scaled to a horizontal irradiance of 1.
template <typename Radiance>
std::vector<double> patch_means(const HemisphereGrid& grid, const HemisphereGrid::Points& points,
                                const Radiance& radiance_from) {
  const std::size_t per_patch = points.direction.size() / grid.size();
  SUNFLECK_EXPECTS(per_patch * grid.size() == points.direction.size());
  const SkyDirections& d = grid.directions();
  std::vector<double> radiance(grid.size(), 0.0);
  double horizontal = 0;
  for (std::size_t p = 0; p < grid.size(); ++p) {
    for (std::size_t i = p * per_patch; i < (p + 1) * per_patch; ++i)
      radiance[p] += radiance_from(points.direction[i]);
    horizontal += radiance[p] * d.solid_angle_sr[p] * d.to_source[p].z;
  }
  for (double& r : radiance) r /= horizontal;
  return radiance;
}

}  // namespace

HemisphereGrid::HemisphereGrid(const std::vector<double>& falling_z, const std::vector<int>& patches) {
  SUNFLECK_EXPECTS(falling_z.size() == patches.size() + 1);
  for (std::size_t r = 0; r < patches.size(); ++r) {
    const auto count = static_cast<std::size_t>(patches[r]);
    const Ring ring{falling_z[r + 1], falling_z[r], directions_.size(), count};
    rings_.push_back(ring);
    for (std::size_t i = 0; i < count; ++i) {
      const double azimuth = 2.0 * kPi * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
      // The mean of z over a ring of the sphere lies half way between its edges (Archimedes).
      directions_.to_source.push_back(at_height(0.5 * (ring.z_low + ring.z_high), azimuth));
      directions_.solid_angle_sr.push_back(2.0 * kPi * (ring.z_high - ring.z_low) /
                                           static_cast<double>(count));
    }
  }
}

// Rings of equal angle take patches in proportion to their length; then their edges move a little so that
// every patch has the same solid angle. Beckers and Beckers 2012, Computational Geometry 45:275-283.
HemisphereGrid HemisphereGrid::equal_area(double patch_deg) {
  SUNFLECK_EXPECTS(patch_deg >= 1.0 && patch_deg <= 30.0);
  const int rings = static_cast<int>(std::lround(90.0 / patch_deg));
  const double step_deg = 90.0 / rings;
  std::vector<int> patches;
  for (int r = 0; r < rings; ++r) {
    const double length_deg = 360.0 * std::sin(radians_from_degrees((r + 0.5) * step_deg));
    patches.push_back(std::max(3, static_cast<int>(std::lround(length_deg / step_deg))));
  }
  const double total = std::accumulate(patches.begin(), patches.end(), 0);
  std::vector<double> falling_z{1.0};
  double above = 0;
  for (const int count : patches) falling_z.push_back(1.0 - (above += count) / total);
  falling_z.back() = 0.0;
  return HemisphereGrid(falling_z, patches);
}

HemisphereGrid HemisphereGrid::tregenza() {
  std::vector<double> falling_z{1.0};
  for (int r = 0; r < 7; ++r) falling_z.push_back(cos_deg(6.0 + 12.0 * r));
  falling_z.push_back(0.0);
  return HemisphereGrid(falling_z, {1, 6, 12, 18, 24, 24, 30, 30});
}

std::size_t HemisphereGrid::patch_of(const Vec3& direction) const {
  const auto below = std::partition_point(rings_.begin(), rings_.end() - 1,
                                          [&](const Ring& ring) { return ring.z_low > direction.z; });
  const double turn = azimuth_of(direction) / (2.0 * kPi);
  const auto i = static_cast<std::size_t>(turn * static_cast<double>(below->patches));
  return below->first_patch + std::min(i, below->patches - 1);
}

// Midpoints of equal steps in z, which are equal steps of solid angle, and in azimuth.
HemisphereGrid::Points HemisphereGrid::points(int along_zenith, int along_azimuth) const {
  SUNFLECK_EXPECTS(along_zenith >= 1 && along_azimuth >= 1);
  Points points;
  for (const Ring& ring : rings_) {
    const double height = ring.z_high - ring.z_low, count = static_cast<double>(ring.patches);
    for (std::size_t i = 0; i < ring.patches; ++i)
      for (int a = 0; a < along_zenith; ++a)
        for (int b = 0; b < along_azimuth; ++b) {
          const double turn = (static_cast<double>(i) + (b + 0.5) / along_azimuth) / count;
          points.direction.push_back(
              at_height(ring.z_low + height * (a + 0.5) / along_zenith, 2.0 * kPi * turn));
          points.solid_angle_sr.push_back(2.0 * kPi * height / (count * along_zenith * along_azimuth));
        }
  }
  return points;
}

HemisphereGrid::Points sky_points(const HemisphereGrid& grid) {
  const double patch_deg = degrees_from_radians(std::sqrt(2.0 * kPi / static_cast<double>(grid.size())));
  const int along = std::max(2, static_cast<int>(std::lround(patch_deg / 3.0)));
  return grid.points(along, along);
}

std::vector<double> patch_radiance(const SkyRadiance& sky, const HemisphereGrid& grid,
                                   const HemisphereGrid::Points& points) {
  return patch_means(grid, points, [&](const Vec3& v) { return sky.radiance(v); });
}

std::vector<double> patch_radiance(const PerezSky& sky, const HemisphereGrid& grid,
                                   const HemisphereGrid::Points& points) {
  const PerezShape shape = perez_shape(sky);
  const Vec3 to_sun = lifted_to_horizon(sky.to_sun);
  // Neighbouring points share their height: its exponential is kept until the height changes.
  double z = -1, gradation = 0;
  return patch_means(grid, points, [&](const Vec3& v) {
    if (v.z != z) gradation = perez_gradation(shape, z = v.z);
    return gradation * perez_halo(shape, glm::dot(v, to_sun));
  });
}

}  // namespace sunfleck
