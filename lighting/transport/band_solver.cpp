// See band_solver.h.
#include "lighting/transport/band_solver.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "sim/base/parallel.h"

namespace sunfleck::transport {

namespace {

// Orders that shrink more slowly than this per bounce give no tail to go by.
constexpr double kSlowest = 0.9995;

// The prediction's error is some times its last change.
constexpr double kChangePerError = 0.25;

// Of the ground over its map.
struct GroundOrders {
  std::vector<float> last, total;
  double open = 0;  // irradiance beyond the map, of the first order only
};

// The series of emitted powers: what is still to come if it goes on as it did last.
class PowerSeries {
 public:
  void add(double power) {
    before_ = last_;
    last_ = power;
    sum_ += power;
  }
  double tail_factor() const {
    if (!(before_ > 0.0) || !(last_ < kSlowest * before_)) return 0.0;
    const double ratio = last_ / before_;
    return ratio / (1.0 - ratio);
  }
  double prediction() const { return sum_ + tail_factor() * last_; }
  bool is_nothing() const { return !(last_ > 0.0); }

 private:
  double last_ = 0, before_ = 0, sum_ = 0;
};

class BandSolver {
 public:
  BandSolver(const TransportScene& scene, const LeafScattering& leaves, const BandProblem& problem,
             const RunControl& control)
      : scene_(scene), leaves_(leaves), problem_(problem), control_(control), around_(scene.set.count()) {
    solution_.scattered.resize(scene.set.count() * scene.cells());
  }

  BandSolution run(const Convergence& convergence) {
    first_order();
    double predicted = series_.prediction();
    solution_.converged = series_.is_nothing();
    while (!solution_.converged && solution_.iterations < convergence.max_iterations) {
      next_order();
      const double before = std::exchange(predicted, series_.prediction());
      const bool steady = std::abs(predicted - before) <= kChangePerError * convergence.relative * predicted;
      solution_.converged = series_.is_nothing() || (solution_.iterations >= 2 && steady);
    }
    sweep_total();
    return std::move(solution_);
  }

 private:
  double ground_power(const std::vector<float>& irradiance) const {
    return problem_.soil_albedo * scene_.ground->cell_area_m2() *
           std::accumulate(irradiance.begin(), irradiance.end(), 0.0);
  }

  void first_order() {
    DirectLight direct;
    ground_.last =
        ground_irradiance(scene_, *problem_.sectors, *problem_.sky, problem_.sectors->sky_radiance, control_);
    for (float& e : ground_.last) e *= static_cast<float>(problem_.diffuse_w_m2);
    ground_.open = problem_.diffuse_w_m2 * problem_.sectors->open_ground_irradiance;
    if (problem_.sun != nullptr) {
      direct = {problem_.sun->elements, problem_.sun->wood, problem_.beam_w_m2};
      for (std::size_t g = 0; g < ground_.last.size(); ++g)
        ground_.last[g] += static_cast<float>(problem_.beam_w_m2 * problem_.sun->ground[g]);
      ground_.open += problem_.beam_w_m2 * problem_.sun->open_ground;
    }
    ground_.total = ground_.last;
    const double power = leaves_.next_order(*problem_.sky, problem_.diffuse_w_m2, direct, orders_,
                                            solution_.scattered, control_);
    series_.add(power + ground_power(ground_.last));
  }

  void next_order() {
    sweep_all(ground_.last, solution_.iterations == 0 ? ground_.open : 0.0, around_, problem_.scattered_from);
    add_around(1.0);
    const std::vector<double> nothing(scene_.set.count(), 0.0);
    ground_.last = ground_irradiance(scene_, *problem_.sectors, solution_.scattered, nothing, control_);
    for (std::size_t g = 0; g < ground_.last.size(); ++g) ground_.total[g] += ground_.last[g];
    const double power =
        leaves_.next_order(solution_.scattered, 1.0, {}, orders_, solution_.scattered, control_);
    series_.add(power + ground_power(ground_.last));
    ++solution_.iterations;
  }

  void sweep_total() {
    const double tail = series_.tail_factor();
    for (std::size_t g = 0; g < ground_.total.size(); ++g)
      ground_.total[g] += static_cast<float>(tail) * ground_.last[g];
    leaves_.total_source(orders_, tail, solution_.scattered, control_);
    add_around(tail);
    around_total_.resize(scene_.set.count());
    sweep_all(ground_.total, ground_.open, around_total_, CellValue::kMiddle);
    solution_.part_radiosity = leaves_.total_radiosity(orders_, tail, control_);
    solution_.ground_irradiance = std::move(ground_.total);
    solution_.wood_radiance = std::move(orders_.wood_total);
    for (std::size_t w = 0; w < solution_.wood_radiance.size(); ++w)
      solution_.wood_radiance[w] += static_cast<float>(tail) * orders_.wood_last[w];
  }

  // What leaves a repeating grid at its end comes in again at its beginning with the next order.
  void add_around(double factor) {
    around_total_.resize(scene_.set.count());
    for (std::size_t d = 0; d < around_.size(); ++d) {
      around_total_[d].resize(around_[d].size());
      for (std::size_t i = 0; i < around_[d].size(); ++i)
        around_total_[d][i] += static_cast<float>(factor) * around_[d][i];
    }
  }

  void sweep_all(const std::vector<float>& irradiance, double open_irradiance,
                 std::vector<std::vector<float>>& around, CellValue value) {
    const double radiance_per_irradiance = problem_.soil_albedo / kPi;
    std::vector<float> ground(irradiance);
    for (float& radiance : ground) radiance *= static_cast<float>(radiance_per_irradiance);
    const auto open = static_cast<float>(radiance_per_irradiance * open_irradiance);
    for_each_chunk(scene_.set.count(), 1, control_, {}, [&](std::size_t d, std::size_t) {
      sweep(scene_.plans[d], scene_.transmittance_of(d),
            GroundInflow(scene_, *problem_.sectors, d, ground, open), scene_.part_of(solution_.scattered, d),
            around[d], control_, value);
    });
  }

  const TransportScene& scene_;
  const LeafScattering& leaves_;
  const BandProblem& problem_;
  const RunControl& control_;
  Orders orders_;
  GroundOrders ground_;
  PowerSeries series_;
  std::vector<std::vector<float>> around_, around_total_;  // per direction
  BandSolution solution_;
};

}  // namespace

BandSolution solve_band(const TransportScene& scene, const LeafScattering& leaves, const BandProblem& problem,
                        const Convergence& convergence, const RunControl& control) {
  return BandSolver(scene, leaves, problem, control).run(convergence);
}

}  // namespace sunfleck::transport
