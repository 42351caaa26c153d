#include "server/convert/light_selection_message.h"

#include <set>

#include "sim/base/error.h"
#include "sunfleck/v1/light.pb.h"

namespace sunfleck {

void read_selection(const v1::LightSpec& message, const std::string& field, const Limits& limits,
                    Violations& violations, Selection& selection) {
  const auto size = [](int n) { return static_cast<std::size_t>(n); };
  const std::size_t most = limits.trees_per_spec;
  const bool ids_fit = violations.count(field + ".id_trees", size(message.id_trees_size()), 0, most);
  const bool indexes_fit = violations.count(field + ".instances", size(message.instances_size()), 0, most);
  if (!ids_fit || !indexes_fit) return;
  for (const std::uint32_t id : message.id_trees()) selection.trees.push_back(TreeId{id});
  selection.instances.assign(message.instances().begin(), message.instances().end());
  if (message.has_far_trees_share()) selection.far_trees_share = message.far_trees_share();
  violations.number(field + ".far_trees_share", selection.far_trees_share, 0, 1);
}

void check_selection(const Selection& selection, const Forest& forest, const std::string& field,
                     Violations& violations) {
  if (selection.everything()) return;
  const std::size_t before = violations.all().size();
  std::set<std::uint32_t> known;
  for (const Instance& instance : forest.instances) known.insert(instance.tree.value);
  for (std::size_t i = 0; i < selection.trees.size(); ++i)
    if (!known.contains(selection.trees[i].value))
      violations.add(at(field + ".id_trees", i),
                     "the scene has no tree " + std::to_string(selection.trees[i].value));
  for (std::size_t i = 0; i < selection.instances.size(); ++i)
    if (selection.instances[i] >= forest.instances.size())
      violations.add(at(field + ".instances", i), "must be below " + std::to_string(forest.instances.size()) +
                                                      ", got " + std::to_string(selection.instances[i]));
  if (violations.all().size() > before) return;
  try {
    selected_instances(forest, selection);
  } catch (const Error& error) {
    violations.add(field + (selection.trees.empty() ? ".instances" : ".id_trees"),
                   error.problem() + " (" + error.remedy() + ")");
  }
}

void refuse_selection(const Selection& selection, const std::string& field, Violations& violations) {
  const char* what = "must be left out: a picture shows all trees";
  if (!selection.trees.empty()) violations.add(field + ".id_trees", what);
  if (!selection.instances.empty()) violations.add(field + ".instances", what);
}

void fill_selection(const Selection& selection, v1::LightSpec& message) {
  for (const TreeId tree : selection.trees) message.add_id_trees(tree.value);
  for (const std::uint32_t instance : selection.instances) message.add_instances(instance);
  message.set_far_trees_share(selection.far_trees_share);
}

}  // namespace sunfleck
