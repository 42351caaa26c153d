// Dense matrices of some tens of rows, for slab_truth.cpp.
#pragma once

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace sunfleck {

struct SmallMatrix {
  std::size_t rows = 0, columns = 0;
  std::vector<double> values;

  SmallMatrix() = default;
  SmallMatrix(std::size_t r, std::size_t c) : rows(r), columns(c), values(r * c, 0.0) {}
  double& at(std::size_t r, std::size_t c) { return values[r * columns + c]; }
  double at(std::size_t r, std::size_t c) const { return values[r * columns + c]; }
};

inline SmallMatrix operator*(const SmallMatrix& a, const SmallMatrix& b) {
  SmallMatrix product(a.rows, b.columns);
  for (std::size_t i = 0; i < a.rows; ++i)
    for (std::size_t k = 0; k < a.columns; ++k)
      for (std::size_t j = 0; j < b.columns; ++j) product.at(i, j) += a.at(i, k) * b.at(k, j);
  return product;
}

inline SmallMatrix operator+(SmallMatrix a, const SmallMatrix& b) {
  for (std::size_t i = 0; i < a.values.size(); ++i) a.values[i] += b.values[i];
  return a;
}

// Each column times its own factor.
inline SmallMatrix scaled_columns(SmallMatrix a, const std::vector<double>& factors) {
  for (std::size_t i = 0; i < a.rows; ++i)
    for (std::size_t j = 0; j < a.columns; ++j) a.at(i, j) *= factors[j];
  return a;
}

// x of (1 - a) x = b, by elimination with the largest element of a column first; 1 - a must be regular.
inline SmallMatrix solve_one_minus(const SmallMatrix& a, SmallMatrix b) {
  SmallMatrix m(a.rows, a.columns);
  for (std::size_t i = 0; i < a.rows; ++i)
    for (std::size_t j = 0; j < a.columns; ++j) m.at(i, j) = (i == j ? 1.0 : 0.0) - a.at(i, j);
  const auto add_row = [](SmallMatrix& to, std::size_t target, std::size_t source, double factor) {
    for (std::size_t j = 0; j < to.columns; ++j) to.at(target, j) += factor * to.at(source, j);
  };
  for (std::size_t k = 0; k < m.rows; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < m.rows; ++i)
      if (std::abs(m.at(i, k)) > std::abs(m.at(pivot, k))) pivot = i;
    for (std::size_t j = 0; j < m.columns; ++j) std::swap(m.at(k, j), m.at(pivot, j));
    for (std::size_t j = 0; j < b.columns; ++j) std::swap(b.at(k, j), b.at(pivot, j));
    for (std::size_t i = k + 1; i < m.rows; ++i) {
      const double factor = -m.at(i, k) / m.at(k, k);
      add_row(m, i, k, factor);
      add_row(b, i, k, factor);
    }
  }
  for (std::size_t k = m.rows; k-- > 0;) {
    for (std::size_t j = 0; j < b.columns; ++j) b.at(k, j) /= m.at(k, k);
    for (std::size_t i = 0; i < k; ++i) add_row(b, i, k, -m.at(i, k));
  }
  return b;
}

}  // namespace sunfleck
