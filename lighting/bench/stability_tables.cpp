// Printing what stability.h measures.
#include <cmath>
#include <cstdio>
#include <map>

#include "lighting/bench/stability.h"

namespace sunfleck {

namespace {

struct MethodCount {
  std::size_t scenes = 0, safe = 0, refused = 0, compared = 0, as_expected = 0, not_finite = 0, negative = 0;
};

std::string line(const char* format, auto... values) {
  char text[400];
  std::snprintf(text, sizeof text, format, values...);
  return std::string(text) + "\n";
}

std::string what_failed(const SceneStability& row) {
  if (!row.violation.empty()) return "broke an invariant: " + row.violation;
  if (row.should_be_refused && row.refused.empty()) return "was not refused";
  if (!row.should_be_refused && !row.refused.empty()) return "was refused: " + row.refused;
  if (row.not_finite + row.negative > 0)
    return std::to_string(row.not_finite) + " not finite, " + std::to_string(row.negative) + " negative";
  char text[200];
  std::snprintf(text, sizeof text, "%s %.6g, expected %.6g: off by %.2g, allowed %.2g", row.figure.c_str(),
                row.found, row.expected, row.difference, row.allowed);
  return text;
}

std::string method_table(const std::vector<SceneStability>& scenes) {
  std::map<std::string, MethodCount> counts;
  std::vector<std::string> order;
  for (const SceneStability& row : scenes) {
    if (!counts.contains(row.method)) order.push_back(row.method);
    MethodCount& count = counts[row.method];
    ++count.scenes;
    count.safe += row.safe();
    count.refused += row.safe() && row.should_be_refused;
    count.compared += row.has_expectation;
    count.as_expected += row.has_expectation && row.as_expected();
    count.not_finite += row.not_finite;
    count.negative += row.negative;
  }
  std::string text = line("%-18s %7s %7s %8s %11s %9s %9s %12s", "method", "scenes", "safe", "refused",
                          "not finite", "negative", "compared", "as expected");
  for (const std::string& method : order) {
    const MethodCount& c = counts[method];
    text += line("%-18s %7zu %7zu %8zu %11zu %9zu %9zu %12zu", method.c_str(), c.scenes, c.safe, c.refused,
                 c.not_finite, c.negative, c.compared, c.as_expected);
  }
  return text;
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c == '\n' ? ' ' : c;
  }
  return result + "\"";
}

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

}  // namespace

std::string stability_table(const std::vector<SceneStability>& scenes,
                            const std::vector<StabilityRow>& forms) {
  std::string text = method_table(scenes);
  for (const SceneStability& row : scenes)
    if (!row.as_expected())
      text += line("%s, %s: %s", row.scene.c_str(), row.method.c_str(), what_failed(row).c_str());
  text += line("\n%-32s %-9s %8s %11s %12s  %s", "closed form", "precision", "points", "not finite",
               "worst error", "at");
  for (const StabilityRow& row : forms)
    text += line("%-32s %-9s %8zu %11zu %12.2g  %s", row.form.c_str(), row.precision.c_str(), row.points,
                 row.not_finite, row.worst_relative_error, row.worst_at.c_str());
  return text;
}

std::string stability_csv(const std::vector<SceneStability>& scenes) {
  std::string text =
      "scene,method,elements,should_be_refused,refused,not_finite,negative,violation,figure,found,expected,"
      "difference,allowed,as_expected\n";
  for (const SceneStability& r : scenes)
    text += quoted(r.scene) + "," + r.method + "," + std::to_string(r.elements) + "," +
            std::to_string(r.should_be_refused) + "," + quoted(r.refused) + "," +
            std::to_string(r.not_finite) + "," + std::to_string(r.negative) + "," + quoted(r.violation) +
            "," + quoted(r.figure) + "," + number(r.found) + "," + number(r.expected) + "," +
            number(r.difference) + "," + number(r.allowed) + "," + std::to_string(r.as_expected()) + "\n";
  return text;
}

std::string stability_csv(const std::vector<StabilityRow>& forms) {
  std::string text = "form,precision,points,not_finite,worst_relative_error,worst_at\n";
  for (const StabilityRow& r : forms)
    text += quoted(r.form) + "," + r.precision + "," + std::to_string(r.points) + "," +
            std::to_string(r.not_finite) + "," + number(r.worst_relative_error) + "," + quoted(r.worst_at) +
            "\n";
  return text;
}

}  // namespace sunfleck
