// How to write a kind of structure (such as a beam or a plate). A kind is a struct with the parameters of the structure and
//
// - `static constexpr std::string_view name`, its name in a scene
// - `fields()`, consteval of a template argument S, an array of Field (base/field.h) of the Structure S: its scene-file keys.
//   A number must be above 0 unless its field has another `range`. The unit is any product of the symbols of config/units.cc.
// - `example()`, of the same argument, a structure that a switch may have, for tests
// - `static constexpr std::array usual_spread`, the process variation of its devices when a scene gives none
// - `auto modes(device, known) const`, its vibration modes: an object with
//     angular_frequencies() [rad/s]; length() [m]; scale(), mass-normalised shapes over normalised shapes [kg^(-1/2)];
//     normalised(), a pointer to the normalised shapes: value(x), slope(x), pinned_inverse_square(x, near), x over the length;
//     frequency_scale() [rad/s]: with a support added at x, the lowest frequency of the structure is
//     frequency_scale() / sqrt(pinned_inverse_square(x))
// `known` are the normalised modes of a similar beam, or null: the search for a beam's modes starts from these modes.
//
// It may also have
//
// - `std::string why_invalid(device) const`, the rule that the structure violates, with the quantity; empty if none
// - `int most_modes() const`, if the structure has fewer modes than Structure::most_modes
// - `double rest_offset(device, x) const`, its distance at rest from the straight shape at x, away from the near electrode [m]
//   and with it `double lowest_rest_offset(device) const`, the least of these distances along the structure
// - `auto stretching(modes, structure) const`, an optional stiffness of mid-plane stretching
// - `static constexpr bool is_rigid` (a rigid body) or `has_far_clamp` (clamped at both ends), when true
// - `static constexpr std::string_view why_no_layer` or `why_no_skins`: the reason why [piezo] or [surface] is impossible
// - `static constexpr std::string_view whose`, the place in messages, such as "on a plate", and `length_is`, words for the
//   length of the structure, such as "the {} of the modes' table", in which the length replaces {}
//
// Functions that take a device are templates of its type, since a device contains structures; so they call beam_modes() of
// model/beam.h without including this header, and a class that holds BeamModes is a template, too. `Structure`
// (model/structure/structure.h) calls the functions of the kind that it holds. For a kind that derives from Beam, softland also
// warns if the beam is not slender, checks how results depend on the number of modes, and uses up to 40 modes in static
// calculations. A kind that derives from Cantilever curls under a stress gradient.
#pragma once

#include <string_view>

#include "base/field.h"
#include "base/range.h"

namespace softland {

/// The process variation (coefficient of variation) of a key of [structure], for scenes without process variation of their own.
struct UsualSpread {
  std::string_view key, cov;
  bool has_default = false;  ///< true when the key varies even in a scene that does not contain the key
};

/// Returns the kind of a structure, which must be of type `Part` or derive from this type.
template <class Part, class S>
[[nodiscard]] constexpr auto& part_of(S& structure) {
  return *structure.template find<Part>();
}
template <class S, class Part, auto member>
[[nodiscard]] constexpr auto& within(S& structure) {
  return part_of<Part>(structure).*member;
}

}  // namespace softland
