// inventory check: every problem of a tree table with its row and what to do about it.
#include <cstdio>

#include "server/apps/commands.h"
#include "server/apps/scene_file.h"
#include "sim/base/error.h"
#include "sim/forest/inventory.h"
#include "sim/forest/plot_polygon.h"

namespace sunfleck {
namespace {

void print(const InventoryProblem& p) {
  std::printf("%-9s%s: %s\n", p.severity == Severity::kError ? "error" : "warning", p.where.c_str(),
              p.what.c_str());
  if (!p.remedy.empty()) std::printf("         -> %s\n", p.remedy.c_str());
}

// A plot outline that cannot be read is one more problem, and so is every tree outside a good one.
void check_plot(const std::filesystem::path& path, InventoryReading& reading) {
  try {
    const PlotPolygon plot = read_plot_polygon(path);
    for (const InventoryTree& tree : reading.trees)
      if (!contains(plot, {tree.x_m, tree.y_m}))
        reading.problems.push_back({Severity::kWarning, tree.where, "the tree stands outside the plot",
                                    "check x and y and the corners in " + path.string()});
  } catch (const Error& error) {
    reading.problems.push_back({Severity::kError, error.where(), error.problem(), error.remedy()});
  }
}

std::string counted(std::size_t n, const char* one) {
  return std::to_string(n) + " " + one + (n == 1 ? "" : "s");
}

}  // namespace

void run_inventory_check(const InventoryOptions& o) {
  InventoryReading reading =
      check_inventory(o.file, SpeciesLibrary::load(find_configs(o.configs) / "species"));
  if (!o.plot.empty()) check_plot(o.plot, reading);
  std::size_t errors = 0;
  for (const InventoryProblem& p : reading.problems) {
    print(p);
    errors += p.severity == Severity::kError;
  }
  const std::size_t warnings = reading.problems.size() - errors;
  std::printf("%s: %s, %zu of them good; %s, %s\n", o.file.c_str(), counted(reading.rows, "tree").c_str(),
              reading.trees.size(), counted(errors, "error").c_str(), counted(warnings, "warning").c_str());
  std::fflush(stdout);
  if (errors > 0)
    throw_invalid(o.file.string(), "has " + counted(errors, "error"), "mend what is listed and check again");
}

}  // namespace sunfleck
