// All 76 bidirectional reflectance factors of RAMI HET01 (near infrared, sun at 20 degrees, principal plane)
// beside the published ones. Usage: lighting_render_het01 [paths per view]. Prints a table, the largest and
// the mean difference, and CPU time.
#include <cstdlib>
#include <ctime>

#include "tests/lighting/render/het01.h"

int main(int argc, char** argv) {
  using namespace sunfleck;
  const auto forest = test::het01();
  if (!forest) return 1;
  const test::Het01Case expected = test::het01_case();
  std::vector<Vec3> views;
  for (const double v : expected.view_zenith_deg) views.push_back(test::principal_plane(v));
  ReflectanceOptions options;
  options.samples_per_view = argc > 1 ? std::atoi(argv[1]) : 600000;
  const std::clock_t began = std::clock();
  const auto found = bidirectional_reflectance(*forest, test::het01_optics(*forest),
                                               test::principal_plane(-20), views, options, {});
  double worst = 0, sum = 0, noise = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double off = found[i].value / expected.factor[i] - 1.0;
    std::printf("%5.0f  %.5f +- %.5f  expected %.5f  %+.2f %%\n", expected.view_zenith_deg[i], found[i].value,
                found[i].standard_error, expected.factor[i], 100 * off);
    worst = std::max(worst, std::abs(off));
    sum += std::abs(off);
    noise = std::max(noise, found[i].standard_error / found[i].value);
  }
  std::printf(
      "%zu views, %d paths each: largest difference %.2f %%, mean %.2f %%, noise at most %.2f %%, "
      "%.0f s of CPU\n",
      found.size(), options.samples_per_view, 100 * worst, 100 * sum / static_cast<double>(found.size()),
      100 * noise, static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC);
}
