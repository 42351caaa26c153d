#include "lighting/render/billboard_atlas.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "lighting/shade/billboard_query.h"
#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

constexpr int kSamples = 4;  // per side of a texel

// Rows of planes, the highest first; nothing where they do not fit.
std::optional<std::vector<AtlasPlace>> packed(const BillboardCloud& cloud, int side_px, double texel_m) {
  std::vector<AtlasPlace> places;
  for (const Billboard& b : cloud.plane)
    places.push_back({0, 0, std::max(1, static_cast<int>(std::ceil(b.width_m / texel_m))),
                      std::max(1, static_cast<int>(std::ceil(b.height_m / texel_m)))});
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return places[a].height > places[b].height; });
  int x = 1, y = 1, row = 0;
  for (const std::size_t k : order) {
    AtlasPlace& p = places[k];
    if (x + p.width + 1 > side_px) x = 1, y += row + 1, row = 0;
    if (x + p.width + 1 > side_px || y + p.height + 1 > side_px) return std::nullopt;
    p.x = x, p.y = y;
    x += p.width + 1;
    row = std::max(row, p.height);
  }
  return places;
}

// Seen straight on, where relief shifts nothing.
bool is_covered(const BillboardCloud& cloud, std::uint32_t plane, double u_m, double v_m) {
  const Billboard& b = cloud.plane[plane];
  const Vec3 above = b.corner_m + u_m * b.along_u + v_m * b.along_v + (b.relief_m + 1) * b.normal;
  return billboard_at(cloud, plane, above, -b.normal, 0).has_value();
}

std::uint8_t texel_cover(const BillboardCloud& cloud, std::uint32_t plane, const AtlasPlace& place,
                         int column, int row) {
  const Billboard& b = cloud.plane[plane];
  int covered = 0;
  for (int j = 0; j < kSamples; ++j)
    for (int i = 0; i < kSamples; ++i) {
      const double u = (column + (i + 0.5) / kSamples) / place.width * b.width_m;
      const double v = (1 - (row + (j + 0.5) / kSamples) / place.height) * b.height_m;
      covered += is_covered(cloud, plane, u, v);
    }
  return static_cast<std::uint8_t>(std::lround(255.0 * covered / (kSamples * kSamples)));
}

}  // namespace

BillboardAtlas bake_atlas(const BillboardCloud& cloud, int side_px, const RunControl& control) {
  BillboardAtlas atlas;
  atlas.side_px = side_px;
  double area_m2 = 0;
  for (const Billboard& b : cloud.plane) area_m2 += b.width_m * b.height_m;
  std::optional<std::vector<AtlasPlace>> places;
  for (atlas.texel_m = std::sqrt(area_m2) / side_px; !places; atlas.texel_m *= 1.02)
    places = packed(cloud, side_px, atlas.texel_m);
  atlas.texel_m /= 1.02;
  atlas.place = std::move(*places);
  const auto side = static_cast<std::size_t>(side_px);
  atlas.cover.assign(side * side, 0);
  for_each_chunk(cloud.plane.size(), 1, control, "baking billboards",
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t k = begin; k < end; ++k) {
                     const AtlasPlace& p = atlas.place[k];
                     for (int row = 0; row < p.height; ++row) {
                       control.check();
                       for (int column = 0; column < p.width; ++column)
                         atlas.cover[static_cast<std::size_t>(p.y + row) * side +
                                     static_cast<std::size_t>(p.x + column)] =
                             texel_cover(cloud, static_cast<std::uint32_t>(k), p, column, row);
                     }
                   }
                 });
  return atlas;
}

AlphaCutoff keeping_cover(const BillboardAtlas& atlas) {
  std::array<double, 256> with{};
  double wanted = 0;
  for (const std::uint8_t c : atlas.cover) with[c] += 1, wanted += c / 255.0;
  AlphaCutoff best{1, 0};
  if (!(wanted > 0)) return {1, 1};
  double above = 0;
  for (int least = 255; least >= 1; --least) {
    above += with[static_cast<std::size_t>(least)];
    if (std::abs(above / wanted - 1) < std::abs(best.kept - 1)) best = {least, above / wanted};
  }
  return best;
}

}  // namespace sunfleck
