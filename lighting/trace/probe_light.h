// Probes: the true light on a few chosen foliage elements, by path tracing, without a hit matrix of the whole
// forest. From points of both faces K cosine-distributed paths each; at every surface a path meets,
// the direct sun by a shadow ray from that very point, then on by reflection or transmission, all bands on
// the same path, until it reaches the sky or Russian roulette ends it. Direct sun of the probe itself by S
// shadow rays. Ground is the infinite plane, lit as it really is.
//
// The first rays of paths are two sets of K / 2 scrambled low-discrepancy points (low_discrepancy.h), shadow
// rays two shifted lattices: on a clumped crown in PAR that leaves a fifth of the sun's variance that random
// rays have, two thirds of the paths'. The sets are independent, so their difference gives the variance.
//
// Unbiased: no cells, no mean over a surface. The reference takes light as even over every leaf, wood group
// and ground cell; where light varies inside them, probes are nearer to the truth. Surfaces and conventions
// (faces, shoots that scatter alike into all directions, wrapped copies, sun disc) are the reference's.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lighting/optics/optics.h"
#include "lighting/sky/illumination.h"
#include "lighting/trace/kept_rays.h"
#include "sim/base/run_control.h"

namespace sunfleck {

struct ProbeOptions {
  std::uint64_t seed = 1;
  int paths_per_face = 64;  // 2 .. 65536
  int sun_rays = 128;       // 2 .. 65536
};

// What rays need to know of a forest, built once for any number of probes. `forest` must outlive it.
class ProbeScene {
 public:
  ProbeScene(const Forest& forest, bool ground, const RunControl& control);
  // With the ray scene that is kept already, and kept from now on.
  ProbeScene(const trace::KeptRays& kept, bool ground);

  const RayScene& rays() const { return *rays_; }
  const trace::Receivers& receivers() const { return surfaces_->receivers; }

 private:
  std::shared_ptr<const trace::Surfaces> surfaces_;  // without ground cells
  std::shared_ptr<const RayScene> rays_;
};

struct ProbeFace {
  double direct_w_m2 = 0, sky_w_m2 = 0, scattered_w_m2 = 0;
  double total() const { return direct_w_m2 + sky_w_m2 + scattered_w_m2; }
};

struct ProbeBand {
  ProbeFace front, back;
  // Of the sums over both faces. Unbiased estimates from the difference of two sets of rays: right on average
  // over probes (what error bars need), far off for any single one.
  double direct_variance_w2_m4 = 0, diffuse_variance_w2_m4 = 0;
  double variance_w2_m4() const { return direct_variance_w2_m4 + diffuse_variance_w2_m4; }
  double irradiance_w_m2() const { return front.total() + back.total(); }
};

struct ProbeLight {
  std::size_t element = 0;     // ForestIndex order
  double sunlit_fraction = 0;  // 0 with no sun
  std::vector<ProbeBand> bands;
};

// One answer per entry of `elements`; an element named twice is probed twice with other random numbers.
// `light` as returned by checked(). Progress stage "probing".
std::vector<ProbeLight> probe_light(const ProbeScene& scene, const OpticsTable& optics,
                                    const Illumination& light, std::span<const std::size_t> elements,
                                    const ProbeOptions& options, const RunControl& control);

}  // namespace sunfleck
