#include "lighting/map/netcdf_handle.h"

#include <cerrno>

#include "sim/base/error.h"
#include "sim/base/pending_file.h"

namespace sunfleck {
namespace {

constexpr std::size_t kMostValues = std::size_t{1} << 34;

std::unique_lock<std::mutex> lock_library() {
  static std::mutex library;
  return std::unique_lock(library);
}

}  // namespace

NetcdfHandle NetcdfHandle::create(const std::filesystem::path& actual, const std::filesystem::path& shown) {
  std::unique_lock lock = lock_library();
  int id = 0;
  const int status = nc_create(actual.c_str(), NC_NETCDF4 | NC_CLOBBER, &id);
  if (status != NC_NOERR) throw_cannot_write(shown, nc_strerror(status));
  return {std::move(lock), id, Mode::kWrite, shown.string()};
}

NetcdfHandle NetcdfHandle::open(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    throw Error(ErrorKind::kNotFound, path.string(), "no such file", "name a light map saved as NetCDF");
  std::unique_lock lock = lock_library();
  int id = 0;
  const int status = nc_open(path.c_str(), NC_NOWRITE, &id);
  if (status == EACCES)
    throw Error(ErrorKind::kInputOutput, path.string(), "cannot be read: permission denied",
                "make it readable for this user");
  if (status != NC_NOERR)
    throw_invalid(path.string(), std::string("is not a whole NetCDF file: ") + nc_strerror(status),
                  "name a light map saved as NetCDF");
  return {std::move(lock), id, Mode::kRead, path.string()};
}

NetcdfHandle::~NetcdfHandle() {
  if (id_ >= 0) nc_close(id_);
}

void NetcdfHandle::close() {
  const int id = id_;
  id_ = -1;
  check(nc_close(id), "closing");
}

void NetcdfHandle::check(int status, const std::string& doing) const {
  if (status == NC_NOERR) return;
  const std::string reason = doing + ": " + nc_strerror(status);
  if (mode_ == Mode::kWrite) throw_cannot_write(shown_, reason);
  throw_invalid(shown_, "cannot be read as a light map, " + reason, "save the light map again");
}

std::size_t NetcdfHandle::dimension(const std::string& name) const {
  int dimension_id = 0;
  std::size_t size = 0;
  check(nc_inq_dimid(id_, name.c_str(), &dimension_id), "dimension " + name);
  check(nc_inq_dimlen(id_, dimension_id, &size), "dimension " + name);
  return size;
}

bool NetcdfHandle::has_variable(const std::string& name) const {
  int variable_id = 0;
  return nc_inq_varid(id_, name.c_str(), &variable_id) == NC_NOERR;
}

std::vector<int> NetcdfHandle::dimensions(int variable) const {
  int rank = 0;
  check(nc_inq_varndims(id_, variable, &rank), "dimensions");
  std::vector<int> all(static_cast<std::size_t>(rank));
  check(nc_inq_vardimid(id_, variable, all.data()), "dimensions");
  return all;
}

std::vector<std::size_t> NetcdfHandle::shape(int variable) const {
  std::vector<std::size_t> sizes;
  for (const int dimension_id : dimensions(variable))
    check(nc_inq_dimlen(id_, dimension_id, &sizes.emplace_back()), "dimensions");
  return sizes;
}

int NetcdfHandle::variable(const std::string& name, const std::vector<std::size_t>& sizes) const {
  int variable_id = 0;
  check(nc_inq_varid(id_, name.c_str(), &variable_id), "variable " + name);
  if (shape(variable_id) != sizes)
    throw_invalid(shown_, "variable " + name + " has another shape than Sunfleck gives it", "save it again");
  return variable_id;
}

std::vector<double> NetcdfHandle::numbers(const std::string& name,
                                          const std::vector<std::size_t>& sizes) const {
  const int id = variable(name, sizes);
  std::size_t count = 1;
  for (const std::size_t size : sizes) {
    if (size > 0 && count > kMostValues / size)
      throw Error(ErrorKind::kLimitExceeded, shown_, "variable " + name + " has too many values",
                  "it is damaged: save it again");
    count *= size;
  }
  std::vector<double> values(count);
  check(nc_get_var_double(id_, id, values.data()), "variable " + name);
  return values;
}

std::vector<std::string> NetcdfHandle::texts(const std::string& name, std::size_t count) const {
  const int id = variable(name, {count});
  nc_type type = NC_NAT;
  check(nc_inq_vartype(id_, id, &type), "variable " + name);
  if (type != NC_STRING) throw_invalid(shown_, "variable " + name + " holds no texts", "save it again");
  std::vector<char*> raw(count, nullptr);
  check(nc_get_var_string(id_, id, raw.data()), "variable " + name);
  std::vector<std::string> all;
  for (const char* text : raw) all.emplace_back(text == nullptr ? "" : text);
  nc_free_string(count, raw.data());
  return all;
}

std::string NetcdfHandle::text_attribute(const std::string& name) const {
  nc_type type = NC_NAT;
  std::size_t length = 0;
  check(nc_inq_att(id_, NC_GLOBAL, name.c_str(), &type, &length), "attribute " + name);
  if (type != NC_CHAR) throw_invalid(shown_, "attribute " + name + " is not text", "save the map again");
  std::string value(length, '\0');
  check(nc_get_att_text(id_, NC_GLOBAL, name.c_str(), value.data()), "attribute " + name);
  return value;
}

// The library writes as many values as the file states, whatever there is room for.
void NetcdfHandle::require_one_value(const std::string& name) const {
  std::size_t length = 0;
  check(nc_inq_attlen(id_, NC_GLOBAL, name.c_str(), &length), "attribute " + name);
  if (length != 1) throw_invalid(shown_, "attribute " + name + " is not one number", "save it again");
}

double NetcdfHandle::number_attribute(const std::string& name) const {
  require_one_value(name);
  double value = 0;
  check(nc_get_att_double(id_, NC_GLOBAL, name.c_str(), &value), "attribute " + name);
  return value;
}

std::uint64_t NetcdfHandle::seed_attribute() const {
  require_one_value("seed");
  unsigned long long seed = 0;
  check(nc_get_att_ulonglong(id_, NC_GLOBAL, "seed", &seed), "attribute seed");
  return seed;
}

void NetcdfHandle::put_text(int variable_id, const std::string& name, const std::string& value) const {
  check(nc_put_att_text(id_, variable_id, name.c_str(), value.size(), value.data()), "attribute " + name);
}

}  // namespace sunfleck
