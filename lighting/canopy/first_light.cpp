// See first_light.h.
#include "lighting/canopy/first_light.h"

#include <algorithm>
#include <cmath>

#include "lighting/canopy/drop_rays.h"
#include "lighting/trace/surface_sampler.h"
#include "sim/base/contract.h"
#include "sim/base/parallel.h"

namespace sunfleck {

namespace {

using Kind = ResponseTable::Kind;

constexpr std::size_t kRaysPerCheck = 1024;
constexpr int kMostBounces = 100000;  // never reached: albedo 1 ends in the sky, long before
// Leaves seen nearly edge-on: limits the noise of sunlit area; leaves it changes are 0.1 % of all.
constexpr double kLeastCosine = 0.002;
// Mean square of 1 / cosine over its mean, leaves turned any way: ln(1 / kLeastCosine) / 2.
constexpr double kSunlitSpread = 3.1;

StandResponse empty_response(const StandScene& scene, const OpticsTable& optics, std::size_t directions,
                             bool bounces) {
  const std::size_t trees = scene.forest().instances.size(), layers = scene.layer_count(),
                    cells = scene.ground().count();
  StandResponse r;
  r.ground_share = {Kind::kShare, directions, cells};
  r.tree_intercepted_m2 = r.tree_sunlit_m2 = {Kind::kAmount, directions, trees};
  r.layer_intercepted_m2 = r.layer_sunlit_m2 = {Kind::kAmount, directions, layers};
  r.height_share = {Kind::kShare, directions, layers + 1};
  r.plot_m2 = {Kind::kAmount, directions, StandResponse::kPlotTerms};
  for (std::size_t b = 0; bounces && b < optics.band_count(); ++b)
    r.bands.push_back({optics.bands()[b],
                       {Kind::kAmount, directions, trees},
                       {Kind::kAmount, directions, layers},
                       {Kind::kAmount, directions, cells},
                       {Kind::kAmount, directions, BandResponse::kPlotTerms}});
  return r;
}

// Chance to be thrown back and to pass through, for light that arrives at the side it met.
struct Scatter {
  double reflect = 0, pass = 0;
  bool is_shoot = false;
};

class DirectionTrace {
 public:
  DirectionTrace(const StandScene& scene, const OpticsTable& optics, std::size_t direction,
                 StandResponse& out)
      : scene_(scene), forest_(scene.forest()), optics_(optics), d_(direction), out_(out) {}

  void run(const DropRays& rays, std::uint64_t seed, const RunControl& control) {
    quantum_ = rays.quantum_m2();
    for (std::size_t i = 0; i < rays.count(); ++i) {
      if (i % kRaysPerCheck == 0) control.check();
      RandomStream random(seed, i, RandomPurpose::kStandRays, 1);
      const DropRay ray = rays.ray(i, random);
      if (ray.is_far) {
        count(out_.plot_m2, d_, StandResponse::kIncident);
        count(out_.plot_m2, d_, StandResponse::kBeyond);
        for (BandResponse& band : out_.bands) count(band.plot_m2, d_, BandResponse::kBeyond);
      } else {
        follow(ray, seed, i);
      }
    }
    complete_heights();
    scale(rays);
  }

 private:
  static void count(ResponseTable& table, std::size_t d, std::size_t target, float by = 1.0f) {
    table.value[d * table.targets + target] += by;
  }

  void follow(const DropRay& ray, std::uint64_t seed, std::size_t i) {
    count(out_.plot_m2, d_, StandResponse::kIncident);
    RayHit hit;
    if (ray.may_hit) {
      hit = scene_.rays().closest_hit(ray.origin_m, ray.direction);
    } else {
      hit.kind = HitKind::kGround;
      hit.front = true;
      hit.position_m = hit.on_original_m = ray.aim_m;
      hit.normal = scene_.ground().normal;
    }
    credit_first(hit, ray);
    if (hit.kind == HitKind::kSky) return;
    for (std::size_t b = 0; b < out_.bands.size(); ++b) {
      RandomStream random(mix_seed(seed, b + 1), i, RandomPurpose::kStandBounces);
      bounce(hit, b, random);
    }
  }

  void credit_first(const RayHit& hit, const DropRay& ray) {
    credit_heights(hit, ray);
    if (hit.kind == HitKind::kSky) return count(out_.plot_m2, d_, StandResponse::kMissed);
    if (hit.kind == HitKind::kGround) {
      const std::size_t cell = scene_.ground().cell_at(hit.position_m.x, hit.position_m.y);
      if (cell == scene_.ground().count()) return count(out_.plot_m2, d_, StandResponse::kBeyond);
      count(out_.ground_share, d_, cell);
      return count(out_.plot_m2, d_, StandResponse::kMapGround);
    }
    const std::size_t layer = scene_.layer_at(hit.position_m);
    count(out_.tree_intercepted_m2, d_, hit.instance);
    count(out_.layer_intercepted_m2, d_, layer);
    if (hit.kind != HitKind::kFoliage) return count(out_.plot_m2, d_, StandResponse::kWood);
    count(out_.plot_m2, d_, StandResponse::kLeaves);
    const double cosine = std::max(kLeastCosine, std::abs(glm::dot(hit.normal, ray.direction)));
    count(out_.tree_sunlit_m2, d_, hit.instance, static_cast<float>(1.0 / cosine));
    count(out_.layer_sunlit_m2, d_, layer, static_cast<float>(1.0 / cosine));
  }

  // Passes through the foot of every layer above the hit, where it does so over the map.
  void credit_heights(const RayHit& hit, const DropRay& ray) {
    const StandGround& ground = scene_.ground();
    const double end_m = hit.kind == HitKind::kGround || hit.kind == HitKind::kSky
                             ? -1.0
                             : scene_.height_above_ground(hit.position_m);
    if (ground.periodic) {
      const double foot = std::max(0.0, std::ceil(end_m / scene_.layer_m()));
      return count(out_.height_share, d_, std::min(static_cast<std::size_t>(foot), scene_.layer_count()));
    }
    const double climb = -glm::dot(ray.direction, ground.normal) / ground.normal.z;
    for (std::size_t k = scene_.layer_count() + 1; k-- > 0;) {
      const double height_m = static_cast<double>(k) * scene_.layer_m();
      if (height_m < end_m) return;
      const Vec3 at = ray.aim_m - ray.direction * (height_m / climb);
      if (ground.contains(at.x, at.y)) count(out_.height_share, d_, k);
    }
  }

  // In a periodic stand rays were noted at the lowest height they pass: they pass all above it too.
  void complete_heights() {
    if (!scene_.ground().periodic) return;
    const std::span<float> passed = out_.height_share.row(d_);
    for (std::size_t k = 1; k < passed.size(); ++k) passed[k] += passed[k - 1];
  }

  Scatter scatter_at(const RayHit& hit, std::size_t band) const {
    if (hit.kind == HitKind::kGround) return {hit.front ? optics_.soil_albedo(band) : 0.0};
    const PrototypeId id = forest_.instances[hit.instance].prototype;
    const Prototype& p = forest_.prototypes[id.value];
    if (hit.kind == HitKind::kFoliage) {
      const FoliageElement& e = p.foliage[hit.local];
      const LeafOptics& leaf = optics_.material(band, id, e.material).leaf;
      return {hit.front ? leaf.reflectance_front : leaf.reflectance_back,
              hit.front ? leaf.transmittance_front : leaf.transmittance_back,
              e.shape == ElementShape::kShoot};
    }
    const std::size_t material =
        hit.kind == HitKind::kWood ? p.wood[hit.local].material : p.wood_mesh[hit.local].material;
    return {optics_.material(band, id, material).bark_reflectance};
  }

  void bounce(RayHit hit, std::size_t band, RandomStream& random) {
    BandResponse& out = out_.bands[band];
    for (int order = 0; order < kMostBounces; ++order) {
      if (hit.kind == HitKind::kSky) return count(out.plot_m2, d_, BandResponse::kReflected);
      if (order > 0 && hit.kind == HitKind::kGround) credit_scattered(hit, out);
      const Scatter s = scatter_at(hit, band);
      const double lot = random.uniform();
      if (lot >= s.reflect + s.pass) return absorb(hit, out);
      const bool reflected = lot < s.reflect;
      Vec3 direction;
      RayStart from;
      if (s.is_shoot) {
        direction = trace::any_direction(random);
      } else {
        direction = trace::cosine_direction(reflected ? hit.normal : -hit.normal, random);
        from = {hit.kind, reflected == hit.front, hit.instance, hit.local};
      }
      hit = scene_.rays().closest_hit(hit.on_original_m, direction, 0.0, from);
    }
    absorb(hit, out);
  }

  void credit_scattered(const RayHit& hit, BandResponse& out) {
    const std::size_t cell = scene_.ground().cell_at(hit.position_m.x, hit.position_m.y);
    if (cell < scene_.ground().count()) count(out.ground_scattered_share, d_, cell);
  }

  void absorb(const RayHit& hit, BandResponse& out) {
    if (hit.kind == HitKind::kGround) {
      const bool on_map =
          scene_.ground().cell_at(hit.position_m.x, hit.position_m.y) < scene_.ground().count();
      return count(out.plot_m2, d_, on_map ? BandResponse::kGroundAbsorbed : BandResponse::kBeyond);
    }
    if (hit.kind != HitKind::kFoliage) return count(out.plot_m2, d_, BandResponse::kWood);
    count(out.plot_m2, d_, BandResponse::kLeaves);
    count(out.tree_absorbed_m2, d_, hit.instance);
    count(out.layer_absorbed_m2, d_, scene_.layer_at(hit.position_m));
  }

  // Counts become amounts.
  void scale(ResponseTable& table, double quantum) const {
    table.quantum[d_] = quantum;
    for (float& v : table.row(d_)) v *= static_cast<float>(quantum);
  }

  void scale(const DropRays& rays) {
    if (rays.count() == 0) return;
    const StandGround& ground = scene_.ground();
    const Vec2 size_m = ground.size_m();
    const double q = quantum_, facing = ground.facing(rays.to_source());
    const double cell = q / (ground.cell_area_m2() * facing), map = q / (size_m.x * size_m.y * facing);
    for (ResponseTable* t : {&out_.tree_intercepted_m2, &out_.tree_sunlit_m2, &out_.layer_intercepted_m2,
                             &out_.layer_sunlit_m2, &out_.plot_m2})
      scale(*t, q);
    for (ResponseTable* t : {&out_.tree_sunlit_m2, &out_.layer_sunlit_m2}) t->quantum[d_] *= kSunlitSpread;
    scale(out_.ground_share, cell);
    scale(out_.height_share, map);
    for (BandResponse& band : out_.bands) {
      for (ResponseTable* t : {&band.tree_absorbed_m2, &band.layer_absorbed_m2, &band.plot_m2}) scale(*t, q);
      scale(band.ground_scattered_share, cell);
    }
  }

  const StandScene& scene_;
  const Forest& forest_;
  const OpticsTable& optics_;
  const std::size_t d_;
  StandResponse& out_;
  double quantum_ = 0;
};

}  // namespace

StandResponse drop_light(const StandScene& scene, const OpticsTable& optics, const LightSource& source,
                         const DropOptions& options, const RunControl& control) {
  SUNFLECK_EXPECTS(options.rays_on_map.size() == source.size());
  StandResponse out = empty_response(scene, optics, source.size(), options.bounces);
  for_each_chunk(source.size(), 1, control, "light on the stand", [&](std::size_t d, std::size_t) {
    if (!(options.rays_on_map[d] > 0.0)) return;
    const std::uint64_t seed = mix_seed(options.seed, d);
    const DropRays rays(scene, source.to_source[d], source.half_angle(d), options.rays_on_map[d]);
    DirectionTrace(scene, optics, d, out).run(rays, seed, control);
  });
  return out;
}

}  // namespace sunfleck
