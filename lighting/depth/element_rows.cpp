// See element_rows.h.
#include "lighting/depth/element_rows.h"

#include <algorithm>

#include "lighting/depth/opacity_frame.h"
#include "lighting/depth/opacity_pieces.h"

namespace sunfleck {

ElementRows element_rows(const Prototype& prototype) {
  ElementRows rows;
  const std::size_t count = prototype.foliage.size();
  for (std::vector<float>* v : {&rows.u_x, &rows.u_y, &rows.u_z, &rows.v_x, &rows.v_y, &rows.v_z,
                                &rows.radius_m, &rows.x_m, &rows.y_m, &rows.z_m, &rows.normal_x,
                                &rows.normal_y, &rows.normal_z, &rows.needles_m2, &rows.longest_m})
    v->resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const FoliageElement& e = prototype.foliage[i];
    const bool needles = e.shape == ElementShape::kShoot;
    const Vec3 u(e.half_u_m), v(e.half_v_m), across = glm::cross(u, v);
    const double length = glm::length(across);
    const Vec3 normal = needles || !(length > 0.0) ? Vec3(0.0) : across * (e.area_m2 / length);
    rows.x_m[i] = e.centre_m.x;
    rows.u_x[i] = e.half_u_m.x;
    rows.u_y[i] = e.half_u_m.y;
    rows.u_z[i] = e.half_u_m.z;
    rows.v_x[i] = needles ? 0.0f : e.half_v_m.x;
    rows.v_y[i] = needles ? 0.0f : e.half_v_m.y;
    rows.v_z[i] = needles ? 0.0f : e.half_v_m.z;
    rows.radius_m[i] = needles ? static_cast<float>(glm::length(v)) : 0.0f;
    rows.y_m[i] = e.centre_m.y;
    rows.z_m[i] = e.centre_m.z;
    rows.normal_x[i] = static_cast<float>(normal.x);
    rows.normal_y[i] = static_cast<float>(normal.y);
    rows.normal_z[i] = static_cast<float>(normal.z);
    rows.needles_m2[i] = needles ? static_cast<float>(kRandomLeafProjection) * e.area_m2 : 0.0f;
    const double stretch = e.shape == ElementShape::kTriangle ? 0.5 : 1.0;
    rows.longest_m[i] = static_cast<float>(
        2.0 * stretch * (needles ? glm::length(u) : std::max(glm::length(u), glm::length(v))));
  }
  rows.typical_side_m = typical_leaf_side_m(prototype);
  return rows;
}

}  // namespace sunfleck
