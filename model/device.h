// The described switch, as plain numbers in SI units. A part that is absent is an effect that is not simulated.
// Coordinates: x along the beam from the clamped end; deflection y and every force positive towards the electrode.
#pragma once

#include <array>
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
#include "model/structure/structure.h"

namespace softland {

struct Gap {
  double electrode = 0;  ///< d0, rest distance beam to electrode [m]
  double contact = 0;    ///< dt, rest distance contact point to contact plane [m]
};

/// The contact's side of the moving part, towards which deflections are positive, the other one, or both.
enum class Side { near, far, both };
inline constexpr auto sides = std::to_array<Named<Side>>({{Side::near, "near"}, {Side::far, "far"}, {Side::both, "both"}});
static_assert(is_complete<sides>());

/// A place on the beam, from the clamped end: a distance [m], or a share of the beam's length, which it follows.
struct Place {
  constexpr Place() = default;
  constexpr Place(double distance) : value(distance) {}  // a length is a place
  [[nodiscard]] static constexpr Place share(double of_length) {
    Place place(of_length);
    place.is_share = true;
    return place;
  }
  /// [m]
  [[nodiscard]] constexpr double on(double length) const { return is_share ? value * length : value; }
  [[nodiscard]] bool operator==(const Place&) const = default;

  double value = 0;
  bool is_share = false;
};

/// From where to where something lies along the beam.
struct Span {
  Place begin, end;
  [[nodiscard]] bool operator==(const Span&) const = default;
};

/// The same on a beam of some length [m].
struct Stretch {
  double begin = 0, end = 0;
  [[nodiscard]] bool holds(double x) const { return x >= begin && x < end; }
};

/// One voltage, on one pad or several.
struct Electrode {
  std::string name = {};
  Place begin;  ///< of a plate only the length counts: the electrode's area over the plate's width
  Place end;
  std::vector<Span> further = {};  ///< pads beside that first one
  Fringing fringing = Fringing::meijs_fokkema;
  Side side = Side::near;
  double gap = 0;  ///< far, both: rest distance of the face on the far side to the moving part [m]

  /// All pads on a beam of this length [m].
  [[nodiscard]] std::vector<Stretch> pads(double length) const;
};

/// A piezoelectric layer on the face away from the electrode, as wide as the beam.
struct Piezo {
  Place begin;                                            ///< Lp1
  Place end;                                              ///< Lp2
  double thickness = 0;                                   ///< bp [m]
  double youngs_modulus = 0;                              ///< Ep [Pa]
  double density = 0;                                     ///< [kg/m^3]
  double d31 = 0;                                         ///< [m/V], negative for the usual ceramics
  double e31 = std::numeric_limits<double>::quiet_NaN();  ///< [C/m^2], instead of d31
  /// That of the layer between its electrodes; NaN: it is not known, and the charging of the layer is not counted.
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
  Conductor conductor = Conductor::ideal;  ///< casimir, automatic: of the Casimir law
  double hamaker_constant = 0;             ///< A_h [J]; van_der_waals, automatic
  double equilibrium_distance = 0;         ///< h0 [m], where attraction and repulsion balance; 0: no repulsion
};

enum class SurfaceFaces { all, wide };
inline constexpr auto surface_faces =
    std::to_array<Named<SurfaceFaces>>({{SurfaceFaces::all, "all"}, {SurfaceFaces::wide, "wide"}});
static_assert(is_complete<surface_faces>());

enum class ResidualLoad { none, compression };
inline constexpr auto residual_loads =
    std::to_array<Named<ResidualLoad>>({{ResidualLoad::none, "none"}, {ResidualLoad::compression, "compression"}});
static_assert(is_complete<residual_loads>());

/// Skins of a thin beam: see model/surface.h.
struct Surface {
  double elastic_modulus = 0;  ///< E_s [N/m], of either sign
  double residual_stress = 0;  ///< tau_0 [N/m], positive where the surface pulls
  SurfaceFaces faces = SurfaceFaces::all;
  ResidualLoad cantilever_load = ResidualLoad::none;  ///< what tau_0 does to a cantilever
};

struct Device {
  Structure structure = {};
  Gap gap = {};
  std::vector<Electrode> electrodes = {};
  std::optional<Gas> gas = {};
  std::optional<Contact> contact = {};
  std::optional<Piezo> piezo = {};
  std::optional<Dispersion> dispersion = {};
  std::optional<Surface> surface = {};

  /// x_c, the centre of the pad [m]: the contact force acts and all figures of merit are taken there. The pad ends at the free
  /// end, or lies about the middle of a beam between two clamps. Without contact: the free end, or the middle. Of a contact along
  /// the pad: the free end, which touches first.
  [[nodiscard]] double contact_position() const;
  /// How far the structure rests from the straight shape at x, away from the near electrode [m].
  [[nodiscard]] double rest_offset(double x) const;
  /// Rest distance of the contact point to the contact plane [m]: gap.contact of the straight shape and what the rest shape adds.
  [[nodiscard]] double contact_gap() const { return gap.contact + rest_offset(contact_position()); }
  /// Whether the contact acts along its pad, not at one place.
  [[nodiscard]] bool touches_along_pad() const { return contact && contact->distribution == ContactDistribution::pad; }
  /// Where the pad begins and ends [m]; of a device with a contact.
  [[nodiscard]] std::pair<double, double> pad() const {
    const double end = structure.has_far_clamp() ? (structure.length + contact->pad_length) / 2 : structure.length;
    return {end - contact->pad_length, end};
  }
};

/// An electrode that has no room beside the others, and why.
struct ElectrodeConflict {
  std::size_t electrode = 0;  ///< its number
  std::string why;
};
/// Electrodes on one side of a beam must not overlap, and those on one side of a plate must not have more area together than the
/// plate: the force would count twice. Edges may touch, within rounding. Nothing when all of them fit.
[[nodiscard]] std::optional<ElectrodeConflict> electrode_conflict(const Structure& structure,
                                                                  const std::vector<Electrode>& electrodes);

/// Why this contact cannot act along the pad of this structure; empty when it can.
[[nodiscard]] std::string why_not_along_pad(const Structure& structure, const Contact& contact);

/// Throws InvalidInput naming the quantity, its value and the rule when a number is outside what the model can mean.
void validate(const Device& device);

}  // namespace softland
