// 95 % intervals of figures computed from independent random probes, by the studentised bootstrap: the figure
// and its standard error are computed again from probes drawn with repetition, and the spread of
// (figure - original) / standard error takes the place of Student's t. Unlike a symmetric interval it follows
// skewed errors (a few leaves far off), as errors of light are. Efron and Tibshirani 1993, chapter 12.5.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace sunfleck {

struct Interval {
  double value = 0, low = 0, high = 0;
};

struct Figure {
  double value = 0, standard_error = 0;
};

// Which probes make up each repetition; drawn once and used for every figure.
class Resamples {
 public:
  Resamples(std::size_t probes, std::uint64_t seed);

  std::size_t probes() const { return probes_; }
  // `figure` of a choice of probes, given as indexes below probes().
  Interval interval(const std::function<Figure(std::span<const std::uint32_t>)>& figure) const;

 private:
  static constexpr std::size_t kRepeats = 999;
  std::span<const std::uint32_t> choice(std::size_t repeat) const {
    return {chosen_.data() + repeat * probes_, probes_};
  }

  std::size_t probes_;
  std::vector<std::uint32_t> chosen_;  // [repeat][probe]
};

}  // namespace sunfleck
