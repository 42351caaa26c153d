#include "sim/lsystem/lsystem.h"

#include <fstream>
#include <sstream>

#include "sim/base/contract.h"
#include "sim/base/error.h"
#include "sim/lsystem/compiled.h"
#include "sim/lsystem/derive.h"
#include "sim/lsystem/grammar_parser.h"
#include "sim/lsystem/interpret.h"

namespace sunfleck::lsystem {

Grammar::Grammar(std::unique_ptr<Compiled> compiled) : compiled_(std::move(compiled)) {}
Grammar::Grammar(Grammar&&) noexcept = default;
Grammar& Grammar::operator=(Grammar&&) noexcept = default;
Grammar::~Grammar() = default;

Grammar Grammar::parse(std::string_view text, std::string source_name,
                       const std::map<std::string, double>& constants) {
  auto compiled = std::make_unique<Compiled>();
  compiled->source = std::move(source_name);
  GrammarParser(*compiled, constants).run(text);
  return Grammar(std::move(compiled));
}

Grammar Grammar::load(const std::filesystem::path& path, const std::map<std::string, double>& constants) {
  if (std::error_code failed; std::filesystem::is_directory(path, failed))
    throw Error(ErrorKind::kNotFound, path.string(), "is a folder, not a file", "a grammar file (*.lsys)");
  std::ifstream file(path);
  if (!file || !std::filesystem::is_regular_file(path))
    throw Error(ErrorKind::kNotFound, path.string(), "cannot be read", "a grammar file (*.lsys)");
  std::ostringstream text;
  text << file.rdbuf();
  return parse(text.str(), path.string(), constants);
}

ModuleString Grammar::axiom() const { return compiled_->axiom; }

ModuleString Grammar::derive(const DeriveOptions& options, const RunControl& control) const {
  const int steps = options.steps < 0 ? compiled_->steps : options.steps;
  ModuleString string = decompose_axiom(*compiled_, options);
  for (int step = 0; step < steps; ++step) {
    string = derive_step(string, step, options, control);
    control.report("derive", (step + 1.0) / steps);
  }
  return string;
}

ModuleString Grammar::derive_step(const ModuleString& string, int step, const DeriveOptions& options,
                                  const RunControl& control) const {
  SUNFLECK_EXPECTS(step >= 0);
  ModuleString next;
  if (compiled_->has_queries) {
    ModuleString answered = string;
    Interpreter(*compiled_, options.frame, options, control).answer_queries(answered);
    next = rewrite(*compiled_, answered, step, options, control);
  } else {
    next = rewrite(*compiled_, string, step, options, control);
  }
  return compiled_->has_cut ? without_cut_branches(*compiled_, next) : next;
}

ModuleString Grammar::advance(const ModuleString& string, double duration, const DeriveOptions& options,
                              const RunControl& control) const {
  if (!(duration > 0 && duration < 1e300))
    throw_invalid("advance", "a duration of " + std::to_string(duration), "a positive number");
  return let_time_pass(*compiled_, string, duration, options, control);
}

Drawing Grammar::interpret(const ModuleString& string, StartFrame frame, const DeriveOptions& options,
                           const RunControl& control) const {
  return Interpreter(*compiled_, frame, options, control).draw(string);
}

std::string Grammar::print(const ModuleString& string) const { return print_modules(*compiled_, string); }

const std::vector<std::string>& Grammar::symbol_names() const { return compiled_->symbols.names(); }

int Grammar::stated_steps() const { return compiled_->steps; }

}  // namespace sunfleck::lsystem
