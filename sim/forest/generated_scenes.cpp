#include "sim/forest/generated_scenes.h"

#include <cmath>

#include "sim/base/contract.h"
#include "sim/base/random.h"
#include "sim/plant/leaf_angle_sampling.h"

namespace sunfleck {
namespace {

Vec3 random_direction(RandomStream& random) {
  const double z = random.uniform(-1, 1), turn = random.uniform(0, 2 * kPi);
  const double s = std::sqrt(1 - z * z);
  return {s * std::cos(turn), s * std::sin(turn), z};
}

Vec3 random_in_ball(RandomStream& random) { return std::cbrt(random.uniform()) * random_direction(random); }

// A point of the unit crown: centre 0, radius 1.
Vec3 random_in_crown(CrownKind kind, RandomStream& random) {
  switch (kind) {
    case CrownKind::kSphere:
      return random_in_ball(random);
    case CrownKind::kShell: {
      const double inner = 0.343;  // 0.7^3
      return std::cbrt(inner + (1 - inner) * random.uniform()) * random_direction(random);
    }
    case CrownKind::kCone: {
      const double down = std::cbrt(random.uniform());  // from the tip; cross-section grows as down^2
      const double radius = down * std::sqrt(random.uniform()), turn = random.uniform(0, 2 * kPi);
      return {radius * std::cos(turn), radius * std::sin(turn), 1 - 2 * down};
    }
    case CrownKind::kEllipsoid:
      return random_in_ball(random) * Vec3(1, 1, 2);
    case CrownKind::kClumped:
      break;
  }
  return random_in_ball(random);
}

FoliageElement square_leaf(const Vec3& centre, const Vec3& normal, double turn_rad, double side_m) {
  const Basis basis = basis_around(normal);
  const Vec3 u = std::cos(turn_rad) * basis.tangent + std::sin(turn_rad) * basis.bitangent;
  FoliageElement e;
  e.centre_m = centre;
  e.half_u_m = 0.5 * side_m * u;
  e.half_v_m = 0.5 * side_m * glm::cross(normal, u);
  e.area_m2 = static_cast<float>(side_m * side_m);
  return e;
}

// A clump's centre, then a point around it: the clump is drawn first, so that its leaves share it.
Vec3 clumped_point(std::uint64_t seed, RandomStream& random) {
  constexpr std::uint32_t kClumps = 120;
  constexpr double kClumpRadius = 0.12;
  RandomStream clump(seed, (std::uint64_t{1} << 40) + random.below(kClumps), RandomPurpose::kTestScene);
  return (1 - kClumpRadius) * random_in_ball(clump) + kClumpRadius * random_in_ball(random);
}

Forest forest_of(Prototype prototype, std::string name) {
  prototype.name = name;
  prototype.materials = {"leaf"};
  Forest forest;
  forest.name = std::move(name);
  forest.materials = {
      {"leaf", {{"VIS", 0.25, 0.25, 0.1}, {"PAR", 0.10, 0.05, 0.1}, {"NIR", 0.45, 0.45, 0.3}}}};
  forest.prototypes.push_back(std::move(prototype));
  forest.instances.push_back({});
  return forest;
}

}  // namespace

Forest generated_crown(const GeneratedCrown& crown) {
  SUNFLECK_EXPECTS(crown.leaves > 0 && crown.radius_m > 0 && crown.crown_lai > 0);
  const double side_m = std::sqrt(crown.crown_lai * kPi * crown.radius_m * crown.radius_m / crown.leaves);
  const Vec3 centre(0, 0, (crown.kind == CrownKind::kEllipsoid ? 2.5 : 1.5) * crown.radius_m);
  Prototype prototype;
  for (int i = 0; i < crown.leaves; ++i) {
    RandomStream random(crown.seed, static_cast<std::uint64_t>(i), RandomPurpose::kTestScene);
    const Vec3 point = crown.kind == CrownKind::kClumped ? clumped_point(crown.seed, random)
                                                         : random_in_crown(crown.kind, random);
    const Vec3 normal = crown.angles == LeafAngles::kSpherical ? random_direction(random)
                                                               : sample_leaf_normal(crown.angles, random);
    prototype.foliage.push_back(
        square_leaf(centre + crown.radius_m * point, normal, random.uniform(0, 2 * kPi), side_m));
  }
  constexpr const char* kNames[] = {"sphere", "clumped", "cone", "shell", "ellipsoid"};
  return forest_of(std::move(prototype), kNames[static_cast<int>(crown.kind)]);
}

Forest generated_layer(const GeneratedLayer& layer) {
  SUNFLECK_EXPECTS(layer.leaves > 0 && layer.cell_m > 0 && layer.height_m > 0 && layer.lai > 0);
  const double side_m = layer.cell_m * std::sqrt(layer.lai / layer.leaves);
  Prototype prototype;
  for (int i = 0; i < layer.leaves; ++i) {
    RandomStream random(layer.seed, static_cast<std::uint64_t>(i), RandomPurpose::kTestScene);
    const Vec3 centre(random.uniform(0, layer.cell_m), random.uniform(0, layer.cell_m),
                      side_m + random.uniform(0, layer.height_m));
    const Vec3 normal = random_direction(random);
    prototype.foliage.push_back(square_leaf(centre, normal, random.uniform(0, 2 * kPi), side_m));
  }
  Forest forest = forest_of(std::move(prototype), "layer");
  forest.period = Period{{0, 0}, {layer.cell_m, layer.cell_m}};
  return forest;
}

}  // namespace sunfleck
