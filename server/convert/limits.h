// What one request may ask for. Every number can be set in configs/server.toml and is told by GetServerInfo.
#pragma once

#include <cstdint>

namespace sunfleck {

struct Limits {
  std::uint64_t message_bytes = 4ull << 20;
  std::uint64_t trees_per_spec = 100'000;
  std::uint64_t elements_per_scene = 20'000'000;
  std::uint64_t scene_store_bytes = 0;      // 0: a tenth of the machine's memory
  std::uint64_t light_map_cache_bytes = 0;  // 0: a twentieth of the machine's memory
  std::uint64_t prepared_bytes = 0;         // 0: a twentieth of the machine's memory
  std::uint64_t request_memory_bytes = 0;   // 0: 15 % of the machine's memory, a quarter of the server's 60 %
  std::uint32_t bands = 32;
  std::uint32_t overrides = 256;
  std::uint32_t image_side_px = 8192;
  std::uint64_t image_samples = 1ull << 30;  // pixels times samples per pixel
  std::uint32_t query_elements = 10'000;
  std::uint32_t stand_sensors = 10'000;
  std::uint32_t stand_intervals = 8'784;  // the hours of a leap year
  std::uint32_t running_calls = 0;        // 0: as many as cores
  std::uint32_t queued_calls = 64;
  double default_deadline_s = 60;  // of unary calls that state none; streams get the longest
  double longest_deadline_s = 3600;
  double stalled_write_s = 30;
  double drain_grace_s = 20;
};

}  // namespace sunfleck
