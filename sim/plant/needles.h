// The needles of a shoot one by one, for pictures from near by and as a reference: where light computes with
// a cylinder filled with randomly turned needles, this says where each of them could be.
//
// Needles stand in fascicles (one needle in spruce and fir, two in pine, a tuft of some thirty on a short
// shoot in larch) along the axis, the golden angle apart, straight and all of the same size. They lean
// towards the tip by the angle whose sine is shoot radius / needle length, so that they reach the rim of the
// shoot's cylinder; fir combs them left and right into the plane of the spray (of half_v). Tufts spread
// round their short shoot. All needles lie inside the cylinder. Not drawn: the twig, curved needles, gaps
// of shed ones.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/plant/prototype.h"
#include "sim/plant/species.h"

namespace sunfleck {

struct Needle {
  Vec3f base_m, tip_m;
  float radius_m;  // of the round needle of equal girth
};

// What grows on the shoots of a material (latin name of the species).
struct NeedleKind {
  std::string material;
  FoliageTemplate foliage;
};
// Of all species of the library that carry shoots.
std::vector<NeedleKind> needle_kinds(const SpeciesLibrary& library);
// The kind of that material, or null.
const NeedleKind* find_needle_kind(std::span<const NeedleKind> kinds, const std::string& material);

// How many needles the shoot has: those of the template, whatever the shoot's size (a larger shoot has larger
// needles); at least one.
std::size_t needle_count(const FoliageTemplate& foliage);

// Appends them, their one-sided areas (pi length radius each) summing to the shoot's. `number` names the
// shoot's own random numbers (its index in the prototype). Expects a shoot and a template of shoots.
void expand_needles(const FoliageElement& shoot, const FoliageTemplate& foliage, std::uint64_t seed,
                    std::uint64_t number, std::vector<Needle>& needles);

}  // namespace sunfleck
