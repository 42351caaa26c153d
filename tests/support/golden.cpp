#include "tests/support/golden.h"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

namespace sunfleck::test {

std::filesystem::path source_dir() { return SUNFLECK_SOURCE_DIR; }

nlohmann::json golden(const std::string& file) {
  std::ifstream in(source_dir() / "tests/golden" / file);
  if (!in) throw std::runtime_error("missing tests/golden/" + file);
  return nlohmann::json::parse(in);
}

std::optional<std::filesystem::path> shared_data(const std::string& path) {
  const char* root = std::getenv("SUNFLECK_SHARED_DATA");
  const std::filesystem::path file =
      (root ? std::filesystem::path(root) : source_dir() / ".." / "shared" / "data") / path;
  if (std::filesystem::exists(file)) return file;
  std::cerr << "\n*** NOT TESTED: measured data '" << path << "' is absent (looked for " << file.string()
            << "; set SUNFLECK_SHARED_DATA) ***\n\n";
  return std::nullopt;
}

std::filesystem::path scratch_dir() {
  struct Scratch {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("sunfleck-test-" + std::to_string(::getpid()));
    Scratch() { std::filesystem::create_directories(path); }
    ~Scratch() {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }
  };
  static const Scratch scratch;
  return scratch.path;
}

}  // namespace sunfleck::test
