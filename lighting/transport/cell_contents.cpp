// See cell_contents.h.
#include "lighting/transport/cell_contents.h"

#include <algorithm>
#include <cmath>

#include "lighting/transport/lanes.h"
#include "sim/base/parallel.h"

namespace sunfleck::transport {

namespace {

constexpr float kSmallestCover = 1e-20f;   // a leaf of no area still has an irradiance
constexpr std::size_t kLookEvery = 65536;  // parts between two looks at the stop token
constexpr std::size_t kPartsPerRange = 8192, kCellsPerRange = 16384;

struct Piece {
  std::uint32_t element, cell;
  float share;
};

// One piece per element, or its pieces where it is larger than a cell.
std::vector<Piece> all_pieces(const BlockerField& field, const RunControl& control) {
  const auto& elements = field.elements();
  const auto& large = field.element_pieces();
  std::vector<Piece> pieces;
  pieces.reserve(elements.size() + large.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (i % kLookEvery == 0) control.check();
    const bool spread = next < large.size() && large[next].blocker == i;
    const auto index = static_cast<std::uint32_t>(i);
    for (; next < large.size() && large[next].blocker == i; ++next)
      if (!elements[i].below_ground) pieces.push_back({index, large[next].cell, large[next].share});
    if (!spread && !elements[i].below_ground) pieces.push_back({index, elements[i].cell, 1.0f});
  }
  return pieces;
}

// Counting sort by cell; keeps the order of elements within a cell.
std::vector<Piece> sorted_by_cell(const std::vector<Piece>& pieces, std::size_t cells,
                                  std::vector<std::uint32_t>& first, const RunControl& control) {
  first.assign(cells + 1, 0);
  for (const Piece& p : pieces) ++first[p.cell + 1];
  for (std::size_t c = 0; c < cells; ++c) first[c + 1] += first[c];
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  std::vector<Piece> sorted(pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (i % kLookEvery == 0) control.check();
    sorted[next[pieces[i].cell]++] = pieces[i];
  }
  return sorted;
}

float wood_depth(const BlockerField& field, const BlockerPiece& piece, const Vec3& direction,
                 float step_cells) {
  const double face_m2 = std::pow(field.layout().mean_cell_m(), 2);
  const double cover = piece.share * projected_area_m2(field.wood()[piece.blocker], direction) / face_m2;
  const float q = std::clamp(static_cast<float>(cover) * step_cells, kSmallestCover, kLargestPartCover);
  return depth_of_cover(q) / step_cells;
}

class Filler {
 public:
  Filler(const Forest& forest, const ForestIndex& index, const BlockerField& field, const DirectionSet& set,
         const DirectionLanes& lanes, const RunControl& control)
      : forest_(forest),
        index_(index),
        field_(field),
        set_(set),
        lanes_(lanes),
        control_(control),
        face_m2_(std::pow(field.layout().mean_cell_m(), 2)),
        classes_(leaf_classes(forest)) {}

  CellContents run() {
    CellContents contents;
    const auto pieces = sorted_by_cell(all_pieces(field_, control_), field_.layout().cell_count(),
                                       contents.first_part, control_);
    contents.parts.resize(pieces.size());
    for_each_chunk(pieces.size(), 8192, control_, {}, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) contents.parts[i] = part_of(pieces[i]);
    });
    add_shoots(contents);
    add_wood(contents);
    add_ranges(contents);
    number_parts_of_elements(contents);
    return contents;
  }

 private:
  LeafPart part_of(const Piece& piece) const {
    const FieldElement& e = field_.elements()[piece.element];
    const auto [instance, local] = index_.place(piece.element);
    const PrototypeId prototype = forest_.instances[instance].prototype;
    LeafPart part;
    part.element = piece.element;
    part.share = piece.share;
    part.cover = std::max(kSmallestCover, static_cast<float>(e.area_m2 * piece.share / face_m2_));
    part.shoot = e.is_shoot() ? 1 : 0;  // numbered by add_shoots()
    if (!e.is_shoot()) part.normal = e.axis;
    part.optics = static_cast<std::uint32_t>(classes_.first[prototype.value] +
                                             forest_.prototypes[prototype.value].foliage[local].material);
    return part;
  }

  void add_shoots(CellContents& contents) const {
    std::vector<std::size_t> shoots;
    for (std::size_t i = 0; i < contents.parts.size(); ++i) {
      if (contents.parts[i].shoot == 0) continue;
      shoots.push_back(i);
      contents.parts[i].shoot = static_cast<std::uint32_t>(shoots.size());
    }
    contents.shoots.resize(shoots.size());
    for_each_chunk(shoots.size(), 1024, control_, {}, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) contents.shoots[s] = shoot_of(contents.parts[shoots[s]]);
    });
  }

  ShootPart shoot_of(const LeafPart& part) const {
    const FieldElement& e = field_.elements()[part.element];
    ShootPart shoot;
    double escape = 0.0;
    for (std::size_t j = 0; j < set_.half(); ++j) {
      const double past_own = own_transmittance(e, set_.to_source[j]);
      escape += 2.0 * set_.solid_angle_sr[j] * past_own / (4.0 * kPi);
      shoot.cover[j] =
          std::clamp(0.5f * part.cover * static_cast<float>(past_own), kSmallestCover, kLargestPartCover);
    }
    shoot.escape = static_cast<float>(std::min(1.0, escape));
    return shoot;
  }

  void add_wood(CellContents& contents) const {
    auto pieces = field_.wood_pieces();
    std::ranges::stable_sort(pieces, {}, &BlockerPiece::cell);
    std::size_t count = 0;
    for (const BlockerPiece& piece : pieces) {
      if (++count % 4096 == 0) control_.check();
      if (contents.wood.empty() || contents.wood.back().cell != piece.cell)
        contents.wood.push_back({.cell = piece.cell});
      WoodCell& cell = contents.wood.back();
      for (std::size_t j = 0; j < set_.half(); ++j)
        cell.depth[j] += wood_depth(field_, piece, set_.to_source[j], lanes_.step_cells[j]);
    }
  }

  static void add_ranges(CellContents& contents) {
    const auto cells = static_cast<std::uint32_t>(contents.first_part.size() - 1);
    std::uint32_t begin = 0, wood = 0;
    while (begin < cells) {
      std::uint32_t end = begin + 1;
      while (end < cells && end - begin < kCellsPerRange &&
             contents.first_part[end + 1] - contents.first_part[begin] < kPartsPerRange)
        ++end;
      CellRange range{.begin = begin, .end = end, .wood_begin = wood, .wood_end = wood};
      while (range.wood_end < contents.wood.size() && contents.wood[range.wood_end].cell < end)
        ++range.wood_end;
      wood = range.wood_end;
      begin = end;
      contents.ranges.push_back(range);
    }
  }

  void number_parts_of_elements(CellContents& contents) const {
    auto& first = contents.first_part_of_element;
    first.assign(field_.elements().size() + 1, 0);
    for (const LeafPart& p : contents.parts) ++first[p.element + 1];
    for (std::size_t e = 0; e + 1 < first.size(); ++e) first[e + 1] += first[e];
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    contents.parts_of_element.resize(contents.parts.size());
    for (std::size_t i = 0; i < contents.parts.size(); ++i) {
      if (i % kLookEvery == 0) control_.check();
      contents.parts_of_element[next[contents.parts[i].element]++] = static_cast<std::uint32_t>(i);
    }
  }

  const Forest& forest_;
  const ForestIndex& index_;
  const BlockerField& field_;
  const DirectionSet& set_;
  const DirectionLanes& lanes_;
  const RunControl& control_;
  const double face_m2_;
  const LeafClasses classes_;
};

}  // namespace

LeafClasses leaf_classes(const Forest& forest) {
  LeafClasses classes;
  for (const Prototype& p : forest.prototypes) {
    classes.first.push_back(classes.count);
    classes.count += p.materials.size();
  }
  return classes;
}

CellContents cell_contents(const Forest& forest, const ForestIndex& index, const BlockerField& field,
                           const DirectionSet& set, const DirectionLanes& lanes, const RunControl& control) {
  return Filler(forest, index, field, set, lanes, control).run();
}

std::vector<float> wood_depths(const CellContents& contents, const BlockerField& field,
                               const Vec3& direction) {
  std::vector<float> depths(contents.wood.size(), 0.0f);
  for (const BlockerPiece& piece : field.wood_pieces()) {
    const auto cell = std::ranges::lower_bound(contents.wood, piece.cell, {}, &WoodCell::cell);
    depths[static_cast<std::size_t>(cell - contents.wood.begin())] +=
        wood_depth(field, piece, direction, 1.0f);
  }
  return depths;
}

std::vector<float> half_step_transmittance(const CellContents& contents, const DirectionLanes& lanes,
                                           std::size_t half, const RunControl& control) {
  const std::size_t cells = contents.first_part.size() - 1;
  std::vector<float> transmittance(half * cells, 1.0f);
  for_each_chunk(contents.ranges.size(), 1, control, {}, [&](std::size_t r, std::size_t) {
    const CellRange& range = contents.ranges[r];
    std::uint32_t wood = range.wood_begin;
    for (std::uint32_t cell = range.begin; cell < range.end; ++cell) {
      Lanes sum{}, cosine, depth;
      for (std::uint32_t p = contents.first_part[cell]; p < contents.first_part[cell + 1]; ++p) {
        const LeafPart& part = contents.parts[p];
        if (part.shoot > 0) {
          shoot_depths(contents.shoots[part.shoot - 1], lanes, cosine, depth);
        } else {
          cosines_of(part, lanes, cosine);
          depths_of(part.cover, lanes, cosine, depth);
        }
        for (std::size_t j = 0; j < kLanes; ++j) sum[j] += depth[j];
      }
      const bool has_wood = wood < range.wood_end && contents.wood[wood].cell == cell;
      if (has_wood)
        for (std::size_t j = 0; j < kLanes; ++j) sum[j] += contents.wood[wood].depth[j];
      wood += has_wood;
      for (std::size_t j = 0; j < half; ++j)
        if (sum[j] > 0.0f) transmittance[j * cells + cell] = std::exp(-0.5f * sum[j] * lanes.step_cells[j]);
    }
  });
  return transmittance;
}

}  // namespace sunfleck::transport
