// The RAMI scene HET01 (fifteen ball crowns of 49,999 discs on a period of 100 m) from its data files, with
// the optics of the case rami_het01_brf_nir_pp, and its measured answers.
#pragma once

#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "lighting/render/reflectance_factor.h"
#include "sim/plant/flat_elements.h"
#include "tests/support/golden.h"

namespace sunfleck::test {

// Lines "radius x y z nx ny nz".
inline std::vector<FoliageElement> read_discs(const std::filesystem::path& gz) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(("gzip -dc '" + gz.string() + "'").c_str(), "r"),
                                                   pclose);
  std::vector<FoliageElement> discs;
  double r, x, y, z, nx, ny, nz;
  while (pipe && std::fscanf(pipe.get(), "%lf %lf %lf %lf %lf %lf %lf", &r, &x, &y, &z, &nx, &ny, &nz) == 7)
    discs.push_back(make_disc({x, y, z}, glm::normalize(Vec3(nx, ny, nz)), r));
  return discs;
}

inline std::optional<Forest> het01() {
  const auto discs = shared_data("rami-het01/crown_discs.txt.gz");
  const auto centres = shared_data("rami-het01/crown_centres.txt");
  if (!discs || !centres) return std::nullopt;
  Forest forest;
  forest.materials = {{"disc", {{"nir", 0.4957, 0.4409, 0.0}}}};
  Prototype crown;
  crown.name = "crown";
  crown.materials = {"disc"};
  crown.foliage = read_discs(*discs);
  forest.prototypes = {crown};
  std::ifstream in(*centres);
  for (Vec3 p; in >> p.x >> p.y >> p.z;) forest.instances.push_back({p, {}, 0.0f, 1.0f, {}});
  forest.period = Period{{-50, -50}, {100, 100}};
  return forest;
}

inline OpticsTable het01_optics(const Forest& forest) {
  return OpticsTable(forest, {.bands = {"nir"}, .soil_albedo = {0.159}, .overrides = {}});
}

// The principal plane: negative zenith angles on the sun's side.
inline Vec3 principal_plane(double zenith_deg) {
  const double zenith = radians_from_degrees(zenith_deg);
  return {-std::sin(zenith), 0.0, std::cos(zenith)};
}

struct Het01Case {
  std::vector<double> view_zenith_deg, factor;
};
inline Het01Case het01_case() {
  const nlohmann::json all = golden("light_cases.json");
  for (const auto& c : all["cases"])
    if (c["id"] == "rami_het01_brf_nir_pp")
      return {c["inputs"]["vza"].get<std::vector<double>>(), c["expected"]["brf"].get<std::vector<double>>()};
  return {};
}

}  // namespace sunfleck::test
