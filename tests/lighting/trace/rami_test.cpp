// The RAMI scene HET01: fifteen ball crowns of 49,999 discs on a period of 100 m, against fluxes traced by an
// independent program (case "rami_het01_fluxes", standard errors below 0.0007). Runs only where the scene's
// data lie beside the checkout.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <sstream>

#include "tests/lighting/trace/golden_cases.h"
#include "tests/lighting/trace/scenes.h"

namespace sunfleck::test {
namespace {

constexpr double kTolerance = 0.003;  // as the case states

// Lines "radius x y z nx ny nz".
std::vector<FoliageElement> read_discs(const std::filesystem::path& gz) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(("gzip -dc '" + gz.string() + "'").c_str(), "r"),
                                                   pclose);
  std::vector<FoliageElement> discs;
  double r, x, y, z, nx, ny, nz;
  while (pipe && std::fscanf(pipe.get(), "%lf %lf %lf %lf %lf %lf %lf", &r, &x, &y, &z, &nx, &ny, &nz) == 7)
    discs.push_back(disc({x, y, z}, {nx, ny, nz}, r));
  return discs;
}

std::optional<Forest> het01() {
  const auto discs = shared_data("rami-het01/crown_discs.txt.gz");
  const auto centres = shared_data("rami-het01/crown_centres.txt");
  if (!discs || !centres) return std::nullopt;
  Forest forest = forest_of(read_discs(*discs));
  forest.materials[0].bands = {
      {"nir", 0.4957, 0.4409, 0.0}, {"red", 0.0546, 0.0149, 0.0}, {"black", 0.0, 0.0, 0.0}};
  forest.instances.clear();
  std::ifstream in(*centres);
  for (Vec3 p; in >> p.x >> p.y >> p.z;) forest.instances.push_back({p, {}, 0.0f, 1.0f, {}});
  forest.period = Period{{-50, -50}, {100, 100}};
  return forest;
}

LightMap fluxes(const Forest& forest, Illumination light) {
  const OpticsTable optics(
      forest, {.bands = {"nir", "red", "black"}, .soil_albedo = {0.159, 0.127, 0.0}, .overrides = {}});
  const BandLight strength = light.bands[0];
  light.bands.assign(3, strength);
  ReferenceOptions o;
  o.rays_per_face = 4;
  o.sun_rays_per_element = 4;
  o.ground_cell_m = 0.25;
  return reference_light_map(forest, optics, light, o, {});
}

void compare(const nlohmann::json& mode, const LightMap& map) {
  const bool nir = mode["rho"].get<double>() > 0.3;
  const EnergyBudget &b = map.bands[nir ? 0 : 1].budget, &black = map.bands[2].budget;
  const std::string name = mode["mode"].get<std::string>() + (nir ? " nir " : " red ") + mode["sza"].dump();
  const auto near = [&](const char* what, double got, double expected) {
    EXPECT_NEAR(got / b.incident_w, expected, kTolerance) << name << " " << what;
    std::printf("%-18s %-20s %.5f expected %.5f\n", name.c_str(), what, got / b.incident_w, expected);
  };
  near("albedo", b.escaped_w, mode["albedo"]);
  near("absorbed by leaves", b.absorbed_foliage_w, mode["f_abs_leaf"]);
  near("absorbed by soil", b.absorbed_ground_w, mode["f_abs_soil"]);
  near("unscattered", black.absorbed_ground_w, mode["unscattered_to_soil"]);
}

TEST(Rami, Het01Fluxes) {
  const auto forest = het01();
  if (!forest) GTEST_SKIP() << "no shared data";
  ASSERT_EQ(forest->prototypes[0].foliage.size(), 49999u);
  ASSERT_EQ(forest->instances.size(), 15u);
  const auto expected = light_case("rami_het01_fluxes")["expected"];
  for (const double zenith_deg : {0.0, 20.0, 50.0}) {
    const double zenith = radians_from_degrees(zenith_deg);
    const LightMap map = fluxes(*forest, sunlight({std::sin(zenith), 0, std::cos(zenith)}, 1.0));
    expect_sound(map, *forest);
    for (const auto& mode : expected)
      if (mode["mode"] == "flux" && mode["sza"].get<double>() == zenith_deg) compare(mode, map);
  }
  for (const auto& [name, sky] :
       {std::pair{"fluxuoc", SkyModel::kUniform}, std::pair{"fluxsoc", SkyModel::kStandardOvercast}}) {
    const LightMap map = fluxes(*forest, skylight(1.0, sky));
    expect_sound(map, *forest);
    for (const auto& mode : expected)
      if (mode["mode"] == name) compare(mode, map);
  }
}

}  // namespace
}  // namespace sunfleck::test
