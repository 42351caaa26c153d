// Whole files or none: a seal (SHA-256 of all bytes before it) at the end of a file tells a whole file from
// a truncated or damaged one before any reader walks into it. Readers of .vdb ignore bytes after the grids.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>

namespace sunfleck {

// Lets `write` fill a temporary file beside `path`, seals it and renames it to `path`. Whatever fails, no
// temporary file stays and an earlier `path` is untouched; throws Error(kInputOutput).
void write_sealed(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

enum class SealCheck {
  kWholeContent,  // hashes every byte
  kPresence       // looks for the seal only
};

// Throws Error: kNotFound without a file, kInputOutput if it cannot be read, kInvalidInput with the reason
// (no .vdb file, written by another program, truncated, damaged).
void check_seal(const std::filesystem::path& path, SealCheck check);

}  // namespace sunfleck
