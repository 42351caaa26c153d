// The figures the papers print about themselves, measured again on scenes of our own and printed beside
// theirs: [SPP] Tables 1 and 2 (closed forms in a slab), 3 (trees) and 4 (times), and those of [Boulanger08]
// section 7. The papers' trees, and much of how they measured, are not published: every table says what scene
// stands for theirs and what was left unsaid, and a figure that differs is no proof that theirs is wrong.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lighting/bench/machine.h"
#include "sim/base/run_control.h"

namespace sunfleck {

struct PublishedPlan {
  bool quick = false;  // small scenes and few rays, some seconds: to see that it works, not to quote
  int threads = 1;     // 0: all cores
  int repeats = 5;     // times are medians of these
  std::uint64_t seed = 1;
};

struct PublishedRow {
  std::string scene;   // ours
  std::string line;    // what else is fixed in it: rows of one scene and line are printed on one line
  std::string column;  // what was measured
  std::string unit;    // "%", "ms", "s"
  double ours = 0;
  std::optional<double> published;  // in the same unit; none where the paper has no such figure
};

struct PublishedTable {
  std::string name;      // "table 1" .. "table 4", "boulanger"
  std::string title;     // what it is about
  std::string how;       // how ours was measured
  std::string unstated;  // what the paper leaves open
  std::vector<PublishedRow> rows;
};

// All five tables. Under two minutes on one core (some seconds if quick). Throws Error(kCancelled), and
// ContractViolation where an answer is wrong that was to be timed.
std::vector<PublishedTable> run_published_tables(const PublishedPlan& plan, const RunControl& control);

// Single tables.
PublishedTable slab_albedo_table(const PublishedPlan& plan, const RunControl& control);     // [SPP] Table 1
PublishedTable slab_thickness_table(const PublishedPlan& plan, const RunControl& control);  // [SPP] Table 2
PublishedTable tree_table(const PublishedPlan& plan, const RunControl& control);            // [SPP] Table 3
PublishedTable timing_table(const PublishedPlan& plan, const RunControl& control);          // [SPP] Table 4
PublishedTable boulanger_table(const PublishedPlan& plan, const RunControl& control);

// For people: "ours (theirs)", a line per scene and line.
std::string published_text(const std::vector<PublishedTable>& tables);
// One line per row, with what is unstated, threads, commit, machine and date on every line.
std::string published_csv(const std::vector<PublishedTable>& tables, int threads,
                          const MachineFacts& machine);

}  // namespace sunfleck
