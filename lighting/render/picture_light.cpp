#include "lighting/render/picture_light.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "lighting/trace/surface_sampler.h"

namespace sunfleck {
namespace {

constexpr int kRings = 32, kSectors = 64, kCells = kRings * kSectors;
constexpr double kEvenShare = 0.05;

Vec3 cell_direction(double ring, double sector) {
  const double z = ring / kRings, across = std::sqrt(std::max(0.0, 1.0 - z * z));
  const double turn = 2.0 * kPi * sector / kSectors;
  return {across * std::cos(turn), across * std::sin(turn), z};
}

std::size_t cell_of(const Vec3& d) {
  const int ring = std::clamp(static_cast<int>(d.z * kRings), 0, kRings - 1);
  double turn = std::atan2(d.y, d.x) / (2.0 * kPi);
  if (turn < 0.0) turn += 1.0;
  const int sector = std::clamp(static_cast<int>(turn * kSectors), 0, kSectors - 1);
  return static_cast<std::size_t>(ring * kSectors + sector);
}

}  // namespace

PictureLight::PictureLight(const Illumination& light, std::size_t band, const PictureColour& colour)
    : light_(light), sky_(sky_radiance(light)), strength_(light.bands[band]), colour_(colour) {
  beam_ = strength_.beam_normal_w_m2 * 2.0 / (1.0 + std::cos(light.sun_half_angle_rad)) * colour.sun_tint;
  diffuse_ = strength_.diffuse_horizontal_w_m2 * colour.sky_tint;
  has_beam_ = light.sun_is_up() && strength_.beam_normal_w_m2 > 0.0;
  has_sky_ = strength_.diffuse_horizontal_w_m2 > 0.0;
  if (has_sky_) tabulate();
}

void PictureLight::tabulate() {
  std::vector<double> weight(kCells);
  double sum = 0.0;
  for (int c = 0; c < kCells; ++c) {
    double radiance = 0.0;
    for (const double a : {0.25, 0.75})
      for (const double b : {0.25, 0.75})
        radiance += sky_.radiance(cell_direction(c / kSectors + a, c % kSectors + b));
    weight[static_cast<std::size_t>(c)] = radiance;
    sum += radiance;
  }
  if (colour_.sky_gradient > 0.0) {
    Vec3 tinted(0.0);
    double plain = 0.0;
    for (int c = 0; c < kCells; ++c) {
      const Vec3 d = cell_direction(c / kSectors + 0.5, c % kSectors + 0.5);
      const double light = weight[static_cast<std::size_t>(c)] * d.z;
      tinted += light * relative_tint(d);
      plain += light;
    }
    tint_scale_ = plain / tinted;
  }
  double running = 0.0;
  for (double& w : weight) {
    const double share = (1.0 - kEvenShare) * w / sum + kEvenShare / kCells;
    running += share;
    up_to_.push_back(running);
    density_.push_back(share * kCells / (2.0 * kPi));
  }
}

Vec3 PictureLight::towards_sun(const Vec2& number) const {
  if (light_.sun_half_angle_rad == 0.0) return light_.to_sun;
  return trace::cone_direction(light_.to_sun, light_.sun_half_angle_rad, number.x, number.y);
}

// Pale where much air or the sun's halo scatters more than once.
Vec3 PictureLight::relative_tint(const Vec3& direction) const {
  if (colour_.sky_gradient == 0.0) return Vec3(1.0);
  const double low = std::pow(1.0 - std::clamp(direction.z, 0.0, 1.0), 3.0);
  const double halo = std::exp(-4.0 * glm::length(direction - light_.to_sun));
  const Vec3 pale = glm::mix(Vec3(1.45, 1.05, 0.78), colour_.sun_tint * Vec3(1.15, 1.05, 0.95), 0.4);
  const Vec3 tint = glm::mix(Vec3(0.8, 0.96, 1.12), pale, std::max(0.85 * low, halo));
  return glm::mix(Vec3(1.0), tint, colour_.sky_gradient);
}

Vec3 PictureLight::sky(const Vec3& direction) const {
  return sky_.radiance(direction) * diffuse_ * relative_tint(direction) * tint_scale_;
}

Vec3 PictureLight::open_ground() const {
  const Vec3 beam = has_beam_ ? strength_.beam_normal_w_m2 * light_.to_sun.z * colour_.sun_tint : Vec3(0.0);
  return beam + diffuse_;
}

Vec3 PictureLight::background(const Vec3& direction) const {
  const Vec3 seen = sky({direction.x, direction.y, std::max(direction.z, 1e-9)});
  const double half_angle_rad = light_.sun_half_angle_rad;
  if (!has_beam_ || half_angle_rad == 0.0) return seen;
  // The chord to the sun's centre tells the angle without loss near 0.
  if (glm::length(direction - light_.to_sun) > 2.0 * std::sin(0.5 * half_angle_rad)) return seen;
  const double projected_sr = kPi * std::pow(std::sin(half_angle_rad), 2);
  return seen + strength_.beam_normal_w_m2 / projected_sr * colour_.sun_tint;
}

PictureLight::Draw PictureLight::draw_sky(const Vec2& number) const {
  const double wanted = number.x * up_to_.back();
  const auto found = std::upper_bound(up_to_.begin(), up_to_.end(), wanted);
  const auto c = std::min(static_cast<std::size_t>(found - up_to_.begin()), up_to_.size() - 1);
  const double before = c > 0 ? up_to_[c - 1] : 0.0;
  const double rest = std::clamp((wanted - before) / (up_to_[c] - before), 0.0, 1.0);
  const auto ring = static_cast<double>(c / kSectors), sector = static_cast<double>(c % kSectors);
  return {cell_direction(std::max(ring + rest, 1e-9), sector + number.y), density_[c]};
}

double PictureLight::sky_density_per_sr(const Vec3& direction) const {
  return direction.z > 0.0 && has_sky_ ? density_[cell_of(direction)] : 0.0;
}

}  // namespace sunfleck
