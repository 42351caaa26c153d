// See blocker_field.h.
#include "lighting/depth/blocker_field.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "lighting/depth/spread_points.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"

namespace sunfleck {

namespace {

// Silhouette of a cylinder without regard to what is inside, seen along a unit direction.
double cylinder_silhouette(const FieldElement& shoot, const Vec3& direction) {
  const Vec3 half_axis(shoot.axis);
  const double radius = shoot.shoot_radius_m, length = 2.0 * glm::length(half_axis);
  const double side = 2.0 * glm::length(glm::cross(half_axis, direction));  // length times sine
  const double cosine = length > 0.0 ? std::abs(glm::dot(half_axis, direction)) * 2.0 / length : 1.0;
  return 2.0 * radius * side + kPi * radius * radius * cosine;
}

// (1 - exp(-x)) / x
double mean_decay(double x) { return x > 0.0 ? -std::expm1(-x) / x : 1.0; }

double mean_silhouette(const FieldElement& e) {
  if (!e.is_shoot()) return e.area_m2;
  const double radius = e.shoot_radius_m, length = 2.0 * glm::length(Vec3(e.axis));
  return 0.5 * kPi * radius * (length + radius);  // a quarter of the surface, caps included
}

Box widened(Box box, double margin_m) {
  box.lo -= Vec3(margin_m);
  box.hi += Vec3(margin_m);
  return box;
}

Vec3 unit_or_up(const Vec3& v) {
  const double length = glm::length(v);
  return length > 0.0 ? v / length : Vec3(0, 0, 1);
}

}  // namespace

double own_transmittance(const FieldElement& e, const Vec3& direction) {
  if (!e.is_shoot()) return 1.0;
  const double silhouette = cylinder_silhouette(e, direction);
  return silhouette > 0.0 ? mean_decay(0.5 * e.area_m2 / silhouette) : 0.0;
}

double element_side_m(const FieldElement& e) { return std::sqrt(mean_silhouette(e)); }

double projected_area_m2(const FieldElement& e, const Vec3& direction) {
  if (!e.is_shoot()) return e.area_m2 * std::abs(glm::dot(Vec3(e.axis), direction));
  return 0.5 * e.area_m2 * own_transmittance(e, direction);
}

double projected_area_m2(const FieldWood& wood, const Vec3& direction) {
  const Vec3 vector(wood.vector);
  return wood.width_m > 0.0f ? wood.width_m * glm::length(glm::cross(vector, direction))
                             : std::abs(glm::dot(vector, direction));
}

// Fills a BlockerField step by step.
class BlockerFieldBuilder {
 public:
  BlockerFieldBuilder(BlockerField& field, const Forest& forest, const RunControl& control)
      : field_(field), forest_(forest), index_(forest), control_(control) {}

  void choose_frame(const BlockerFieldOptions& options) {
    field_.frame_ = options.frame ? *options.frame : grid_frame(forest_);
  }

  void flatten_elements() {
    if (index_.element_count() >= (1ull << 32))
      throw Error(ErrorKind::kLimitExceeded, "forest", "more than 4e9 foliage elements",
                  "compute fewer trees at a time");
    field_.elements_.resize(index_.element_count());
    for_each_element([&](std::size_t i, const WorldElement& e) { field_.elements_[i] = flattened(e); });
  }

  void choose_grid(const BlockerFieldOptions& options) {
    Box box = wood_box();
    double area = 0.0, weighted_side = 0.0;
    for (const FieldElement& e : field_.elements_) {
      box.include(Vec3(e.centre_m));
      area += e.area_m2;
      weighted_side += e.area_m2 * element_side_m(e);
    }
    const double extent = std::max({box.size().x, box.size().y, box.size().z});
    field_.mean_side_m_ = area > 0.0 ? weighted_side / area : (extent > 0.0 ? extent / 64.0 : 1.0);
    const double cell = options.cell_m > 0.0 ? options.cell_m : leaf_cell_size(extent, field_.mean_side_m_);
    const std::uint64_t worthwhile = std::max<std::uint64_t>(8ull << 20, 512 * field_.elements_.size());
    const std::uint64_t most =
        options.keep_cell ? options.max_cells : std::min(options.max_cells, worthwhile);
    const Box wide = options.margin_m > 0.0 ? widened(box, options.margin_m) : box;
    field_.layout_ = fit_grid(wide, field_.frame_.period_box(), cell, most);
  }

  void place_elements() {
    const double cell_m = field_.layout_.mean_cell_m();
    std::mutex collecting;
    std::vector<std::size_t> large;
    for_each_element([&](std::size_t i, const WorldElement& e) {
      FieldElement& element = field_.elements_[i];
      element.cell = field_.layout_.flat(field_.layout_.cell_of(Vec3(element.centre_m)));
      if (!needs_spreading(e, cell_m)) return;
      const std::lock_guard lock(collecting);
      large.push_back(i);
    });
    std::ranges::sort(large);
    for (const std::size_t i : large) {
      control_.check();
      const auto [instance, local] = index_.place(i);
      add_pieces(field_.element_pieces_, i, spread_element(world_element(forest_, instance, local), cell_m));
    }
  }

  // Counting sort.
  void sort_elements() {
    std::vector<std::uint32_t> next(field_.layout_.cell_count() + 1, 0);
    for (const FieldElement& e : field_.elements_) ++next[e.cell + 1];
    for (std::size_t c = 1; c < next.size(); ++c) next[c] += next[c - 1];
    field_.elements_by_cell_.resize(field_.elements_.size());
    for (std::size_t i = 0; i < field_.elements_.size(); ++i) {
      if (i % 65536 == 0) control_.check();
      field_.elements_by_cell_[next[field_.elements_[i].cell]++] = static_cast<std::uint32_t>(i);
    }
  }

  void place_wood() {
    const double cell_m = field_.layout_.mean_cell_m();
    for (const Instance& instance : forest_.instances) {
      control_.check();
      const Prototype& prototype = forest_.prototypes[instance.prototype.value];
      for (const WoodSegment& segment : prototype.wood)
        add_segment(world_cylinder(instance, segment), cell_m);
      for (const WoodTriangle& triangle : prototype.wood_mesh) add_triangle(instance, triangle, cell_m);
    }
  }

 private:
  template <class Visit>
  void for_each_element(const Visit& visit) const {
    constexpr std::size_t kChunk = 4096;
    for_each_chunk(index_.element_count(), kChunk, control_, {}, [&](std::size_t begin, std::size_t end) {
      auto [instance, local] = index_.place(begin);
      for (std::size_t i = begin; i < end; ++i, ++local) {
        while (i >= index_.first_element(instance + 1)) {
          ++instance;
          local = 0;
        }
        visit(i, world_element(forest_, instance, local));
      }
    });
  }

  FieldElement flattened(const WorldElement& e) const {
    FieldElement element;
    const bool shoot = e.shape == ElementShape::kShoot;
    element.centre_m = Vec3f(field_.field_from_world(e.centre_m));
    element.axis = Vec3f(shoot ? e.half_u_m : unit_or_up(glm::cross(e.half_u_m, e.half_v_m)));
    element.area_m2 = static_cast<float>(e.area_m2);
    element.shoot_radius_m = shoot ? static_cast<float>(glm::length(e.half_v_m)) : 0.0f;
    const double height = e.centre_m.z - forest_.terrain.height_at(e.centre_m.x, e.centre_m.y);
    const double half_size = std::max(glm::length(e.half_u_m), glm::length(e.half_v_m));
    element.below_ground = height < -1e-3 * half_size - 1e-9 * std::abs(e.centre_m.z);
    return element;
  }

  static WorldCylinder world_cylinder(const Instance& instance, const WoodSegment& segment) {
    return {world_from_tree(instance, segment.from_m), world_from_tree(instance, segment.to_m),
            static_cast<double>(instance.scale) * segment.radius_from_m,
            static_cast<double>(instance.scale) * segment.radius_to_m};
  }

  Box wood_box() const {
    Box box;
    for (const Instance& instance : forest_.instances) {
      control_.check();
      const Prototype& prototype = forest_.prototypes[instance.prototype.value];
      for (const WoodSegment& segment : prototype.wood) {
        const WorldCylinder c = world_cylinder(instance, segment);
        box.include(field_.field_from_world(c.from_m));
        box.include(field_.field_from_world(c.to_m));
      }
      for (const WoodTriangle& t : prototype.wood_mesh)
        for (const Vec3f& corner : {t.a_m, t.b_m, t.c_m})
          box.include(field_.field_from_world(world_from_tree(instance, corner)));
    }
    return box;
  }

  // One piece per cell: what a blocker covers of a cell's face counts once.
  void add_pieces(std::vector<BlockerPiece>& pieces, std::size_t blocker,
                  const std::vector<SpreadPoint>& points) const {
    std::vector<BlockerPiece> parts;
    for (const SpreadPoint& p : points) {
      const auto cell = field_.layout_.cell_of(field_.field_from_world(p.point_m));
      parts.push_back(
          {static_cast<std::uint32_t>(blocker), field_.layout_.flat(cell), static_cast<float>(p.share)});
    }
    std::ranges::stable_sort(parts, {}, &BlockerPiece::cell);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (i > 0 && parts[i].cell == parts[i - 1].cell)
        pieces.back().share += parts[i].share;
      else
        pieces.push_back(parts[i]);
    }
  }

  void add_segment(const WorldCylinder& c, double cell_m) {
    const double width = c.radius_from_m + c.radius_to_m;
    if (!(width > 0.0) || c.from_m == c.to_m) return;
    add_pieces(field_.wood_pieces_, field_.wood_.size(), spread_cylinder(c, cell_m));
    field_.wood_.push_back({Vec3f(c.to_m - c.from_m), static_cast<float>(width)});
  }

  void add_triangle(const Instance& instance, const WoodTriangle& triangle, double cell_m) {
    const Vec3 a = world_from_tree(instance, triangle.a_m), b = world_from_tree(instance, triangle.b_m),
               c = world_from_tree(instance, triangle.c_m);
    add_pieces(field_.wood_pieces_, field_.wood_.size(), spread_triangle(a, b, c, cell_m));
    field_.wood_.push_back({Vec3f(0.25 * glm::cross(b - a, c - a)), 0.0f});  // half of the area vector
  }

  BlockerField& field_;
  const Forest& forest_;
  const ForestIndex index_;
  const RunControl& control_;
};

BlockerField::BlockerField(const Forest& forest, const BlockerFieldOptions& options,
                           const RunControl& control) {
  BlockerFieldBuilder builder(*this, forest, control);
  builder.choose_frame(options);
  builder.flatten_elements();
  SUNFLECK_EXPECTS(!elements_.empty());
  builder.choose_grid(options);
  builder.place_elements();
  builder.sort_elements();
  builder.place_wood();
}

}  // namespace sunfleck
