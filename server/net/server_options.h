// How a server listens and what it allows: configs/server.toml.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "server/convert/limits.h"
#include "sim/config/config_table.h"

namespace sunfleck {

struct ServerOptions {
  // Unix socket, made for its owner only (0600); empty: none.
  std::filesystem::path unix_socket = default_unix_socket();
  // TCP address "host:port"; empty: none; port 0: any free one. Anything but a loopback address needs TLS.
  std::string tcp_address = "127.0.0.1:50517";
  std::filesystem::path tls_certificate, tls_key;  // PEM; both or none
  std::filesystem::path species_folder = "configs/species";
  std::string log_level = "info";  // trace, debug, info, warn, error
  Limits limits;

  // $XDG_RUNTIME_DIR/sunfleck.sock, else sunfleck-<user id>.sock in the folder for temporary files.
  static std::filesystem::path default_unix_socket();
};

// Reads the tables [listen], [species], [log] and [limits]; every key is read or refused. Relative paths
// start at the file's folder.
ServerOptions read_server_options(const ConfigTable& root);

// Throws Error(kInvalidInput): nothing to listen on, a TCP address that is none, one that others can reach
// without TLS, a certificate without key.
void validate(const ServerOptions& options);

}  // namespace sunfleck
