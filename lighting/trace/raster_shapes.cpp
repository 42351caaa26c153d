#include "lighting/trace/raster_shapes.h"

namespace sunfleck::trace {

// Roots of a t^2 + 2 b t + c = 0 by the form that does not cancel; every line has two, or none.
std::optional<SolidLine::Chord> SolidLine::roots() const {
  const double discriminant = b_ * b_ - a_ * c_;
  if (!(discriminant >= 0.0)) return std::nullopt;
  const double q = -(b_ + std::copysign(std::sqrt(discriminant), b_));
  if (q == 0.0) return a_ == 0.0 ? std::nullopt : std::optional(Chord{0.0, 0.0});
  const double other = c_ / q, one = a_ != 0.0 ? q / a_ : other;
  return Chord{std::min(one, other), std::max(one, other)};
}

std::optional<double> SolidLine::nearest() const {
  const auto both = roots();
  if (!both) return std::nullopt;
  if (on_side(both->leave)) return both->leave;
  if (on_side(both->enter)) return both->enter;
  return std::nullopt;
}

std::optional<SolidLine::Chord> SolidLine::chord() const {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Chord chord{-kFar, kFar};
  if (solid_.run2 > 0.0) {
    const auto side = roots();
    if (!side) return std::nullopt;
    chord = *side;
  } else if (c_ > 0.0) {
    return std::nullopt;
  }
  if (solid_.rise != 0.0) {
    const double x = (solid_.lowest - height_) / solid_.rise, y = (solid_.highest - height_) / solid_.rise;
    chord.enter = std::max(chord.enter, std::min(x, y));
    chord.leave = std::min(chord.leave, std::max(x, y));
  } else if (!(height_ >= solid_.lowest && height_ <= solid_.highest)) {
    return std::nullopt;
  }
  if (!(chord.enter < chord.leave)) return std::nullopt;
  return chord;
}

FigurePoint point_of(const RasterRecord& r, double x, double y) {
  double a = 2.0 * x - 1.0, b = 2.0 * y - 1.0;
  if (r.figure == Figure::kCone || r.figure == Figure::kShoot) return {};
  if (r.figure == Figure::kDisc) {
    const double radius = std::sqrt(x), turn = 2.0 * kPi * y;
    a = radius * std::cos(turn), b = radius * std::sin(turn);
  } else if (r.figure == Figure::kTriangle) {
    const double root = std::sqrt(x);
    a = root * (1.0 - y) - 1.0 / 3.0, b = root * y - 1.0 / 3.0;
  }
  return {a * r.a_du + b * r.b_du, a * r.a_dv + b * r.b_dv, a * r.s_a + b * r.s_b};
}

}  // namespace sunfleck::trace
