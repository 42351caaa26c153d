#include "lighting/bench/error_figures.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "lighting/depth/extinction_grid.h"
#include "sim/base/contract.h"

namespace sunfleck {
namespace {

constexpr int kCellsPerAxis = 3;
constexpr std::uint32_t kMostLayers = 255;

double total(const ElementLight& light) {
  return static_cast<double>(light.front.total()) + light.back.total();
}

double diffuse(const ElementLight& light) {
  return static_cast<double>(light.front.sky_w_m2) + light.front.scattered_w_m2 + light.back.sky_w_m2 +
         light.back.scattered_w_m2;
}

double mean_square(const std::vector<float>& values) {
  double sum = 0.0;
  for (const float v : values) sum += static_cast<double>(v) * v;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

std::uint32_t cell_of(const Vec3& point_m, const Box& box) {
  const Vec3 share = (point_m - box.lo) / glm::max(box.size(), Vec3(1e-300));
  std::uint32_t cell = 0;
  for (int axis = 0; axis < 3; ++axis)
    cell = cell * kCellsPerAxis + static_cast<std::uint32_t>(std::clamp(
                                      static_cast<int>(share[axis] * kCellsPerAxis), 0, kCellsPerAxis - 1));
  return cell;
}

std::uint32_t layers(double depth) {
  return static_cast<std::uint32_t>(std::min<double>(kMostLayers, depth));
}

struct Group {
  double difference = 0, truth = 0, count = 0;
};

std::map<std::uint32_t, Group> grouped(const std::vector<std::uint32_t>& group_of,
                                       const BandLightMap& estimate, const BandLightMap& truth) {
  std::map<std::uint32_t, Group> groups;
  for (std::size_t i = 0; i < group_of.size(); ++i) {
    Group& g = groups[group_of[i]];
    g.difference += total(estimate.elements[i]) - total(truth.elements[i]);
    g.truth += total(truth.elements[i]);
    g.count += 1.0;
  }
  return groups;
}

// RMS of the cells' mean differences, cells weighted by their elements.
double cell_rms(const std::vector<std::uint32_t>& cells, const BandLightMap& estimate,
                const BandLightMap& truth, double truth_mean) {
  double sum = 0.0;
  for (const auto& [cell, g] : grouped(cells, estimate, truth)) sum += g.difference * g.difference / g.count;
  return std::sqrt(sum / static_cast<double>(cells.size())) / truth_mean;
}

// [SPP] Eq. 30, read as sqrt(sum (<L> - <L0>)^2 / sum <L0>^2) with the classes unweighted.
double class_rms(const std::vector<std::uint32_t>& classes, const BandLightMap& estimate,
                 const BandLightMap& truth) {
  double squares = 0.0, truth_squares = 0.0;
  for (const auto& [index, g] : grouped(classes, estimate, truth)) {
    squares += std::pow(g.difference / g.count, 2);
    truth_squares += std::pow(g.truth / g.count, 2);
  }
  return truth_squares > 0.0 ? std::sqrt(squares / truth_squares) : 0.0;
}

}  // namespace

ErrorGroups error_groups(const Forest& forest, const Vec3& to_sun, const RunControl& control) {
  const ForestIndex index(forest);
  const Box box = forest_bounds(forest);
  const BlockerField field(forest, {}, control);
  const ExtinctionGrid grid(field, to_sun, control);
  const std::vector<float> before = grid.depth_of_elements(March::kForward, control);
  const std::vector<float> behind = grid.depth_of_elements(March::kBackward, control);
  ErrorGroups groups;
  groups.cell.resize(index.element_count());
  groups.depth_class.resize(index.element_count());
  for (std::size_t i = 0; i < index.element_count(); ++i) {
    const auto place = index.place(i);
    groups.cell[i] = cell_of(world_element(forest, place.instance, place.local).centre_m, box);
    groups.depth_class[i] = layers(before[i]) * (kMostLayers + 1) + layers(before[i] + behind[i]);
  }
  return groups;
}

ErrorFigures compare(const ErrorGroups& groups, const BandLightMap& estimate, const BandLightMap& truth) {
  SUNFLECK_EXPECTS(estimate.elements.size() == truth.elements.size() && !truth.elements.empty());
  const double n = static_cast<double>(truth.elements.size());
  double mean = 0, diffuse_mean = 0, bias = 0, squares = 0, diffuse_squares = 0;
  for (std::size_t i = 0; i < truth.elements.size(); ++i) {
    const double d = total(estimate.elements[i]) - total(truth.elements[i]);
    const double dd = diffuse(estimate.elements[i]) - diffuse(truth.elements[i]);
    mean += total(truth.elements[i]) / n;
    diffuse_mean += diffuse(truth.elements[i]) / n;
    bias += d / n;
    squares += d * d / n;
    diffuse_squares += dd * dd / n;
  }
  SUNFLECK_EXPECTS(mean > 0.0);
  ErrorFigures figures;
  figures.bias = bias / mean;
  figures.element_rms = std::sqrt(std::max(0.0, squares - mean_square(truth.standard_error_w_m2))) / mean;
  figures.cell_rms = cell_rms(groups.cell, estimate, truth, mean);
  figures.class_rms = class_rms(groups.depth_class, estimate, truth);
  figures.diffuse_rms = diffuse_mean > 0 ? std::sqrt(diffuse_squares) / diffuse_mean : 0.0;
  return figures;
}

}  // namespace sunfleck
