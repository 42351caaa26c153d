// Light maps between lighting and the wire: big parts as arrays, the rest as the summary.
#pragma once

#include <memory>
#include <vector>

#include "lighting/base/light_map.h"
#include "server/convert/array_message.h"

namespace sunfleck {

namespace v1 {
class Provenance;
class BandSummary;
class LightMapSummary;
}  // namespace v1

// Views of the map's big parts, and the small columns of the trees, which are gathered here. Per band:
// "<band>/element_light" (n x 7 float32), "<band>/standard_error_w_m2" (n float32, absent where the method
// has none), "<band>/tree_ids" (t x 2 uint32), "<band>/tree_light" (t x 5 float64); first "sunlit_fraction"
// (n).
class LightMapArrays {
 public:
  explicit LightMapArrays(std::shared_ptr<const LightMap> map);
  const std::vector<ArrayView>& views() const { return views_; }
  std::uint64_t size_bytes() const;

 private:
  void add_band(const BandLightMap& band);
  std::shared_ptr<const LightMap> map_;
  std::vector<std::vector<std::uint32_t>> tree_ids_;
  std::vector<std::vector<double>> tree_light_;
  std::vector<ArrayView> views_;
};

void fill_message(const Provenance& provenance, v1::Provenance& message);
Provenance provenance_from_message(const v1::Provenance& message);
void fill_message(const BandLightMap& band, v1::BandSummary& message);
void fill_summary(const LightMap& map, const LightMapArrays& arrays, v1::LightMapSummary& message);

// The same map again, bit by bit. Throws Error(kInputOutput) if arrays and summary do not fit together.
LightMap light_map_from_messages(const std::vector<ReceivedArray>& arrays,
                                 const v1::LightMapSummary& summary);

std::size_t memory_bytes(const LightMap& map);

}  // namespace sunfleck
