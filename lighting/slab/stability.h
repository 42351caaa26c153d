// Numerical stability of the closed forms of this folder, measured: each over a grid of arguments from one
// end of their range to the other, against the same integral in long double, with the form as printed in
// [SPP] beside it (signs mended, growing exponentials and differences kept). Under a second.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace sunfleck {

struct SlabStabilityRow {
  std::string form;  // "spp", "spp_h", "compensation", "refined"
  std::string
      precision;  // "double", "float", "float rows": the vector code; "printed double", "printed float"
  bool printed = false;  // the naive twin, for comparison
  std::size_t points = 0;
  std::size_t not_finite = 0;
  // Of all finite answers; of compensation the absolute error, else relative to the truth where that is above
  // 1e-30. In slabs thinner than 0.01 relative to at least a tenth of their thickness: where single
  // scattering has nothing to give (all of it turns back), the little that is left has fewer digits. Of the
  // float rows of spp relative to at least 8e-3 of min(1, depth before).
  double worst_error = 0;
  std::size_t over_one_in_1000 = 0;  // answers off by more than 1e-3, or not finite
  double allowed_error = 0;          // what the headers promise; 0 for printed forms
  std::string where;                 // arguments of the worst answer

  bool holds() const { return printed || (not_finite == 0 && worst_error <= allowed_error); }
};

std::vector<SlabStabilityRow> slab_form_stability();

}  // namespace sunfleck
