// One door to all estimators: what to compute, by which method, with which knobs.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lighting/base/light_map.h"
#include "lighting/envelope/envelope_estimator.h"
#include "lighting/envelope/envelope_options.h"
#include "lighting/links/links_estimator.h"
#include "lighting/optics/optics.h"
#include "lighting/plan/auto_options.h"
#include "lighting/plan/selection.h"
#include "lighting/sky/illumination.h"
#include "lighting/slab/spp_estimators.h"
#include "lighting/trace/reference.h"
#include "lighting/transport/grid_estimator.h"
#include "lighting/transport/world_light.h"
#include "sim/base/run_control.h"
#include "sim/forest/forest.h"

namespace sunfleck {

enum class Method {
  kReference,
  kSingleScattering,
  kSpp,
  kSppG,
  kSppH,
  kSppMarched,
  kEnvelope,
  kEnvelopeMarched,
  kEnvelopeFull,
  kGrid,
  kLinks,
  kWorld,
  kAuto
};

// reference, single_scattering, spp, spp_g, spp_h, spp_marched, envelope, envelope_marched, envelope_full,
// grid, links, world, auto
std::string to_string(Method method);
Method method_from_string(const std::string& name, const std::string& where);  // throws, listing the names
const std::vector<std::string>& method_names();

// Whether work that cannot change the answer by more than a stated bound is left out, see plan.h.
enum class Skipping { kAuto, kNever };

// What changes the answer.
struct LightRequest {
  Method method = Method::kReference;
  OpticsRequest optics;
  Illumination light;
  ReferenceOptions reference;
  SppOptions spp;
  EnvelopeOptions envelope;
  EnvelopeFullOptions envelope_full;
  GridOptions grid;
  LinksOptions links;
  WorldOptions world;
  AutoOptions automatic;
  Skipping skip = Skipping::kAuto;
  Selection selection;  // the answer holds only these trees, numbered as in selected_forest()
  // Measures the error of the answer, whatever the method; `auto` always does, by the defaults if not given.
  std::optional<ProbePlan> probes;
};

// What only changes its cost.
struct CostOptions {
  int threads = 0;  // 0: all cores
};

// Sun, sky, bands and optics of a request as name and value pairs: what a light map file needs to say about
// its light.
std::vector<std::pair<std::string, std::string>> describe_light(const Forest& forest,
                                                                const LightRequest& request);

// Validates, skips what the scene does not need (and says so), runs the method, fills the provenance and
// checks the invariants of every result. Throws Error for bad input, an empty forest, a stop, or a limit.
LightMap compute_light_map(const Forest& forest, const LightRequest& request, const CostOptions& cost,
                           const RunControl& control);

}  // namespace sunfleck
