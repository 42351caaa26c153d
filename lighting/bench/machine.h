// Where and with what a benchmark was run: a figure without it cannot be compared.
#pragma once

#include <cstdint>
#include <string>

namespace sunfleck {

struct MachineFacts {
  std::string processor;  // as the system names it
  int threads = 0;        // hardware threads this process may use
  std::string commit;  // of the sources this program was built from; "+" after it: changed since; "unknown"
  std::string compiler, build_type, date_utc;  // YYYY-MM-DD
};
MachineFacts machine_facts();

// Peak resident memory of the process since the last reset_peak_memory(), bytes; 0 where the system does not
// tell.
std::uint64_t peak_memory_bytes();
void reset_peak_memory();

}  // namespace sunfleck
