// SHA-256 by OpenSSL, as lower-case hex.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace sunfleck {

class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;

  void add_bytes(const void* data, std::size_t size);
  void add(std::string_view text) { add_bytes(text.data(), text.size()); }
  // Numbers and plain structs without padding, in native (little-endian) order.
  template <class T>
  requires std::has_unique_object_representations_v<T> || std::is_floating_point_v<T>
  void add_value(const T& value) { add_bytes(&value, sizeof value); }
  std::string hex();  // ends the hash

 private:
  struct State;
  std::unique_ptr<State> state_;
};

std::string sha256_hex(std::string_view text);

}  // namespace sunfleck
