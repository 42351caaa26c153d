// Scenes and light that the tests of the envelope method share.
#pragma once

#include <vector>

#include "lighting/envelope/envelope_estimator.h"
#include "lighting/envelope/envelope_full.h"

namespace sunfleck::test {

// A square leaf of `side_m` with its front towards `normal`.
FoliageElement square_leaf(const Vec3& centre_m, const Vec3& normal, double side_m);
// One tree of these elements; material "leaf" with r, t and bands as generated_crown() has.
Forest forest_of(std::vector<FoliageElement> foliage);

// Light of `bands` equal bands; `to_sun` need not be unit.
Illumination light_of(const Vec3& to_sun, double beam_w_m2, double diffuse_w_m2, std::size_t bands = 1);
OpticsTable optics_of(const Forest& forest, std::vector<std::string> bands, double soil_albedo);

LightMap envelope_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                      EnvelopeSun sun = EnvelopeSun::kMarched);
LightMap envelope_full_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                           const EnvelopeFullOptions& options);

// Area-weighted mean of front + back of one part over the elements of a forest's first band.
double mean_direct(const LightMap& map);
double mean_sky(const LightMap& map);
double mean_scattered(const LightMap& map);

}  // namespace sunfleck::test
