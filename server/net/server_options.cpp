// Head comment in server_options.h.
#include "server/net/server_options.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <unistd.h>

#include <cstdlib>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

std::filesystem::path resolved(const ConfigTable& table, const std::string& path) {
  if (path.empty()) return {};
  return std::filesystem::path(path).is_absolute() ? std::filesystem::path(path) : table.directory() / path;
}

void read_listen(const ConfigTable& table, ServerOptions& options) {
  if (table.has("unix_socket")) options.unix_socket = resolved(table, table.text("unix_socket"));
  options.tcp_address = table.text_or("tcp_address", options.tcp_address);
  options.tls_certificate = resolved(table, table.text_or("tls_certificate", ""));
  options.tls_key = resolved(table, table.text_or("tls_key", ""));
}

std::uint64_t whole(const ConfigTable& table, const char* key, std::uint64_t fallback, std::int64_t least,
                    std::int64_t most) {
  const Range range{static_cast<double>(least), static_cast<double>(most)};
  return static_cast<std::uint64_t>(table.integer_or(key, static_cast<std::int64_t>(fallback), range));
}

std::uint32_t small(const ConfigTable& table, const char* key, std::uint32_t fallback, std::int64_t least,
                    std::int64_t most) {
  return static_cast<std::uint32_t>(whole(table, key, fallback, least, most));
}

void read_limits(const ConfigTable& table, Limits& limits) {
  constexpr std::int64_t kMostBytes = 1ll << 44;
  limits.message_bytes = whole(table, "message_bytes", limits.message_bytes, 1 << 19, 1 << 30);
  limits.trees_per_spec = whole(table, "trees_per_spec", limits.trees_per_spec, 1, 100'000'000);
  limits.elements_per_scene =
      whole(table, "elements_per_scene", limits.elements_per_scene, 1, 1'000'000'000'000);
  limits.scene_store_bytes = whole(table, "scene_store_bytes", 0, 0, kMostBytes);
  limits.light_map_cache_bytes = whole(table, "light_map_cache_bytes", 0, 0, kMostBytes);
  limits.prepared_bytes = whole(table, "prepared_bytes", 0, 0, kMostBytes);
  limits.request_memory_bytes = whole(table, "request_memory_bytes", 0, 0, kMostBytes);
  limits.bands = small(table, "bands", limits.bands, 1, 10'000);
  limits.overrides = small(table, "overrides", limits.overrides, 0, 100'000);
  limits.image_side_px = small(table, "image_side_px", limits.image_side_px, 1, 16384);
  limits.image_samples = whole(table, "image_samples", limits.image_samples, 1, 1ll << 40);
  limits.query_elements = small(table, "query_elements", limits.query_elements, 1, 30'000);
  limits.stand_sensors = small(table, "stand_sensors", limits.stand_sensors, 0, 1'000'000);
  limits.stand_intervals = small(table, "stand_intervals", limits.stand_intervals, 1, 200'000);
  limits.running_calls = small(table, "running_calls", limits.running_calls, 0, 4096);
  limits.queued_calls = small(table, "queued_calls", limits.queued_calls, 0, 100'000);
  limits.default_deadline_s = table.number_or("default_deadline_s", limits.default_deadline_s, {0.01, 1e6});
  limits.longest_deadline_s = table.number_or("longest_deadline_s", limits.longest_deadline_s, {0.01, 1e6});
  limits.stalled_write_s = table.number_or("stalled_write_s", limits.stalled_write_s, {0.1, 1e5});
  limits.drain_grace_s = table.number_or("drain_grace_s", limits.drain_grace_s, {0, 1e5});
}

// 127.0.0.0/8, ::1 or localhost.
bool is_loopback(const std::string& host) {
  if (host == "localhost") return true;
  in_addr v4{};
  if (inet_pton(AF_INET, host.c_str(), &v4) == 1) return (ntohl(v4.s_addr) >> 24) == 127;
  in6_addr v6{};
  return inet_pton(AF_INET6, host.c_str(), &v6) == 1 && IN6_IS_ADDR_LOOPBACK(&v6);
}

// Host of "host:port" or "[v6]:port".
std::string host_of(const std::string& address) {
  const std::size_t colon = address.rfind(':');
  const std::string port = colon == std::string::npos ? "" : address.substr(colon + 1);
  const bool port_is_number = !port.empty() && port.size() <= 5 &&
                              port.find_first_not_of("0123456789") == std::string::npos &&
                              std::stoi(port) <= 65535;
  if (colon == 0 || !port_is_number) {
    throw_invalid("listen.tcp_address", "'" + address + "' is no address",
                  "host:port, for example 127.0.0.1:50517, or \"\" for none");
  }
  const std::string host = address.substr(0, colon);
  return host.size() > 2 && host.front() == '[' && host.back() == ']' ? host.substr(1, host.size() - 2)
                                                                      : host;
}

}  // namespace

std::filesystem::path ServerOptions::default_unix_socket() {
  if (const char* runtime = std::getenv("XDG_RUNTIME_DIR"); runtime && *runtime) {
    return std::filesystem::path(runtime) / "sunfleck.sock";
  }
  return std::filesystem::temp_directory_path() / ("sunfleck-" + std::to_string(geteuid()) + ".sock");
}

ServerOptions read_server_options(const ConfigTable& root) {
  ServerOptions options;
  if (const auto listen = root.table_if("listen")) read_listen(*listen, options);
  if (const auto species = root.table_if("species")) {
    options.species_folder = resolved(*species, species->text("folder"));
  }
  if (const auto log = root.table_if("log")) {
    options.log_level =
        log->choice_or("level", options.log_level, {"trace", "debug", "info", "warn", "error"});
  }
  if (const auto limits = root.table_if("limits")) read_limits(*limits, options.limits);
  root.reject_unread();
  return options;
}

void validate(const ServerOptions& options) {
  if (options.unix_socket.empty() && options.tcp_address.empty()) {
    throw_invalid("listen", "nothing to listen on", "set unix_socket or tcp_address");
  }
  if (options.unix_socket.native().size() > 100) {
    throw_invalid("listen.unix_socket", "the path is longer than a socket's may be", "at most 100 bytes");
  }
  if (options.tls_certificate.empty() != options.tls_key.empty()) {
    throw_invalid("listen.tls_certificate", "certificate and key belong together", "set both or none");
  }
  if (options.tcp_address.empty()) return;
  const std::string host = host_of(options.tcp_address);
  if (!is_loopback(host) && options.tls_certificate.empty()) {
    throw_invalid("listen.tcp_address", "'" + options.tcp_address + "' can be reached from other machines",
                  "set tls_certificate and tls_key, or listen on 127.0.0.1");
  }
}

}  // namespace sunfleck
