// Sets of points in the open unit cube (0, 1)^d. Point k is computed directly, as a function of seed, stream, k and, for a
// Latin hypercube, the size of the set. The order of computation, threads and the division of a study into parts do not change
// it.
//
//   sobol            a Sobol' sequence with Owen's nested uniform scrambling. Every point is uniform over the cube, so that
//                    means over the set have no bias; together the points are a digital net: of 2^m points, beginning at a
//                    multiple of 2^m, each dimension has one in every interval [i, i + 1) 2^-m. The error of a mean of a smooth
//                    function falls nearly as N^-3/2. Best sizes are powers of two. Point k is the same for every size.
//   latin_hypercube  in each dimension a random permutation of N strata, with a uniform number inside each. The error of a mean
//                    falls as N^-1/2, like that of Monte Carlo, but a part of the function that is a sum of functions of one
//                    variable each hardly adds to it. All points depend on N: sets of different size have nothing in common.
//   monte_carlo      independent and uniform; the error falls as N^-1/2. Point k is the same for every size.
//
// Coordinate i of a point does not depend on the number of dimensions. All coordinates are multiples of 2^-53, except in a
// Latin hypercube, where a division by N rounds them.
//
// Scrambling: bit j of a coordinate is flipped or not by a random bit, which depends on the bits above bit j: on a node of a
// binary tree. It is computed from the number of the node. The direction numbers give the highest 32 bits of a coordinate. The
// lower bits are 0 in the sequence, so that after scrambling they are random. Permutation: a Feistel network over the least
// power of two that holds N, repeated until it gives a number below N.
//
// Sources: A. B. Owen, "Randomly permuted (t,m,s)-nets and (t,s)-sequences", 1995 (scrambling), and "Scrambled net variance for
// integrals of smooth functions", Annals of Statistics 25 (1997) 1541; S. Joe & F. Y. Kuo, SIAM J. Sci. Comput. 30 (2008) 2635
// (direction numbers, those of Boost.Random); M. D. McKay, R. J. Beckman & W. J. Conover, Technometrics 21 (1979) 239; J. Black &
// P. Rogaway, CT-RSA 2002 (cycle walking).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/choice.h"
#include "base/random.h"

namespace softland {

enum class PointSet { sobol, latin_hypercube, monte_carlo };

inline constexpr std::array point_sets{
    Named<PointSet>{PointSet::sobol, "sobol"},
    Named<PointSet>{PointSet::latin_hypercube, "latin_hypercube"},
    Named<PointSet>{PointSet::monte_carlo, "monte_carlo"},
};
static_assert(is_complete<point_sets>());

class SamplePoints {
 public:
  static constexpr std::uint64_t largest_size = std::uint64_t{1} << 31;
  /// Largest number of dimensions for which Boost.Random has direction numbers.
  static constexpr std::size_t most_dimensions = 3667;

  /// Takes the kind of point set, dimensions, seed and size. Throws InvalidParameter for `dimensions` or `size` unless 1 <=
  /// dimensions <= most_dimensions and 1 <= size <= largest_size.
  SamplePoints(PointSet kind, std::size_t dimensions, std::uint64_t seed, Stream stream, std::uint64_t size);

  [[nodiscard]] PointSet kind() const { return kind_; }
  [[nodiscard]] std::size_t dimensions() const { return keys_.size(); }
  [[nodiscard]] std::uint64_t size() const { return size_; }

  /// Writes the coordinates of point k to `u`. Throws InvalidInput unless k < size() and `u` has as many elements as there are
  /// dimensions.
  void point(std::uint64_t k, std::span<double> u) const;

 private:
  PointSet kind_;
  std::uint64_t size_;
  std::vector<std::uint64_t> keys_;  // seed of the random numbers of each dimension
  std::vector<std::uint32_t>
      directions_;  // element r * dimensions() + i: Sobol direction number of dimension i for bit r of a point's number
};

}  // namespace softland
