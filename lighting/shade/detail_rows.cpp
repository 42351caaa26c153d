#include "lighting/shade/detail_rows.h"

namespace sunfleck {

std::vector<MeasuredDetail> measured_detail() {
  using enum Detail;
  // NIR, path-traced, all bounces; beech, birch, spruce of 30 cm and a ball of 100,000 leaves.
  return {{kExplicit, 2.5, 0, 432},    {kExplicit, 10, 0, 422},     {kExplicit, 40, 0, 418},
          {kPruned4, 2.5, .0602, 301}, {kPruned4, 5, .0213, 282},   {kPruned4, 10, .0151, 292},
          {kPruned4, 20, .0067, 288},  {kPruned16, 5, .0598, 241},  {kPruned16, 10, .0346, 242},
          {kPruned16, 20, .0136, 250}, {kPruned16, 40, .0114, 249}, {kPruned64, 10, .0667, 217},
          {kPruned64, 20, .0369, 220}, {kPruned64, 40, .0206, 222}};
}

}  // namespace sunfleck
