#include "server/apps/commands.h"
#include "server/apps/scene_file.h"
#include "server/net/server.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

ServerOptions read_options(const std::filesystem::path& path) {
  const ConfigTable root = ConfigTable::from_file(path);
  ServerOptions options = read_server_options(root);
  root.reject_unread();
  return options;
}

}  // namespace

void run_serve(const ServeOptions& o) {
  const std::filesystem::path configs = find_configs(o.configs);
  ServerOptions options = read_options(o.config.empty() ? configs / "server.toml" : o.config);
  if (!o.configs.empty()) options.species_folder = configs / "species";
  if (!o.socket.empty()) {
    options.unix_socket = o.socket;
    options.tcp_address.clear();
  }
  if (run_server(options) != 0) throw Error(ErrorKind::kInputOutput, "serve", "did not end in order");
}

}  // namespace sunfleck
