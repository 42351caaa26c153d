// What leaves and wood of every cell take from the radiance there and give back as sources.
//
// A flat part gets on its two faces, with g its depth in the cell (cell_contents.h),
//   E = pi sum Om_j g_j I_j / sum Om_j g_j   over the directions of the face's side,
// and gives off radiosity B_front = r_f E_front + t_b E_back (and the other way round), adding g_j B / pi to
// the source towards each direction: its own scattering kernel, exact for its angle. What it takes out of the
// radiance and gives back balance exactly for r + t = 1, and even light stays even, on any set of directions.
// The shade and light of the part itself in its own cell are taken out of I, see own_part(). The sources keep
// g and not q: what a part's own depth takes from its own light is what g has more than q.
// A shoot is a body of randomly turned needles that light each other; wood one of even brightness.
#pragma once

#include <span>

#include "lighting/transport/leaf_kernel.h"

namespace sunfleck::transport {

// Light of one order of bounces, and of all so far. Wood: mean incident radiance per WoodCell.
struct Orders {
  std::vector<FacePair> last, total;
  std::vector<float> wood_last, wood_total;
};

// Direct light: per element the irradiance of both faces, per WoodCell what its wood takes.
struct DirectLight {
  std::span<const FacePair> elements;  // empty: none
  std::span<const float> wood;
  double beam_w_m2 = 0;
};

// A medium beside leaves and wood, of which every cell has one of a few kinds: g towards every direction of
// the half set, and the source that goes with it (near: from the half set's directions, far: their
// opposites).
struct Background {
  std::vector<std::uint32_t> of_cell;
  std::vector<Lanes> depth, source_near, source_far;  // per kind
};

class LeafScattering {
 public:
  // `background` may be null.
  LeafScattering(const CellContents& contents, const DirectionLanes& lanes, std::size_t half,
                 double cell_face_m2, std::vector<LeafBand> bands, double bark_reflectance,
                 const Background* background = nullptr);

  // Takes light from `radiance` times `scale` and from `direct`, keeps it in `orders`, and writes the source
  // function of what it gives back to `source` (may be the same memory); both [direction][cell]. Returns the
  // power given back, W.
  double next_order(std::span<const float> radiance, double scale, const DirectLight& direct, Orders& orders,
                    std::span<float> source, const RunControl& control) const;

  // Source function of all orders and `tail` times the last once more.
  void total_source(const Orders& orders, double tail, std::span<float> source,
                    const RunControl& control) const;

  // Radiosity of every part, W m-2, for the same light.
  std::vector<FacePair> total_radiosity(const Orders& orders, double tail, const RunControl& control) const;

  // Power that wood takes in for mean incident radiance 1, W per W m-2 sr-1.
  double wood_intake_m2_sr(std::size_t wood_cell) const;

 private:
  double wood_order(std::size_t wood, CellLight& cell, double scale, const DirectLight& direct,
                    Orders& orders) const;
  template <class PartsVisit, class WoodVisit>
  void for_each_cell(std::span<const float> radiance, std::span<float> source, const RunControl& control,
                     const PartsVisit& parts_visit, const WoodVisit& wood_visit) const;
  void start_cell(std::uint32_t cell, std::span<const float> radiance, CellLight& light) const;
  void finish_cell(std::uint32_t cell, const CellLight& light, std::span<float> source) const;
  void leave_alone(std::uint32_t begin, std::uint32_t end, std::span<float> source) const;
  std::uint32_t next_filled(std::uint32_t cell, std::uint32_t end, std::uint32_t wood) const;

  const CellContents& contents_;
  const DirectionLanes& lanes_;
  const std::size_t half_, cells_;
  const double face_m2_;
  const std::vector<LeafBand> bands_;
  const float bark_reflectance_;
  const Background* const background_;
  // Source function of cells with nothing but background, per kind.
  std::vector<Lanes> alone_near_, alone_far_;
};

}  // namespace sunfleck::transport
