// Serving until a signal: SIGTERM and SIGINT are taken by one thread that waits for them, so that no handler
// runs in the middle of anything.
#include <csignal>
#include <thread>

#include "server/net/server.h"

namespace sunfleck {
namespace {

sigset_t ending_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  return signals;
}

}  // namespace

int run_server(const ServerOptions& options) {
  const sigset_t signals = ending_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);  // threads started from here on inherit it
  std::signal(SIGPIPE, SIG_IGN);
  Server server(options);
  server.start();
  int signal = 0;
  sigwait(&signals, &signal);
  // A second signal during the drain has its default effect: the impatient can end the process at once.
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  server.shutdown(options.limits.drain_grace_s);
  return 0;
}

}  // namespace sunfleck
