// See crown_optics.h.
#include "lighting/canopy/crown_optics.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lighting/canopy/box_sweep.h"
#include "lighting/canopy/crown_rays.h"
#include "sim/base/parallel.h"

namespace sunfleck {

namespace {

constexpr std::array<double, 7> kZenithDeg{0, 20, 40, 55, 68, 78, 86};
constexpr std::array<double, 6> kAzimuthDeg{15, 75, 135, 195, 255, 315};
constexpr double kMostShown = 4;  // m2 per m2; above it a crown is opaque in any box

double between(const std::vector<double>& x, const std::vector<double>& y, double at) {
  if (x.empty()) return 0.0;
  const auto above = std::upper_bound(x.begin(), x.end(), at);
  if (above == x.begin()) return y.front();
  if (above == x.end()) return y.back();
  const auto i = static_cast<std::size_t>(above - x.begin());
  const double part = (at - x[i - 1]) / (x[i] - x[i - 1]);
  return y[i - 1] + part * (y[i] - y[i - 1]);
}

// Interception in boxes rises with what the area shows; bisection.
double fitted_shown(BoxSweep& sweep, const std::vector<Vec3>& suns, double wanted_m2,
                    const RunControl& control) {
  double lo = 0.0, hi = kMostShown;
  for (int step = 0; step < 16; ++step) {
    const double middle = 0.5 * (lo + hi);
    double got = 0.0;
    for (std::size_t a = 0; a < suns.size(); ++a) {
      const std::array<float, 1> shown{static_cast<float>(middle)};
      got += sweep.run(suns[a], shown, a, control).intercepted_m2[0] / static_cast<double>(suns.size());
    }
    (got < wanted_m2 ? lo : hi) = middle;
  }
  return 0.5 * (lo + hi);
}

CrownOptics optics_of(const CrownAlone& crown, const CrownOpticsOptions& options, std::size_t prototype,
                      const RunControl& control) {
  CrownOptics optics;
  const BoxCanopy canopy = box_canopy(crown.forest(), options.voxel_m, control);
  BoxSweep sweep(canopy);
  RandomStream random(options.seed, prototype, RandomPurpose::kStandRays);
  for (const double zenith_deg : kZenithDeg) {
    std::vector<Vec3> suns;
    double traced = 0.0;
    for (const double azimuth_deg : kAzimuthDeg) {
      control.check();
      suns.push_back(
          direction_from_azimuth_zenith(radians_from_degrees(azimuth_deg), radians_from_degrees(zenith_deg)));
      traced += crown.intercept(suns.back(), 0.0, options.rays, random).m2 /
                static_cast<double>(kAzimuthDeg.size());
    }
    optics.zenith_rad.push_back(radians_from_degrees(zenith_deg));
    optics.alone_m2.push_back(traced);
    optics.shown_per_area.push_back(fitted_shown(sweep, suns, traced, control));
  }
  return optics;
}

}  // namespace

double CrownOptics::alone_at(double zenith) const { return between(zenith_rad, alone_m2, zenith); }
double CrownOptics::shown_at(double zenith) const { return between(zenith_rad, shown_per_area, zenith); }

std::vector<CrownOptics> crown_optics(const Forest& forest, const CrownOpticsOptions& options,
                                      const RunControl& control) {
  std::vector<CrownOptics> out(forest.prototypes.size());
  std::vector<char> used(out.size(), 0);
  for (const Instance& tree : forest.instances) used[tree.prototype.value] = 1;
  for_each_chunk(out.size(), 1, control, "crowns alone", [&](std::size_t p, std::size_t) {
    if (!used[p] || prototype_bounds(forest.prototypes[p]).empty()) return;
    out[p] = optics_of(CrownAlone(forest, p, control), options, p, control);
  });
  return out;
}

}  // namespace sunfleck
