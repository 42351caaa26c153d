#include "sim/plant/wood_contacts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "sim/base/contract.h"

namespace sunfleck {
namespace {

constexpr double kCell_m = 0.25;
constexpr double kForkRadii = 4, kFork_m = 0.01;  // how far from a fork its limbs are one piece of wood

struct InCell {
  std::uint64_t cell;
  std::uint32_t segment;
  bool operator<(const InCell& other) const {
    return std::tie(cell, segment) < std::tie(other.cell, other.segment);
  }
  bool operator==(const InCell&) const = default;
};

std::uint64_t cell_of(std::int64_t x, std::int64_t y, std::int64_t z) {
  constexpr std::int64_t kMiddle = 1 << 20;
  const auto part = [](std::int64_t v) { return static_cast<std::uint64_t>(v + kMiddle) & 0x1FFFFF; };
  return part(x) << 42 | part(y) << 21 | part(z);
}

void note_box(const Vec3& lo, const Vec3& hi, std::uint32_t segment, std::vector<InCell>& cells) {
  const auto first = glm::floor(lo / kCell_m), last = glm::floor(hi / kCell_m);
  for (auto x = static_cast<std::int64_t>(first.x); x <= static_cast<std::int64_t>(last.x); ++x)
    for (auto y = static_cast<std::int64_t>(first.y); y <= static_cast<std::int64_t>(last.y); ++y)
      for (auto z = static_cast<std::int64_t>(first.z); z <= static_cast<std::int64_t>(last.z); ++z)
        cells.push_back({cell_of(x, y, z), segment});
}

// A long segment in pieces, so that its cells lie along it.
std::vector<InCell> cells_of(std::span<const WoodSegment> wood) {
  std::vector<InCell> cells;
  for (std::size_t i = 0; i < wood.size(); ++i) {
    const Vec3 from(wood[i].from_m), along = Vec3(wood[i].to_m) - from;
    const auto pieces = std::max(1.0, std::ceil(glm::length(along) / kCell_m));
    const Vec3 r(std::max(wood[i].radius_from_m, wood[i].radius_to_m));
    for (double k = 0; k < pieces; ++k) {
      const Vec3 a = from + along * (k / pieces), b = from + along * ((k + 1) / pieces);
      note_box(glm::min(a, b) - r, glm::max(a, b) + r, static_cast<std::uint32_t>(i), cells);
    }
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

struct Nearest {
  double on_first, on_second;  // shares of the way along each
};

// Of two line segments p + s d1 and q + t d2 with s and t in [0, 1] (Ericson 2005, Real-Time Collision
// Detection, 5.1.9).
Nearest nearest_points(const Vec3& p, const Vec3& d1, const Vec3& q, const Vec3& d2) {
  const Vec3 r = p - q;
  const double a = glm::dot(d1, d1), e = glm::dot(d2, d2), f = glm::dot(d2, r), c = glm::dot(d1, r);
  const double b = glm::dot(d1, d2), across = a * e - b * b;
  double s = across > 1e-12 * a * e ? std::clamp((b * f - c * e) / across, 0.0, 1.0) : 0.0;
  double t = e > 0 ? (b * s + f) / e : 0.0;
  if (t < 0 || t > 1) {
    t = std::clamp(t, 0.0, 1.0);
    s = a > 0 ? std::clamp((b * t - c) / a, 0.0, 1.0) : 0.0;
  }
  return {s, t};
}

class Contacts {
 public:
  Contacts(std::span<const WoodSegment> wood, std::span<const std::int32_t> parents, double tolerance)
      : wood_(wood), parents_(parents), tolerance_(tolerance), depth_(wood.size(), 0) {
    SUNFLECK_EXPECTS(parents.size() == wood.size() && tolerance >= 0);
    for (std::size_t i = 0; i < wood.size(); ++i) {
      SUNFLECK_EXPECTS(parents[i] < static_cast<std::int32_t>(i));
      if (parents[i] >= 0) depth_[i] = depth_[static_cast<std::size_t>(parents[i])] + 1;
    }
  }

  std::vector<WoodContact> find() {
    const std::vector<InCell> cells = cells_of(wood_);
    for (std::size_t begin = 0, end = 0; begin < cells.size(); begin = end) {
      while (end < cells.size() && cells[end].cell == cells[begin].cell) ++end;
      for (std::size_t i = begin; i < end; ++i)
        for (std::size_t j = i + 1; j < end; ++j) test(cells[i].segment, cells[j].segment);
    }
    const auto pair = [](const WoodContact& c) { return std::tie(c.first, c.second); };
    std::sort(found_.begin(), found_.end(),
              [&](const WoodContact& a, const WoodContact& b) { return pair(a) < pair(b); });
    const auto twice =
        std::unique(found_.begin(), found_.end(),
                    [&](const WoodContact& a, const WoodContact& b) { return pair(a) == pair(b); });
    found_.erase(twice, found_.end());
    return std::move(found_);
  }

 private:
  void test(std::size_t i, std::size_t j) {
    if (parents_[j] == static_cast<std::int32_t>(i) || (parents_[i] == parents_[j] && parents_[i] >= 0))
      return;
    const WoodSegment &a = wood_[i], &b = wood_[j];
    const Vec3 from_a(a.from_m), from_b(b.from_m), along_a = Vec3(a.to_m) - from_a,
                                                   along_b = Vec3(b.to_m) - from_b;
    const Nearest at = nearest_points(from_a, along_a, from_b, along_b);
    const Vec3 on_a = from_a + at.on_first * along_a, on_b = from_b + at.on_second * along_b;
    const double radius_a = a.radius_from_m + at.on_first * (a.radius_to_m - a.radius_from_m);
    const double radius_b = b.radius_from_m + at.on_second * (b.radius_to_m - b.radius_from_m);
    const double overlap_m = radius_a + radius_b - glm::distance(on_a, on_b);
    if (overlap_m > tolerance_ * std::min(radius_a, radius_b) && !at_fork(i, j, 0.5 * (on_a + on_b)))
      found_.push_back({i, j, overlap_m});
  }

  // Climbs from both to the segment they have in common.
  bool at_fork(std::size_t i, std::size_t j, const Vec3& point_m) const {
    auto a = static_cast<std::int32_t>(i), b = static_cast<std::int32_t>(j);
    while (a != b && a >= 0 && b >= 0) {
      std::int32_t& higher = depth(a) < depth(b) ? b : a;
      higher = parents_[static_cast<std::size_t>(higher)];
    }
    if (a != b) return false;  // two roots
    const WoodSegment& below = wood_[static_cast<std::size_t>(a)];
    return glm::distance(point_m, Vec3(below.to_m)) <= kForkRadii * below.radius_from_m + kFork_m;
  }

  int depth(std::int32_t segment) const { return depth_[static_cast<std::size_t>(segment)]; }

  std::span<const WoodSegment> wood_;
  std::span<const std::int32_t> parents_;
  double tolerance_;
  std::vector<int> depth_;
  std::vector<WoodContact> found_;
};

}  // namespace

std::vector<WoodContact> wood_contacts(std::span<const WoodSegment> wood,
                                       std::span<const std::int32_t> parents, double tolerance) {
  return Contacts(wood, parents, tolerance).find();
}

std::vector<bool> crossing_branches(std::span<const WoodSegment> wood, std::span<const std::int32_t> parents,
                                    double tolerance) {
  std::vector<WoodContact> contacts = wood_contacts(wood, parents, tolerance);
  const auto thinner = [&](const WoodContact& c) {
    return wood[c.first].radius_from_m < wood[c.second].radius_from_m ? c.first : c.second;
  };
  std::stable_sort(contacts.begin(), contacts.end(), [&](const WoodContact& a, const WoodContact& b) {
    return wood[thinner(a)].radius_from_m > wood[thinner(b)].radius_from_m;  // limbs before twigs
  });
  std::vector<bool> away(wood.size(), false);
  const auto gone = [&](std::size_t i) {
    auto at = static_cast<std::int32_t>(i);
    while (at >= 0 && !away[static_cast<std::size_t>(at)]) at = parents[static_cast<std::size_t>(at)];
    return at >= 0;
  };
  for (const WoodContact& contact : contacts)
    if (!gone(contact.first) && !gone(contact.second)) away[thinner(contact)] = true;
  for (std::size_t i = 0; i < wood.size(); ++i)
    if (parents[i] >= 0 && away[static_cast<std::size_t>(parents[i])]) away[i] = true;
  return away;
}

std::vector<std::int32_t> wood_parents(std::span<const WoodSegment> wood) {
  const auto before = [](const Vec3f& a, const Vec3f& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  };
  std::map<Vec3f, std::int32_t, decltype(before)> ends(before);
  std::vector<std::int32_t> parents;
  for (std::size_t i = 0; i < wood.size(); ++i) {
    const auto found = ends.find(wood[i].from_m);
    parents.push_back(found == ends.end() ? -1 : found->second);
    ends.emplace(wood[i].to_m, static_cast<std::int32_t>(i));
  }
  return parents;
}

}  // namespace sunfleck
