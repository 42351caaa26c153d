// See leaf_scattering.h.
#include "lighting/transport/leaf_scattering.h"

#include <algorithm>
#include <cmath>

#include "sim/base/contract.h"
#include "sim/base/parallel.h"

namespace sunfleck::transport {

namespace {

constexpr float kPiF = static_cast<float>(kPi);

FacePair with_tail(const FacePair& total, const FacePair& last, double tail) {
  return {total.front + static_cast<float>(tail) * last.front,
          total.back + static_cast<float>(tail) * last.back};
}

}  // namespace

std::vector<LeafBand> leaf_bands(const Forest& forest, const OpticsTable& optics, std::size_t band) {
  std::vector<LeafBand> bands;
  for (std::size_t p = 0; p < forest.prototypes.size(); ++p) {
    for (std::size_t m = 0; m < forest.prototypes[p].materials.size(); ++m) {
      const LeafOptics& leaf = optics.material(band, {static_cast<std::uint32_t>(p)}, m).leaf;
      bands.push_back({.reflectance_front = static_cast<float>(leaf.reflectance_front),
                       .reflectance_back = static_cast<float>(leaf.reflectance_back),
                       .transmittance_front = static_cast<float>(leaf.transmittance_front),
                       .transmittance_back = static_cast<float>(leaf.transmittance_back),
                       .albedo = static_cast<float>(leaf.albedo())});
    }
  }
  return bands;
}

double mean_bark_reflectance(const Forest& forest, const OpticsTable& optics, std::size_t band) {
  double area = 0.0, reflected = 0.0;
  for (std::size_t p = 0; p < forest.prototypes.size(); ++p) {
    const auto add = [&](double part_m2, std::uint32_t material) {
      area += part_m2;
      reflected +=
          part_m2 * optics.material(band, {static_cast<std::uint32_t>(p)}, material).bark_reflectance;
    };
    for (const WoodSegment& s : forest.prototypes[p].wood)
      add(kPi * (s.radius_from_m + s.radius_to_m) * glm::length(Vec3(s.to_m) - Vec3(s.from_m)), s.material);
    for (const WoodTriangle& t : forest.prototypes[p].wood_mesh)
      add(0.5 * glm::length(glm::cross(Vec3(t.b_m) - Vec3(t.a_m), Vec3(t.c_m) - Vec3(t.a_m))), t.material);
  }
  return area > 0.0 ? reflected / area : 0.0;
}

// Radiance and sources of one cell: `near` from the directions of the half set, `far` from their opposites.
struct LeafScattering::Cell {
  alignas(64) Lanes near{}, far{}, source_near{}, source_far{}, depth{};

  void deposit(const Lanes& cosine, const Lanes& part_depth, const FacePair& radiosity) {
    const float front = radiosity.front / kPiF, back = radiosity.back / kPiF;
    for (std::size_t j = 0; j < kLanes; ++j) {
      // Light arriving from w travels along -w: off the back where w is on the front's side.
      const bool on_front = cosine[j] >= 0.0f;
      source_near[j] += part_depth[j] * (on_front ? back : front);
      source_far[j] += part_depth[j] * (on_front ? front : back);
      depth[j] += part_depth[j];
    }
  }
};

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
      background_(background) {}

void LeafScattering::part_depths(const LeafPart& part, Lanes& cosine, Lanes& depth) const {
  if (part.shoot > 0) return shoot_depths(contents_.shoots[part.shoot - 1], lanes_, cosine, depth);
  cosines_of(part, lanes_, cosine);
  depths_of(part.cover, lanes_, cosine, depth);
}

FacePair LeafScattering::face_light(const LeafPart& part, const Cell& cell, const Lanes& cosine,
                                    const Lanes& depth, double scale, const FacePair& sent,
                                    const DirectLight& direct) const {
  // What reaches the front travels as what the part sends off its back.
  const float sent_front = sent.front / kPiF, sent_back = sent.back / kPiF;
  alignas(64) Lanes weight, front, back;
  for (std::size_t j = 0; j < kLanes; ++j) {
    const bool on_front = cosine[j] >= 0.0f;
    const float own = own_part(depth[j], lanes_.step_cells[j]);
    const float to_front = on_front ? cell.near[j] : cell.far[j];
    const float to_back = on_front ? cell.far[j] : cell.near[j];
    weight[j] = lanes_.solid_angle_sr[j] * depth[j];
    front[j] = weight[j] * std::max(0.0f, to_front + own * (to_front - sent_back));
    back[j] = weight[j] * std::max(0.0f, to_back + own * (to_back - sent_front));
  }
  const float per_radiance = static_cast<float>(scale) * kPiF / sum_of(weight);
  FacePair light{per_radiance * sum_of(front), per_radiance * sum_of(back)};
  const ShootPart* shoot = part.shoot > 0 ? &contents_.shoots[part.shoot - 1] : nullptr;
  if (shoot != nullptr) light.front = light.back = shoot->escape * 0.5f * (light.front + light.back);
  if (!direct.elements.empty()) {
    light.front += static_cast<float>(direct.beam_w_m2) * direct.elements[part.element].front;
    light.back += static_cast<float>(direct.beam_w_m2) * direct.elements[part.element].back;
  }
  if (shoot == nullptr) return light;
  const float gain = shoot_gain(bands_[part.optics].albedo, shoot->escape);
  return {gain * light.front, gain * light.back};
}

FacePair LeafScattering::radiosity(const LeafPart& part, const FacePair& light) const {
  const LeafBand& leaf = bands_[part.optics];
  if (part.shoot > 0) {
    const float even = 0.5f * leaf.albedo * (light.front + light.back);
    return {even, even};
  }
  return {leaf.reflectance_front * light.front + leaf.transmittance_back * light.back,
          leaf.reflectance_back * light.back + leaf.transmittance_front * light.front};
}

std::vector<FacePair> LeafScattering::total_radiosity(const Orders& orders, double tail,
                                                      const RunControl& control) const {
  std::vector<FacePair> given(orders.total.size());
  for_each_chunk(given.size(), 16384, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      given[p] = radiosity(contents_.parts[p], with_tail(orders.total[p], orders.last[p], tail));
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

double LeafScattering::wood_order(std::size_t index, Cell& cell, double scale, const DirectLight& direct,
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

template <class PartVisit, class WoodVisit>
void LeafScattering::for_each_cell(std::span<const float> radiance, std::span<float> source,
                                   const RunControl& control, const PartVisit& part_visit,
                                   const WoodVisit& wood_visit) const {
  const auto& first_part = contents_.first_part;
  for_each_chunk(contents_.ranges.size(), 1, control, {}, [&](std::size_t r, std::size_t) {
    const CellRange& range = contents_.ranges[r];
    std::uint32_t wood = range.wood_begin;
    for (std::uint32_t c = range.begin; c < range.end; ++c) {
      const bool has_wood = wood < range.wood_end && contents_.wood[wood].cell == c;
      if (first_part[c] == first_part[c + 1] && !has_wood && background_ == nullptr) {
        for (std::size_t d = 0; d < 2 * half_; ++d) source[d * cells_ + c] = 0.0f;
        continue;
      }
      Cell cell;
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
      for (std::uint32_t p = first_part[c]; p < first_part[c + 1]; ++p) part_visit(r, p, cell);
      if (has_wood) {
        const float glow = bark_reflectance_ * wood_visit(r, wood, cell);
        for (std::size_t j = 0; j < half_; ++j) {
          cell.source_near[j] += glow * contents_.wood[wood].depth[j];
          cell.source_far[j] += glow * contents_.wood[wood].depth[j];
          cell.depth[j] += contents_.wood[wood].depth[j];
        }
        ++wood;
      }
      for (std::size_t j = 0; j < half_; ++j) {
        // Nothing at all is in many cells of a background.
        const float per_depth = cell.depth[j] > 0.0f ? 1.0f / cell.depth[j] : 0.0f;
        source[j * cells_ + c] = cell.source_near[j] * per_depth;
        source[(half_ + j) * cells_ + c] = cell.source_far[j] * per_depth;
      }
    }
  });
}

double LeafScattering::next_order(std::span<const float> radiance, double scale, const DirectLight& direct,
                                  Orders& orders, std::span<float> source, const RunControl& control) const {
  orders.last.resize(contents_.parts.size());
  orders.total.resize(contents_.parts.size());
  orders.wood_last.resize(contents_.wood.size());
  orders.wood_total.resize(contents_.wood.size());
  std::vector<double> power(contents_.ranges.size(), 0.0);
  for_each_cell(
      radiance, source, control,
      [&](std::size_t range, std::size_t p, Cell& cell) {
        const LeafPart& part = contents_.parts[p];
        alignas(64) Lanes cosine, depth;
        part_depths(part, cosine, depth);
        const FacePair sent = radiosity(part, orders.last[p]);
        const FacePair light = face_light(part, cell, cosine, depth, scale, sent, direct);
        const FacePair given = radiosity(part, light);
        cell.deposit(cosine, depth, given);
        orders.last[p] = light;
        orders.total[p].front += light.front;
        orders.total[p].back += light.back;
        power[range] += static_cast<double>(part.cover) * (given.front + given.back);
      },
      [&](std::size_t range, std::size_t wood, Cell& cell) {
        power[range] += wood_order(wood, cell, scale, direct, orders) / face_m2_;
        return orders.wood_last[wood];
      });
  double sum = 0.0;
  for (const double p : power) sum += p * face_m2_;
  return sum;
}

void LeafScattering::total_source(const Orders& orders, double tail, std::span<float> source,
                                  const RunControl& control) const {
  for_each_cell(
      {}, source, control,
      [&](std::size_t, std::size_t p, Cell& cell) {
        const LeafPart& part = contents_.parts[p];
        alignas(64) Lanes cosine, depth;
        part_depths(part, cosine, depth);
        const FacePair light = with_tail(orders.total[p], orders.last[p], tail);
        cell.deposit(cosine, depth, radiosity(part, light));
      },
      [&](std::size_t, std::size_t wood, Cell&) {
        return orders.wood_total[wood] + static_cast<float>(tail) * orders.wood_last[wood];
      });
}

}  // namespace sunfleck::transport
