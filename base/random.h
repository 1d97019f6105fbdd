// Random numbers without a state: every number is a function of (seed, stream, counter), so that neither the order in which
// numbers are drawn nor the number of threads can change them.
//
// The generator is SplitMix64: output n of seed s is mix(s + (n + 1) gamma) with a fixed odd gamma, so that any output is
// computed directly. A stream is the SplitMix64 sequence whose seed is an output of the sequence of the user's seed. Each
// sequence has a period of 2^64; the sequences of different streams overlap no more than random ones.
// Sources: G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014, section 4
// (sequence and splitting); D. Stafford, "Better bit mixing", 2011, variant 13 (mix).
#pragma once

#include <cstdint>

namespace softland {

/// The uses of random numbers. The number of each use keeps the streams of one seed apart. It must not change:
/// otherwise the same seed would give other results.
enum class Stream : std::uint64_t {
  sobol_shift = 1,
  skew = 2,
  library_seed = 3,
  normals = 4,
  scene = 5,
  perturbation = 6,
  spread = 7,        ///< parameters of the varied devices of an ensemble (Monte Carlo sample)
  indices = 8,       ///< sample points from which Sobol' indices (shares of the variance) are estimated
  bootstrap = 9,     ///< indices of the values that a bootstrap sample takes
  folds = 10,        ///< random partition of the devices for a cross-validation
  measurement = 11,  ///< errors of the simulated measurements on a device
  fresh = 12,        ///< seeds of new samples of simulated devices, to check a search's result on other devices
  jitter = 13,       ///< delays of the edges of a drive's waveform (jitter)
  classes = 14,      ///< reference devices of a calibration, and start centres of its classes (groups of devices)
  plan = 15,         ///< points of an exploration of a design space
  offspring = 16,    ///< choice of the parents in an evolutionary search's population, and random changes of their child
  hop = 17,          ///< random start points of local searches near the best point of a search
  /// Seeds of the searches in every round of a comparison of waveform families.
  tournament = 18,
  tuning = 19,             ///< parameters of simulated devices like the device under test, and searches for its waveform
  practice_device = 21,    ///< parameters of a practice device, a simulated device on which tuning is tried out
  practice_gain = 22,      ///< gain errors of the voltage sources of a practice device: constant, and per actuation
  practice_edges = 23,     ///< errors of the measured times at which the contact of a practice device closes and opens
  piezo_measurement = 24,  ///< errors of the measured deflection of a device by its piezo layer
  fit = 25,                ///< start points of the minimisations in a fit to measurements
};

/// Returns output number n, counted from 0, of SplitMix64 with this seed.
[[nodiscard]] constexpr std::uint64_t split_mix_64(std::uint64_t seed, std::uint64_t n) {
  std::uint64_t bits = seed + (n + 1) * 0x9e3779b97f4a7c15u;  // the constant is 2^64 divided by the golden ratio
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
  return bits ^ (bits >> 31);
}

/// Returns 64 random bits; `counter` numbers the draws of a stream.
[[nodiscard]] constexpr std::uint64_t random_bits(std::uint64_t seed, Stream stream, std::uint64_t counter) {
  return split_mix_64(split_mix_64(split_mix_64(seed, 0), static_cast<std::uint64_t>(stream)), counter);
}

/// Returns a multiple of 2^-53 in [0, 1) from 64 random bits.
[[nodiscard]] constexpr double to_unit_interval(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

/// Returns a number uniform in [0, 1).
[[nodiscard]] constexpr double random_uniform(std::uint64_t seed, Stream stream, std::uint64_t counter) {
  return to_unit_interval(random_bits(seed, stream, counter));
}

/// Returns a number uniform in (0, 1), as the quantiles of distributions need it: the middle of one of 2^52 intervals.
[[nodiscard]] constexpr double random_probability(std::uint64_t seed, Stream stream, std::uint64_t counter) {
  return (static_cast<double>(random_bits(seed, stream, counter) >> 12) + 0.5) * 0x1p-52;
}

/// Returns a standard normal number: the quantile at a random probability, so that its magnitude is at most 8.2.
[[nodiscard]] double random_normal(std::uint64_t seed, Stream stream, std::uint64_t counter);

}  // namespace softland
