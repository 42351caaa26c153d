// Bidirectional reflectance factor of a forest: radiance towards a view over that of a white Lambertian plane
// under the same sun, BRF = pi L / (E cos sun_zenith), as RAMI defines it: mean over the top of the scene.
//
// Where: the horizontal plane at the top of the forest's box, over one whole period (or, where the forest
// does not repeat, over its box). Rays go down from points of the plane against the view; path tracing (all
// bounces) does the rest. No sky, a sun without size.
#pragma once

#include <span>
#include <vector>

#include "lighting/optics/optics.h"
#include "lighting/render/picture_look.h"
#include "sim/base/run_control.h"
#include "sim/forest/forest.h"

namespace sunfleck {

struct ReflectanceOptions {
  std::size_t band = 0;         // of the optics table
  int samples_per_view = 4096;  // paths; rounded up to whole groups of kReflectanceGroups
  std::uint64_t seed = 1;
  PictureLook look = plain_look();
};
inline constexpr int kReflectanceGroups = 64;  // independent parts of which the standard error is made

struct ReflectanceFactor {
  double value = 0, standard_error = 0;
};

// One per view (unit vectors to the viewer). Throws Error(kInvalidInput): sun or view not above the horizon,
// an empty forest that does not repeat.
std::vector<ReflectanceFactor> bidirectional_reflectance(const Forest& forest, const OpticsTable& optics,
                                                         const Vec3& to_sun, std::span<const Vec3> to_views,
                                                         const ReflectanceOptions& options,
                                                         const RunControl& control);

}  // namespace sunfleck
