// Head comment in stand_light_handlers.h.
#include "server/handlers/stand_light_handlers.h"

#include "server/convert/stand_answer.h"
#include "server/convert/stand_request.h"
#include "server/handlers/array_stream.h"
#include "server/handlers/unary_call.h"

namespace sunfleck {
namespace {

using StandLightCall = StreamCall<v1::StreamStandLightResponse>;

constexpr const char* kField = "stand_light";

StandStudySpec checked_spec(const v1::StreamStandLightRequest& request, const Limits& limits) {
  Violations violations;
  StandStudySpec spec = stand_spec_from_message(request.stand_light(), kField, limits, violations);
  violations.refuse_if_any();
  return spec;
}

void check_memory(const StandCost& cost, const Limits& limits) {
  if (cost.memory_bytes <= static_cast<double>(limits.request_memory_bytes)) return;
  throw Error(ErrorKind::kLimitExceeded, "request_memory_bytes",
              "the call would need about " + std::to_string(static_cast<std::uint64_t>(cost.memory_bytes)) +
                  " bytes, one call may have " + std::to_string(limits.request_memory_bytes),
              "ask for larger ground cells, fewer intervals, or fewer bands");
}

// What is sent before the computation begins.
v1::StreamStandLightResponse header_of(const StoredScene& scene, const StandStudySpec& spec,
                                       const StandCost& cost) {
  v1::StreamStandLightResponse message;
  v1::StandLightHeader& header = *message.mutable_header();
  header.set_scene(scene.name);
  header.set_tree_count(scene.forest.instances.size());
  header.set_sensor_count(spec.sensors.size());
  fill_message(cost, *header.mutable_cost());
  return message;
}

// What is wrong with the request is told at the request's own fields.
StandStudy study_of(const StoredScene& scene, const StandStudySpec& spec, const RunControl& control) {
  try {
    return run_stand_study(scene.forest, spec, control);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kInvalidInput) throw;
    throw InvalidRequest({violation_of(error, spec, kField)});
  }
}

StandLightCall::Next arrays_then_summary(StandStudy study, const Forest& forest) {
  auto arrays =
      std::make_shared<const StandArrays>(std::make_shared<const StandStudy>(std::move(study)), &forest);
  return arrays_then<v1::StreamStandLightResponse>(
      arrays, arrays->views(), &v1::StreamStandLightResponse::mutable_array,
      [arrays](v1::StreamStandLightResponse& message) { fill_summary(*arrays, *message.mutable_summary()); });
}

}  // namespace

grpc::ServerWriteReactor<v1::StreamStandLightResponse>* StandLightHandlers::StreamStandLight(
    grpc::CallbackServerContext* context, const v1::StreamStandLightRequest* request) {
  return StandLightCall::start(state_, *context, "StreamStandLight",
                               [this, request](StandLightCall& call, const RunControl& control) {
                                 const StandStudySpec spec = checked_spec(*request, state_.limits);
                                 const ScenePtr scene = state_.scenes.find(request->scene());
                                 const StandCost cost = predicted_cost(scene->forest, spec);
                                 check_memory(cost, state_.limits);
                                 call.push(header_of(*scene, spec, cost));
                                 return arrays_then_summary(study_of(*scene, spec, control), scene->forest);
                               });
}

grpc::ServerUnaryReactor* StandLightHandlers::EstimateStandLight(grpc::CallbackServerContext* context,
                                                                 const v1::StreamStandLightRequest* request,
                                                                 v1::StandLightCost* response) {
  return compute_unary(state_, *context, "EstimateStandLight", [this, request, response](const RunControl&) {
    const StandStudySpec spec = checked_spec(*request, state_.limits);
    const ScenePtr scene = state_.scenes.find(request->scene());
    fill_message(predicted_cost(scene->forest, spec), *response);
  });
}

}  // namespace sunfleck
