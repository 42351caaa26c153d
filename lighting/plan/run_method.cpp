#include "lighting/plan/run_method.h"

#include "lighting/plan/kept_grid.h"
#include "lighting/plan/kept_methods.h"
#include "sim/base/contract.h"

namespace sunfleck {
namespace {

SppOptions spp_options(const LightRequest& request, SppVariant variant) {
  SppOptions options = request.spp;
  options.variant = variant;
  return options;
}

EnvelopeOptions envelope_options(const LightRequest& request, EnvelopeSun sun) {
  EnvelopeOptions options = request.envelope;
  options.sun = sun;
  return options;
}

}  // namespace

LightMap run_method(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
                    const LightRequest& request, std::span<const float> sunlit_fraction,
                    const RunControl& control) {
  const Forest& forest = scene.forest;
  switch (request.method) {
    case Method::kReference:
      return reference_light_map(forest, optics, light, request.reference, control, scene.store);
    case Method::kSingleScattering:
      return kept_spp_light_map(scene, optics, light, spp_options(request, SppVariant::kSingleScattering),
                                control);
    case Method::kSpp:
      return kept_spp_light_map(scene, optics, light, spp_options(request, SppVariant::kSpp), control);
    case Method::kSppG:
      return kept_spp_light_map(scene, optics, light, spp_options(request, SppVariant::kSppG), control);
    case Method::kSppH:
      return kept_spp_light_map(scene, optics, light, spp_options(request, SppVariant::kSppH), control);
    case Method::kSppMarched:
      return kept_spp_light_map(scene, optics, light, spp_options(request, SppVariant::kSppMarched), control);
    case Method::kEnvelopeFull:
      return kept_envelope_light_map(scene, optics, light, request.envelope_full, control);
    case Method::kLinks:
      return kept_links_light_map(scene, optics, light, request.links, sunlit_fraction, control);
    case Method::kEnvelope:
      return kept_envelope_light_map(scene, optics, light, envelope_options(request, EnvelopeSun::kPublished),
                                     control);
    case Method::kEnvelopeMarched:
      return kept_envelope_light_map(scene, optics, light, envelope_options(request, EnvelopeSun::kMarched),
                                     control);
    case Method::kGrid:
      return kept_grid_light_map(scene, optics, light, request.grid, sunlit_fraction, control);
    case Method::kWorld:  // knows which trees are asked for: LightSession
    case Method::kAuto:   // chooses among the others: auto_light_map()
      break;
  }
  throw ContractViolation("not a method of its own");
}

}  // namespace sunfleck
