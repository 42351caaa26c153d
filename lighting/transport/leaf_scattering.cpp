// See leaf_scattering.h.
#include "lighting/transport/leaf_scattering.h"

#include <algorithm>

#include "sim/base/parallel.h"

namespace sunfleck::transport {

namespace {

FacePair with_tail(const FacePair& total, const FacePair& last, double tail) {
  return {total.front + static_cast<float>(tail) * last.front,
          total.back + static_cast<float>(tail) * last.back};
}

// Sources over depths. Nothing at all is in many cells of a background.
void source_function(const Lanes& sources, const Lanes& depth, std::size_t half, Lanes& function) {
  for (std::size_t j = 0; j < half; ++j)
    function[j] = depth[j] > 0.0f ? sources[j] * (1.0f / depth[j]) : 0.0f;
}

}  // namespace

LeafScattering::LeafScattering(const CellContents& contents, const DirectionLanes& lanes, std::size_t half,
                               double cell_face_m2, std::vector<LeafBand> bands, double bark_reflectance,
                               const Background* background)
    : contents_(contents),
      lanes_(lanes),
      half_(half),
      cells_(contents.first_part.size() - 1),
      face_m2_(cell_face_m2),
      bands_(std::move(bands)),
      bark_reflectance_(static_cast<float>(bark_reflectance)),
      background_(background) {
  if (background == nullptr) return;
  alone_near_.resize(background->depth.size());
  alone_far_.resize(background->depth.size());
  for (std::size_t k = 0; k < background->depth.size(); ++k) {
    source_function(background->source_near[k], background->depth[k], half_, alone_near_[k]);
    source_function(background->source_far[k], background->depth[k], half_, alone_far_[k]);
  }
}

std::vector<FacePair> LeafScattering::total_radiosity(const Orders& orders, double tail,
                                                      const RunControl& control) const {
  std::vector<FacePair> given(orders.total.size());
  for_each_chunk(given.size(), 16384, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      given[p] = radiosity_of(bands_[contents_.parts[p].optics], contents_.parts[p].shoot > 0,
                              with_tail(orders.total[p], orders.last[p], tail));
  });
  return given;
}

double LeafScattering::wood_intake_m2_sr(std::size_t wood_cell) const {
  const WoodCell& wood = contents_.wood[wood_cell];
  double sum = 0.0;
  for (std::size_t j = 0; j < half_; ++j)
    sum += 2.0 * static_cast<double>(lanes_.solid_angle_sr[j]) * wood.depth[j];
  return sum * face_m2_;
}

double LeafScattering::wood_order(std::size_t index, CellLight& cell, double scale, const DirectLight& direct,
                                  Orders& orders) const {
  const WoodCell& wood = contents_.wood[index];
  float arriving = 0.0f, weight = 0.0f;
  for (std::size_t j = 0; j < half_; ++j) {
    arriving += lanes_.solid_angle_sr[j] * wood.depth[j] * (cell.near[j] + cell.far[j]);
    weight += 2.0f * lanes_.solid_angle_sr[j] * wood.depth[j];
  }
  float radiance = static_cast<float>(scale) * arriving / weight;
  if (!direct.wood.empty()) radiance += static_cast<float>(direct.beam_w_m2) * direct.wood[index] / weight;
  orders.wood_last[index] = radiance;
  orders.wood_total[index] += radiance;
  return static_cast<double>(bark_reflectance_) * radiance * weight * face_m2_;
}

void LeafScattering::start_cell(std::uint32_t c, std::span<const float> radiance, CellLight& cell) const {
  if (background_ != nullptr) {
    const std::uint32_t kind = background_->of_cell[c];
    cell.depth = background_->depth[kind];
    cell.source_near = background_->source_near[kind];
    cell.source_far = background_->source_far[kind];
  }
  for (std::size_t j = 0; j < half_ && !radiance.empty(); ++j) {
    cell.near[j] = radiance[j * cells_ + c];
    cell.far[j] = radiance[(half_ + j) * cells_ + c];
  }
}

void LeafScattering::finish_cell(std::uint32_t c, const CellLight& cell, std::span<float> source) const {
  Lanes near, far;
  source_function(cell.source_near, cell.depth, half_, near);
  source_function(cell.source_far, cell.depth, half_, far);
  for (std::size_t j = 0; j < half_; ++j) {
    source[j * cells_ + c] = near[j];
    source[(half_ + j) * cells_ + c] = far[j];
  }
}

void LeafScattering::leave_alone(std::uint32_t begin, std::uint32_t end, std::span<float> source) const {
  for (std::size_t j = 0; j < half_; ++j) {
    float* near = source.data() + j * cells_;
    float* far = source.data() + (half_ + j) * cells_;
    if (background_ == nullptr) {
      std::fill(near + begin, near + end, 0.0f);
      std::fill(far + begin, far + end, 0.0f);
      continue;
    }
    const std::uint32_t* kind = background_->of_cell.data();
    for (std::uint32_t c = begin; c < end; ++c) {
      near[c] = alone_near_[kind[c]][j];
      far[c] = alone_far_[kind[c]][j];
    }
  }
}

// First cell from `cell` on, and before `end`, that holds a part or wood; `wood` is the next entry of wood.
std::uint32_t LeafScattering::next_filled(std::uint32_t cell, std::uint32_t end, std::uint32_t wood) const {
  const std::uint32_t next_wood =
      wood < contents_.wood.size() ? std::min(end, contents_.wood[wood].cell) : end;
  while (cell < next_wood && contents_.first_part[cell] == contents_.first_part[cell + 1]) ++cell;
  return cell;
}

template <class PartsVisit, class WoodVisit>
void LeafScattering::for_each_cell(std::span<const float> radiance, std::span<float> source,
                                   const RunControl& control, const PartsVisit& parts_visit,
                                   const WoodVisit& wood_visit) const {
  const auto& first_part = contents_.first_part;
  for_each_chunk(contents_.ranges.size(), 1, control, {}, [&](std::size_t r, std::size_t) {
    const CellRange& range = contents_.ranges[r];
    std::uint32_t wood = range.wood_begin;
    for (std::uint32_t c = range.begin; c < range.end; ++c) {
      const std::uint32_t filled = next_filled(c, range.end, wood);
      leave_alone(c, filled, source);
      c = filled;
      if (c == range.end) break;
      const bool has_wood = wood < range.wood_end && contents_.wood[wood].cell == c;
      CellLight cell;
      start_cell(c, radiance, cell);
      parts_visit(r, first_part[c], first_part[c + 1], cell);
      if (has_wood) {
        const float glow = bark_reflectance_ * wood_visit(r, wood, cell);
        for (std::size_t j = 0; j < half_; ++j) {
          cell.source_near[j] += glow * contents_.wood[wood].depth[j];
          cell.source_far[j] += glow * contents_.wood[wood].depth[j];
          cell.depth[j] += contents_.wood[wood].depth[j];
        }
        ++wood;
      }
      finish_cell(c, cell, source);
    }
  });
}

double LeafScattering::next_order(std::span<const float> radiance, double scale, const DirectLight& direct,
                                  Orders& orders, std::span<float> source, const RunControl& control) const {
  orders.last.resize(contents_.parts.size());
  orders.total.resize(contents_.parts.size());
  orders.wood_last.resize(contents_.wood.size());
  orders.wood_total.resize(contents_.wood.size());
  const LeafOrder order{.parts = contents_.parts.data(),
                        .shoots = contents_.shoots.data(),
                        .bands = bands_.data(),
                        .direct = direct.elements.empty() ? nullptr : direct.elements.data(),
                        .beam_w_m2 = static_cast<float>(direct.beam_w_m2),
                        .scale = static_cast<float>(scale),
                        .last = orders.last.data(),
                        .total = orders.total.data()};
  const ScatterLeaves scatter_leaves = scatter_leaves_best();
  std::vector<double> power(contents_.ranges.size(), 0.0);
  for_each_cell(
      radiance, source, control,
      [&](std::size_t range, std::uint32_t begin, std::uint32_t end, CellLight& cell) {
        power[range] += scatter_leaves(order, lanes_, begin, end, cell);
      },
      [&](std::size_t range, std::size_t wood, CellLight& cell) {
        power[range] += wood_order(wood, cell, scale, direct, orders) / face_m2_;
        return orders.wood_last[wood];
      });
  double sum = 0.0;
  for (const double p : power) sum += p * face_m2_;
  return sum;
}

void LeafScattering::total_source(const Orders& orders, double tail, std::span<float> source,
                                  const RunControl& control) const {
  const std::vector<FacePair> given = total_radiosity(orders, tail, control);
  const LeafOrder order{.parts = contents_.parts.data(), .shoots = contents_.shoots.data()};
  const EmitLeaves emit_leaves = emit_leaves_best();
  for_each_cell(
      {}, source, control,
      [&](std::size_t, std::uint32_t begin, std::uint32_t end, CellLight& cell) {
        emit_leaves(order, lanes_, given.data(), begin, end, cell);
      },
      [&](std::size_t, std::size_t wood, CellLight&) {
        return orders.wood_total[wood] + static_cast<float>(tail) * orders.wood_last[wood];
      });
}

}  // namespace sunfleck::transport
