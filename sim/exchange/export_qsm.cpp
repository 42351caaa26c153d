#include <cmath>
#include <cstdint>
#include <cstdio>
#include <span>
#include <unordered_map>

#include "sim/base/error.h"
#include "sim/base/pending_file.h"
#include "sim/exchange/qsm.h"

namespace sunfleck {
namespace {

constexpr double kJoint_m = 1e-4;  // ends this close are one joint

std::uint64_t joint_key(std::int64_t x, std::int64_t y, std::int64_t z) {
  const auto part = [](std::int64_t v) { return static_cast<std::uint64_t>(v + (1 << 20)) & 0x1fffff; };
  return part(x) << 42 | part(y) << 21 | part(z);
}

struct Joint {
  Vec3 point_m;
  int segment;
};

// Segments by the place of their start or end, on a lattice of kJoint_m.
class Joints {
 public:
  void add(const Vec3& p, int segment) { at_[key(p)].push_back({p, segment}); }

  // The thickest other segment that has a joint within kJoint_m of p and a number below `before`.
  int find(const Vec3& p, int before, const std::vector<WoodSegment>& wood) const {
    int best = -1;
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz)
          for (const Joint& joint : joints_near(p + kJoint_m * Vec3(dx, dy, dz)))
            if (joint.segment < before && glm::distance(joint.point_m, p) <= kJoint_m &&
                (best < 0 || thickness(joint.segment, wood) > thickness(best, wood)))
              best = joint.segment;
    return best;
  }

 private:
  static std::uint64_t key(const Vec3& p) {
    return joint_key(std::llround(p.x / kJoint_m), std::llround(p.y / kJoint_m),
                     std::llround(p.z / kJoint_m));
  }
  static float thickness(int segment, const std::vector<WoodSegment>& wood) {
    return wood[static_cast<std::size_t>(segment)].radius_to_m;
  }
  std::span<const Joint> joints_near(const Vec3& p) const {
    const auto found = at_.find(key(p));
    return found == at_.end() ? std::span<const Joint>() : found->second;
  }
  std::unordered_map<std::uint64_t, std::vector<Joint>> at_;
};

// 0 for the stem; a branch has one more than what it grows from. Parents come before their children.
std::vector<int> branch_orders(const std::vector<WoodSegment>& wood, const std::vector<int>& parents) {
  std::vector<int> thickest(wood.size(), -1), orders(wood.size(), 0);
  for (std::size_t i = 0; i < wood.size(); ++i) {
    if (parents[i] < 0) continue;
    int& child = thickest[static_cast<std::size_t>(parents[i])];
    if (child < 0 || wood[i].radius_from_m > wood[static_cast<std::size_t>(child)].radius_from_m)
      child = static_cast<int>(i);
  }
  for (std::size_t i = 0; i < wood.size(); ++i) {
    if (parents[i] < 0) continue;
    const auto parent = static_cast<std::size_t>(parents[i]);
    orders[i] = orders[parent] + (thickest[parent] == static_cast<int>(i) ? 0 : 1);
  }
  return orders;
}

std::string row_of(const WoodSegment& s, std::size_t id, int parent, int order) {
  char row[400];
  const double length_m = glm::distance(Vec3(s.from_m), Vec3(s.to_m));
  std::snprintf(row, sizeof row, "%zu,%d,%d,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", id,
                parent + 1, order, s.from_m.x, s.from_m.y, s.from_m.z, s.to_m.x, s.to_m.y, s.to_m.z,
                s.radius_from_m, s.radius_to_m, 0.5 * (s.radius_from_m + s.radius_to_m), length_m);
  return row;
}

}  // namespace

// Only earlier segments can be parents, so that there are no circles: all our trees state the stem first.
std::vector<int> wood_parents(const std::vector<WoodSegment>& wood) {
  Joints ends, starts;
  for (std::size_t i = 0; i < wood.size(); ++i) {
    ends.add(wood[i].to_m, static_cast<int>(i));
    starts.add(wood[i].from_m, static_cast<int>(i));
  }
  std::vector<int> parents(wood.size(), -1);
  for (std::size_t i = 0; i < wood.size(); ++i) {
    const int before = static_cast<int>(i);
    parents[i] = ends.find(wood[i].from_m, before, wood);
    if (parents[i] < 0) parents[i] = starts.find(wood[i].from_m, before, wood);
  }
  return parents;
}

std::size_t export_qsm(const Prototype& prototype, const std::filesystem::path& path) {
  validate(prototype, prototype.name);
  if (prototype.wood.empty())
    throw_invalid(path.string(), "the prototype has no wood segments", "export it as obj, ply or gltf");
  const std::vector<int> parents = wood_parents(prototype.wood);
  const std::vector<int> orders = branch_orders(prototype.wood, parents);
  std::string text =
      "id,parent_id,branch_order,start_x_m,start_y_m,start_z_m,end_x_m,end_y_m,end_z_m,radius_start_m,"
      "radius_end_m,radius_m,length_m\n";
  for (std::size_t i = 0; i < prototype.wood.size(); ++i)
    text += row_of(prototype.wood[i], i + 1, parents[i], orders[i]);
  write_whole_file(path, text);
  return prototype.wood_mesh.size();
}

}  // namespace sunfleck
