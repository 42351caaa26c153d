#include "lighting/render/raster_figures.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace sunfleck {
namespace {

constexpr std::size_t kFlatsPerCluster = 24, kRoundsPerCluster = 16;

FlatFigure flat_of(const FoliageElement& e, std::uint32_t local) {
  FlatFigure f;
  f.centre = e.centre_m, f.u = e.half_u_m, f.v = e.half_v_m;
  f.local = local;
  if (e.shape == ElementShape::kDisc) f.shape = FlatShape::kDisc;
  if (e.shape == ElementShape::kTriangle) {
    f.shape = FlatShape::kTriangle;
    f.centre = Vec3f(Vec3(e.centre_m) - (Vec3(e.half_u_m) + Vec3(e.half_v_m)) / 3.0);
  }
  return f;
}

FlatFigure flat_of(const WoodTriangle& t, std::uint32_t local) {
  FlatFigure f;
  f.centre = t.a_m, f.u = t.b_m - t.a_m, f.v = t.c_m - t.a_m;
  f.local = local;
  f.shape = FlatShape::kTriangle;
  f.kind = HitKind::kWoodMesh;
  return f;
}

// Half the one-sided needle area per volume (lighting/trace/ray_scene.h).
RoundFigure shoot_of(const FoliageElement& e, std::uint32_t local) {
  RoundFigure r;
  const double half = glm::length(Vec3(e.half_u_m)), radius = glm::length(Vec3(e.half_v_m));
  r.base = e.centre_m - e.half_u_m;
  if (half > 0.0) r.axis = Vec3f(Vec3(e.half_u_m) / half);
  r.length = static_cast<float>(2.0 * half);
  r.radius = static_cast<float>(radius);
  const double volume = kPi * radius * radius * 2.0 * half;
  r.extinction_per_m = volume > 0.0 ? static_cast<float>(0.5 * e.area_m2 / volume) : 0.0f;
  r.local = local;
  return r;
}

RoundFigure cone_of(const WoodSegment& s, std::uint32_t local) {
  RoundFigure r;
  const Vec3 axis = Vec3(s.to_m) - Vec3(s.from_m);
  const double length = glm::length(axis);
  r.base = s.from_m;
  r.length = static_cast<float>(length);
  r.radius = s.radius_from_m;
  if (length > 0.0) {
    r.axis = Vec3f(axis / length);
    r.taper = static_cast<float>((static_cast<double>(s.radius_to_m) - s.radius_from_m) / length);
  }
  r.local = local;
  return r;
}

struct Ball {
  Vec3f centre;
  float radius;
};
Ball ball_of(const FlatFigure& f) {
  if (f.shape == FlatShape::kTriangle) {
    const Vec3f middle = f.centre + (f.u + f.v) / 3.0f;
    return {middle, std::max({glm::length(f.centre - middle), glm::length(f.centre + f.u - middle),
                              glm::length(f.centre + f.v - middle)})};
  }
  const float aside = f.shape == FlatShape::kDisc ? std::max(glm::length(f.u), glm::length(f.v))
                                                  : std::max(glm::length(f.u + f.v), glm::length(f.u - f.v));
  return {f.centre, aside};
}
Ball ball_of(const RoundFigure& r) {
  const float widest = std::max(r.radius, r.radius + r.taper * r.length);
  return {r.base + 0.5f * r.length * r.axis, std::hypot(0.5f * r.length, widest)};
}

// Halves a range at the middle of its longest side until it is small enough.
template <class Figure>
void split(std::vector<Figure>& figures, std::size_t first, std::size_t end, std::size_t most, bool flat,
           std::vector<FigureCluster>& clusters) {
  if (first == end) return;
  Box box;
  for (std::size_t i = first; i < end; ++i) box.include(Vec3(ball_of(figures[i]).centre));
  if (end - first > most) {
    const Vec3 size = box.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t middle = first + (end - first) / 2;
    const auto at = [&](std::size_t i) { return figures.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(first), at(middle), at(end), [&](const Figure& a, const Figure& b) {
      const float pa = ball_of(a).centre[axis], pb = ball_of(b).centre[axis];
      return pa != pb ? pa < pb : a.local < b.local;
    });
    split(figures, first, middle, most, flat, clusters);
    split(figures, middle, end, most, flat, clusters);
    return;
  }
  FigureCluster c;
  c.centre = Vec3f(box.centre());
  for (std::size_t i = first; i < end; ++i) {
    const Ball ball = ball_of(figures[i]);
    c.radius = std::max(c.radius, glm::length(ball.centre - c.centre) + ball.radius);
  }
  c.radius *= 1.00001f;
  c.first = static_cast<std::uint32_t>(first);
  c.count = static_cast<std::uint32_t>(end - first);
  c.flat = flat;
  clusters.push_back(c);
}

}  // namespace

// A cell is of one kind where a finer lattice over it is; details finer than 1 / 1000 of a leaf may be lost.
OutlineTable::OutlineTable(const MaterialLook& look) : look_(look), cells_(kSide * kSide) {
  constexpr int kFine = 4;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      int inside = 0;
      for (int i = 0; i <= kFine; ++i)
        for (int j = 0; j <= kFine; ++j)
          inside += look.is_inside(
              {2.0 * (x + i / double{kFine}) / kSide - 1.0, 2.0 * (y + j / double{kFine}) / kSide - 1.0});
      cells_[static_cast<std::size_t>(y * kSide + x)] = inside == 0                           ? kOutside
                                                        : inside == (kFine + 1) * (kFine + 1) ? kInside
                                                                                              : kAsk;
    }
}

bool OutlineTable::is_inside(float along, float across) const {
  const int x = std::clamp(static_cast<int>((along + 1.0f) * (kSide / 2)), 0, kSide - 1);
  const int y = std::clamp(static_cast<int>((across + 1.0f) * (kSide / 2)), 0, kSide - 1);
  const std::uint8_t cell = cells_[static_cast<std::size_t>(y * kSide + x)];
  return cell == kAsk ? look_.is_inside({along, across}) : cell == kInside;
}

FigureTable::FigureTable(const PictureScene& scene) {
  const Forest& forest = scene.forest();
  std::map<const MaterialLook*, std::uint16_t> known;
  // Any tree of a prototype tells the original one, whose looks it has.
  std::vector<PrototypeId> original(forest.prototypes.size());
  for (std::uint32_t i = 0; i < forest.instances.size(); ++i)
    original[forest.instances[i].prototype.value] = scene.original_prototype(i);
  const auto outline_number = [&](std::size_t prototype, const FoliageElement& e) -> std::uint16_t {
    if (e.shape != ElementShape::kParallelogram) return 0;
    const MaterialLook& look = scene.look_of(original[prototype], e.material);
    if (!look.changes_outline()) return 0;
    const auto [at, added] = known.try_emplace(&look, static_cast<std::uint16_t>(outlines_.size() + 1));
    if (added) outlines_.emplace_back(look);
    return at->second;
  };
  for (std::size_t p = 0; p < forest.prototypes.size(); ++p) {
    const Prototype& from = forest.prototypes[p];
    PrototypeFigures& to = prototypes_.emplace_back();
    for (std::uint32_t i = 0; i < from.foliage.size(); ++i) {
      const FoliageElement& e = from.foliage[i];
      if (e.shape == ElementShape::kShoot) {
        to.rounds.push_back(shoot_of(e, i));
        continue;
      }
      to.flats.push_back(flat_of(e, i));
      to.flats.back().outline = outline_number(p, e);
    }
    // Leaves and meshes, shoots and wood in clusters of their own.
    const std::size_t shoots = to.rounds.size(), leaves = to.flats.size();
    for (std::uint32_t i = 0; i < from.wood_mesh.size(); ++i)
      to.flats.push_back(flat_of(from.wood_mesh[i], i));
    for (std::uint32_t i = 0; i < from.wood.size(); ++i)
      if (from.wood[i].from_m != from.wood[i].to_m) to.rounds.push_back(cone_of(from.wood[i], i));
    split(to.flats, 0, leaves, kFlatsPerCluster, true, to.clusters);
    split(to.flats, leaves, to.flats.size(), kFlatsPerCluster, true, to.clusters);
    split(to.rounds, 0, shoots, kRoundsPerCluster, false, to.clusters);
    split(to.rounds, shoots, to.rounds.size(), kRoundsPerCluster, false, to.clusters);
    to.box = prototype_bounds(from);
  }
}

std::uint64_t FigureTable::figures() const {
  std::uint64_t sum = 0;
  for (const PrototypeFigures& p : prototypes_) sum += p.count();
  return sum;
}

std::size_t FigureTable::bytes() const {
  std::size_t sum = 0;
  for (const PrototypeFigures& p : prototypes_)
    sum += p.flats.size() * sizeof(FlatFigure) + p.rounds.size() * sizeof(RoundFigure) +
           p.clusters.size() * sizeof(FigureCluster);
  return sum;
}

}  // namespace sunfleck
