// Opacity map of a prototype for one direction; see opacity_map.h for what a texel holds.
#include "lighting/depth/opacity_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lighting/depth/opacity_pieces.h"

namespace sunfleck {
namespace {

constexpr double kMostCover = 0.99966;  // of a texel by opaque matter: depth 8
constexpr std::size_t kCheckEvery = 2048;

// What is left of a float sum after a subtraction is 0 where only rounding is left.
double without_noise(double difference, double total) { return difference > 1e-6 * total ? difference : 0.0; }

double depth_of_cover(double cover) { return -std::log1p(-std::min(cover, kMostCover)); }

}  // namespace

// Where a piece leaves its mark.
struct OpacityMap::Share {
  std::size_t column, slice;
  double cover;  // of the texel
};

std::size_t opacity_map_bytes(const OpacityLayout& layout) {
  return layout.columns() * (layout.slices + 1) * sizeof(float);
}

std::size_t largest_opacity_map_bytes(int resolution) {
  const auto side = static_cast<std::size_t>(resolution + 1 + 2 * kOpacityMargin);
  return side * side * (kMostOpacitySlices + 1) * sizeof(float);
}

OpacityMap::OpacityMap(const Prototype& prototype, const Vec3& to_light, int resolution,
                       const RunControl& control)
    : layout_(opacity_layout(prototype, to_light, resolution)) {
  cumulated_.assign(layout_.columns() * (layout_.slices + 1), 0.0f);
  measure_angles(prototype);
  add_foliage(prototype, control);
  add_wood(prototype, control);
  cumulate(control);
}

OpacityMap::OpacityMap(const Prototype& prototype, const ElementRows& rows, const Vec3& to_light,
                       int resolution, const RunControl& control)
    : layout_(opacity_layout(prototype, rows, to_light, resolution)) {
  cumulated_.assign(layout_.columns() * (layout_.slices + 1), 0.0f);
  measure_angles(prototype, rows);
  add_rows(prototype, rows, control);
  add_wood(prototype, control);
  cumulate(control);
}

template <class Visit>
void OpacityMap::for_each_share(const Vec3& centre, double area_m2, const Visit& visit) const {
  OpacitySite site;
  if (!layout_.locate(centre, site)) return;
  const double cover = area_m2 / (layout_.texel_m * layout_.texel_m);
  for (std::size_t q = 0; q < 4; ++q)
    if (site.weight[q] > 0.0) visit(Share{site.column[q], site.slice, cover * site.weight[q]});
}

void OpacityMap::add_foliage(const Prototype& prototype, const RunControl& control) {
  std::size_t seen = 0;
  for (const FoliageElement& e : prototype.foliage) {
    if (++seen % kCheckEvery == 0) control.check();
    add_element(e);
  }
}

void OpacityMap::add_element(const FoliageElement& e) {
  for_each_piece(e, layout_.axes.to_light, layout_.texel_m, [&](const Vec3& centre, double area_m2) {
    for_each_share(centre, area_m2, [&](const Share& s) {
      cumulated_[row(s.column) + s.slice + 1] += static_cast<float>(depth_of_cover(s.cover));
    });
  });
}

void OpacityMap::add_wood(const Prototype& prototype, const RunControl& control) {
  if (prototype.wood.empty() && prototype.wood_mesh.empty()) return;
  std::vector<float> cover(cumulated_.size(), 0.0f);
  const auto add = [&](const auto& part) {
    for_each_piece(part, layout_.axes.to_light, layout_.texel_m, [&](const Vec3& centre, double area_m2) {
      for_each_share(centre, area_m2, [&](const Share& s) {
        cover[row(s.column) + s.slice + 1] += static_cast<float>(s.cover);
      });
    });
  };
  std::size_t seen = 0;
  for (const WoodSegment& segment : prototype.wood) {
    if (++seen % kCheckEvery == 0) control.check();
    add(segment);
  }
  for (const WoodTriangle& triangle : prototype.wood_mesh) {
    if (++seen % kCheckEvery == 0) control.check();
    add(triangle);
  }
  for (std::size_t i = 0; i < cover.size(); ++i)
    if (cover[i] > 0.0f) cumulated_[i] += static_cast<float>(depth_of_cover(static_cast<double>(cover[i])));
}

void OpacityMap::cumulate(const RunControl& control) {
  for (std::size_t column = 0; column < layout_.columns(); ++column) {
    if (column % kCheckEvery == 0) control.check();
    float* depth = cumulated_.data() + row(column);
    for (std::size_t k = 1; k <= layout_.slices; ++k) depth[k] += depth[k - 1];
  }
}

void OpacityMap::measure_angles(const Prototype& prototype) {
  double area = 0.0, projected = 0.0, squared = 0.0;
  for (const FoliageElement& e : prototype.foliage) {
    if (!(e.area_m2 > 0.0f)) continue;
    const double shown = projected_area_m2(e, layout_.axes.to_light);
    area += e.area_m2;
    projected += shown;
    squared += e.shape == ElementShape::kShoot ? e.area_m2 / 3.0 : shown * shown / e.area_m2;
  }
  if (!(area > 0.0)) return;  // keep the values of randomly turned leaves
  leaf_projection_ = projected / area;
  mean_square_cosine_ = squared / area;
}

// `own`: what to leave out of each of the four columns, or null.
OpticalDepths OpacityMap::read(const OpacitySite& site, const OpticalDepths* own) const {
  std::array<double, 4> before{};
  double behind = 0.0, least = 0.0;
  for (std::size_t q = 0; q < 4; ++q) {
    const float* depth = cumulated_.data() + row(site.column[q]);
    const double low = depth[site.slice], high = depth[site.slice + 1], total = depth[layout_.slices];
    const double reached = low + site.part * (high - low);
    before[q] = without_noise(reached - (own ? own[q].before : 0.0), total);
    behind += site.weight[q] * without_noise(total - reached - (own ? own[q].behind : 0.0), total);
    least = q == 0 ? before[q] : std::min(least, before[q]);
  }
  // -log of the mean transmission, formed relative to the largest one so that nothing underflows.
  double transmitted = 0.0;
  for (std::size_t q = 0; q < 4; ++q) transmitted += site.weight[q] * std::exp(least - before[q]);
  return {transmitted > 0.0 ? std::max(least - std::log(transmitted), 0.0) : least, behind};
}

OpticalDepths OpacityMap::at(const Vec3& point_m) const {
  OpacitySite site;
  return layout_.locate(point_m, site) ? read(site, nullptr) : OpticalDepths{};
}

OpticalDepths OpacityMap::around(const FoliageElement& element) const {
  OpacitySite site;
  if (!layout_.locate(Vec3(element.centre_m), site)) return {};
  std::array<OpticalDepths, 4> own{};
  const double reached = static_cast<double>(site.slice) + site.part;
  for_each_piece(element, layout_.axes.to_light, layout_.texel_m, [&](const Vec3& centre, double area_m2) {
    for_each_share(centre, area_m2, [&](const Share& s) {
      for (std::size_t q = 0; q < 4; ++q) {
        if (site.column[q] != s.column) continue;
        const double depth = static_cast<float>(depth_of_cover(s.cover));
        const double part = std::clamp(reached - static_cast<double>(s.slice), 0.0, 1.0);
        own[q].before += part * depth;
        own[q].behind += (1.0 - part) * depth;
      }
    });
  });
  return read(site, own.data());
}

}  // namespace sunfleck
