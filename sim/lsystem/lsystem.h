// L-systems: a text grammar, compiled once, derived step by step, interpreted by a turtle. Grammar language:
// see configs/grammars/README.md; semantics follow cpfg and "The Algorithmic Beauty of Plants" (ABOP).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/run_control.h"
#include "sim/base/vec.h"

namespace sunfleck::lsystem {

// A derived string in compact form: modules with typed double parameters (values, never shared).
class ModuleString {
 public:
  std::size_t size() const { return symbol_.size(); }
  std::uint16_t symbol(std::size_t i) const { return symbol_[i]; }  // index into Grammar::symbol_names()
  std::span<const double> parameters(std::size_t i) const {
    return {parameters_.data() + first_[i], parameters_.data() + first_[i + 1]};
  }
  std::span<double> mutable_parameters(std::size_t i) {
    return {parameters_.data() + first_[i], parameters_.data() + first_[i + 1]};
  }
  void clear();
  void append(std::uint16_t symbol, std::span<const double> parameters) {
    symbol_.push_back(symbol);
    for (const double parameter : parameters) parameters_.push_back(parameter);
    first_.push_back(static_cast<std::uint32_t>(parameters_.size()));
  }
  // Appends a module and returns its parameters (zero) for the caller to fill, valid until the next append.
  std::span<double> append(std::uint16_t symbol, std::size_t parameter_count) {
    symbol_.push_back(symbol);
    parameters_.resize(parameters_.size() + parameter_count);
    first_.push_back(static_cast<std::uint32_t>(parameters_.size()));
    return {parameters_.data() + parameters_.size() - parameter_count, parameter_count};
  }
  void reserve(std::size_t modules, std::size_t parameters);
  ModuleString reversed() const;
  bool operator==(const ModuleString&) const = default;

 private:
  std::vector<std::uint16_t> symbol_;
  std::vector<std::uint32_t> first_{0};
  std::vector<double> parameters_;
};

// Answers an open L-system's ?E(...) module: gets its parameters and the turtle's place, changes the
// parameters.
struct TurtleState {
  Vec3 position_m{0}, heading{0, 0, 1}, left{-1, 0, 0}, up{0, -1, 0};
  double width_m = 0;
};
using Environment = std::function<void(const TurtleState& turtle, std::span<double> parameters)>;

// The frame a drawing starts in. kAbop (H = +y, L = -x, U = +z) is that of the published figures; kTree (H =
// +z, L = -x, U = -y) stands trees upright in Sunfleck's frame. Same turtle, one turned by 90 degrees about
// x; tropism vectors, queries and what "level" means ($) are in the frame the drawing is made in.
enum class StartFrame { kAbop, kTree };

struct DeriveOptions {
  std::uint64_t seed = 1;
  int steps = -1;                        // -1: the number the grammar states
  std::size_t max_modules = 20'000'000;  // a longer string is refused with Error(kLimitExceeded)
  Environment environment;               // needed by grammars with ?E
  StartFrame frame = StartFrame::kTree;  // where the turtle that answers ?P ?H ?U ?L ?E starts
};

// One drawn internode. `parent` is the index of the segment below, -1 at the root of the string.
struct Segment {
  Vec3 from_m, to_m;
  double width_from_m, width_to_m;  // diameters, as set by ! (the unit is whatever the grammar means)
  std::int32_t parent;
  std::int32_t colour;
};

// An organ placed by ~ or by a module declared as an organ: where, how it is turned, its parameters.
struct Organ {
  std::string symbol;
  TurtleState turtle;
  std::vector<double> parameters;
  std::int32_t segment;  // the one it stands on, -1 if none
};

struct Polygon {
  std::vector<Vec3> corners_m;
  std::int32_t colour;
};

struct Drawing {
  std::vector<Segment> segments;
  std::vector<Organ> organs;
  std::vector<Polygon> polygons;
  TurtleState end;
  Box bounds;  // of all turtle positions reached by drawing
  double total_length_m = 0;
  int max_bracket_depth = 0;
};

class Grammar {
 public:
  // Throws Error(kInvalidInput) with "file:line" for what cannot be understood: unknown construct, undeclared
  // symbol, unbalanced brackets, wrong number of parameters. `constants` replace the values of `#define`s.
  static Grammar parse(std::string_view text, std::string source_name,
                       const std::map<std::string, double>& constants = {});
  static Grammar load(const std::filesystem::path& path, const std::map<std::string, double>& constants = {});

  ModuleString axiom() const;
  // Throws Error naming rule, line and module for division by zero, a parameter that is not finite, a string
  // over the limit; Error(kCancelled) when stopped. Deterministic in (grammar, options).
  ModuleString derive(const DeriveOptions& options, const RunControl& control = {}) const;
  // One step further; `step` numbers it for stochastic choice.
  ModuleString derive_step(const ModuleString& string, int step, const DeriveOptions& options,
                           const RunControl& control = {}) const;
  // Timed L-systems: advance ages by `duration` (any positive number). Stochastic choices repeat in every
  // call with the same options.seed.
  ModuleString advance(const ModuleString& string, double duration, const DeriveOptions& options,
                       const RunControl& control = {}) const;
  // Applies interpretation rules on the fly and draws; the derived string stays as it is.
  Drawing interpret(const ModuleString& string, StartFrame frame, const DeriveOptions& options = {},
                    const RunControl& control = {}) const;

  // Symbols concatenated, parameters by %.12g, no spaces (the form the conformance vectors hash).
  std::string print(const ModuleString& string) const;
  const std::vector<std::string>& symbol_names() const;
  int stated_steps() const;

  Grammar(Grammar&&) noexcept;
  Grammar& operator=(Grammar&&) noexcept;
  ~Grammar();

  struct Compiled;  // the parsed tables (sim/lsystem/compiled.h)

 private:
  explicit Grammar(std::unique_ptr<Compiled> compiled);
  std::unique_ptr<Compiled> compiled_;
};

}  // namespace sunfleck::lsystem
