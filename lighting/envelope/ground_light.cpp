// See ground_light.h.
#include "lighting/envelope/ground_light.h"

#include <algorithm>
#include <cmath>

#include "lighting/envelope/arriving_light.h"
#include "sim/base/parallel.h"

namespace sunfleck::envelope {

namespace {

constexpr int kMostRounds = 8;
constexpr double kSettled = 1e-3;  // relative change of the brightest cell

class GroundLight {
 public:
  GroundLight(Sources& sources, const PreparedParts& parts, const OpticsTable& optics, PrototypeId above,
              const RunControl& control)
      : sources_(sources), parts_(parts), optics_(optics), above_(above), control_(control) {}

  void run() {
    march_sun();
    set_weights();
    for (std::size_t b = 0; b < sources_.bands.size(); ++b) {
      std::vector<float>& radiance = sources_.bands[b].ground_radiance;
      const float open = radiance.back();
      radiance.assign(parts_.ground.count() + 1, 0.0f);
      radiance.back() = open;
    }
    for (int round = 0; round < kMostRounds; ++round)
      if (one_round() < kSettled) break;
  }

 private:
  void march_sun() {
    sun_depth_.assign(parts_.ground.count(), static_cast<float>(kLargestDepth));
    if (!sources_.sun || parts_.field->ends_on_ground(sources_.to_sun)) return;
    for_each_chunk(sun_depth_.size(), 16, control_, {}, [&](std::size_t begin, std::size_t end) {
      for (std::size_t g = begin; g < end; ++g)
        sun_depth_[g] =
            static_cast<float>(sources_.sun_grid ? sources_.sun_grid->depth_from_point(
                                                       parts_.ground.world_point(g), March::kForward)
                                                 : interpolated_sun_depth(sources_, depths(g)));
    });
  }

  // Irradiance of the ground per radiance of a sector, scaled so that open sky counts exactly.
  void set_weights() {
    const SectorSet& set = parts_.set;
    const Vec3 normal = parts_.ground.normal();
    weight_sr_.assign(set.count(), 0.0);
    double sum = 0.0;
    for (std::size_t k = 0; k < set.count(); ++k) {
      weight_sr_[k] = set.solid_angle_sr[k] * std::max(0.0, glm::dot(normal, set.to_source[k]));
      sum += weight_sr_[k];
    }
    for (double& w : weight_sr_) w *= kPi / sum;
    cosine_ = std::max(0.0, glm::dot(normal, sources_.to_sun));
  }

  std::span<const float> depths(std::size_t g) const {
    return {parts_.ground_depths.data() + g * parts_.set.count(), parts_.set.count()};
  }

  // Largest change relative to the open ground's radiance.
  double one_round() {
    std::vector<std::vector<float>> next;
    for (const BandSource& band : sources_.bands) next.push_back(band.ground_radiance);
    for_each_chunk(parts_.ground.count(), 64, control_, {}, [&](std::size_t begin, std::size_t end) {
      ArrivingLight light(parts_, sources_);
      for (std::size_t g = begin; g < end; ++g) {
        light.receive({.depths = depths(g),
                       .sun_depth = sun_depth_[g],
                       .neighbours = above_,
                       .ground_cell = static_cast<std::int32_t>(g),
                       .is_ground = true});
        for (std::size_t b = 0; b < next.size(); ++b)
          next[b][g] = static_cast<float>(optics_.soil_albedo(b) / kPi * irradiance(light, b, g));
      }
    });
    double change = 0.0;
    for (std::size_t b = 0; b < next.size(); ++b) {
      std::vector<float>& radiance = sources_.bands[b].ground_radiance;
      for (std::size_t g = 0; g < parts_.ground.count() && radiance.back() > 0.0f; ++g)
        change = std::max<double>(change, std::abs(next[b][g] - radiance[g]) / radiance.back());
      radiance = std::move(next[b]);
    }
    return change;
  }

  double irradiance(const ArrivingLight& light, std::size_t b, std::size_t g) const {
    const ArrivingBand& band = light.bands()[b];
    double sum = sources_.bands[b].beam_w_m2 * cosine_ * std::exp(-static_cast<double>(sun_depth_[g]));
    for (std::size_t k = 0; k < weight_sr_.size(); ++k)
      sum += weight_sr_[k] * (static_cast<double>(band.sky[k]) + band.foliage[k]);
    return sum;
  }

  Sources& sources_;
  const PreparedParts& parts_;
  const OpticsTable& optics_;
  const PrototypeId above_;
  const RunControl& control_;
  std::vector<float> sun_depth_;
  std::vector<double> weight_sr_;
  double cosine_ = 0;
};

}  // namespace

void light_ground(Sources& sources, const PreparedParts& parts, const OpticsTable& optics,
                  PrototypeId foliage_above, const RunControl& control) {
  bool bright = false;
  for (std::size_t b = 0; b < sources.bands.size(); ++b) bright = bright || optics.soil_albedo(b) > 0.0;
  if (!bright || parts.options.ground == EnvelopeGround::kFullyLit) return;
  GroundLight(sources, parts, optics, foliage_above, control).run();
}

}  // namespace sunfleck::envelope
