#include <cstdio>

#include "server/apps/commands.h"
#include "server/apps/scene_file.h"
#include "server/apps/summary.h"
#include "server/apps/terminal.h"
#include "sim/base/error.h"
#include "sim/grid/forest_file.h"
#include "sim/lsystem/lsystem.h"
#include "sim/plant/make_prototype.h"

namespace sunfleck {
namespace {

// A single plant at the origin.
Forest forest_of_one(Prototype prototype, const std::string& name) {
  Forest forest;
  forest.name = name;
  for (const std::string& m : prototype.materials) forest.materials.push_back({m, {}});
  forest.prototypes.push_back(std::move(prototype));
  forest.instances.push_back({});
  return forest;
}

void print_string(const GrowOptions& o, const RunControl& control) {
  const auto grammar = lsystem::Grammar::load(o.lsystem);
  lsystem::DeriveOptions derive;
  derive.seed = o.seed;
  derive.steps = o.steps;
  std::printf("%s\n", grammar.print(grammar.derive(derive, control)).c_str());
}

Forest grow_scene(const GrowOptions& o, const RunControl& control) {
  const SceneFile scene = read_scene_file(o.scene);
  if (!scene.forest) throw_invalid(o.scene.string(), "has no [forest] table", "say what to grow");
  return grow_forest(*scene.forest, SpeciesLibrary::load(find_configs(o.configs) / "species"), control);
}

}  // namespace

void run_grow(const GrowOptions& o, const RunControl& control) {
  if (o.scene.empty() == o.lsystem.empty())
    throw_invalid("grow", "needs either a scene file or --lsystem", "sunfleck grow scene.toml -o stand.vdb");
  if (!o.lsystem.empty() && o.print) print_string(o, control);
  if (o.output.empty()) {
    if (o.print) return;
    throw_invalid("--output", "is missing", "-o FILE.vdb");
  }
  if (o.output.extension() != ".vdb") throw_invalid("--output", "must end in .vdb", "-o FILE.vdb");
  const Forest forest =
      o.lsystem.empty() ? grow_scene(o, control)
                        : forest_of_one(prototype_from_lsystem(o.lsystem, o.steps, o.seed, "leaf", control),
                                        o.lsystem.stem().string());
  save_forest(forest, o.output);
  finish_progress();
  print_forest(forest);
  std::printf("wrote        %s\n", o.output.c_str());
}

}  // namespace sunfleck
