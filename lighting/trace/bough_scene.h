// Conifers from afar, after [Meyer00]: every shoot a bough of needles with a closed-form optical depth
// (lighting/shade), met by rays as expected values. A ray has no lot to draw: it is told what share of it
// comes through and what light the boughs in its way send back, so pictures of boughs below a pixel need few
// rays.
//
//   seen = sum over the boughs in the way, front to back: (what comes through to it) (its opacity) (its
//   light), its light = (reflected / opacity of the whole bough from there, lit from there) (sun that reaches
//   it).
// The ratio is tabulated once per kind of bough from bough_light, over all directions of viewer and sun, the
// bough's own shade and hot spot included. What reaches it through other boughs is asked by a ray from each
// of a few stations on its axis, when the bough is first seen, and kept for one viewer and sun.
//
// Assumptions: single scattering ([Meyer00]: low albedo); boughs are at most a few pixels wide, as light is
// even across one; viewer far away against a bough's length; boughs that lie in each other are taken one
// behind the other. Only foliage: who has wood or ground in the picture bounds the ray (far_m). Does not
// repeat. Measured error against needles one by one: see the README and tests/bench/render/firs_bench.cpp.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sim/base/run_control.h"
#include "sim/base/vec.h"
#include "sim/forest/forest.h"
#include "sim/plant/needles.h"

namespace sunfleck {

// Immutable, const calls are safe from many threads. `forest` must outlive it.
class BoughScene {
 public:
  // Throws Error(kInvalidInput) for shoots whose material has no kind, and for instances whose place, turn or
  // scale is not finite.
  BoughScene(const Forest& forest, std::span<const NeedleKind> kinds, const RunControl& control = {});
  ~BoughScene();
  BoughScene(const BoughScene&) = delete;
  BoughScene& operator=(const BoughScene&) = delete;

  struct Viewer {
    Vec3 position_m{0};
    bool far = false;         // all rays run along `direction`
    Vec3 direction{0, 1, 0};  // unit, away from the viewer
  };
  // For one viewer and one sun: reflected light per opacity of every bough of every instance, at `stations`
  // places along it (1: below a pixel; 3: a few pixels). Values are found when first asked for and do not
  // depend on who asks; 4 bytes per station.
  class Lit {
   public:
    Lit(const BoughScene& scene, const Viewer& viewer, const Vec3& to_sun, int stations = 1);

   private:
    friend class BoughScene;
    Viewer viewer_;
    Vec3 to_sun_;
    std::size_t stations_;
    std::vector<std::size_t> first_;  // of each instance
    std::unique_ptr<std::atomic<float>[]>
        reflected_;  // [first + bough * stations + station]; < 0: not yet known
  };

  struct Seen {
    float through = 1;    // share of the ray that meets no needle
    float reflected = 0;  // radiance = albedo / pi * irradiance across the sun's light * reflected
  };
  Seen seen(const Vec3& origin_m, const Vec3& direction, const Lit& lit, double far_m = 1e30) const;
  // Expected share of light that comes through; below 1 in 1000 it may be anything between that and 0.
  double transmittance(const Vec3& origin_m, const Vec3& direction, double far_m = 1e30) const;

  std::size_t boughs() const;  // of all instances
  std::size_t memory_bytes() const;

 private:
  struct State;
  float light_at(const Lit& lit, std::uint32_t instance, std::uint32_t bough, float z) const;
  float station(const Lit& lit, std::uint32_t instance, std::uint32_t bough, std::size_t station) const;
  std::unique_ptr<State> state_;
};

}  // namespace sunfleck
