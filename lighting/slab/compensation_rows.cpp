// [SPP] Eq. 27 row by row; see compensation_rows.h.
#include "lighting/slab/compensation_rows.h"

#include <algorithm>

#include "lighting/slab/slab_rows.h"

namespace sunfleck {

void compensation_rows(const CellDepths& cells, const Vec3& to_light, std::span<const float> before,
                       std::span<const float> behind, std::size_t begin, std::size_t end,
                       std::span<float> result) {
  const SampleDirections& d = cells.directions;
  const std::size_t count = end - begin;
  const std::span<float> sum = result.subspan(begin, count);
  std::fill(sum.begin(), sum.end(), 0.0f);
  for (std::size_t j = 0; j < d.directions(); ++j)
    add_shortfall_row(before.subspan(begin, count), behind.subspan(begin, count),
                      cells.depths(j).subspan(begin, count),
                      std::clamp(glm::dot(d.direction(j), to_light), -1.0, 1.0), sum);
  const float per_direction = 1.0f / static_cast<float>(d.directions());
  for (float& g : sum) g = std::clamp(1.0f - g * per_direction, 0.0f, 1.0f);
}

}  // namespace sunfleck
