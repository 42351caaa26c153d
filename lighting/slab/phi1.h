// phi1(y) = (1 - e^-y) / y, 1 at 0: the integral of e^(-y t) over t in [0, 1].
#pragma once

#include <cmath>

namespace sunfleck {

template <class Real>
Real phi1(Real y) {
  return y == Real(0) ? Real(1) : -std::expm1(-y) / y;
}

}  // namespace sunfleck
