// A whole grammar file -> Grammar::Compiled. The language is described in configs/grammars/README.md.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "sim/lsystem/compiled.h"
#include "sim/lsystem/rule_parser.h"
#include "sim/lsystem/source_text.h"

namespace sunfleck::lsystem {

class GrammarParser {
 public:
  // `compiled` is filled by run(); `overrides` replace #define values and must all name one.
  GrammarParser(Grammar::Compiled& compiled, const std::map<std::string, double>& overrides);
  void run(std::string_view text);

 private:
  struct PendingRule {
    Statement statement;
    RuleKind kind;
    std::size_t system, group;
  };

  Cursor cursor(const Statement& statement, std::size_t position = 0) const;
  void read_statement(const Statement& statement);
  void define(const Statement& statement);
  bool read_section(const std::string& keyword, Cursor& rest);
  bool read_number(const std::string& keyword, Cursor& rest);
  bool read_symbols(const std::string& keyword, Cursor& rest);
  void read_tropism(Cursor& rest);
  void declare_symbols(Cursor& rest, bool timed);
  std::uint16_t known_symbol(Cursor& rest);
  void mark_symbols(Cursor& rest, TurtleOp op);
  void read_context_symbols(Cursor& rest, bool listed_is_ignored);
  void begin_system(Cursor& rest);
  void begin_group(Cursor& rest);
  void read_schedule(Cursor& rest);
  double number(Cursor& rest);
  void compile_axiom();
  void compile_rules();
  void check_overrides() const;
  void check_timed(const Rule& rule, const PendingRule& pending) const;

  Grammar::Compiled& out_;
  const std::map<std::string, double>& overrides_;
  SystemNames system_names_{"main"};
  std::vector<PendingRule> pending_;
  std::vector<Statement> schedules_;
  Statement axiom_;
  std::set<std::string> defined_;
  std::uint8_t unlisted_is_ignored_ = 0;
  RuleKind kind_ = RuleKind::kProduction;
  std::size_t system_ = 0, group_ = 0;
};

}  // namespace sunfleck::lsystem
