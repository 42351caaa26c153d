#include "lighting/trace/hit_matrix.h"

#include <algorithm>

#include "lighting/trace/surface_sampler.h"
#include "sim/base/parallel.h"

namespace sunfleck::trace {
namespace {

RandomPurpose purpose_of(HitKind kind, bool front) {
  if (kind == HitKind::kGround) return RandomPurpose::kRaysGround;
  if (kind == HitKind::kFoliage) return front ? RandomPurpose::kRaysFront : RandomPurpose::kRaysBack;
  return RandomPurpose::kRaysWood;
}

class RowTracer {
 public:
  RowTracer(HitMatrix& matrix, const RayScene& scene, const Receivers& receivers, const SkyRadiance& sky,
            std::uint64_t seed)
      : matrix_(matrix), scene_(scene), receivers_(receivers), sky_(sky), seed_(seed) {}

  void trace(const SurfaceSampler& surface, bool front, std::size_t face, int begin, int end) const {
    const RandomPurpose purpose = purpose_of(surface.object().kind, front);
    const FacePoints points(mix_seed(seed_, static_cast<std::uint64_t>(purpose)), face);
    for (int k = begin; k < end; ++k) {
      const CubePoint x = points(k);
      const SurfacePoint at = surface.sample_at(x[2], x[3], x[4]);
      // A needle turned any way sends its cosine-distributed rays anywhere alike.
      const Vec3 direction = surface.is_shoot()
                                 ? any_direction(x[0], x[1])
                                 : cosine_direction(front ? at.normal : -at.normal, x[0], x[1]);
      record(face, k, scene_.closest_hit(at.position_m, direction, 0.0, surface.start(at, front)), direction);
    }
  }

 private:
  void record(std::size_t face, int k, const RayHit& hit, const Vec3& direction) const {
    const std::uint32_t met = receivers_.met_by(hit);
    matrix_.hits[face * static_cast<std::size_t>(matrix_.rays) + static_cast<std::size_t>(k)] = met;
    if (met < receivers_.sky()) return;
    const auto group = group_of(face, k);
    ++matrix_.lost[face][group];
    if (met != receivers_.sky()) return;
    const auto light = static_cast<float>(kPi * sky_.radiance(direction));
    matrix_.sky[face][group] += light;
    matrix_.sky_squares[face] += light * light;
  }

  HitMatrix& matrix_;
  const RayScene& scene_;
  const Receivers& receivers_;
  const SkyRadiance& sky_;
  std::uint64_t seed_;
};

// Makes room for `rays` per face and keeps what is there.
void widen(HitMatrix& matrix, std::size_t faces, int rays) {
  const auto before = static_cast<std::size_t>(matrix.rays), after = static_cast<std::size_t>(rays);
  std::vector<std::uint32_t> hits(faces * after);
  for (std::size_t f = 0; f < faces && before > 0; ++f)
    std::copy_n(matrix.hits.data() + f * before, before, hits.data() + f * after);
  matrix.hits = std::move(hits);
  matrix.sky.resize(faces);
  matrix.lost.resize(faces);
  matrix.sky_squares.resize(faces);
  matrix.rays = rays;
}

}  // namespace

std::uint64_t hit_matrix_bytes(std::size_t faces, int rays) {
  // Sky, losses, squares; the sun's groups; four fields of the iteration, each for all groups.
  constexpr std::uint64_t kPerFace = kGroups * (4 + 2) + 4 + kGroups * 4 + 4 * kGroups * 4;
  return faces * (4 * static_cast<std::uint64_t>(rays) + kPerFace);
}

void extend(HitMatrix& matrix, int rays, const RayScene& scene, const Receivers& receivers,
            std::span<const std::uint32_t> order, const SkyRadiance& sky, std::uint64_t seed,
            const RunControl& control) {
  constexpr int kBlock = 512;  // rays between two looks at the stop token
  const int before = matrix.rays;
  if (rays <= before) return;
  widen(matrix, receivers.face_count(), rays);
  const RowTracer tracer(matrix, scene, receivers, sky, seed);
  for_each_chunk(order.size(), 16, control, "tracing rays", [&](std::size_t b, std::size_t e) {
    for (const std::uint32_t s : order.subspan(b, e - b)) {
      const SurfaceSampler surface(receivers, s);
      for (std::size_t side = 0; side < receivers.faces_of(s); ++side)
        for (int k = before; k < rays; k += kBlock) {
          control.check();
          tracer.trace(surface, side == 0, receivers.first_face(s) + side, k, std::min(rays, k + kBlock));
        }
    }
  });
}

}  // namespace sunfleck::trace
