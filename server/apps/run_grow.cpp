#include <cstdio>

#include "lighting/plan/growth_light.h"
#include "server/apps/commands.h"
#include "server/apps/outputs.h"
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
  derive.seed = o.seed.value_or(1);
  derive.steps = o.steps;
  std::printf("%s\n", grammar.print(grammar.derive(derive, control)).c_str());
}

Forest grow_scene(const GrowOptions& o, std::vector<std::string>& notes, const RunControl& control) {
  const SceneFile scene = read_scene_file(o.scene);
  if (!scene.forest) throw_invalid(o.scene.string(), "has no [forest] table", "say what to grow");
  ForestSpec spec = *scene.forest;
  if (o.seed) spec.seed = *o.seed;
  return grow_lit_forest(spec, SpeciesLibrary::load(find_configs(o.configs) / "species"), control, &notes);
}

}  // namespace

void run_grow(const GrowOptions& o, const RunControl& control) {
  if (o.scene.empty() == o.lsystem.empty())
    throw_invalid("grow", "needs either a scene file or --lsystem", "sunfleck grow scene.toml -o stand.vdb");
  if (o.lsystem.empty() && (o.print || o.steps >= 0))
    throw_invalid(o.print ? "--print" : "--steps", "belongs to --lsystem", "leave it out for a scene file");
  if (!o.output.empty()) check_outputs("grow", {{"-o", o.output, ".vdb"}});
  if (!o.lsystem.empty() && o.print) print_string(o, control);
  if (o.output.empty()) {
    if (o.print) return;
    throw_invalid("--output", "is missing", "-o FILE.vdb");
  }
  std::vector<std::string> notes;
  const Forest forest =
      o.lsystem.empty()
          ? grow_scene(o, notes, control)
          : forest_of_one(prototype_from_lsystem(o.lsystem, o.steps, o.seed.value_or(1), "leaf", control),
                          o.lsystem.stem().string());
  save_forest(forest, o.output);
  finish_progress();
  print_forest(forest);
  for (const std::string& note : notes) std::printf("note         %s\n", note.c_str());
  std::printf("wrote        %s\n", o.output.c_str());
}

}  // namespace sunfleck
