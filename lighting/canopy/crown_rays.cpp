// See crown_rays.h.
#include "lighting/canopy/crown_rays.h"

#include <cmath>
#include <limits>

#include "lighting/trace/surface_sampler.h"
#include "sim/base/contract.h"

namespace sunfleck {

namespace {

// Steps of the two-dimensional golden lattice: 1/p and 1/p^2, p = 1.3247... the plastic number. Roberts 2018,
// "The unreasonable effectiveness of quasirandom sequences".
constexpr double kStepX = 0.7548776662466927, kStepY = 0.5698402909980532;

Forest single_tree(const Forest& forest, std::size_t prototype) {
  Forest alone;
  alone.materials = forest.materials;
  alone.prototypes = {forest.prototypes[prototype]};
  alone.instances.resize(1);
  return alone;
}

// The box in a frame whose third axis points to the light.
Box seen_from(const Box& box, const Basis& across, const Vec3& to_source) {
  Box seen;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p((corner & 1) ? box.hi.x : box.lo.x, (corner & 2) ? box.hi.y : box.lo.y,
                 (corner & 4) ? box.hi.z : box.lo.z);
    seen.include({glm::dot(p, across.tangent), glm::dot(p, across.bitangent), glm::dot(p, to_source)});
  }
  return seen;
}

}  // namespace

CrownAlone::CrownAlone(const Forest& forest, std::size_t prototype, const RunControl& control)
    : forest_(single_tree(forest, prototype)),
      box_(forest_bounds(forest_)),
      rays_(forest_, {.ground = false}, control) {}

CrownAlone::Interception CrownAlone::intercept(const Vec3& to_source, double half_angle_rad, int rays,
                                               RandomStream& random) const {
  SUNFLECK_EXPECTS(rays >= 1);
  if (box_.empty()) return {};
  double m2 = 0.0, quantum_m2 = 0.0;
  Vec3 towards = to_source;
  Basis across = basis_around(towards);
  Box seen = seen_from(box_, across, towards);
  const double x0 = random.uniform(), y0 = random.uniform();
  for (int i = 0; i < rays; ++i) {
    if (half_angle_rad > 0.0) {
      towards = trace::cone_direction(to_source, half_angle_rad, random);
      across = basis_around(towards);
      seen = seen_from(box_, across, towards);
    }
    const double x = std::fmod(x0 + i * kStepX, 1.0), y = std::fmod(y0 + i * kStepY, 1.0);
    const Vec3 size = seen.size();
    const double start = seen.hi.z + 0.01 * size.z + 1e-3;
    const Vec3 origin = (seen.lo.x + x * size.x) * across.tangent +
                        (seen.lo.y + y * size.y) * across.bitangent + start * towards;
    quantum_m2 = size.x * size.y / rays;
    if (rays_.occluded(origin, -towards)) m2 += quantum_m2;
  }
  return {m2, quantum_m2};
}

}  // namespace sunfleck
