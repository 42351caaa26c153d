// Known answers for Philox and SHA-256; loops that do not depend on the number of threads; frames.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "sim/base/contract.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"
#include "sim/base/sha256.h"
#include "sim/base/vec.h"

namespace sunfleck {
namespace {

TEST(Philox, GivesThePublishedAnswers) {
  // Random123 1.09, kat_vectors, philox4x32 10.
  using Block = std::array<std::uint32_t, 4>;
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}), (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox4x32({~0u, ~0u, ~0u, ~0u}, {~0u, ~0u}),
            (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(RandomStream, IsUniformAndNormalWithinFourSigma) {
  constexpr int n = 200000;
  double sum = 0, squares = 0, normal_squares = 0;
  RandomStream stream(7, 3, RandomPurpose::kTestScene);
  for (int i = 0; i < n; ++i) {
    const double u = stream.uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    squares += u * u;
    normal_squares += std::pow(stream.normal(), 2);
  }
  EXPECT_NEAR(sum / n, 0.5, 4 * std::sqrt(1.0 / 12 / n));
  EXPECT_NEAR(squares / n, 1.0 / 3, 4 * std::sqrt(4.0 / 45 / n));
  EXPECT_NEAR(normal_squares / n, 1.0, 4 * std::sqrt(2.0 / n));
}

TEST(RandomStream, StreamsOfDifferentPurposeDiffer) {
  RandomStream a(1, 1, RandomPurpose::kRaysFront), b(1, 1, RandomPurpose::kRaysBack);
  EXPECT_NE(a.next_u32(), b.next_u32());
}

TEST(Sha256, GivesThePublishedAnswer) {
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Frames, NorthEastUp) {
  const Vec3 east = direction_from_azimuth_zenith(radians_from_degrees(90), radians_from_degrees(90));
  EXPECT_NEAR(east.x, 1.0, 1e-15);
  const Vec3 d = direction_from_azimuth_zenith(radians_from_degrees(200), radians_from_degrees(35));
  EXPECT_NEAR(degrees_from_radians(azimuth_of(d)), 200, 1e-12);
  EXPECT_NEAR(degrees_from_radians(zenith_of(d)), 35, 1e-12);
}

TEST(Frames, BasisIsRightHandedAndOrthonormalEverywhere) {
  RandomStream stream(1, 0, RandomPurpose::kTestScene);
  for (int i = 0; i < 1000; ++i) {
    Vec3 n(stream.normal(), stream.normal(), stream.normal());
    if (i == 0) n = {0, 0, 1};
    if (i == 1) n = {0, 0, -1};
    n = glm::normalize(n);
    const Basis b = basis_around(n);
    EXPECT_NEAR(glm::dot(b.tangent, b.bitangent), 0, 1e-14);
    EXPECT_NEAR(glm::length(glm::cross(b.tangent, b.bitangent) - n), 0, 1e-14);
  }
}

TEST(Parallel, SumsAreTheSameForOneAndTwoThreads) {
  const auto sum_with = [](int threads) {
    double sum = 0;
    with_threads(threads, [&] { sum = ordered_sum(100001, [](std::size_t i) { return 1.0 / (1.0 + i); }); });
    return sum;
  };
  EXPECT_EQ(sum_with(1), sum_with(2));
}

TEST(Parallel, StopsWhenAskedAndPassesExceptionsOn) {
  std::stop_source source;
  std::atomic<int> ran{0};
  const auto body = [&](std::size_t, std::size_t) {
    ++ran;
    source.request_stop();
  };
  EXPECT_THROW(for_each_chunk(1000, 1, {source.get_token(), {}}, "test", body), Error);
  EXPECT_LT(ran, 1000);
  EXPECT_THROW(for_each_chunk(10, 1, {}, "", [](std::size_t, std::size_t) { SUNFLECK_EXPECTS(false); }),
               ContractViolation);
}

TEST(Error, ReadsAsWhereWhatAndRemedy) {
  const Error error(ErrorKind::kInvalidInput, "a.toml:3: seed", "must not be negative", "write 0 or more");
  EXPECT_STREQ(error.what(), "a.toml:3: seed: must not be negative (write 0 or more)");
}

// What a message quotes may be a whole binary file: it stays short and is cut between characters.
TEST(Error, QuotesAnythingShortlyAndPlainly) {
  const Error error(ErrorKind::kInvalidInput, std::string("a\0b", 3), "not\nthis\x1b[2J\x7f", "so");
  EXPECT_STREQ(error.what(), "a\\x00b: not\nthis\\x1b[2J\\x7f (so)");
  EXPECT_EQ(error.where(), "a\\x00b");
  std::string umlauts;
  for (int i = 0; i < 100'000; ++i) umlauts += "\xC3\xBC";
  for (const char* lead : {"", "x"}) {
    const std::string problem = Error(ErrorKind::kInvalidInput, "", lead + umlauts).problem();
    EXPECT_LT(problem.size(), 5100u);
    EXPECT_NE(problem.find("\xBC [...] \xC3"), std::string::npos) << problem;
  }
}

}  // namespace
}  // namespace sunfleck
