// Functions of points in the space of several objectives, all of them to be minimised. They find the points that no other point
// dominates (the front), the volume of the space of objectives that the points dominate together, and the knee of the front.
//
// A point dominates another point if it is nowhere worse and somewhere better. A point with a value that is not finite is never
// part of a front.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace softland {

/// Values of the minimised objectives at one point.
using Objectives = std::vector<double>;

/// Returns true when `a` dominates `b`. Throws InvalidInput for points of different lengths.
[[nodiscard]] bool dominates(std::span<const double> a, std::span<const double> b);

/// Returns the indices of the points that no other point dominates (Pareto front), ascending; of several equal points only the
/// first. Throws InvalidInput when points have different numbers of objectives.
[[nodiscard]] std::vector<std::size_t> pareto_front(std::span<const Objectives> points);

/// Returns the volume of the box below `reference`, its worst corner, that the points dominate. It is exact, for one to three
/// objectives, in n log n and, for three, at most n^2 steps; a point that does not lie below the reference in every objective
/// adds nothing. Throws InvalidInput for other numbers of objectives, for points with another number of objectives than the
/// reference, and for a reference that is not finite. Source: E. Zitzler & L. Thiele, PPSN V 1998 (the measure); C. M. Fonseca,
/// L. Paquete & M. Lopez-Ibanez, CEC 2006 (sweep along the last objective over a staircase of the others).
[[nodiscard]] double hypervolume(std::span<const Objectives> points, std::span<const double> reference);

/// The smallest and the largest value of an objective over the points.
struct ObjectiveRange {
  double lowest = 0;
  double highest = 0;
};
[[nodiscard]] std::vector<ObjectiveRange> objective_ranges(std::span<const Objectives> points);

/// Returns the index of the point at the knee of the Pareto front: with every objective scaled to [0, 1] over the points, the
/// point farthest below the plane through (1, 0, ...), (0, 1, 0, ...) and so on. For two objectives this is the line between
/// both ends of the front. Returns none when no point lies below this plane by more than rounding: a front that is straight or
/// bulges outwards has no knee, and neither has a front whose points agree in an objective. Source: I. Das, "On characterizing
/// the knee of the Pareto curve based on normal-boundary intersection", Structural Optimization 18 (1999) 107.
[[nodiscard]] std::optional<std::size_t> pareto_knee(std::span<const Objectives> front);

}  // namespace softland
