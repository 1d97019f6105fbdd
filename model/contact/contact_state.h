// A contact law is told this about the past of its contact.
#pragma once

#include <concepts>

namespace softland {

/// This is where a contact law stands. Laws without memory know only whether they act. `Yes` is bool, or the mask of a lane of
/// numbers.
template <class S, class Yes>
struct ContactStateOf {
  constexpr ContactStateOf() = default;
  constexpr ContactStateOf(std::same_as<Yes> auto acts) : active(acts) {}  // NOLINT: for most laws that is all there is

  Yes active = Yes(false);
  Yes unloading = Yes(false);  ///< along the shifted elastic curve
  S shift = 0;                 ///< s [m], where unloading
};
using ContactState = ContactStateOf<double, bool>;

}  // namespace softland
