// CRC-32C (Castagnoli, polynomial 0x1EDC6F41 reflected), as iSCSI uses it (RFC 3720): of "123456789" it is
// 0xE3069283. Debian 12 packages no C++ library for it.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace sunfleck {

// By the processor's instruction where it has one, else eight bytes at a time by tables.
std::uint32_t crc32c(std::span<const std::byte> bytes);
std::uint32_t crc32c(std::string_view bytes);
// The plain twin: one bit at a time.
std::uint32_t crc32c_plain(std::span<const std::byte> bytes);
// What crc32c does on a processor without the instruction.
std::uint32_t crc32c_by_tables(std::span<const std::byte> bytes);

}  // namespace sunfleck
