// Digits of the envelope's closed forms, see stability.h. Truth: long double, series where terms cancel; our
// forms and the printed ones see the same rounded arguments.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <numbers>

#include "lighting/bench/stability.h"
#include "lighting/envelope/bounce_kernel.h"
#include "lighting/envelope/closed_forms.h"

namespace sunfleck {

namespace {

using envelope::AnglePair;
using Long = long double;

constexpr Long kLongPi = std::numbers::pi_v<Long>;

// Values below this carry no light and may underflow.
template <class Real>
constexpr Long kNothing = std::is_same_v<Real, double> ? 1e-30L : 1e-30L;

template <class Real>
std::string precision_name() {
  return std::is_same_v<Real, double> ? "double" : "float";
}

template <class Real>
class Sweep {
 public:
  explicit Sweep(std::string form) {
    row_.form = std::move(form);
    row_.precision = precision_name<Real>();
  }

  void add(Real value, Long truth, std::initializer_list<double> at) {
    ++row_.points;
    if (!std::isfinite(value)) {
      if (row_.not_finite++ == 0 && row_.worst_relative_error == 0) row_.worst_at = text(at);
      return;
    }
    const Long error = std::abs(static_cast<Long>(value) - truth);
    const double relative = static_cast<double>(error / std::max(std::abs(truth), kNothing<Real>));
    if (relative <= row_.worst_relative_error) return;
    row_.worst_relative_error = relative;
    row_.worst_at = text(at);
  }

  StabilityRow row() const { return row_; }

 private:
  static std::string text(std::initializer_list<double> at) {
    std::string result;
    for (const double x : at) {
      char number[32];
      std::snprintf(number, sizeof number, "%s%.9g", result.empty() ? "" : " ", x);
      result += number;
    }
    return result;
  }

  StabilityRow row_;
};

// sin x - x cos x in [0, pi].
Long true_lobe(Long x) {
  if (x > 1.0L) return std::sin(x) - x * std::cos(x);
  // sum (-1)^(n+1) 2n x^(2n+1) / (2n+1)!
  Long term = x * x * x / 6, sum = 0;
  for (int n = 1; n < 20; ++n) {
    sum += (n % 2 == 1 ? 1 : -1) * 2 * n * term;
    term *= x * x / (static_cast<Long>(2 * n + 2) * (2 * n + 3));
  }
  return sum;
}

Long true_decay(Long x) { return x == 0 ? 1 : -std::expm1(-x) / x; }

// J by its two parts, each over a span whose exponent runs from a to b.
Long true_bounce(Long d0, Long c, Long d) {
  const bool turns = c > 0 && d0 < c * d;
  const Long x1 = turns ? d0 / c : d, end = turns ? x1 : d0 + (1 - c) * d;
  const Long low = std::min(d0, end), high = std::max(d0, end);
  const Long before = std::exp(-low) * x1 * true_decay(high - low);
  return turns ? before + std::exp(-x1) * -std::expm1(-(d - x1)) : before;
}

// Angles from 0 to pi, crowded at both ends.
std::vector<double> angles() {
  std::vector<double> list = {0.0, 0.5 * std::numbers::pi, std::numbers::pi};
  for (int e = -100; e <= 0; e += e < -20 ? 20 : 1)
    for (const double m : {1.0, 2.3, 5.1}) list.push_back(m * std::pow(10.0, e) / 2);
  for (int i = 1; i < 100; ++i) list.push_back(i * std::numbers::pi / 100);
  for (int e = -12; e <= -1; ++e) list.push_back(std::numbers::pi - std::pow(10.0, e));
  return list;
}

std::vector<double> decades(int first, int last) {
  std::vector<double> list = {0.0};
  for (int e = first; e <= last; ++e)
    for (const double m : {1.0, 1.9, 3.0, 6.7}) list.push_back(m * std::pow(10.0, e));
  return list;
}

template <class Real>
void add_lobe(std::vector<StabilityRow>& rows) {
  Sweep<Real> ours("h(x) = sin x - x cos x"), printed("h(x), as printed");
  for (const double angle : angles()) {
    const Real x = static_cast<Real>(angle);
    ours.add(envelope::lobe_function(x), true_lobe(x), {angle});
    printed.add(std::sin(x) - x * std::cos(x), true_lobe(x), {angle});
  }
  rows.push_back(ours.row());
  rows.push_back(printed.row());
}

template <class Real>
void add_decay(std::vector<StabilityRow>& rows) {
  Sweep<Real> ours("phi(x) = (1 - exp(-x)) / x"), printed("phi(x), as printed");
  for (const double size : decades(-20, 9))
    for (const double sign : {1.0, -1.0}) {
      const Real x = static_cast<Real>(sign * size);
      if (x < Real(-60)) continue;  // grows as exp |x|: only ever used inside J
      ours.add(envelope::mean_decay(x), true_decay(x), {static_cast<double>(x)});
      printed.add((1 - std::exp(-x)) / x, true_decay(x), {static_cast<double>(x)});
    }
  rows.push_back(ours.row());
  rows.push_back(printed.row());
}

// Eq. 31 and 18; the supplement of the angle is given as exactly as the angle, as angle_between() gives it.
template <class Real>
void add_scattering(std::vector<StabilityRow>& rows) {
  Sweep<Real> through("Avt, Eq. 31"), through_printed("Avt, as printed");
  Sweep<Real> density("G1, Eq. 18"), density_printed("G1, as printed");
  constexpr Real pi = std::numbers::pi_v<Real>;
  const envelope::LeafSums<Real> leaf{Real(0), Real(0.5)};  // leaves that only let light through
  for (const double beta : angles()) {
    // Measured from pi: where transmission vanishes.
    const Real supplement = static_cast<Real>(beta);
    const AnglePair<Real> pair{static_cast<Real>(kLongPi - supplement), supplement};
    const Real a = pair.angle_rad;
    const Long truth = true_lobe(supplement) / (6 * kLongPi);
    through.add(envelope::mean_transmitting_cosines(pair), truth, {beta});
    through_printed.add(((pi - a) * std::cos(a) + std::sin(a)) / (6 * pi), truth, {beta});
    const Real per_m3 = 100;
    const Long true_density =
        2 * Long(per_m3) / (3 * kLongPi * 8) * Long(leaf.transmittance) * true_lobe(supplement);
    density.add(envelope::scattering_density(per_m3, 8, leaf, pair), true_density, {beta});
    const Real bracket =
        leaf.transmittance * (std::sin(a) - a * std::cos(a)) + pi * leaf.transmittance * std::cos(a);
    density_printed.add(2 * per_m3 / (3 * pi * 8) * bracket, true_density, {beta});
  }
  for (const auto& sweep : {through, through_printed, density, density_printed}) rows.push_back(sweep.row());
}

template <class Real>
void add_bounce(std::vector<StabilityRow>& rows) {
  Sweep<Real> ours("J(D0, c, D)"), printed("J, Eq. 20 with 22, as printed");
  for (const double start : decades(-9, 6))
    for (const double approach :
         {-3.0, -1.0, -0.5, -1e-9, 0.0, 1e-12, 1e-6, 0.5, 1 - 1e-12, 1.0, 1 + 1e-9, 2.5})
      for (const double depth : decades(-9, 6)) {
        const Real d0 = static_cast<Real>(start), c = static_cast<Real>(approach),
                   d = static_cast<Real>(depth);
        // Exponents beyond 60 leave less than 1e-26; their rounding alone is 60 half units.
        const Long truth = true_bounce(d0, c, d);
        if (truth < 1e-20L && d > 1) continue;
        ours.add(envelope::one_bounce_integral(d0, c, d), truth, {start, approach, depth});
        const Real decay = 1 - c;
        printed.add(std::exp(-d0) * (1 - std::exp(-decay * d)) / decay, truth, {start, approach, depth});
      }
  rows.push_back(ours.row());
  rows.push_back(printed.row());
}

// The kernel's error is measured against 1, the most J can be.
void add_bounce_kernel(std::vector<StabilityRow>& rows) {
  Sweep<float> sweep("J in vector lanes, error of 1");
  const std::vector<double> depths = decades(-9, 1);
  for (const double approach : {-3.0, -0.5, 0.0, 0.5, 1.0, 2.5})
    for (const double depth : depths)
      for (const double start : depths) {
        const std::vector<float> d0(envelope::kLaneCount, static_cast<float>(start)),
            c(envelope::kLaneCount, static_cast<float>(approach));
        std::vector<float> j(envelope::kLaneCount);
        envelope::bounce_row(d0, c, static_cast<float>(depth), j);
        const Long truth = true_bounce(d0[0], c[0], static_cast<float>(depth));
        sweep.add(static_cast<float>(1.0L + (static_cast<Long>(j[0]) - truth)), 1.0L,
                  {start, approach, depth});
      }
  rows.push_back(sweep.row());
}

template <class Real>
void add_angles(std::vector<StabilityRow>& rows) {
  using Direction = envelope::Direction<Real>;
  Sweep<Real> ours("angle between directions"), printed("angle, acos of the dot product");
  for (const double angle : angles()) {
    if (angle < 1e-30 && angle > 0) continue;  // sin is not 0, but its square underflows in float
    const Real a = static_cast<Real>(angle);
    const Direction z(0, 0, 1), w(std::sin(a), 0, std::cos(a));
    const Long truth = std::atan2(static_cast<Long>(w.x), static_cast<Long>(w.z));
    if (truth < 0 || (truth > 0 && truth < (sizeof(Real) == 4 ? 1e-18L : 1e-30L))) continue;
    ours.add(envelope::angle_between(z, w).angle_rad, truth, {angle});
    printed.add(std::acos(w.z), truth, {angle});
  }
  rows.push_back(ours.row());
  rows.push_back(printed.row());
}

template <class Real>
void add_all(std::vector<StabilityRow>& rows) {
  add_lobe<Real>(rows);
  add_decay<Real>(rows);
  add_scattering<Real>(rows);
  add_bounce<Real>(rows);
  add_angles<Real>(rows);
}

}  // namespace

std::vector<StabilityRow> envelope_form_stability() {
  std::vector<StabilityRow> rows;
  add_all<double>(rows);
  add_all<float>(rows);
  add_bounce_kernel(rows);
  return rows;
}

}  // namespace sunfleck
