// Walks a turtle along a string: draws it, or answers the queries in it.
#pragma once

#include <vector>

#include "sim/lsystem/compiled.h"
#include "sim/lsystem/rule_runner.h"
#include "sim/lsystem/turtle.h"

namespace sunfleck::lsystem {

class Interpreter {
 public:
  Interpreter(const Grammar::Compiled& grammar, StartFrame frame, const DeriveOptions& options,
              const RunControl& control);

  Drawing draw(const ModuleString& string);
  // Writes the turtle's place into ?P ?H ?U ?L and what the environment says into ?E.
  void answer_queries(ModuleString& string);

 private:
  // `mutable_string` is `string` itself while queries are answered, else null.
  void walk(const ModuleString& string, ModuleString* mutable_string);
  void visit(std::uint16_t symbol, std::span<const double> parameters, int depth);
  bool interpret_by_rule(std::uint16_t symbol, std::span<const double> parameters, int depth);
  void apply(const Symbol& symbol, std::span<const double> parameters);
  bool turn(TurtleOp op, double angle_deg);
  void change_state(TurtleOp op, std::span<const double> parameters);
  void step_forward(TurtleOp op, double length_m);
  void draw_segment(const Vec3& from_m);
  void pop(const char* what);
  void place_organ(const std::string& name, std::span<const double> parameters);
  void change_polygon(TurtleOp op);
  void answer(TurtleOp op, std::span<double> parameters);
  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const;

  const Grammar::Compiled& grammar_;
  StartFrame frame_;
  const DeriveOptions& options_;
  const RunControl& control_;
  RuleRunner runner_;
  Turtle turtle_;
  std::vector<Turtle> branches_;
  std::vector<Polygon> open_polygons_;
  std::vector<ModuleString> scratch_;  // results of interpretation rules, by depth
  const System* system_ = nullptr;
  ModuleRandom* random_ = nullptr;
  bool surface_next_ = false;
  std::size_t current_ = 0;
  std::size_t applied_ = 0;  // interpretation rules, to the current module
  Drawing drawing_;
};

}  // namespace sunfleck::lsystem
