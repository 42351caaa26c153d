// See world_sums.h.
#include "lighting/transport/world_sums.h"

#include <numeric>

#include "lighting/transport/world_contents.h"
#include "sim/base/parallel.h"

namespace sunfleck::transport {

namespace {

float dot(const BothLanes& a, const BothLanes& b) {
  float sum = 0.0f;
  for (std::size_t j = 0; j < kBothLanes; ++j) sum += a[j] * b[j];
  return sum;
}

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

void add_sums(const WorldScene& scene, const Forest& forest, const WorldSources& sources,
              const BandLight& strength, double soil_albedo, WorldBand& band, const RunControl& control) {
  const EntryLight light = light_of_entries(scene, sources, strength.beam_normal_w_m2, band, control);
  add_trees(scene, forest, sources, light, band, control);
  if (scene.periodic) add_budget(scene, sources, strength, soil_albedo, light.wood_absorbed_w, band);
}

}  // namespace sunfleck::transport
