// Any grammar's drawing as a prototype: segments as wood of the widths the grammar sets, polygons as leaves;
// organs by name: Shoot(length, radius, area) a shoot, @O(r) and @o(r) a disc across the turtle's up, every
// other organ(length, width) a rhombic leaf of 0.05 m length and 0.6 of it wide unless it says otherwise.
#include "sim/base/error.h"
#include "sim/lsystem/lsystem.h"
#include "sim/plant/flat_elements.h"
#include "sim/plant/grow_foliage.h"
#include "sim/plant/make_prototype.h"

namespace sunfleck {
namespace {

double parameter(const lsystem::Organ& organ, std::size_t k, double otherwise) {
  return k < organ.parameters.size() ? organ.parameters[k] : otherwise;
}

FoliageElement organ_element(const lsystem::Organ& organ) {
  if (organ.symbol == "@O" || organ.symbol == "@o")
    return make_disc(organ.turtle.position_m, organ.turtle.up, parameter(organ, 0, 0.05));
  if (organ.symbol == "Shoot") {
    const double length_m = parameter(organ, 0, 0.1), radius_m = parameter(organ, 1, 0.2 * length_m);
    return shoot_element(organ.turtle, length_m, radius_m, parameter(organ, 2, 4 * length_m * radius_m));
  }
  const double length_m = parameter(organ, 0, 0.05);
  return rhombic_leaf(organ.turtle, length_m, parameter(organ, 1, 0.6 * length_m));
}

void require_sizes(const lsystem::Organ& organ, const std::string& where) {
  for (const double size : organ.parameters)
    if (!(size > 0))
      throw_invalid(where, "organ '" + organ.symbol + "' with the size " + std::to_string(size),
                    "positive sizes in metres");
}

void add_polygon(const lsystem::Polygon& polygon, std::vector<FoliageElement>& foliage) {
  if (polygon.corners_m.size() < 3) return;
  ImportReport report;
  add_leaf_polygon(polygon.corners_m, 0, foliage, report);
}

WoodSegment wood_of(const lsystem::Segment& segment) {
  return {Vec3f(segment.from_m), Vec3f(segment.to_m), static_cast<float>(0.5 * segment.width_from_m),
          static_cast<float>(0.5 * segment.width_to_m), 0};
}

}  // namespace

Prototype prototype_from_lsystem(const std::filesystem::path& grammar_file, int steps, std::uint64_t seed,
                                 const std::string& material, const RunControl& control) {
  const auto grammar = lsystem::Grammar::load(grammar_file);
  lsystem::DeriveOptions options;
  options.seed = seed;
  options.steps = steps;
  const auto drawing =
      grammar.interpret(grammar.derive(options, control), lsystem::StartFrame::kTree, options, control);
  Prototype plant;
  plant.name = grammar_file.stem().string();
  plant.materials = {material};
  for (const lsystem::Segment& segment : drawing.segments) plant.wood.push_back(wood_of(segment));
  for (const lsystem::Organ& organ : drawing.organs) {
    require_sizes(organ, grammar_file.string());
    plant.foliage.push_back(organ_element(organ));
  }
  for (const lsystem::Polygon& polygon : drawing.polygons) add_polygon(polygon, plant.foliage);
  validate(plant, grammar_file.string());
  return plant;
}

}  // namespace sunfleck
