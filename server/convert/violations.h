// Everything that is wrong with a request, collected before it is refused: field path and what would be
// right.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace sunfleck {

struct Violation {
  std::string field, description;
};

// The checks return true if the value is good, else they note a violation and return false.
class Violations {
 public:
  void add(std::string field, std::string description);
  bool number(const std::string& field, double value, double lo, double hi);  // NaN is never good
  bool above(const std::string& field, double value, double lo, double hi);   // (lo, hi]
  bool integer(const std::string& field, std::int64_t value, std::int64_t lo, std::int64_t hi);
  bool count(const std::string& field, std::size_t value, std::size_t lo, std::size_t hi);  // of a list
  // 1 .. longest bytes without control characters or slashes.
  bool text(const std::string& field, std::string_view value, std::size_t longest);

  bool empty() const { return all_.empty(); }
  const std::vector<Violation>& all() const { return all_; }
  void refuse_if_any() const;  // throws InvalidRequest

 private:
  std::vector<Violation> all_;
};

class InvalidRequest : public std::runtime_error {
 public:
  explicit InvalidRequest(std::vector<Violation> violations);
  const std::vector<Violation>& violations() const { return violations_; }

 private:
  std::vector<Violation> violations_;
};

// "field[3]"
std::string at(const std::string& field, std::size_t index);
// At most 60 bytes of a text of the client, control characters replaced, for use in an answer.
std::string clipped(std::string_view text);

}  // namespace sunfleck
