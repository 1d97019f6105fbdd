// A kind of structure is a struct with its numbers and
//
//   static constexpr std::string_view name;             its name in a scene
//   template <class S> static consteval auto fields();  an array of Field<S> (base/field.h), S the Structure: its keys in a scene
//   template <class S> static S example();              a structure that a switch may have, for tests
//   static constexpr std::array usual_spread;           how its devices differ where a scene does not say
//   auto modes(device, known) const;                    what answers as BeamModes does; `known` are modes of a similar switch
//
// It may also have
//
//   std::string why_invalid(device) const;              the rule that it breaks, with the quantity; empty: none
//   int most_modes() const;                             fewer than Structure::most_modes
//   double rest_offset(device, x) const;                how far it rests from the straight shape at x, away from the near
//   electrode auto stretching(modes, structure) const;            an optional stiffness of stretching static constexpr bool
//   is_rigid, has_far_clamp;      where they are true static constexpr std::string_view why_no_layer, why_no_skins;    why
//   [piezo] or [surface] cannot be static constexpr std::string_view whose, length_is; for messages: "on a plate", and its length
//   in words, {} for the value
//
// Functions that take a device are templates of its type: a device is made of structures. `Structure`
// (model/structure/structure.h) answers for the kind in force.
#pragma once

#include <string_view>

#include "base/field.h"
#include "base/range.h"

namespace softland {

/// How much devices differ in a key of [structure], where a scene does not say.
struct UsualSpread {
  std::string_view key, cov;
  bool has_default = false;  ///< it varies where a scene does not write it, too
};

/// The kind in force as the `Part` that it is, or derives from.
template <class Part, class S>
[[nodiscard]] constexpr auto& part_of(S& structure) {
  return *structure.template find<Part>();
}
template <class S, class Part, auto member>
[[nodiscard]] constexpr auto& within(S& structure) {
  return part_of<Part>(structure).*member;
}

}  // namespace softland
