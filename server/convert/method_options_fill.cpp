// Head comment in method_options.h: to the wire.
#include "server/convert/method_enums.h"
#include "server/convert/method_options.h"

namespace sunfleck {
namespace {

void fill_reference(const ReferenceOptions& options, v1::ReferenceOptions& message) {
  message.set_seed(options.seed);
  message.set_rays_per_face(options.rays_per_face);
  message.set_sun_rays_per_element(options.sun_rays_per_element);
  message.set_target_relative_error(options.target_relative_error);
  message.set_max_rays_per_face(options.max_rays_per_face);
  message.set_convergence(options.convergence);
  message.set_max_iterations(options.max_iterations);
  message.set_ground_cell_m(options.ground_cell_m);
  message.set_ground(options.ground);
}

void fill_auto(const AutoOptions& options, v1::AutoOptions& message) {
  if (options.tolerance) message.set_tolerance(*options.tolerance);
  if (options.time_s) message.set_time_s(*options.time_s);
  message.set_measure(wire_of(kMeasures, options.measure));
  message.set_layer_m(options.layer_m);
  message.set_layers(options.layers);
}

template <class Options, class Message>
void fill_sweeps(const Options& options, Message& message) {
  message.set_directions(options.directions);
  message.set_cell_m(options.cell_m);
  message.set_convergence(options.convergence);
  message.set_max_iterations(options.max_iterations);
}

void fill_probes(const ProbePlan& plan, v1::ProbeOptions& message) {
  message.set_count(plan.count);
  message.set_paths_per_face(plan.paths_per_face);
  message.set_sun_rays(plan.sun_rays);
  message.set_seed(plan.seed);
}

void fill_spp(const SppOptions& options, v1::SppOptions& message) {
  message.set_sample_directions(options.sample_directions);
  message.set_map_resolution(options.map_resolution);
  message.set_grid_resolution(options.grid_resolution);
  v1::SppMarchedOptions& marched = *message.mutable_marched();
  marched.set_phase(wire_of(kPhases, options.marched.phase));
  marched.set_paths(wire_of(kPaths, options.marched.paths));
  marched.set_cell_m(options.marched.cell_m);
}

void fill_envelope_full(const EnvelopeFullOptions& options, v1::EnvelopeFullOptions& message) {
  message.set_directions(options.directions);
  message.set_sun(wire_of(kSuns, options.sun));
  message.set_angles(wire_of(kAngles, options.angles));
  message.set_bounces(wire_of(kBounces, options.bounces));
  message.set_ground(wire_of(kGrounds, options.ground));
  message.set_weights(wire_of(kWeights, options.weights));
  message.set_own_leaf(wire_of(kOwnLeaves, options.own_leaf));
  message.set_border(wire_of(kBorders, options.border));
  message.set_cell_m(options.cell_m);
}

void fill_links(const LinksOptions& options, v1::LinksOptions& message) {
  message.set_seed(options.seed);
  message.set_links_per_face(options.links_per_face);
  message.set_sun_rays_per_element(options.sun_rays_per_element);
  message.set_convergence(options.convergence);
  message.set_max_iterations(options.max_iterations);
  message.set_ground(options.ground);
  message.set_ground_cell_m(options.ground_cell_m);
}

}  // namespace

void fill_method_options(const LightRequest& request, v1::LightSpec& message) {
  fill_reference(request.reference, *message.mutable_reference());
  fill_spp(request.spp, *message.mutable_spp());
  message.mutable_envelope()->set_cell_m(request.envelope.cell_m);
  fill_envelope_full(request.envelope_full, *message.mutable_envelope_full());
  fill_links(request.links, *message.mutable_links());
  fill_sweeps(request.grid, *message.mutable_grid());
  fill_sweeps(request.world, *message.mutable_world());
  fill_auto(request.automatic, *message.mutable_auto_());
  if (request.probes) fill_probes(*request.probes, *message.mutable_probes());
}

}  // namespace sunfleck
