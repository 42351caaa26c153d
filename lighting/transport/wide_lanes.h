// Directions of half a set in one wide register, or in two narrow ones on machines without: for functions
// that are compiled for several machines. All by reference, for no two of those agree how such values are
// passed.
#pragma once

#include <cstdint>
#include <cstring>

#include "lighting/transport/cell_contents.h"

namespace sunfleck::transport {

typedef float WideLanes __attribute__((vector_size(sizeof(Lanes))));
typedef std::int32_t WideMask __attribute__((vector_size(sizeof(Lanes))));

[[gnu::always_inline]] inline void load_wide(WideLanes& wide, const Lanes& lanes) {
  std::memcpy(&wide, lanes.data(), sizeof wide);
}
[[gnu::always_inline]] inline void store_wide(Lanes& lanes, const WideLanes& wide) {
  std::memcpy(lanes.data(), &wide, sizeof wide);
}
[[gnu::always_inline]] inline void absolute_wide(WideLanes& value) {
  const WideMask bits = reinterpret_cast<const WideMask&>(value) & 0x7fffffff;
  std::memcpy(&value, &bits, sizeof value);
}

// Lanes of a value that are below zero, bit by bit: the compiler takes masks of comparisons apart where more
// than one choice hangs on them.
[[gnu::always_inline]] inline void negative_lanes(WideMask& negative, const WideLanes& value) {
  WideMask bits;
  std::memcpy(&bits, &value, sizeof bits);
  negative = bits >> 31;
}
[[gnu::always_inline]] inline void choose_wide(WideLanes& chosen, const WideMask& negative,
                                               const WideLanes& where_negative, const WideLanes& elsewhere) {
  WideMask a, b;
  std::memcpy(&a, &where_negative, sizeof a);
  std::memcpy(&b, &elsewhere, sizeof b);
  const WideMask bits = (a & negative) | (b & ~negative);
  std::memcpy(&chosen, &bits, sizeof chosen);
}

// Sums of three values in the order of sum_of().
[[gnu::always_inline]] inline void sums_wide(const WideLanes& a, const WideLanes& b, const WideLanes& c,
                                             float (&sums)[3]) {
  typedef float Eight __attribute__((vector_size(32)));
  typedef float Four __attribute__((vector_size(16)));
  const WideLanes* const all[3] = {&a, &b, &c};
  for (int i = 0; i < 3; ++i) {
    const Eight eight = __builtin_shufflevector(*all[i], *all[i], 0, 1, 2, 3, 4, 5, 6, 7) +
                        __builtin_shufflevector(*all[i], *all[i], 8, 9, 10, 11, 12, 13, 14, 15);
    const Four four =
        __builtin_shufflevector(eight, eight, 0, 1, 2, 3) + __builtin_shufflevector(eight, eight, 4, 5, 6, 7);
    sums[i] = (four[0] + four[2]) + (four[1] + four[3]);
  }
}

}  // namespace sunfleck::transport
