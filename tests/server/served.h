// A server process under test: `<binary> serve --config FILE` on a Unix socket of its own, and small
// requests.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <string>

#include "lighting/plan/light_request.h"
#include "lighting/render/render.h"
#include "server/client/client.h"
#include "sim/forest/forest_spec.h"

namespace grpc {
class Channel;
}

namespace sunfleck::test {

class ServedProcess {
 public:
  // `limits`: lines of that table of configs/server.toml; no species folder: the shipped one. Returns when
  // the server answers.
  explicit ServedProcess(const std::string& limits = "", std::filesystem::path species_folder = {});
  ~ServedProcess();  // kills it if it still runs
  ServedProcess(const ServedProcess&) = delete;
  ServedProcess& operator=(const ServedProcess&) = delete;

  const std::filesystem::path& socket() const { return socket_; }
  std::string target() const { return "unix:" + socket_.string(); }
  Client client(double deadline_s = 0) const { return Client({target(), deadline_s, {}}); }
  std::shared_ptr<grpc::Channel> channel() const;
  void send_signal(int signal);
  // Exit code; -1 if it does not end within that time, 128 + number if a signal ended it.
  int wait_for_exit(double seconds);
  std::string log() const;

 private:
  std::filesystem::path socket_, config_, log_;
  pid_t process_ = -1;
};

const SpeciesLibrary& species();
// `trees` beeches and pines in a row, each a crown of `elements` leaves or shoots.
ForestSpec row_of_trees(int trees, int elements);
// PAR and NIR, sun and sky; the method's knobs at their defaults but for few rays.
LightRequest noon(Method method);
// Looks at the row from the south.
Camera small_camera();
// Of seconds: takes long with 20,000 elements and can be stopped.
LightRequest slow_request();

double seconds_since(std::chrono::steady_clock::time_point start);
// Names of GetServerInfo's load: "running_calls", "queued_calls", ...
std::size_t load_of(Client& client, const std::string& name);
// Polls until the load is that; the seconds it took, or -1 after `patience_s`.
double wait_for_load(Client& client, const std::string& name, std::size_t value, double patience_s);

}  // namespace sunfleck::test
