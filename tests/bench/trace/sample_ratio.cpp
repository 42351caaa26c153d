// How many fewer rays per face the reference needs than with random ones, for the same error of the diffuse
// light that comes by a face's own rays (and per element towards the sun): the variance of independent rays
// over that of the rays as they are spread, on crowns of 40,000 leaves.
//   sample_ratio [rays per face ...]
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "lighting/trace/element_error.h"
#include "lighting/trace/kept_rays.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

void run(const char* name, CrownKind kind, const std::vector<int>& rays) {
  const Forest forest = generated_crown({.kind = kind});
  const OpticsTable optics(forest, {.bands = {"PAR", "NIR"}, .soil_albedo = {0.1, 0.2}, .overrides = {}});
  Illumination light;
  light.to_sun = glm::normalize(Vec3(0.45, 0.25, 0.86));
  light.bands = {{400, 100}, {400, 100}};
  PreparedCache cache(1ull << 30);
  const PreparedStore store{cache, {}};
  const RunControl control;
  const trace::KeptRays kept(forest, store, control);
  const auto surfaces = kept.surfaces(true, 0);
  for (const int n : rays) {
    const auto matrix = kept.matrix({}, light, n, nullptr);
    const auto sun = kept.sun({}, light, n, nullptr);
    std::printf("%-8s %4d rays:", name, n);
    for (const std::size_t band : {0u, 1u}) {
      const trace::BandProblem problem{
          surfaces->receivers, *matrix, *sun, surfaces->receivers.optics(optics, band), {400, 100, 0}, n};
      const trace::Radiosity<1> solved = trace::solve(problem, {}, {});
      const trace::SpreadGains gains = trace::spread_gains(problem, solved).leaves;
      std::printf("  %s %.2f times", optics.bands()[band].c_str(), 1 / gains.rays);
      if (band == 1) std::printf("  sun %.2f times", 1 / gains.sun_rays);
    }
    std::printf("\n");
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace sunfleck

int main(int argc, char** argv) {
  std::vector<int> rays;
  for (int i = 1; i < argc; ++i) rays.push_back(std::atoi(argv[i]));
  if (rays.empty()) rays = {16, 64, 256};
  sunfleck::run("sphere", sunfleck::CrownKind::kSphere, rays);
  sunfleck::run("clumped", sunfleck::CrownKind::kClumped, rays);
}
