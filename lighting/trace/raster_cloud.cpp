#include "lighting/trace/raster_cloud.h"

#include <algorithm>
#include <cmath>

namespace sunfleck::trace {

void CloudLine::start(double end) {
  end_ = end;
  left_ = 1.0;
  clouds_.clear();
  borders_.clear();
}

void CloudLine::add(double enter, double leave, double extinction_per_m) {
  const std::size_t number = clouds_.size();
  clouds_.push_back({enter, leave, extinction_per_m});
  if (leave <= end_) return;
  borders_.push_back({leave, number, true});
  borders_.push_back({std::max(enter, end_), number, false});
}

// Between two borders the extinction is constant; `lit` is the integral of the transmittance from the sun.
void CloudLine::follow() {
  std::sort(borders_.begin(), borders_.end(), [](const Border& x, const Border& y) {
    if (x.depth != y.depth) return x.depth > y.depth;
    return x.cloud != y.cloud ? x.cloud < y.cloud : x.begins && !y.begins;
  });
  double extinction = 0.0, lit = 0.0, depth = borders_.empty() ? 0.0 : borders_.front().depth;
  for (const Border& b : borders_) {
    const double way = depth - b.depth, optical = std::max(0.0, extinction) * way;
    lit += left_ * way * (optical > 1e-12 ? -std::expm1(-optical) / optical : 1.0);
    left_ *= std::exp(-optical);
    depth = b.depth;
    Cloud& cloud = clouds_[b.cloud];
    cloud.lit_m += b.begins ? -lit : lit;
    extinction += b.begins ? cloud.extinction_per_m : -cloud.extinction_per_m;
  }
  for (Cloud& c : clouds_) c.lit_m = std::clamp(c.lit_m, 0.0, c.leave - c.enter);
}

}  // namespace sunfleck::trace
