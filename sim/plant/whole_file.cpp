#include "sim/plant/whole_file.h"

#include <unistd.h>

#include <fstream>
#include <string>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

[[noreturn]] void give_up(const std::filesystem::path& path, const std::filesystem::path& partial,
                          const std::string& problem) {
  std::error_code ignored;
  std::filesystem::remove(partial, ignored);
  throw Error(ErrorKind::kInputOutput, path.string(), "cannot be written: " + problem,
              "check that the folder exists, is writable and has space");
}

}  // namespace

void write_whole_file(const std::filesystem::path& path, std::string_view content) {
  std::filesystem::path partial = path;
  partial += "." + std::to_string(::getpid()) + ".partial";
  std::ofstream out(partial, std::ios::binary | std::ios::trunc);
  if (!out) give_up(path, partial, "the file cannot be made");
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  if (!out) give_up(path, partial, "the file system refused the content");
  std::error_code failed;
  std::filesystem::rename(partial, path, failed);
  if (failed) give_up(path, partial, failed.message());
}

}  // namespace sunfleck
