// A crown shape filled with foliage of a species.
//
// Element centres are even over the crown's volume outside the stem, or denser towards its rim, or in clumps,
// normals follow the species' leaf angles, all elements have the same area. A shoot's axis lies in the plane
// of a leaf normal drawn so: spherical normals give axes that point everywhere alike, planophile ones nearly
// level axes. Leaves may overhang the crown's surface by their own size, but not reach below the ground at
// the stem foot.
#include <cmath>

#include "sim/base/error.h"
#include "sim/plant/crown_branches.h"
#include "sim/plant/crown_shape.h"
#include "sim/plant/crown_stem.h"
#include "sim/plant/leaf_angle_sampling.h"
#include "sim/plant/make_prototype.h"
#include "sim/plant/template_element.h"

namespace sunfleck {
namespace {

constexpr int kMostElements = 50'000'000;
constexpr int kMostTries = 64;  // to find a place outside stem and ground; then the last one is taken

bool stands_free(const CrownShape& crown, const FoliageElement& element) {
  const Vec3 c(element.centre_m);
  return std::hypot(c.x, c.y) >= stem_radius_m(crown, c.z) && element_bounds(element).lo.z >= 0.0;
}

// Centres of elements: even in the crown, or in clumps that are.
class CentreSampler {
 public:
  CentreSampler(const CrownShape& crown, const CrownFill& fill)
      : crown_(crown, fill.rim_power, fill.height_power), fill_(fill) {}
  Vec3 sample(std::size_t element, double share, RandomStream& random) const {
    if (fill_.clump_radius_m <= 0.0) return crown_.sample(share, random);
    const std::size_t clump = element / static_cast<std::size_t>(fill_.clump_elements);
    const double clumps = std::ceil(static_cast<double>(fill_.elements) / fill_.clump_elements);
    RandomStream of_clump(fill_.seed, clump, RandomPurpose::kClumps);
    const double clump_share = (static_cast<double>(clump) + of_clump.uniform()) / clumps;
    return crown_.sample(clump_share, of_clump) + fill_.clump_radius_m * random_in_ball(random);
  }

 private:
  static Vec3 random_in_ball(RandomStream& random) {
    const double z = random.uniform(-1, 1), turn = random.uniform(0, 2 * kPi), s = std::sqrt(1 - z * z);
    return std::cbrt(random.uniform()) * Vec3(s * std::cos(turn), s * std::sin(turn), z);
  }
  const CrownSampler crown_;
  const CrownFill& fill_;
};

FoliageElement place_element(const Species& species, const CrownShape& crown, const CentreSampler& sampler,
                             std::size_t number, double area_m2, double share, RandomStream& random) {
  FoliageElement element;
  for (int i = 0; i < kMostTries; ++i) {
    const Vec3 centre_m = sampler.sample(number, share, random);
    const Vec3 normal = sample_leaf_normal(species.foliage.angles, random);
    element = template_element(species.foliage, area_m2, centre_m, normal, random.uniform(0.0, 2.0 * kPi));
    if (stands_free(crown, element)) break;
  }
  return element;
}

void require_possible(const CrownFill& fill, const std::string& where) {
  if (!(fill.leaf_area_m2 > 0.0 && fill.leaf_area_m2 <= 1e6))
    throw_invalid(where + ": leaf area", "is no leaf area", "give square metres above 0");
  if (fill.elements < 1 || fill.elements > kMostElements)
    throw_invalid(where + ": elements", std::to_string(fill.elements) + " foliage elements are not possible",
                  "give a number from 1 to " + std::to_string(kMostElements));
  if (!(fill.clump_radius_m >= 0.0 && fill.clump_radius_m <= 100.0) || fill.clump_elements < 1)
    throw_invalid(where + ": clumps", "are not possible", "a radius from 0 to 100 m and 1 element or more");
  if (!(fill.rim_power >= 0.0 && fill.rim_power <= 20.0))
    throw_invalid(where + ": rim power", "is out of range", "0 (even) to 20 (all at the surface)");
  if (!(fill.height_power >= 0.0 && fill.height_power <= 20.0))
    throw_invalid(where + ": height power", "is out of range", "0 (even) to 20 (all at the top)");
  if (!(fill.branch_share >= 0.0 && fill.branch_share <= 10.0))
    throw_invalid(where + ": branches", "are not possible", "0 to 10 m2 of branches per m2 of leaves");
}

}  // namespace

Prototype crown_prototype(const Species& species, const CrownShape& crown, const CrownFill& fill) {
  validate(crown, species.latin);
  require_possible(fill, species.latin);
  Prototype prototype;
  prototype.name = species.latin;
  prototype.materials = {species.material.name};
  prototype.stated_dbh_m = crown.dbh_m;
  prototype.wood = crown_stem(crown);
  for (const WoodSegment& branch : crown_branches(crown, fill)) prototype.wood.push_back(branch);

  const CentreSampler sampler(crown, fill);
  const auto count = static_cast<std::size_t>(fill.elements);
  const double each_m2 = static_cast<float>(fill.leaf_area_m2 / fill.elements);
  double left_m2 = fill.leaf_area_m2;
  prototype.foliage.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    RandomStream random(fill.seed, i, RandomPurpose::kCrownFill);
    const double share = (static_cast<double>(i) + random.uniform()) / fill.elements;
    const double area_m2 = i + 1 < count ? each_m2 : left_m2;
    prototype.foliage.push_back(place_element(species, crown, sampler, i, area_m2, share, random));
    left_m2 -= each_m2;
  }
  return prototype;
}

}  // namespace sunfleck
