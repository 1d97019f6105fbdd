// The description of a switch, as plain numbers in SI units. A part that the description leaves out, such as gas or a piezo
// layer, has no effect in a simulation. Coordinates: x along the beam from the clamped end; deflection y and every force
// positive towards the electrode.
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
  double electrode = 0;  ///< distance between straight beam and near electrode at rest [m]
  /// Distance between the straight beam and the plane of the first contact at rest; without a contact, the deflection at which
  /// a run ends [m].
  double contact = 0;
};

/// The contact of a beam with the face of a dielectric: the pressure of the face on the beam, see model/contact/face.h. The
/// face is a rigid wall when neither a stiffness nor asperities are given.
struct Landing {
  /// Stiffness of an elastic bed on the dielectric's face, per area [Pa/m]; NaN: not given.
  double stiffness = std::numeric_limits<double>::quiet_NaN();
  double from = 0;  ///< height above the dielectric's face at which the elastic bed begins to press [m]
  std::optional<UniformAsperities> asperities = {};  ///< asperities on the dielectric's face, without damping

  [[nodiscard]] bool is_wall() const { return std::isnan(stiffness) && !asperities; }
  /// Returns the height above the dielectric's face at which the pressure on the beam begins [m]; for asperities the height of
  /// the highest asperity.
  [[nodiscard]] double begin() const { return asperities ? asperities->height : from; }
};

/// An insulator on an electrode, facing the moving part. Gaps are measured to the face of the insulator; the electrode's metal
/// lies deeper.
struct Dielectric {
  double thickness = 0;     ///< thickness of the dielectric [m]
  double permittivity = 1;  ///< relative permittivity of the dielectric
  double roughness = 0;     ///< air gap that remains, by roughness, when the moving part touches the face [m]
  double charge = 0;        ///< charge per area on the dielectric's face [C/m^2], of either sign
  /// Contact law of the dielectric's face. A run fails when the moving part reaches a face without this law, unless the moving
  /// part is a plate on a contact at the face.
  std::optional<Landing> landing = {};

  /// Returns the air gap that is electrically equivalent to the dielectric: thickness / permittivity + roughness [m].
  [[nodiscard]] double depth() const { return thickness / permittivity + roughness; }
  /// Returns the voltage of the electrode at which the charge on the dielectric leaves no field in the air: -charge thickness /
  /// (permittivity eps0) [V].
  [[nodiscard]] double neutral_voltage() const;
};

/// An electrode: one or several pads at one voltage.
struct Electrode {
  std::string name = {};
  /// Begin and end of the first pad along a beam. For a plate only end - begin counts: the area of the electrode over the width
  /// of the plate.
  Place begin;
  Place end;
  std::vector<Span> further = {};  ///< pads of the electrode besides the first pad
  Fringing fringing = Fringing::meijs_fokkema;
  Side side = Side::near;
  /// Distance of the moving part at rest from the electrode's face on the far side [m], for Side::far and Side::both.
  double gap = 0;
  std::optional<Dielectric> dielectric = {};  ///< dielectric on the electrode, on the near side only

  /// Returns all pads of the electrode on a beam of this length [m].
  [[nodiscard]] std::vector<Stretch> pads(double length) const;
};

/// A piezoelectric layer on the beam's face away from the electrode, as wide as the beam.
struct Piezo {
  Place begin;                ///< begin of the piezo layer along the beam
  Place end;                  ///< end of the piezo layer along the beam
  double thickness = 0;       ///< thickness of the piezo layer [m]
  double youngs_modulus = 0;  ///< Young's modulus of the piezo layer [Pa]
  double density = 0;         ///< density of the piezo layer [kg/m^3]
  double d31 = 0;             ///< piezoelectric strain constant [m/V], negative for the usual ceramics
  double e31 = std::numeric_limits<double>::quiet_NaN();  ///< piezoelectric stress constant [C/m^2], given instead of d31
  /// Relative permittivity of the piezo layer between its electrodes; NaN: the charging of the layer is neglected.
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
  Conductor conductor = Conductor::ideal;  ///< conductor of the Casimir law; used by the models casimir and automatic
  double hamaker_constant = 0;             ///< Hamaker constant [J]; used by the models van_der_waals and automatic
  double equilibrium_distance = 0;         ///< distance at which attraction and repulsion balance [m]; 0: no repulsion
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
  double elastic_modulus = 0;  ///< elastic modulus of the surface skins [N/m], of either sign
  double residual_stress = 0;  ///< residual surface stress [N/m], positive in tension
  SurfaceFaces faces = SurfaceFaces::all;
  ResidualLoad cantilever_load = ResidualLoad::none;  ///< effect of the residual surface stress on a cantilever
};

/// The conditions for the electrical connection (the signal path through the contacts) to count as closed. Without bounds of
/// force and resistance the connection is closed while its contacts touch.
struct ElectricalClosing {
  /// Contact force above which the connection counts as closed [N]; NaN: no bound.
  double force = std::numeric_limits<double>::quiet_NaN();
  /// Resistance below which the connection counts as closed [Ohm]; NaN: no bound.
  double resistance = std::numeric_limits<double>::quiet_NaN();
  /// Electrical openings of at most this duration do not count [s]; NaN: every opening counts.
  double after = std::numeric_limits<double>::quiet_NaN();

  [[nodiscard]] bool is_asked() const { return force >= 0 || resistance > 0 || after >= 0; }
  [[nodiscard]] double shortest_opening() const { return after >= 0 ? after : 0; }
};

/// The circuit that the contacts close: a voltage source and a resistor in series with the contacts.
struct SwitchedLoad {
  double voltage = std::numeric_limits<double>::quiet_NaN();  ///< voltage of the source [V]; NaN: not given
  /// Resistance in series with the contacts [Ohm]; NaN: not given.
  double resistance = std::numeric_limits<double>::quiet_NaN();

  [[nodiscard]] bool is_given() const { return voltage > 0 && resistance > 0; }
};

struct Device {
  Structure structure = {};
  Gap gap = {};
  std::vector<Electrode> electrodes = {};
  std::optional<Gas> gas = {};
  std::vector<Contact> contacts = {};  ///< contacts of the switch: the first, on the near side, closes it; back stops come last
  Connection connection = Connection::all;
  ElectricalClosing electrical = {};
  SwitchedLoad load = {};
  std::optional<Piezo> piezo = {};
  std::optional<Dispersion> dispersion = {};
  std::optional<Surface> surface = {};

  [[nodiscard]] bool has_contact() const { return !contacts.empty(); }
  /// Returns true when the resistance of the electrical connection is known: every contact of the connection has a resistivity.
  [[nodiscard]] bool conducts() const {
    return has_contact() &&
           std::ranges::all_of(contacts, [](const Contact& c) { return !c.connects || c.conduction.is_given(); });
  }
  /// Returns the position along the beam at which a contact force acts, the centre of the contact's pad [m]. Figures of merit
  /// are taken at the position of the first contact. A pad without a given place ends at the free end, or lies about the middle
  /// of a beam between two clamps. Without contact the position is the free end, or the middle. For a contact along the pad it
  /// is the free end, which touches first.
  [[nodiscard]] double contact_position(std::size_t contact = 0) const;
  /// Returns the distance of the structure at rest from its straight shape at x, away from the near electrode [m].
  [[nodiscard]] double rest_offset(double x) const;
  /// Returns the distance of the contact point from the contact plane at rest [m]: the gap of the straight shape plus the
  /// offset of the rest shape.
  [[nodiscard]] double contact_gap(std::size_t contact = 0) const;
  /// Returns the contact law of the dielectrics' faces, which is the same for all dielectrics with a `landing`; null when none
  /// has one.
  [[nodiscard]] const Landing* landing() const;
  /// Returns the index of the contact along the face of the electrodes' dielectric; none when no dielectric has a landing.
  [[nodiscard]] std::optional<std::size_t> face_contact() const;
  [[nodiscard]] bool closes_along_face() const { return face_contact().has_value(); }
  /// Returns true when the moving part closes onto the dielectric of its electrodes, to within a hundredth of the electrode's
  /// gap.
  [[nodiscard]] bool closes_on_dielectric() const { return closes_along_face() || gap.contact > 0.99 * gap.electrode; }
  /// Returns the local gap between a closed switch and the face of its electrode, for the laws of gas films [m]. The gap is at
  /// least a hundredth of the rest gap, below which the film laws are continued by their tangent.
  [[nodiscard]] double closed_gap() const { return std::max(gap.electrode - gap.contact, gap.electrode / 100); }
  /// Returns the least Dielectric::depth(), the air gap equivalent to a dielectric, of the electrodes on the near side [m]; 0
  /// when an electrode has no dielectric.
  [[nodiscard]] double dielectric_depth() const;
  /// Returns true when there is a charge on the dielectric of an electrode.
  [[nodiscard]] bool is_charged() const;
  /// Returns true when the contact force is distributed along the contact's pad and does not act at a single point.
  [[nodiscard]] bool touches_along_pad() const {
    return has_contact() && contacts.front().distribution == ContactDistribution::pad;
  }
  /// Returns begin and end of the pad of the first contact along the beam [m]; the device must have a contact.
  [[nodiscard]] std::pair<double, double> pad() const {
    const Contact& first = contacts.front();
    if (first.at) return {contact_position() - first.pad_length / 2, contact_position() + first.pad_length / 2};
    const double end = structure.has_far_clamp() ? (structure.length + first.pad_length) / 2 : structure.length;
    return {end - first.pad_length, end};
  }
};

/// An electrode that overlaps other electrodes, and the reason for the conflict.
struct ElectrodeConflict {
  std::size_t electrode = 0;  ///< index of the conflicting electrode
  std::string why;
};
/// Returns a conflict of electrodes; none when all electrodes fit. Electrodes on one side of a beam must not overlap.
/// Electrodes on one side of a plate must not have more area together than the plate: the force would count twice. Edges may
/// touch, within rounding.
[[nodiscard]] std::optional<ElectrodeConflict> electrode_conflict(const Structure& structure,
                                                                  const std::vector<Electrode>& electrodes);

/// A contact that a device cannot have together with its other contacts, and the reason.
struct ContactConflict {
  std::size_t contact = 0;  ///< index of the conflicting contact
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

/// Returns the reason why a device whose contact plane is at its electrode cannot close onto the electrode; empty when the
/// device can.
[[nodiscard]] std::string why_no_landing(const Device& device);

/// Returns the reason why this contact cannot act along the pad of this structure; empty when it can.
[[nodiscard]] std::string why_not_along_pad(const Structure& structure, const Contact& contact);

/// Checks the numbers of a device. Throws InvalidInput with the quantity, its value and the rule when a number is outside the
/// range of the model.
void validate(const Device& device);

}  // namespace softland
