// A contact of a device: the parameters of one of its laws, and its pad. A new law needs a header and an entry in ContactModel;
// contact_law.h includes the header of a long force function.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "base/choice.h"
#include "base/field.h"
#include "model/contact/adhesive_asperities.h"
#include "model/contact/adhesive_repulsive_surfaces.h"
#include "model/contact/gaussian_asperities.h"
#include "model/contact/hysteretic_spring.h"
#include "model/contact/linear.h"
#include "model/contact/own.h"
#include "model/contact/plastic_asperities.h"
#include "model/contact/rigid.h"
#include "model/contact/uniform_asperities.h"
#include "model/place.h"

namespace softland {

/// The contact laws, in the order in which messages and tables list them.
using ContactModel = std::variant<LinearSpring, UniformAsperities, GaussianAsperities, AdhesiveAsperities, HystereticSpring,
                                  PlasticAsperities, RigidStop, AdhesiveRepulsiveSurfaces, OwnContact>;

/// The place where the contact force acts: at the pad's centre, or at all points of the pad that are beyond the contact plane.
enum class ContactDistribution { centre, pad };
inline constexpr auto contact_distributions =
    std::to_array<Named<ContactDistribution>>({{ContactDistribution::centre, "centre"}, {ContactDistribution::pad, "pad"}});
static_assert(is_complete<contact_distributions>());

/// Rule for the electrical connection of several contacts: closed while all of its contacts are closed, or while any of them
/// is.
enum class Connection { all, any };
inline constexpr auto connections = std::to_array<Named<Connection>>({{Connection::all, "all"}, {Connection::any, "any"}});
static_assert(is_complete<connections>());

/// The electrical properties of a closed contact: see model/contact/resistance.h. The resistance of a contact without a given
/// resistivity is unknown.
struct Conduction {
  double resistivity = std::numeric_limits<double>::quiet_NaN();  ///< resistivity of the contact metals [Ohm m]
  /// Hardness H of the softer metal; by default the hardness of the contact law, if the law has one [Pa].
  double hardness = std::numeric_limits<double>::quiet_NaN();
  double film_resistance = 0;  ///< resistance of a film in series with each contact [Ohm]
  double mean_free_path = 0;   ///< mean free path of the electrons [m]

  [[nodiscard]] bool is_given() const { return resistivity > 0; }
};

struct Contact {
  ContactModel model = UniformAsperities{};
  ContactDistribution distribution = ContactDistribution::centre;
  double pad_length = 0;  ///< length of the contact pad along the beam [m]: see Device::contact_position()
  /// Width of the contact pad [m]; NaN: the width of the moving part.
  double pad_width = std::numeric_limits<double>::quiet_NaN();
  std::string name = {};         ///< name of the contact; empty for the only contact
  std::optional<Place> at = {};  ///< centre of the contact pad along the beam; none: see Device::contact_position()
  /// Distance of the contact from its plane at rest [m]; for the first contact the value of Device::gap is used.
  double gap = std::numeric_limits<double>::quiet_NaN();
  Side side = Side::near;   ///< side of the beam; `far` for a back stop
  bool along_face = false;  ///< true for a contact at all points of a dielectric's face, whose law is per area
  double count = 1;         ///< number of equal contacts beside each other across the beam
  bool connects = true;     ///< true when the contact is part of the electrical connection
  Conduction conduction = {};
};

/// Returns true when the contact law acts per area of the pad, so that a plate needs a width and a length of the pad.
[[nodiscard]] inline bool acts_per_area(const ContactModel& model) {
  return std::visit(
      [](const auto& law) {
        return requires { law.per_area; };
      },
      model);
}
/// Returns true when the contact may remain closed without any voltage, by adhesion.
[[nodiscard]] inline bool may_stick(const ContactModel& model) {
  return std::visit(
      [](const auto& law) {
        if constexpr (requires { law.sticks(); }) return law.sticks();
        return requires { law.sticks; };
      },
      model);
}
/// Returns the reason why the contact law cannot act along the pad; empty when it can.
[[nodiscard]] inline std::string_view why_not_along_pad(const ContactModel& model) {
  return std::visit(
      [](const auto& law) -> std::string_view {
        if constexpr (requires { law.not_along_pad; }) return law.not_along_pad;
        return {};
      },
      model);
}
/// Returns the largest interference at which the contact law is physical [m]: all asperities touch, or for Gaussian heights the
/// plane has come down by four standard deviations. For a spring the result is infinite.
[[nodiscard]] inline double largest_interference(const ContactModel& model) {
  return std::visit(
      [](const auto& law) {
        if constexpr (requires { law.largest_interference(); }) return law.largest_interference();
        return std::numeric_limits<double>::infinity();
      },
      model);
}

}  // namespace softland
