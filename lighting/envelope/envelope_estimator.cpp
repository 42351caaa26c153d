// [Boulanger08] in optical depths: one march of the leaf-area grid per leaf and direction, then closed forms.
//
// Computed: direct sun, direct sky, and as scattered light one bounce of sun off neighbouring leaves and the
// light of the ground. Not computed: bounces of sky light and all further bounces (notes say how much that
// is), wood as a source, shade on the ground. Differences from print: depths instead of distances, so density
// may vary and nothing must be fitted; depths from the leaf-area grid instead of sorted bins of leaves, which
// cost the square of their number and are biased; cosine-normalised sector weights; a clamped integral where
// the printed depth to the sun turns negative.
#include "lighting/envelope/envelope_estimator.h"

#include <cmath>
#include <optional>
#include <sstream>

#include "lighting/base/summaries.h"
#include "lighting/envelope/envelope_depths.h"
#include "lighting/envelope/envelope_notes.h"
#include "lighting/envelope/sector_light.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/base/version.h"

namespace sunfleck {

namespace {

using namespace envelope;

constexpr std::uint64_t kBytesPerCell = 32;  // of the leaf-area grid, about

void check_request(const ForestIndex& index, const EnvelopeOptions& options) {
  if (index.element_count() == 0)
    throw_invalid("forest", "it has no foliage element, so there is nothing to compute light for",
                  "give a forest with at least one tree that has leaves or shoots");
  if (!(options.cell_m >= 0.0 && std::isfinite(options.cell_m)))
    throw_invalid("envelope.cell_m", "a cell cannot be " + std::to_string(options.cell_m) + " m",
                  "give a length in metres, best 2 to 4 leaf sides, or 0 to have it chosen");
}

// True if direct sunlight has to be computed; else notes why not.
bool needs_sun(const Illumination& light, Provenance& provenance) {
  bool beam = false;
  for (const BandLight& band : light.bands) beam = beam || band.beam_normal_w_m2 > 0.0;
  if (light.sun_is_up() && beam) return true;
  const char* reason = light.sun_is_up() ? "no band has direct sunlight" : "the sun is not above the horizon";
  provenance.skipped.push_back({.what = "direct sun and its bounce", .reason = reason, .relative_bound = 0});
  return false;
}

void state_settings(Provenance& provenance, const EnvelopeOptions& options, const BlockerField& field) {
  std::ostringstream cell;
  cell << field.layout().mean_cell_m();
  provenance.settings = {{"sun", options.sun == EnvelopeSun::kPublished ? "published" : "marched"},
                         {"directions", "8"},
                         {"cell_m", cell.str()},
                         {"cells", std::to_string(field.layout().cell_count())}};
}

void evaluate(const Forest& forest, const ForestIndex& index, const BlockerField& field,
              const SectorDepths& sectors, const std::vector<float>& sun_depth, const SectorLight& light,
              const RunControl& control, LightMap& map) {
  for_each_chunk(index.element_count(), 1024, control, "evaluating leaves",
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t i = begin; i < end; ++i) {
                     const LeafDepths depths{.sectors = sectors[i], .sun = light.sun ? sun_depth[i] : 0.0f};
                     const LeafTransfer leaf = leaf_transfer(field.elements()[i], depths, light);
                     const std::size_t prototype = forest.instances[index.place(i).instance].prototype.value;
                     map.sunlit_fraction[i] = static_cast<float>(leaf.sunlit);
                     for (std::size_t b = 0; b < light.bands.size(); ++b)
                       map.bands[b].elements[i] = element_light(leaf, light.bands[b], prototype);
                   }
                 });
}

LightMap empty_map(const ForestIndex& index, const OpticsTable& optics, const std::string& forest_hash) {
  LightMap map;
  map.sunlit_fraction.resize(index.element_count());
  for (const std::string& band : optics.bands()) {
    BandLightMap& added = map.bands.emplace_back();
    added.band = band;
    added.elements.resize(index.element_count());
  }
  map.provenance.method = "envelope";
  map.provenance.version = kVersion;
  map.provenance.forest_hash = forest_hash;
  return map;
}

void add_notes(Provenance& provenance, const std::vector<std::string>& notes) {
  provenance.notes.insert(provenance.notes.end(), notes.begin(), notes.end());
}

}  // namespace

namespace envelope {

struct PublishedDepths {
  BlockerField field;
  MarchedSectors sectors;
};

}  // namespace envelope

std::uint64_t EnvelopeSectors::bytes() const {
  const std::uint64_t elements = depths->sectors.depths.size();
  return elements * (sizeof(depths->sectors.depths[0]) + sizeof(FieldElement)) +
         depths->field.layout().cell_count() * kBytesPerCell;
}

EnvelopeSectors prepare_envelope_sectors(const Forest& forest, const EnvelopeOptions& options,
                                         const RunControl& control) {
  validate(forest);
  check_request(ForestIndex(forest), options);
  Provenance provenance;
  EnvelopeSectors prepared;
  prepared.cell_m = options.cell_m;
  prepared.forest_hash = content_hash(forest);
  std::optional<BlockerField> field;
  {
    const StageTimer timer(provenance, "leaf-area grid");
    field.emplace(forest, BlockerFieldOptions{.cell_m = options.cell_m}, control);
  }
  MarchedSectors sectors;
  {
    const StageTimer timer(provenance, "sector depths");
    sectors = march_sectors(*field, control);
  }
  prepared.depths =
      std::make_shared<const PublishedDepths>(PublishedDepths{std::move(*field), std::move(sectors)});
  prepared.times = std::move(provenance.times);
  return prepared;
}

LightMap envelope_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& illumination,
                            const EnvelopeOptions& options, const EnvelopeSectors& prepared,
                            const RunControl& control) {
  SUNFLECK_EXPECTS(prepared.depths != nullptr && prepared.cell_m == options.cell_m);
  const Illumination light = checked(illumination, optics.band_count());
  const ForestIndex index(forest);
  const auto& [field, sectors] = *prepared.depths;
  SUNFLECK_EXPECTS(sectors.depths.size() == index.element_count());
  LightMap map = empty_map(index, optics, prepared.forest_hash);
  Provenance& provenance = map.provenance;
  const bool sun = needs_sun(light, provenance);
  std::vector<float> sun_depth;
  if (sun) {
    const StageTimer timer(provenance, "sun depths");
    sun_depth = sun_depths(field, sectors.depths, light.to_sun, options.sun, control);
  }
  {
    const StageTimer timer(provenance, "evaluation");
    const SectorLight sector = sector_light(forest, optics, light, field, options.sun, sun);
    evaluate(forest, index, field, sectors.depths, sun_depth, sector, control, map);
  }
  summarize(forest, index, optics, map);
  state_settings(provenance, options, field);
  add_notes(provenance, scene_notes(forest, field, sectors));
  add_notes(provenance, missing_bounce_notes(forest, optics, field, sectors.depths));
  SUNFLECK_ENSURES(find_violation(map, index).empty());
  return map;
}

LightMap envelope_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& illumination,
                            const EnvelopeOptions& options, const RunControl& control) {
  const Illumination light = checked(illumination, optics.band_count());
  const EnvelopeSectors prepared = prepare_envelope_sectors(forest, options, control);
  LightMap map = envelope_light_map(forest, optics, light, options, prepared, control);
  map.provenance.times.insert(map.provenance.times.begin(), prepared.times.begin(), prepared.times.end());
  return map;
}

}  // namespace sunfleck
