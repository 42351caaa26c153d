#include "lighting/shade/cube_mask.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();
constexpr double kFreePaths = 4;  // radius of the ball of leaves
constexpr double kMostLeaves = 2e7;
constexpr std::array<double, 5> kShells{0, 0.28, 0.75, 1.69,
                                        kFreePaths};  // in free paths: .15, .4, .9 m there

// Face 2 a + (0 positive, 1 negative) of axis a; (u, v) in [-1, 1] along the next two axes.
struct FacePoint {
  int face = 0;
  double u = 0, v = 0;
};

Vec3 face_direction(int face, double u, double v) {
  const int axis = face / 2;
  Vec3 d(0);
  d[axis] = face % 2 == 0 ? 1 : -1;
  d[(axis + 1) % 3] = u;
  d[(axis + 2) % 3] = v;
  return d;
}

FacePoint face_point(const Vec3& d) {
  const Vec3 size = glm::abs(d);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return {2 * axis + (d[axis] > 0 ? 0 : 1), d[(axis + 1) % 3] / size[axis], d[(axis + 2) % 3] / size[axis]};
}

std::size_t texel_index(const CubeMask& mask, int layer, int face, int row, int column) {
  const auto side = static_cast<std::size_t>(mask.side);
  return ((static_cast<std::size_t>(layer) * 6 + static_cast<std::size_t>(face)) * side +
          static_cast<std::size_t>(row)) *
             side +
         static_cast<std::size_t>(column);
}

int texel_of(double coordinate, int side) {
  return std::clamp(static_cast<int>(std::floor((coordinate + 1) * 0.5 * side)), 0, side - 1);
}

// Distance along unit direction d from the map's centre to the leaf; infinity if it is missed.
double leaf_distance(const PlacedLeaf& leaf, const Vec3& d) {
  const double facing = glm::dot(d, leaf.normal);
  if (facing == 0) return kNone;
  const double distance = glm::dot(leaf.centre, leaf.normal) / facing;
  const Vec3 off = distance * d - leaf.centre;
  const double a = glm::dot(off, leaf.half_u) / glm::dot(leaf.half_u, leaf.half_u);
  const double b = glm::dot(off, leaf.half_v) / glm::dot(leaf.half_v, leaf.half_v);
  return distance > 0 && leaf_covers(leaf.shape, a, b) ? distance : kNone;
}

// Enters the leaf where a face sees it: texels within the shadow of its surrounding sphere.
void draw_on_face(CubeMask& mask, const PlacedLeaf& leaf, int face) {
  const double radius = std::sqrt(glm::dot(leaf.half_u, leaf.half_u) + glm::dot(leaf.half_v, leaf.half_v));
  const int axis = face / 2;
  const double sign = face % 2 == 0 ? 1 : -1, deep = sign * leaf.centre[axis];
  const double sideways =
      std::max(std::abs(leaf.centre[(axis + 1) % 3]), std::abs(leaf.centre[(axis + 2) % 3]));
  if (deep + radius <= 0 || sideways - radius > deep + radius) return;  // outside the face's pyramid
  int u0 = 0, u1 = mask.side - 1, v0 = 0, v1 = mask.side - 1;
  const double near = deep - radius, far = deep + radius;
  if (near > 0) {
    const auto range = [&](double centre, int& lo, int& hi) {
      const double least = centre - radius, most = centre + radius;
      const double from = least / (least < 0 ? near : far), to = most / (most > 0 ? near : far);
      if (from > 1 || to < -1) return false;
      lo = texel_of(from, mask.side);
      hi = texel_of(to, mask.side);
      return true;
    };
    if (!range(leaf.centre[(axis + 1) % 3], u0, u1) || !range(leaf.centre[(axis + 2) % 3], v0, v1)) return;
  }
  for (int row = v0; row <= v1; ++row)
    for (int column = u0; column <= u1; ++column) {
      const Vec3 d = glm::normalize(
          face_direction(face, (column + 0.5) / mask.side * 2 - 1, (row + 0.5) / mask.side * 2 - 1));
      const double distance = leaf_distance(leaf, d);
      for (int layer = 0; layer < mask.layers; ++layer) {
        if (!(distance >= mask.shell_m[layer] && distance < mask.shell_m[layer + 1])) continue;
        float& value = mask.value[texel_index(mask, layer, face, row, column)];
        value = std::min(value, static_cast<float>(distance));
      }
    }
}

// Solid angle of a texel, up to a factor: (1 + u^2 + v^2)^(-3/2).
double texel_weight(const CubeMask& mask, std::size_t texel) {
  const auto side = static_cast<std::size_t>(mask.side);
  const double u = (static_cast<double>(texel % side) + 0.5) / static_cast<double>(side) * 2 - 1;
  const double v = (static_cast<double>(texel / side % side) + 0.5) / static_cast<double>(side) * 2 - 1;
  return std::pow(1 + u * u + v * v, -1.5);
}

// Distances of one layer become the share of the map, by solid angle, that is nearer; no leaf: 2.
void rank_layer(CubeMask& mask, int layer) {
  const std::size_t count = mask.value.size() / static_cast<std::size_t>(mask.layers);
  float* value = mask.value.data() + count * static_cast<std::size_t>(layer);
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return value[a] < value[b]; });
  double whole = 0, nearer = 0;
  for (std::size_t i = 0; i < count; ++i) whole += texel_weight(mask, i);
  for (const std::uint32_t texel : order) {
    const double weight = texel_weight(mask, texel);
    value[texel] = value[texel] < kNone ? static_cast<float>((nearer + 0.5 * weight) / whole) : 2.0f;
    nearer += weight;
  }
}

// Mean distance of a shell, weighted by exp(-extinction distance).
double mean_distance(double from, double to, double extinction) {
  const int steps = 200;
  double sum = 0, weight = 0;
  for (int i = 0; i < steps; ++i) {
    const double s = from + (to - from) * (i + 0.5) / steps;
    sum += s * std::exp(-extinction * s);
    weight += std::exp(-extinction * s);
  }
  return sum / weight;
}

// A random rotation of its own for every number (quaternion of four normal variates' direction).
Vec3 turned(const Vec3& d, std::uint32_t leaf) {
  RandomStream random(leaf, 0, RandomPurpose::kShadowMask);
  const double a = random.uniform(0, 2 * kPi), b = random.uniform(0, 2 * kPi), s = random.uniform();
  const Vec3 v(std::sqrt(1 - s) * std::cos(a), std::sqrt(s) * std::sin(b), std::sqrt(s) * std::cos(b));
  const double w = std::sqrt(1 - s) * std::sin(a);
  return d + 2.0 * glm::cross(v, glm::cross(v, d) + w * d);
}

}  // namespace

CubeMask build_cube_mask(const MaskLeaves& leaves, const CubeMaskOptions& options,
                         const RunControl& control) {
  if (options.layers != 1 && options.layers != 4)
    throw_invalid("cube mask layers", std::to_string(options.layers), "1 or 4");
  if (options.side < 16 || options.side > 1024)
    throw_invalid("cube mask side", std::to_string(options.side), "16 to 1024");
  const double path = 1 / leaves.extinction_per_m(), radius = kFreePaths * path;
  const double count = leaves.per_m3 * 4 * kPi / 3 * radius * radius * radius;
  if (!(count <= kMostLeaves))
    throw Error(ErrorKind::kLimitExceeded, "cube mask", "more than 20 million leaves in its ball",
                "a denser crown, or a shadow tile");
  CubeMask mask{options.form, options.side, options.layers, {}, {}, {}};
  const auto side = static_cast<std::size_t>(options.side);
  mask.value.assign(6 * side * side * static_cast<std::size_t>(options.layers), kNone);
  for (int layer = 0; layer < options.layers; ++layer) {
    mask.shell_m[layer + 1] = options.layers == 1 ? radius : kShells[layer + 1] * path;
    const double least = 1.2 * std::sqrt(0.5 * leaves.mean_area_m2);  // leaf points lie inside the sphere
    mask.radius_m[layer] =
        std::max(least, mean_distance(mask.shell_m[layer], mask.shell_m[layer + 1], 1 / path));
  }
  RandomStream random(options.seed, 1, RandomPurpose::kShadowMask);
  for (std::int64_t i = 0; i < std::llround(count); ++i) {
    if (i % 256 == 0) control.check();
    const double z = random.uniform(-1, 1), turn = random.uniform(0, 2 * kPi), s = std::sqrt(1 - z * z);
    const Vec3 centre =
        radius * std::cbrt(random.uniform()) * Vec3(s * std::cos(turn), s * std::sin(turn), z);
    const PlacedLeaf leaf = place_leaf(leaves, centre, random);
    for (int face = 0; face < 6; ++face) draw_on_face(mask, leaf, face);
  }
  if (options.form == MaskForm::kRank)
    for (int layer = 0; layer < options.layers; ++layer) rank_layer(mask, layer);
  return mask;
}

bool cube_lit(const CubeMask& mask, const CubeQuery& query) {
  const Vec3& q = query.from_centre_m;
  const double b = glm::dot(q, query.to_light), q2 = glm::dot(q, q);
  for (int layer = 0; layer < mask.layers; ++layer) {
    if (mask.shell_m[layer] >= query.way_m) break;
    const double radius = mask.radius_m[layer];
    const double t = -b + std::sqrt(std::max(0.0, b * b - q2 + radius * radius));
    Vec3 w = q + t * query.to_light;
    if (query.leaf != 0) w = turned(w, query.leaf);
    const FacePoint at = face_point(w);
    const float value =
        mask.value[texel_index(mask, layer, at.face, texel_of(at.v, mask.side), texel_of(at.u, mask.side))];
    const bool lit = mask.form == MaskForm::kDistance ? static_cast<double>(value) > query.way_m
                                                      : value > 1 - query.transmittance[layer];
    if (!lit) return false;
  }
  return true;
}

std::array<float, kMostMaskLayers> layer_transmittances(const CubeMask& mask, double extinction_per_m,
                                                        double way_m) {
  std::array<float, kMostMaskLayers> share{1, 1, 1, 1};
  for (int layer = 0; layer < mask.layers; ++layer) {
    const double end = layer + 1 == mask.layers ? way_m : std::min(way_m, mask.shell_m[layer + 1]);
    share[layer] = static_cast<float>(std::exp(-extinction_per_m * std::max(0.0, end - mask.shell_m[layer])));
  }
  return share;
}

}  // namespace sunfleck
