// The real program on the real command line, and files for it in this test's own folder.
#pragma once

#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/golden.h"

namespace sunfleck::test {

struct Ran {
  int code = -1;
  std::string text;  // stdout and stderr
};

inline Ran run(const std::string& arguments) {
  const std::string command =
      "cd '" + source_dir().string() + "' && '" SUNFLECK_PROGRAM "' " + arguments + " 2>&1";
  Ran ran;
  FILE* pipe = popen(command.c_str(), "r");
  char buffer[4096];
  for (std::size_t n; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) ran.text.append(buffer, n);
  const int status = pclose(pipe);
  ran.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return ran;
}

inline std::filesystem::path write_file(const std::string& name, const std::string& text) {
  const std::filesystem::path path = scratch_dir() / name;
  std::ofstream(path) << text;
  return path;
}

}  // namespace sunfleck::test
