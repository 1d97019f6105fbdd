// The state of a contact that its law receives: whether the contact acts, and for laws with memory its past.
#pragma once

#include <concepts>

namespace softland {

/// The state of a contact law. Laws without memory need only `active`. `Yes` is bool, or the mask of a vector of numbers.
template <class S, class Yes>
struct ContactStateOf {
  constexpr ContactStateOf() = default;
  constexpr ContactStateOf(std::same_as<Yes> auto acts) : active(acts) {}  // NOLINT: implicit; most laws need to know no more

  Yes active = Yes(false);
  Yes unloading = Yes(false);  ///< true on the elastic curve of unloading
  S shift = 0;                 ///< residual interference s while unloading [m]
};
using ContactState = ContactStateOf<double, bool>;

}  // namespace softland
