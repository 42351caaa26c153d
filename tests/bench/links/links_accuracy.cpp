// Accuracy and cost of the links method on crowns, grown trees and stands: RMS error of the diffuse light per
// leaf and of its parts against probes, the noise of the probes taken out by two independent lots of them
// (the mean product of the differences to both is the square of the links' own error).
//   links_accuracy [links per face] [probes, 0: cost alone] [scene ...]
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <map>
#include <string>

#include "lighting/links/links_estimator.h"
#include "lighting/trace/probe_light.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"
#include "sim/forest/forest_spec.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

double cpu_s() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// Trees by their species' grammar in rows; `side` along an edge.
Forest grown(const char* species, double dbh_cm, int side, double spacing_m) {
  ForestSpec spec;
  for (int i = 0; i < side * side; ++i) {
    InventoryTree tree;
    tree.id = TreeId{static_cast<std::uint32_t>(i + 1)};
    tree.species = species;
    tree.dbh_cm = dbh_cm + 0.5 * (i % 5);
    tree.x_m = spacing_m * (i % side);
    tree.y_m = spacing_m * (i / side);
    spec.inventory.push_back(tree);
  }
  return grow_forest(spec, SpeciesLibrary::load(std::string(SUNFLECK_SOURCE_DIR) + "/configs/species"), {});
}

// 25 turned crowns of one prototype.
Forest rows_of_crowns(CrownKind kind, double spacing_m) {
  Forest forest = generated_crown({.kind = kind, .leaves = 4000, .seed = 3});
  const Instance first = forest.instances[0];
  forest.instances.clear();
  RandomStream random(5, 0, RandomPurpose::kTestScene);
  for (int i = 0; i < 25; ++i) {
    Instance tree = first;
    tree.position_m += Vec3(spacing_m * (i % 5), spacing_m * (i / 5), 0);
    tree.yaw_rad = static_cast<float>(random.uniform(0, 6));
    forest.instances.push_back(tree);
  }
  return forest;
}

Illumination sun_and_sky() {
  Illumination light;
  light.to_sun = glm::normalize(Vec3(0.45, 0.25, 0.86));
  light.bands = {{400, 100}, {400, 100}};
  return light;
}

// Both faces.
struct Diffuse {
  double sky = 0, scattered = 0;
};
Diffuse of(const ElementLight& e) {
  return {static_cast<double>(e.front.sky_w_m2) + e.back.sky_w_m2,
          static_cast<double>(e.front.scattered_w_m2) + e.back.scattered_w_m2};
}
Diffuse of(const ProbeBand& p) {
  return {p.front.sky_w_m2 + p.back.sky_w_m2, p.front.scattered_w_m2 + p.back.scattered_w_m2};
}

struct Errors {
  double both = 0, sky = 0, scattered = 0, bias = 0;  // relative to the mean of diffuse light
};

Errors errors(const LightMap& map, std::size_t band, const std::vector<ProbeLight>& a,
              const std::vector<ProbeLight>& b) {
  double both = 0, sky = 0, scattered = 0, mean = 0, difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Diffuse x = of(map.bands[band].elements[a[i].element]), ta = of(a[i].bands[band]),
                  tb = of(b[i].bands[band]);
    sky += (x.sky - ta.sky) * (x.sky - tb.sky);
    scattered += (x.scattered - ta.scattered) * (x.scattered - tb.scattered);
    both += (x.sky + x.scattered - ta.sky - ta.scattered) * (x.sky + x.scattered - tb.sky - tb.scattered);
    mean += 0.5 * (ta.sky + ta.scattered + tb.sky + tb.scattered);
    difference += x.sky + x.scattered - 0.5 * (ta.sky + ta.scattered + tb.sky + tb.scattered);
  }
  const auto n = static_cast<double>(a.size());
  const auto rms = [&](double squares) { return std::sqrt(std::max(0.0, squares) * n) / mean; };
  return {rms(both), rms(sky), rms(scattered), difference / mean};
}

void run(const std::string& name, const Forest& forest, int links_per_face, int probes) {
  const OpticsTable optics(forest, {.bands = {"PAR", "NIR"}, .soil_albedo = {0.1, 0.2}, .overrides = {}});
  const std::size_t count = ForestIndex(forest).element_count();
  std::vector<std::size_t> elements;
  RandomStream random(7, 0, RandomPurpose::kProbeDraw);
  for (int i = 0; i < probes; ++i) elements.push_back(random.below(static_cast<std::uint32_t>(count)));
  const LinksOptions options{.links_per_face = links_per_face};
  const ProbeScene scene(forest, true, {});
  std::vector<ProbeLight> lots[2];
  for (const std::size_t i : {0u, 1u})
    lots[i] = probe_light(scene, optics, sun_and_sky(), elements,
                          {.seed = 100 + i, .paths_per_face = 128, .sun_rays = 2}, {});
  LightMap map;
  double prepared_s = 0, solved_s = 0;
  std::uint64_t bytes = 0;
  with_threads(1, [&] {
    double before = cpu_s();
    const LinksPrepared prepared = prepare_links(forest, options, {});
    prepared_s = cpu_s() - before;
    bytes = prepared.table.bytes();
    const links::DirectLight direct = links_direct_light(prepared, sun_and_sky(), options, {});
    before = cpu_s();
    map = links_light_map(forest, optics, sun_and_sky(), options, prepared, direct, {});
    solved_s = cpu_s() - before;
  });
  std::printf("%-14s %7zu elements, %3d links: %6.2f s, two bands %5.3f s, %4.0f MB |", name.c_str(), count,
              links_per_face, prepared_s, solved_s, static_cast<double>(bytes) / 1e6);
  for (const std::size_t b : {0u, 1u}) {
    if (probes == 0) break;
    const Errors e = errors(map, b, lots[0], lots[1]);
    std::printf(" %s diffuse %5.2f sky %5.2f scattered %5.2f bias %+5.2f %%", map.bands[b].band.c_str(),
                100 * e.both, 100 * e.sky, 100 * e.scattered, 100 * e.bias);
  }
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace
}  // namespace sunfleck

int main(int argc, char** argv) {
  using namespace sunfleck;
  const std::map<std::string, std::function<Forest()>> scenes = {
      {"sphere", [] { return generated_crown({}); }},
      {"clumped", [] { return generated_crown({.kind = CrownKind::kClumped}); }},
      {"beech", [] { return grown("Fagus sylvatica", 12, 1, 0); }},
      {"spruce", [] { return grown("Picea abies", 12, 1, 0); }},
      {"spruce30", [] { return grown("Picea abies", 30, 1, 0); }},
      {"rows", [] { return rows_of_crowns(CrownKind::kSphere, 3); }},
      {"rows_touching", [] { return rows_of_crowns(CrownKind::kClumped, 1.6); }},
      {"beeches", [] { return grown("Fagus sylvatica", 14, 4, 2.5); }},
      {"spruces", [] { return grown("Picea abies", 12, 3, 2); }},
  };
  const int links = argc > 1 ? std::atoi(argv[1]) : 64;
  const int probes = argc > 2 ? std::atoi(argv[2]) : 3000;
  for (const auto& [name, make] : scenes) {
    bool wanted = argc <= 3;
    for (int i = 3; i < argc; ++i) wanted = wanted || name == argv[i];
    if (wanted) run(name, make(), links, probes);
  }
}
