// One tree on its way: a string that is derived once a year, and what it draws. For sim/growth only.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "sim/growth/grow_in_light.h"
#include "sim/lsystem/lsystem.h"

namespace sunfleck::growth {

// Light at a place of the tree's own frame.
using LightAt = std::function<double(const Vec3& position_m)>;

class GrowingTree {
 public:
  // `species` must outlive it.
  GrowingTree(const Species& species, std::shared_ptr<const lsystem::Grammar> grammar, std::uint64_t seed,
              const RunControl& control);

  // This year's foliage, in the tree's frame. Throws Error(kLimitExceeded) for more than `most_leaves`.
  std::vector<LeafPlace> leaves(std::size_t most_leaves) const;
  double height_m() const { return drawing_.bounds.hi.z; }
  int years() const { return years_; }
  // Buds ask, the grammar answers: next year's tree. Throws Error(kInvalidInput) for light outside [0, 1].
  void grow_a_year(const LightAt& light, const RunControl& control);
  // Wood that carries leaves, without branches that cross others (the leaves of those go with them) and
  // leaves in the ground. The tree is used up.
  Prototype finished(double twig_radius_m);

 private:
  const Species& species_;
  std::shared_ptr<const lsystem::Grammar> grammar_;
  lsystem::DeriveOptions derive_;
  lsystem::ModuleString string_;
  lsystem::Drawing drawing_;
  int years_ = 0;
};

}  // namespace sunfleck::growth
