// What a person at a terminal sees and presses: progress on stderr, Ctrl-C, errors as one line.
#pragma once

#include <functional>
#include <string>

#include "sim/base/run_control.h"

namespace sunfleck {

// Progress for the terminal: one rewritten line (at most 4 a second) where stderr is a terminal, else a line
// per stage and quarter. Stops on SIGINT and SIGTERM. One per process.
RunControl terminal_control();
void finish_progress();  // ends the progress line

// Runs a command and turns what it throws into one line on stderr and an exit code: 0 done, 2 the user can
// mend it, 130 stopped, 1 anything else.
int run_and_report(const std::function<void()>& command);

// 1234567 -> "1,234,567"; 0.0123 -> "12.3 ms".
std::string grouped(std::uint64_t number);
std::string seconds_text(double seconds);

}  // namespace sunfleck
