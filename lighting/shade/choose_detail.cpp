#include "lighting/shade/choose_detail.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "sim/base/contract.h"
#include "sim/base/error.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool comes_first(const MeasuredDetail& a, const MeasuredDetail& b) {
  return a.detail != b.detail ? a.detail < b.detail : a.footprint < b.footprint;
}

// Of a flat element its own, of a shoot that of its cylinder from the side.
double outline_m2(const FoliageElement& e) {
  if (e.shape != ElementShape::kShoot) return element_geometric_area(e);
  return 4.0 * glm::length(Vec3(e.half_u_m)) * glm::length(Vec3(e.half_v_m));
}

}  // namespace

std::string to_string(Detail detail) {
  switch (detail) {
    case Detail::kExplicit:
      return "explicit";
    case Detail::kPruned4:
      return "pruned_4";
    case Detail::kPruned16:
      return "pruned_16";
    case Detail::kPruned64:
      return "pruned_64";
    case Detail::kBough:
      return "bough";
    default:
      return "billboards";
  }
}

double leaf_side_m(std::span<const FoliageElement> foliage) {
  double sum = 0, squares = 0;
  for (const FoliageElement& e : foliage) {
    const double area = outline_m2(e);
    sum += area, squares += area * area;
  }
  return sum > 0 ? std::sqrt(squares / sum) : 0;
}

DetailTable::DetailTable(std::vector<MeasuredDetail> rows) : rows_(std::move(rows)) {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const MeasuredDetail& row = rows_[i];
    const std::string where = "detail table row " + std::to_string(i);
    if (!(row.footprint > 0) || !std::isfinite(row.footprint))
      throw_invalid(where, "footprint is not a positive number", "leaf sides > 0");
    if (!(row.rms_error >= 0) || !(row.cost_ns >= 0))
      throw_invalid(where, "error or cost is negative or undefined", "both >= 0");
  }
  std::sort(rows_.begin(), rows_.end(), comes_first);
  const auto same = std::adjacent_find(rows_.begin(), rows_.end(), [](const auto& a, const auto& b) {
    return !comes_first(a, b) && !comes_first(b, a);
  });
  if (same != rows_.end())
    throw_invalid(
        "detail table",
        "two rows of one representation at a footprint of " + std::to_string(same->footprint) + " leaf sides",
        "one");
}

MeasuredDetail DetailTable::at(Detail detail, double footprint) const {
  SUNFLECK_EXPECTS(footprint > 0);
  const auto first =
      std::lower_bound(rows_.begin(), rows_.end(), MeasuredDetail{detail, 0, 0, 0}, comes_first);
  const auto last = std::find_if(first, rows_.end(), [&](const auto& row) { return row.detail != detail; });
  const MeasuredDetail unknown{detail, footprint, detail == Detail::kExplicit ? 0 : kInfinity, kInfinity};
  if (first == last) return unknown;
  const auto above = std::find_if(first, last, [&](const auto& row) { return row.footprint >= footprint; });
  if (above == last) return {detail, footprint, (last - 1)->rms_error, (last - 1)->cost_ns};
  if (above == first && above->footprint > footprint) {
    if (detail != Detail::kExplicit) return unknown;
    return {detail, footprint, above->rms_error, above->cost_ns};
  }
  if (above->footprint == footprint) return *above;
  const MeasuredDetail &a = *(above - 1), &b = *above;
  const double share = std::log(footprint / a.footprint) / std::log(b.footprint / a.footprint);
  return {detail, footprint, std::lerp(a.rms_error, b.rms_error, share),
          std::lerp(a.cost_ns, b.cost_ns, share)};
}

Detail DetailTable::choose(double footprint, double rms_tolerance, double uniform, LightUse use) const {
  SUNFLECK_EXPECTS(footprint > 0 && uniform >= 0 && uniform < 1);
  if (use == LightUse::kLightMap) return Detail::kExplicit;
  const double shifted = footprint / (1 + 0.4 * uniform);
  Detail best = Detail::kExplicit;
  double cost = at(best, shifted).cost_ns;
  for (int i = 1; i < kDetails; ++i) {
    const MeasuredDetail row = at(static_cast<Detail>(i), shifted);
    if (row.rms_error <= rms_tolerance && row.cost_ns < cost) best = row.detail, cost = row.cost_ns;
  }
  return best;
}

double detail_choice(std::uint64_t seed, std::uint64_t instance) {
  return RandomStream(seed, instance, RandomPurpose::kDetailChoice).uniform();
}

}  // namespace sunfleck
