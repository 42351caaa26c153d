// Head comment in crc32c.h. Tables: "slicing by 8" after Kounavis and Berry 2005.
#include "server/convert/crc32c.h"

#include <nmmintrin.h>

#include <array>
#include <cstring>

namespace sunfleck {
namespace {

constexpr std::uint32_t kPolynomial = 0x82F63B78;  // reflected

constexpr std::uint32_t step_bit(std::uint32_t crc) { return (crc >> 1) ^ ((crc & 1) ? kPolynomial : 0); }

using Tables = std::array<std::array<std::uint32_t, 256>, 8>;

// table[k][b]: the CRC of byte b followed by k zero bytes.
constexpr Tables make_tables() {
  Tables table{};
  for (std::uint32_t b = 0; b < 256; ++b) {
    std::uint32_t crc = b;
    for (int bit = 0; bit < 8; ++bit) crc = step_bit(crc);
    table[0][b] = crc;
  }
  for (std::size_t k = 1; k < 8; ++k) {
    for (std::size_t b = 0; b < 256; ++b) {
      table[k][b] = (table[k - 1][b] >> 8) ^ table[0][table[k - 1][b] & 0xff];
    }
  }
  return table;
}

constexpr Tables kTables = make_tables();

std::uint64_t eight_bytes(const std::byte* data) {
  std::uint64_t word;
  std::memcpy(&word, data, sizeof word);
  return word;
}

__attribute__((target("sse4.2"))) std::uint32_t by_instruction(std::span<const std::byte> bytes) {
  std::uint64_t crc = 0xffffffff;
  std::size_t i = 0;
  for (; i + 8 <= bytes.size(); i += 8) crc = _mm_crc32_u64(crc, eight_bytes(&bytes[i]));
  auto tail = static_cast<std::uint32_t>(crc);
  for (; i < bytes.size(); ++i) tail = _mm_crc32_u8(tail, std::to_integer<std::uint8_t>(bytes[i]));
  return ~tail;
}

}  // namespace

std::uint32_t crc32c_plain(std::span<const std::byte> bytes) {
  std::uint32_t crc = 0xffffffff;
  for (const std::byte byte : bytes) {
    crc ^= std::to_integer<std::uint32_t>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = step_bit(crc);
  }
  return ~crc;
}

std::uint32_t crc32c_by_tables(std::span<const std::byte> bytes) {
  std::uint32_t crc = 0xffffffff;
  std::size_t i = 0;
  for (; i + 8 <= bytes.size(); i += 8) {
    const std::uint64_t word = eight_bytes(&bytes[i]) ^ crc;
    crc = 0;
    for (std::size_t k = 0; k < 8; ++k) crc ^= kTables[7 - k][(word >> (8 * k)) & 0xff];
  }
  for (; i < bytes.size(); ++i) {
    crc = (crc >> 8) ^ kTables[0][(crc ^ std::to_integer<std::uint32_t>(bytes[i])) & 0xff];
  }
  return ~crc;
}

std::uint32_t crc32c(std::span<const std::byte> bytes) {
  static const bool has_instruction = __builtin_cpu_supports("sse4.2") != 0;
  return has_instruction ? by_instruction(bytes) : crc32c_by_tables(bytes);
}

std::uint32_t crc32c(std::string_view bytes) {
  return crc32c(std::as_bytes(std::span<const char>(bytes.data(), bytes.size())));
}

}  // namespace sunfleck
