// bench: error against time of every method on scenes made here. Published figures stand in the README beside
// them.
#include <cstdio>
#include <sstream>

#include "lighting/plan/error_against_time.h"
#include "server/apps/commands.h"
#include "server/apps/outputs.h"
#include "server/apps/scene_file.h"
#include "server/apps/terminal.h"
#include "sim/base/error.h"
#include "sim/base/pending_file.h"
#include "sim/forest/generated_scenes.h"
#include "sim/plant/make_prototype.h"

namespace sunfleck {
namespace {

Forest beech(const BenchOptions& o, const RunControl& control) {
  const SpeciesLibrary library = SpeciesLibrary::load(find_configs(o.configs) / "species");
  const Species& species = library.find("Fagus sylvatica", "bench");
  Forest forest;
  forest.name = "beech";
  forest.materials = {species.material};
  forest.prototypes.push_back(grow_prototype(species, expected_size(species, 30), o.seed, 1.0, control));
  forest.instances.push_back({});
  return forest;
}

std::vector<Forest> scenes(const BenchOptions& o, const RunControl& control) {
  const bool all = o.scenes == "all";
  std::vector<Forest> forests;
  if (all || o.scenes == "sphere")
    forests.push_back(generated_crown({.kind = CrownKind::kSphere, .leaves = o.elements, .seed = o.seed}));
  if (all || o.scenes == "clumped")
    forests.push_back(generated_crown({.kind = CrownKind::kClumped, .leaves = o.elements, .seed = o.seed}));
  if (all || o.scenes == "beech") forests.push_back(beech(o, control));
  if (forests.empty())
    throw_invalid("--scenes", "there is no scene '" + o.scenes + "'", "sphere, clumped, beech or all");
  return forests;
}

// Sun at 35 degrees zenith, 400 W m-2 on the horizontal from the sun and 100 from a uniform sky, per band.
LightRequest sun_and_sky(const BenchOptions& o) {
  LightRequest request;
  const std::vector<std::pair<std::string, double>> known = {{"PAR", 0.10}, {"NIR", 0.25}};
  request.light.to_sun = direction_from_azimuth_zenith(radians_from_degrees(160), radians_from_degrees(35));
  for (const auto& [band, soil] : known)
    if (o.bands == "all" || o.bands == band) {
      request.optics.bands.push_back(band);
      request.optics.soil_albedo.push_back(soil);
      request.light.bands.push_back({400 / request.light.to_sun.z, 100});
    }
  if (request.light.bands.empty())
    throw_invalid("--bands", "there is no band '" + o.bands + "'", "PAR, NIR or all");
  request.reference.seed = o.seed;
  return request;
}

std::string csv_line(const BenchmarkRow& r) {
  std::ostringstream line;
  line << r.scene << ',' << r.band << ',' << r.method << ',' << r.knob << ',' << r.elements << ','
       << r.error.bias << ',' << r.error.element_rms << ',' << r.error.cell_rms << ','
       << r.error.scattered_rms << ',' << r.truth_noise << ',' << r.wall_s << ',' << r.cpu_s << ','
       << r.setup_s << '\n';
  return line.str();
}

void print_row(const BenchmarkRow& r) {
  std::printf("%-8s %-4s %-18s %-8s %8.1f %8.1f %8.1f %9.1f %10s %10s\n", r.scene.c_str(), r.band.c_str(),
              r.method.c_str(), r.knob.c_str(), 100 * r.error.bias, 100 * r.error.element_rms,
              100 * r.error.cell_rms, 100 * r.error.scattered_rms, seconds_text(r.wall_s).c_str(),
              seconds_text(r.setup_s).c_str());
}

void check(const BenchOptions& o) {
  if (o.elements < 1 || o.elements > 5'000'000)
    throw_invalid("--elements", "is out of range", "1 to 5000000");
  if (o.reference_rays < 2 || o.reference_rays > 65536)
    throw_invalid("--reference-rays", "is out of range", "2 to 65536");
  if (o.repeats < 1 || o.repeats > 1000) throw_invalid("--repeats", "is out of range", "1 to 1000");
}

}  // namespace

void run_bench(const BenchOptions& o, const RunControl& control) {
  check(o);
  if (!o.csv.empty()) check_outputs("bench", {{"--csv", o.csv, ".csv"}});
  const LightRequest request = sun_and_sky(o);
  const BenchmarkPlan plan{o.reference_rays,
                           o.repeats,
                           {o.threads},
                           {Method::kSingleScattering, Method::kSpp, Method::kSppG, Method::kEnvelope,
                            Method::kEnvelopeMarched, Method::kGrid}};
  std::string csv =
      "scene,band,method,knob,elements,bias,element_rms,cell_rms,diffuse_rms,truth_noise,wall_s,cpu_s,setup_"
      "s\n";
  std::printf(
      "error in %% of the mean irradiance; diffuse: sky + scattered light only; time: median of %d, %d "
      "threads\n",
      o.repeats, o.threads);
  std::printf("%-8s %-4s %-18s %-8s %8s %8s %8s %9s %10s %10s\n", "scene", "band", "method", "knob", "bias",
              "element", "cell", "diffuse", "time", "of it setup");
  for (const Forest& forest : scenes(o, control)) {
    const std::vector<BenchmarkRow> rows = error_against_time(forest, request, plan, control);
    finish_progress();
    for (const BenchmarkRow& row : rows) {
      print_row(row);
      csv += csv_line(row);
    }
    std::printf("%-8s truth: %d rays per face, own noise %.1f %% per element\n", forest.name.c_str(),
                o.reference_rays, 100 * rows.front().truth_noise);
  }
  if (o.csv.empty()) return;
  write_whole_file(o.csv, csv);
  std::printf("wrote    %s\n", o.csv.c_str());
}

}  // namespace sunfleck
