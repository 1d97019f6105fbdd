#include "sampling/points.h"

#include <bit>
#include <boost/random/sobol.hpp>
#include <string>

#include "base/require.h"

namespace softland {
namespace {

constexpr int resolved_bits = 32;  // number of highest bits of a coordinate that come from the Sobol' sequence

// Returns a number in (0, 1) from 64 random bits: the highest 52 select one of 2^52 equal intervals, whose middle is returned.
double in_open_interval(std::uint64_t bits) { return (static_cast<double>(bits >> 12) + 0.5) * 0x1p-52; }

std::vector<std::uint32_t> direction_numbers(std::size_t dimensions) {
  boost::random::sobol_engine<std::uint32_t, resolved_bits> sequence(dimensions);
  std::vector<std::uint32_t> directions;
  for (int r = 0; r < resolved_bits; ++r) {
    // Point s of Boost's sequence is the exclusive or of the direction numbers of the bits that are set in the Gray code of s +
    // 1. For s = 2^(r + 1) - 2 only bit r is set, so the point is direction number r.
    sequence.seed(static_cast<std::uint32_t>((std::uint64_t{2} << r) - 2));
    for (std::size_t i = 0; i < dimensions; ++i) directions.push_back(sequence());
  }
  return directions;
}

// Returns 64 bits of a scrambled coordinate. The highest 32 bits are `digits`, the coordinate in the Sobol' sequence, after
// scrambling; the others are random.
std::uint64_t scrambled(std::uint64_t key, std::uint32_t digits) {
  // Bit j, counted from the highest, is flipped if a random bit is 1, which depends on the j higher bits: on the node of a
  // binary tree with the number 2^j + (the first j bits of `digits`).
  std::uint32_t flips = 0;
  for (unsigned j = 0; j < resolved_bits; ++j) {
    const std::uint64_t node = (std::uint64_t{digits} | std::uint64_t{1} << resolved_bits) >> (resolved_bits - j);
    flips |= static_cast<std::uint32_t>(split_mix_64(key, node) >> 63) << (resolved_bits - 1 - j);
  }
  const std::uint64_t below = split_mix_64(key, std::uint64_t{digits} | std::uint64_t{1} << resolved_bits);
  return std::uint64_t{digits ^ flips} << resolved_bits | below >> resolved_bits;
}

// Returns the image of k under a permutation of 0, ..., size - 1, which `key` determines.
std::uint64_t permuted(std::uint64_t key, std::uint64_t k, std::uint64_t size) {
  constexpr std::uint64_t rounds = 8;  // rounds of the Feistel network; four suffice for large halves, but a half may be one bit
  const int width = static_cast<int>(std::bit_width(size - 1)), right_width = (width + 1) / 2;
  const std::uint64_t right_mask = (std::uint64_t{1} << right_width) - 1,
                      left_mask = (std::uint64_t{1} << (width - right_width)) - 1;
  do {
    std::uint64_t left = k >> right_width, right = k & right_mask;
    for (std::uint64_t round = 0; round < rounds; ++round) {
      right ^= split_mix_64(key, (2 * round) << 32 | left) >> 32 & right_mask;
      left ^= split_mix_64(key, (2 * round + 1) << 32 | right) >> 32 & left_mask;
    }
    k = left << right_width | right;
  } while (k >= size);
  return k;
}

// Returns a random number inside stratum number `stratum` of the `size` equal parts of (0, 1). Only as many random bits are
// used as leave the sum below exact, so that it rounds neither to the next stratum nor to 1.
double in_stratum(std::uint64_t bits, std::uint64_t stratum, std::uint64_t size) {
  const int kept = 52 - static_cast<int>(std::bit_width(size - 1));
  const double inside = (static_cast<double>(bits >> (64 - kept)) + 0.5) / static_cast<double>(std::uint64_t{1} << kept);
  return (static_cast<double>(stratum) + inside) / static_cast<double>(size);
}

}  // namespace

SamplePoints::SamplePoints(PointSet kind, std::size_t dimensions, std::uint64_t seed, Stream stream, std::uint64_t size)
    : kind_(kind), size_(size) {
  require_of("dimensions", 1 <= dimensions && dimensions <= most_dimensions,
             "dimensions = " + std::to_string(dimensions) + " must be between 1 and " + std::to_string(most_dimensions));
  require_of("size", 1 <= size && size <= largest_size,
             "size = " + std::to_string(size) + " must be between 1 and " + std::to_string(largest_size));
  // Derive the keys of all dimensions from the first number of the random stream; other uses of the stream may take the others.
  for (std::size_t i = 0; i < dimensions; ++i) keys_.push_back(split_mix_64(random_bits(seed, stream, 0), i));
  if (kind == PointSet::sobol) directions_ = direction_numbers(dimensions);
}

void SamplePoints::point(std::uint64_t k, std::span<double> u) const {
  require(k < size_, "the number of a point must be below the size of its set");
  require(u.size() == dimensions(), "a point must have one coordinate per dimension of its set");
  switch (kind_) {
    case PointSet::sobol:
      for (std::size_t i = 0; i < u.size(); ++i) {
        std::uint32_t digits = 0;
        for (std::uint64_t bits = k; bits != 0; bits &= bits - 1) {
          digits ^= directions_[static_cast<std::size_t>(std::countr_zero(bits)) * u.size() + i];
        }
        u[i] = in_open_interval(scrambled(keys_[i], digits));
      }
      break;
    case PointSet::latin_hypercube:
      for (std::size_t i = 0; i < u.size(); ++i) {
        // The key of the dimension seeds the permutation of the strata, and its complement the positions inside the strata.
        u[i] = in_stratum(split_mix_64(~keys_[i], k), permuted(keys_[i], k, size_), size_);
      }
      break;
    case PointSet::monte_carlo:
      for (std::size_t i = 0; i < u.size(); ++i) u[i] = in_open_interval(split_mix_64(keys_[i], k));
      break;
  }
}

}  // namespace softland
