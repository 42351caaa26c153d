// The one error type of Sunfleck's edges: what is wrong, where, and what would be right.
#pragma once

#include <stdexcept>
#include <string>

namespace sunfleck {

enum class ErrorKind {
  kInvalidInput,   // the user can mend it: a file, a key, a request field
  kNotFound,       // a file or name that does not exist
  kLimitExceeded,  // the work asked for is larger than a stated limit
  kCancelled,      // somebody asked to stop
  kInputOutput     // reading or writing failed although the request was right
};

// Thrown at the edges (files, options, requests) and caught once, in main() or in an RPC handler.
// `where` is "file:line", "file: key.path" or a request's field path; `remedy` says what would be right.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, std::string where, std::string problem, std::string remedy = {});

  ErrorKind kind() const { return kind_; }
  const std::string& where() const { return where_; }
  const std::string& problem() const { return problem_; }
  const std::string& remedy() const { return remedy_; }

 private:
  ErrorKind kind_;
  std::string where_, problem_, remedy_;
};

// Shorthands for the two commonest kinds.
[[noreturn]] void throw_invalid(std::string where, std::string problem, std::string remedy);
[[noreturn]] void throw_cancelled();

}  // namespace sunfleck
