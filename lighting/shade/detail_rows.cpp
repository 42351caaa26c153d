#include "lighting/shade/detail_rows.h"

namespace sunfleck {

std::vector<MeasuredDetail> measured_detail() {
  using enum Detail;
  // NIR, path-traced, all bounces; beech and birch of 30 cm and a ball of 100,000 leaves.
  return {{kExplicit, 2.5, 0, 485},    {kExplicit, 10, 0, 470},     {kExplicit, 40, 0, 462},
          {kPruned4, 2.5, .0602, 315}, {kPruned4, 5, .0340, 291},   {kPruned4, 10, .0138, 304},
          {kPruned4, 20, .0067, 298},  {kPruned16, 5, .0634, 243},  {kPruned16, 10, .0346, 244},
          {kPruned16, 20, .0136, 253}, {kPruned16, 40, .0114, 252}, {kPruned64, 10, .0667, 213},
          {kPruned64, 20, .0369, 213}, {kPruned64, 40, .0206, 220}};
}

}  // namespace sunfleck
