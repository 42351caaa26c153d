#include "lighting/trace/raster_picture.h"

#include <algorithm>
#include <utility>

#include "lighting/trace/raster_bins.h"
#include "lighting/trace/raster_project.h"
#include "sim/base/parallel.h"

namespace sunfleck::trace {
namespace {

constexpr double kBytesPerRecord = 2 * sizeof(RasterRecord) + sizeof(RasterSolid) / 4.0 + 8;
constexpr double kBytesPerTile = 16;

std::size_t size_of(const Prototype& p) { return p.foliage.size() + p.wood.size() + p.wood_mesh.size(); }

double area_of(const PixelBox& b) {
  return b.empty() ? 0.0 : static_cast<double>(b.u_hi - b.u_lo) * (b.v_hi - b.v_lo);
}

PixelBox whole_of(const RasterView& view, const std::vector<PlacedTree>& trees) {
  if (view.wraps) return {0, 0, view.u_count, view.v_count};
  PixelBox whole;
  for (const PlacedTree& t : trees) {
    if (t.bounds.empty()) continue;
    if (whole.empty()) whole = t.bounds;
    whole = {std::min(whole.u_lo, t.bounds.u_lo), std::min(whole.v_lo, t.bounds.v_lo),
             std::max(whole.u_hi, t.bounds.u_hi), std::max(whole.v_hi, t.bounds.v_hi)};
  }
  return whole;
}

// Halves along the longer side, at a border of tiles; empty second half where it is a single tile.
std::pair<PixelBox, PixelBox> halves(const PixelBox& b) {
  PixelBox first = b, second = b;
  const auto middle = [](std::int32_t lo, std::int32_t hi) {
    return lo + (((hi - lo) / 2 + kTileSide - 1) / kTileSide) * kTileSide;
  };
  if (b.u_hi - b.u_lo >= b.v_hi - b.v_lo)
    first.u_hi = second.u_lo = std::min(b.u_hi, middle(b.u_lo, b.u_hi));
  else
    first.v_hi = second.v_lo = std::min(b.v_hi, middle(b.v_lo, b.v_hi));
  return {first, second};
}

// A stretch of a tree's foliage, or its wood.
struct Batch {
  std::uint32_t tree = 0;
  std::size_t first = 0, end = 0;
  bool wood = false;
};

void append(RasterScene& to, RasterScene&& from) {
  const auto shift = static_cast<std::uint32_t>(to.solids.size());
  if (shift > 0)
    for (RasterRecord& r : from.records) r.solid += shift;
  to.records.insert(to.records.end(), from.records.begin(), from.records.end());
  to.solids.insert(to.solids.end(), from.solids.begin(), from.solids.end());
}

}  // namespace

PicturePainter::PicturePainter(const Forest& forest, const ForestIndex& index, std::uint64_t limit_bytes)
    : forest_(forest), index_(index), limit_bytes_(limit_bytes) {
  for (const Prototype& p : forest.prototypes) boxes_.push_back(prototype_bounds(p));
}

double PicturePainter::records_in(const RasterView& view, const std::vector<PlacedTree>& trees,
                                  const Part& part) const {
  double records = 0.0;
  for (const std::uint32_t t : part.trees) {
    const std::size_t all = size_of(forest_.prototypes[forest_.instances[t].prototype.value]);
    const double inside = view.wraps ? std::min(1.0, area_of(part.box) / area_of(trees[t].bounds))
                                     : area_of(common(trees[t].bounds, part.box)) / area_of(trees[t].bounds);
    records += static_cast<double>(all) * inside;
  }
  return records;
}

std::vector<PicturePainter::Part> PicturePainter::parts_of(const RasterView& view,
                                                           const std::vector<PlacedTree>& trees) const {
  std::vector<Part> parts, waiting(1);
  waiting[0].box = whole_of(view, trees);
  for (const PlacedTree& t : trees)
    if (!t.bounds.empty()) waiting[0].trees.push_back(t.instance);
  while (!waiting.empty()) {
    Part part = std::move(waiting.back());
    waiting.pop_back();
    std::erase_if(part.trees, [&](std::uint32_t t) { return !touches(view, trees[t].bounds, part.box); });
    if (part.box.empty() || part.trees.empty()) continue;
    const double tiles = area_of(part.box) / (kTileSide * kTileSide);
    const double bytes = records_in(view, trees, part) * kBytesPerRecord + tiles * kBytesPerTile;
    const auto [first, second] = halves(part.box);
    if (bytes <= static_cast<double>(limit_bytes_) || second.empty()) {
      parts.push_back(std::move(part));
      continue;
    }
    waiting.push_back({second, part.trees});
    waiting.push_back({first, std::move(part.trees)});
  }
  return parts;
}

RasterScene PicturePainter::project(const RasterView& view, const std::vector<PlacedTree>& trees,
                                    const Part& part, const RunControl& control) const {
  constexpr std::size_t kBatch = 8192;
  std::vector<Batch> batches;
  for (const std::uint32_t t : part.trees) {
    const Prototype& p = forest_.prototypes[forest_.instances[t].prototype.value];
    for (std::size_t first = 0; first < p.foliage.size(); first += kBatch)
      batches.push_back({t, first, std::min(first + kBatch, p.foliage.size()), false});
    if (!p.wood.empty() || !p.wood_mesh.empty()) batches.push_back({t, 0, 0, true});
  }
  std::vector<RasterScene> projected(batches.size());
  for_each_chunk(batches.size(), 1, control, {}, [&](std::size_t i, std::size_t) {
    const Batch& b = batches[i];
    if (b.wood)
      project_wood(view, forest_, trees[b.tree], part.box, projected[i]);
    else
      project_foliage(view, forest_, trees[b.tree], index_.first_element(b.tree), b.first, b.end, part.box,
                      projected[i]);
  });
  RasterScene scene;
  std::size_t records = 0;
  for (const RasterScene& s : projected) records += s.records.size();
  scene.records.reserve(records);
  for (RasterScene& s : projected) append(scene, std::exchange(s, {}));
  return scene;
}

void PicturePainter::paint_part(const RasterView& view, const std::vector<PlacedTree>& trees, const Part& part,
                                std::uint64_t seed, SunPicture& picture, const RunControl& control) const {
  const RasterScene scene = project(view, trees, part, control);
  const RasterBins bins(scene.records, part.box);
  std::vector<std::uint32_t> tiles;
  for (std::size_t t = 0; t < bins.tile_count(); ++t)
    if (!bins.records(t).empty()) tiles.push_back(static_cast<std::uint32_t>(t));
  for_each_chunk(tiles.size(), 1, control, {}, [&](std::size_t i, std::size_t) {
    std::vector<SunLookup> lookups;
    RasterTile tile(view, scene, bins.box(tiles[i]));
    tile.work(bins.records(tiles[i]), seed, picture.tallies, lookups);
    // One tile alone holds an element's point.
    for (const SunLookup& l : lookups) picture.looked_up[l.element] = l.transmittance;
  });
}

SunPicture PicturePainter::paint(const RasterView& view, std::uint64_t seed, const RunControl& control) const {
  std::vector<PlacedTree> trees;
  for (std::size_t i = 0; i < forest_.instances.size(); ++i)
    trees.push_back(place_tree(view, forest_, i, boxes_[forest_.instances[i].prototype.value]));
  SunPicture picture{std::vector<SunTally>(index_.element_count()),
                     std::vector<float>(index_.element_count(), -1.0f)};
  for (const Part& part : parts_of(view, trees)) paint_part(view, trees, part, seed, picture, control);
  return picture;
}

}  // namespace sunfleck::trace
