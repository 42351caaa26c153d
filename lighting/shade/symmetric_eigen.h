// Eigenvectors of small symmetric matrices.
#pragma once

#include <array>
#include <cmath>

#include "sim/base/vec.h"

namespace sunfleck {

// Symmetric 3 x 3 by its upper triangle.
struct Symmetric3 {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
  void add(const Vec3& v, double weight) {
    xx += weight * v.x * v.x, yy += weight * v.y * v.y, zz += weight * v.z * v.z;
    xy += weight * v.x * v.y, xz += weight * v.x * v.z, yz += weight * v.y * v.z;
  }
};

// Unit vector of the smallest eigenvalue, by Jacobi rotations.
inline Vec3 least_axis(const Symmetric3& m) {
  std::array<std::array<double, 3>, 3> a{{{m.xx, m.xy, m.xz}, {m.xy, m.yy, m.yz}, {m.xz, m.yz, m.zz}}};
  std::array<Vec3, 3> axis{Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
  for (int sweep = 0; sweep < 12; ++sweep)
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) {
        if (a[p][q] == 0) continue;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (int k = 0; k < 3; ++k) {
          const double kp = a[k][p], kq = a[k][q];
          a[k][p] = c * kp - s * kq, a[k][q] = s * kp + c * kq;
        }
        for (int k = 0; k < 3; ++k) {
          const double pk = a[p][k], qk = a[q][k];
          a[p][k] = c * pk - s * qk, a[q][k] = s * pk + c * qk;
        }
        const Vec3 vp = axis[p], vq = axis[q];
        axis[p] = c * vp - s * vq, axis[q] = s * vp + c * vq;
      }
  int least = 0;
  for (int k = 1; k < 3; ++k)
    if (a[k][k] < a[least][least]) least = k;
  return glm::normalize(axis[least]);
}

}  // namespace sunfleck
