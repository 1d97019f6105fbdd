// Contact that remembers its deepest interference, loads along one curve and unloads along the elastic curve of the same
// surfaces, shifted so that it passes through the turning point.
//
//   loading        P = L(d)                          d deeper than ever before
//   unloading      P = Pe(d - s),  s = d_m - d_e,  Pe(d_e) = L(d_m)       s < d < d_m, the deepest interference so far
//   dent           P = 0                             d < s
//
// P is the force on the beam, away from the contact [N]; d interference [m]; L and Pe loading and elastic law, L <= Pe; s
// residual interference [m]. Stored energy is Ue(d_e) while loading, Ue(d - s) after; the energy lost is the work of loading
// less Ue(d_e), at d_m. P and both energies are continuous. Reloading follows the unloading curve up to d_m. Each curve is
// continued smoothly past its end, where the integrator restarts. Statics (pull-in, release, closed equilibrium) are those of
// first loading.
//
//   hysteretic        L = k_l d, Pe = k_u d: a mass rebounds with e^2 = k_l / k_u. The dent heals when contact ends: every touch
//                     loses the same share. Source: Tung et al. 2014 (loading and unloading stiffness).
//   elastic-plastic   L of plastic_asperity.h, Pe the law asperity-uniform. The dent stays for the rest of the run, so that
//                     later and lighter impacts are elastic. Source of elastic unloading: Johnson 1985, sec. 6.4; the shift of
//                     the whole curve is ours. The shift leaves the summits as sharp as before; flattened summits would be
//                     stiffer and lose more energy.
#pragma once

#include <type_traits>
#include <variant>

#include "base/select.h"
#include "model/contact/asperity_uniform.h"
#include "model/contact/contact_state.h"
#include "model/contact/hysteretic_spring.h"
#include "model/contact/linear.h"
#include "model/contact/plastic_asperities.h"
#include "model/contact/plastic_asperity.h"

namespace softland {

template <class Loading, class Elastic, bool Heals>
struct ContactWithMemory {
  Loading loading = {};
  Elastic elastic = {};

  static constexpr bool heals = Heals;              ///< true when the residual deformation vanishes as the contact opens
  static constexpr bool grows_with_depth = !Heals;  ///< true if the contact force is largest at the deepest interference

  /// Returns the contact force on first loading [N]; energy() returns the work of loading [J].
  template <class S>
  S force(S d) const {
    return loading.force(d);
  }
  [[nodiscard]] double energy(double d) const { return loading.energy(d); }

  template <class S, class Shift, class Yes>
  S force(S d, const ContactStateOf<Shift, Yes>& state) const {
    return select(
        state.unloading, [&]() -> S { return elastic.force(d - S(state.shift)); }, [&]() -> S { return loading.force(d); });
  }
  [[nodiscard]] double stored(double d, const ContactState& state) const {
    return elastic.energy(state.unloading ? d - state.shift : elastic.interference(loading.force(d)));
  }
  /// Returns the residual interference of the contact after unloading from the deepest interference [m].
  [[nodiscard]] double shift(double deepest) const { return deepest - elastic.interference(loading.force(deepest)); }
  /// Returns the energy that loading to the deepest interference dissipates [J].
  [[nodiscard]] double lost(double deepest) const {
    return loading.energy(deepest) - elastic.energy(elastic.interference(loading.force(deepest)));
  }
};

inline HystereticContact HystereticSpring::law(const ContactPad& pad) const {
  return {.loading = {.stiffness = stiffness * pad.count}, .elastic = {.stiffness = unloading_stiffness * pad.count}};
}

inline std::variant<PlasticAsperityContact<ZmcAsperity>, PlasticAsperityContact<KogutEtsionAsperity>> PlasticAsperities::law(
    const ContactPad& pad) const {
  const auto of = [&]<class Asperity>(std::type_identity<Asperity>) {
    return PlasticAsperityContact<Asperity>{
        .loading = {summits.count(pad), height, summits.radius, hardness, summits.effective_modulus},
        .elastic = uniform_contact(summits, height, pad)};
  };
  if (plasticity == Plasticity::zmc) return of(std::type_identity<ZmcAsperity>());
  return of(std::type_identity<KogutEtsionAsperity>());
}

}  // namespace softland
