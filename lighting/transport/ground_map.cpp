// See ground_map.h.
#include "lighting/transport/ground_map.h"

#include <algorithm>
#include <cmath>

#include "sim/base/parallel.h"

namespace sunfleck::transport {

GroundMap::GroundMap(const Forest& forest, const GridFrame& frame, const GridLayout& layout,
                     const DirectionSet& set, int cells_per_side, const RunControl& control)
    : terrain_(forest.terrain), wraps_(layout.wraps_xy) {
  Vec3 world = forest_bounds(forest).centre();
  if (forest.period) world = Vec3(forest.period->origin_m + 0.5 * forest.period->size_m, world.z);
  world.z = terrain_.height_at(world.x, world.y);
  point_m_ = frame.field_from_world(world);
  world_from_field_m_ = world - point_m_;
  if (!wraps_) normal_ = terrain_.normal();
  choose_extent(forest, layout, cells_per_side);
  entries_.assign(set.count() * count(), kOpen);
  for_each_chunk(set.count(), 1, control, {}, [&](std::size_t j, std::size_t) {
    if (frame.ends_on_ground(set.to_source[j])) return;
    const Vec3 towards = frame.field_direction(set.to_source[j]);
    for (std::size_t g = 0; g < count(); ++g)
      entries_[j * count() + g] = grid_entry(field_point(g), towards, layout);
  });
}

void GroundMap::choose_extent(const Forest& forest, const GridLayout& layout, int cells_per_side) {
  lo_m_ = Vec2(layout.lo_m);
  Vec2 size(layout.size_m());
  if (wraps_) {
    nx_ = layout.cells[0];
    ny_ = layout.cells[1];
    cell_m_ = Vec2(layout.cell_m);
    return;
  }
  // As wide as shadows of a sun at 45 degrees, at least a quarter more than the forest.
  const Box box = forest_bounds(forest);
  double height = 0.0;
  for (const double x : {box.lo.x, box.hi.x})
    for (const double y : {box.lo.y, box.hi.y})
      height = std::max(height, box.hi.z - terrain_.height_at(x, y));
  const double margin = std::max(height, 0.25 * std::max(size.x, size.y));
  lo_m_ -= Vec2(margin);
  size += Vec2(2.0 * margin);
  const double wanted = std::max(std::max(size.x, size.y) / cells_per_side, layout.mean_cell_m());
  nx_ = static_cast<int>(std::ceil(size.x / wanted - 1e-9));
  ny_ = static_cast<int>(std::ceil(size.y / wanted - 1e-9));
  // Both grids even or both odd: on a middle between cells, rounding would decide where symmetric rays meet.
  nx_ += (nx_ - layout.cells[0]) & 1;
  ny_ += (ny_ - layout.cells[1]) & 1;
  cell_m_ = {size.x / nx_, size.y / ny_};
}

double GroundMap::cell_area_m2() const { return cell_m_.x * cell_m_.y / terrain_.normal().z; }

Vec3 GroundMap::field_point(std::size_t cell) const {
  const auto nx = static_cast<std::size_t>(nx_);
  const double x = lo_m_.x + (static_cast<double>(cell % nx) + 0.5) * cell_m_.x;
  const double y = lo_m_.y + (static_cast<double>(cell / nx) + 0.5) * cell_m_.y;
  const double z = point_m_.z - (normal_.x * (x - point_m_.x) + normal_.y * (y - point_m_.y)) / normal_.z;
  return {x, y, z};
}

Vec3 GroundMap::world_point(std::size_t cell) const { return world_from_field(field_point(cell)); }

Vec3 GroundMap::world_from_field(const Vec3& point_m) const {
  Vec3 p = point_m + world_from_field_m_;
  const double above_plane = point_m.z - point_m_.z;
  // The frame of a periodic scene follows the ground.
  if (wraps_) p.z = terrain_.height_at(p.x, p.y) + above_plane;
  return p;
}

std::int32_t GroundMap::hit(const Vec3& point_m, const Vec3& towards) const {
  const double sinking = glm::dot(normal_, towards);
  if (std::abs(sinking) < 1e-9) return kOpen;
  const double way = -glm::dot(normal_, point_m - point_m_) / sinking;
  double x = (point_m.x + way * towards.x - lo_m_.x) / cell_m_.x;
  double y = (point_m.y + way * towards.y - lo_m_.y) / cell_m_.y;
  if (wraps_) {
    x -= nx_ * std::floor(x / nx_);
    y -= ny_ * std::floor(y / ny_);
  } else if (!(x >= 0.0 && x < nx_ && y >= 0.0 && y < ny_)) {
    return kOpen;
  }
  return std::min(static_cast<int>(y), ny_ - 1) * nx_ + std::min(static_cast<int>(x), nx_ - 1);
}

std::int32_t GroundMap::grid_entry(const Vec3& start_m, const Vec3& towards, const GridLayout& layout) const {
  double enter = 0.0, leave = 1e300;
  for (int axis = wraps_ ? 2 : 0; axis < 3; ++axis) {
    const double lo = layout.lo_m[axis] - start_m[axis], hi = lo + layout.size_m()[axis];
    if (std::abs(towards[axis]) < 1e-9) {
      if (lo > 0.0 || hi < 0.0) return kOpen;
      continue;
    }
    const double a = lo / towards[axis], b = hi / towards[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (enter >= leave) return kOpen;
  Vec3 p = start_m + enter * towards;
  for (int axis = 0; axis < 2 && wraps_; ++axis) {
    const double size = layout.size_m()[axis];
    p[axis] -= size * std::floor((p[axis] - layout.lo_m[axis]) / size);
  }
  return static_cast<std::int32_t>(layout.flat(layout.cell_of(p)));
}

}  // namespace sunfleck::transport
