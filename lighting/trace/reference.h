// The traced reference: rays once from both faces of every element, hit ids kept (the hit matrix), then
// iterated per band and source until the light no longer changes; direct sun by shadow rays. Unbiased but for
// the second-order effect of a noisy matrix; every value comes with a standard error.
#pragma once

#include <cstdint>

#include "lighting/base/light_map.h"
#include "lighting/base/prepared_cache.h"
#include "lighting/optics/optics.h"
#include "lighting/sky/illumination.h"
#include "sim/base/run_control.h"
#include "sim/forest/forest.h"

namespace sunfleck {

struct ReferenceOptions {
  std::uint64_t seed = 1;
  int rays_per_face = 64;         // 1 .. 65536, cosine-distributed, from random points of the face
  int sun_rays_per_element = 64;  // 1 .. 65536
  // Stop at this RMS standard error per element relative to the mean irradiance, adding rays to the numbers
  // above as the error found asks for; 0: exactly the rays above.
  double target_relative_error = 0;
  int max_rays_per_face = 4096;
  double convergence = 1e-4;  // of scattered power between two iterations, relative
  int max_iterations = 200;
  double ground_cell_m = 0;  // 0: chosen from the scene
  bool ground = true;
  std::uint64_t memory_limit_bytes = 8ull << 30;  // of stored hits; more is refused with kLimitExceeded
};

LightMap reference_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                             const ReferenceOptions& options, const RunControl& control);
// The same with what can be used again kept in `store`, see kept_rays.h. Equal bytes.
LightMap reference_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                             const ReferenceOptions& options, const RunControl& control,
                             const PreparedStore& store);

}  // namespace sunfleck
