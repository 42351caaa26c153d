// Runs gnuplot (Debian package gnuplot-nox) on a script of ours.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace sunfleck {

// Text in gnuplot's double quotes, without its enhanced mark-up.
std::string gnuplot_quoted(const std::string& text);

// `script_for(picture)` writes into that file, which becomes `path` whole or not at all. Throws
// Error(kInputOutput) where gnuplot is missing (says which package) or refuses.
void draw_by_gnuplot(const std::filesystem::path& path,
                     const std::function<std::string(const std::filesystem::path& picture)>& script_for);

}  // namespace sunfleck
