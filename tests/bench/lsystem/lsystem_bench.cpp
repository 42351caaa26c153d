// Speed of derivation: parametric modules written per second on one core. The string is checked against its
// closed form before the clock starts.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <iostream>

#include "sim/lsystem/lsystem.h"

namespace sunfleck::lsystem {
namespace {

void demand(bool right, const char* what) {
  if (right) return;
  std::cerr << "wrong answer: " << what << "\n";
  std::exit(1);
}

std::size_t modules_of(const Grammar& grammar, int steps) {
  DeriveOptions options;
  options.steps = steps;
  return grammar.derive(options).size();
}

// Times the last step; the counter is modules in its result per second.
void time_last_step(benchmark::State& state, const Grammar& grammar, int steps) {
  DeriveOptions options;
  options.steps = steps - 1;
  const ModuleString before = grammar.derive(options);
  std::size_t modules = 0;
  for (auto _ : state) {
    const ModuleString after = grammar.derive_step(before, steps - 1, options);
    modules += after.size();
    benchmark::DoNotOptimize(after.size());
  }
  state.counters["modules/s"] = benchmark::Counter(static_cast<double>(modules), benchmark::Counter::kIsRate);
}

// Honda's monopodial tree (ABOP figure 2.6): every apex makes one internode and two apices.
void honda(benchmark::State& state) {
  const Grammar grammar = Grammar::parse(R"(
symbols: A(2) B(2) C(2)
axiom: A(1,10)
A(l,w) --> !(w)F(l)[&(45)B(l*0.6,w*0.707)]/(137.5)A(l*0.9,w*0.707)
B(l,w) --> !(w)F(l)[-(45)$C(l*0.6,w*0.707)]C(l*0.9,w*0.707)
C(l,w) --> !(w)F(l)[+(45)$B(l*0.6,w*0.707)]B(l*0.9,w*0.707)
)",
                                         "honda");
  DeriveOptions options;
  options.steps = 10;
  demand(grammar.interpret(grammar.derive(options), StartFrame::kAbop).segments.size() == 1023, "2^10-1 F");
  time_last_step(state, grammar, 17);
}
BENCHMARK(honda)->Unit(benchmark::kMillisecond);

// Every module rewritten under a condition: Row of trees (ABOP figure 1.39).
void row_of_trees(benchmark::State& state) {
  const Grammar grammar = Grammar::parse(R"(
axiom: -(90)F(1)
F(x) : x > 1e-9 --> F(x*0.3)+(86)F(x*0.458257569495584)-(172)F(x*0.458257569495584)+(86)F(x*0.7)
)",
                                         "row");
  demand(modules_of(grammar, 5) == 1 + 1024 + 1023, "4^5 F with a turn before each");
  time_last_step(state, grammar, 10);
}
BENCHMARK(row_of_trees)->Unit(benchmark::kMillisecond);

// Two-module left context on every module.
void context(benchmark::State& state) {
  std::string text = "symbols: I(1)\naxiom: ";
  for (int i = 0; i < 20000; ++i) text += "I(1)";
  const Grammar grammar = Grammar::parse(text + "\nI(j)I(k) < I(i) --> I(min(j+k, 9))\n", "context");
  DeriveOptions options;
  options.steps = 21;
  demand(grammar.print(grammar.derive(options)).starts_with("I(1)I(1)I(2)I(3)I(5)I(8)I(9)"), "Fibonacci");
  time_last_step(state, grammar, 5);
}
BENCHMARK(context)->Unit(benchmark::kMillisecond);

// Weighted choice with a random number per module.
void stochastic(benchmark::State& state) {
  const Grammar grammar = Grammar::parse(R"(
axiom: F(1)
F(x) --> F(x)[+(20)F(x/2)]F(x)[-(20)F(x/2)]F(x) : 0.33
F(x) --> F(x)[+(20)F(x/2)]F(x) : 0.33
F(x) --> F(x)[-(20)F(x/2)]F(x) : 0.34
)",
                                         "stochastic");
  const double count = static_cast<double>(modules_of(grammar, 8));
  demand(count > std::pow(3, 8) && count < std::pow(11, 8), "between the smallest and the largest tree");
  time_last_step(state, grammar, 10);
}
BENCHMARK(stochastic)->Unit(benchmark::kMillisecond);

// Drawing: modules the turtle walks over per second.
void interpret(benchmark::State& state) {
  const Grammar grammar =
      Grammar::parse("axiom: F(1)\nF(x) --> F(x/2)[+(25)F(x/2)]F(x/2)[-(25)/(60)F(x/2)]F(x/2)\n", "draw");
  DeriveOptions options;
  options.steps = 7;
  const ModuleString string = grammar.derive(options);
  demand(grammar.interpret(string, StartFrame::kTree).segments.size() == 78125, "5^7 segments");
  std::size_t modules = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(grammar.interpret(string, StartFrame::kTree).segments.size());
    modules += string.size();
  }
  state.counters["modules/s"] = benchmark::Counter(static_cast<double>(modules), benchmark::Counter::kIsRate);
}
BENCHMARK(interpret)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sunfleck::lsystem
