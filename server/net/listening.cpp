// Head comment in listening.h.
#include "server/net/listening.h"

#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_builder.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

std::string file_text(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) {
    throw Error(ErrorKind::kNotFound, path.string(), "cannot be read", "a PEM file");
  }
  return std::move(text).str();
}

std::shared_ptr<grpc::ServerCredentials> tcp_credentials(const ServerOptions& options) {
  if (options.tls_certificate.empty()) return grpc::InsecureServerCredentials();
  grpc::SslServerCredentialsOptions tls;
  tls.pem_key_cert_pairs.push_back({file_text(options.tls_key), file_text(options.tls_certificate)});
  return grpc::SslServerCredentials(tls);
}

bool somebody_answers(const std::filesystem::path& socket_path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, socket_path.c_str(), sizeof address.sun_path - 1);
  const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return false;
  const bool answers = ::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  ::close(fd);
  return answers;
}

}  // namespace

void refuse_socket_in_use(const std::filesystem::path& socket) {
  std::error_code ignored;
  if (socket.empty() || !std::filesystem::exists(socket, ignored)) return;
  if (!std::filesystem::is_socket(socket, ignored)) {
    throw Error(ErrorKind::kInputOutput, socket.string(), "is there and is no socket", "name another path");
  }
  if (somebody_answers(socket)) {
    throw Error(ErrorKind::kInputOutput, socket.string(), "another server answers there",
                "stop it or name another path");
  }
}

void add_listeners(const ServerOptions& options, grpc::ServerBuilder& builder, int& tcp_port) {
  if (!options.unix_socket.empty()) {
    builder.AddListeningPort("unix:" + options.unix_socket.string(), grpc::InsecureServerCredentials());
  }
  if (!options.tcp_address.empty()) {
    builder.AddListeningPort(options.tcp_address, tcp_credentials(options), &tcp_port);
  }
}

std::string listeners_text(const ServerOptions& options, int tcp_port) {
  std::string text;
  if (!options.unix_socket.empty()) text = "unix:" + options.unix_socket.string();
  if (options.tcp_address.empty()) return text;
  if (!text.empty()) text += ", ";
  text += options.tcp_address;
  if (tcp_port != 0) text += " (port " + std::to_string(tcp_port) + ")";
  return text;
}

OwnerOnlyFiles::OwnerOnlyFiles() : before_(::umask(0177)) {}
OwnerOnlyFiles::~OwnerOnlyFiles() { ::umask(before_); }

ScratchFolder::ScratchFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "sunfleck-server-XXXXXX").string();
  if (!::mkdtemp(name.data())) {
    throw Error(ErrorKind::kInputOutput, name, "cannot make a folder for passing files",
                "make the folder for temporary files writable");
  }
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace sunfleck
