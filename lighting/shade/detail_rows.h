// What was measured of pruned trees in pictures: the table that pictures choose their levels of detail by.
//
// Measured anew by the program `lighting_render_detail_table` (tests/bench/render), which prints rows in the
// form they have in detail_rows.cpp.
#pragma once

#include <vector>

#include "lighting/shade/choose_detail.h"

namespace sunfleck {

// For flat leaves. Errors are those of the worst tree measured, over the pixels that the tree touches, noise
// taken out, with kDetailCasts prunings per tree; costs a mean over species, CPU of one thread.
std::vector<MeasuredDetail> measured_detail();

// How many different prunings of a tree a picture's samples take in turn: their mean errs by the root of this
// number less than one of them.
inline constexpr int kDetailCasts = 4;

}  // namespace sunfleck
