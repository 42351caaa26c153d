#include "lighting/render/film.h"

#include <cmath>

namespace sunfleck {
namespace {

double grey(const Vec3& v) { return (v.x + v.y + v.z) / 3.0; }

}  // namespace

// Never a difference of large sums.
void Film::add(std::size_t pixel, const Vec3& value) {
  const double n = ++units_[pixel];
  const double step = grey(value) - grey(mean_[pixel]);
  mean_[pixel] += (value - mean_[pixel]) / n;
  squares_[pixel] += step * (grey(value) - grey(mean_[pixel]));
}

double Film::standard_error(std::size_t pixel) const {
  const double n = units_[pixel];
  return n > 1.0 ? std::sqrt(std::fmax(0.0, squares_[pixel]) / (n - 1.0) / n) : 0.0;
}

}  // namespace sunfleck
