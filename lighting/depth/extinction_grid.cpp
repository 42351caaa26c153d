// See extinction_grid.h.
#include "lighting/depth/extinction_grid.h"

#include <algorithm>
#include <cmath>

#include "lighting/depth/grid_march.h"
#include "lighting/depth/march_lanes.h"
#include "sim/base/contract.h"
#include "sim/base/parallel.h"

namespace sunfleck {

namespace {

constexpr double kLargestCover = 0.9;  // of a cell's face by one contribution
}  // namespace

ExtinctionGrid::ExtinctionGrid(const BlockerField& field, const Vec3& direction, const RunControl& control)
    : field_(field) {
  turn_to(direction, control);
}

void ExtinctionGrid::turn_to(const Vec3& direction, const RunControl& control) {
  SUNFLECK_EXPECTS(std::abs(glm::dot(direction, direction) - 1.0) < 1e-6);
  direction_ = direction;
  field_direction_ = field_.field_direction(direction);
  clamped_ = 0;
  extinction_per_m_.assign(field_.layout().cell_count(), 0.0f);
  add_elements(control);
  add_wood(control);
}

float ExtinctionGrid::extinction_of(double projected_m2) const {
  const double h = field_.layout().mean_cell_m();
  const double cover = std::min(kLargestCover, projected_m2 / (h * h));
  return static_cast<float>(-std::log1p(-cover) / h);
}

void ExtinctionGrid::add_elements(const RunControl& control) {
  const auto& elements = field_.elements();
  own_extinction_per_m_.resize(elements.size());
  for_each_chunk(elements.size(), 8192, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      own_extinction_per_m_[i] = extinction_of(projected_area_m2(elements[i], direction_));
  });
  // Large elements: piece by piece; what falls in the cell of their centre is their own share.
  const double limit_m2 = kLargestCover * std::pow(field_.layout().mean_cell_m(), 2);
  std::uint32_t previous = static_cast<std::uint32_t>(elements.size());
  for (const BlockerPiece& piece : field_.element_pieces()) {
    if (piece.blocker != previous) own_extinction_per_m_[piece.blocker] = 0.0f;
    previous = piece.blocker;
    const double projected = piece.share * projected_area_m2(elements[piece.blocker], direction_);
    clamped_ += projected > limit_m2;
    const float part = extinction_of(projected);
    if (piece.cell == elements[piece.blocker].cell)
      own_extinction_per_m_[piece.blocker] += part;
    else
      extinction_per_m_[piece.cell] += part;
  }
  // In order of the elements, whatever the number of threads: sums of floats depend on it.
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (i % 65536 == 0) control.check();
    extinction_per_m_[elements[i].cell] += own_extinction_per_m_[i];
  }
}

void ExtinctionGrid::add_wood(const RunControl& control) {
  const double limit_m2 = kLargestCover * std::pow(field_.layout().mean_cell_m(), 2);
  std::size_t count = 0;
  for (const BlockerPiece& piece : field_.wood_pieces()) {
    if (++count % 65536 == 0) control.check();
    const double projected = piece.share * projected_area_m2(field_.wood()[piece.blocker], direction_);
    clamped_ += projected > limit_m2;
    extinction_per_m_[piece.cell] += extinction_of(projected);
  }
}

double ExtinctionGrid::depth_from_element(std::size_t element, March march) const {
  const FieldElement& e = field_.elements()[element];
  if (e.below_ground) return kLargestDepth;
  const Vec3 direction = march == March::kForward ? field_direction_ : -field_direction_;
  return march_from_cell(field_.layout(), extinction_per_m_, field_.layout().unflat(e.cell), Vec3(e.centre_m),
                         direction, own_extinction_per_m_[element]);
}

double ExtinctionGrid::depth_from_point(const Vec3& point_m, March march) const {
  const Vec3 direction = march == March::kForward ? field_direction_ : -field_direction_;
  return march_grid(field_.layout(), extinction_per_m_, field_.field_from_world(point_m), direction);
}

void ExtinctionGrid::depths_from_elements(std::span<const std::uint32_t> elements, March march,
                                          float* depths) const {
  if (!lanes_can_march(field_.layout())) {
    for (std::size_t i = 0; i < elements.size(); ++i)
      depths[i] = static_cast<float>(depth_from_element(elements[i], march));
    return;
  }
  const MarchGroup march_group = march_group_best();
  const MarchLine line = march_line(field_.layout(), extinction_per_m_,
                                    march == March::kForward ? field_direction_ : -field_direction_);
  std::array<MarchStart, kMarchLanes> starts;
  std::array<float, kMarchLanes> found;
  for (std::size_t first = 0; first < elements.size(); first += kMarchLanes) {
    const auto group = elements.subspan(first, std::min(kMarchLanes, elements.size() - first));
    for (std::size_t i = 0; i < group.size(); ++i) {
      const FieldElement& e = field_.elements()[group[i]];
      starts[i] = {e.centre_m, e.cell, own_extinction_per_m_[group[i]]};
    }
    march_group(line, std::span(starts).first(group.size()), found.data());
    for (std::size_t i = 0; i < group.size(); ++i)
      depths[first + i] =
          field_.elements()[group[i]].below_ground ? static_cast<float>(kLargestDepth) : found[i];
  }
}

std::vector<float> ExtinctionGrid::depth_of_elements(March march, const RunControl& control) const {
  const std::vector<std::uint32_t>& order = field_.elements_by_cell();
  std::vector<float> depths(order.size());
  // A level ray in a periodic scene takes kMostWraps rounds: small chunks keep the stop token in sight.
  const std::size_t chunk = field_.layout().wraps_xy ? kMarchLanes : 512;
  for_each_chunk(order.size(), chunk, control, "marching the leaf-area grid",
                 [&](std::size_t begin, std::size_t end) {
                   std::vector<float> found(end - begin);
                   depths_from_elements(std::span(order).subspan(begin, end - begin), march, found.data());
                   for (std::size_t i = begin; i < end; ++i) depths[order[i]] = found[i - begin];
                 });
  return depths;
}

}  // namespace sunfleck
