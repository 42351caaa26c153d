// When the light of a tree is settled, and how it goes on from there.
#pragma once

#include <cmath>

namespace sunfleck::transport {

// The power a tree gives back, from one look at the light to the next, and where it is going.
class TreeSeries {
 public:
  void add(double power) {
    const double change = power - power_;
    factor_ = 0.0;
    if (count_ >= 2 && std::abs(change) < kSteadiest * std::abs(change_)) {
      const double ratio = change / change_;
      factor_ = ratio / (1.0 - ratio);
    }
    moved_ = std::abs(power + factor_ * change - predicted_);
    predicted_ = power + factor_ * change;
    change_ = change;
    power_ = power;
    ++count_;
  }
  bool is_settled(double convergence) const {
    if (count_ == 0 || (count_ < 3 && power_ > 0.0)) return false;
    if (!(power_ > 0.0)) return true;
    const double rest = std::abs(predicted_ - power_);
    return moved_ <= kChangePerError * convergence * power_ && rest <= kLongestRest * convergence * power_;
  }
  // What is still to come over the last change.
  float rest_per_change() const { return static_cast<float>(factor_); }

 private:
  static constexpr double kChangePerError = 2.0;  // the prediction moves by more than it is off
  static constexpr double kSteadiest = 0.9;       // changes that shrink more slowly tell no end
  static constexpr double kLongestRest = 15.0;    // of the tolerance: the rest has not quite the last's shape
  int count_ = 0;
  double power_ = 0, change_ = 0, predicted_ = 0, moved_ = 0, factor_ = 0;
};

}  // namespace sunfleck::transport
