// Head comment in client.h: stand light.
#include "server/client/client.h"
#include "server/client/client_state.h"
#include "server/client/read_stream.h"
#include "server/convert/array_message.h"
#include "server/convert/stand_answer.h"
#include "server/convert/stand_request.h"

namespace sunfleck {
namespace {

v1::StreamStandLightRequest message_of(const std::string& scene, const StandStudySpec& spec) {
  v1::StreamStandLightRequest message;
  message.set_scene(scene);
  fill_message(spec, *message.mutable_stand_light());
  return message;
}

}  // namespace

StandStudy Client::stand_light(const std::string& scene, const StandStudySpec& spec,
                               const RunControl& control) {
  const v1::StreamStandLightRequest message = message_of(scene, spec);
  WatchedCall call(state_->options, control);
  ArrayAssembler arrays;
  const v1::StandLightSummary summary =
      read_arrays(call, *state_->stand_light->StreamStandLight(&call.context(), message), control, arrays);
  return stand_study_from_messages(arrays.finish(), summary, spec);
}

StandCost Client::stand_light_cost(const std::string& scene, const StandStudySpec& spec) {
  WatchedCall call(state_->options, {});
  v1::StandLightCost message;
  throw_unless_ok(
      state_->stand_light->EstimateStandLight(&call.context(), message_of(scene, spec), &message));
  return cost_from_message(message);
}

}  // namespace sunfleck
