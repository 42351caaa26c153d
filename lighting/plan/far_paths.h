// Paths of light traced backwards from selected elements, with what each may bring from every tree that it
// meets. Part of far_trees.h.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "lighting/plan/far_trees.h"

namespace sunfleck::far_trees {

// One thing that happened to a path, as far as a tree had to do with it.
struct PathEvent {
  std::uint32_t tree = 0;
  bool ends = false;  // the tree was met: without it the path goes on elsewhere
  float most = 0;     // that it may bring or take, relative to the mean light
};

class PathRecords {
 public:
  PathRecords(std::size_t trees, int paths_per_face) : trees_(trees), paths_per_face_(paths_per_face) {}

  std::size_t trees() const { return trees_; }
  std::size_t elements() const { return elements_.size(); }
  std::size_t paths() const { return 2 * static_cast<std::size_t>(paths_per_face_) * elements(); }
  double largest() const { return largest_; }  // that any path may bring

  // An element's paths: front and back face of path 0, of path 1, ...
  void add_element(std::vector<std::vector<PathEvent>> paths);

  // What light on this element may change without the trees marked in `gone`, by the even and by the odd
  // paths.
  std::pair<double, double> change(std::size_t element, const std::vector<bool>& gone) const;
  // Over all events of each tree.
  std::vector<double> sums() const;

 private:
  struct Element {
    std::vector<PathEvent> events;
    std::vector<std::uint32_t> first_event;  // of each path, and the end
  };
  std::size_t trees_;
  int paths_per_face_;
  double largest_ = 0;
  std::vector<Element> elements_;
};

class PathPlan {
 public:
  // Measures the mean light of the selected trees by probes. All must outlive the plan.
  PathPlan(const ProbeScene& scene, const OpticsTable& optics, const Illumination& light,
           const std::vector<std::uint32_t>& selected, const FarTreesOptions& options,
           const RunControl& control);

  // Half of the elements; `half` 0 and 1 are independent.
  PathRecords trace(int half) const;

 private:
  std::vector<std::size_t> draw(int half, std::size_t count) const;
  std::vector<double> mean_light_w_m2() const;
  std::vector<double> most_of_surfaces_w_m2() const;
  std::vector<std::vector<PathEvent>> paths_of(std::size_t element, std::uint64_t number) const;

  const ProbeScene& scene_;
  const OpticsTable& optics_;
  const Illumination& light_;
  const std::vector<std::uint32_t>& selected_;
  const FarTreesOptions& options_;
  const RunControl& control_;
  std::vector<double> mean_w_m2_, surfaces_w_m2_;  // per band
};

}  // namespace sunfleck::far_trees
