// See sensor_canopy.h.
#include "lighting/canopy/sensor_canopy.h"

#include <algorithm>
#include <cmath>

#include "sim/base/contract.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"

namespace sunfleck {

namespace {

constexpr int kSegments = 24;  // of azimuth, for the logarithmic mean

struct Band {
  double from_deg, to_deg;
};
// Fields of view of the LAI-2000's rings (LI-COR manual).
constexpr std::array<Band, 5> kLai2000{{{0, 13}, {16, 28}, {32, 43}, {47, 58}, {61, 74}}};
// sin(theta) dtheta of the five rings widened to cover 0 to 90 degrees (Welles and Norman 1991), sum 1.010.
constexpr std::array<double, 5> kLai2000Weights{0.034, 0.104, 0.160, 0.218, 0.494};

void check(const CanopyOptions& o) {
  if (o.zenith_steps < 9 || o.zenith_steps > 1800 || o.azimuth_steps < kSegments || o.azimuth_steps > 7200)
    throw_invalid("canopy",
                  "cannot look in " + std::to_string(o.zenith_steps) + " x " +
                      std::to_string(o.azimuth_steps) + " directions",
                  "9 to 1800 steps of zenith, 24 to 7200 of azimuth");
  if (!(o.last_zenith_deg >= 10.0 && o.last_zenith_deg <= 90.0))
    throw_invalid("canopy.last_zenith_deg", "is out of range", "10 to 90 degrees");
}

// One ray: where it went, what it stands for, and whether it saw the sky.
struct View {
  double zenith_deg, solid_angle;
  int segment;
  bool sky;
};

std::vector<View> look_around(const StandScene& scene, const Vec3& point, std::size_t sensor,
                              const CanopyOptions& o, const RunControl& control) {
  std::vector<View> views;
  views.reserve(static_cast<std::size_t>(o.zenith_steps) * static_cast<std::size_t>(o.azimuth_steps));
  RandomStream random(o.seed, sensor, RandomPurpose::kSensorRays);
  for (int z = 0; z < o.zenith_steps; ++z) {
    control.check();
    for (int a = 0; a < o.azimuth_steps; ++a) {
      const double zenith = 0.5 * kPi * (z + random.uniform()) / o.zenith_steps;
      const double azimuth = 2.0 * kPi * (a + random.uniform()) / o.azimuth_steps;
      const Vec3 to = direction_from_azimuth_zenith(azimuth, std::min(zenith, 0.4999999 * kPi));
      views.push_back({degrees_from_radians(zenith), std::sin(zenith), a * kSegments / o.azimuth_steps,
                       !scene.rays().occluded(point, to)});
    }
  }
  return views;
}

// Weighted share of sky, its error, over the views that `weight` gives more than 0.
struct Share {
  double value = 1, error = 0;
};
template <class Weight>
Share share_of(const std::vector<View>& views, const Weight& weight) {
  double all = 0.0, sky = 0.0, squares = 0.0;
  for (const View& v : views) {
    const double w = weight(v);
    all += w;
    squares += w * w;
    if (v.sky) sky += w;
  }
  if (!(all > 0.0)) return {};
  const double p = sky / all, n = all * all / squares;
  const double smoothed = (p * n + 0.5) / (n + 1.0);  // no certainty from a run of equal outcomes
  return {p, std::sqrt(smoothed * (1.0 - smoothed) / n)};
}

GapRing ring_of(const std::vector<View>& views, const Band& band) {
  GapRing ring{band.from_deg, band.to_deg};
  const auto inside = [&](const View& v) {
    return v.zenith_deg >= band.from_deg && v.zenith_deg < band.to_deg ? v.solid_angle : 0.0;
  };
  const Share whole = share_of(views, inside);
  std::array<double, kSegments> all{}, sky{}, count{};
  for (const View& v : views) {
    const auto s = static_cast<std::size_t>(v.segment);
    all[s] += inside(v);
    if (v.sky) sky[s] += inside(v);
    count[s] += inside(v) > 0.0 ? 1.0 : 0.0;
  }
  double logs = 0.0;
  int segments = 0;
  for (std::size_t s = 0; s < kSegments; ++s) {
    if (count[s] == 0.0) continue;
    logs += std::log(std::max(sky[s] / all[s], 0.5 / count[s]));
    ++segments;
  }
  ring.gap_fraction = whole.value;
  ring.standard_error = whole.error;
  if (segments > 0) ring.log_mean_gap = std::exp(logs / segments);
  return ring;
}

// Half a ray of the ring where there is no gap at all.
double floor_of(const GapRing& ring) { return std::max(ring.gap_fraction, 0.5 * ring.standard_error); }

double contact(double gap, const GapRing& ring) {
  return -std::log(std::max(gap, 1e-12)) *
         std::cos(radians_from_degrees(0.5 * (ring.from_deg + ring.to_deg)));
}

// L = 2 sum -ln P cos(theta) w.
void infer_lai(SensorCanopy& canopy) {
  double weight_sum = 0.0;
  for (const double w : kLai2000Weights) weight_sum += w;
  double variance = 0.0;
  for (std::size_t i = 0; i < 5; ++i) {
    const GapRing& ring = canopy.rings_lai2000[i];
    const double w = 2.0 * kLai2000Weights[i] / weight_sum;
    canopy.effective_lai_lai2000 += w * contact(floor_of(ring), ring);
    canopy.clumped_lai += w * contact(ring.log_mean_gap, ring);
    const double relative = ring.standard_error / floor_of(ring);
    variance +=
        std::pow(w * std::cos(radians_from_degrees(0.5 * (ring.from_deg + ring.to_deg))) * relative, 2);
  }
  canopy.effective_lai_error = std::sqrt(variance);
  if (canopy.clumped_lai > 0.0) canopy.clumping = canopy.effective_lai_lai2000 / canopy.clumped_lai;
  double ten_weights = 0.0, ten = 0.0;
  for (std::size_t i = 0; i < 8; ++i) {
    const GapRing& ring = canopy.rings_10_deg[i];
    const double w =
        std::cos(radians_from_degrees(ring.from_deg)) - std::cos(radians_from_degrees(ring.to_deg));
    ten_weights += w;
    ten += 2.0 * w * contact(floor_of(ring), ring);
  }
  canopy.effective_lai_10_deg = ten / ten_weights;
}

SensorCanopy canopy_of(const std::vector<View>& views, double last_zenith_deg) {
  SensorCanopy canopy;
  const Share open =
      share_of(views, [&](const View& v) { return v.zenith_deg < last_zenith_deg ? v.solid_angle : 0.0; });
  const Share view = share_of(views, [&](const View& v) {
    return v.zenith_deg < last_zenith_deg ? v.solid_angle * std::cos(radians_from_degrees(v.zenith_deg))
                                          : 0.0;
  });
  canopy.openness = open.value;
  canopy.openness_error = open.error;
  canopy.sky_view_factor = view.value;
  canopy.sky_view_factor_error = view.error;
  for (int k = 0; k < 9; ++k) canopy.rings_10_deg.push_back(ring_of(views, {10.0 * k, 10.0 * (k + 1)}));
  for (std::size_t k = 0; k < 5; ++k) canopy.rings_lai2000[k] = ring_of(views, kLai2000[k]);
  infer_lai(canopy);
  return canopy;
}

}  // namespace

double GapRing::clumping() const {
  const double random = std::log(std::max(log_mean_gap, 1e-12));
  return random < 0.0 ? std::clamp(std::log(std::max(gap_fraction, 1e-12)) / random, 0.0, 1.0) : 1.0;
}

std::vector<SensorCanopy> sensor_canopy(const StandScene& scene, const std::vector<LightSensor>& sensors,
                                        const CanopyOptions& options, const RunControl& control) {
  check(options);
  std::vector<SensorCanopy> out(sensors.size());
  for_each_chunk(sensors.size(), 1, control, "canopy over sensors", [&](std::size_t s, std::size_t) {
    const Vec3 point = sensor_point_m(sensors[s], scene);
    out[s] = canopy_of(look_around(scene, point, s, options, control), options.last_zenith_deg);
  });
  return out;
}

HemisphericalPhotograph hemispherical_photograph(const StandScene& scene, const LightSensor& sensor,
                                                 const PhotographOptions& o, const RunControl& control) {
  if (o.pixels < 8 || o.pixels > 8192 || o.samples_per_pixel < 1 || o.samples_per_pixel > 1024)
    throw_invalid("photograph",
                  "cannot be " + std::to_string(o.pixels) + " pixels wide with " +
                      std::to_string(o.samples_per_pixel) + " samples per pixel",
                  "8 to 8192 pixels, 1 to 1024 samples");
  const auto edge = static_cast<std::size_t>(o.pixels);
  HemisphericalPhotograph photo{o.pixels, std::vector<float>(edge * edge, 0.0f)};
  const Vec3 point = sensor_point_m(sensor, scene);
  for_each_chunk(edge, 1, control, "photograph", [&](std::size_t row, std::size_t) {
    for (std::size_t column = 0; column < edge; ++column) {
      RandomStream random(o.seed, row * edge + column, RandomPurpose::kSensorRays);
      int seen = 0;
      for (int k = 0; k < o.samples_per_pixel; ++k) {
        const double left = 1.0 - 2.0 * (static_cast<double>(column) + random.uniform()) / o.pixels;
        const double up = 1.0 - 2.0 * (static_cast<double>(row) + random.uniform()) / o.pixels;
        const double rim = std::hypot(left, up);
        if (rim >= 1.0) continue;
        const Vec3 to = direction_from_azimuth_zenith(std::atan2(left, up), 0.5 * kPi * rim);
        seen += to.z > 0.0 && !scene.rays().occluded(point, to) ? 1 : 0;
      }
      photo.sky[row * edge + column] = static_cast<float>(seen) / static_cast<float>(o.samples_per_pixel);
    }
  });
  return photo;
}

}  // namespace sunfleck
