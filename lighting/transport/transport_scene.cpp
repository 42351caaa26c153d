// See transport_scene.h.
#include "lighting/transport/transport_scene.h"

#include "sim/base/parallel.h"

namespace sunfleck::transport {

TransportScene transport_scene(const Forest& forest, const ForestIndex& index, DirectionSet set,
                               const BlockerFieldOptions& options, const RunControl& control) {
  TransportScene scene;
  scene.periodic = forest.period.has_value();
  scene.set = std::move(set);
  scene.field = std::make_unique<BlockerField>(forest, options, control);
  scene.frame = scene.field->frame();
  scene.layout = scene.field->layout();
  plan_sweeps(scene);
  scene.lanes = direction_lanes(scene.set, scene.step_cells());
  scene.contents = cell_contents(forest, index, *scene.field, scene.set, scene.lanes, control);
  scene.transmittance = half_step_transmittance(scene.contents, scene.lanes, scene.set.half(), control);
  return scene;
}

std::vector<float> sky_radiance(const TransportScene& scene, const SkySectors& sectors, CellValue value,
                                const RunControl& control) {
  std::vector<float> radiance(scene.set.count() * scene.cells());
  for_each_chunk(scene.set.count(), 1, control, {}, [&](std::size_t d, std::size_t) {
    if (sectors.sky_radiance[d] > 0.0)
      sweep_even(scene.plans[d], scene.transmittance_of(d), EvenInflow(sectors.sky_radiance[d]),
                 scene.part_of(radiance, d), control, value);
  });
  return radiance;
}

}  // namespace sunfleck::transport
