// Text files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>

namespace sunfleck {

// Writes beside `path` under another name and renames; a failure leaves no file and an old one as it was.
// Throws Error(kInputOutput).
void write_whole_file(const std::filesystem::path& path, std::string_view content);

}  // namespace sunfleck
