#include "lighting/render/leaf_flecks.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>

namespace sunfleck {
namespace {

constexpr std::size_t kPoints = 20;  // of a leaf, to find its threshold

// Evenly spread over the unit cube (additive recurrence with the plastic numbers of three dimensions).
Vec3 spread_point(std::size_t i) {
  const Vec3 p =
      (static_cast<double>(i) + 0.5) * Vec3(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
  return p - glm::floor(p);
}

// A point of an element in the tree's frame, and whether it belongs to it: coordinates (a, b) in [-1, 1]
// along the half edges; of a shoot a place in its cylinder.
Vec3 element_point(const FoliageElement& e, const Vec3& number) {
  const Vec3 u(e.half_u_m), v(e.half_v_m);
  const double a = 2 * number.x - 1, b = 2 * number.y - 1;
  if (e.shape != ElementShape::kShoot) return Vec3(e.centre_m) + a * u + b * v;
  const Vec3 w = glm::length(u) > 0 ? glm::cross(glm::normalize(u), v) : v;
  const double r = std::sqrt(number.y), turn = 2 * kPi * number.z;
  return Vec3(e.centre_m) + a * u + r * (std::cos(turn) * v + std::sin(turn) * w);
}

bool is_on_leaf(const FoliageElement& e, const MaterialLook& look, const Vec3& number) {
  if (e.shape == ElementShape::kShoot) return true;
  const double a = 2 * number.x - 1, b = 2 * number.y - 1;
  if (e.shape == ElementShape::kParallelogram && look.changes_outline()) return look.is_inside({a, b});
  return leaf_covers(e.shape, a, b);
}

struct LeafPoints {
  std::array<Vec3, kPoints> at;
  std::size_t count = 0;
};

// In the world, for the size of the tile's leaves.
LeafPoints points_on(const FoliageElement& e, const MaterialLook& look, const Instance& tree) {
  LeafPoints points;
  for (std::size_t i = 0; i < 8 * kPoints && points.count < kPoints; ++i) {
    const Vec3 number = spread_point(i);
    if (is_on_leaf(e, look, number))
      points.at[points.count++] =
          world_from_tree(tree, element_point(e, number)) / static_cast<double>(tree.scale);
  }
  return points;
}

std::uint32_t offset_of(std::size_t element, std::uint32_t candidate) {
  return leaf_offset(static_cast<std::uint32_t>(2 * element + candidate));
}

// The value above which `share` of the population lies that `rank` was drawn from: of n points the k-th from
// above has (k - a) / (n + 1 - 2 a) above it on average, a = 0 for random points, .5 for points that divide
// the leaf evenly; .3 is between, since ranks vary within a leaf. Between them, and beyond the ends,
// linearly.
float quantile_from_above(std::span<float> rank, float share) {
  std::sort(rank.begin(), rank.end(), std::greater<>());
  if (rank.size() == 1) return 1 - share;
  constexpr float a = 0.3f;
  const float at = share * (static_cast<float>(rank.size()) + 1 - 2 * a) + a - 1;
  const auto low = static_cast<std::size_t>(std::clamp(at, 0.0f, static_cast<float>(rank.size()) - 2));
  return std::lerp(rank[low], rank[low + 1], at - static_cast<float>(low));
}

float threshold_of(const LeafPoints& points, const TileView& view, std::uint32_t offset, float share) {
  if (points.count == 0) return 1 - share;
  std::array<float, kPoints> rank;
  for (std::size_t i = 0; i < points.count; ++i) rank[i] = tile_rank_between(view, points.at[i], offset);
  return quantile_from_above({rank.data(), points.count}, share);
}

std::string kind_of(const Prototype& prototype) {
  const FoliageElement& e = prototype.foliage.front();
  return prototype.materials[e.material] + '/' + std::to_string(static_cast<int>(e.shape));
}

}  // namespace

bool knows_single_leaves(const LightMap& map) {
  const std::string& method = map.provenance.method;
  const std::array<const char*, 5> smooth{"grid", "world", "spp", "envelope", "single_scattering"};
  return std::none_of(smooth.begin(), smooth.end(), [&](const char* m) { return method.rfind(m, 0) == 0; });
}

LeafFlecks::LeafFlecks(const Forest& forest, const PictureScene& scene, const LightMap& map,
                       const Vec3& to_sun, const RunControl& control)
    : scene_(scene),
      share_(map.sunlit_fraction),
      of_leaves_(knows_single_leaves(map)),
      patch_(of_leaves_ ? share_.size() : 0) {
  make_sheets(forest, to_sun, control);
  double sum = 0;
  for (const float share : share_) sum += static_cast<double>(share);
  usual_threshold_ =
      static_cast<float>(1 - sum / static_cast<double>(std::max<std::size_t>(share_.size(), 1)));
}

void LeafFlecks::make_sheets(const Forest& forest, const Vec3& to_sun, const RunControl& control) {
  std::map<std::string, std::size_t> known;
  for (const Prototype& prototype : forest.prototypes) {
    sheet_of_.push_back(0);
    if (prototype.foliage.empty()) continue;
    const auto [at, added] = known.try_emplace(kind_of(prototype), sheets_.size());
    sheet_of_.back() = at->second;
    if (!added) continue;
    sheets_.push_back({build_shadow_tile(mask_leaves(prototype, prototype.name.c_str()), {}, control), {}});
  }
  for (Sheet& sheet : sheets_) sheet.view = view_tile(sheet.tile, to_sun);
}

// A leaf's patch of the tile is one of two by lot: that whose threshold is closer to the usual one, since
// there its pattern looks like that of the shadows a leaf gets. With one the flecks are too often at the rim.
std::uint32_t LeafFlecks::find_patch(const RayHit& hit, std::size_t element) const {
  const Instance& at = scene_.forest().instances[hit.instance];
  const FoliageElement& e = scene_.forest().prototypes[at.prototype.value].foliage[hit.local];
  const LeafPoints points = points_on(e, scene_.look_of(at.prototype, e.material), at);
  std::array<float, 2> threshold{};
  for (std::uint32_t k = 0; k < 2; ++k)
    threshold[k] = threshold_of(points, view_of(at), offset_of(element, k), share_[element]);
  const auto off = [&](std::size_t k) { return std::abs(threshold[k] - usual_threshold_); };
  const std::uint32_t chosen = off(1) < off(0) ? 1 : 0;
  return (std::bit_cast<std::uint32_t>(threshold[chosen]) & ~3u) | 2u | chosen;
}

bool LeafFlecks::lit(const RayHit& hit, std::size_t element) const {
  const float share = share_[element];
  if (!(share > 0)) return false;
  if (share >= 1) return true;
  const Instance& at = scene_.forest().instances[hit.instance];
  const Vec3 point = hit.on_original_m / static_cast<double>(at.scale);
  if (!of_leaves_) return tile_lit(view_of(at), point, share, offset_of(element, 0));
  std::uint32_t patch = patch_[element].load(std::memory_order_relaxed);
  if (patch == 0) {
    patch = find_patch(hit, element);
    patch_[element].store(patch, std::memory_order_relaxed);
  }
  return tile_rank_between(view_of(at), point, offset_of(element, patch & 1u)) >
         std::bit_cast<float>(patch & ~3u);
}

std::size_t LeafFlecks::memory_bytes() const {
  std::size_t bytes = patch_.size() * sizeof(std::uint32_t);
  for (const Sheet& sheet : sheets_) bytes += sheet.tile.memory_bytes();
  return bytes;
}

}  // namespace sunfleck
