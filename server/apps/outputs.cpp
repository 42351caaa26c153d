#include "server/apps/outputs.h"

#include <unistd.h>

#include <set>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

namespace fs = std::filesystem;

// A folder to write into: there and ours, or to be made in one that is.
void check_folder(const Output& o) {
  const fs::path whole = fs::absolute(o.path).lexically_normal();
  const fs::path above = (whole.has_filename() ? whole : whole.parent_path()).parent_path();
  if (fs::exists(o.path) && !fs::is_directory(o.path))
    throw_invalid(o.option, o.path.string() + " is a file", "the name of a folder");
  const fs::path& existing = fs::is_directory(o.path) ? o.path : above;
  if (!fs::is_directory(existing))
    throw_invalid(o.option, "there is no folder " + existing.string(), "an existing folder");
  if (::access(existing.c_str(), W_OK) != 0)
    throw_invalid(o.option, existing.string() + " may not be written to", "a folder of yours");
}

void check_place(const Output& o) {
  if (o.extension.empty()) return check_folder(o);
  const fs::path folder = o.path.has_parent_path() ? o.path.parent_path() : fs::path(".");
  if (o.path.extension() != o.extension)
    throw_invalid(o.option, "'" + o.path.string() + "' does not end in " + o.extension,
                  o.option + " FILE" + o.extension);
  if (fs::is_directory(o.path))
    throw_invalid(o.option, o.path.string() + " is a folder", "the name of a file");
  if (!fs::is_directory(folder))
    throw_invalid(o.option, "there is no folder " + folder.string(), "an existing folder");
  if (::access(folder.c_str(), W_OK) != 0)
    throw_invalid(o.option, folder.string() + " may not be written to", "a folder of yours");
}

}  // namespace

void check_outputs(const std::string& command, const std::vector<Output>& outputs) {
  std::set<fs::path> names;
  std::string options;
  for (const Output& o : outputs) {
    options += (options.empty() ? "" : " or ") + o.option +
               (o.extension.empty() ? " FOLDER" : " FILE" + o.extension);
    if (o.path.empty()) continue;
    check_place(o);
    if (!names.insert(fs::weakly_canonical(o.path)).second)
      throw_invalid(o.option, o.path.string() + " is named twice", "a file of its own for each output");
  }
  if (names.empty()) throw_invalid(command, "nowhere to write", options);
}

}  // namespace sunfleck
