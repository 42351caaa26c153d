#include "lighting/links/links_estimator.h"

#include <algorithm>
#include <cmath>

#include "lighting/base/summaries.h"
#include "lighting/links/link_memory.h"
#include "lighting/links/link_result.h"
#include "lighting/links/trace_links.h"
#include "lighting/trace/open_plane.h"
#include "lighting/trace/probe_path.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/base/version.h"

namespace sunfleck {

using namespace links;

namespace {

void check_number(bool good, const std::string& field, const std::string& range) {
  if (!good) throw_invalid("links." + field, "is out of range", range);
}

void check_options(const LinksOptions& o) {
  check_number(o.links_per_face >= 16 && o.links_per_face <= 256, "links_per_face", "16 to 256");
  check_number(o.sun_rays_per_element >= 1 && o.sun_rays_per_element <= 65536, "sun_rays_per_element",
               "1 to 65536");
  check_number(o.convergence > 0.0 && o.convergence <= 1.0, "convergence", "more than 0, at most 1");
  check_number(o.max_iterations >= 1, "max_iterations", "1 or more");
  check_number(std::isfinite(o.ground_cell_m) && o.ground_cell_m >= 0.0, "ground_cell_m",
               "0 (chosen from the scene) or a width in metres");
}

trace::GroundCells ground_of(const Forest& forest, const LinksOptions& options) {
  if (!options.ground) return {};
  try {
    return trace::ground_cells_for(forest, options.ground_cell_m);
  } catch (const Error& e) {  // the field is ours here
    throw Error(e.kind(), "links.ground_cell_m", e.problem(), e.remedy());
  }
}

LinkSources sources_of(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                       const LinksPrepared& prepared, std::size_t band) {
  const BandLight& strength = light.bands[band];
  const Vec3 up = forest.terrain.normal();
  const bool ground = prepared.ground->count() > 0;
  const double above = trace::open_irradiance_w_m2(light, strength, up);
  const double below = ground ? 0.0 : trace::open_irradiance_w_m2(light, strength, -up);
  LinkSources s;
  s.beam_w_m2 = light.sun_is_up() ? strength.beam_normal_w_m2 : 0.0;
  s.diffuse_w_m2 = strength.diffuse_horizontal_w_m2;
  s.ground_beyond_w_m2 = ground && !forest.period ? optics.soil_albedo(band) * above : 0.0;
  s.open_w_m2 = above + below;
  return s;
}

std::vector<float> first_light(const LinkSources& sources, const DirectLight& direct,
                               const OuterLight& outer) {
  std::vector<float> first(outer.sky.size());
  for (std::size_t f = 0; f < first.size(); ++f)
    first[f] = static_cast<float>(first_light_w_m2(sources, direct, outer, f));
  return first;
}

// One band; returns the iterations it took, negative where they were not enough.
int light_band(const LinkProblem& without_light, const LinkSources& sources, const DirectLight& direct,
               const OuterLight& outer, const LinksOptions& options, BandLightMap& map,
               const RunControl& control) {
  const std::vector<float> first = first_light(sources, direct, outer);
  LinkProblem problem = without_light;
  problem.first_light_w_m2 = first;
  const LinkSolution solution = solve(problem, {options.convergence, options.max_iterations}, control);
  fill_band(problem, solution, sources, direct, outer, map, control);
  return solution.converged ? solution.iterations : -solution.iterations;
}

void describe(const Forest& forest, const LinksOptions& options, const LinksPrepared& prepared,
              Provenance& p) {
  p.method = "links";
  p.version = kVersion;
  p.forest_hash = prepared.forest_hash;
  p.seed = options.seed;
  p.settings = {{"links_per_face", std::to_string(prepared.table.links_per_face)},
                {"links_bytes", std::to_string(prepared.table.bytes())},
                {"convergence", std::to_string(options.convergence)},
                {"ground", prepared.ground->count() > 0 ? "on" : "off"}};
  if (prepared.ground->count() > 0)
    p.settings.emplace_back("ground_cell_m", std::to_string(prepared.ground->cell_m.x));
  for (const Prototype& tree : forest.prototypes)
    for (const FoliageElement& e : tree.foliage)
      if (e.shape == ElementShape::kShoot) {
        p.notes.push_back("shoots scatter alike into all directions");
        return;
      }
}

void add_iterations(const OpticsTable& optics, const std::vector<int>& iterations, Provenance& p) {
  int most = 0;
  for (std::size_t b = 0; b < iterations.size(); ++b) {
    most = std::max(most, std::abs(iterations[b]));
    if (iterations[b] < 0)
      p.notes.push_back("band " + optics.bands()[b] + " had not converged after " +
                        std::to_string(-iterations[b]) + " iterations");
  }
  p.settings.emplace_back("iterations", std::to_string(most));
}

void check_prepared(const Forest& forest, const LinksPrepared& prepared, const DirectLight& direct) {
  SUNFLECK_EXPECTS(&prepared.receivers->forest() == &forest);
  SUNFLECK_EXPECTS(direct.on_face.size() == prepared.receivers->face_count());
  SUNFLECK_EXPECTS(direct.sunlit_fraction.size() == prepared.receivers->foliage_count());
}

}  // namespace

LinksPrepared prepare_links(const Forest& forest, const LinksOptions& options, const RunControl& control) {
  check_options(options);
  validate(forest);
  if (ForestIndex(forest).element_count() == 0)
    throw_invalid("forest", "has no foliage", "at least one tree with leaves or shoots");
  control.check();
  LinksPrepared p;
  Provenance spent;
  p.ground = std::make_unique<trace::GroundCells>(ground_of(forest, options));
  p.receivers = std::make_unique<trace::Receivers>(forest, *p.ground);
  if (p.receivers->end_count() > 0x7FFFFFFFu)
    throw Error(
        ErrorKind::kLimitExceeded, "forest",
        std::to_string(p.receivers->two_faced_count()) + " elements and wood surfaces are more than ids",
        "at most 1e9; split the forest or use a faster method");
  check_memory(fewest_bytes(*p.receivers, options.links_per_face), options.links_per_face,
               options.memory_limit_bytes);
  {
    const StageTimer timer(spent, "building ray scene");
    const double rays = 3.0 * options.links_per_face * static_cast<double>(p.receivers->two_faced_count());
    p.rays = std::make_unique<RayScene>(
        forest, RayScene::Options{.ground = options.ground, .expected_rays = rays}, control);
  }
  {
    const StageTimer timer(spent, "tracing links");
    p.table = trace_links({forest, *p.receivers, *p.rays}, options.links_per_face, options.seed,
                          options.memory_limit_bytes, control);
    p.ranges = surface_ranges(p.table, p.ground->count());
    p.forest_hash = content_hash(forest);
  }
  p.times = spent.times;
  return p;
}

links::DirectLight links_direct_light(const LinksPrepared& prepared, const Illumination& light,
                                      const LinksOptions& options, const RunControl& control) {
  check_options(options);
  return direct_light_by_rays(*prepared.receivers, *prepared.rays, light, options.sun_rays_per_element,
                              options.seed, control);
}

links::DirectLight links_given_light(const LinksPrepared& prepared, const Illumination& light,
                                     const LinksOptions& options, std::span<const float> sunlit_fraction,
                                     const RunControl& control) {
  constexpr int kMostRays = 4;  // of wood and ground, whose own light matters little
  check_options(options);
  return direct_light_by_shares(*prepared.receivers, *prepared.rays, light, sunlit_fraction,
                                std::min(options.sun_rays_per_element, kMostRays), options.seed, control);
}

LightMap links_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light_in,
                         const LinksOptions& options, const LinksPrepared& prepared,
                         const links::DirectLight& direct, const RunControl& control) {
  check_options(options);
  check_prepared(forest, prepared, direct);
  const Illumination light = checked(light_in, optics.band_count());
  LightMap map;
  std::vector<int> iterations;
  {
    const StageTimer timer(map.provenance, "iterating");
    const OuterLight outer =
        outer_light(prepared.table, *prepared.receivers, prepared.ranges, light, control);
    map.bands.resize(optics.band_count());
    for (std::size_t b = 0; b < map.bands.size(); ++b) {
      control.report("iterating", static_cast<double>(b) / static_cast<double>(map.bands.size()));
      const std::vector<trace::SurfaceOptics> surfaces = prepared.receivers->optics(optics, b);
      map.bands[b].band = optics.bands()[b];
      iterations.push_back(light_band({prepared.table, *prepared.receivers, prepared.ranges, surfaces, {}},
                                      sources_of(forest, optics, light, prepared, b), direct, outer, options,
                                      map.bands[b], control));
    }
  }
  control.report("iterating", 1.0);
  map.sunlit_fraction = direct.sunlit_fraction;
  summarize(forest, prepared.receivers->index(), optics, map);
  describe(forest, options, prepared, map.provenance);
  add_iterations(optics, iterations, map.provenance);
  return map;
}

LightMap links_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light_in,
                         const LinksOptions& options, const LinksPrepared& prepared,
                         const RunControl& control) {
  const Illumination light = checked(light_in, optics.band_count());
  Provenance spent;
  links::DirectLight direct;
  {
    const StageTimer timer(spent, "tracing sun");
    direct = links_direct_light(prepared, light, options, control);
  }
  LightMap map = links_light_map(forest, optics, light, options, prepared, direct, control);
  Provenance& p = map.provenance;
  p.times.insert(p.times.begin(), spent.times.begin(), spent.times.end());
  p.settings.emplace_back("sun_rays_per_element", std::to_string(options.sun_rays_per_element));
  if (!trace::has_beam(light))
    p.skipped.push_back(
        {"direct sun", light.sun_is_up() ? "no band has a beam" : "the sun is below the horizon", 0.0});
  return map;
}

LightMap links_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                         const LinksOptions& options, const RunControl& control) {
  checked(light, optics.band_count());  // before any work
  const LinksPrepared prepared = prepare_links(forest, options, control);
  LightMap map = links_light_map(forest, optics, light, options, prepared, control);
  std::vector<StageTime>& times = map.provenance.times;
  times.insert(times.begin(), prepared.times.begin(), prepared.times.end());
  return map;
}

}  // namespace sunfleck
