// Saving: forest -> description + tables + leaf area grids -> .vdb -> seal -> rename. Loading checks the seal
// over all bytes first, so OpenVDB's reader only ever sees files that are whole, and compares the content
// hash last, so what is returned is bit for bit what was saved.

#include "sim/grid/forest_file.h"

#include <limits>
#include <stdexcept>

#include "sim/base/error.h"
#include "sim/grid/forest_description.h"
#include "sim/grid/forest_parts.h"
#include "sim/grid/forest_tables.h"
#include "sim/grid/leaf_area_grid.h"
#include "sim/grid/sealed_file.h"
#include "sim/grid/vdb_archive.h"

namespace sunfleck {

namespace {

constexpr std::size_t kMaxRows = std::numeric_limits<std::int32_t>::max();

void check_size(const std::string& what, std::size_t count) {
  if (count <= kMaxRows) return;
  throw Error(ErrorKind::kLimitExceeded, what, "has " + std::to_string(count) + " rows",
              "a point grid holds at most " + std::to_string(kMaxRows));
}

void check_sizes(const Forest& forest) {
  check_size("instances", forest.instances.size());
  for (const Prototype& p : forest.prototypes) {
    check_size(p.name + " foliage", p.foliage.size());
    check_size(p.name + " wood", p.wood.size());
    check_size(p.name + " wood mesh", p.wood_mesh.size());
  }
}

VdbContent content_of(const Forest& forest) {
  VdbContent content{text_of_description(forest), {}, tables_of(forest)};
  for (std::size_t p = 0; p < forest.prototypes.size(); ++p) {
    if (forest.prototypes[p].foliage.empty()) continue;
    content.densities.push_back(leaf_area_grid(forest.prototypes[p], grid_name(kLeafAreaGrid, p)));
  }
  return content;
}

Forest forest_of(VdbContent content) {
  ForestDescription description = description_from_text(content.description);
  const TablesByName tables(std::move(content.tables));
  Forest& forest = description.forest;
  for (std::size_t p = 0; p < forest.prototypes.size(); ++p) {
    fill_prototype(tables, p, description.counts[p], forest.prototypes[p]);
  }
  forest.instances = tables.rows(kInstancesGrid, description.instances, instances_from);
  if (content_hash(forest) != description.content_hash) {
    throw std::runtime_error("what was read does not match the stored content hash");
  }
  return std::move(forest);
}

}  // namespace

void save_forest(const Forest& forest, const std::filesystem::path& path) {
  validate(forest);
  check_sizes(forest);
  const VdbContent content = content_of(forest);
  write_sealed(path, [&](std::ostream& out) { write_vdb(content, out); });
}

Forest load_forest(const std::filesystem::path& path) {
  check_seal(path, SealCheck::kWholeContent);
  Forest forest = read_or_explain(path, [&] { return forest_of(read_vdb(path)); });
  validate(forest);
  return forest;
}

std::vector<GridSummary> summarize_forest_file(const std::filesystem::path& path) {
  check_seal(path, SealCheck::kPresence);
  return read_or_explain(path, [&] { return summarize_vdb(path); });
}

}  // namespace sunfleck
