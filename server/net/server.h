// A running server. gRPC stays behind it.
#pragma once

#include <memory>

#include "server/net/server_options.h"

namespace sunfleck {

class Server {
 public:
  // Loads the species; does not listen yet. Throws Error for wrong options.
  explicit Server(const ServerOptions& options);
  ~Server();  // as shutdown(0)
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  // Listens. Throws Error(kInputOutput) if an address is taken or cannot be opened.
  void start();
  int tcp_port() const;  // 0: none
  // Refuses new calls, lets running ones finish for at most `grace_s`, then stops them. Returns when all are
  // over.
  void shutdown(double grace_s);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Serves until SIGTERM or SIGINT, then drains; a second signal ends the process at once. Returns the exit
// code: 0 after a drain. To be called before other threads are started, so that they all leave the signals to
// it.
int run_server(const ServerOptions& options);

}  // namespace sunfleck
