#include "sim/base/pending_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <string>
#include <system_error>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

namespace fs = std::filesystem;

fs::path followed(const fs::path& target) {
  std::error_code ignored;
  return fs::is_symlink(target, ignored) ? fs::weakly_canonical(target, ignored) : target;
}

fs::path partial_name(const fs::path& target, int attempt) {
  const std::string unique = std::to_string(getpid()) + "-" + std::to_string(attempt);
  return target.parent_path() /
         ("." + target.stem().string() + "." + unique + ".partial" + target.extension().string());
}

// Creates the first free name; exclusive creation keeps two writers of one target apart.
fs::path create_partial(const fs::path& target) {
  for (int attempt = 0; attempt < 1000; ++attempt) {
    fs::path name = partial_name(target, attempt);
    const int descriptor = open(name.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor >= 0) {
      close(descriptor);
      return name;
    }
    if (errno != EEXIST) break;
  }
  throw_cannot_write(target, std::generic_category().message(errno));
}

}  // namespace

void throw_cannot_write(const fs::path& path, const std::string& reason) {
  throw Error(ErrorKind::kInputOutput, path.string(), "cannot be written: " + reason,
              "name a file in an existing folder that you may write to and that has space left");
}

PendingFile::PendingFile(const fs::path& target) : target_(followed(target)) {
  std::error_code ignored;
  if (!target_.has_filename()) throw_cannot_write(target, "no file name");
  if (fs::exists(target_, ignored) && !fs::is_regular_file(target_, ignored))
    throw_cannot_write(target, "it exists and is not a regular file");
  partial_ = create_partial(target_);
}

PendingFile::~PendingFile() {
  std::error_code ignored;
  if (!committed_) fs::remove(partial_, ignored);
}

void PendingFile::commit() {
  std::error_code failure;
  fs::rename(partial_, target_, failure);
  if (failure) throw_cannot_write(target_, failure.message());
  committed_ = true;
}

void write_whole_file(const fs::path& path, std::string_view content) {
  PendingFile file(path);
  std::ofstream out(file.path(), std::ios::binary | std::ios::trunc);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  if (!out) throw_cannot_write(path, "the file system refused the content");
  file.commit();
}

}  // namespace sunfleck
