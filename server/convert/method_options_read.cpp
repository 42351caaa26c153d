// Head comment in method_options.h: from the wire.
#include "server/convert/method_enums.h"
#include "server/convert/method_options.h"

namespace sunfleck {
namespace {

void read_reference(const v1::ReferenceOptions& message, const std::string& field, Violations& violations,
                    ReferenceOptions& options) {
  if (message.has_seed()) options.seed = message.seed();
  if (message.has_rays_per_face()) options.rays_per_face = message.rays_per_face();
  if (message.has_sun_rays_per_element()) options.sun_rays_per_element = message.sun_rays_per_element();
  if (message.has_target_relative_error()) options.target_relative_error = message.target_relative_error();
  if (message.has_max_rays_per_face()) options.max_rays_per_face = message.max_rays_per_face();
  if (message.has_convergence()) options.convergence = message.convergence();
  if (message.has_max_iterations()) options.max_iterations = message.max_iterations();
  if (message.has_ground_cell_m()) options.ground_cell_m = message.ground_cell_m();
  if (message.has_ground()) options.ground = message.ground();
  violations.integer(field + ".rays_per_face", options.rays_per_face, 1, 65536);
  violations.integer(field + ".sun_rays_per_element", options.sun_rays_per_element, 1, 65536);
  violations.number(field + ".target_relative_error", options.target_relative_error, 0, 10);
  violations.integer(field + ".max_rays_per_face", options.max_rays_per_face, 1, 65536);
  violations.above(field + ".convergence", options.convergence, 0, 1);
  violations.integer(field + ".max_iterations", options.max_iterations, 1, 100'000);
  violations.number(field + ".ground_cell_m", options.ground_cell_m, 0, 1e6);
}

void read_spp(const v1::SppOptions& message, const std::string& field, Violations& violations,
              SppOptions& options) {
  if (message.has_sample_directions()) options.sample_directions = message.sample_directions();
  if (message.has_map_resolution()) options.map_resolution = message.map_resolution();
  if (message.has_grid_resolution()) options.grid_resolution = message.grid_resolution();
  if (options.sample_directions != 16 && options.sample_directions != 22)
    violations.add(field + ".sample_directions",
                   "must be 16 or 22, got " + std::to_string(options.sample_directions));
  violations.integer(field + ".map_resolution", options.map_resolution, 8, 1024);
  violations.integer(field + ".grid_resolution", options.grid_resolution, 2, 64);
  const v1::SppMarchedOptions& marched = message.marched();
  read_enum(kPhases, marched.phase(), field + ".marched.phase", violations, options.marched.phase);
  read_enum(kPaths, marched.paths(), field + ".marched.paths", violations, options.marched.paths);
  if (marched.has_cell_m()) options.marched.cell_m = marched.cell_m();
  violations.number(field + ".marched.cell_m", options.marched.cell_m, 0, 1000);
}

void read_envelope_full(const v1::EnvelopeFullOptions& message, const std::string& field,
                        Violations& violations, EnvelopeFullOptions& options) {
  if (message.has_directions()) options.directions = message.directions();
  const int n = options.directions;
  if (n != 8 && n != 14 && n != 26 && n != 50)
    violations.add(field + ".directions", "must be 8, 14, 26 or 50, got " + std::to_string(n));
  read_enum(kSuns, message.sun(), field + ".sun", violations, options.sun);
  read_enum(kAngles, message.angles(), field + ".angles", violations, options.angles);
  read_enum(kBounces, message.bounces(), field + ".bounces", violations, options.bounces);
  read_enum(kGrounds, message.ground(), field + ".ground", violations, options.ground);
  read_enum(kWeights, message.weights(), field + ".weights", violations, options.weights);
  read_enum(kOwnLeaves, message.own_leaf(), field + ".own_leaf", violations, options.own_leaf);
  read_enum(kBorders, message.border(), field + ".border", violations, options.border);
  if (message.has_cell_m()) options.cell_m = message.cell_m();
  violations.number(field + ".cell_m", options.cell_m, 0, 1000);
}

void read_links(const v1::LinksOptions& message, const std::string& field, Violations& violations,
                LinksOptions& options) {
  if (message.has_seed()) options.seed = message.seed();
  if (message.has_links_per_face()) options.links_per_face = message.links_per_face();
  if (message.has_sun_rays_per_element()) options.sun_rays_per_element = message.sun_rays_per_element();
  if (message.has_convergence()) options.convergence = message.convergence();
  if (message.has_max_iterations()) options.max_iterations = message.max_iterations();
  if (message.has_ground()) options.ground = message.ground();
  if (message.has_ground_cell_m()) options.ground_cell_m = message.ground_cell_m();
  violations.integer(field + ".links_per_face", options.links_per_face, 16, 256);
  violations.integer(field + ".sun_rays_per_element", options.sun_rays_per_element, 1, 65536);
  violations.above(field + ".convergence", options.convergence, 0, 1);
  violations.integer(field + ".max_iterations", options.max_iterations, 1, 100'000);
  violations.number(field + ".ground_cell_m", options.ground_cell_m, 0, 1e6);
}

// Grid and world: the same knobs under the same names.
template <class Message, class Options>
void read_sweeps(const Message& message, const std::string& field, Violations& violations, Options& options) {
  if (message.has_directions()) options.directions = message.directions();
  if (message.has_cell_m()) options.cell_m = message.cell_m();
  if (message.has_convergence()) options.convergence = message.convergence();
  if (message.has_max_iterations()) options.max_iterations = message.max_iterations();
  if (options.directions != 8 && options.directions != 14 && options.directions != 26)
    violations.add(field + ".directions", "must be 8, 14 or 26, got " + std::to_string(options.directions));
  violations.number(field + ".cell_m", options.cell_m, 0, 1e6);
  violations.above(field + ".convergence", options.convergence, 0, 0.5);
  violations.integer(field + ".max_iterations", options.max_iterations, 1, 10'000);
}

void read_auto(const v1::AutoOptions& message, const std::string& field, Violations& violations,
               AutoOptions& options) {
  read_enum(kMeasures, message.measure(), field + ".measure", violations, options.measure);
  if (message.has_tolerance()) {
    violations.above(field + ".tolerance", message.tolerance(), 0, 1);
    options.tolerance = message.tolerance();
  }
  if (message.has_time_s()) {
    violations.above(field + ".time_s", message.time_s(), 0, 1e7);
    options.time_s = message.time_s();
  }
  if (message.has_tolerance() && message.has_time_s())
    violations.add(field + ".time_s", "must not be given together with tolerance");
  if (message.has_layer_m()) options.layer_m = message.layer_m();
  if (message.has_layers()) options.layers = message.layers();
  violations.above(field + ".layer_m", options.layer_m, 0, 1e6);
  violations.integer(field + ".layers", options.layers, 0, 10'000);
}

void read_probes(const v1::ProbeOptions& message, const std::string& field, Violations& violations,
                 std::optional<ProbePlan>& probes) {
  ProbePlan& plan = probes.emplace();
  if (message.has_count()) plan.count = message.count();
  if (message.has_paths_per_face()) plan.paths_per_face = message.paths_per_face();
  if (message.has_sun_rays()) plan.sun_rays = message.sun_rays();
  if (message.has_seed()) plan.seed = message.seed();
  violations.integer(field + ".count", plan.count, 16, 1'000'000);
  violations.integer(field + ".paths_per_face", plan.paths_per_face, 2, 65536);
  violations.integer(field + ".sun_rays", plan.sun_rays, 2, 65536);
}

}  // namespace

void read_method_options(const v1::LightSpec& message, const std::string& field, Violations& violations,
                         LightRequest& request) {
  read_reference(message.reference(), field + ".reference", violations, request.reference);
  read_spp(message.spp(), field + ".spp", violations, request.spp);
  if (message.envelope().has_cell_m()) request.envelope.cell_m = message.envelope().cell_m();
  violations.number(field + ".envelope.cell_m", request.envelope.cell_m, 0, 1e6);
  read_envelope_full(message.envelope_full(), field + ".envelope_full", violations, request.envelope_full);
  read_links(message.links(), field + ".links", violations, request.links);
  read_sweeps(message.grid(), field + ".grid", violations, request.grid);
  read_sweeps(message.world(), field + ".world", violations, request.world);
  read_auto(message.auto_(), field + ".auto", violations, request.automatic);
  if (message.has_probes()) read_probes(message.probes(), field + ".probes", violations, request.probes);
}

}  // namespace sunfleck
