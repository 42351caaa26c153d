// Student's t by its distribution function: with A = P(|T| < t), nu degrees of freedom and theta =
// atan(t / sqrt(nu)), A is a finite series in cos(theta) (Abramowitz and Stegun 26.7.3 and 26.7.4); inverted
// by bisection.
#include <cmath>

#include "lighting/study/calibrate.h"
#include "sim/base/contract.h"
#include "sim/base/vec.h"

namespace sunfleck {
namespace {

double share_within(double t, int nu) {
  const double theta = std::atan(t / std::sqrt(nu)), c = std::cos(theta), s = std::sin(theta);
  double term = nu % 2 == 1 ? c : 1.0, sum = 0;
  for (int k = nu % 2 == 1 ? 1 : 0; k <= nu - 2; k += 2) {
    sum += term;
    term *= c * c * (k + 1.0) / (k + 2.0);
  }
  return nu % 2 == 1 ? 2.0 / kPi * (theta + s * sum) : s * sum;
}

}  // namespace

double student_t(double confidence, int degrees_of_freedom) {
  SUNFLECK_EXPECTS(confidence > 0 && confidence < 1 && degrees_of_freedom >= 1);
  double low = 0, high = 1;
  while (share_within(high, degrees_of_freedom) < confidence) high *= 2;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (share_within(middle, degrees_of_freedom) < confidence ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace sunfleck
