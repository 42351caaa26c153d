// How the leaves and the wood of a prototype stand to the directions of a set, on average over their angles
// and over 16 azimuths of the tree: cover towards each direction, and per band the scattering between them.
//
// A leaf with normal n gets on its face E = pi sum Om_k |n.w_k| I_k / sum Om_k |n.w_k| over the directions of
// that face's side, gives off radiosity B by its own reflectance and transmittance, and adds |n.w_j| B / pi
// to the source towards j (leaf_scattering.h); the kernel is the area-weighted mean of these. With r + t = 1
// even light stays even.
#pragma once

#include "lighting/transport/leaf_scattering.h"
#include "lighting/transport/world_prototype.h"

namespace sunfleck::transport {

// Both directions of a pair: entry j for direction j of the half set, kLanes + j for its opposite.
inline constexpr std::size_t kBothLanes = 2 * kLanes;
using BothLanes = std::array<float, kBothLanes>;

// Kinds of content of a world cell: leaves and wood of every prototype.
inline std::uint32_t leaf_kind(std::size_t prototype) { return 2 * static_cast<std::uint32_t>(prototype); }
inline std::uint32_t wood_kind(std::size_t prototype) { return leaf_kind(prototype) + 1; }

// Mean projected area over area, per half direction.
Lanes leaf_cover(const WorldPrototype& prototype, const DirectionSet& set);
Lanes wood_cover(const WorldPrototype& prototype, const DirectionSet& set);

inline constexpr std::size_t kMostHalf = 13;  // directions in half of the largest set

// Everything per effective area of a kind.
struct alignas(64) KindKernel {
  // Where both faces of all leaves scatter alike: half the kernels of sum and difference of a pair.
  bool faces_alike = false;
  alignas(64) std::array<Lanes, kMostHalf> even{}, odd{};
  alignas(64) std::array<BothLanes, kBothLanes> source{};  // [from][to], of radiance
  alignas(64) BothLanes absorbed{}, irradiance{};          // W m-2 per radiance; irradiance: front + back
  // The same for a beam of 1 W m-2.
  alignas(64) BothLanes sun_source{};
  float sun_absorbed = 0, sun_irradiance = 0, sun_cover = 0;
};

// By kind, for one band. `to_sun`: unit. `optics` of the forest the prototypes are from.
struct WorldKernels {
  std::vector<KindKernel> kinds;
};
WorldKernels world_kernels(const std::vector<WorldPrototype>& prototypes, const DirectionSet& set,
                           const OpticsTable& optics, std::size_t band, const Vec3& to_sun,
                           const RunControl& control);

}  // namespace sunfleck::transport
