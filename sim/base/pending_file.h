// A file that appears whole or not at all: written beside its target under another name, renamed at the end.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace sunfleck {

// Creates an empty file `.<stem>.<unique>.partial<extension>` in the target's folder; a target that is a link
// is followed. The destructor removes it unless commit() renamed it onto the target. Throws
// Error(kInputOutput) naming the target: folder missing or not writable, target not a regular file, rename
// refused.
class PendingFile {
 public:
  explicit PendingFile(const std::filesystem::path& target);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  const std::filesystem::path& path() const { return partial_; }
  void commit();

 private:
  std::filesystem::path target_, partial_;
  bool committed_ = false;
};

// A whole text file at once.
void write_whole_file(const std::filesystem::path& path, std::string_view content);

[[noreturn]] void throw_cannot_write(const std::filesystem::path& path, const std::string& reason);

}  // namespace sunfleck
