// A position on a beam, and its side of the beam.
#pragma once

#include "base/choice.h"

namespace softland {

/// Side of the moving part: the side of the first contact, towards which deflections are positive (near), the other side (far),
/// or both sides.
enum class Side { near, far, both };
inline constexpr auto sides = std::to_array<Named<Side>>({{Side::near, "near"}, {Side::far, "far"}, {Side::both, "both"}});
static_assert(is_complete<sides>());

/// A position along the beam, from the clamped end: a distance [m], or a share of the beam's length, which scales with the
/// length.
struct Place {
  constexpr Place() = default;
  // Not explicit: a plain number stands for a distance from the clamped end [m].
  constexpr Place(double distance) : value(distance) {}
  [[nodiscard]] static constexpr Place share(double of_length) {
    Place place(of_length);
    place.is_share = true;
    return place;
  }
  /// Returns the distance from the clamped end of a beam of this length [m].
  [[nodiscard]] constexpr double on(double length) const { return is_share ? value * length : value; }
  [[nodiscard]] bool operator==(const Place&) const = default;

  double value = 0;
  bool is_share = false;
};

/// An interval along the beam.
struct Span {
  Place begin, end;
  [[nodiscard]] bool operator==(const Span&) const = default;
};

/// Begin and end of an interval along a beam [m].
struct Stretch {
  double begin = 0, end = 0;
  [[nodiscard]] bool holds(double x) const { return x >= begin && x < end; }
};

}  // namespace softland
