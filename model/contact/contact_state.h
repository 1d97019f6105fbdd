// The state of a contact as input of its force law: whether the law acts, and for laws with memory the past of the contact.
#pragma once

#include <concepts>

namespace softland {

/// The state of a contact as input of its force law: `active` is true when the law acts. Laws without memory need nothing else.
/// `Yes` is bool, or the mask of a SIMD vector.
template <class S, class Yes>
struct ContactStateOf {
  constexpr ContactStateOf() = default;
  constexpr ContactStateOf(std::same_as<Yes> auto acts) : active(acts) {}  // NOLINT: implicit; most laws need only `active`

  Yes active = Yes(false);
  Yes unloading = Yes(false);  ///< true while a contact law with memory is on its elastic unloading curve
  S shift = 0;                 ///< residual interference of a contact law with memory while it unloads [m]
};
using ContactState = ContactStateOf<double, bool>;

}  // namespace softland
