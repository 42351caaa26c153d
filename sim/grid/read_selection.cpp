#include "sim/grid/read_selection.h"

#include "sim/base/contract.h"
#include "sim/grid/forest_parts.h"
#include "sim/grid/forest_tables.h"
#include "sim/grid/sealed_file.h"
#include "sim/grid/vdb_archive.h"

namespace sunfleck {
namespace {

bool states_outlines(const ForestDescription& description) {
  return description.outlines.size() == description.forest.prototypes.size() &&
         !description.instances_hash.empty();
}

void require_match(const std::string& found, const std::string& stored, const std::string& what) {
  if (found != stored) throw std::runtime_error(what + " does not match its stored content hash");
}

// "elements_12" -> 12; none for another grid.
std::optional<std::size_t> prototype_of(const std::string& grid) {
  const std::size_t line = grid.rfind('_');
  if (line == std::string::npos || line + 1 == grid.size()) return std::nullopt;
  const std::string kind = grid.substr(0, line);
  if (kind != kElementsGrid && kind != kWoodGrid && kind != kWoodMeshGrid) return std::nullopt;
  std::size_t index = 0;
  for (const char c : grid.substr(line + 1)) {
    if (c < '0' || c > '9' || index > 1'000'000'000) return std::nullopt;
    index = 10 * index + static_cast<std::size_t>(c - '0');
  }
  return index;
}

std::optional<ForestSketch> sketch_of(const std::filesystem::path& path) {
  VdbContent content = read_vdb(path, [](const std::string& name) { return name == kInstancesGrid; });
  ForestSketch sketch{path, description_from_text(content.description), {}};
  if (!states_outlines(sketch.description)) return std::nullopt;
  const TablesByName tables(std::move(content.tables));
  Forest& forest = sketch.description.forest;
  forest.instances = tables.rows(kInstancesGrid, sketch.description.instances, instances_from);
  require_match(content_hash(forest.instances), sketch.description.instances_hash, "the list of trees");
  sketch.outline = {sketch.description.outlines, forest.instances, forest.terrain, forest.period};
  return sketch;
}

Forest forest_of(const ForestSketch& sketch, const std::vector<char>& wanted) {
  const TablesByName tables(read_vdb(sketch.path, [&](const std::string& name) {
                              const auto prototype = prototype_of(name);
                              return prototype && *prototype < wanted.size() && wanted[*prototype];
                            }).tables);
  Forest forest = sketch.description.forest;
  for (std::size_t p = 0; p < wanted.size(); ++p) {
    if (!wanted[p]) continue;
    Prototype& prototype = forest.prototypes[p];
    fill_prototype(tables, p, sketch.description.counts[p], prototype);
    require_match(content_hash(prototype), sketch.description.prototype_hashes[p],
                  "prototype " + prototype.name);
  }
  return forest;
}

}  // namespace

std::optional<ForestSketch> read_sketch(const std::filesystem::path& path) {
  check_seal(path, SealCheck::kPresence);
  auto sketch = read_or_explain(path, [&] { return sketch_of(path); });
  if (sketch) validate(sketch->description.forest);
  return sketch;
}

Forest load_prototypes(const ForestSketch& sketch, const std::vector<char>& wanted) {
  SUNFLECK_EXPECTS(wanted.size() == sketch.description.forest.prototypes.size());
  Forest forest = read_or_explain(sketch.path, [&] { return forest_of(sketch, wanted); });
  validate(forest);
  return forest;
}

}  // namespace sunfleck
