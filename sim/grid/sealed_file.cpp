// Seal: "\nsunfleck-seal-sha256:" + 64 hex digits + "\n". A file without it that says "sunfleck_forest" in
// its first bytes was ours and was cut; one that does not was written by another program.

#include "sim/grid/sealed_file.h"

#include <array>
#include <fstream>
#include <string>

#include "sim/base/error.h"
#include "sim/base/pending_file.h"
#include "sim/base/sha256.h"

namespace sunfleck {

namespace {

constexpr std::string_view kSealMark = "\nsunfleck-seal-sha256:";
constexpr std::size_t kSealSize = kSealMark.size() + 64 + 1;
constexpr std::string_view kForestMark = "sunfleck_forest";
constexpr std::string_view kVdbMagic{" BDV\0\0\0\0", 8};
constexpr const char* kRemedy = "give a .vdb file that sunfleck grow or import wrote";

std::string read_bytes(std::ifstream& in, std::uintmax_t offset, std::size_t count) {
  std::string bytes(count, '\0');
  in.seekg(static_cast<std::streamoff>(offset));
  in.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  in.clear();
  return bytes;
}

std::string hash_of_first(std::ifstream& in, std::uintmax_t size) {
  Sha256 hash;
  std::string block(std::size_t{1} << 20, '\0');
  in.seekg(0);
  while (size > 0) {
    const auto count = static_cast<std::streamsize>(std::min<std::uintmax_t>(size, block.size()));
    if (!in.read(block.data(), count)) break;
    hash.add_bytes(block.data(), static_cast<std::size_t>(count));
    size -= static_cast<std::uintmax_t>(count);
  }
  return hash.hex();
}

[[noreturn]] void throw_unsealed(const std::filesystem::path& path, std::ifstream& in) {
  const std::string head = read_bytes(in, 0, 4096);
  if (head.substr(0, kVdbMagic.size()) != kVdbMagic) {
    throw_invalid(path.string(), head.empty() ? "the file is empty" : "this is no whole .vdb file", kRemedy);
  }
  if (head.find(kForestMark) == std::string::npos) {
    throw_invalid(path.string(), "this .vdb file was written by another program, or is truncated", kRemedy);
  }
  throw_invalid(path.string(), "the file is truncated or was changed by another program", "write it again");
}

void append_seal(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string seal =
      std::string(kSealMark) + hash_of_first(in, std::filesystem::file_size(path)) + "\n";
  std::ofstream out;
  out.exceptions(std::ios::badbit | std::ios::failbit);
  out.open(path, std::ios::binary | std::ios::app);
  out << seal;
  out.close();
}

void write_and_seal(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write) {
  std::ofstream out;
  out.exceptions(std::ios::badbit | std::ios::failbit);
  out.open(path, std::ios::binary | std::ios::trunc);
  write(out);
  out.close();
  append_seal(path);
}

}  // namespace

void write_sealed(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write) {
  PendingFile file(path);
  try {
    write_and_seal(file.path(), write);
  } catch (const std::exception& failure) {
    throw_cannot_write(path, failure.what());
  }
  file.commit();
}

void check_seal(const std::filesystem::path& path, SealCheck check) {
  std::error_code code;
  const auto status = std::filesystem::status(path, code);
  if (!std::filesystem::exists(status)) {
    throw Error(ErrorKind::kNotFound, path.string(), "there is no such file", kRemedy);
  }
  if (!std::filesystem::is_regular_file(status)) throw_invalid(path.string(), "this is not a file", kRemedy);
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    throw Error(ErrorKind::kInputOutput, path.string(), "the file cannot be opened", "check its permissions");
  }
  const std::uintmax_t size = std::filesystem::file_size(path);
  if (size < kSealSize) throw_unsealed(path, in);
  const std::string seal = read_bytes(in, size - kSealSize, kSealSize);
  if (!seal.starts_with(kSealMark)) throw_unsealed(path, in);
  if (check == SealCheck::kPresence) return;
  if (seal.substr(kSealMark.size(), 64) != hash_of_first(in, size - kSealSize)) {
    throw_invalid(path.string(), "the file is damaged: its content does not match its seal",
                  "write or copy it again");
  }
}

}  // namespace sunfleck
