// Accuracy of the world grid with its trees, and of the grid over the whole forest, against traced light on a
// stand of 25 trees.
//   world_accuracy [leaves per tree] [rays per face] [world cell_m] [periodic 0/1] [spacing_m]
//                  [soil albedo] [trees along an edge] [grid cell_m] [only clumped 0/1]
#include <cstdlib>
#include <iomanip>
#include <iostream>

#include "tests/lighting/transport/world_stand.h"

namespace sunfleck::test {
namespace {

void print(const std::string& name, const StandErrors& e) {
  std::cout << std::setw(26) << std::left << name << std::right << std::fixed << std::setprecision(1);
  for (const double x : {e.bias, e.leaf_mean_absolute, e.leaf_rms, e.cell, e.direct_bias, e.tree_bias,
                         e.tree_rms, e.tree_worst})
    std::cout << std::setw(8) << 100 * x;
  std::cout << '\n';
}

int run(int argc, char** argv) {
  const auto number = [&](int i, double usual) { return argc > i ? std::atof(argv[i]) : usual; };
  StandOptions made{.side = static_cast<int>(number(7, 5)),
                    .leaves = static_cast<int>(number(1, 2000)),
                    .spacing_m = number(5, 4.5),
                    .periodic = number(4, 0) > 0};
  if (number(9, 0) > 0) made.kinds = {CrownKind::kClumped};
  const StandCase c = stand_case(stand(made), number(6, 0.2));
  const WorldOptions options{.cell_m = number(3, 0)};
  const WorldPrepared prepared = prepare_world(c.forest, options, {});
  const WorldLight world = world_light(c.forest, c.optics, c.light, options, prepared, {});
  for (const std::string& note : prepared.notes) std::cout << note << '\n';
  const std::vector<BandLightMap> trees = all_trees(c, world, options);
  const LightMap grid = grid_light_map(c.forest, c.optics, c.light, {.cell_m = number(8, 0)}, {});
  ReferenceOptions rays;
  rays.rays_per_face = static_cast<int>(number(2, 64));
  rays.sun_rays_per_element = 32;
  const LightMap truth = reference_light_map(c.forest, c.optics, c.light, rays, {});
  std::cout << "%                          bias    leaf     rms    cell  direct   trees treerms   worst\n";
  for (std::size_t b = 0; b < world.bands.size(); ++b) {
    StandErrors coarse;
    add_tree_errors(world.bands[b].trees, truth.bands[b].trees, coarse);
    const std::string band = world.bands[b].band;
    print(band + " world alone", coarse);
    print(band + " world + tree", stand_errors(c.forest, trees[b], truth.bands[b]));
    print(band + " grid", stand_errors(c.forest, grid.bands[b], truth.bands[b]));
    print(band + " tree against grid", stand_errors(c.forest, trees[b], grid.bands[b]));
    if (world.bands[b].has_budget)
      std::cout << "  residual " << 100 * world.bands[b].budget.residual_w / world.bands[b].budget.incident_w
                << " % (grid " << 100 * grid.bands[b].budget.residual_w / grid.bands[b].budget.incident_w
                << ")\n";
  }
  return 0;
}

}  // namespace
}  // namespace sunfleck::test

int main(int argc, char** argv) { return sunfleck::test::run(argc, argv); }
