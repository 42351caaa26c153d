// envelope: every leaf keeps its optical depth towards 8 directions; sky, sun and one bounce of sun follow in
// closed form, as [Boulanger08] describes it, in optical depths.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lighting/base/light_map.h"
#include "lighting/optics/optics.h"
#include "lighting/sky/illumination.h"
#include "sim/base/run_control.h"
#include "sim/forest/forest.h"

namespace sunfleck {

enum class EnvelopeSun {
  kPublished,  // Eq. 7: the depth towards the sun interpolated from the 8 directions
  kMarched     // one march of the leaf-area grid per leaf towards the sun
};

struct EnvelopeOptions {
  EnvelopeSun sun = EnvelopeSun::kPublished;
  double cell_m =
      0;  // of the leaf-area grid; 0: 2 to 4 leaf sides by the rule clamp(extent / 32, 2 side, 4 side)
};

namespace envelope {
struct PublishedDepths;
}

// What depends on the forest and the cells alone. Any number of threads may read it.
struct EnvelopeSectors {
  std::shared_ptr<const envelope::PublishedDepths> depths;
  double cell_m = 0;  // as in the options
  std::string forest_hash;
  std::vector<StageTime> times;
  std::uint64_t bytes() const;
};
EnvelopeSectors prepare_envelope_sectors(const Forest& forest, const EnvelopeOptions& options,
                                         const RunControl& control);

// `sectors` must be those of this forest and these cells; then the same bytes as all of it at once.
LightMap envelope_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                            const EnvelopeOptions& options, const EnvelopeSectors& sectors,
                            const RunControl& control);
LightMap envelope_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                            const EnvelopeOptions& options, const RunControl& control);

}  // namespace sunfleck
