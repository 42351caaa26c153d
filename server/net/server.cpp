// Head comment in server.h.
#include "server/net/server.h"

#include <grpc/grpc.h>
#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <thread>

#include "server/handlers/info_handlers.h"
#include "server/handlers/light_handlers.h"
#include "server/handlers/render_handlers.h"
#include "server/handlers/scene_handlers.h"
#include "server/handlers/stand_light_handlers.h"
#include "server/net/listening.h"
#include "sim/base/error.h"
#include "sim/base/version.h"

namespace sunfleck {
namespace {

std::shared_ptr<spdlog::logger> make_logger(const std::string& level) {
  auto logger = std::make_shared<spdlog::logger>("server", std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_pattern("%Y-%m-%dT%H:%M:%S.%e%z %l %v");
  logger->set_level(spdlog::level::from_str(level));
  return logger;
}

constexpr auto kLook = std::chrono::milliseconds(1);
constexpr auto kReaderMoment = std::chrono::milliseconds(250);
constexpr double kStopping_s = 1.0;  // a stopped call needs some 10 ms

// False if calls are left when the time is over.
bool wait_for_calls(const ServerState& state, double seconds) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (state.live_calls > 0 && std::chrono::steady_clock::now() < until) std::this_thread::sleep_for(kLook);
  return state.live_calls == 0;
}

}  // namespace

struct Server::State {
  State(const ServerOptions& given)
      : options((validate(given), given)),
        shared(with_machine_defaults(given.limits), SpeciesLibrary::load(given.species_folder),
               make_logger(given.log_level)) {}

  void add_services(grpc::ServerBuilder& builder);

  const ServerOptions options;
  ScratchFolder scratch;
  ServerState shared;
  SceneHandlers scenes{shared};
  LightHandlers light{shared};
  StandLightHandlers stand_light{shared};
  RenderHandlers render{shared, scratch.path()};
  InfoHandlers info{shared};
  int tcp_port = 0;
  std::unique_ptr<grpc::Server> grpc_server;
};

void Server::State::add_services(grpc::ServerBuilder& builder) {
  builder.RegisterService(&scenes);
  builder.RegisterService(&light);
  builder.RegisterService(&stand_light);
  builder.RegisterService(&render);
  builder.RegisterService(&info);
  const auto message_bytes = static_cast<int>(shared.limits.message_bytes);
  builder.SetMaxReceiveMessageSize(message_bytes);
  builder.SetMaxSendMessageSize(message_bytes);
  // A second server on the same port shall fail, not share its callers.
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
}

Server::Server(const ServerOptions& options) : state_(std::make_unique<State>(options)) {}

Server::~Server() { shutdown(0); }

void Server::start() {
  State& s = *state_;
  // Kept until the process ends: gRPC 1.51 takes up to ten seconds to tear its own threads down (one sleeps
  // in epoll_wait for so long), and a drained server shall be gone at once.
  grpc_init();
  grpc::EnableDefaultHealthCheckService(true);
  grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  refuse_socket_in_use(s.options.unix_socket);
  grpc::ServerBuilder builder;
  s.add_services(builder);
  add_listeners(s.options, builder, s.tcp_port);
  {
    const OwnerOnlyFiles mask;  // the socket is made with rights 0600
    s.grpc_server = builder.BuildAndStart();
  }
  if (!s.grpc_server || (!s.options.tcp_address.empty() && s.tcp_port == 0)) {
    s.grpc_server.reset();
    throw Error(ErrorKind::kInputOutput, "listen", "cannot listen on " + listeners_text(s.options, 0),
                "is the address taken, or the folder of the socket missing?");
  }
  s.shared.log->info("sunfleck {} serves on {}", kVersion, listeners_text(s.options, s.tcp_port));
}

int Server::tcp_port() const { return state_->tcp_port; }

// gRPC's own shutdown closes a connection with the last byte of its last answer, and a peer that writes at
// that moment (an acknowledgement is enough) loses what it has not read yet. So the calls end first, then
// their readers get a moment, then gRPC ends.
void Server::shutdown(double grace_s) {
  State& s = *state_;
  if (!s.grpc_server) return;
  s.shared.draining = true;
  s.grpc_server->GetHealthCheckService()->SetServingStatus(false);
  s.shared.log->info("draining for at most {} s", grace_s);
  if (!wait_for_calls(s.shared, grace_s)) {
    s.shared.ending.request_stop();
    wait_for_calls(s.shared, kStopping_s);
  }
  if (grace_s > 0) std::this_thread::sleep_for(kReaderMoment);
  s.grpc_server->Shutdown(std::chrono::system_clock::now());
  s.grpc_server->Wait();
  // gRPC has told every call that it is over; the last of them may still be on its way out.
  while (s.shared.live_calls > 0) std::this_thread::sleep_for(kLook);
  s.grpc_server.reset();
  s.shared.log->info("drained");
  s.shared.log->flush();
}

}  // namespace sunfleck
