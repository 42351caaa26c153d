#include "lighting/bench/machine.h"

#include <chrono>
#include <ctime>
#include <fstream>
#include <sstream>
#include <thread>

#include "lighting/bench/commit.h"
#include "sim/base/version.h"

namespace sunfleck {
namespace {

// Value of the first line "name<blanks>: value" of a file of the system.
std::string system_value(const char* file, const std::string& name) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind(name, 0) != 0) continue;
    const std::size_t colon = line.find(':');
    const std::size_t start = line.find_first_not_of(" \t", colon + 1);
    return start == std::string::npos ? "" : line.substr(start);
  }
  return "";
}

std::string today_utc() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", &parts);
  return text;
}

}  // namespace

MachineFacts machine_facts() {
  const std::string processor = system_value("/proc/cpuinfo", "model name");
  return {processor.empty() ? "unknown" : processor,
          static_cast<int>(std::thread::hardware_concurrency()),
          kCommit,
          "GCC " + std::string(__VERSION__),
          kBuildType,
          today_utc()};
}

std::uint64_t peak_memory_bytes() {
  std::istringstream in(system_value("/proc/self/status", "VmHWM"));
  std::uint64_t kib = 0;
  in >> kib;
  return kib * 1024;
}

void reset_peak_memory() {
  std::ofstream out("/proc/self/clear_refs");
  out << 5;  // see proc(5): resets VmHWM
}

}  // namespace sunfleck
