// An open netCDF file: closes itself, turns the library's codes into Errors that name file and variable.
// The netCDF library keeps state of the whole process and is not safe for threads: a handle holds the
// library's lock for its lifetime, so at most one is open at a time, and never two in one thread.
#pragma once

#include <netcdf.h>

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

namespace sunfleck {

class NetcdfHandle {
 public:
  // Opens `actual` for writing as a new NetCDF-4 file, or for reading; errors name `shown`.
  static NetcdfHandle create(const std::filesystem::path& actual, const std::filesystem::path& shown);
  // Throws Error: kNotFound without a file, kInvalidInput where it is not a (whole) NetCDF-4 file.
  static NetcdfHandle open(const std::filesystem::path& path);
  ~NetcdfHandle();
  NetcdfHandle(const NetcdfHandle&) = delete;
  NetcdfHandle& operator=(const NetcdfHandle&) = delete;
  void close();  // writes what is buffered; throws where that fails

  int id() const { return id_; }
  const std::string& shown() const { return shown_; }
  // Throws kInputOutput (writing) or kInvalidInput (reading) with the library's message unless status is 0.
  void check(int status, const std::string& doing) const;

  std::size_t dimension(const std::string& name) const;
  bool has_variable(const std::string& name) const;
  int variable(const std::string& name, const std::vector<std::size_t>& sizes) const;  // checks its shape
  std::vector<int> dimensions(int variable) const;                                     // ids
  std::vector<std::size_t> shape(int variable) const;                                  // their sizes
  // Of a variable of this shape; what is no number, or no text, is refused.
  std::vector<double> numbers(const std::string& name, const std::vector<std::size_t>& sizes) const;
  std::vector<std::string> texts(const std::string& name, std::size_t count) const;
  // Global ones, of one value.
  std::string text_attribute(const std::string& name) const;
  double number_attribute(const std::string& name) const;
  std::uint64_t seed_attribute() const;
  void put_text(int variable, const std::string& name, const std::string& value) const;

 private:
  void require_one_value(const std::string& name) const;
  enum class Mode { kWrite, kRead };
  NetcdfHandle(std::unique_lock<std::mutex> lock, int id, Mode mode, std::string shown)
      : lock_(std::move(lock)), id_(id), mode_(mode), shown_(std::move(shown)) {}
  std::unique_lock<std::mutex> lock_;
  int id_;
  Mode mode_;
  std::string shown_;
};

}  // namespace sunfleck
