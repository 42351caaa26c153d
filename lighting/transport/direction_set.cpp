// See direction_set.h.
#include "lighting/transport/direction_set.h"

#include <cmath>

#include "sim/base/contract.h"

namespace sunfleck::transport {

namespace {

// Adds the opposites of the directions there are.
void complete(DirectionSet& set) {
  const std::size_t half = set.to_source.size();
  for (std::size_t j = 0; j < half; ++j) {
    set.to_source.push_back(-set.to_source[j]);
    set.solid_angle_sr.push_back(set.solid_angle_sr[j]);
  }
}

bool in_upper_half(const Vec3& w) { return w.z > 0 || (w.z == 0 && (w.y > 0 || (w.y == 0 && w.x > 0))); }

// A ring of `count` directions at `cosine` from the pole that shares `weight` of the hemisphere.
void add_ring(DirectionSet& set, const Vec3& pole, double cosine, double weight, int count) {
  const Basis basis = basis_around(pole);
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  for (int i = 0; i < count; ++i) {
    const double turn = 2.0 * kPi * (i + 0.5) / count;
    set.to_source.push_back(glm::normalize(sine * std::cos(turn) * basis.tangent +
                                           sine * std::sin(turn) * basis.bitangent + cosine * pole));
    set.solid_angle_sr.push_back(2.0 * kPi * weight / count);
  }
}

}  // namespace

DirectionSet cubic_directions(int count) {
  SUNFLECK_EXPECTS(count == 8 || count == 14 || count == 26);
  // Shares of the sphere by the number of components that are not zero: faces, edges, corners.
  const double share[4] = {0.0,
                           count == 26   ? 1.0 / 21
                           : count == 14 ? 1.0 / 15
                                         : 0.0,
                           count == 26 ? 4.0 / 105 : 0.0,
                           count == 26   ? 9.0 / 280
                           : count == 14 ? 3.0 / 40
                                         : 1.0 / 8};
  DirectionSet set;
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        const Vec3 w(x, y, z);
        const int components = std::abs(x) + std::abs(y) + std::abs(z);
        if (share[components] == 0.0 || !in_upper_half(w)) continue;
        set.to_source.push_back(w / std::sqrt(static_cast<double>(components)));
        set.solid_angle_sr.push_back(4.0 * kPi * share[components]);
      }
    }
  }
  complete(set);
  SUNFLECK_ENSURES(set.count() == static_cast<std::size_t>(count));
  return set;
}

DirectionSet layered_directions(int count, const Vec3& pole) {
  SUNFLECK_EXPECTS(count == 8 || count == 14 || count == 26);
  DirectionSet set;
  if (count == 8) {
    add_ring(set, pole, 0.5, 1.0, 4);
  } else if (count == 14) {
    const double node = std::sqrt(1.0 / 3);  // Gauss, two nodes
    add_ring(set, pole, 0.5 * (1 + node), 0.5, 4);
    add_ring(set, pole, 0.5 * (1 - node), 0.5, 4);
  } else {
    const double root = std::sqrt(6.0);  // Radau, three nodes with the pole
    set.to_source.push_back(pole);
    set.solid_angle_sr.push_back(2.0 * kPi / 9.0);
    add_ring(set, pole, (4 + root) / 10, (16 + root) / 36, 4);
    add_ring(set, pole, (4 - root) / 10, (16 - root) / 36, 8);
  }
  complete(set);
  return set;
}

}  // namespace sunfleck::transport
