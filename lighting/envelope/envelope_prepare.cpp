// See envelope_full.h: what depends on the forest alone. One leaf-area grid per pair of opposite directions,
// one march of it per leaf, per ground cell and way.
#include "lighting/base/summaries.h"
#include "lighting/envelope/envelope_full.h"
#include "lighting/envelope/prepared_parts.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"

namespace sunfleck {

namespace envelope {

namespace {

// In the box around a tree that stands alone, as for the grid method: crowns of 200,000 leaves and more get
// cells wider than 4 sides, finer against the crown than those of smaller ones. Marches stay short.
constexpr double kMostCellsPerLeaf = 0.65;
constexpr std::size_t kMostGridBytes = 512ull << 20;  // of the grids kept for single points

void require_leaves(const ForestIndex& index) {
  if (index.element_count() == 0)
    throw_invalid("forest", "it has no foliage element, so there is nothing to compute light for",
                  "give a forest with at least one tree that has leaves or shoots");
}

bool keeps_grids(const PreparedParts& parts) {
  const std::size_t floats = parts.field->layout().cell_count() + parts.field->elements().size();
  return floats * sizeof(float) * parts.set.half() <= kMostGridBytes;
}

void march_ground(PreparedParts& parts, const ExtinctionGrid& grid, std::size_t direction, March march,
                  const RunControl& control) {
  if (parts.field->ends_on_ground(parts.set.to_source[direction])) return;
  const std::size_t n = parts.set.count();
  for_each_chunk(parts.ground.count(), 16, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g)
      parts.ground_depths[g * n + direction] =
          static_cast<float>(grid.depth_from_point(parts.ground.world_point(g), march));
  });
}

void march_sector(PreparedParts& parts, const Forest& forest, const ForestIndex& index,
                  const ExtinctionGrid& grid, std::size_t direction, March march, const RunControl& control) {
  const std::size_t n = parts.set.count();
  const std::vector<float> depth = element_depths(parts, forest, index, grid, march, control);
  for (std::size_t i = 0; i < depth.size(); ++i) parts.depths[i * n + direction] = depth[i];
  march_ground(parts, grid, direction, march, control);
}

void march_all(PreparedParts& parts, const Forest& forest, const ForestIndex& index,
               const RunControl& control) {
  const std::size_t n = parts.set.count(), half = parts.set.half();
  const bool keep = keeps_grids(parts);
  parts.depths.resize(index.element_count() * n);
  parts.ground_depths.assign(parts.ground.count() * n, 0.0f);
  parts.grids.reserve(half);
  for (std::size_t j = 0; j < half; ++j) {
    if (keep || j == 0)
      parts.grids.emplace_back(*parts.field, parts.set.to_source[j], control);
    else
      parts.grids.front().turn_to(parts.set.to_source[j], control);
    const ExtinctionGrid& grid = parts.grids.back();
    march_sector(parts, forest, index, grid, j, March::kForward, control);
    march_sector(parts, forest, index, grid, half + j, March::kBackward, control);
    parts.clamped += grid.clamped();
    control.report("sector depths", static_cast<double>(j + 1) / static_cast<double>(half));
  }
  if (!keep) parts.grids.clear();
}

void measure_angles(PreparedParts& parts, const Forest& forest, const ForestIndex& index,
                    const RunControl& control) {
  parts.angles = measure_leaf_angles(forest, index, *parts.field, parts.options.angles, control);
  parts.moments.resize(parts.angles.size());
  for_each_chunk(parts.angles.size(), 1, control, {}, [&](std::size_t p, std::size_t) {
    for (const AngleSample& sample : parts.angles[p].samples)
      parts.moments[p].push_back(angle_moments(sample, parts.set));
  });
}

}  // namespace

std::vector<float> element_depths(const PreparedParts& parts, const Forest& forest, const ForestIndex& index,
                                  const ExtinctionGrid& grid, March march, const RunControl& control) {
  if (parts.options.own_leaf == EnvelopeOwnLeaf::kRemoved) return grid.depth_of_elements(march, control);
  std::vector<float> depths(index.element_count());
  for_each_chunk(depths.size(), 256, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto [instance, local] = index.place(i);
      const Vec3 centre = world_element(forest, instance, local).centre_m;
      depths[i] = parts.field->elements()[i].below_ground
                      ? static_cast<float>(kLargestDepth)
                      : static_cast<float>(grid.depth_from_point(centre, march));
    }
  });
  return depths;
}

}  // namespace envelope

EnvelopePrepared::EnvelopePrepared(std::unique_ptr<envelope::PreparedParts> parts)
    : parts_(std::move(parts)) {}
EnvelopePrepared::EnvelopePrepared(EnvelopePrepared&&) noexcept = default;
EnvelopePrepared& EnvelopePrepared::operator=(EnvelopePrepared&&) noexcept = default;
EnvelopePrepared::~EnvelopePrepared() = default;

std::size_t EnvelopePrepared::memory_bytes() const {
  const envelope::PreparedParts& p = *parts_;
  std::size_t floats = p.depths.size() + p.ground_depths.size();
  floats += p.grids.size() * (p.field->layout().cell_count() + p.field->elements().size());
  return floats * sizeof(float) + p.field->elements().size() * sizeof(FieldElement);
}

EnvelopePrepared prepare_envelope(const Forest& forest, const EnvelopeFullOptions& options,
                                  const RunControl& control) {
  using namespace envelope;
  check(options);
  validate(forest);
  const ForestIndex index(forest);
  require_leaves(index);
  auto parts = std::make_unique<PreparedParts>();
  Provenance times;
  parts->options = options;
  parts->forest_hash = content_hash(forest);
  {
    const StageTimer timer(times, "leaf-area grid");
    parts->field = std::make_unique<const BlockerField>(
        forest,
        BlockerFieldOptions{.cell_m = options.cell_m,
                            .most_cells_per_element = forest.instances.size() == 1 ? kMostCellsPerLeaf : 0.0},
        control);
    parts->set = forest.period ? layered_sectors(options.directions, forest.terrain.normal())
                               : cubic_sectors(options.directions);
    parts->ground = GroundCells(forest, *parts->field);
  }
  {
    const StageTimer timer(times, "leaf angles");
    measure_angles(*parts, forest, index, control);
  }
  {
    const StageTimer timer(times, "sector depths");
    march_all(*parts, forest, index, control);
  }
  parts->times = std::move(times.times);
  return EnvelopePrepared(std::move(parts));
}

}  // namespace sunfleck
