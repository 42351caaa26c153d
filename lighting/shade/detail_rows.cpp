#include "lighting/shade/detail_rows.h"

namespace sunfleck {

std::vector<MeasuredDetail> measured_detail() {
  using enum Detail;
  // NIR, path-traced, all bounces; beech, birch, spruce of 30 cm and a ball of 100,000 leaves.
  return {{kExplicit, 2.5, 0, 432},    {kExplicit, 40, 0, 430},     {kPruned4, 2.5, .0602, 300},
          {kPruned4, 5, .0213, 290},   {kPruned4, 10, .0151, 300},  {kPruned16, 5, .0598, 250},
          {kPruned16, 10, .0346, 250}, {kPruned16, 20, .0136, 260}, {kPruned16, 40, .0114, 260},
          {kPruned64, 10, .0667, 220}, {kPruned64, 20, .0324, 225}, {kPruned64, 40, .0204, 225}};
}

}  // namespace sunfleck
