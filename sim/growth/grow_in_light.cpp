#include "sim/growth/grow_in_light.h"

#include <string>

#include "sim/base/error.h"
#include "sim/growth/growing_tree.h"

namespace sunfleck {

void validate(const GrowthOptions& o) {
  if (!(o.years >= 1 && o.years <= 500))
    throw_invalid("growth: years", std::to_string(o.years), "1 to 500 years");
  if (!(o.twig_radius_m > 0 && o.twig_radius_m < 0.1))
    throw_invalid("growth: twig_radius_m", std::to_string(o.twig_radius_m), "metres, above 0");
}

void validate(const BudLight& light) {
  if (!light.new_year || !light.at) throw_invalid("growth: light", "nobody answers", "a BudLight");
}

BudLight light_of(LightGrid& grid) {
  return {[&grid](std::span<const LeafPlace> leaves) { grid.set_leaves(leaves); },
          [&grid](const Vec3& position_m) {
            return grid.has_room(position_m) ? grid.openness(position_m) : 0.0;
          }};
}

GrownTree grow_in_light(const Species& species, const std::filesystem::path& grammar_file,
                        const BudLight& light, const GrowthOptions& options, const RunControl& control) {
  validate(options);
  validate(light);
  auto grammar = std::make_shared<const lsystem::Grammar>(lsystem::Grammar::load(grammar_file));
  growth::GrowingTree tree(species, std::move(grammar), options.seed, control);
  while (tree.years() < options.years) {
    light.new_year(tree.leaves(options.most_leaves));
    tree.grow_a_year(light.at, control);
    control.report("grow", static_cast<double>(tree.years()) / options.years);
    if (options.stop_height_m > 0 && tree.height_m() >= options.stop_height_m) break;
  }
  GrownTree grown{tree.finished(options.twig_radius_m), tree.years()};
  validate(grown.tree, grammar_file.string());
  return grown;
}

}  // namespace sunfleck
