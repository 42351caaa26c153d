#include "sim/lsystem/interpret.h"

#include <algorithm>
#include <cmath>

#include "sim/base/error.h"
#include "sim/lsystem/derive.h"

namespace sunfleck::lsystem {
namespace {

constexpr std::size_t kModulesPerLook = 8192;
constexpr std::uint64_t kInterpretationSeed = ~std::uint64_t{1};

double first_or(std::span<const double> parameters, double otherwise) {
  return parameters.empty() ? otherwise : parameters[0];
}

std::int32_t colour_or(std::span<const double> parameters, double otherwise) {
  return static_cast<std::int32_t>(std::clamp(first_or(parameters, otherwise), -1e9, 1e9));
}

}  // namespace

Interpreter::Interpreter(const Grammar::Compiled& grammar, StartFrame frame, const DeriveOptions& options,
                         const RunControl& control)
    : grammar_(grammar),
      frame_(frame),
      options_(options),
      control_(control),
      runner_(grammar, options.max_modules),
      turtle_(start_turtle(frame, grammar.width_m, grammar.elasticity)),
      scratch_(static_cast<std::size_t>(grammar.interpretation_depth) + 1) {}

Drawing Interpreter::draw(const ModuleString& string) {
  walk(string, nullptr);
  if (!open_polygons_.empty()) fail("a polygon that is never closed", "a '}' for each '{'");
  drawing_.end = turtle_;
  return std::move(drawing_);
}

void Interpreter::answer_queries(ModuleString& string) { walk(string, &string); }

void Interpreter::walk(const ModuleString& string, ModuleString* mutable_string) {
  const std::vector<std::uint16_t> system_of = systems_along(grammar_, string);
  const std::uint64_t seed = mix_seed(options_.seed, kInterpretationSeed);
  const auto visit_all = [&] {
    for (std::size_t i = 0; i < string.size(); ++i) {
      if (i % kModulesPerLook == 0) control_.check();
      current_ = i;
      system_ = &grammar_.systems[system_of.empty() ? 0 : system_of[i]];
      ModuleRandom random(seed, i);
      random_ = &random;
      const TurtleOp op = grammar_.symbols.at(string.symbol(i)).op;
      if (mutable_string != nullptr && op >= TurtleOp::kQueryPosition)
        answer(op, mutable_string->mutable_parameters(i));
      else
        visit(string.symbol(i), string.parameters(i), 0);
    }
  };
  runner_.guarded(visit_all, [&] { return " while interpreting module " + std::to_string(current_); });
}

void Interpreter::visit(std::uint16_t symbol, std::span<const double> parameters, int depth) {
  const Symbol& what = grammar_.symbols.at(symbol);
  if (surface_next_) {
    surface_next_ = false;
    return place_organ(what.name, parameters);
  }
  if (system_->interpretation.has(symbol) && depth < grammar_.interpretation_depth &&
      interpret_by_rule(symbol, parameters, depth))
    return;
  if (what.op != TurtleOp::kNone) apply(what, parameters);
}

bool Interpreter::interpret_by_rule(std::uint16_t symbol, std::span<const double> parameters, int depth) {
  double slots[kMaxSlots];
  const Rule* rule = runner_.choose(system_->interpretation, symbol, parameters, slots, *random_,
                                    [](const Rule&) { return true; });
  if (rule == nullptr) return false;
  applied_ = depth == 0 ? 1 : applied_ + 1;
  if (applied_ % kModulesPerLook == 0) control_.check();
  if (applied_ > options_.max_modules)
    fail("interpretation of one module by more than " + std::to_string(options_.max_modules) + " rules",
         "a smaller `maximum depth:`");
  ModuleString& modules = scratch_[static_cast<std::size_t>(depth)];
  modules.clear();
  runner_.produce_plain(*rule, slots, *random_, modules);
  for (std::size_t i = 0; i < modules.size(); ++i) visit(modules.symbol(i), modules.parameters(i), depth + 1);
  return true;
}

void Interpreter::apply(const Symbol& symbol, std::span<const double> parameters) {
  if (turn(symbol.op, first_or(parameters, grammar_.angle_deg))) return;
  switch (symbol.op) {
    case TurtleOp::kDraw:
    case TurtleOp::kDrawNoVertex:
    case TurtleOp::kMove:
    case TurtleOp::kMoveNoVertex:
      return step_forward(symbol.op, first_or(parameters, grammar_.step_m));
    case TurtleOp::kPush:
      branches_.push_back(turtle_);
      drawing_.max_bracket_depth = std::max(drawing_.max_bracket_depth, static_cast<int>(branches_.size()));
      return;
    case TurtleOp::kPop:
      return pop("a ']' without '['");
    case TurtleOp::kOrgan:
      return place_organ(symbol.name, parameters);
    case TurtleOp::kPolygonBegin:
    case TurtleOp::kPolygonEnd:
    case TurtleOp::kPolygonVertex:
      return change_polygon(symbol.op);
    default:
      return change_state(symbol.op, parameters);
  }
}

bool Interpreter::turn(TurtleOp op, double angle_deg) {
  switch (op) {
    case TurtleOp::kTurnLeft:
      return turn_left(turtle_, angle_deg), true;
    case TurtleOp::kTurnRight:
      return turn_left(turtle_, -angle_deg), true;
    case TurtleOp::kPitchDown:
      return pitch_down(turtle_, angle_deg), true;
    case TurtleOp::kPitchUp:
      return pitch_down(turtle_, -angle_deg), true;
    case TurtleOp::kRollLeft:
      return roll_left(turtle_, angle_deg), true;
    case TurtleOp::kRollRight:
      return roll_left(turtle_, -angle_deg), true;
    case TurtleOp::kTurnAround:
      return turn_around(turtle_), true;
    case TurtleOp::kLevel:
      return level(turtle_, upright(frame_)), true;
    default:
      return false;
  }
}

void Interpreter::change_state(TurtleOp op, std::span<const double> parameters) {
  const double increment = grammar_.width_increment_m;
  switch (op) {
    case TurtleOp::kWidth:
      turtle_.width_m = first_or(parameters, std::max(0.0, turtle_.width_m - increment));
      return;
    case TurtleOp::kWidthUp:
      turtle_.width_m = first_or(parameters, turtle_.width_m + increment);
      return;
    case TurtleOp::kColourUp:
      turtle_.colour = colour_or(parameters, turtle_.colour + 1.0);
      return;
    case TurtleOp::kColourDown:
      turtle_.colour = colour_or(parameters, turtle_.colour - 1.0);
      return;
    case TurtleOp::kElasticity:
      turtle_.elasticity = first_or(parameters, grammar_.elasticity);
      return;
    case TurtleOp::kSurface:
      surface_next_ = true;
      return;
    default:
      return;  // cuts, queries and systems are of the derivation
  }
}

void Interpreter::step_forward(TurtleOp op, double length_m) {
  const Vec3 from_m = turtle_.position_m;
  turtle_.position_m += turtle_.heading * length_m;
  const bool vertex = op == TurtleOp::kDraw || op == TurtleOp::kMove;
  if (vertex && !open_polygons_.empty()) {
    open_polygons_.back().corners_m.push_back(turtle_.position_m);
  } else if (op == TurtleOp::kDraw || op == TurtleOp::kDrawNoVertex) {
    draw_segment(from_m);
  }
  if (op == TurtleOp::kDraw || op == TurtleOp::kDrawNoVertex) bend_towards(turtle_, grammar_.tropism);
}

void Interpreter::draw_segment(const Vec3& from_m) {
  if (drawing_.segments.size() >= options_.max_modules)
    fail("a drawing of more than " + std::to_string(options_.max_modules) + " segments", "a larger limit");
  drawing_.segments.push_back(
      {from_m, turtle_.position_m, turtle_.width_m, turtle_.width_m, turtle_.segment, turtle_.colour});
  turtle_.segment = static_cast<std::int32_t>(drawing_.segments.size()) - 1;
  drawing_.total_length_m += glm::length(turtle_.position_m - from_m);
  drawing_.bounds.include(from_m);
  drawing_.bounds.include(turtle_.position_m);
}

void Interpreter::pop(const char* what) {
  if (branches_.empty()) fail(what, "as many '[' as ']'");
  turtle_ = branches_.back();
  branches_.pop_back();
}

void Interpreter::place_organ(const std::string& name, std::span<const double> parameters) {
  drawing_.organs.push_back(
      {name, turtle_, std::vector<double>(parameters.begin(), parameters.end()), turtle_.segment});
}

void Interpreter::change_polygon(TurtleOp op) {
  if (op == TurtleOp::kPolygonBegin) {
    open_polygons_.push_back({{}, turtle_.colour});
    return;
  }
  if (open_polygons_.empty()) fail("a '.' or '}' outside a polygon", "a '{' before it");
  if (op == TurtleOp::kPolygonVertex) {
    open_polygons_.back().corners_m.push_back(turtle_.position_m);
    return;
  }
  drawing_.polygons.push_back(std::move(open_polygons_.back()));
  open_polygons_.pop_back();
}

void Interpreter::answer(TurtleOp op, std::span<double> parameters) {
  if (op == TurtleOp::kEnvironment) {
    if (!options_.environment)
      fail("?E asks the environment, but there is none", "a DeriveOptions::environment");
    options_.environment(turtle_, parameters);
    for (const double value : parameters)
      if (!std::isfinite(value)) fail("an answer of the environment that is not finite", "finite numbers");
    return;
  }
  const Vec3& vector = op == TurtleOp::kQueryPosition  ? turtle_.position_m
                       : op == TurtleOp::kQueryHeading ? turtle_.heading
                       : op == TurtleOp::kQueryUp      ? turtle_.up
                                                       : turtle_.left;
  for (std::size_t k = 0; k < std::min<std::size_t>(3, parameters.size()); ++k)
    parameters[k] = vector[static_cast<int>(k)];
}

void Interpreter::fail(const std::string& problem, const std::string& remedy) const {
  throw_invalid(grammar_.source, problem + ", at module " + std::to_string(current_) + " of the string",
                remedy);
}

}  // namespace sunfleck::lsystem
