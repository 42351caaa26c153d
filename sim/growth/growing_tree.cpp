#include "sim/growth/growing_tree.h"

#include <numeric>
#include <string>

#include "sim/base/error.h"
#include "sim/plant/grow_foliage.h"
#include "sim/plant/grow_wood.h"
#include "sim/plant/wood_contacts.h"

namespace sunfleck::growth {
namespace {

lsystem::Environment environment_of(const LightAt& light) {
  return [&light](const lsystem::TurtleState& turtle, std::span<double> parameters) {
    const double answer = light(turtle.position_m);
    if (!(answer >= 0 && answer <= 1))
      throw_invalid("growth: light", "the answer " + std::to_string(answer), "light from 0 to 1");
    if (!parameters.empty()) parameters[0] = answer;
  };
}

// Drawing asks too, and uses no answer.
void nobody(const lsystem::TurtleState&, std::span<double>) {}

std::vector<WoodSegment> wood_of(const lsystem::Drawing& drawing, double twig_radius_m) {
  std::vector<WoodSegment> wood = piped_wood(drawing, kPipeExponent, kLivingShare);
  for (WoodSegment& s : wood) {
    s.radius_from_m *= static_cast<float>(twig_radius_m);
    s.radius_to_m *= static_cast<float>(twig_radius_m);
  }
  return wood;
}

void drop_crossing(const std::vector<WoodSegment>& wood, lsystem::Drawing& drawing) {
  std::vector<std::int32_t> parents;
  for (const lsystem::Segment& segment : drawing.segments) parents.push_back(segment.parent);
  const std::vector<bool> away = crossing_branches(wood, parents, 0);
  std::erase_if(drawing.organs, [&](const lsystem::Organ& organ) {
    const bool on_crossing = organ.segment >= 0 && away[static_cast<std::size_t>(organ.segment)];
    return on_crossing || organ.turtle.position_m.z <= 0;
  });
}

}  // namespace

GrowingTree::GrowingTree(const Species& species, std::shared_ptr<const lsystem::Grammar> grammar,
                         std::uint64_t seed, const RunControl& control)
    : species_(species), grammar_(std::move(grammar)) {
  derive_.seed = seed;
  derive_.environment = nobody;
  string_ = grammar_->axiom();
  drawing_ = grammar_->interpret(string_, lsystem::StartFrame::kTree, derive_, control);
}

std::vector<LeafPlace> GrowingTree::leaves(std::size_t most_leaves) const {
  if (drawing_.organs.size() > most_leaves)
    throw Error(ErrorKind::kLimitExceeded, "growth", std::to_string(drawing_.organs.size()) + " leaves",
                "fewer years, or a higher limit");
  const double area_m2 = template_area_m2(species_.foliage);
  std::vector<LeafPlace> leaves;
  for (const lsystem::Organ& organ : drawing_.organs)
    leaves.push_back({organ.turtle.position_m, area_m2, organ.turtle.up});
  return leaves;
}

void GrowingTree::grow_a_year(const LightAt& light, const RunControl& control) {
  derive_.environment = environment_of(light);
  string_ = grammar_->derive_step(string_, years_, derive_, control);
  derive_.environment = nobody;
  drawing_ = grammar_->interpret(string_, lsystem::StartFrame::kTree, derive_, control);
  ++years_;
}

Prototype GrowingTree::finished(double twig_radius_m) {
  const std::vector<WoodSegment> wood = wood_of(drawing_, twig_radius_m);
  drop_crossing(wood, drawing_);
  std::vector<std::size_t> leaves(drawing_.organs.size());
  std::iota(leaves.begin(), leaves.end(), std::size_t{0});
  const std::vector<bool> carries = carrying_segments(drawing_, leaves);
  Prototype tree;
  tree.name = species_.latin;
  tree.materials = {species_.material.name};
  for (std::size_t i = 0; i < wood.size(); ++i)
    if (carries[i]) tree.wood.push_back(wood[i]);
  if (!leaves.empty())
    tree.foliage = foliage_of(drawing_.organs, leaves, species_.foliage,
                              template_area_m2(species_.foliage) * static_cast<double>(leaves.size()));
  return tree;
}

}  // namespace sunfleck::growth
