// See envelope_full.h: single leaves and points.
#include "lighting/envelope/envelope_query.h"

#include <cmath>

#include "sim/base/error.h"
#include "sim/base/parallel.h"

namespace sunfleck {

using namespace envelope;

namespace envelope {

PrototypeId leafiest_prototype(const Forest& forest) {
  std::vector<double> area(forest.prototypes.size(), 0.0), of_one(forest.prototypes.size(), 0.0);
  for (std::size_t p = 0; p < of_one.size(); ++p)
    for (const FoliageElement& e : forest.prototypes[p].foliage) of_one[p] += e.area_m2;
  PrototypeId best{0};
  for (const Instance& i : forest.instances) {
    area[i.prototype.value] += of_one[i.prototype.value] * i.scale * i.scale;
    if (area[i.prototype.value] > area[best.value]) best = i.prototype;
  }
  return best;
}

bool has_sun(const Illumination& light) {
  bool beam = false;
  for (const BandLight& band : light.bands) beam = beam || band.beam_normal_w_m2 > 0.0;
  return light.sun_is_up() && beam;
}

}  // namespace envelope

namespace {

Sources lit_sources(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                    const PreparedParts& parts, const RunControl& control) {
  const Illumination good = checked(light, optics.band_count());
  if (ForestIndex(forest).element_count() != parts.field->elements().size())
    throw_invalid("forest", "it is not the one that was prepared", "prepare the envelope of this forest");
  Sources result = sources(forest, optics, good, parts, has_sun(good), control);
  light_ground(result, parts, optics, leafiest_prototype(forest), control);
  return result;
}

void check_point(const EnvelopePoint& point, const PreparedParts& parts) {
  if (parts.grids.empty())
    throw Error(ErrorKind::kLimitExceeded, "envelope point",
                "the leaf-area grids of all directions would take more than 512 MiB and were not kept",
                "ask for elements of the forest, or give a larger envelope_full.cell_m");
  if (!is_finite(point.position_m) || !is_finite(point.normal) || !(glm::length(point.normal) > 0.0))
    throw_invalid("envelope point", "position or normal is no number, or the normal has no length",
                  "finite metres and a direction");
  if (point.neighbours.value >= parts.angles.size())
    throw_invalid("envelope point", "there is no prototype " + std::to_string(point.neighbours.value),
                  "the id of a prototype of the forest");
}

}  // namespace

EnvelopeQuery::EnvelopeQuery(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                             const EnvelopePrepared& prepared, const RunControl& control)
    : parts_(new Parts{forest, ForestIndex(forest), optics, prepared.parts(),
                       lit_sources(forest, optics, light, prepared.parts(), control)}) {}

EnvelopeQuery::EnvelopeQuery(EnvelopeQuery&&) noexcept = default;
EnvelopeQuery::~EnvelopeQuery() = default;

double EnvelopeQuery::Parts::sun_depth(std::size_t element) const {
  if (!sources.sun || prepared.field->ends_on_ground(sources.to_sun)) return kLargestDepth;
  if (!sources.sun_grid) return interpolated_sun_depth(sources, prepared.depths_of(element));
  if (prepared.options.own_leaf == EnvelopeOwnLeaf::kRemoved) {
    const auto index32 = static_cast<std::uint32_t>(element);
    float depth = 0.0f;
    sources.sun_grid->depths_from_elements({&index32, 1}, March::kForward, &depth);
    return depth;
  }
  const auto [instance, local] = index.place(element);
  return prepared.field->elements()[element].below_ground
             ? kLargestDepth
             : sources.sun_grid->depth_from_point(world_element(forest, instance, local).centre_m,
                                                  March::kForward);
}

std::vector<float> EnvelopeQuery::Parts::sun_depths(const RunControl& control) const {
  if (sources.sun_grid && prepared.options.own_leaf == EnvelopeOwnLeaf::kRemoved)
    return sources.sun_grid->depth_of_elements(March::kForward, control);
  std::vector<float> depths(index.element_count());
  for_each_chunk(depths.size(), 256, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) depths[i] = static_cast<float>(sun_depth(i));
  });
  return depths;
}

void EnvelopeQuery::Parts::element(std::size_t i, double depth, ArrivingLight& light,
                                   EnvelopeAnswer& answer) const {
  const auto [instance, local] = index.place(i);
  const FieldElement& e = prepared.field->elements()[i];
  const PrototypeId prototype = forest.instances[instance].prototype;
  light.receive({.depths = prepared.depths_of(i),
                 .sun_depth = depth,
                 .field_point_m = Vec3(e.centre_m),
                 .neighbours = prototype});
  const FaceWeights weights =
      e.is_shoot() ? shoot_weights(prepared.set, e, sources.to_sun)
                   : flat_weights(prepared.set, Vec3(e.axis), sources.to_sun, prepared.options.weights);
  const std::uint16_t material = forest.prototypes[prototype.value].foliage[local].material;
  fill(
      light, weights, depth,
      [&](std::size_t b) { return optics.material(b, prototype, material).leaf.albedo(); }, answer);
}

EnvelopeAnswer EnvelopeQuery::at_element(std::size_t element) const {
  SUNFLECK_EXPECTS(element < parts_->index.element_count());
  ArrivingLight light(parts_->prepared, parts_->sources);
  EnvelopeAnswer answer;
  parts_->element(element, parts_->sun_depth(element), light, answer);
  return answer;
}

EnvelopeAnswer EnvelopeQuery::at_point(const EnvelopePoint& point) const {
  const PreparedParts& parts = parts_->prepared;
  check_point(point, parts);
  std::array<float, kMostSectors> depths{};
  for (std::size_t j = 0; j < parts.set.half(); ++j) {
    depths[j] = static_cast<float>(parts.grids[j].depth_from_point(point.position_m, March::kForward));
    depths[parts.set.half() + j] =
        static_cast<float>(parts.grids[j].depth_from_point(point.position_m, March::kBackward));
  }
  const std::span<const float> sectors(depths.data(), parts.set.count());
  const double depth = parts_->sun_depth_at(point.position_m, sectors);
  ArrivingLight light(parts, parts_->sources);
  light.receive({.depths = sectors,
                 .sun_depth = depth,
                 .field_point_m = parts.field->field_from_world(point.position_m),
                 .neighbours = point.neighbours});
  const FaceWeights weights =
      flat_weights(parts.set, glm::normalize(point.normal), parts_->sources.to_sun, parts.options.weights);
  EnvelopeAnswer answer;
  parts_->fill(
      light, weights, depth, [](std::size_t) { return 0.0; }, answer);
  return answer;
}

double EnvelopeQuery::Parts::sun_depth_at(const Vec3& point_m, std::span<const float> sectors) const {
  if (!sources.sun || prepared.field->ends_on_ground(sources.to_sun)) return kLargestDepth;
  return sources.sun_grid ? sources.sun_grid->depth_from_point(point_m, March::kForward)
                          : interpolated_sun_depth(sources, sectors);
}

std::vector<EnvelopeAnswer> envelope_at(const Forest& forest, const OpticsTable& optics,
                                        const Illumination& light, const EnvelopePrepared& prepared,
                                        std::span<const EnvelopePoint> points, const RunControl& control) {
  const EnvelopeQuery query(forest, optics, light, prepared, control);
  std::vector<EnvelopeAnswer> answers(points.size());
  for_each_chunk(points.size(), 256, control, "points", [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) answers[i] = query.at_point(points[i]);
  });
  return answers;
}

}  // namespace sunfleck
