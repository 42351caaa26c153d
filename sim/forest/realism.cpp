#include "sim/forest/realism.h"

namespace sunfleck {

void apply(Realism realism, ForestSpec& spec) {
  if (realism == Realism::kPlain) return;
  spec.trees = TreeSource::kCrown;
  spec.leaf_area = LeafAreaSource::kAllometry;
  spec.element_area_m2 = 0.06;
  spec.clumps.radius_m = 0.5;
  spec.clumps.leaf_area_m2 = 0.6;
  spec.rim_power = 1;
  spec.height_power = 1;
  spec.branch_share = 0.1;
  spec.understorey.add = true;
}

}  // namespace sunfleck
