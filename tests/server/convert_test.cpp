// Checksums against published values and against their plain twin, half floats against their definition,
// arrays that survive the wire and refuse damage.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "server/convert/array_message.h"
#include "server/convert/crc32c.h"
#include "server/convert/half.h"
#include "server/convert/light_map_message.h"
#include "server/convert/light_spec_message.h"
#include "server/convert/stand_answer.h"
#include "server/convert/stand_request.h"
#include "server/convert/status_message.h"
#include "sim/base/error.h"
#include "sim/base/random.h"
#include "sunfleck/v1/common.pb.h"
#include "sunfleck/v1/light.pb.h"
#include "sunfleck/v1/stand_light.pb.h"

namespace sunfleck {
namespace {

std::vector<std::byte> noise(std::size_t size) {
  RandomStream random(11, size, RandomPurpose::kTestScene);
  std::vector<std::byte> bytes(size);
  for (std::byte& b : bytes) b = static_cast<std::byte>(random.below(256));
  return bytes;
}

TEST(Crc32c, PublishedValues) {
  EXPECT_EQ(crc32c("123456789"), 0xE3069283u);              // the check value of the catalogue of CRCs
  EXPECT_EQ(crc32c(std::string(32, '\0')), 0x8A9136AAu);    // RFC 3720, B.4: 32 bytes of zeros
  EXPECT_EQ(crc32c(std::string(32, '\xff')), 0x62A8AB43u);  // and of ones
  EXPECT_EQ(crc32c(""), 0u);
}

TEST(Crc32c, FastOnesEqualThePlainOneForEveryLengthAndOffset) {
  const std::vector<std::byte> bytes = noise(300);
  for (std::size_t offset = 0; offset < 9; ++offset) {
    for (std::size_t length = 0; length + offset < bytes.size(); ++length) {
      const std::span<const std::byte> part(&bytes[offset], length);
      ASSERT_EQ(crc32c(part), crc32c_plain(part)) << offset << " " << length;
      ASSERT_EQ(crc32c_by_tables(part), crc32c_plain(part)) << offset << " " << length;
    }
  }
}

// Every half is exactly a float, so that going there and back must give the same bits.
TEST(Half, EveryHalfSurvives) {
  for (unsigned bits = 0; bits < 0x10000; ++bits) {
    const auto half = static_cast<std::uint16_t>(bits);
    const float value = float_from_half_bits(half);
    if (std::isnan(value)) {
      EXPECT_TRUE(std::isnan(float_from_half_bits(half_bits(value))));
    } else {
      ASSERT_EQ(half_bits(value), half);
    }
  }
}

// Between two neighbouring halves the nearer wins, and at the middle the even one.
TEST(Half, RoundsToNearestEven) {
  for (std::uint16_t bits = 0; bits < 0x7bff; ++bits) {
    const float low = float_from_half_bits(bits);
    const float high = float_from_half_bits(static_cast<std::uint16_t>(bits + 1));
    const float middle = 0.5f * (low + high);
    const auto even = static_cast<std::uint16_t>(bits % 2 == 0 ? bits : bits + 1);
    ASSERT_EQ(half_bits(middle), even);
    ASSERT_EQ(half_bits(std::nextafter(middle, low)), bits);
    ASSERT_EQ(half_bits(std::nextafter(middle, high)), bits + 1);
  }
  EXPECT_EQ(half_bits(65520.0f), 0x7c00);  // halfway beyond the largest half, 65504
  EXPECT_EQ(half_bits(-1.0f), 0xbc00);
  EXPECT_EQ(half_bits(1e-30f), 0);
}

struct Sent {
  v1::ArrayHeader header;
  std::vector<v1::ArrayChunk> chunks;
};

Sent sent(std::span<const std::byte> bytes) {
  const ArrayView view{"noise", ElementType::kUint8, {bytes.size()}, {}, bytes};
  Sent parts;
  fill_header(view, 0, parts.header);
  for (std::size_t c = 0; c < chunk_count(view); ++c) fill_chunk(view, 0, c, parts.chunks.emplace_back());
  return parts;
}

std::string received(const Sent& parts) {
  ArrayAssembler assembler;
  assembler.begin(parts.header);
  for (const v1::ArrayChunk& chunk : parts.chunks) assembler.add(chunk);
  return assembler.finish().at(0).bytes;
}

TEST(Arrays, AnySizeSurvivesInChunksOf256KiB) {
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{1}, kChunkBytes, kChunkBytes + 1, 3 * kChunkBytes - 1}) {
    const std::vector<std::byte> bytes = noise(size);
    const Sent parts = sent(bytes);
    EXPECT_EQ(parts.chunks.size(), (size + kChunkBytes - 1) / kChunkBytes);
    const std::string back = received(parts);
    ASSERT_EQ(back.size(), size);
    EXPECT_TRUE(size == 0 || std::memcmp(back.data(), bytes.data(), size) == 0);
  }
}

TEST(Arrays, DamageIsRefusedWithItsKind) {
  const std::vector<std::byte> bytes = noise(2 * kChunkBytes + 10);
  const struct {
    const char* says;
    std::function<void(Sent&)> damage;
  } cases[] = {
      {"checksum", [](Sent& s) { (*s.chunks[1].mutable_data())[77] ^= 1; }},
      {"out of order", [](Sent& s) { std::swap(s.chunks[0], s.chunks[1]); }},
      {"out of order", [](Sent& s) { s.chunks.erase(s.chunks.begin()); }},
      {"incomplete", [](Sent& s) { s.chunks.pop_back(); }},
      {"longer than announced", [](Sent& s) { s.header.set_size_bytes(kChunkBytes); }},
      {"not announced", [](Sent& s) { s.chunks[0].set_array_index(3); }},
      {"unknown data type", [](Sent& s) { s.header.clear_data_type(); }},
      {"impossible size", [](Sent& s) { s.header.set_size_bytes(~0ull); }},
  };
  for (const auto& [says, damage] : cases) {
    Sent parts = sent(bytes);
    damage(parts);
    try {
      received(parts);
      ADD_FAILURE() << "damage was taken: " << says;
    } catch (const Error& error) {
      EXPECT_NE(error.problem().find(says), std::string::npos) << error.what();
    }
  }
}

ReceivedArray floats(const std::string& name, std::vector<std::uint64_t> shape) {
  std::size_t size = sizeof(float);
  for (const std::uint64_t n : shape) size *= n;
  return {name, ElementType::kFloat32, std::move(shape), {}, std::string(size, '\0')};
}

std::string refusal_of(const std::function<void()>& read) {
  try {
    read();
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

// Arrays that arrived whole but are not of one size are not read beyond their end.
TEST(Answers, ThatDoNotFitTogetherAreRefused) {
  v1::LightMapSummary light;
  light.add_bands()->set_band("PAR");
  light.mutable_bands(0)->set_has_standard_error(true);
  std::vector<ReceivedArray> arrays = {floats("sunlit_fraction", {2}),
                                       floats("PAR/element_light", {2, 7}),
                                       floats("PAR/standard_error_w_m2", {1}),
                                       {"PAR/tree_ids", ElementType::kUint32, {0, 2}, {}, ""},
                                       {"PAR/tree_light", ElementType::kFloat64, {0, 5}, {}, ""}};
  light.set_array_count(static_cast<std::uint32_t>(arrays.size()));
  EXPECT_NE(refusal_of([&] { light_map_from_messages(arrays, light); }).find("standard errors"),
            std::string::npos);
  arrays[2] = floats("PAR/standard_error_w_m2", {2});
  EXPECT_EQ(refusal_of([&] { light_map_from_messages(arrays, light); }), "accepted");

  v1::StandLightSummary stand;
  stand.add_intervals()->set_label("all");
  stand.set_by_rays(true);
  stand.set_array_count(1);
  const ReceivedArray empty{"tree_ids", ElementType::kUint32, {7}, {}, ""};
  EXPECT_NE(refusal_of([&] { stand_study_from_messages({empty}, stand, {}); }).find("fit its shape"),
            std::string::npos);
}

TEST(LightSpecs, EqualRequestsHaveEqualKeysAndOthersDoNot) {
  LightRequest request;
  request.optics.bands = {"PAR"};
  request.optics.soil_albedo = {0.1};
  request.light.bands = {{400, 80}};
  LightRequest other = request;
  EXPECT_EQ(request_key(request), request_key(other));
  other.light.to_sun.x = std::numeric_limits<double>::denorm_min();
  EXPECT_NE(request_key(request), request_key(other));
  other = request;
  other.reference.seed = 2;
  EXPECT_NE(request_key(request), request_key(other));
}

TEST(LightSpecs, PerezSkiesKeepTheirNumbers) {
  LightRequest request;
  request.optics.bands = {"PAR"};
  request.optics.soil_albedo = {0.1};
  request.light.bands = {{400, 80}};
  request.light.sky = SkyModel::kPerez;
  request.light.sky_clearness = 4.3;
  request.light.sky_brightness = 0.17;
  v1::LightSpec message;
  fill_message(request, message);
  Violations violations;
  const LightRequest back = light_request_from_message(message, "light", {}, violations);
  EXPECT_TRUE(violations.empty());
  EXPECT_EQ(back.light.sky, SkyModel::kPerez);
  EXPECT_EQ(back.light.sky_clearness, 4.3);
  EXPECT_EQ(back.light.sky_brightness, 0.17);
}

// Times go as text, to the last digit.
TEST(RadiationTables, RowsOfAnyKindComeBackTheSame) {
  for (const char* csv :
       {"time,global_horizontal_w_m2\n2024-06-21T23:59:00.1+02:00,480.1\n2024-06-22T01:00:00.7+02:00,0.3\n",
        "date,global_horizontal_kwh_m2,diffuse_fraction\n2024-02-29,3.3,0.1\n1999-12-31,1.7,0.7\n",
        "year,month,global_horizontal_mj_m2\n2011,3,300.3\n2010,12,70.1\n"}) {
    const RadiationTable table = parse_radiation(csv, "a.csv");
    v1::RadiationTable message;
    fill_message(table, "a.csv", message);
    Violations violations;
    const RadiationTable back = radiation_from_message(message, "radiation", violations);
    EXPECT_TRUE(violations.empty());
    EXPECT_EQ(back.per, table.per);
    EXPECT_EQ(back.is_power, table.is_power);
    ASSERT_EQ(back.rows.size(), table.rows.size());
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      EXPECT_EQ(back.rows[i].begin_s, table.rows[i].begin_s);
      EXPECT_EQ(back.rows[i].end_s, table.rows[i].end_s);
      EXPECT_EQ(back.rows[i].day, table.rows[i].day);
      EXPECT_EQ(back.rows[i].month, table.rows[i].month);
      EXPECT_EQ(back.rows[i].year, table.rows[i].year);
      EXPECT_EQ(back.rows[i].global, table.rows[i].global);
      EXPECT_EQ(back.rows[i].diffuse_fraction, table.rows[i].diffuse_fraction);
      EXPECT_EQ(back.rows[i].where, at("radiation.rows", i));
    }
  }
}

TEST(Statuses, AnErrorSurvivesWithAllItsViolations) {
  const Error error = error_of(status_of({.code = grpc::StatusCode::INVALID_ARGUMENT,
                                          .reason = "REQUEST_INVALID",
                                          .message = "m",
                                          .violations = {{"a.b[1]", "must be 1"}, {"c", "must be 2"}}}));
  EXPECT_EQ(error.kind(), ErrorKind::kInvalidInput);
  EXPECT_NE(error.problem().find("a.b[1]: must be 1"), std::string::npos);
  EXPECT_NE(error.problem().find("c: must be 2"), std::string::npos);
}

}  // namespace
}  // namespace sunfleck
