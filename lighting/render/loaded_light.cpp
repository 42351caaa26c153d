#include "lighting/render/loaded_light.h"

#include <algorithm>
#include <string>

#include "sim/base/contract.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

struct Kept {
  std::size_t from, to, count;  // elements from .. from + count of the whole become to .. to + count
};

std::vector<Kept> kept_runs(const ForestOutline& whole, const std::vector<char>& loaded) {
  std::vector<Kept> runs;
  std::size_t from = 0, to = 0;
  for (const Instance& instance : whole.instances) {
    const std::size_t count = whole.prototypes[instance.prototype.value].foliage_elements;
    if (loaded[instance.prototype.value]) {
      runs.push_back({from, to, count});
      to += count;
    }
    from += count;
  }
  return runs;
}

std::size_t element_count(const ForestOutline& forest) {
  std::size_t count = 0;
  for (const Instance& i : forest.instances) count += forest.prototypes[i.prototype.value].foliage_elements;
  return count;
}

// In place: every run moves towards the front.
template <class T>
void keep(const std::vector<Kept>& runs, std::vector<T>& values) {
  for (const Kept& run : runs) {
    const auto from = values.begin() + static_cast<std::ptrdiff_t>(run.from);
    std::copy(from, from + static_cast<std::ptrdiff_t>(run.count),
              values.begin() + static_cast<std::ptrdiff_t>(run.to));
  }
  values.resize(runs.empty() ? 0 : runs.back().to + runs.back().count);
  values.shrink_to_fit();
}

}  // namespace

LightMap light_of_loaded(LightMap map, const ForestOutline& whole, const std::vector<char>& loaded) {
  SUNFLECK_EXPECTS(loaded.size() == whole.prototypes.size());
  const std::size_t count = element_count(whole);
  const std::vector<Kept> runs = kept_runs(whole, loaded);
  for (BandLightMap& band : map.bands) {
    if (band.elements.size() != count)
      throw_invalid(
          "map",
          "has " + std::to_string(band.elements.size()) + " elements, the forest " + std::to_string(count),
          "give the light map that was computed for this forest");
    keep(runs, band.elements);
    if (!band.standard_error_w_m2.empty()) keep(runs, band.standard_error_w_m2);
  }
  if (!map.sunlit_fraction.empty()) keep(runs, map.sunlit_fraction);
  return map;
}

}  // namespace sunfleck
