// Branches on values, written once for one number and for a lane of numbers, where each number takes its own branch. A lane is
// a type such as std::experimental::simd with size(), mask_type, and where().
#pragma once

#include <concepts>
#include <cstddef>

namespace softland {

template <class S>
concept LaneOfNumbers = requires(const S& lane) {
  typename S::mask_type;
  { S::size() } -> std::convertible_to<std::size_t>;
  lane[0];
};

/// Sets the numbers of the lane `to` to those of `from` where the condition holds.
template <LaneOfNumbers Lane>
void assign_where(const typename Lane::mask_type& condition, Lane& to, const Lane& from) {
  where(condition, to) = from;
}

/// Returns then() where the condition holds, else otherwise(). For one number only one of the two functions is called. For a
/// lane both are called, so each must return a value, possibly NaN, also for numbers that do not use the value.
template <class Condition, class Then, class Otherwise>
[[nodiscard, gnu::always_inline]] constexpr auto select(const Condition& condition, Then&& then, Otherwise&& otherwise) {
  if constexpr (std::same_as<Condition, bool>) {
    return condition ? then() : otherwise();
  } else {
    auto chosen = otherwise();
    assign_where(condition, chosen, then());
    return chosen;
  }
}

/// Returns f(x); for a lane, f of each number one by one: this serves functions without a vector instruction, such as a table
/// look-up.
template <class S, class F>
[[nodiscard, gnu::always_inline]] constexpr S one_by_one(const S& x, F&& f) {
  if constexpr (LaneOfNumbers<S>) {
    return S([&](auto i) { return f(static_cast<typename S::value_type>(x[i])); });
  } else {
    return f(x);
  }
}

}  // namespace softland
