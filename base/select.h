// Branches on values, written once for one number and for a lane of numbers, each with its own answer. A lane is a type such as
// std::experimental::simd: it knows its size(), its mask_type, and where().
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

/// Sets `to` where the condition holds.
template <LaneOfNumbers Lane>
void assign_where(const typename Lane::mask_type& condition, Lane& to, const Lane& from) {
  where(condition, to) = from;
}

/// then() where the condition holds, else otherwise(). Of one number only one of both is called; of a lane both are, so that each
/// must give something, if only NaN, where it is not asked for.
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

/// f of a number, or of every number of a lane: for what a lane can only do one by one, such as looking up a table.
template <class S, class F>
[[nodiscard, gnu::always_inline]] constexpr S one_by_one(const S& x, F&& f) {
  if constexpr (LaneOfNumbers<S>) {
    return S([&](auto i) { return f(static_cast<typename S::value_type>(x[i])); });
  } else {
    return f(x);
  }
}

}  // namespace softland
