// Head comment in client.h: unary calls.
#include "server/client/client.h"

#include "server/client/client_state.h"
#include "server/convert/forest_spec_message.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

std::shared_ptr<grpc::Channel> make_channel(const ConnectOptions& options) {
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(64 << 20);
  arguments.SetInt(GRPC_ARG_ENABLE_RETRIES, 0);
  // A server that is being started shall be met within a quarter of a second.
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 250);
  auto credentials = grpc::InsecureChannelCredentials();
  if (!options.tls_roots.empty()) {
    grpc::SslCredentialsOptions tls;
    tls.pem_root_certs = options.tls_roots;
    credentials = grpc::SslCredentials(tls);
  }
  return grpc::CreateCustomChannel(options.target, credentials, arguments);
}

std::chrono::system_clock::time_point seconds_from_now(double seconds) {
  return std::chrono::system_clock::now() +
         std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::duration<double>(seconds));
}

SceneInfo scene_from_message(const v1::Scene& message) {
  const auto vector = [](const v1::Vector3& v) { return Vec3(v.x(), v.y(), v.z()); };
  SceneInfo info;
  info.name = message.name();
  info.forest_name = message.forest_name();
  info.trees = message.tree_count();
  info.elements = message.element_count();
  info.prototypes = message.prototype_count();
  info.memory_bytes = message.memory_bytes();
  info.leaf_area_m2 = message.leaf_area_m2();
  info.bounds_lo_m = vector(message.bounds_lo_m());
  info.bounds_hi_m = vector(message.bounds_hi_m());
  return info;
}

// Every field of a flat message as name and value, so that a new limit shows up without new code here.
std::vector<std::pair<std::string, std::string>> fields_of(const google::protobuf::Message& message) {
  std::vector<std::pair<std::string, std::string>> fields;
  const google::protobuf::Descriptor& type = *message.GetDescriptor();
  const google::protobuf::Reflection& values = *message.GetReflection();
  for (int i = 0; i < type.field_count(); ++i) {
    const google::protobuf::FieldDescriptor* field = type.field(i);
    std::string text;
    switch (field->cpp_type()) {
      case google::protobuf::FieldDescriptor::CPPTYPE_UINT64:
        text = std::to_string(values.GetUInt64(message, field));
        break;
      case google::protobuf::FieldDescriptor::CPPTYPE_UINT32:
        text = std::to_string(values.GetUInt32(message, field));
        break;
      default:
        text = std::to_string(values.GetDouble(message, field));
    }
    fields.emplace_back(field->name(), text);
  }
  return fields;
}

}  // namespace

Client::State::State(const ConnectOptions& given)
    : options(given),
      channel(make_channel(given)),
      scenes(v1::SceneService::NewStub(channel)),
      light(v1::LightService::NewStub(channel)),
      stand_light(v1::StandLightService::NewStub(channel)),
      render(v1::RenderService::NewStub(channel)),
      info(v1::ServerInfoService::NewStub(channel)) {}

WatchedCall::WatchedCall(const ConnectOptions& options, const RunControl& control)
    : on_stop_(control.stop, [this] { context_.TryCancel(); }) {
  if (options.deadline_s > 0) context_.set_deadline(seconds_from_now(options.deadline_s));
}

void throw_unless_ok(const grpc::Status& status) {
  if (!status.ok()) throw error_of(status);
}

Client::Client(const ConnectOptions& options) : state_(std::make_unique<State>(options)) {}
Client::~Client() = default;
Client::Client(Client&&) noexcept = default;
Client& Client::operator=(Client&&) noexcept = default;

void Client::wait_until_ready(double seconds) {
  if (state_->channel->WaitForConnected(seconds_from_now(seconds))) return;
  throw Error(ErrorKind::kInputOutput, state_->options.target, "no server answers",
              "start one with `sunfleck serve`");
}

ServerReport Client::info() {
  WatchedCall call(state_->options, {});
  v1::ServerInfo message;
  throw_unless_ok(state_->info->GetServerInfo(&call.context(), {}, &message));
  ServerReport report{message.version(), message.build(), {}, {}, {}, {}};
  report.methods.assign(message.methods().begin(), message.methods().end());
  for (const v1::SpeciesInfo& s : message.species()) report.species.push_back(s.code() + " " + s.latin());
  report.limits = fields_of(message.limits());
  report.load = fields_of(message.load());
  return report;
}

SceneInfo Client::create_scene(const ForestSpec& spec, const RunControl& control) {
  WatchedCall call(state_->options, control);
  // Growing takes its time: without a deadline of the options the server's longest shall hold.
  if (state_->options.deadline_s <= 0) call.context().set_deadline(seconds_from_now(24 * 3600));
  v1::CreateSceneRequest request;
  fill_message(spec, *request.mutable_spec());
  v1::Scene scene;
  throw_unless_ok(state_->scenes->CreateScene(&call.context(), request, &scene));
  return scene_from_message(scene);
}

SceneInfo Client::get_scene(const std::string& name) {
  WatchedCall call(state_->options, {});
  v1::GetSceneRequest request;
  request.set_name(name);
  v1::Scene scene;
  throw_unless_ok(state_->scenes->GetScene(&call.context(), request, &scene));
  return scene_from_message(scene);
}

std::vector<SceneInfo> Client::list_scenes() {
  std::vector<SceneInfo> all;
  v1::ListScenesRequest request;
  do {
    WatchedCall call(state_->options, {});
    v1::ListScenesResponse page;
    throw_unless_ok(state_->scenes->ListScenes(&call.context(), request, &page));
    for (const v1::Scene& scene : page.scenes()) all.push_back(scene_from_message(scene));
    request.set_page_token(page.next_page_token());
  } while (!request.page_token().empty());
  return all;
}

void Client::delete_scene(const std::string& name) {
  WatchedCall call(state_->options, {});
  v1::DeleteSceneRequest request;
  request.set_name(name);
  v1::DeleteSceneResponse response;
  throw_unless_ok(state_->scenes->DeleteScene(&call.context(), request, &response));
}

}  // namespace sunfleck
