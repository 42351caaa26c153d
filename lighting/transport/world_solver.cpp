// See world_solver.h. The radiance of sky and scattered light together is iterated: what leaves, wood and
// ground give back, swept again with the sky coming in, until the power they give back is known; the rest of
// the series is then added in proportion.
#include "lighting/transport/world_solver.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "lighting/transport/world_scatter.h"
#include "lighting/transport/world_sums.h"
#include "sim/base/parallel.h"

namespace sunfleck::transport {

namespace {

constexpr double kSlowest = 0.9995;       // orders that shrink more slowly give no tail to go by
constexpr double kChangePerError = 0.25;  // the prediction's error is some times its last change
// The tail is added in the shape of all orders, which it has not quite: it may be this times the tolerance.
constexpr double kLongestTail = 10.0;

class WorldSolver {
 public:
  WorldSolver(const WorldScene& scene, const WorldSources& sources, const BandLight& strength,
              double soil_albedo, const WorldKernels& kernels, const RunControl& control)
      : scene_(scene),
        sources_(sources),
        strength_(strength),
        soil_albedo_(soil_albedo),
        kernels_(kernels),
        control_(control),
        around_(scene.set.count()) {}

  void run(const WorldOptions& options, WorldBand& band) {
    start();
    double before_power = 0.0, before_order = 0.0, predicted = 0.0;
    band.converged = false;
    for (band.iterations = 0;; ++band.iterations) {
      WorldGround ground = world_ground(scene_, sources_, strength_, radiance_, control_);
      const double power = scatter() + ground_power(ground);
      const double order = power - before_power;
      double tail = 0.0;
      if (band.iterations > 0 && order > 0.0 && order < kSlowest * before_order)
        tail = order * order / (before_order - order);
      const double before = std::exchange(predicted, power + tail);
      before_power = power;
      before_order = order;
      const bool steady =
          std::abs(predicted - before) <= kChangePerError * options.convergence * std::abs(predicted);
      const bool short_tail = tail <= kLongestTail * options.convergence * power;
      band.converged = !(power > 0.0) || (band.iterations >= 2 && steady && short_tail);
      const bool last = band.converged || band.iterations >= options.max_iterations;
      if (last && power > 0.0) add_tail(predicted / power, ground);
      sweep_all(ground);
      if (last) break;
    }
    band.radiance = std::move(radiance_);
    band.ground_irradiance = world_ground(scene_, sources_, strength_, band.radiance, control_).irradiance;
  }

 private:
  void start() {
    radiance_.assign(scene_.set.count() * scene_.cells(), 0.0f);
    if (sources_.sky.empty() || !(strength_.diffuse_horizontal_w_m2 > 0.0)) return;
    const auto diffuse = static_cast<float>(strength_.diffuse_horizontal_w_m2);
    around_ = sources_.sky_around;
    for (auto& direction : around_)
      for (float& radiance : direction) radiance *= diffuse;
    for_each_chunk(radiance_.size(), 1 << 18, control_, {}, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) radiance_[i] = diffuse * sources_.sky[i];
    });
  }

  double ground_power(const WorldGround& ground) const {
    return soil_albedo_ * scene_.ground->cell_area_m2() *
           std::accumulate(ground.irradiance.begin(), ground.irradiance.end(), 0.0);
  }

  // Radiance to source functions, in place. Returns the power given back.
  double scatter() {
    const auto beam = static_cast<float>(strength_.beam_normal_w_m2);
    const ScatterCell scatter_cell = scatter_cell_best();
    std::vector<double> power(scene_.ranges.size(), 0.0);
    for_each_chunk(scene_.ranges.size(), 1, control_, {}, [&](std::size_t r, std::size_t) {
      const std::size_t half = scene_.set.half(), cells = scene_.cells();
      for (std::uint32_t c = scene_.ranges[r].begin; c < scene_.ranges[r].end; ++c) {
        const std::uint32_t begin = scene_.first_entry[c], end = scene_.first_entry[c + 1];
        if (begin == end) continue;  // all light passes, whatever the source function is
        const BothLanes light = radiance_in(scene_, radiance_, c);
        const float sun = sources_.sun_transmittance.empty() ? 0.0f : beam * sources_.sun_transmittance[c];
        alignas(64) BothLanes source{};
        alignas(64) Lanes cover{};
        for (std::uint32_t e = begin; e < end; ++e) {
          const WorldEntry& entry = scene_.entries[e];
          for (std::size_t j = 0; j < kLanes; ++j) cover[j] += entry.area_m2 * scene_.cover[entry.kind][j];
        }
        scatter_cell(std::span(scene_.entries).subspan(begin, end - begin), kernels_.kinds.data(), light, sun,
                     source);
        float sent = 0.0f;
        for (std::size_t j = 0; j < kLanes; ++j)
          sent += scene_.lanes.solid_angle_sr[j] * (source[j] + source[kLanes + j]);
        power[r] += sent;
        for (std::size_t j = 0; j < half; ++j) {
          const float per_cover = cover[j] > 0.0f ? 1.0f / cover[j] : 0.0f;
          radiance_[j * cells + c] = source[j] * per_cover;
          radiance_[(half + j) * cells + c] = source[kLanes + j] * per_cover;
        }
      }
    });
    return std::accumulate(power.begin(), power.end(), 0.0);
  }

  void add_tail(double factor, WorldGround& ground) {
    const auto f = static_cast<float>(factor);
    for_each_chunk(radiance_.size(), 1 << 18, control_, {}, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) radiance_[i] *= f;
    });
    for (float& e : ground.irradiance) e *= f;
  }

  void sweep_all(const WorldGround& ground) {
    const std::vector<float> lit = ground_radiance(ground, soil_albedo_);
    const auto open = static_cast<float>(soil_albedo_ / kPi * ground.open);
    for_each_chunk(scene_.set.count(), 1, control_, {}, [&](std::size_t d, std::size_t) {
      const WorldInflow inflow(scene_, sources_.sectors, d, strength_.diffuse_horizontal_w_m2, lit, open);
      sweep(scene_.plans[d], scene_.transmittance_of(d), inflow, scene_.part_of(radiance_, d), around_[d],
            control_);
    });
  }

  const WorldScene& scene_;
  const WorldSources& sources_;
  const BandLight strength_;
  const double soil_albedo_;
  const WorldKernels& kernels_;
  const RunControl& control_;
  std::vector<std::vector<float>> around_;
  std::vector<float> radiance_;
};

}  // namespace

void solve_world_band(const WorldScene& scene, const Forest& forest, const WorldSources& sources,
                      const BandLight& strength, double soil_albedo, const WorldOptions& options,
                      WorldBand& band, const RunControl& control) {
  const BandLight lit{.beam_normal_w_m2 = sources.sun_ground.empty() ? 0.0 : strength.beam_normal_w_m2,
                      .diffuse_horizontal_w_m2 = strength.diffuse_horizontal_w_m2};
  WorldSolver(scene, sources, lit, soil_albedo, *band.kernels, control).run(options, band);
  add_sums(scene, forest, sources, lit, soil_albedo, band, control);
}

}  // namespace sunfleck::transport
