// A line through overlapping clouds of needles: how much of the beam is left on the way, exactly for clouds
// that are even inside.
#pragma once

#include <vector>

namespace sunfleck::trace {

class CloudLine {
 public:
  // A new line, down to a surface at `end` (-infinity: none); depths fall along the beam.
  void start(double end);
  void add(double enter, double leave, double extinction_per_m);
  void follow();

  double transmittance() const { return left_; }  // down to the end
  // Integral of the transmittance over the i-th cloud's stretch, m.
  double lit_way_m(std::size_t i) const { return clouds_[i].lit_m; }

 private:
  struct Cloud {
    double enter, leave, extinction_per_m;
    double lit_m = 0;
  };
  struct Border {
    double depth;
    std::size_t cloud;
    bool begins;  // coming from the sun
  };

  double end_ = 0.0, left_ = 1.0;
  std::vector<Cloud> clouds_;
  std::vector<Border> borders_;
};

}  // namespace sunfleck::trace
