// What the complete envelope method can be told: every correction of the published model has a name and can
// be taken away.
#pragma once

#include <string>

#include "lighting/envelope/envelope_estimator.h"

namespace sunfleck {

enum class EnvelopeAngles {
  kSpherical,  // leaf normals in all directions alike, as published
  kMeasured    // the normals of the forest's own leaves
};

enum class EnvelopeBounces {
  kSunOnce,  // one bounce of sunlight, as published
  kOnce,     // one bounce of sun, sky and ground light
  kAll       // that, and all further bounces by the chance of light to meet leaves again
};

enum class EnvelopeGround {
  kFullyLit,  // as if nothing stood on it, as published
  kShaded     // lit through the canopy, by what the canopy throws down too
};

enum class EnvelopeWeights {
  kPlain,  // solid angle times cosine, as published: 0.82 to 1.16 of an even sky with 8 directions
  kCosine  // scaled per leaf so that light that is the same from everywhere counts exactly
};

// How the depth towards one direction changes on the way along another: by the border that is assumed there.
enum class EnvelopeBorder {
  kRound,   // square to each direction, as published (Eq. 22): by the cosine between the two
  kLevel,   // a plane along the ground: exact in even layers
  kByScene  // level where the scene repeats for ever, else round
};

enum class EnvelopeOwnLeaf {
  kKept,    // a leaf shades itself like its neighbours do
  kRemoved  // its own part of its cell is taken out
};

struct EnvelopeFullOptions {
  int directions = 14;  // 8, 14, 26 or 50: time grows a little faster, errors hardly fall beyond 14
  EnvelopeSun sun = EnvelopeSun::kMarched;
  EnvelopeAngles angles = EnvelopeAngles::kMeasured;
  EnvelopeBounces bounces = EnvelopeBounces::kAll;
  EnvelopeGround ground = EnvelopeGround::kShaded;
  EnvelopeWeights weights = EnvelopeWeights::kCosine;
  EnvelopeOwnLeaf own_leaf = EnvelopeOwnLeaf::kRemoved;
  EnvelopeBorder border = EnvelopeBorder::kByScene;
  // Of the leaf-area grid; 0: clamp(extent / 32, 2 side, 4 side), and of a tree that stands alone wider
  // than 4 sides where there would be more than 0.65 cells per leaf (dense crowns of 200,000 leaves and more,
  // open ones before that).
  double cell_m = 0;
};

std::string to_string(EnvelopeSun value);      // published, marched
std::string to_string(EnvelopeAngles value);   // spherical, measured
std::string to_string(EnvelopeBounces value);  // sun_once, once, all
std::string to_string(EnvelopeGround value);   // fully_lit, shaded
std::string to_string(EnvelopeWeights value);  // plain, cosine
std::string to_string(EnvelopeOwnLeaf value);  // kept, removed

std::string to_string(EnvelopeBorder value);  // round, level, by_scene

// Throws Error(kInvalidInput) naming "envelope_full.<field>".
void check(const EnvelopeFullOptions& options);

}  // namespace sunfleck
