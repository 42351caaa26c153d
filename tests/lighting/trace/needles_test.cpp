// Shoots drawn needle by needle: rays against the closed form of every needle, area, what the random cloud of
// needles makes of the same shoot and tree, memory.
#include "sim/plant/needles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "lighting/trace/directions.h"
#include "lighting/trace/ray_scene.h"
#include "lighting/trace/solids.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"
#include "sim/plant/make_prototype.h"
#include "tests/lighting/trace/scenes.h"
#include "tests/sim/plant/refusal.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

Species species_of(const std::string& file) {
  return load_species(test::source_dir() / "configs/species" / (file + ".toml"));
}

const char* const kConifers[] = {"picea_abies", "abies_alba", "pinus_sylvestris", "larix_decidua"};

// One shoot of the species, its middle in the origin, along x.
Forest one_shoot(const FoliageTemplate& f) {
  return test::forest_of(
      {test::shoot(Vec3(0), {0.5 * f.shoot_length_m, 0, 0}, f.shoot_radius_m, f.shoot_area_m2())});
}

RayScene::Options needles_of(const FoliageTemplate& foliage, ShootForm form = ShootForm::kNeedles) {
  return {.ground = false, .shoots = form, .needles = {{"m0", foliage}}};
}

Vec3 any_direction(RandomStream& random) {
  const double z = random.uniform(-1, 1), turn = random.uniform(0, 2 * kPi), r = std::sqrt(1 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

struct Line {
  Vec3 origin_m, direction;
};
// Lines that meet the ball of this radius evenly.
Line any_line(RandomStream& random, double radius_m) {
  const Vec3 d = any_direction(random);
  const Basis basis = basis_around(d);
  const double r = radius_m * std::sqrt(random.uniform()), turn = random.uniform(0, 2 * kPi);
  const Vec3 across = r * (std::cos(turn) * basis.tangent + std::sin(turn) * basis.bitangent);
  return {across - 2.0 * radius_m * d, d};
}

double reach_of(const FoliageTemplate& f) {
  return 1.01 * std::hypot(0.5 * f.shoot_length_m, f.shoot_radius_m);
}

struct ClosedHit {
  double distance_m = INFINITY;
  std::uint32_t needle = RayHit::kNoNeedle;
  Vec3 normal{0};
};
// Where the line enters a ball.
std::optional<double> enter_ball(const Vec3& centre, double radius, const Line& line) {
  const Vec3 o = line.origin_m - centre;
  const double b = glm::dot(o, line.direction), c = glm::dot(o, o) - radius * radius;
  return b * b > c ? std::optional(-b - std::sqrt(b * b - c)) : std::nullopt;
}

// The nearest of all needles, cylinders with half balls as ends.
ClosedHit nearest_needle(const std::vector<Needle>& needles, const Line& line) {
  ClosedHit best;
  for (std::uint32_t i = 0; i < needles.size(); ++i) {
    const Vec3 base(needles[i].base_m), tip(needles[i].tip_m);
    const double r = needles[i].radius_m;
    const Vec3 along = glm::normalize(tip - base), a = base + r * along, b = tip - r * along;
    const auto side =
        trace::intersect(trace::cone_between(a, b, r, r), line.origin_m, line.direction, 0, best.distance_m);
    if (side && side->from_outside) best = {side->t, i, side->outward_normal};
    for (const Vec3& end : {a, b})
      if (const auto t = enter_ball(end, r, line); t && *t < best.distance_m)
        best = {*t, i, glm::normalize(line.origin_m + *t * line.direction - end)};
  }
  return best;
}

// Distances within a tenth of a needle's radius: Embree solves in single precision. Rays that graze a needle
// (one in some hundred) may miss it.
TEST(NeedleRays, MeetTheNeedleOfTheClosedForm) {
  const FoliageTemplate foliage = species_of("picea_abies").foliage;
  const Forest forest = one_shoot(foliage);
  const RayScene rays(forest, needles_of(foliage));
  std::vector<Needle> needles;
  expand_needles(forest.prototypes[0].foliage[0], foliage, 1, 0, needles);
  RandomStream random(5, 0, RandomPurpose::kTestScene);
  int met = 0, unlike = 0;
  for (int i = 0; i < 4000; ++i) {
    const Line line = any_line(random, reach_of(foliage));
    const ClosedHit known = nearest_needle(needles, line);
    const RayHit hit = rays.closest_hit(line.origin_m, line.direction);
    EXPECT_EQ(rays.occluded(line.origin_m, line.direction), hit.kind != HitKind::kSky);
    if (hit.kind == HitKind::kSky && known.needle == RayHit::kNoNeedle) continue;
    ++met;
    if (hit.needle != known.needle ||
        std::abs(hit.distance_m - known.distance_m) > 0.1 * needles[0].radius_m) {
      ++unlike;
      continue;
    }
    EXPECT_EQ(hit.kind, HitKind::kFoliage);
    EXPECT_EQ(hit.local, 0u);
    EXPECT_GT(glm::dot(hit.normal, known.normal), 0.98) << i;
    EXPECT_LE(glm::dot(hit.normal, line.direction), 0.0);
  }
  EXPECT_GT(met, 500);
  EXPECT_LE(unlike, 0.01 * met);
}

// Lines that meet a ball of radius R evenly enter convex bodies of surface S, S / (4 pi R^2) times on average
// (Cauchy): needles keep the shoot's area, half of which is S. 200,000 lines, three standard errors of about
// 0.4 %.
TEST(NeedleRays, KeepTheArea) {
  for (const char* file : kConifers) {
    const FoliageTemplate foliage = species_of(file).foliage;
    const Forest forest = one_shoot(foliage);
    const RayScene rays(forest, needles_of(foliage));
    RandomStream random(6, 0, RandomPurpose::kTestScene);
    const double radius = reach_of(foliage);
    double entries = 0, squares = 0;
    constexpr int kLines = 100000;
    for (int i = 0; i < kLines; ++i) {
      const Line line = any_line(random, radius);
      RayHit hit = rays.closest_hit(line.origin_m, line.direction);
      int here = 0;
      for (; hit.kind != HitKind::kSky && here < 100; ++here)
        hit = rays.closest_hit(hit.on_original_m, line.direction, 1e-7, start_from(hit, false));
      entries += here;
      squares += here * here;
    }
    const double mean = entries / kLines, se = std::sqrt((squares / kLines - mean * mean) / kLines);
    const double known = 2 * foliage.shoot_area_m2() / (4 * kPi * radius * radius);
    EXPECT_NEAR(mean, known, 3 * se + 0.002 * known) << file;
  }
}

struct Opacities {
  double volume = 0, needles = 0, se = 0;
};
Opacities opacities(const FoliageTemplate& foliage, int lines) {
  const Forest forest = one_shoot(foliage);
  const RayScene cloud(forest, {.ground = false}), each(forest, needles_of(foliage));
  RandomStream random(7, 0, RandomPurpose::kTestScene);
  Opacities o;
  for (int i = 0; i < lines; ++i) {
    const Line line = any_line(random, reach_of(foliage));
    o.volume += cloud.occluded(line.origin_m, line.direction);
    o.needles += each.occluded(line.origin_m, line.direction);
  }
  o.se = std::sqrt(o.volume) / lines;
  o.volume /= lines;
  o.needles /= lines;
  return o;
}

// Mean over all ways, needles / volume: the cloud of needles turned and placed any way is a model, and this
// is its error. Spruce's needles stand round the shoot; fir's are combed flat, pine's stand in pairs and
// larch's in tufts: they hide each other. 100,000 lines; 2.5 % is three standard errors.
TEST(NeedleRays, OpacityOfAShootAgainstItsCloud) {
  struct Known {
    const char* file;
    double ratio;
  };
  for (const Known& k : {Known{"picea_abies", 0.99}, Known{"abies_alba", 0.89},
                         Known{"pinus_sylvestris", 0.88}, Known{"larix_decidua", 0.74}}) {
    const Opacities o = opacities(species_of(k.file).foliage, 100000);
    EXPECT_NEAR(o.needles / o.volume, k.ratio, 0.025) << k.file;
  }
}

// Coordinates, sizes and turns of instances: the needles of a tree that is moved, turned and scaled are those
// of the tree, moved, turned and scaled; drawn as an instance or written out.
TEST(NeedleRays, InstancesShareNeedles) {
  const FoliageTemplate foliage = species_of("pinus_sylvestris").foliage;
  const Forest alone = one_shoot(foliage);
  Forest two = alone;
  two.instances = {{{3, -2, 1}, {}, 0.7f, 2.0f, {}}, {{-5, 1, 0}, {}, 0.0f, 1.0f, {}}};
  const RayScene one(alone, needles_of(foliage)), both(two, needles_of(foliage));
  RandomStream random(9, 0, RandomPurpose::kTestScene);
  int met = 0, unlike = 0;
  for (int i = 0; i < 2000; ++i) {
    const Line line = any_line(random, reach_of(foliage));
    const Instance& at = two.instances[0];
    const RayHit a = one.closest_hit(line.origin_m, line.direction);
    const RayHit b =
        both.closest_hit(world_from_tree(at, line.origin_m), world_direction_from_tree(at, line.direction));
    met += a.kind == HitKind::kFoliage;
    const bool like =
        a.kind == b.kind && a.needle == b.needle &&
        (a.kind == HitKind::kSky || std::abs(b.distance_m - 2 * a.distance_m) < 1e-5) &&
        (a.kind == HitKind::kSky || glm::dot(world_direction_from_tree(at, a.normal), b.normal) > 0.99);
    unlike += !like;
  }
  EXPECT_GT(met, 300);
  EXPECT_LE(unlike, 10);  // rays along an edge in single precision
}

// A ray that leaves a needle never meets that needle, to its own side or through it, and goes on to others.
TEST(NeedleRays, LeaveTheirNeedle) {
  const FoliageTemplate foliage = species_of("picea_abies").foliage;
  const Forest forest = one_shoot(foliage);
  const RayScene rays(forest, needles_of(foliage));
  RandomStream random(10, 0, RandomPurpose::kTestScene);
  int others = 0;
  for (int i = 0; i < 4000; ++i) {
    const Line line = any_line(random, reach_of(foliage));
    const RayHit hit = rays.closest_hit(line.origin_m, line.direction);
    if (hit.kind == HitKind::kSky) continue;
    for (const bool side : {true, false}) {
      const Vec3 d = any_direction(random);
      const RayHit next = rays.closest_hit(hit.on_original_m, d, 0, start_from(hit, side));
      EXPECT_TRUE(next.kind == HitKind::kSky || next.needle != hit.needle) << i;
      others += next.kind == HitKind::kFoliage;
    }
  }
  EXPECT_GT(others, 100);
}

TEST(NeedleRays, SameForAnyNumberOfThreads) {
  const FoliageTemplate foliage = species_of("abies_alba").foliage;
  const Forest forest = one_shoot(foliage);
  const auto run = [&] {
    const RayScene rays(forest, needles_of(foliage));
    std::vector<double> found(5000);
    for_each_chunk(found.size(), 64, {}, "", [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        RandomStream random(11, i, RandomPurpose::kTestScene);
        const Line line = any_line(random, reach_of(foliage));
        const RayHit hit = rays.closest_hit(line.origin_m, line.direction);
        found[i] = hit.kind == HitKind::kSky ? -1 : hit.distance_m + hit.needle;
      }
    });
    return found;
  };
  std::vector<double> one, three;
  with_threads(1, [&] { one = run(); });
  with_threads(3, [&] { three = run(); });
  EXPECT_EQ(one, three);
}

TEST(NeedleRays, UnknownMaterialIsRefused) {
  const FoliageTemplate foliage = species_of("picea_abies").foliage;
  const Forest forest = one_shoot(foliage);
  test::expect_refused([&] { RayScene(forest, {.shoots = ShootForm::kNeedles}); }, ErrorKind::kInvalidInput,
                       "needles", "'m0'", "a species with shoots");
}

struct LightOnNeedles {
  double sky = 0, sun = 0;  // of the light on a lone needle, mean over all needles
};

// `samples` places on the needles of a tree of shoots of one size, one ray to a uniform sky and one to the
// sun each; without bounces and ground.
LightOnNeedles light_on_needles(const Forest& forest, const FoliageTemplate& foliage, const Vec3& to_sun,
                                int samples) {
  const Prototype& tree = forest.prototypes[0];
  const RayScene rays(forest, needles_of(foliage));
  RandomStream random(12, 0, RandomPurpose::kTestScene);
  std::vector<Needle> needles;
  LightOnNeedles light;
  for (int i = 0; i < samples; ++i) {
    const std::uint32_t shoot = random.below(static_cast<std::uint32_t>(tree.foliage.size()));
    needles.clear();
    expand_needles(tree.foliage[shoot], foliage, 1, shoot, needles);
    const std::uint32_t k = random.below(static_cast<std::uint32_t>(needles.size()));
    const Vec3 base(needles[k].base_m), tip(needles[k].tip_m);
    const Basis around = basis_around(glm::normalize(tip - base));
    const double turn = random.uniform(0, 2 * kPi), radius = needles[k].radius_m;
    const Vec3 normal = std::cos(turn) * around.tangent + std::sin(turn) * around.bitangent;
    const Vec3 at = glm::mix(base, tip, random.uniform()) + radius * normal;
    const RayStart from{HitKind::kFoliage, true, 0, shoot, k};
    const Vec3 up = trace::cosine_direction(normal, random.uniform(), random.uniform());
    light.sky += up.z > 0 && !rays.occluded(at, up, 0, from);
    const double cosine = glm::dot(normal, to_sun);
    light.sun += cosine > 0 && !rays.occluded(at, to_sun, 0, from) ? 4 * cosine : 0;
  }
  return {2 * light.sky / samples, light.sun / samples};
}

// The same for the clouds of needles: places all over their cylinders, needles turned any way.
LightOnNeedles light_in_clouds(const Forest& forest, const Vec3& to_sun, int samples) {
  const Prototype& tree = forest.prototypes[0];
  const RayScene rays(forest, {.ground = false});
  RandomStream random(13, 0, RandomPurpose::kTestScene);
  LightOnNeedles light;
  for (int i = 0; i < samples; ++i) {
    const FoliageElement& e = tree.foliage[random.below(static_cast<std::uint32_t>(tree.foliage.size()))];
    const Vec3 u(e.half_u_m);
    const Basis around = basis_around(glm::normalize(u));
    const double turn = random.uniform(0, 2 * kPi),
                 rho = glm::length(Vec3(e.half_v_m)) * std::sqrt(random.uniform());
    const Vec3 at = Vec3(e.centre_m) + random.uniform(-1, 1) * u +
                    rho * (std::cos(turn) * around.tangent + std::sin(turn) * around.bitangent);
    const Vec3 up = any_direction(random);
    light.sky += up.z > 0 && !rays.occluded(at, up);
    light.sun += !rays.occluded(at, to_sun);
  }
  return {2 * light.sky / samples, light.sun / samples};
}

// Trees of 10 cm: light on their needles, one by one, against the clouds that `reference` computes with. In
// spruce they agree; larch's tufts shade themselves (fir: sky 0.89, sun 1.11; pine 0.90 and 0.89). Standard
// errors 0.02.
TEST(NeedleRays, LightOfATreeAgainstItsClouds) {
  struct Known {
    const char* file;
    double sky, sun;
  };
  for (const Known& k : {Known{"picea_abies", 1.02, 1.015}, Known{"larix_decidua", 0.89, 0.88}}) {
    const Species species = species_of(k.file);
    Forest forest = test::forest_of({});
    forest.prototypes[0] = grow_prototype(species, expected_size(species, 10), 1, 1);
    forest.prototypes[0].materials = {"m0"};
    const Vec3 to_sun = glm::normalize(Vec3(0.5, 0.3, 0.8));
    const LightOnNeedles each = light_on_needles(forest, species.foliage, to_sun, 20000),
                         cloud = light_in_clouds(forest, to_sun, 20000);
    EXPECT_NEAR(each.sky / cloud.sky, k.sky, 0.06) << k.file;
    EXPECT_NEAR(each.sun / cloud.sun, k.sun, 0.06) << k.file;
  }
}

TEST(NeedleRays, MemoryOfASpruce) {
  const Species spruce = species_of("picea_abies");
  Forest forest = test::forest_of({});
  forest.prototypes[0] = grow_prototype(spruce, expected_size(spruce, 30), 1, 1);
  forest.prototypes[0].materials = {"m0"};
  const RayScene cloud(forest, {.ground = false}), each(forest, needles_of(spruce.foliage));
  // 16,107 shoots of 140 needles: 2.25 million. Embree's structures and ours; measured 2.0 and 223 MB.
  EXPECT_LT(static_cast<double>(cloud.memory_bytes()), 60e6);
  EXPECT_GT(static_cast<double>(each.memory_bytes()), 2.25e6 * 36);  // two points and an index each
  EXPECT_LT(static_cast<double>(each.memory_bytes()), 2.25e6 * 120);
}

}  // namespace
}  // namespace sunfleck
