// See world_solver.h. The radiance of sky and scattered light together is iterated: what leaves, wood and
// ground give back, swept again with the sky coming in, until the power they give back is known; the rest of
// the series is then added in proportion.
#include "lighting/transport/world_solver.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "lighting/depth/grid_march.h"
#include "lighting/transport/world_scatter.h"
#include "sim/base/parallel.h"

namespace sunfleck::transport {

namespace {

constexpr double kSlowest = 0.9995;       // orders that shrink more slowly give no tail to go by
constexpr double kChangePerError = 0.25;  // the prediction's error is some times its last change
// The tail is added in the shape of all orders, which it has not quite: it may be this times the tolerance.
constexpr double kLongestTail = 10.0;

// Depth over half a cell beyond which its middle says nothing of its mean.
constexpr float kThickest = 3.0f;

// Extinction along any direction, for the sun.
std::vector<float> extinction_towards_sun(const WorldScene& scene, const Vec3& to_sun,
                                          std::vector<float>& of_kind, const RunControl& control) {
  DirectionSet sun;
  sun.to_source = {to_sun, -to_sun};
  sun.solid_angle_sr = {2 * kPi, 2 * kPi};
  for (const WorldPrototype& p : scene.prototypes) {
    of_kind.push_back(leaf_cover(p, sun)[0]);
    of_kind.push_back(wood_cover(p, sun)[0]);
  }
  std::vector<float> extinction(scene.cells(), 0.0f);
  const auto per_volume = static_cast<float>(1.0 / std::pow(scene.layout.mean_cell_m(), 3));
  for_each_chunk(scene.cells(), 65536, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      for (std::uint32_t e = scene.first_entry[c]; e < scene.first_entry[c + 1]; ++e)
        extinction[c] += scene.entries[e].area_m2 * of_kind[scene.entries[e].kind] * per_volume;
  });
  return extinction;
}

void add_sun(const WorldScene& scene, const Forest& forest, const Vec3& to_sun, WorldSources& sources,
             const RunControl& control) {
  sources.sun_extinction_per_m = extinction_towards_sun(scene, to_sun, sources.sun_cover, control);
  sources.sun_ground.assign(scene.ground->count(), 0.0f);
  sources.sun_transmittance.assign(scene.cells(), 0.0f);
  if (scene.frame.ends_on_ground(to_sun)) return;
  sources.open_ground = glm::dot(to_sun, forest.terrain.normal());
  const Vec3 towards = scene.frame.field_direction(to_sun);
  const SweepPlan plan = plan_sweep(scene.layout, towards);
  std::vector<float> pass(scene.cells());
  const auto half_step = static_cast<float>(-0.5 * plan.step_m);
  for_each_chunk(scene.cells(), 65536, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      pass[c] = sources.sun_extinction_per_m[c] > 0.0f ? std::exp(half_step * sources.sun_extinction_per_m[c])
                                                       : 1.0f;
  });
  sweep_even(plan, pass, EvenInflow(1.0), sources.sun_transmittance, control);
  // From the middle of a cell to its mean along the ray: what a cell takes is then what its slab lets not
  // pass.
  for_each_chunk(scene.cells(), 65536, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const float x = std::min(kThickest, -half_step * sources.sun_extinction_per_m[c]);
      if (x > 1e-3f)
        sources.sun_transmittance[c] = std::min(1.0f, sources.sun_transmittance[c] * std::sinh(x) / x);
    }
  });
  for_each_chunk(scene.ground->count(), 16, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) {
      const Vec3 p = scene.frame.field_from_world(scene.ground->world_point(g));
      sources.sun_ground[g] =
          static_cast<float>(sources.open_ground *
                             std::exp(-march_grid(scene.layout, sources.sun_extinction_per_m, p, towards)));
    }
  });
}

BothLanes radiance_in(const WorldScene& scene, const std::vector<float>& radiance, std::size_t cell) {
  BothLanes lanes{};
  const std::size_t half = scene.set.half(), cells = scene.cells();
  for (std::size_t j = 0; j < half; ++j) {
    lanes[j] = radiance[j * cells + cell];
    lanes[kLanes + j] = radiance[(half + j) * cells + cell];
  }
  return lanes;
}

float dot(const BothLanes& a, const BothLanes& b) {
  float sum = 0.0f;
  for (std::size_t j = 0; j < kBothLanes; ++j) sum += a[j] * b[j];
  return sum;
}

class WorldSolver {
 public:
  WorldSolver(const WorldScene& scene, const WorldSources& sources, const BandLight& strength,
              double soil_albedo, const WorldKernels& kernels, const RunControl& control)
      : scene_(scene),
        sources_(sources),
        strength_(strength),
        soil_albedo_(soil_albedo),
        kernels_(kernels),
        control_(control),
        around_(scene.set.count()) {}

  void run(const WorldOptions& options, WorldBand& band) {
    start();
    double before_power = 0.0, before_order = 0.0, predicted = 0.0;
    band.converged = false;
    for (band.iterations = 0;; ++band.iterations) {
      WorldGround ground = world_ground(scene_, sources_, strength_, radiance_, control_);
      const double power = scatter() + ground_power(ground);
      const double order = power - before_power;
      double tail = 0.0;
      if (band.iterations > 0 && order > 0.0 && order < kSlowest * before_order)
        tail = order * order / (before_order - order);
      const double before = std::exchange(predicted, power + tail);
      before_power = power;
      before_order = order;
      const bool steady =
          std::abs(predicted - before) <= kChangePerError * options.convergence * std::abs(predicted);
      const bool short_tail = tail <= kLongestTail * options.convergence * power;
      band.converged = !(power > 0.0) || (band.iterations >= 2 && steady && short_tail);
      const bool last = band.converged || band.iterations >= options.max_iterations;
      if (last && power > 0.0) add_tail(predicted / power, ground);
      sweep_all(ground);
      if (last) break;
    }
    band.radiance = std::move(radiance_);
    band.ground_irradiance = world_ground(scene_, sources_, strength_, band.radiance, control_).irradiance;
  }

 private:
  void start() {
    radiance_.assign(scene_.set.count() * scene_.cells(), 0.0f);
    if (sources_.sky.empty() || !(strength_.diffuse_horizontal_w_m2 > 0.0)) return;
    const auto diffuse = static_cast<float>(strength_.diffuse_horizontal_w_m2);
    around_ = sources_.sky_around;
    for (auto& direction : around_)
      for (float& radiance : direction) radiance *= diffuse;
    for_each_chunk(radiance_.size(), 1 << 18, control_, {}, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) radiance_[i] = diffuse * sources_.sky[i];
    });
  }

  double ground_power(const WorldGround& ground) const {
    return soil_albedo_ * scene_.ground->cell_area_m2() *
           std::accumulate(ground.irradiance.begin(), ground.irradiance.end(), 0.0);
  }

  // Radiance to source functions, in place. Returns the power given back.
  double scatter() {
    const auto beam = static_cast<float>(strength_.beam_normal_w_m2);
    const ScatterCell scatter_cell = scatter_cell_best();
    std::vector<double> power(scene_.ranges.size(), 0.0);
    for_each_chunk(scene_.ranges.size(), 1, control_, {}, [&](std::size_t r, std::size_t) {
      const std::size_t half = scene_.set.half(), cells = scene_.cells();
      for (std::uint32_t c = scene_.ranges[r].begin; c < scene_.ranges[r].end; ++c) {
        const std::uint32_t begin = scene_.first_entry[c], end = scene_.first_entry[c + 1];
        if (begin == end) continue;  // all light passes, whatever the source function is
        const BothLanes light = radiance_in(scene_, radiance_, c);
        const float sun = sources_.sun_transmittance.empty() ? 0.0f : beam * sources_.sun_transmittance[c];
        alignas(64) BothLanes source{};
        alignas(64) Lanes cover{};
        for (std::uint32_t e = begin; e < end; ++e) {
          const WorldEntry& entry = scene_.entries[e];
          for (std::size_t j = 0; j < kLanes; ++j) cover[j] += entry.area_m2 * scene_.cover[entry.kind][j];
        }
        scatter_cell(std::span(scene_.entries).subspan(begin, end - begin), kernels_.kinds.data(), light, sun,
                     source);
        float sent = 0.0f;
        for (std::size_t j = 0; j < kLanes; ++j)
          sent += scene_.lanes.solid_angle_sr[j] * (source[j] + source[kLanes + j]);
        power[r] += sent;
        for (std::size_t j = 0; j < half; ++j) {
          const float per_cover = cover[j] > 0.0f ? 1.0f / cover[j] : 0.0f;
          radiance_[j * cells + c] = source[j] * per_cover;
          radiance_[(half + j) * cells + c] = source[kLanes + j] * per_cover;
        }
      }
    });
    return std::accumulate(power.begin(), power.end(), 0.0);
  }

  void add_tail(double factor, WorldGround& ground) {
    const auto f = static_cast<float>(factor);
    for_each_chunk(radiance_.size(), 1 << 18, control_, {}, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) radiance_[i] *= f;
    });
    for (float& e : ground.irradiance) e *= f;
  }

  void sweep_all(const WorldGround& ground) {
    const std::vector<float> lit = ground_radiance(ground, soil_albedo_);
    const auto open = static_cast<float>(soil_albedo_ / kPi * ground.open);
    for_each_chunk(scene_.set.count(), 1, control_, {}, [&](std::size_t d, std::size_t) {
      const WorldInflow inflow(scene_, sources_.sectors, d, strength_.diffuse_horizontal_w_m2, lit, open);
      sweep(scene_.plans[d], scene_.transmittance_of(d), inflow, scene_.part_of(radiance_, d), around_[d],
            control_);
    });
  }

  const WorldScene& scene_;
  const WorldSources& sources_;
  const BandLight strength_;
  const double soil_albedo_;
  const WorldKernels& kernels_;
  const RunControl& control_;
  std::vector<std::vector<float>> around_;
  std::vector<float> radiance_;
};

// Absorbed power and irradiance per effective area of every entry, and the wood's absorption in total.
struct EntryLight {
  std::vector<float> absorbed, irradiance;
  double wood_absorbed_w = 0;
};

EntryLight light_of_entries(const WorldScene& scene, const WorldSources& sources, double beam_w_m2,
                            const WorldBand& band, const RunControl& control) {
  EntryLight light;
  light.absorbed.resize(scene.entries.size());
  light.irradiance.resize(scene.entries.size());
  std::vector<double> wood(scene.ranges.size(), 0.0);
  for_each_chunk(scene.ranges.size(), 1, control, {}, [&](std::size_t r, std::size_t) {
    for (std::uint32_t c = scene.ranges[r].begin; c < scene.ranges[r].end; ++c) {
      if (scene.first_entry[c] == scene.first_entry[c + 1]) continue;
      const BothLanes radiance = radiance_in(scene, band.radiance, c);
      const float sun = sources.sun_transmittance.empty()
                            ? 0.0f
                            : static_cast<float>(beam_w_m2) * sources.sun_transmittance[c];
      for (std::uint32_t e = scene.first_entry[c]; e < scene.first_entry[c + 1]; ++e) {
        const KindKernel& kernel = band.kernels->kinds[scene.entries[e].kind];
        light.absorbed[e] = dot(kernel.absorbed, radiance) + sun * kernel.sun_absorbed;
        light.irradiance[e] = dot(kernel.irradiance, radiance) + sun * kernel.sun_irradiance;
        if (scene.entries[e].kind % 2 == 1)
          wood[r] += static_cast<double>(scene.entries[e].area_m2) * light.absorbed[e];
      }
    }
  });
  light.wood_absorbed_w = std::accumulate(wood.begin(), wood.end(), 0.0);
  return light;
}

TreeLight tree_sums(const WorldScene& scene, const Forest& forest, const WorldSources& sources,
                    const EntryLight& light, std::size_t i) {
  const Instance& instance = forest.instances[i];
  TreeLight tree{.tree = instance.tree, .instance = static_cast<std::uint32_t>(i)};
  tree.leaf_area_m2 = scene.instance_leaf_m2[i];
  if (!(tree.leaf_area_m2 > 0.0)) return tree;
  const InstanceContent content = instance_content(scene, instance);
  double received = 0.0;
  std::size_t at = 0;
  for (int z = 0; z < content.size[2]; ++z)
    for (int y = 0; y < content.size[1]; ++y)
      for (int x = 0; x < content.size[0]; ++x, ++at) {
        if (!(content.leaf_m2[at] > 0.0f)) continue;
        const std::uint32_t cell =
            *grid_cell(scene.layout, {content.lo[0] + x, content.lo[1] + y, content.lo[2] + z});
        std::uint32_t e = scene.first_entry[cell];
        while (scene.entries[e].kind != leaf_kind(instance.prototype.value)) ++e;
        const double area = content.leaf_m2[at];
        tree.absorbed_w += area * light.absorbed[e];
        received += area * light.irradiance[e];
        if (!sources.sun_transmittance.empty())
          tree.sunlit_leaf_area_m2 += area * sources.sun_transmittance[cell];
      }
  tree.mean_irradiance_w_m2 = received / tree.leaf_area_m2;
  return tree;
}

void add_trees(const WorldScene& scene, const Forest& forest, const WorldSources& sources,
               const EntryLight& light, WorldBand& band, const RunControl& control) {
  band.trees.resize(forest.instances.size());
  for_each_chunk(band.trees.size(), 16, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) band.trees[i] = tree_sums(scene, forest, sources, light, i);
  });
  double area = 0.0, received = 0.0;
  for (const TreeLight& tree : band.trees) {
    area += tree.leaf_area_m2;
    received += tree.leaf_area_m2 * tree.mean_irradiance_w_m2;
  }
  band.mean_irradiance_w_m2 = area > 0.0 ? received / area : 0.0;
}

// A period is closed but for the sky: what the parts of the estimate do not agree on is the residual.
void add_budget(const WorldScene& scene, const WorldSources& sources, const BandLight& strength,
                double soil_albedo, double wood_absorbed_w, WorldBand& band) {
  EnergyBudget& budget = band.budget;
  const double area = scene.ground->cell_area_m2();
  const std::size_t count = scene.ground->count(), cells = scene.cells(), half = scene.set.half();
  budget.incident_w = area * static_cast<double>(count) *
                      (strength.diffuse_horizontal_w_m2 * sources.sectors.open_ground_irradiance +
                       strength.beam_normal_w_m2 * sources.open_ground);
  for (const float e : band.ground_irradiance) budget.absorbed_ground_w += area * (1.0 - soil_albedo) * e;
  for (std::size_t d = 0; d < scene.set.count(); ++d) {
    const std::size_t upwards = (d + half) % scene.set.count();
    for (std::size_t c = cells - count; c < cells && sources.sectors.ground_weight_sr[d] > 0.0; ++c)
      budget.escaped_w += area * sources.sectors.ground_weight_sr[d] *
                          static_cast<double>(band.radiance[upwards * cells + c]);
  }
  for (const TreeLight& tree : band.trees) budget.absorbed_foliage_w += tree.absorbed_w;
  budget.absorbed_wood_w = wood_absorbed_w;
  budget.residual_w = budget.incident_w - budget.absorbed_foliage_w - budget.absorbed_wood_w -
                      budget.absorbed_ground_w - budget.escaped_w;
  band.has_budget = true;
}

}  // namespace

WorldSources world_sources(const WorldScene& scene, const Forest& forest, const Illumination& light,
                           const RunControl& control) {
  WorldSources sources;
  sources.sectors = sky_sectors(scene.set, sky_radiance(light), forest.terrain.normal());
  if (std::ranges::any_of(light.bands, [](const BandLight& b) { return b.diffuse_horizontal_w_m2 > 0; })) {
    sources.sky.assign(scene.set.count() * scene.cells(), 0.0f);
    sources.sky_around.resize(scene.set.count());
    for_each_chunk(scene.set.count(), 1, control, {}, [&](std::size_t d, std::size_t) {
      if (sources.sectors.sky_radiance[d] > 0.0)
        sources.sky_around[d] =
            sweep_even(scene.plans[d], scene.transmittance_of(d), EvenInflow(sources.sectors.sky_radiance[d]),
                       scene.part_of(sources.sky, d), control);
    });
  }
  const bool beam =
      std::ranges::any_of(light.bands, [](const BandLight& b) { return b.beam_normal_w_m2 > 0; });
  if (beam && light.sun_is_up()) add_sun(scene, forest, light.to_sun, sources, control);
  return sources;
}

WorldInflow::WorldInflow(const WorldScene& scene, const SkySectors& sectors, std::size_t direction,
                         double diffuse_w_m2, std::span<const float> ground_radiance,
                         float open_ground_radiance)
    : scene_(scene),
      ground_(scene, sectors, direction, ground_radiance, open_ground_radiance),
      ground_radiance_(ground_radiance),
      below_(scene.ground_below[direction]),
      sky_(static_cast<float>(diffuse_w_m2 * sectors.sky_radiance[direction])),
      share_(static_cast<float>(sectors.ground_share[direction])),
      open_radiance_(open_ground_radiance) {}

float WorldInflow::radiance(const std::array<int, 3>& cell) const {
  if (share_ == 0.0f) return sky_;
  const auto [nx, ny, nz] = scene_.layout.cells;
  const bool just_below =
      cell[2] == -1 && cell[0] >= 0 && cell[0] < nx && cell[1] >= 0 && cell[1] < ny && !below_.empty();
  if (!just_below) return sky_ + ground_.radiance(cell);
  const std::int32_t hit = below_[static_cast<std::size_t>(cell[1]) * static_cast<std::size_t>(nx) +
                                  static_cast<std::size_t>(cell[0])];
  return sky_ + share_ * (hit == GroundMap::kOpen ? open_radiance_
                                                  : ground_radiance_[static_cast<std::size_t>(hit)]);
}

WorldGround world_ground(const WorldScene& scene, const WorldSources& sources, const BandLight& strength,
                         const std::vector<float>& radiance, const RunControl& control) {
  std::vector<double> outside(sources.sectors.sky_radiance);
  for (double& r : outside) r *= strength.diffuse_horizontal_w_m2;
  WorldGround ground{ground_irradiance(scene, sources.sectors, radiance, outside, control),
                     strength.diffuse_horizontal_w_m2 * sources.sectors.open_ground_irradiance};
  if (sources.sun_ground.empty()) return ground;
  for (std::size_t g = 0; g < ground.irradiance.size(); ++g)
    ground.irradiance[g] += static_cast<float>(strength.beam_normal_w_m2 * sources.sun_ground[g]);
  ground.open += strength.beam_normal_w_m2 * sources.open_ground;
  return ground;
}

std::vector<float> ground_radiance(const WorldGround& ground, double soil_albedo) {
  std::vector<float> radiance(ground.irradiance);
  for (float& r : radiance) r *= static_cast<float>(soil_albedo / kPi);
  return radiance;
}

void solve_world_band(const WorldScene& scene, const Forest& forest, const WorldSources& sources,
                      const BandLight& strength, double soil_albedo, const WorldOptions& options,
                      WorldBand& band, const RunControl& control) {
  const BandLight lit{.beam_normal_w_m2 = sources.sun_ground.empty() ? 0.0 : strength.beam_normal_w_m2,
                      .diffuse_horizontal_w_m2 = strength.diffuse_horizontal_w_m2};
  WorldSolver(scene, sources, lit, soil_albedo, *band.kernels, control).run(options, band);
  const EntryLight light = light_of_entries(scene, sources, lit.beam_normal_w_m2, band, control);
  add_trees(scene, forest, sources, light, band, control);
  if (scene.periodic) add_budget(scene, sources, lit, soil_albedo, light.wood_absorbed_w, band);
}

}  // namespace sunfleck::transport
