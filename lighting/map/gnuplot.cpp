#include "lighting/map/gnuplot.h"

#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>

#include "sim/base/error.h"
#include "sim/base/pending_file.h"

extern char** environ;

namespace sunfleck {
namespace {

// Runs gnuplot on a script file; its exit code, -1 where it could not be started.
int run_gnuplot(const std::filesystem::path& script) {
  std::string program = "gnuplot", file = script.string();
  char* arguments[] = {program.data(), file.data(), nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, "gnuplot", nullptr, nullptr, arguments, environ) != 0) return -1;
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

}  // namespace

std::string gnuplot_quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out + "\"";
}

void draw_by_gnuplot(const std::filesystem::path& path,
                     const std::function<std::string(const std::filesystem::path& picture)>& script_for) {
  PendingFile picture(path);
  // The script stands beside the picture while gnuplot reads it and is never renamed into place.
  const std::filesystem::path script_target = path.string() + ".gnuplot";
  const PendingFile script(script_target);
  write_whole_file(script.path(), script_for(picture.path()));
  const int code = run_gnuplot(script.path());
  if (code < 0 || code == 127)
    throw Error(ErrorKind::kInputOutput, path.string(), "gnuplot cannot be started",
                "install the Debian package gnuplot-nox");
  if (code != 0)
    throw Error(ErrorKind::kInputOutput, path.string(), "gnuplot ended with " + std::to_string(code),
                "see what it printed above");
  picture.commit();
}

}  // namespace sunfleck
