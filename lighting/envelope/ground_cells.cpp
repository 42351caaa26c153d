// See ground_cells.h.
#include "lighting/envelope/ground_cells.h"

#include <algorithm>
#include <cmath>

namespace sunfleck::envelope {

namespace {

constexpr int kMostCellsPerSide = 32;

}  // namespace

GroundCells::GroundCells(const Forest& forest, const BlockerField& field)
    : terrain_(forest.terrain), wraps_(field.layout().wraps_xy) {
  const Box box = forest_bounds(forest);
  Vec3 world = box.centre();
  if (forest.period) world = Vec3(forest.period->origin_m + 0.5 * forest.period->size_m, world.z);
  world.z = terrain_.height_at(world.x, world.y);
  point_m_ = field.field_from_world(world);
  world_from_field_m_ = world - point_m_;
  if (!wraps_) normal_ = terrain_.normal();
  lo_m_ = Vec2(field.layout().lo_m);
  Vec2 size(field.layout().size_m());
  if (!wraps_) {
    // As wide as shadows of a sun at 45 degrees, at least a quarter more than the forest.
    double height = 0.0;
    for (const double x : {box.lo.x, box.hi.x})
      for (const double y : {box.lo.y, box.hi.y})
        height = std::max(height, box.hi.z - terrain_.height_at(x, y));
    const double margin = std::max(height, 0.25 * std::max(size.x, size.y));
    lo_m_ -= Vec2(margin);
    size += Vec2(2.0 * margin);
  }
  const double wanted = std::max(std::max(size.x, size.y) / kMostCellsPerSide, field.layout().mean_cell_m());
  nx_ = std::clamp(static_cast<int>(std::ceil(size.x / wanted - 1e-9)), 1, kMostCellsPerSide);
  ny_ = std::clamp(static_cast<int>(std::ceil(size.y / wanted - 1e-9)), 1, kMostCellsPerSide);
  cell_m_ = {size.x / nx_, size.y / ny_};
}

Vec3 GroundCells::field_point(std::size_t cell) const {
  const auto nx = static_cast<std::size_t>(nx_);
  const double x = lo_m_.x + (static_cast<double>(cell % nx) + 0.5) * cell_m_.x;
  const double y = lo_m_.y + (static_cast<double>(cell / nx) + 0.5) * cell_m_.y;
  const double z = point_m_.z - (normal_.x * (x - point_m_.x) + normal_.y * (y - point_m_.y)) / normal_.z;
  return {x, y, z};
}

Vec3 GroundCells::world_point(std::size_t cell) const {
  Vec3 p = field_point(cell) + world_from_field_m_;
  // The frame of a periodic scene follows the ground.
  if (wraps_) p.z = terrain_.height_at(p.x, p.y);
  return p;
}

std::int32_t GroundCells::hit(const Vec3& point_m, const Vec3& towards) const {
  const double sinking = glm::dot(normal_, towards);
  if (!(sinking < -1e-9)) return kOpen;
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

}  // namespace sunfleck::envelope
