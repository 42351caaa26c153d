// See blocker_field.h.
#include "lighting/depth/blocker_field.h"

#include <algorithm>
#include <cmath>

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

  double usual_cell_m(const Vec3& size_m, const BlockerFieldOptions& options) const {
    const double extent_m = std::max({size_m.x, size_m.y, size_m.z});
    const double cell_m = leaf_cell_size(extent_m, field_.mean_side_m_);
    if (!(options.most_cells_per_element > 0.0) || field_.elements_.empty()) return cell_m;
    const double cells = options.most_cells_per_element * static_cast<double>(field_.elements_.size());
    return std::max(cell_m, std::min(extent_m / 32.0, std::cbrt(size_m.x * size_m.y * size_m.z / cells)));
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
    const double cell = options.cell_m > 0.0 ? options.cell_m : usual_cell_m(box.size(), options);
    const std::uint64_t worthwhile = std::max<std::uint64_t>(8ull << 20, 512 * field_.elements_.size());
    const std::uint64_t most =
        options.keep_cell ? options.max_cells : std::min(options.max_cells, worthwhile);
    const Box wide = options.margin_m > 0.0 ? widened(box, options.margin_m) : box;
    field_.layout_ = fit_grid(wide, field_.frame_.period_box(), cell, most);
  }

  void place_elements() {
    for_each_chunk(field_.elements_.size(), kChunk, control_, {}, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        FieldElement& element = field_.elements_[i];
        element.cell = field_.layout_.flat(field_.layout_.cell_of(Vec3(element.centre_m)));
      }
    });
    spread_large_elements();
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
  static constexpr std::size_t kChunk = 4096;

  // An instance's turn and size, found once for all its elements.
  struct Placed {
    const Instance& instance;
    double sine = std::sin(static_cast<double>(instance.yaw_rad)),
           cosine = std::cos(static_cast<double>(instance.yaw_rad));

    Vec3 turned(const Vec3f& v) const {
      const Vec3 p(v);
      return static_cast<double>(instance.scale) *
             Vec3(cosine * p.x - sine * p.y, sine * p.x + cosine * p.y, p.z);
    }
    WorldElement world(const FoliageElement& e) const {
      const double scale = instance.scale;
      return {instance.position_m + turned(e.centre_m),
              turned(e.half_u_m),
              turned(e.half_v_m),
              scale * scale * e.area_m2,
              e.shape,
              e.material};
    }
  };

  // visit(index, element) for all.
  template <class Visit>
  void for_each_element(const Visit& visit) const {
    for_each_chunk(index_.element_count(), kChunk, control_, {}, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end;) {
        const auto [instance, local] = index_.place(i);
        const Placed placed{forest_.instances[instance]};
        const Prototype& prototype = forest_.prototypes[placed.instance.prototype.value];
        const std::size_t last = std::min(end, index_.first_element(instance + 1));
        for (std::size_t k = local; i < last; ++i, ++k) visit(i, placed.world(prototype.foliage[k]));
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

  // Only trees whose largest element does not fit a cell are looked through.
  void spread_large_elements() {
    const double cell_m = field_.layout_.mean_cell_m();
    std::vector<WorldElement> largest;
    for (const Prototype& p : forest_.prototypes) largest.push_back(largest_of(p));
    for (std::size_t i = 0; i < forest_.instances.size(); ++i) {
      const std::size_t first = index_.first_element(i), count = index_.first_element(i + 1) - first;
      const Instance& instance = forest_.instances[i];
      if (count == 0 || !needs_spreading(scaled(largest[instance.prototype.value], instance.scale), cell_m))
        continue;
      const Placed placed{instance};
      for (std::size_t local = 0; local < count; ++local) {
        if (local % kChunk == 0) control_.check();
        const WorldElement e = placed.world(forest_.prototypes[instance.prototype.value].foliage[local]);
        if (needs_spreading(e, cell_m))
          add_pieces(field_.element_pieces_, first + local, spread_element(e, cell_m));
      }
    }
  }

  // Something no element of the prototype exceeds, a little larger for rounding.
  static WorldElement largest_of(const Prototype& prototype) {
    WorldElement largest{};
    largest.shape = ElementShape::kParallelogram;
    for (const FoliageElement& e : prototype.foliage) {
      largest.half_u_m.x = std::max({largest.half_u_m.x, glm::length(Vec3(e.half_u_m)) * (1.0 + 1e-9),
                                     glm::length(Vec3(e.half_v_m)) * (1.0 + 1e-9)});
      largest.area_m2 = std::max(largest.area_m2, static_cast<double>(e.area_m2) * (1.0 + 1e-9));
    }
    return largest;
  }
  static WorldElement scaled(WorldElement element, double scale) {
    element.half_u_m *= scale;
    element.area_m2 *= scale * scale;
    return element;
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
