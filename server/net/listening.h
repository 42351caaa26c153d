// Where a server listens: sockets, credentials, and a private folder for what passes through.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>

#include "server/net/server_options.h"

namespace grpc {
class ServerBuilder;
}

namespace sunfleck {

// Throws Error(kInputOutput) if another server answers on that socket; a socket that nobody serves any more
// is left to be replaced.
void refuse_socket_in_use(const std::filesystem::path& socket);

// `tcp_port` is set when the server has started.
void add_listeners(const ServerOptions& options, grpc::ServerBuilder& builder, int& tcp_port);

// For the log and for messages: "unix:..., 127.0.0.1:50517".
std::string listeners_text(const ServerOptions& options, int tcp_port);

// While it lives, files and sockets this process makes are its owner's only.
class OwnerOnlyFiles {
 public:
  OwnerOnlyFiles();
  ~OwnerOnlyFiles();
  OwnerOnlyFiles(const OwnerOnlyFiles&) = delete;
  OwnerOnlyFiles& operator=(const OwnerOnlyFiles&) = delete;

 private:
  mode_t before_;
};

// An empty folder (0700) that is removed with its content.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace sunfleck
