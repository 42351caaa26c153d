// envelope: every leaf keeps its optical depth towards 8 directions; sky, sun and one bounce of sun follow in
// closed form, as [Boulanger08] describes it, in optical depths.
#pragma once

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

LightMap envelope_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                            const EnvelopeOptions& options, const RunControl& control);

}  // namespace sunfleck
