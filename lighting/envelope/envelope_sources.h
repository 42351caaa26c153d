// Everything that lights the leaves at one moment, ready to be read by any of them: sky and ground per
// sector, the sun, and what the foliage of every prototype does to light in every band.
#pragma once

#include <optional>
#include <vector>

#include "lighting/envelope/bounce_kernel.h"
#include "lighting/envelope/prepared_parts.h"
#include "lighting/envelope/scattering.h"
#include "lighting/sky/illumination.h"

namespace sunfleck::envelope {

// Rows are padded to whole lanes.
struct BandMedium {
  std::vector<float> turn;      // [j * row + k], sr: Scattering::turn
  std::vector<float> sun_turn;  // [j], 1/sr
  double albedo = 0;
};

struct PrototypeMedium {
  std::vector<float> approach;      // [j * row + k]: how fast the depth towards k falls per depth along j
  std::vector<float> sun_approach;  // [j]
  std::vector<BandMedium> bands;
};

struct BandSource {
  double beam_w_m2 = 0;                // on a plane facing the sun; 0 with the sun down
  std::vector<float> sky_radiance;     // [k], W m-2 sr-1, nothing in the way
  std::vector<float> ground_radiance;  // [ground cell], W m-2 sr-1, as lit; and one more: open ground
};

struct Sources {
  bool sun = false;
  Vec3 to_sun{0, 0, 1};
  std::optional<ExtinctionGrid> sun_grid;  // where the sun is marched and above the ground
  std::vector<double> sun_weights;         // where it is interpolated
  std::vector<float> ground_share;         // [k] of a sector
  std::optional<Vec3> level_normal;        // of the border, where it is level
  std::size_t row = 0;                     // floats of a row
  std::vector<PrototypeMedium> media;      // by prototype
  std::vector<BandSource> bands;
};

// `light` must be checked(). Ground is not lit yet: see light_ground().
Sources sources(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                const PreparedParts& parts, bool sun, const RunControl& control);

// Optical depth towards the sun from the sector depths of a leaf or from its own march.
double interpolated_sun_depth(const Sources& sources, std::span<const float> sector_depths);

}  // namespace sunfleck::envelope
