// See leaf_answer.h.
#include "lighting/envelope/leaf_answer.h"

#include <algorithm>
#include <cmath>

namespace sunfleck::envelope {

namespace {

// An even light from all around must come out as pi times its radiance.
void scale_to_pi(std::array<float, kMostSectors>& face, std::size_t count) {
  double sum = 0.0;
  for (std::size_t j = 0; j < count; ++j) sum += face[j];
  if (!(sum > 1e-6)) return;
  for (std::size_t j = 0; j < count; ++j) face[j] = static_cast<float>(face[j] * (kPi / sum));
}

FaceLight face_light(const std::array<float, kMostSectors>& face, const ArrivingBand& light,
                     std::size_t sectors, double direct) {
  double sky = 0.0, scattered = 0.0;
  for (std::size_t j = 0; j < sectors; ++j) {
    sky += static_cast<double>(face[j]) * light.sky[j];
    scattered += static_cast<double>(face[j]) * (light.ground[j] + light.foliage[j]);  // Eq. 11
  }
  return {static_cast<float>(direct), static_cast<float>(sky), static_cast<float>(scattered)};
}

}  // namespace

FaceWeights flat_weights(const SectorSet& set, const Vec3& normal, const Vec3& to_sun,
                         EnvelopeWeights weights) {
  FaceWeights result;
  for (std::size_t j = 0; j < set.count(); ++j) {
    const double weight = set.solid_angle_sr[j] * glm::dot(normal, set.to_source[j]);
    result.front[j] = static_cast<float>(std::max(0.0, weight));
    result.back[j] = static_cast<float>(std::max(0.0, -weight));
  }
  if (weights == EnvelopeWeights::kCosine) {
    scale_to_pi(result.front, set.count());
    scale_to_pi(result.back, set.count());
  }
  const double cosine = glm::dot(normal, to_sun);
  result.sun_front = std::max(0.0, cosine);  // Eq. 8
  result.sun_back = std::max(0.0, -cosine);
  return result;
}

FaceWeights shoot_weights(const SectorSet& set, const FieldElement& shoot, const Vec3& to_sun) {
  FaceWeights result;
  double escape = 0.0;
  for (std::size_t j = 0; j < set.count(); ++j) {
    const double out = own_transmittance(shoot, set.to_source[j]);
    escape += set.solid_angle_sr[j] / (4.0 * kPi) * out;
    result.front[j] = result.back[j] = static_cast<float>(0.25 * set.solid_angle_sr[j] * out);
  }
  result.sun_front = result.sun_back = 0.25;
  result.own_sun = own_transmittance(shoot, to_sun);
  result.escape = escape;
  return result;
}

ElementLight element_light(const FaceWeights& weights, const ArrivingBand& light, std::size_t sectors,
                           double beam_seen_w_m2, double albedo) {
  const double beam = beam_seen_w_m2 * weights.own_sun;
  ElementLight result{.front = face_light(weights.front, light, sectors, beam * weights.sun_front),
                      .back = face_light(weights.back, light, sectors, beam * weights.sun_back),
                      .absorbed_w = 0};
  const double kept = std::min(1.0, albedo) * (1.0 - weights.escape);
  if (kept > 0.0) {
    const double inside = kept / std::max(1e-4, 1.0 - kept);
    const double mean = 0.5 * (static_cast<double>(result.front.total()) + result.back.total());
    result.front.scattered_w_m2 += static_cast<float>(inside * mean);
    result.back.scattered_w_m2 += static_cast<float>(inside * mean);
  }
  return result;
}

}  // namespace sunfleck::envelope
