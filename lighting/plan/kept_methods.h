// Estimators whose preparation a session keeps: the closed forms, links, and the world grid. Answers have the
// same bytes as their one-call forms.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lighting/plan/light_request.h"
#include "lighting/plan/light_scene.h"

namespace sunfleck {

LightMap kept_spp_light_map(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
                            const SppOptions& options, const RunControl& control);

LightMap kept_envelope_light_map(const LightScene& scene, const OpticsTable& optics,
                                 const Illumination& light, const EnvelopeFullOptions& options,
                                 const RunControl& control);

// Direct light of leaves by drawing the forest as the sun sees it (sun_raster.h), of wood and ground by a few
// shadow rays. `sunlit_fraction`: of every element, drawn before; empty: drawn here and kept.
LightMap kept_links_light_map(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
                              const LinksOptions& options, std::span<const float> sunlit_fraction,
                              const RunControl& control);

// The published envelope.
LightMap kept_envelope_light_map(const LightScene& scene, const OpticsTable& optics,
                                 const Illumination& light, const EnvelopeOptions& options,
                                 const RunControl& control);

// The world grid once, then the leaves of these instances one tree after the other: elements and trees in
// that order, TreeLight::instance counting them.
LightMap kept_world_light_map(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
                              const WorldOptions& options, const std::vector<std::uint32_t>& instances,
                              const RunControl& control);

}  // namespace sunfleck
