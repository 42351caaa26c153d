// Which limits of the envelope method a scene touches, in sentences for the user.
#pragma once

#include <string>
#include <vector>

#include "lighting/envelope/envelope_depths.h"
#include "lighting/envelope/sector_light.h"

namespace sunfleck::envelope {

// Prototypes with fewer elements than this are no random medium: rays are the better choice.
inline constexpr std::size_t kFewElements = 300;

std::vector<std::string> scene_notes(const Forest& forest, const BlockerField& field,
                                     const MarchedSectors& sectors);

// Per band where it matters: how much light the missing bounces would add. The chance that scattered light
// meets another leaf is p = 1 - mean T_j, and all bounces together are about 1 / (1 - albedo p) of the first.
std::vector<std::string> missing_bounce_notes(const Forest& forest, const OpticsTable& optics,
                                              const BlockerField& field, const SectorDepths& depths);

}  // namespace sunfleck::envelope
