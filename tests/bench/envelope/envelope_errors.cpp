// Error of the envelope methods against traced light: for every scene, band and part of the light (direct,
// sky, scattered, all) the bias, the RMS per leaf and the RMS of 4^3 cells, relative to the mean of the part;
// sun and sky traced apart. The reference's own noise per leaf stands beside the whole; it is not taken out.
//   envelope_errors [leaves] [rays]
// Beside it what [Boulanger08] states: sky 5 %, sun 7.5 %, indirect sun 6 %, precomputation 2 s and 40 s for
// 1,500 and 40,000 leaves.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

#include "lighting/base/summaries.h"
#include "lighting/envelope/envelope_full.h"
#include "lighting/trace/reference.h"
#include "sim/base/parallel.h"
#include "sim/forest/generated_scenes.h"
#include "tests/bench/envelope/error_scenes.h"

namespace sunfleck {
namespace {

using Light = std::vector<double>;  // front + back per element

Light part_of(const BandLightMap& band, const std::string& part) {
  Light light;
  for (const ElementLight& e : band.elements) {
    double sum = 0.0;
    for (const FaceLight& f : {e.front, e.back})
      sum += part == "direct"      ? f.direct_w_m2
             : part == "sky"       ? f.sky_w_m2
             : part == "scattered" ? f.scattered_w_m2
                                   : f.total();
    light.push_back(sum);
  }
  return light;
}

double mean_of(const Light& light) {
  double sum = 0.0;
  for (const double l : light) sum += l;
  return sum / static_cast<double>(light.size());
}

struct Errors {
  double bias = 0, leaf = 0, cell = 0;  // %
};

Errors errors(const Light& estimate, const Light& truth, const std::vector<std::size_t>& cells) {
  const double n = static_cast<double>(truth.size()), mean = mean_of(truth);
  Errors e;
  std::vector<double> difference(64), count(64);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double d = (estimate[i] - truth[i]) / mean;
    e.bias += d / n;
    e.leaf += d * d / n;
    difference[cells[i]] += d;
    count[cells[i]] += 1;
  }
  for (std::size_t c = 0; c < 64; ++c)
    if (count[c] > 0) e.cell += difference[c] * difference[c] / count[c] / n;
  return {100 * e.bias, 100 * std::sqrt(e.leaf), 100 * std::sqrt(e.cell)};
}

void print(const std::string& head, const Errors& e) {
  std::printf("%s %+6.1f %5.1f %5.1f\n", head.c_str(), e.bias, e.leaf, e.cell);
}

struct Method {
  const char* name;
  std::function<LightMap(const Forest&, const OpticsTable&, const Illumination&)> run;
};

std::vector<Method> methods() {
  const auto published = [](EnvelopeSun sun) {
    return [sun](const Forest& f, const OpticsTable& o, const Illumination& l) {
      return envelope_light_map(f, o, l, {.sun = sun, .cell_m = 0}, {});
    };
  };
  const auto full = [](int directions) {
    return [directions](const Forest& f, const OpticsTable& o, const Illumination& l) {
      EnvelopeFullOptions options;
      options.directions = directions;
      return envelope_full_light_map(f, o, l, options, {});
    };
  };
  return {{"envelope", published(EnvelopeSun::kPublished)},
          {"envelope_marched", published(EnvelopeSun::kMarched)},
          {"envelope_full 8", full(8)},
          {"envelope_full 14", full(14)},
          {"envelope_full 26", full(26)},
          {"envelope_full 50", full(50)}};
}

void print_times(const Method& method, const LightMap& map) {
  double cpu = 0.0;
  std::string stages;
  for (const StageTime& t : map.provenance.times) {
    cpu += t.cpu_s;
    char text[80];
    std::snprintf(text, sizeof text, ", %s %.1f ms", t.stage.c_str(), 1e3 * t.cpu_s);
    stages += text;
  }
  std::printf("  %-17s %.1f ms of one core%s\n", method.name, 1e3 * cpu, stages.c_str());
}

void compare_scene(const bench::ErrorScene& scene, int leaves, int rays) {
  const Forest forest = scene.make(leaves);
  const OpticsTable optics(forest, {.bands = {"PAR", "NIR"}, .soil_albedo = {0.1, 0.2}, .overrides = {}});
  Illumination sun, sky;
  sun.to_sun = sky.to_sun = glm::normalize(Vec3(0.45, 0.25, 0.73));
  sun.bands = {{400, 0}, {400, 0}};
  sky.bands = {{0, 100}, {0, 100}};
  ReferenceOptions exact;
  exact.rays_per_face = exact.sun_rays_per_element = rays;
  const LightMap truth_sun = reference_light_map(forest, optics, sun, exact, {});
  const LightMap truth_sky = reference_light_map(forest, optics, sky, exact, {});
  const auto cells = bench::cells_of_elements(forest);
  std::printf("%s, %zu elements\n", scene.name, cells.size());
  for (const Method& method : methods()) {
    LightMap own_sun, own_sky;
    with_threads(1, [&] {
      own_sun = method.run(forest, optics, sun);
      own_sky = method.run(forest, optics, sky);
    });
    print_times(method, own_sun);
    for (std::size_t b = 0; b < 2; ++b) {
      const auto line = [&](const char* source, const char* part, const LightMap& own,
                            const LightMap& truth) {
        char head[120];
        std::snprintf(head, sizeof head, "    %-17s %s %s %-9s", method.name, truth.bands[b].band.c_str(),
                      source, part);
        print(head, errors(part_of(own.bands[b], part), part_of(truth.bands[b], part), cells));
      };
      if (b == 0) line("sun", "direct", own_sun, truth_sun);
      if (b == 0) line("sky", "sky", own_sky, truth_sky);
      line("sun", "scattered", own_sun, truth_sun);
      line("sky", "scattered", own_sky, truth_sky);
      line("sun", "all", own_sun, truth_sun);
      line("sky", "all", own_sky, truth_sky);
    }
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace sunfleck

int main(int count, char** words) {
  const int leaves = count > 1 ? std::atoi(words[1]) : 10000, rays = count > 2 ? std::atoi(words[2]) : 64;
  const std::string only = count > 3 ? words[3] : "";
  std::printf("bias, per leaf, per cell, %% of the part's mean; %d leaves, %d rays\n", leaves, rays);
  for (const sunfleck::bench::ErrorScene& scene : sunfleck::bench::error_scenes())
    if (only.empty() || only == scene.name) sunfleck::compare_scene(scene, leaves, rays);
}
