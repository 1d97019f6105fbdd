// The past of a contact, as its law receives it.
#pragma once

#include <concepts>

namespace softland {

/// The state of a contact law. Laws without memory need only `active`. `Yes` is bool, or the mask of a lane of numbers.
template <class S, class Yes>
struct ContactStateOf {
  constexpr ContactStateOf() = default;
  constexpr ContactStateOf(std::same_as<Yes> auto acts) : active(acts) {}  // NOLINT: most laws need nothing else

  Yes active = Yes(false);
  Yes unloading = Yes(false);  ///< true on the shifted elastic curve
  S shift = 0;                 ///< s [m] while unloading
};
using ContactState = ContactStateOf<double, bool>;

}  // namespace softland
