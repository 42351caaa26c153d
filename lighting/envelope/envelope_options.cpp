// See envelope_options.h.
#include "lighting/envelope/envelope_options.h"

#include <algorithm>
#include <cmath>

#include "lighting/envelope/sector_set.h"
#include "sim/base/error.h"

namespace sunfleck {

std::string to_string(EnvelopeSun value) {
  return value == EnvelopeSun::kPublished ? "published" : "marched";
}

std::string to_string(EnvelopeAngles value) {
  return value == EnvelopeAngles::kSpherical ? "spherical" : "measured";
}

std::string to_string(EnvelopeBounces value) {
  if (value == EnvelopeBounces::kSunOnce) return "sun_once";
  return value == EnvelopeBounces::kOnce ? "once" : "all";
}

std::string to_string(EnvelopeGround value) {
  return value == EnvelopeGround::kFullyLit ? "fully_lit" : "shaded";
}

std::string to_string(EnvelopeWeights value) { return value == EnvelopeWeights::kPlain ? "plain" : "cosine"; }

std::string to_string(EnvelopeOwnLeaf value) { return value == EnvelopeOwnLeaf::kKept ? "kept" : "removed"; }

std::string to_string(EnvelopeBorder value) {
  if (value == EnvelopeBorder::kByScene) return "by_scene";
  return value == EnvelopeBorder::kRound ? "round" : "level";
}

void check(const EnvelopeFullOptions& options) {
  if (std::ranges::find(envelope::kSectorCounts, options.directions) == std::end(envelope::kSectorCounts))
    throw_invalid("envelope_full.directions",
                  std::to_string(options.directions) + " directions are not built", "8, 14, 26 or 50");
  if (!(options.cell_m >= 0.0 && std::isfinite(options.cell_m)))
    throw_invalid("envelope_full.cell_m", "a cell cannot be " + std::to_string(options.cell_m) + " m",
                  "give a length in metres, best 2 to 4 leaf sides, or 0 to have it chosen");
}

}  // namespace sunfleck
