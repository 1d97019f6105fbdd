// The state of a contact that its force law receives: whether the contact acts, and for laws with memory its past.
#pragma once

#include <concepts>

namespace softland {

/// The state of a contact that its force law receives. Laws without memory need only `active`. `Yes` is bool, or the mask of a
/// SIMD vector.
template <class S, class Yes>
struct ContactStateOf {
  constexpr ContactStateOf() = default;
  constexpr ContactStateOf(std::same_as<Yes> auto acts) : active(acts) {}  // NOLINT: implicit; most laws need to know no more

  Yes active = Yes(false);
  Yes unloading = Yes(false);  ///< true while a contact law with memory unloads on its elastic curve
  S shift = 0;                 ///< residual interference of a contact law with memory while it unloads [m]
};
using ContactState = ContactStateOf<double, bool>;

}  // namespace softland
