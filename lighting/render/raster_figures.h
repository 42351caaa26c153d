// A forest's prototypes made ready for rasterising: figures in single precision, sorted into clusters of
// neighbours with a sphere around each, and everything placed with its numbers.
//
// Every figure of every placed tree has a number: the tree's first number and the figure's place in the
// prototype's list, flat figures before round ones.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "lighting/render/picture_scene.h"

namespace sunfleck {

// Whether places of a leaf's box belong to the leaf, by a table; what lies across a border is asked.
class OutlineTable {
 public:
  explicit OutlineTable(const MaterialLook& look);
  bool is_inside(float along, float across) const;

 private:
  static constexpr int kSide = 128;
  enum Cell : std::uint8_t { kOutside, kInside, kAsk };
  const MaterialLook& look_;
  std::vector<std::uint8_t> cells_;
};

enum class FlatShape : std::uint8_t { kParallelogram, kDisc, kTriangle };

// centre + a u + b v with |a|, |b| <= 1 (parallelogram), a^2 + b^2 <= 1 (disc), or a, b >= 0 and a + b <= 1
// (triangle; its centre is a corner).
struct FlatFigure {
  Vec3f centre{0}, u{0}, v{0};
  std::uint32_t local = 0;
  FlatShape shape = FlatShape::kParallelogram;
  HitKind kind = HitKind::kFoliage;
  std::uint16_t outline = 0;  // 1 + index of its OutlineTable; 0: none
};

// The side of a cone frustum (wood), or a cylinder filled with needles (shoot).
struct RoundFigure {
  Vec3f base{0}, axis{0, 0, 1};  // axis unit, length beside it
  float length = 0, radius = 0, taper = 0;
  float extinction_per_m = 0;  // of a shoot, in tree coordinates; 0: wood
  std::uint32_t local = 0;
};

struct FigureCluster {
  Vec3f centre{0};
  float radius = 0;
  std::uint32_t first = 0, count = 0;  // of its list
  bool flat = true;
};

struct PrototypeFigures {
  std::vector<FlatFigure> flats;
  std::vector<RoundFigure> rounds;
  std::vector<FigureCluster> clusters;
  Box box;
  std::size_t count() const { return flats.size() + rounds.size(); }
};

class FigureTable {
 public:
  explicit FigureTable(const PictureScene& scene);
  const PrototypeFigures& of(PrototypeId prototype) const { return prototypes_[prototype.value]; }
  const OutlineTable* outline(const FlatFigure& figure) const {
    return figure.outline == 0 ? nullptr : &outlines_[figure.outline - 1u];
  }
  std::size_t bytes() const;
  std::uint64_t figures() const;

 private:
  std::vector<PrototypeFigures> prototypes_;
  std::vector<OutlineTable> outlines_;
};

// One tree, or its copy in another period.
struct PlacedFigures {
  std::uint32_t instance = 0;
  std::uint32_t first_number = 0;
  Vec3 shift_m{0};  // of the copy
  const PrototypeFigures* figures = nullptr;
};

}  // namespace sunfleck
