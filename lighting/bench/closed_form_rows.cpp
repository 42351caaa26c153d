// See stability.h: the slab methods' own report in the shape of this one.
#include "lighting/bench/stability.h"
#include "lighting/slab/stability.h"

namespace sunfleck {

std::vector<StabilityRow> slab_form_rows() {
  std::vector<StabilityRow> rows;
  for (const SlabStabilityRow& row : slab_form_stability())
    rows.push_back({.form = row.printed ? row.form + ", as printed" : row.form,
                    .precision = row.precision,
                    .points = row.points,
                    .not_finite = row.not_finite,
                    .worst_relative_error = row.worst_error,
                    .worst_at = row.where});
  return rows;
}

std::vector<StabilityRow> closed_form_rows() {
  std::vector<StabilityRow> rows = envelope_form_stability();
  for (StabilityRow& row : slab_form_rows()) rows.push_back(std::move(row));
  return rows;
}

}  // namespace sunfleck
