// links: what 16 to 256 rays from every face meet, kept once per forest; any sun, sky and band is then solved
// on the same links, all bounces, without another ray but for direct sun. Links within a tree are kept with
// its prototype and shared by its instances, so that the light of two instances of one prototype errs alike.
//
// Rays of a face are one scrambled low-discrepancy set over positions and directions; every link is unbiased.
// Surfaces and conventions are those of the reference: light is even over a leaf, a group of wood segments
// and a ground cell; shoots scatter alike into all directions. No standard errors: the spread of such rays
// does not tell their error; probes do.
#pragma once

#include <memory>
#include <span>

#include "lighting/base/light_map.h"
#include "lighting/links/direct_light.h"
#include "lighting/links/link_solver.h"

namespace sunfleck {

struct LinksOptions {
  std::uint64_t seed = 1;
  int links_per_face = 64;        // 16 .. 256; powers of two spread best
  int sun_rays_per_element = 16;  // 1 .. 65536, where direct light is not given
  // Bounces end when the power given back is known to about this, relative.
  double convergence = 1e-3;
  int max_iterations = 200;
  bool ground = true;
  double ground_cell_m = 0;                       // 0: chosen from the scene, as by the reference
  std::uint64_t memory_limit_bytes = 8ull << 30;  // more is refused with kLimitExceeded before it is traced
};

// Depends on the forest and on seed, links_per_face, ground, ground_cell_m. The forest must outlive it,
// unchanged.
struct LinksPrepared {
  std::unique_ptr<const trace::GroundCells> ground;
  std::unique_ptr<const trace::Receivers> receivers;
  std::unique_ptr<const RayScene> rays;
  links::LinkTable table;
  std::vector<links::SurfaceRange> ranges;
  std::string forest_hash;
  std::vector<StageTime> times;
  std::uint64_t bytes() const { return table.bytes() + rays->memory_bytes(); }
};

// Throws Error(kInvalidInput) naming "links.<field>" or "forest", Error(kLimitExceeded), Error(kCancelled).
LinksPrepared prepare_links(const Forest& forest, const LinksOptions& options, const RunControl& control);

// Direct sun by shadow rays for links_light_map(); depends on the sun's place, not on bands.
links::DirectLight links_direct_light(const LinksPrepared& prepared, const Illumination& light,
                                      const LinksOptions& options, const RunControl& control);

// The same where the share of each foliage element that is in the sun is known already (SunExposure of the
// same sun and ground): few shadow rays, for wood and ground alone.
links::DirectLight links_given_light(const LinksPrepared& prepared, const Illumination& light,
                                     const LinksOptions& options, std::span<const float> sunlit_fraction,
                                     const RunControl& control);

// `direct`: per face of prepared.receivers, see links::DirectLight.
LightMap links_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                         const LinksOptions& options, const LinksPrepared& prepared,
                         const links::DirectLight& direct, const RunControl& control);
// With direct light by shadow rays; its time is stage "tracing sun".
LightMap links_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                         const LinksOptions& options, const LinksPrepared& prepared,
                         const RunControl& control);
// All of it.
LightMap links_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                         const LinksOptions& options, const RunControl& control);

}  // namespace sunfleck
