// Where a command will write, checked before any work is done.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sunfleck {

struct Output {
  std::string option;
  std::filesystem::path path;  // empty: not asked for
  std::string extension;       // that it must have; empty: a folder, made where it is missing
};

// Throws Error(kInvalidInput) naming the option: nothing asked for at all, a wrong extension, two outputs of
// one name, a folder in the file's place, a folder that is missing or may not be written to.
void check_outputs(const std::string& command, const std::vector<Output>& outputs);

}  // namespace sunfleck
