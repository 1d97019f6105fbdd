// A contact of a device: the parameters of its force law, and its pad. To add a law, write a header with its parameters and add
// these to ContactModel. A long force function belongs in a second header, which contact_law.h includes.
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

/// The parameters of one contact law, of any kind. Messages and tables list the laws in this order.
using ContactModel = std::variant<LinearSpring, UniformAsperities, GaussianAsperities, AdhesiveAsperities, HystereticSpring,
                                  PlasticAsperities, RigidStop, AdhesiveRepulsiveSurfaces, OwnContact>;

/// The place where the contact force acts: at the pad's centre, or at all points of the pad that are beyond the contact plane.
enum class ContactDistribution { centre, pad };
inline constexpr auto contact_distributions =
    std::to_array<Named<ContactDistribution>>({{ContactDistribution::centre, "centre"}, {ContactDistribution::pad, "pad"}});
static_assert(is_complete<contact_distributions>());

/// Rule for the connection (electrical path) through several contacts: closed while all of them are closed, or while any is.
enum class Connection { all, any };
inline constexpr auto connections = std::to_array<Named<Connection>>({{Connection::all, "all"}, {Connection::any, "any"}});
static_assert(is_complete<connections>());

/// The electrical properties of a closed contact: see model/contact/resistance.h. Without a resistivity (NaN) the resistance of
/// the contact is not computed.
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
  /// Width of the contact pad [m]; NaN for a pad as wide as the moving part.
  double pad_width = std::numeric_limits<double>::quiet_NaN();
  std::string name = {};         ///< name of the contact; empty for the only contact
  std::optional<Place> at = {};  ///< centre of the contact pad along the beam; if empty, see Device::contact_position()
  /// Distance of the contact point from its contact plane at rest [m]; not used for the first contact, whose distance is in
  /// Device::gap.
  double gap = std::numeric_limits<double>::quiet_NaN();
  Side side = Side::near;   ///< side of the beam; `far` for a back stop
  bool along_face = false;  ///< true for a contact along the whole face of a dielectric; its force law is per area
  double count = 1;         ///< number of equal contacts beside each other across the beam
  bool connects = true;     ///< true when the contact is part of the electrical connection
  Conduction conduction = {};
};

/// Returns true when the force of the contact law is proportional to the pad's area, so that pad width and length must be
/// known.
[[nodiscard]] inline bool acts_per_area(const ContactModel& model) {
  return std::visit(
      [](const auto& law) {
        return requires { law.per_area; };
      },
      model);
}
/// Returns true when the contact law is adhesive, so that the contact may remain closed without any voltage.
[[nodiscard]] inline bool may_stick(const ContactModel& model) {
  return std::visit(
      [](const auto& law) {
        if constexpr (requires { law.sticks(); }) return law.sticks();
        return requires { law.sticks; };
      },
      model);
}
/// Returns the reason why the contact law cannot act along the pad (ContactDistribution::pad); empty when it can.
[[nodiscard]] inline std::string_view why_not_along_pad(const ContactModel& model) {
  return std::visit(
      [](const auto& law) -> std::string_view {
        if constexpr (requires { law.not_along_pad; }) return law.not_along_pad;
        return {};
      },
      model);
}
/// Returns the largest interference at which the contact law is valid [m]: all asperities are in contact, or for Gaussian
/// heights the contact plane has reached the mean of the summits. Infinite for a spring.
[[nodiscard]] inline double largest_interference(const ContactModel& model) {
  return std::visit(
      [](const auto& law) {
        if constexpr (requires { law.largest_interference(); }) return law.largest_interference();
        return std::numeric_limits<double>::infinity();
      },
      model);
}

}  // namespace softland
