// Accuracy and time of the grid method against traced light: crowns of several shapes and leaf angles, cells
// of several sizes. The reference's own scatter is measured (its standard errors) and taken out of the RMS.
//   grid_accuracy [leaves] [rays per face] [cell in leaf sides, 0: the rule] [directions] [one shape, or
//   "grown" for the trees of the grammars; run in the root of the repository]
#include <cstdlib>
#include <iomanip>
#include <iostream>

#include "lighting/transport/grid_limits.h"
#include "sim/plant/make_prototype.h"
#include "tests/lighting/transport/world_stand.h"

namespace sunfleck::test {
namespace {

// Turns every leaf so that its normal leans towards the vertical (> 0) or the level (< 0).
Forest leaning(Forest forest, double towards_vertical) {
  for (FoliageElement& e : forest.prototypes[0].foliage) {
    Vec3 normal(element_normal(e));
    if (towards_vertical > 0.0)
      normal.z = std::copysign(std::abs(normal.z) + towards_vertical, normal.z);
    else
      normal.z *= 1.0 / (1.0 - 2.0 * towards_vertical);
    const Basis basis = basis_around(glm::normalize(normal));
    const double half = 0.5 * std::sqrt(static_cast<double>(e.area_m2));
    e.half_u_m = Vec3f(half * basis.tangent);
    e.half_v_m = Vec3f(half * basis.bitangent);
  }
  return forest;
}

double noise_variance(const BandLightMap& truth) {
  double sum = 0.0;
  for (const float se : truth.standard_error_w_m2) sum += static_cast<double>(se) * se;
  return truth.standard_error_w_m2.empty() ? 0.0
                                           : sum / static_cast<double>(truth.standard_error_w_m2.size());
}

void measure(const std::string& name, Forest forest, int rays, double sides, int directions) {
  const StandCase c = stand_case(std::move(forest), 0.1);
  GridOptions options{.directions = directions};
  options.cell_m = sides * grid_suitability(c.forest, {}).leaf_side_m;
  const LightMap grid = grid_light_map(c.forest, c.optics, c.light, options, {});
  ReferenceOptions traced;
  traced.rays_per_face = rays;
  traced.sun_rays_per_element = 64;
  static std::string of;
  static LightMap truth;
  if (of != name) truth = reference_light_map(c.forest, c.optics, c.light, traced, {});
  of = name;
  double cpu = 0.0;
  for (const StageTime& t : grid.provenance.times) cpu += t.cpu_s;
  for (std::size_t b = 0; b < grid.bands.size(); ++b) {
    const StandErrors e = stand_errors(c.forest, grid.bands[b], truth.bands[b]);
    const double mean = truth.bands[b].mean_irradiance_w_m2;
    const double noise = std::sqrt(noise_variance(truth.bands[b])) / mean;
    std::cout << std::setw(20) << std::left << name << std::setw(9) << grid.bands[b].band << std::right
              << std::fixed << std::setprecision(1);
    for (const double x :
         {e.bias, e.leaf_mean_absolute, e.leaf_rms, noise,
          std::sqrt(std::max(0.0, e.leaf_rms * e.leaf_rms - noise * noise)), e.cell, e.direct_bias})
      std::cout << std::setw(8) << 100 * x;
    std::cout << "  cpu_s " << std::setprecision(3) << cpu / 3.0 << " cell "
              << grid.provenance.settings[1].second << '\n';
  }
}

// Trees of the grammars, open-grown, with few enough leaves for the reference.
Forest grown(const std::string& species_file) {
  const Species species = load_species(std::string("configs/species/") + species_file + ".toml");
  Forest forest;
  forest.prototypes.push_back(grow_prototype(species, expected_size(species, 18.0), 1, 1.0));
  for (const std::string& name : forest.prototypes[0].materials) forest.materials.push_back({name, {}});
  forest.instances.emplace_back();
  std::cout << species_file << ": " << forest.prototypes[0].foliage.size() << " elements\n";
  return forest;
}

int run(int argc, char** argv) {
  const auto number = [&](int i, double usual) { return argc > i ? std::atof(argv[i]) : usual; };
  const int leaves = static_cast<int>(number(1, 40000)), rays = static_cast<int>(number(2, 96));
  const int directions = static_cast<int>(number(4, 26));
  const auto crown = [&](CrownKind kind) {
    return generated_crown({.kind = kind, .leaves = leaves, .crown_lai = 5, .seed = 5});
  };
  const std::string only = argc > 5 ? argv[5] : "";
  if (only == "grown") {
    for (const char* name : {"fagus_sylvatica", "pinus_sylvestris", "picea_abies"})
      measure(name, grown(name), rays, 0.0, directions);
    return 0;
  }
  std::cout << "%                               bias    leaf     rms   noise rms-noi    cell  direct\n";
  for (const auto& [name, forest] :
       {std::pair{"clumped", crown(CrownKind::kClumped)}, std::pair{"sphere", crown(CrownKind::kSphere)},
        std::pair{"cone", crown(CrownKind::kCone)},
        std::pair{"planophile cone", leaning(crown(CrownKind::kCone), 1.5)},
        std::pair{"erectophile sphere", leaning(crown(CrownKind::kSphere), -2.0)}}) {
    if (!only.empty() && only != name) continue;
    for (const double sides :
         number(3, 0) > 0.0 ? std::vector<double>{0.0, number(3, 0)} : std::vector<double>{0.0})
      measure(name, forest, rays, sides, directions);
  }
  return 0;
}

}  // namespace
}  // namespace sunfleck::test

int main(int argc, char** argv) { return sunfleck::test::run(argc, argv); }
