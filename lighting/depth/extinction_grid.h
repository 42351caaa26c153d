// The leaf-area grid for one direction, and optical depths by marching it.
//
// Every blocker adds -log1p(-q) / h to its cell, q its projected area over the cell's face h^2, at most 0.9:
// the contribution whose exponential is right on average when leaves are independent (adding q itself lets
// too much light through, by several percent at cells of two leaf sides). A ray adds extinction times the
// exact length in each cell. Assumes cells of 2 to 4 leaf sides and more than some hundred elements; leaves
// that hide behind each other on purpose (clumps smaller than a cell) get too little light.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lighting/depth/blocker_field.h"
#include "lighting/depth/grid_march.h"

namespace sunfleck {

// Which way along the grid's direction.
enum class March { kForward, kBackward };

class ExtinctionGrid {
 public:
  // `field` must outlive the grid. One grid serves `direction` (unit) and its opposite.
  ExtinctionGrid(const BlockerField& field, const Vec3& direction, const RunControl& control);

  // The same for another direction, in the memory already there.
  void turn_to(const Vec3& direction, const RunControl& control);

  // Optical depth from the middle of an element to the border of the scene, without the element itself, in
  // [0, kLargestDepth]. An element below the ground gets kLargestDepth.
  double depth_from_element(std::size_t element, March march) const;
  // Optical depth from a point of the world; the point may lie outside the grid.
  double depth_from_point(const Vec3& point_m, March march) const;
  // depth_from_element for many, sixteen at a time and in float (march_lanes.h): best of neighbours together.
  void depths_from_elements(std::span<const std::uint32_t> elements, March march, float* depths) const;
  // depth_from_element for all, in order; as depths_from_elements().
  std::vector<float> depth_of_elements(March march, const RunControl& control) const;

  const std::vector<float>& extinction_per_m() const { return extinction_per_m_; }
  // Contributions that q <= 0.9 cut off.
  std::size_t clamped() const { return clamped_; }

 private:
  void add_elements(const RunControl& control);
  void add_wood(const RunControl& control);
  float extinction_of(double projected_m2) const;

  const BlockerField& field_;
  Vec3 direction_{0, 0, 1};        // world
  Vec3 field_direction_{0, 0, 1};  // may be sheared
  std::vector<float> extinction_per_m_;
  std::vector<float> own_extinction_per_m_;  // of every element in the cell of its centre
  std::size_t clamped_ = 0;
};

}  // namespace sunfleck
