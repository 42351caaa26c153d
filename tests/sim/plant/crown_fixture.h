// A crooked crown and small species to fill it with.
#pragma once

#include "sim/plant/make_prototype.h"

namespace sunfleck::test {

inline CrownShape crooked_crown() {
  CrownShape crown;
  crown.height_m = 18;
  crown.base_m = 6;
  crown.widest_m = 9;
  crown.radius_nesw_m = {3.0, 2.0, 1.5, 4.0};
  crown.dbh_m = 0.28;
  return crown;
}

inline Species broadleaf(LeafAngles angles = LeafAngles::kSpherical) {
  Species species;
  species.latin = species.material.name = "Fagus fixture";
  species.foliage.leaf_length_m = 0.09;
  species.foliage.leaf_width_m = 0.06;
  species.foliage.angles = angles;
  return species;
}

inline Species conifer() {
  Species species;
  species.latin = species.material.name = "Picea fixture";
  species.foliage.kind = FoliageKind::kShoot;
  species.foliage.shoot_length_m = 0.1;
  species.foliage.shoot_radius_m = 0.02;
  species.foliage.needle_length_m = 0.02;
  species.foliage.needle_width_m = 0.001;
  species.foliage.needles_per_m = 2000;
  return species;
}

}  // namespace sunfleck::test
