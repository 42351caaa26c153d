// Crowns as they are in forests rather than in textbooks, by one word: [forest] realism = "natural".
//
// Homogeneous ellipsoids with one leaf area density overstate contrasts: too dark below, too bright between.
// What `natural` adds, each from general knowledge and open to change by its own key; nothing is fitted to
// light:
//
// leaf area   by the law of harvested trees (DBH and height; the species file's [leaf_area]) instead of
//             density times crown volume: a suppressed tree with a wide thin crown carries little. Species
//             without such a law: foliage mass by DBH.
// clumps      leaves stand in sprays of 1 m across with 0.6 m2 of leaves each. Clumps of optical depth t in
//             random places have a clumping index (1 - exp(-t)) / t; 0.6 m2 over the 0.79 m2 that such a ball
//             covers is t = 0.45 for leaves near level and 0.4 for all angles alike: 0.80 to 0.82 within
//             crowns, as broadleaf stands show (0.7 to 0.8 with the gaps between crowns: Chen, Menges and
//             Leblanc 2005; recalled).
// elements    of 0.06 m2, ten in a clump, whatever the tree's size.
// rim         density grows in proportion to the distance from the crown's middle: beeches and oaks carry
//             leaves at the ends of branches, their interior is bare (Horn 1971, The adaptive geometry of
//             trees).
// height      density grows in proportion to the height above the crown's base: foliage follows light, and
//             lower branches are sparse before they are shed. Over a crown that is widest in its middle, leaf
//             area per height is then t (t (1 - t)) of its length t, the beta distribution (3, 2) with its
//             mode at 2/3 and its mean at 0.6: beta distributions with the mode in the upper half are what
//             harvested crowns show (Wang, Jarvis and Taylor 1990; Maguire and Bennett 1996; recalled).
// branches    0.1 m2 (half surface) per m2 of leaves besides the stem: woody area is 10 to 20 % of plant area
// in
//             broadleaf stands (Breda 2003, J. Exp. Bot. 54; Dufrene and Breda 1995; recalled).
// understorey from 1 cm DBH up (the threshold of plot censuses, Condit 1998) to the callipering limit of the
//             inventory; see understorey.h.
//
// Holds for broadleaved and mixed stands with crown fill (trees = "crown"). Conifers: shoots are clumped in
// the elements already, so clumps are a larger scale here; no measured stand was tried.
#pragma once

#include "sim/forest/forest_spec.h"

namespace sunfleck {

enum class Realism { kPlain, kNatural };

// Sets the options above (and trees = kCrown); kPlain leaves `spec` as it is.
void apply(Realism realism, ForestSpec& spec);

}  // namespace sunfleck
