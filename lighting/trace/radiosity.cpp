#include "lighting/trace/radiosity.h"

#include <algorithm>
#include <cmath>

#include "lighting/trace/ordered_sums.h"

namespace sunfleck::trace {
namespace {

template <std::size_t lanes>
using Field = std::vector<std::array<float, lanes>>;
template <std::size_t lanes>
using Values = std::array<double, lanes>;

Values<1> lane_means(const BandProblem& p, const Radiosity<1>& x, std::size_t face) {
  return {mean_met(p, x, face)};
}
Values<kGroups> lane_means(const BandProblem& p, const Radiosity<kGroups>& x, std::size_t face) {
  return mean_met(p, x, face).without_own_rays;
}
void set_first(const FirstLight& light, Values<1>& to) { to = {light.total()}; }
void set_first(const FirstLight& light, Values<kGroups>& to) { to = light.without_group; }

template <std::size_t lanes>
class Iteration {
 public:
  Iteration(const BandProblem& problem, const RunControl& control, Radiosity<lanes>& solution)
      : problem_(problem), receivers_(problem.receivers), control_(control), x_(solution) {
    const std::size_t rays = static_cast<std::size_t>(std::max(1, problem.matrix.rays));
    chunk_ = std::max<std::size_t>(1, 400000 / (lanes * rays));
    once_.resize(receivers_.end_count());
    scattered_.resize(receivers_.end_count());
    scatter_first_light();
  }

  // Radiosity by first light alone.
  const Field<lanes>& once() const { return once_; }
  double once_power() const {
    double most = 0.0;
    for (const double p : once_power_) most = std::max(most, p);
    return most;
  }

  struct Step {
    Values<lanes> power, change;  // W scattered; sum of absolute changes
  };
  Step step() {
    const Values<lanes> kept = scatter();
    Values<lanes> scale;
    for (std::size_t l = 0; l < lanes; ++l) {
      const double balance = once_power_[l] / kept[l];
      scale[l] = std::isfinite(balance) ? std::clamp(balance, 0.1, 100.0) : 1.0;
    }
    return add_up(scale);
  }

 private:
  void scatter_first_light() {
    once_power_ =
        ordered_sums<lanes>(receivers_.surface_count(), chunk_, control_,
                            [&](std::size_t begin, std::size_t end, Values<lanes>& sums) {
                              for (std::size_t s = begin; s < end; ++s) {
                                FacePair<lanes> e;
                                set_first(first_light(problem_, receivers_.first_face(s)), e.front);
                                if (!receivers_.is_ground(s))
                                  set_first(first_light(problem_, receivers_.first_face(s) + 1), e.back);
                                store(s, given_back(problem_.optics[s], e), once_);
                                add_power(s, once_, 1.0, sums);
                              }
                            });
  }

  // scattered = what the present field gives back; returns field - scattered, summed over area.
  Values<lanes> scatter() {
    return ordered_sums<lanes>(receivers_.surface_count(), chunk_, control_,
                               [&](std::size_t begin, std::size_t end, Values<lanes>& sums) {
                                 for (std::size_t s = begin; s < end; ++s) {
                                   FacePair<lanes> e;
                                   e.front = lane_means(problem_, x_, receivers_.first_face(s));
                                   if (!receivers_.is_ground(s))
                                     e.back = lane_means(problem_, x_, receivers_.first_face(s) + 1);
                                   store(s, given_back(problem_.optics[s], e), scattered_);
                                   add_power(s, x_.of_face, 1.0, sums);
                                   add_power(s, scattered_, -1.0, sums);
                                 }
                               });
  }

  // x = once + scale * scattered.
  Step add_up(const Values<lanes>& scale) {
    const auto sums = ordered_sums<2 * lanes>(
        receivers_.surface_count(), 8192, control_,
        [&](std::size_t begin, std::size_t end, std::array<double, 2 * lanes>& out) {
          for (std::size_t s = begin; s < end; ++s)
            for (std::size_t i = 0; i < receivers_.faces_of(s); ++i)
              add_up_face(receivers_.first_face(s) + i, receivers_.area_m2(s), scale, out);
        });
    Step step;
    for (std::size_t l = 0; l < lanes; ++l) step.power[l] = sums[l], step.change[l] = sums[lanes + l];
    return step;
  }

  void add_up_face(std::size_t f, double area_m2, const Values<lanes>& scale,
                   std::array<double, 2 * lanes>& out) {
    for (std::size_t l = 0; l < lanes; ++l) {
      const double next = once_[f][l] + scale[l] * scattered_[f][l];
      out[l] += area_m2 * next;
      out[lanes + l] += area_m2 * std::abs(next - scale[l] * x_.of_face[f][l]);
      x_.of_face[f][l] = static_cast<float>(next);
    }
  }

  void store(std::size_t s, const FacePair<lanes>& b, Field<lanes>& to) const {
    const std::size_t f = receivers_.first_face(s);
    for (std::size_t l = 0; l < lanes; ++l) to[f][l] = static_cast<float>(b.front[l]);
    if (receivers_.is_ground(s)) return;
    for (std::size_t l = 0; l < lanes; ++l) to[f + 1][l] = static_cast<float>(b.back[l]);
  }

  void add_power(std::size_t s, const Field<lanes>& of, double sign, Values<lanes>& sums) const {
    for (std::size_t i = 0; i < receivers_.faces_of(s); ++i)
      for (std::size_t l = 0; l < lanes; ++l)
        sums[l] += sign * receivers_.area_m2(s) * of[receivers_.first_face(s) + i][l];
  }

  const BandProblem& problem_;
  const Receivers& receivers_;
  const RunControl& control_;
  Radiosity<lanes>& x_;
  std::size_t chunk_;
  Field<lanes> once_, scattered_;
  Values<lanes> once_power_{};
};

}  // namespace

Radiosity<1> solve(const BandProblem& problem, const Convergence& convergence, const RunControl& control) {
  Radiosity<1> x;
  x.of_face.resize(problem.receivers.end_count());
  Iteration<1> iteration(problem, control, x);
  x.of_face = iteration.once();
  if (!(iteration.once_power() > 0.0)) return x;
  double change_before = 0.0;
  for (x.iterations = 1; x.iterations <= convergence.max_iterations; ++x.iterations) {
    const auto step = iteration.step();
    const double change = step.change[0], power = step.power[0];
    // Changes shrink by a steady factor q: what is still to come is change * q / (1 - q).
    const double q = change_before > 0.0 ? std::min(change / change_before, 0.999) : 0.9;
    if (change * q / (1.0 - q) <= convergence.relative * power) return x;
    change_before = change;
  }
  x.converged = false;
  return x;
}

Radiosity<kGroups> solve_without_groups(const BandProblem& problem, const Radiosity<1>& full,
                                        const Convergence& convergence, const RunControl& control) {
  Radiosity<kGroups> x;
  x.of_face.resize(problem.receivers.end_count());
  for (std::size_t f = 0; f < x.of_face.size(); ++f) x.of_face[f].fill(full.of_face[f][0]);
  if (problem.fewest_rays < 2 || full.iterations == 0) return x;
  Iteration<kGroups> iteration(problem, control, x);
  GroupValues before{};
  for (x.iterations = 1; x.iterations <= convergence.max_iterations; ++x.iterations) {
    const auto step = iteration.step();
    // Done when the scattered powers move by little of their spread, which is all that is asked of them.
    double moved = 0.0;
    for (std::size_t g = 0; g < kGroups; ++g) moved += std::pow(step.power[g] - before[g], 2);
    before = step.power;
    const double spread = jackknife_variance(step.power, problem.fewest_rays);
    if (x.iterations > 2 && moved <= 1e-3 * spread + std::pow(1e-9 * step.power[0], 2)) return x;
  }
  x.converged = false;
  return x;
}

}  // namespace sunfleck::trace
