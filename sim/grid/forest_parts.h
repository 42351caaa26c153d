// Steps that reading a whole forest and reading a part of one share. Private to this folder.
#pragma once

#include <exception>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/base/error.h"
#include "sim/grid/forest_description.h"
#include "sim/grid/point_table.h"

namespace sunfleck {

class TablesByName {
 public:
  explicit TablesByName(std::vector<PointTable> tables) {
    for (PointTable& table : tables) by_name_[table.name] = std::move(table);
  }
  // The rows of a grid by `convert`; none are stored for `count` 0.
  template <class Convert>
  auto rows(const std::string& name, std::uint64_t count, Convert convert) const {
    decltype(convert(PointTable{})) rows;
    if (count == 0) return rows;
    const auto found = by_name_.find(name);
    if (found == by_name_.end()) throw std::runtime_error("grid " + name + " is missing");
    rows = convert(found->second);
    if (rows.size() != count) throw std::runtime_error("grid " + name + " lacks rows");
    return rows;
  }

 private:
  std::map<std::string, PointTable> by_name_;
};

// Foliage and wood of prototype `index`.
void fill_prototype(const TablesByName& tables, std::size_t index, const PrototypeCounts& counts,
                    Prototype& prototype);

// Runs `read` and turns whatever it throws into our error.
template <class Read>
auto read_or_explain(const std::filesystem::path& path, Read read) {
  std::string problem;
  try {
    return read();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& failure) {
    problem = failure.what();
  } catch (...) {
    problem = "unknown failure of the reader";
  }
  throw_invalid(path.string(), "this is no forest that can be read (" + problem + ")",
                "give a .vdb file that sunfleck grow or import wrote");
}

}  // namespace sunfleck
