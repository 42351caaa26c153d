#include "sim/growth/grow_in_light.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "sim/base/error.h"
#include "sim/lsystem/lsystem.h"
#include "sim/plant/grow_foliage.h"
#include "sim/plant/grow_wood.h"
#include "sim/plant/wood_contacts.h"

namespace sunfleck {
namespace {

void require_options(const GrowthOptions& o, const BudLight& light) {
  if (!(o.years >= 1 && o.years <= 500))
    throw_invalid("growth: years", std::to_string(o.years), "1 to 500 years");
  if (!(o.twig_radius_m > 0 && o.twig_radius_m < 0.1))
    throw_invalid("growth: twig_radius_m", std::to_string(o.twig_radius_m), "metres, above 0");
  if (!light.new_year || !light.at) throw_invalid("growth: light", "nobody answers", "a BudLight");
}

lsystem::Environment environment_of(const BudLight& light) {
  return [&light](const lsystem::TurtleState& turtle, std::span<double> parameters) {
    const double answer = light.at(turtle.position_m);
    if (!(answer >= 0 && answer <= 1))
      throw_invalid("growth: light", "the answer " + std::to_string(answer), "light from 0 to 1");
    if (!parameters.empty()) parameters[0] = answer;
  };
}

std::vector<LeafPlace> leaf_places(const lsystem::Drawing& drawing, double leaf_area_m2,
                                   const GrowthOptions& options) {
  if (drawing.organs.size() > options.most_leaves)
    throw Error(ErrorKind::kLimitExceeded, "growth", std::to_string(drawing.organs.size()) + " leaves",
                "fewer years, or a higher limit");
  std::vector<LeafPlace> leaves;
  for (const lsystem::Organ& organ : drawing.organs)
    leaves.push_back({organ.turtle.position_m, leaf_area_m2});
  return leaves;
}

// Wood that carries leaves, without branches that cross others (the leaves of those go with them) and leaves
// in the ground.
Prototype tree_of(const Species& species, lsystem::Drawing drawing, const GrowthOptions& options) {
  std::vector<WoodSegment> wood = piped_wood(drawing, kPipeExponent, kLivingShare);
  for (WoodSegment& s : wood) {
    s.radius_from_m *= static_cast<float>(options.twig_radius_m);
    s.radius_to_m *= static_cast<float>(options.twig_radius_m);
  }
  std::vector<std::int32_t> parents;
  for (const lsystem::Segment& segment : drawing.segments) parents.push_back(segment.parent);
  const std::vector<bool> away = crossing_branches(wood, parents, 0);
  std::erase_if(drawing.organs, [&](const lsystem::Organ& organ) {
    const bool on_crossing = organ.segment >= 0 && away[static_cast<std::size_t>(organ.segment)];
    return on_crossing || organ.turtle.position_m.z <= 0;
  });
  std::vector<std::size_t> leaves(drawing.organs.size());
  std::iota(leaves.begin(), leaves.end(), std::size_t{0});
  const std::vector<bool> carries = carrying_segments(drawing, leaves);
  Prototype tree;
  tree.name = species.latin;
  tree.materials = {species.material.name};
  for (std::size_t i = 0; i < wood.size(); ++i)
    if (carries[i]) tree.wood.push_back(wood[i]);
  if (!leaves.empty())
    tree.foliage = foliage_of(drawing.organs, leaves, species.foliage,
                              template_area_m2(species.foliage) * static_cast<double>(leaves.size()));
  return tree;
}

}  // namespace

BudLight light_of(LightGrid& grid) {
  return {[&grid](std::span<const LeafPlace> leaves) { grid.set_leaves(leaves); },
          [&grid](const Vec3& position_m) {
            return grid.has_room(position_m) ? grid.openness(position_m) : 0.0;
          }};
}

GrownTree grow_in_light(const Species& species, const std::filesystem::path& grammar_file,
                        const BudLight& light, const GrowthOptions& options, const RunControl& control) {
  require_options(options, light);
  const auto grammar = lsystem::Grammar::load(grammar_file);
  lsystem::DeriveOptions derive;
  derive.seed = options.seed;
  derive.environment = environment_of(light);
  lsystem::ModuleString string = grammar.axiom();
  lsystem::Drawing drawing = grammar.interpret(string, lsystem::StartFrame::kTree, derive, control);
  GrownTree grown;
  const double leaf_m2 = template_area_m2(species.foliage);
  while (grown.years < options.years) {
    light.new_year(leaf_places(drawing, leaf_m2, options));
    string = grammar.derive_step(string, grown.years, derive, control);
    drawing = grammar.interpret(string, lsystem::StartFrame::kTree, derive, control);
    ++grown.years;
    control.report("grow", static_cast<double>(grown.years) / options.years);
    if (options.stop_height_m > 0 && drawing.bounds.hi.z >= options.stop_height_m) break;
  }
  grown.tree = tree_of(species, std::move(drawing), options);
  validate(grown.tree, grammar_file.string());
  return grown;
}

}  // namespace sunfleck
