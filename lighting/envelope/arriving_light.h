// Light that arrives at one leaf, point or ground cell along every sector, from its depths alone.
//
// With T_k = exp(-D_k), lights L_k = sky + ground share times the ground's radiance where sector k ends, and
// J of closed_forms.h, foliage along sector j shows the radiance
//   (sum_k turn_jk L_k J(D_k, c_jk, D_j) + sun_j E J(D_sun, c_jsun, D_j)) / (1 - a p),
// p = 1 - sum_k Om_k T_k / (4 pi) the chance that scattered light meets foliage again.
#pragma once

#include <array>

#include "lighting/envelope/envelope_sources.h"

namespace sunfleck::envelope {

// Who receives.
struct Receiver {
  std::span<const float> depths;  // towards the set's directions
  double sun_depth = 0;
  Vec3 field_point_m{0};
  PrototypeId neighbours;
  std::int32_t ground_cell = GroundCells::kOpen;  // of a ground point: what it sees below itself
  bool is_ground = false;
};

using SectorRow = std::array<float, kMostSectors>;

// Of one band, W m-2 sr-1.
struct ArrivingBand {
  alignas(64) SectorRow sky{}, ground{}, foliage{};
};

class ArrivingLight {
 public:
  ArrivingLight(const PreparedParts& parts, const Sources& sources);

  // Fills bands() for a receiver.
  void receive(const Receiver& receiver);

  const std::vector<ArrivingBand>& bands() const { return bands_; }
  double recollision() const { return recollision_; }

 private:
  void find_ground(const Receiver& receiver);
  void set_lights();
  void add_bounces(const Receiver& receiver);

  const PreparedParts& parts_;
  const Sources& sources_;
  alignas(64) SectorRow depth_{}, through_{}, integral_{};
  std::array<std::size_t, kMostSectors> ground_{};  // cell that sector k ends on; the last for open ground
  std::vector<ArrivingBand> bands_;
  std::vector<SectorRow> lights_;  // by band
  double recollision_ = 0;
};

}  // namespace sunfleck::envelope
