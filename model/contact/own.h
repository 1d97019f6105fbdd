// A user's own contact law, written by a program that links softland, besides the laws that scenes can name.
//
//   P = force(d, d')        U = energy(d), the integral of force(., 0) from 0 to d
//
// P is the force on the moving part, away from the contact [N]; d interference [m]: how far the contact point is beyond the
// contact plane; d' its rate [m/s], positive into the contact; U stored energy [J].
//
//   struct Cubic final : OwnContactLaw {
//     std::string_view name() const override { return "cubic spring"; }
//     double force(double d, double) const override { return 1e20 * d * d * d; }
//   };
//   const Contact contact{.model = OwnContact{std::make_shared<const Cubic>()}, .pad_length = 5e-6};
//   device.contacts = {contact};  // for a device
//   file.add_contact(contact);    // for a scene file without [contact]
//
// Rules, which the laws of softland obey as well: force(0, d') = 0. For d > 0 the force is continuous with two continuous
// derivatives. The force continues smoothly to d < 0, where an integrator evaluates it on its way to the event that ends
// contact. The law has no memory, and no force acts before first contact. A law that depends on the rate dissipates energy:
// (force(d, d') - force(d, 0)) d' >= 0. Several threads call the functions at once, and often: some hundred times during one
// contact. The functions must not throw an exception.
//
// Such a switch is simulated, searched and evaluated under process variation (prepare(), optimize(), robustness()) like any
// other, one closing at a time instead of several at once with SIMD instructions. Tangents for implicit steps and for statics
// are differences of the force. Exact derivatives of a closing are refused (LinearizedClosing::refusal), and so is writing such
// a switch into a scene file (SceneFile::text), which cannot express the law.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <memory>
#include <string>
#include <string_view>
#include <variant>

#include "base/field.h"
#include "model/contact/summits.h"

namespace softland {

class OwnContactLaw {
 public:
  virtual ~OwnContactLaw() = default;
  /// Returns the name of the contact law in messages.
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// Returns the contact force on the moving part [N] at an interference [m] and its rate [m/s].
  [[nodiscard]] virtual double force(double interference, double rate) const = 0;
  /// Returns true when the contact force depends on the rate. Only such a law is evaluated at rates other than 0, and the
  /// energy audit counts its dissipation.
  [[nodiscard]] virtual bool depends_on_rate() const { return false; }
  /// Returns true when the contact force is negative (adhesive) somewhere, so that the contact may remain closed without any
  /// voltage.
  [[nodiscard]] virtual bool pulls() const { return false; }
  /// Returns the energy stored in the contact [J] at an interference [m]. The default integrates the force by Gauss points in
  /// the root of the interference, exact to rounding for sums of half-integer powers of the interference.
  [[nodiscard]] virtual double energy(double interference) const;
};

namespace internal {

/// Returns the derivative of a contact force by its interference or its rate, as a central difference over a millionth of this
/// argument's value `at` plus `least_step`.
template <class F>
[[nodiscard]] double slope_by_differences(F&& force, double at, double least_step) {
  const double step = 1e-6 * std::abs(at) + least_step;
  return (force(at + step) - force(at - step)) / (2 * step);
}

/// A user's own contact law with the functions by which a switch calls every law. `S` is double or a dual number; derivatives
/// of the force in a dual result are finite differences.
template <bool by_rate>
struct OwnContactForce {
  std::shared_ptr<const OwnContactLaw> own;

  template <class S>
  S force(S d) const {
    if constexpr (std::same_as<S, double>) {
      return own->force(d, 0);
    } else {
      const auto at = [&](double x) { return own->force(x, 0); };
      return S(at(d.value), slope_by_differences(at, d.value, least_depth) * d.slope);
    }
  }
  template <class S>
  S force(S d, S rate) const requires by_rate {
    if constexpr (std::same_as<S, double>) {
      return own->force(d, rate);
    } else {
      const double by_depth = slope_by_differences([&](double x) { return own->force(x, rate.value); }, d.value, least_depth);
      const double by_speed = slope_by_differences([&](double x) { return own->force(d.value, x); }, rate.value, least_speed);
      return S(own->force(d.value, rate.value), by_depth * d.slope + by_speed * rate.slope);
    }
  }
  [[nodiscard]] double dissipation(double d, double rate) const requires by_rate {
    return (own->force(d, rate) - own->force(d, 0)) * rate;
  }
  [[nodiscard]] double energy(double d) const { return own->energy(d); }

 private:
  // Smallest step of a finite difference: of the interference [m], of its rate [m/s].
  static constexpr double least_depth = 1e-15, least_speed = 1e-5;
};

}  // namespace internal

/// A user's own contact law as the law of a device's contact.
struct OwnContact {
  static constexpr std::string_view name = "own", not_along_pad = "which acts at the centre of the pad";
  static constexpr bool is_of_scenes = false;
  std::shared_ptr<const OwnContactLaw> own = {};

  static consteval auto fields() { return std::array<Field<OwnContact>, 0>{}; }
  [[nodiscard]] bool sticks() const { return own->pulls(); }
  /// Returns a message that names the violated rule; empty when the parameters of the contact are valid.
  [[nodiscard]] std::string why_invalid(double) const { return own ? std::string() : "contact: the own law must not be null"; }
  [[nodiscard]] std::variant<internal::OwnContactForce<false>, internal::OwnContactForce<true>> law(const ContactPad&) const {
    if (own->depends_on_rate()) return internal::OwnContactForce<true>{own};
    return internal::OwnContactForce<false>{own};
  }
};

}  // namespace softland
