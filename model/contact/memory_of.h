// Forward declarations of contact laws with memory: see model/contact/memory.h.
#pragma once

#include <string_view>

namespace softland {

template <class Loading, class Elastic, bool Heals>
struct ContactWithMemory;
template <class P>
struct LinearContactOf;
template <class P>
struct UniformAsperityContactOf;
template <class Asperity, class P>
class PlasticAsperityLoading;

using HystereticContact = ContactWithMemory<LinearContactOf<double>, LinearContactOf<double>, true>;
template <class Asperity>
using PlasticAsperityContact =
    ContactWithMemory<PlasticAsperityLoading<Asperity, double>, UniformAsperityContactOf<double>, false>;

/// Reason in messages why a contact law with memory cannot act along the pad.
inline constexpr std::string_view many_dents = "every point of the pad would keep a dent of its own";

}  // namespace softland
