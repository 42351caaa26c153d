#include "lighting/trace/sun_raster.h"

#include <algorithm>
#include <cmath>

#include "lighting/trace/raster_error.h"
#include "lighting/trace/raster_picture.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"

namespace sunfleck {

using namespace trace;

namespace {

void check(bool good, const char* field, const char* range) {
  if (!good) throw_invalid(std::string("sun_raster.") + field, "is out of range", range);
}

void check_options(const SunRasterOptions& o) {
  check(std::isfinite(o.pixel_m) && o.pixel_m >= 0.0, "pixel_m", "0 (from target_error) or a side in metres");
  check(o.pixel_m > 0.0 || (o.target_error >= 1e-3 && o.target_error <= 1.0), "target_error", "0.001 to 1");
  check(o.sun_directions >= 0 && o.sun_directions <= 4096, "sun_directions", "0 (chosen) to 4096");
}

// Lifted where the picture of a period would be endless.
Vec3 lifted(const Forest& forest, const Vec3& to_sun) {
  if (!forest.period) return to_sun;
  const double climb = climb_of(forest.terrain, to_sun);
  if (std::abs(climb) >= kLowestClimb) return to_sun;
  return glm::normalize(to_sun + Vec3(0, 0, kLowestClimb - climb));
}

double fraction_of(double x) { return x - std::floor(x); }

// Roberts' R2 lattice, shifted at random, over the disc: every point alone is evenly distributed.
Vec3 point_of_disc(const Vec3& axis, double half_angle_rad, int k, double shift_a, double shift_b) {
  if (half_angle_rad == 0.0) return axis;
  const double a = fraction_of(shift_a + k * 0.7548776662466927), b = fraction_of(shift_b + k * 0.5698402909980532);
  const double drop = a * 2.0 * std::pow(std::sin(0.5 * half_angle_rad), 2);  // 1 - cos
  const double across = std::sqrt(drop * (2.0 - drop)), turn = 2.0 * kPi * b;
  const Basis basis = basis_around(axis);
  return glm::normalize((1.0 - drop) * axis +
                        across * (std::cos(turn) * basis.tangent + std::sin(turn) * basis.bitangent));
}

// Side of a square of the mean leaf area, m.
double typical_side_m(const Forest& forest, std::size_t elements) {
  return std::sqrt(forest_leaf_area_m2(forest) / static_cast<double>(elements));
}

BeamOnFaces beam_on(const FoliageElement& e, const Vec3& to_sun) {
  // Needles face everywhere alike: mean of max(0, cosine).
  if (e.shape == ElementShape::kShoot) return {0.25f, 0.25f};
  const auto cosine = static_cast<float>(glm::dot(element_normal(e), to_sun));
  return {std::max(0.0f, cosine), std::max(0.0f, -cosine)};
}

class SunRaster {
 public:
  SunRaster(const Forest& forest, const ForestIndex& index, const Vec3& to_sun, double half_angle_rad,
            const SunRasterOptions& options, const RunControl& control)
      : forest_(forest),
        index_(index),
        to_sun_(to_sun),
        half_angle_rad_(half_angle_rad),
        options_(options),
        control_(control),
        bounds_(forest_bounds(forest)),
        side_m_(typical_side_m(forest, index.element_count())),
        painter_(forest, index, options.memory_limit_bytes) {}

  SunExposure run() {
    directions_ = options_.sun_directions > 0 ? options_.sun_directions : chosen_directions();
    double pixel_m = options_.pixel_m;
    if (pixel_m == 0.0) {
      // The error falls as pixel^1.5 / sqrt(directions).
      const double coarse_m = 0.3 * side_m_;
      const SunExposure first = draw(coarse_m, 1, 1);
      const double factor = options_.target_error * std::sqrt(directions_) / first.relative_error;
      pixel_m = coarse_m * std::clamp(0.95 * std::pow(factor, 2.0 / 3.0), 0.01, 4.0);
    }
    return draw(pixel_m, directions_, 0);
  }

 private:
  int chosen_directions() const {
    // Width of a penumbra half the forest's depth away.
    const double away_m = 0.5 * std::min(glm::length(bounds_.size()), 4.0 * bounds_.size().z);
    const double widths = 2.0 * half_angle_rad_ * away_m / side_m_;
    if (widths < 0.1) return 1;
    return widths < 1.0 ? 4 : 16;
  }

  SunExposure draw(double pixel_m, int directions, std::uint64_t round) {
    RandomStream disc(options_.seed, round, RandomPurpose::kSunRaster);
    const double shift_a = disc.uniform(), shift_b = disc.uniform();
    std::vector<SunlitMean> means(index_.element_count());
    SunExposure out;
    for (int k = 0; k < directions; ++k) {
      control_.report("drawing sun", static_cast<double>(k) / directions);
      const Vec3 to_sun = point_of_disc(to_sun_, half_angle_rad_, k, shift_a, shift_b);
      add_picture(to_sun, pixel_m, mix_seed(round, static_cast<std::uint64_t>(k)), means, out);
    }
    control_.report("drawing sun", 1.0);
    out.pixel_m = pixel_m;
    out.sun_directions = directions;
    finish(means, out);
    return out;
  }

  void add_picture(const Vec3& to_sun, double pixel_m, std::uint64_t number, std::vector<SunlitMean>& means,
                   SunExposure& out) {
    if (options_.ground && !(climb_of(forest_.terrain, to_sun) > 0.0)) {
      for (SunlitMean& m : means) m.add({0.0, 0.0});
      return;
    }
    const RasterView view = make_view(forest_, bounds_, lifted(forest_, to_sun), pixel_m, options_.ground,
                                      RandomStream(options_.seed, number + 2, RandomPurpose::kSunRaster));
    const SunPicture picture = painter_.paint(view, mix_seed(options_.seed, number), control_);
    std::uint64_t covered = 0;
    for_each_element([&](std::size_t e, const FoliageElement& element) {
      const SunTally& tally = picture.tallies[e];
      covered += tally.covered;
      const double looked_up = picture.looked_up[e];
      means[e].add(element.shape == ElementShape::kShoot ? sunlit_shoot(tally, looked_up)
                                                          : sunlit_leaf(tally, looked_up));
    });
    out.pixels += static_cast<std::uint64_t>(static_cast<double>(covered) / kWhole);
  }

  void finish(const std::vector<SunlitMean>& means, SunExposure& out) const {
    out.sunlit_fraction.resize(means.size());
    out.standard_error.resize(means.size());
    double light = 0.0, squares = 0.0;
    std::size_t e = 0;
    for (std::size_t i = 0; i < forest_.instances.size(); ++i) {
      const Vec3 to_sun = tree_direction_from_world(forest_.instances[i], to_sun_);
      for (const FoliageElement& element : forest_.prototypes[forest_.instances[i].prototype.value].foliage) {
        const SunlitEstimate mean = means[e].mean(out.sun_directions);
        const double beam = beam_on(element, to_sun).both();
        out.sunlit_fraction[e] = static_cast<float>(mean.fraction);
        out.standard_error[e] = static_cast<float>(std::sqrt(mean.variance));
        light += beam * mean.fraction;
        squares += beam * beam * mean.variance;
        ++e;
      }
    }
    const auto n = static_cast<double>(means.size());
    out.relative_error = light > 0.0 ? std::sqrt(squares / n) / (light / n) : 0.0;
  }

  template <class Visit>
  void for_each_element(Visit&& visit) const {
    std::size_t e = 0;
    for (const Instance& i : forest_.instances)
      for (const FoliageElement& element : forest_.prototypes[i.prototype.value].foliage) visit(e++, element);
  }

  const Forest& forest_;
  const ForestIndex& index_;
  const Vec3 to_sun_;
  const double half_angle_rad_;
  const SunRasterOptions& options_;
  const RunControl& control_;
  const Box bounds_;
  const double side_m_;
  const PicturePainter painter_;
  int directions_ = 1;
};

}  // namespace

BeamOnFaces beam_on_faces(const Forest& forest, std::size_t instance, std::size_t local, const Vec3& to_sun) {
  const Instance& i = forest.instances[instance];
  return beam_on(forest.prototypes[i.prototype.value].foliage[local],
                            tree_direction_from_world(i, to_sun));
}

SunExposure raster_sun(const Forest& forest, const ForestIndex& index, const Vec3& to_sun,
                       double half_angle_rad, const SunRasterOptions& options, const RunControl& control) {
  check_options(options);
  control.check();
  if (index.element_count() == 0) return {};
  if (!(to_sun.z > 0.0)) {
    SunExposure dark;
    dark.sunlit_fraction.resize(index.element_count());
    dark.standard_error.resize(index.element_count());
    return dark;
  }
  return SunRaster(forest, index, to_sun, half_angle_rad, options, control).run();
}

}  // namespace sunfleck
