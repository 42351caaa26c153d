// Direct sun per leaf: error against CPU time of shadow rays and of the raster, as a table. The truth of a few
// hundred leaves comes from 4096 spread shadow rays each (error about 0.3 %); errors are RMS over those
// leaves of their direct irradiance, relative to its mean. CPU time is of one thread for all leaves, without
// building the ray scene, which is printed apart. Usage: lighting_trace_sun_error [scene ...].
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <map>

#include "lighting/trace/probe_light.h"
#include "lighting/trace/probe_sun.h"
#include "lighting/trace/sun_raster.h"
#include "lighting/trace/visiting_order.h"
#include "sim/base/parallel.h"
#include "sim/forest/forest_spec.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

double cpu_s() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Sample {
  std::vector<std::size_t> elements;
  std::vector<double> beam, truth;  // irradiance wholly in the sun; true sunlit fraction
};

class Table {
 public:
  Table(const std::string& name, const Forest& forest, double half_angle_deg)
      : name_(name), forest_(forest), index_(forest) {
    light_.to_sun = glm::normalize(Vec3(0.45, 0.25, 0.86));
    light_.sun_half_angle_rad = radians_from_degrees(half_angle_deg);
    const double before = cpu_s();
    scene_ = std::make_unique<ProbeScene>(forest, true, RunControl{});
    std::printf("%s: %zu elements, half angle %g deg, ray scene built in %.3f s\n", name.c_str(),
                index_.element_count(), half_angle_deg, cpu_s() - before);
    take_truth();
  }

  void rays(trace::SunPoints points, const char* kind) {
    const std::vector<std::uint32_t> order = trace::visiting_order(scene_->receivers());
    for (const int n : {4, 16, 64, 256}) {
      if (n > 64 && index_.element_count() > 100000) continue;
      std::vector<float> fraction(index_.element_count()), error(fraction.size());
      const double before = cpu_s();
      for (std::size_t i = 0; i < fraction.size(); ++i) {
        const std::uint32_t e = order[i];
        RandomStream random(1, e, RandomPurpose::kSunRays);
        const auto sun = trace::sun_on_surface(scene_->rays(), trace::SurfaceSampler(scene_->receivers(), e),
                                               light_, n, points, random);
        fraction[e] = static_cast<float>(sun.seen);
        error[e] = static_cast<float>(std::sqrt(sun.seen * (1 - sun.seen) / n));
      }
      print(kind, std::to_string(n), cpu_s() - before, fraction, error);
    }
  }

  void raster() {
    const double side = std::sqrt(forest_leaf_area_m2(forest_) / static_cast<double>(index_.element_count()));
    for (const double part : {0.5, 0.35, 0.25, 0.18, 0.125, 0.09, 0.0625}) picture(part * side, 0);
    picture(0, 0.05);
    picture(0, 0.03);
  }

  void picture(double pixel_m, double target) {
    SunRasterOptions o;
    o.pixel_m = pixel_m;
    if (target > 0) o.target_error = target;
    const double before = cpu_s();
    SunExposure sun;
    with_threads(1, [&] { sun = raster_sun(forest_, index_, light_.to_sun, light_.sun_half_angle_rad, o, {}); });
    char what[80];
    std::snprintf(what, sizeof what, "%.2f mm x %d%s", 1e3 * sun.pixel_m, sun.sun_directions,
                  target > 0 ? " chosen" : "");
    print("raster", what, cpu_s() - before, sun.sunlit_fraction, sun.standard_error);
  }

 private:
  void take_truth() {
    const std::size_t step = std::max<std::size_t>(1, index_.element_count() / 1000);
    for (std::size_t e = 0; e < index_.element_count(); e += step) {
      RandomStream random(99, e, RandomPurpose::kTestScene);
      const auto sun = trace::sun_on_surface(scene_->rays(), trace::SurfaceSampler(scene_->receivers(), e), light_,
                                             4096, trace::SunPoints::kSpread, random);
      const ForestIndex::Place place = index_.place(e);
      sample_.elements.push_back(e);
      sample_.beam.push_back(beam_on_faces(forest_, place.instance, place.local, light_.to_sun).both());
      sample_.truth.push_back(sun.seen);
    }
  }

  void print(const char* kind, const std::string& what, double seconds, const std::vector<float>& fraction,
             const std::vector<float>& error) const {
    double squares = 0, claimed = 0, difference = 0, light = 0;
    for (std::size_t i = 0; i < sample_.elements.size(); ++i) {
      const std::size_t e = sample_.elements[i];
      const double d = sample_.beam[i] * (fraction[e] - sample_.truth[i]);
      squares += d * d;
      difference += d;
      light += sample_.beam[i] * sample_.truth[i];
      claimed += std::pow(sample_.beam[i] * error[e], 2);
    }
    const auto n = static_cast<double>(sample_.elements.size());
    std::printf("  %-14s %-20s cpu %8.4f s  error %6.2f %%  bias %+5.2f %%  squares found/claimed %.2f\n", kind,
                what.c_str(), seconds, 100 * std::sqrt(squares / n) / (light / n), 100 * difference / light,
                claimed > 0 ? squares / claimed : 0.0);
    std::fflush(stdout);
  }

  std::string name_;
  const Forest& forest_;
  ForestIndex index_;
  Illumination light_;
  std::unique_ptr<ProbeScene> scene_;
  Sample sample_;
};

void work_through(const std::string& name, const Forest& forest, double half_angle_deg) {
  Table table(name, forest, half_angle_deg);
  table.rays(trace::SunPoints::kIndependent, "random rays");
  table.rays(trace::SunPoints::kSpread, "lattice rays");
  table.raster();
}

// A stand of 12 crowns that repeats every 8 m.
Forest stand() {
  Forest forest = generated_crown({.leaves = 40000, .radius_m = 1.5, .crown_lai = 4, .seed = 3});
  const Instance first = forest.instances[0];
  forest.instances.clear();
  RandomStream random(5, 0, RandomPurpose::kTestScene);
  for (int i = 0; i < 12; ++i) {
    Instance tree = first;
    tree.position_m += Vec3(2.0 * (i % 4) + random.uniform(), 2.67 * (i / 4) + random.uniform(), 0);
    tree.yaw_rad = static_cast<float>(random.uniform(0, 6));
    forest.instances.push_back(tree);
  }
  forest.period = Period{{0, 0}, {8, 8}};
  return forest;
}

// One tree by its species' grammar.
Forest grown(const char* species, double dbh_cm) {
  ForestSpec spec;
  InventoryTree tree;
  tree.species = species;
  tree.dbh_cm = dbh_cm;
  spec.inventory.push_back(tree);
  return grow_forest(spec, SpeciesLibrary::load(std::string(SUNFLECK_SOURCE_DIR) + "/configs/species"), {});
}

}  // namespace
}  // namespace sunfleck

int main(int argc, char** argv) {
  using namespace sunfleck;
  const std::map<std::string, std::function<void()>> scenes = {
      {"sphere", [] { work_through("sphere", generated_crown({}), 0); }},
      {"clumped", [] { work_through("clumped", generated_crown({.kind = CrownKind::kClumped}), 0); }},
      {"sphere_disc", [] { work_through("sphere", generated_crown({}), 0.265); }},
      {"beech", [] { work_through("beech", grown("Fagus sylvatica", 12), 0); }},
      {"spruce", [] { work_through("spruce", grown("Picea abies", 12), 0); }},
      {"stand", [] { work_through("periodic stand", stand(), 0); }},
  };
  for (const auto& [name, run] : scenes) {
    bool wanted = argc == 1;
    for (int i = 1; i < argc; ++i) wanted = wanted || name == argv[i];
    if (wanted) run();
  }
}
