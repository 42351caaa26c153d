// Geometry of the elements of a light map file: place, normal, area, shape and origin, computed from the
// forest one block at a time.
#include <algorithm>

#include "lighting/map/netcdf_sink.h"

namespace sunfleck::netcdf {
namespace {

struct GeometryVariables {
  int x, y, z, normal_x, normal_y, normal_z, area, shape, tree, instance, local;
};

GeometryVariables define_geometry(const Sink& sink) {
  const std::vector<int> at{sink.dimensions.element};
  GeometryVariables v{};
  v.x = define(sink, "x", NC_DOUBLE, at, {"m", "centre of the element, towards east", nullptr});
  v.y = define(sink, "y", NC_DOUBLE, at, {"m", "centre of the element, towards north", nullptr});
  v.z = define(sink, "z", NC_DOUBLE, at, {"m", "centre of the element, upwards", nullptr});
  sink.file.put_text(v.z, "positive", "up");
  const char* normal = "front normal of the element (0 for a shoot, which has none)";
  v.normal_x = define(sink, "normal_x", NC_FLOAT, at, {"1", normal, kElementPlace});
  v.normal_y = define(sink, "normal_y", NC_FLOAT, at, {"1", normal, kElementPlace});
  v.normal_z = define(sink, "normal_z", NC_FLOAT, at, {"1", normal, kElementPlace});
  v.area = define(sink, "area", NC_DOUBLE, at, {"m2", "one-sided area of the element", kElementPlace});
  v.shape = define(sink, "shape", NC_BYTE, at, {nullptr, "shape of the element", kElementPlace});
  const signed char flags[] = {0, 1, 2, 3};
  sink.file.check(nc_put_att_schar(sink.file.id(), v.shape, "flag_values", NC_BYTE, 4, flags), "flag_values");
  sink.file.put_text(v.shape, "flag_meanings", "parallelogram disc triangle shoot");
  v.tree = define(sink, "tree_id", NC_UINT, at, {"1", "number of the tree in its inventory", kElementPlace});
  v.instance = define(sink, "instance", NC_UINT, at, {"1", "index of the tree in the forest", kElementPlace});
  v.local = define(sink, "prototype_element", NC_UINT, at,
                   {"1", "index of the element in the tree's prototype", kElementPlace});
  return v;
}

struct GeometryBlock {
  std::vector<double> x, y, z, area;
  std::vector<float> normal_x, normal_y, normal_z;
  std::vector<signed char> shape;
  std::vector<std::uint32_t> tree, instance, local;
};

void append(GeometryBlock& block, const Forest& forest, const ForestIndex::Place& place) {
  const WorldElement element = world_element(forest, place.instance, place.local);
  const Vec3 across = glm::cross(element.half_u_m, element.half_v_m);
  const double length = glm::length(across);
  const bool has_normal = element.shape != ElementShape::kShoot && length > 0.0;
  const Vec3 normal = has_normal ? across / length : Vec3(0.0);
  block.x.push_back(element.centre_m.x);
  block.y.push_back(element.centre_m.y);
  block.z.push_back(element.centre_m.z);
  block.normal_x.push_back(static_cast<float>(normal.x));
  block.normal_y.push_back(static_cast<float>(normal.y));
  block.normal_z.push_back(static_cast<float>(normal.z));
  block.area.push_back(element.area_m2);
  block.shape.push_back(static_cast<signed char>(element.shape));
  block.tree.push_back(forest.instances[place.instance].tree.value);
  block.instance.push_back(place.instance);
  block.local.push_back(place.local);
}

}  // namespace

void write_geometry(const Sink& sink, const Forest& forest, const ForestIndex& index) {
  const GeometryVariables v = define_geometry(sink);
  for (std::size_t begin = 0; begin < index.element_count(); begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, index.element_count());
    GeometryBlock block;
    for (std::size_t i = begin; i < end; ++i) append(block, forest, index.place(i));
    const auto write = [&](int variable, const auto& values) {
      put(sink, variable, {begin}, {end - begin}, values);
    };
    write(v.x, block.x), write(v.y, block.y), write(v.z, block.z);
    write(v.normal_x, block.normal_x), write(v.normal_y, block.normal_y), write(v.normal_z, block.normal_z);
    write(v.area, block.area), write(v.shape, block.shape);
    write(v.tree, block.tree), write(v.instance, block.instance), write(v.local, block.local);
  }
}

}  // namespace sunfleck::netcdf
