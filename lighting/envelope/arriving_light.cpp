// See arriving_light.h.
#include "lighting/envelope/arriving_light.h"

#include <algorithm>
#include <cmath>

namespace sunfleck::envelope {

namespace {

// 1 / (1 - a p) stays finite in a closed crown of leaves that absorb nothing.
constexpr double kLargestRecollision = 1.0 - 1e-4;

}  // namespace

ArrivingLight::ArrivingLight(const PreparedParts& parts, const Sources& sources)
    : parts_(parts), sources_(sources), bands_(sources.bands.size()), lights_(sources.bands.size()) {}

void ArrivingLight::receive(const Receiver& receiver) {
  std::ranges::copy(receiver.depths, depth_.begin());
  transmittances({depth_.data(), sources_.row}, {through_.data(), sources_.row});
  double escaping = 0.0;
  for (std::size_t k = 0; k < parts_.set.count(); ++k) escaping += parts_.set.solid_angle_sr[k] * through_[k];
  recollision_ = std::clamp(1.0 - escaping / (4.0 * kPi), 0.0, kLargestRecollision);
  find_ground(receiver);
  set_lights();
  add_bounces(receiver);
}

void ArrivingLight::find_ground(const Receiver& receiver) {
  const std::size_t open = sources_.bands.front().ground_radiance.size() - 1;
  for (std::size_t k = 0; k < parts_.set.count(); ++k) {
    ground_[k] = open;
    if (sources_.ground_share[k] == 0.0f || open == 0) continue;
    std::int32_t cell = receiver.ground_cell;
    if (!receiver.is_ground)
      cell =
          parts_.ground.hit(receiver.field_point_m, parts_.field->field_direction(parts_.set.to_source[k]));
    if (cell != GroundCells::kOpen) ground_[k] = static_cast<std::size_t>(cell);
  }
}

void ArrivingLight::set_lights() {
  for (std::size_t b = 0; b < bands_.size(); ++b) {
    const BandSource& source = sources_.bands[b];
    for (std::size_t k = 0; k < parts_.set.count(); ++k) {
      const float ground = sources_.ground_share[k] * source.ground_radiance[ground_[k]];
      lights_[b][k] = source.sky_radiance[k] + ground;
      bands_[b].sky[k] = through_[k] * source.sky_radiance[k];  // Eq. 6
      bands_[b].ground[k] = through_[k] * ground;
    }
  }
}

void ArrivingLight::add_bounces(const Receiver& receiver) {
  const std::size_t row = sources_.row, count = parts_.set.count();
  const PrototypeMedium& medium = sources_.media[receiver.neighbours.value];
  const std::span<const float> depth(depth_.data(), row);
  const std::span<float> integral(integral_.data(), row);
  std::fill(integral.begin(), integral.end(), 0.0f);
  if (sources_.sun)
    bounce_sectors(static_cast<float>(receiver.sun_depth), medium.sun_approach, depth, integral);
  for (std::size_t b = 0; b < bands_.size(); ++b)
    for (std::size_t j = 0; j < count; ++j)
      bands_[b].foliage[j] = static_cast<float>(sources_.bands[b].beam_w_m2) * medium.bands[b].sun_turn[j] *
                             integral[j];  // Eq. 23, its depth never negative
  if (parts_.options.bounces != EnvelopeBounces::kSunOnce) {
    for (std::size_t j = 0; j < count; ++j) {
      bounce_row(depth, {medium.approach.data() + j * row, row}, depth_[j], integral);
      for (std::size_t b = 0; b < bands_.size(); ++b)
        bands_[b].foliage[j] +=
            row_product({medium.bands[b].turn.data() + j * row, row}, {lights_[b].data(), row}, integral);
    }
  }
  if (parts_.options.bounces != EnvelopeBounces::kAll) return;
  for (std::size_t b = 0; b < bands_.size(); ++b) {
    const float gain = static_cast<float>(1.0 / (1.0 - medium.bands[b].albedo * recollision_));
    for (std::size_t j = 0; j < count; ++j) bands_[b].foliage[j] *= gain;
  }
}

}  // namespace sunfleck::envelope
