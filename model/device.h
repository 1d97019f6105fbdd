// The description of a switch, as plain numbers in SI units. The effect of an absent part is not simulated. Coordinates:
// x along the beam from the clamped end; deflection y and every force positive towards the electrode.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/choice.h"
#include "model/contact/contact.h"
#include "model/forces/fringing.h"
#include "model/gas/gas.h"
#include "model/place.h"
#include "model/structure/structure.h"

namespace softland {

struct Gap {
  double electrode = 0;  ///< d0, rest distance beam to electrode [m]
  double contact = 0;    ///< dt, rest distance of the first contact to its plane; free travel if there is no contact [m]
};

/// The contact of a beam with the face of a dielectric: the pressure of the face on the beam, see model/contact/face.h. The
/// face is a wall when neither a stiffness nor asperities are given.
struct Landing {
  double stiffness = std::numeric_limits<double>::quiet_NaN();  ///< stiffness of an elastic bed on the face, per area [Pa/m]
  double from = 0;                                              ///< height above the face at which the bed begins to press [m]
  std::optional<UniformAsperities> asperities = {};             ///< asperities on the face, without damping

  [[nodiscard]] bool is_wall() const { return std::isnan(stiffness) && !asperities; }
  /// Returns the height above the face at which the pressure begins [m]; for asperities the height of the highest asperity.
  [[nodiscard]] double begin() const { return asperities ? asperities->height : from; }
};

/// An insulator on an electrode, facing the moving part. The gaps of the scene end at the insulator's face; the metal lies
/// deeper.
struct Dielectric {
  double thickness = 0;     ///< [m]
  double permittivity = 1;  ///< relative permittivity
  double roughness = 0;     ///< air gap that remains when the summits of its face touch [m]
  double charge = 0;        ///< charge per area on its face [C/m^2], of either sign
  /// Contact law of the face. A run fails when the moving part reaches a face without this law, unless the moving part is a
  /// plate on a contact at the face.
  std::optional<Landing> landing = {};

  /// Returns the air gap that is electrically equivalent to the dielectric of thickness t, t / eps_r + roughness [m].
  [[nodiscard]] double depth() const { return thickness / permittivity + roughness; }
  /// Returns V0, the voltage of the electrode at which the charge leaves no field in the air, -charge t / (eps_r eps0) [V].
  [[nodiscard]] double neutral_voltage() const;
};

/// An electrode: one or several pads at one voltage.
struct Electrode {
  std::string name = {};
  Place begin;  ///< only the length of the interval matters on a plate: the electrode's area over the plate's width
  Place end;
  std::vector<Span> further = {};  ///< pads besides the first one
  Fringing fringing = Fringing::meijs_fokkema;
  Side side = Side::near;
  double gap = 0;                             ///< rest distance of the face on the far side, for Side::far and Side::both [m]
  std::optional<Dielectric> dielectric = {};  ///< dielectric, on the near side only

  /// Returns all pads on a beam of this length [m].
  [[nodiscard]] std::vector<Stretch> pads(double length) const;
};

/// A piezoelectric layer on the face away from the electrode, as wide as the beam.
struct Piezo {
  Place begin;                                            ///< Lp1, begin along the beam
  Place end;                                              ///< Lp2, end along the beam
  double thickness = 0;                                   ///< bp [m]
  double youngs_modulus = 0;                              ///< Ep [Pa]
  double density = 0;                                     ///< [kg/m^3]
  double d31 = 0;                                         ///< [m/V], negative for the usual ceramics
  double e31 = std::numeric_limits<double>::quiet_NaN();  ///< [C/m^2], given instead of d31
  /// Relative permittivity of the layer between its electrodes; NaN: the charging of the layer is neglected.
  double relative_permittivity = std::numeric_limits<double>::quiet_NaN();
};

enum class DispersionModel { casimir, van_der_waals, automatic };
inline constexpr auto dispersion_models =
    std::to_array<Named<DispersionModel>>({{DispersionModel::casimir, "casimir"},
                                           {DispersionModel::van_der_waals, "van-der-waals"},
                                           {DispersionModel::automatic, "auto"}});
static_assert(is_complete<dispersion_models>());

enum class Conductor { ideal, gold };
inline constexpr auto conductors = std::to_array<Named<Conductor>>({{Conductor::ideal, "ideal"}, {Conductor::gold, "gold"}});
static_assert(is_complete<conductors>());

/// Casimir and van der Waals forces between beam and electrode plane, over the whole length.
struct Dispersion {
  DispersionModel model = DispersionModel::automatic;
  Conductor conductor = Conductor::ideal;  ///< conductor of the Casimir law; used by models casimir, automatic
  double hamaker_constant = 0;             ///< A_h [J]; used by models van_der_waals, automatic
  double equilibrium_distance = 0;         ///< h0 [m], at which attraction and repulsion balance; 0: no repulsion
};

enum class SurfaceFaces { all, wide };
inline constexpr auto surface_faces =
    std::to_array<Named<SurfaceFaces>>({{SurfaceFaces::all, "all"}, {SurfaceFaces::wide, "wide"}});
static_assert(is_complete<surface_faces>());

enum class ResidualLoad { none, compression };
inline constexpr auto residual_loads =
    std::to_array<Named<ResidualLoad>>({{ResidualLoad::none, "none"}, {ResidualLoad::compression, "compression"}});
static_assert(is_complete<residual_loads>());

/// Elastic skins at the surfaces of a thin beam: see model/surface.h.
struct Surface {
  double elastic_modulus = 0;  ///< E_s [N/m], of either sign
  double residual_stress = 0;  ///< tau_0 [N/m], positive where the surface pulls
  SurfaceFaces faces = SurfaceFaces::all;
  ResidualLoad cantilever_load = ResidualLoad::none;  ///< effect of tau_0 on a cantilever
};

/// The rule by which the connection, the signal path through the contacts, counts as electrically closed. The rule has no
/// effect when no number is given.
struct ElectricalClosing {
  double force = std::numeric_limits<double>::quiet_NaN();       ///< the contact force must exceed this [N]; NaN: no bound
  double resistance = std::numeric_limits<double>::quiet_NaN();  ///< the resistance must be below this [Ohm]; NaN: no bound
  double after = std::numeric_limits<double>::quiet_NaN();       ///< openings that are not longer than this do not count [s]

  [[nodiscard]] bool is_asked() const { return force >= 0 || resistance > 0 || after >= 0; }
  [[nodiscard]] double shortest_opening() const { return after >= 0 ? after : 0; }
};

/// The circuit that the contacts close: a voltage source and a resistance in series with the contacts.
struct SwitchedLoad {
  double voltage = std::numeric_limits<double>::quiet_NaN();     ///< [V]
  double resistance = std::numeric_limits<double>::quiet_NaN();  ///< [Ohm]

  [[nodiscard]] bool is_given() const { return voltage > 0 && resistance > 0; }
};

struct Device {
  Structure structure = {};
  Gap gap = {};
  std::vector<Electrode> electrodes = {};
  std::optional<Gas> gas = {};
  std::vector<Contact> contacts = {};  ///< the first one, on the near side, closes the switch; back stops come after all others
  Connection connection = Connection::all;
  ElectricalClosing electrical = {};
  SwitchedLoad load = {};
  std::optional<Piezo> piezo = {};
  std::optional<Dispersion> dispersion = {};
  std::optional<Surface> surface = {};

  [[nodiscard]] bool has_contact() const { return !contacts.empty(); }
  /// Returns true when the resistance of the connection is known: every contact of the connection has a resistivity.
  [[nodiscard]] bool conducts() const {
    return has_contact() &&
           std::ranges::all_of(contacts, [](const Contact& c) { return !c.connects || c.conduction.is_given(); });
  }
  /// Returns x_c, the centre of the pad of a contact [m]: the contact force acts there, and figures of merit are taken at x_c
  /// of the first contact. A pad without a given place ends at the free end, or lies about the middle of a beam between two
  /// clamps. Without contact x_c is the free end, or the middle. For a contact along the pad x_c is the free end, which touches
  /// first.
  [[nodiscard]] double contact_position(std::size_t contact = 0) const;
  /// Returns the distance at which the structure rests from the straight shape at x, away from the near electrode [m].
  [[nodiscard]] double rest_offset(double x) const;
  /// Returns the distance of a contact at rest to its plane [m]: the gap of the straight shape plus the offset of the rest
  /// shape.
  [[nodiscard]] double contact_gap(std::size_t contact = 0) const;
  /// Returns the contact law of the dielectrics' faces, which all dielectrics with a `landing` share; null when none has one.
  [[nodiscard]] const Landing* landing() const;
  /// Returns the number of the contact along the face of the electrodes' dielectric; none when no dielectric has a landing.
  [[nodiscard]] std::optional<std::size_t> face_contact() const;
  [[nodiscard]] bool lands_along_face() const { return face_contact().has_value(); }
  /// Returns true when the moving part closes onto the dielectric of its electrodes, to within a hundredth of the electrode's
  /// gap.
  [[nodiscard]] bool lands_on_dielectric() const { return lands_along_face() || gap.contact > 0.99 * gap.electrode; }
  /// Returns the local gap between a closed switch and the face of its electrode, for the laws of gas films [m]. The gap is at
  /// least a hundredth of the rest gap: below this the film laws are continued by a tangent.
  [[nodiscard]] double closed_gap() const { return std::max(gap.electrode - gap.contact, gap.electrode / 100); }
  /// Returns the least Dielectric::depth() of the electrodes on the near side [m]; 0 when an electrode has no dielectric.
  [[nodiscard]] double dielectric_depth() const;
  /// Returns true when there is a charge on the dielectric of an electrode.
  [[nodiscard]] bool is_charged() const;
  /// Returns true when the contact acts along its pad, not at a single point.
  [[nodiscard]] bool touches_along_pad() const {
    return has_contact() && contacts.front().distribution == ContactDistribution::pad;
  }
  /// Returns begin and end of the pad of the first contact [m]; the device must have a contact.
  [[nodiscard]] std::pair<double, double> pad() const {
    const Contact& first = contacts.front();
    if (first.at) return {contact_position() - first.pad_length / 2, contact_position() + first.pad_length / 2};
    const double end = structure.has_far_clamp() ? (structure.length + first.pad_length) / 2 : structure.length;
    return {end - first.pad_length, end};
  }
};

/// An electrode that overlaps other electrodes, and the reason for the conflict.
struct ElectrodeConflict {
  std::size_t electrode = 0;  ///< number of the electrode
  std::string why;
};
/// Returns a conflict of electrodes; none when all electrodes fit. Electrodes on one side of a beam must not overlap.
/// Electrodes on one side of a plate must not have more area together than the plate: the force would count twice. Edges may
/// touch, within rounding.
[[nodiscard]] std::optional<ElectrodeConflict> electrode_conflict(const Structure& structure,
                                                                  const std::vector<Electrode>& electrodes);

/// A contact that the device cannot have together with its other contacts, and the reason.
struct ContactConflict {
  std::size_t contact = 0;  ///< number of the contact
  std::string why;
};
/// Returns a conflict of contacts; none when all contacts fit. The first contact must be on the near side, two contacts on one
/// side must differ in place or gap, and a rigid contact or a contact along its pad must be the only contact.
[[nodiscard]] std::optional<ContactConflict> contact_conflict(const Device& device);

/// Returns true when the `landing` of both electrodes' dielectrics has equal parameters, or neither has a `landing`.
[[nodiscard]] bool have_equal_landings(const Electrode& one, const Electrode& other);
inline constexpr auto unequal_landings = "where a dielectric has a landing, every near electrode has the same one";

/// Name of the contact along the face of a dielectric, for a device that has other contacts.
inline constexpr std::string_view face_name = "dielectric";

/// Adds the face of the dielectric as a contact to a device whose dielectric has a `landing`. The contact's plane and place are
/// where a beam that bends under its electrodes touches first. When the device has a contact on the near side, the face comes
/// last and is not part of the connection; otherwise the face comes first and makes the connection. A repeated call updates the
/// contact after a change of the landing. Without a `landing` nothing changes.
void set_face_contact(Device& device);

/// Returns the reason why a device whose contact lies at its electrode cannot close onto the electrode; empty when it can.
[[nodiscard]] std::string why_no_landing(const Device& device);

/// Returns the reason why this contact cannot act along the pad of this structure; empty when it can.
[[nodiscard]] std::string why_not_along_pad(const Structure& structure, const Contact& contact);

/// Throws InvalidInput naming the quantity, its value and the rule when a number is outside the range of the model.
void validate(const Device& device);

}  // namespace softland
