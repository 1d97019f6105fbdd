// The contact law "elastic-plastic" of a scene: see model/contact/plastic_asperity.h and memory.h.
#pragma once

#include <string_view>
#include <variant>

#include "base/choice.h"
#include "model/contact/memory_of.h"
#include "model/contact/summits.h"

namespace softland {

class ZmcAsperity;
class KogutEtsionAsperity;

/// Law of the load of one yielding asperity: Zhao, Maietta and Chang (zmc.h), or Kogut and Etsion (kogut_etsion.h).
enum class Plasticity { zmc, kogut_etsion };
inline constexpr auto plasticities =
    std::to_array<Named<Plasticity>>({{Plasticity::zmc, "zmc"}, {Plasticity::kogut_etsion, "ke"}});
static_assert(is_complete<plasticities>());

struct PlasticAsperities {
  static constexpr std::string_view name = "elastic-plastic", not_along_pad = many_dents;
  static constexpr bool per_area = true;
  Summits summits = {};
  double height = 0;    ///< greatest height of the asperity summits [m]
  double hardness = 0;  ///< hardness of the softer surface [Pa]
  Plasticity plasticity = Plasticity::zmc;

  static consteval auto fields() {
    using Law = PlasticAsperities;
    // clang-format off
    return joined(summit_fields<Law>(), height_fields<Law>(), modulus_fields<Law>(), std::to_array<Field<Law>>({
        {.key = "hardness", .unit = "Pa", .about = "of the softer surface", .in = reach<Law, &Law::hardness>, .required = true, .such_as = "1 GPa"},
        {.key = "plasticity", .about = "law of one asperity: zmc of Zhao, Maietta and Chang; ke of Kogut and Etsion, made continuous; ceb is refused, for its force jumps", .fallback = "'zmc'",
         .words = [] { return names_of(plasticities); },
         .choose = [](Law& law, std::string_view word) { law.plasticity = find_named(plasticities, word)->value; },
         .refused_word = "ceb",
         .why_refused = "the force of Chang, Etsion and Bogy as published jumps by about half at the critical interference, which no integrator of motion can use; take \"zmc\" or \"ke\""},
    }));
    // clang-format on
  }
  [[nodiscard]] static constexpr PlasticAsperities example() {
    return {.summits = Summits::example(), .height = 100e-9, .hardness = 1e9};
  }
  /// Returns the interference at which all asperity summits touch [m].
  [[nodiscard]] double largest_interference() const { return height; }
  [[nodiscard]] std::variant<PlasticAsperityContact<ZmcAsperity>, PlasticAsperityContact<KogutEtsionAsperity>> law(
      const ContactPad& pad) const;
};

}  // namespace softland
