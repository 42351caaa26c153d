// Rays through a forest. The only folder that knows Embree; its types stay inside.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sim/base/run_control.h"
#include "sim/base/vec.h"
#include "sim/forest/forest.h"
#include "sim/plant/needles.h"

namespace sunfleck {

enum class HitKind : std::uint8_t { kSky, kFoliage, kWood, kWoodMesh, kGround };

struct RayHit {
  HitKind kind = HitKind::kSky;
  // Foliage: the front face was hit (for a shoot: one of its two faces by lot). Wood: its outer side. Wood
  // mesh: the side from which its corners run counter-clockwise. Ground: its upper side.
  bool front = false;
  std::uint32_t instance = 0;  // index into Forest::instances (of the original where a wrapped copy was hit)
  std::uint32_t local = 0;     // foliage element, wood segment or triangle of its prototype
  std::uint32_t needle = kNoNeedle;  // of the shoot `local`, where shoots are drawn needle by needle

  static constexpr std::uint32_t kNoNeedle = 0xFFFFFFFFu, kSomeNeedle = 0xFFFFFFFEu;  // kSome: of a bough
  double distance_m = 0;
  Vec3 position_m{0};  // world; for a periodic forest brought back into the base cell
  // The same point on the original where a wrapped copy was hit: a ray goes on from here with a RayStart of
  // the same kind, instance and local.
  Vec3 on_original_m{0};
  Vec3 normal{0};         // unit, of the surface hit, turned towards the ray's origin
  std::uint8_t cast = 0;  // of the ray
};

// The surface a ray starts on, so that it does not hit the place it leaves. kSky: none. Shoots are no
// surfaces: a ray from a needle may meet other needles of its own shoot; where needles are drawn one by one
// it does not meet the one it starts on, whichever side it leaves to.
struct RayStart {
  HitKind kind = HitKind::kSky;
  bool front = true;  // wood: from its outer side
  std::uint32_t instance = 0, local = 0;
  std::uint32_t needle = RayHit::kNoNeedle;
  std::uint8_t cast = 0;  // which of Options::casts the ray meets
};
// From where a ray met something, to the side it came from or to the other.
inline RayStart start_from(const RayHit& hit, bool to_side_met) {
  return {hit.kind, to_side_met == hit.front, hit.instance, hit.local, hit.needle, hit.cast};
}

// How shoots meet rays.
enum class ShootForm : std::uint8_t {
  kVolume,  // a cylinder evenly filled with needles turned any way, met by lot
  // Every needle for itself, round, in the places of expand_needles (which lie inside the cylinder and
  // have the shoot's area): what the others are measured against, and what is seen from near by.
  kNeedles,
  // The volume of a bough ([Meyer00]; lighting/shade/shoot_bough.h): denser towards the axis, needles that
  // lean one way. Met by lot; what is met is a needle of the bough that faces the ray. Light that goes back
  // the way it came meets needles anew: no hot spot.
  kBough
};

// An Embree scene over the instances of a forest. Immutable; all calls are const and safe from many threads.
// `forest` must outlive it. Shoots are small clouds of needles: a ray flies through their cylinder and meets
// a needle with a chance given by path length times half the needle area density, drawn from the ray itself
// (same ray, same answer). In a periodic forest rays go on on the other side of the cell, at most max_wraps
// times, then count as sky (upwards) or ground (downwards). Directions are unit vectors. Distances below
// about 4e-7 of the scene's extent are noise: leaves closer than that do not know which is on top.
class RayScene {
 public:
  struct Options {
    bool ground = true;  // false: nothing below, rays down go to "sky"
    int max_wraps = 10'000;
    // How many rays will be cast, about. Where they are many against the trees' figures, all trees are
    // written out into one structure, which takes longer to build, about 250 bytes per figure, and a half to
    // a tenth of the time per ray where crowns interlock.
    double expected_rays = 0;
    // From this number of trees on a forest that does not repeat is kept in rows of 24 bytes per tree.
    std::size_t table_from = 50'000;
    ShootForm shoots = ShootForm::kVolume;
    // Other forms than kVolume need the kind of every material that shoots have (else Error(kInvalidInput)).
    std::vector<NeedleKind> needles{};
    std::uint64_t needle_seed = 1;  // of expand_needles
    // Several plants for each place, of which a ray meets one: casts[c][i] stands where instance i does for
    // rays of cast c, in place of the instance's own prototype. For pictures whose samples look at different
    // prototypes of one tree, which share their structures. None: one cast, of the instances' prototypes.
    std::vector<std::vector<PrototypeId>> casts{};
    // The box whose middle and size fix the origin and rounding of the scene's coordinates; empty: the
    // forest's. One that a part of the forest shares with the whole gives equal rays equal hits in both.
    Box coordinates = {};
  };
  // Throws Error(kCancelled) when stopped while building.
  RayScene(const Forest& forest, const Options& options, const RunControl& control = {});
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  RayHit closest_hit(const Vec3& origin_m, const Vec3& direction, double min_distance_m = 0.0,
                     const RayStart& from = {}) const;
  // True if anything (foliage, wood, ground) lies on the way to infinity.
  bool occluded(const Vec3& origin_m, const Vec3& direction, double min_distance_m = 0.0,
                const RayStart& from = {}) const;

  // The same past one instance, as if it were not there (copies of it in other periods are), and no farther
  // than max_m: beyond that what is met may be left out, what lies at the end of the way (sky, ground) not.
  RayHit closest_hit_past(std::uint32_t instance, const Vec3& origin_m, const Vec3& direction,
                          const RayStart& from, double max_m) const;
  bool occluded_past(std::uint32_t instance, const Vec3& origin_m, const Vec3& direction,
                     const RayStart& from) const;

  std::size_t copies() const;        // wrapped copies added for the period
  std::size_t memory_bytes() const;  // of Embree's structures and the places of the trees

 private:
  struct State;
  struct Way;
  RayHit closest_on(const Way& way) const;
  bool occluded_on(const Way& way) const;
  std::unique_ptr<State> state_;
};

}  // namespace sunfleck
