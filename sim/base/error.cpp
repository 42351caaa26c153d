#include "sim/base/error.h"

namespace sunfleck {
namespace {

std::string sentence(const std::string& where, const std::string& problem, const std::string& remedy) {
  std::string text = where.empty() ? problem : where + ": " + problem;
  if (!remedy.empty()) text += " (" + remedy + ")";
  return text;
}

}  // namespace

Error::Error(ErrorKind kind, std::string where, std::string problem, std::string remedy)
    : std::runtime_error(sentence(where, problem, remedy)),
      kind_(kind),
      where_(std::move(where)),
      problem_(std::move(problem)),
      remedy_(std::move(remedy)) {}

void throw_invalid(std::string where, std::string problem, std::string remedy) {
  throw Error(ErrorKind::kInvalidInput, std::move(where), std::move(problem), std::move(remedy));
}

void throw_cancelled() { throw Error(ErrorKind::kCancelled, "", "stopped on request"); }

}  // namespace sunfleck
