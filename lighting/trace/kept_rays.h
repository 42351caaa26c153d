// What traced light keeps between two requests on one forest: the ray scene, the receivers with their order,
// the hit matrix of each seed, sky and number of rays, and the sun of each seed, direction and number of
// rays. A change of strengths, bands, leaf or soil optics reuses all of it, a change of the sun the matrix, a
// change of the sky model the rest.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "lighting/base/prepared_cache.h"
#include "lighting/trace/hit_matrix.h"
#include "lighting/trace/sun_light.h"

namespace sunfleck::trace {

// Numbered receivers over ground cells; immutable. `forest` must outlive it.
struct Surfaces {
  Surfaces(const Forest& forest, const GroundCells& cells, bool ordered);
  Surfaces(const Surfaces&) = delete;
  Surfaces& operator=(const Surfaces&) = delete;

  const GroundCells ground;
  const Receivers receivers;
  const std::vector<std::uint32_t> order;  // visiting_order(), where asked for
};

class KeptRays {
 public:
  // `store` keeps what is made here; it must belong to this forest, and both must outlive this.
  KeptRays(const Forest& forest, const PreparedStore& store, const RunControl& control)
      : forest_(forest), store_(store), control_(control) {}

  std::shared_ptr<const RayScene> scene(bool ground) const;
  // Ground cells of about `cell_m` (0: chosen from the scene), or no ground.
  std::shared_ptr<const Surfaces> surfaces(bool ground, double cell_m) const;
  // Without ground cells and order, for a few probes.
  std::shared_ptr<const Surfaces> plain_surfaces() const;

  struct Knobs {
    bool ground = true;
    double ground_cell_m = 0;
    std::uint64_t seed = 1;
  };
  // With `rays` per face. What `before` holds (of the same knobs and sky; null: nothing) is not traced again.
  std::shared_ptr<const HitMatrix> matrix(const Knobs& knobs, SkyModel sky, int rays,
                                          const HitMatrix* before) const;
  std::shared_ptr<const SunLight> sun(const Knobs& knobs, const Illumination& light, int rays,
                                      const SunLight* before) const;

 private:
  const Forest& forest_;
  const PreparedStore& store_;
  const RunControl& control_;
};

}  // namespace sunfleck::trace
