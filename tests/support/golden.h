// Files that tests read: our own golden vectors in tests/golden, and measured data of others that may lie in
// ../shared/data beside the checkout (never copied into it).
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace sunfleck::test {

nlohmann::json golden(const std::string& file);  // tests/golden/<file>, throws if it is not there
std::filesystem::path source_dir();
// ../shared/data/<path> (or $SUNFLECK_SHARED_DATA/<path>); nullopt, with a loud line on stderr, when it is
// absent.
std::optional<std::filesystem::path> shared_data(const std::string& path);
// An empty folder of this test process, removed at exit.
std::filesystem::path scratch_dir();

}  // namespace sunfleck::test
