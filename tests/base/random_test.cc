#include "base/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <set>

namespace softland {
namespace {

// Outputs of the reference implementation, splitmix64.c (Vigna 2015), for seed 0; and for seed 1234567 as Rosetta Code lists them
// ("Pseudo-random numbers/Splitmix64").
TEST(SplitMix64, GivesThePublishedNumbers) {
  constexpr std::array<std::uint64_t, 5> from_0{0xe220a8397b1dcdaf, 0x6e789e6aa1b965f4, 0x06c45d188009454f, 0xf88bb8a8724c81ec,
                                                0x1b39896a51a8749b};
  constexpr std::array<std::uint64_t, 5> from_1234567{6457827717110365317u, 3203168211198807973u, 9817491932198370423u,
                                                      4593380528125082431u, 16408922859458223821u};
  for (std::size_t n = 0; n < from_0.size(); ++n) {
    EXPECT_EQ(split_mix_64(0, n), from_0[n]);
    EXPECT_EQ(split_mix_64(1234567, n), from_1234567[n]);
  }
}

// The numbers are those of earlier versions, so that a recorded seed keeps its meaning.
TEST(Random, GivesTheNumbersOfEarlierVersions) {
  constexpr std::uint64_t largest = std::numeric_limits<std::uint64_t>::max();
  EXPECT_EQ(random_bits(1, Stream::library_seed, 0), 0xca32e53bf572740bu);
  EXPECT_EQ(random_bits(1, Stream::sobol_shift, 6), 0x2c8b9eb39db1b2bdu);
  EXPECT_EQ(random_bits(7, Stream::normals, 99999), 0xae30a32adca1410fu);
  EXPECT_EQ(random_bits(0, Stream::perturbation, 0), 0x50cf6f5f4343b2afu);
  EXPECT_EQ(random_bits(largest, Stream::scene, largest), 0x0de043bd7088a120u);
  EXPECT_EQ(random_bits(1, Stream::spread, 0), 0x6bb1fcc8494f3b37u);
  EXPECT_EQ(random_bits(1, Stream::indices, 0), 0x717108a07d3e8a49u);
  EXPECT_EQ(random_bits(1, Stream::bootstrap, 0), 0x40a8e2b0daf32125u);
  EXPECT_EQ(random_uniform(20240101, Stream::skew, 5), 0x1.90418c9fb2badp-1);
}

TEST(Random, StreamsAndSeedsDoNotMeet) {
  std::set<std::uint64_t> seen;
  for (const std::uint64_t seed : {0u, 1u, 2u}) {
    for (const Stream stream : {Stream::sobol_shift, Stream::skew, Stream::library_seed, Stream::normals}) {
      for (std::uint64_t counter = 0; counter < 100; ++counter) seen.insert(random_bits(seed, stream, counter));
    }
  }
  EXPECT_EQ(seen.size(), 3u * 4u * 100u);
}

TEST(Random, IsUniform) {
  constexpr int samples = 100000;
  double sum = 0, squares = 0;
  for (std::uint64_t counter = 0; counter < samples; ++counter) {
    const double u = random_uniform(7, Stream::normals, counter);
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    sum += u;
    squares += u * u;
  }
  // Five standard deviations of the mean of so many uniform numbers, and of their squares.
  EXPECT_NEAR(sum / samples, 0.5, 5 * 0.289 / 316);
  EXPECT_NEAR(squares / samples, 1.0 / 3, 5 * 0.298 / 316);
}

TEST(Random, NormalNumbersAreQuantilesOfUniformOnes) {
  for (std::uint64_t counter = 0; counter < 10'000; ++counter) {
    const double x = random_normal(7, Stream::normals, counter);
    const double probability = random_uniform(7, Stream::normals, counter);
    constexpr double kept_bits = 0x1p-52;  // rounding of the uniform number
    ASSERT_NEAR(std::erfc(-x / std::sqrt(2.0)) / 2, probability, 4 * kept_bits) << x;
  }
}

}  // namespace
}  // namespace softland
