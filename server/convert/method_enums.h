// Which value of the wire is which of lighting, once for both directions. For server/convert only.
#pragma once

#include <string>
#include <utility>

#include "lighting/plan/light_request.h"
#include "server/convert/violations.h"
#include "sunfleck/v1/light.pb.h"

namespace sunfleck {

// Pairs of (wire, lighting); the wire's 0 means the value that `into` has before.
template <class Wire, class Ours>
using EnumPairs = std::initializer_list<std::pair<Wire, Ours>>;

inline constexpr EnumPairs<v1::AutoMeasure, AutoMeasure> kMeasures = {
    {v1::AUTO_MEASURE_ELEMENT_RMS, AutoMeasure::kElementRms},
    {v1::AUTO_MEASURE_BIAS, AutoMeasure::kBias},
    {v1::AUTO_MEASURE_TREE_RMS, AutoMeasure::kTreeRms},
    {v1::AUTO_MEASURE_TREE_ABSORBED_RMS, AutoMeasure::kTreeAbsorbedRms},
    {v1::AUTO_MEASURE_LAYER_RMS, AutoMeasure::kLayerRms}};

inline constexpr EnumPairs<v1::SppMarchedOptions::Phase, SppPhase> kPhases = {
    {v1::SppMarchedOptions::PHASE_LEAF_ANGLES, SppPhase::kLeafAngles},
    {v1::SppMarchedOptions::PHASE_ISOTROPIC, SppPhase::kIsotropic}};
inline constexpr EnumPairs<v1::SppMarchedOptions::Paths, SppPaths> kPaths = {
    {v1::SppMarchedOptions::PATHS_TRUE_BOUNDARY, SppPaths::kTrueBoundary},
    {v1::SppMarchedOptions::PATHS_SLAB, SppPaths::kSlab}};

inline constexpr EnumPairs<v1::EnvelopeFullOptions::Sun, EnvelopeSun> kSuns = {
    {v1::EnvelopeFullOptions::SUN_MARCHED, EnvelopeSun::kMarched},
    {v1::EnvelopeFullOptions::SUN_PUBLISHED, EnvelopeSun::kPublished}};
inline constexpr EnumPairs<v1::EnvelopeFullOptions::Angles, EnvelopeAngles> kAngles = {
    {v1::EnvelopeFullOptions::ANGLES_MEASURED, EnvelopeAngles::kMeasured},
    {v1::EnvelopeFullOptions::ANGLES_SPHERICAL, EnvelopeAngles::kSpherical}};
inline constexpr EnumPairs<v1::EnvelopeFullOptions::Bounces, EnvelopeBounces> kBounces = {
    {v1::EnvelopeFullOptions::BOUNCES_ALL, EnvelopeBounces::kAll},
    {v1::EnvelopeFullOptions::BOUNCES_ONCE, EnvelopeBounces::kOnce},
    {v1::EnvelopeFullOptions::BOUNCES_SUN_ONCE, EnvelopeBounces::kSunOnce}};
inline constexpr EnumPairs<v1::EnvelopeFullOptions::Ground, EnvelopeGround> kGrounds = {
    {v1::EnvelopeFullOptions::GROUND_SHADED, EnvelopeGround::kShaded},
    {v1::EnvelopeFullOptions::GROUND_FULLY_LIT, EnvelopeGround::kFullyLit}};
inline constexpr EnumPairs<v1::EnvelopeFullOptions::Weights, EnvelopeWeights> kWeights = {
    {v1::EnvelopeFullOptions::WEIGHTS_COSINE, EnvelopeWeights::kCosine},
    {v1::EnvelopeFullOptions::WEIGHTS_PLAIN, EnvelopeWeights::kPlain}};
inline constexpr EnumPairs<v1::EnvelopeFullOptions::OwnLeaf, EnvelopeOwnLeaf> kOwnLeaves = {
    {v1::EnvelopeFullOptions::OWN_LEAF_REMOVED, EnvelopeOwnLeaf::kRemoved},
    {v1::EnvelopeFullOptions::OWN_LEAF_KEPT, EnvelopeOwnLeaf::kKept}};
inline constexpr EnumPairs<v1::EnvelopeFullOptions::Border, EnvelopeBorder> kBorders = {
    {v1::EnvelopeFullOptions::BORDER_BY_SCENE, EnvelopeBorder::kByScene},
    {v1::EnvelopeFullOptions::BORDER_ROUND, EnvelopeBorder::kRound},
    {v1::EnvelopeFullOptions::BORDER_LEVEL, EnvelopeBorder::kLevel}};

// 0 leaves the default; a number that nobody knows is a violation.
template <class Wire, class Ours>
void read_enum(const EnumPairs<Wire, Ours>& pairs, Wire wire, const std::string& field,
               Violations& violations, Ours& into) {
  if (wire == static_cast<Wire>(0)) return;
  for (const auto& [theirs, ours] : pairs)
    if (theirs == wire) {
      into = ours;
      return;
    }
  violations.add(field, "unknown value " + std::to_string(wire));
}

template <class Wire, class Ours>
Wire wire_of(const EnumPairs<Wire, Ours>& pairs, Ours value) {
  for (const auto& [theirs, ours] : pairs)
    if (ours == value) return theirs;
  return static_cast<Wire>(0);
}

}  // namespace sunfleck
