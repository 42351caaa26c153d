#include "lighting/map/netcdf_handle.h"

#include <cerrno>

#include "sim/base/error.h"
#include "sim/base/pending_file.h"

namespace sunfleck {
namespace {

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

int NetcdfHandle::variable(const std::string& name, const std::vector<std::size_t>& sizes) const {
  int variable_id = 0, rank = 0;
  check(nc_inq_varid(id_, name.c_str(), &variable_id), "variable " + name);
  check(nc_inq_varndims(id_, variable_id, &rank), "variable " + name);
  std::vector<int> dimensions(static_cast<std::size_t>(rank));
  check(nc_inq_vardimid(id_, variable_id, dimensions.data()), "variable " + name);
  std::vector<std::size_t> found;
  for (const int dimension_id : dimensions)
    check(nc_inq_dimlen(id_, dimension_id, &found.emplace_back()), "variable " + name);
  if (found != sizes)
    throw_invalid(shown_, "variable " + name + " has another shape than a light map's", "save it again");
  return variable_id;
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

void NetcdfHandle::put_text(int variable_id, const std::string& name, const std::string& value) const {
  check(nc_put_att_text(id_, variable_id, name.c_str(), value.size(), value.data()), "attribute " + name);
}

}  // namespace sunfleck
