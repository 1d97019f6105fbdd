// The switch as a system of ordinary differential equations in modal coordinates.
//
//   q_i'' = -omega_i^2 q_i - 2 zeta omega_i q_i' + V_piezo theta_i + sum over points p of w_p phi_i(x_p) f(x_p)
//           - phi_i(x_c) P(d) + Q_i(q)
//
// q are modal coordinates [m kg^(1/2)], phi mass-normalised modes [kg^(-1/2)], f is the load per length of all distributed laws
// [N/m], w are quadrature weights [m], theta_i = M_p [phi_i'(Lp2) - phi_i'(Lp1)] with M_p the piezo moment per volt, P is the
// contact force [N], d the interference [m], Q the force of stretching (model/stretching.h). The deflection is y(x) = sum
// phi_i(x) q_i, positive towards the electrode. It is a Galerkin projection on Gauss panels that start and end where an
// electrode, the piezo layer or a pad that acts along its length does. Only the laws that the device has are included, so that
// an absent effect costs no time. A rigid plate is a strip that stays flat: one mode, one quadrature point per panel.
//
// A charge per area sigma lies on the face of an electrode's dielectric. With E in the air and E_d in the dielectric, Gauss'
// law gives eps0 E = eps_r eps0 E_d + sigma, and V = E (h + h_r) + E_d t, so that
//
//   E = (V - V0) / (h + t / eps_r + h_r),   V0 = -sigma t / (eps_r eps0)
//
// The electrode pulls as if its voltage were V - V0. The fringing field is taken to scale with V - V0. C (V - V0) is the charge
// on the electrode up to a constant, which does not flow through a source.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <concepts>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "model/contact/contact_state.h"
#include "model/device.h"
#include "model/distributed_law.h"
#include "model/modal_basis.h"
#include "model/point_quadrature.h"
#include "model/stretching.h"

namespace softland {

struct ContactLaw;    // defined in model/contact/contact_law.h
struct GasLaw;        // defined in model/gas/gas_law.h
class PadQuadrature;  // defined in model/contact/pad.h
class ReynoldsFilm;   // defined in model/gas/reynolds_film.h

struct SwitchOptions {
  double points_per_length = 24;  ///< number of quadrature points over a beam's length
  /// Least number of quadrature points of a panel. A study of accuracy increases this number and points_per_length.
  int points_per_panel = 3;
  /// Number of modes of a beam, which replaces the number in the device's structure: at most most_static_modes. A number above
  /// most_modes is for statics only.
  std::optional<int> modes = {};
};

/// The states of all contact laws of a switch: either one state for each contact, or a state for the first contact alone. Every
/// other contact is then in first loading, and acts within contact_reach() of its plane and beyond the plane.
struct ContactStates {
  ContactStates(const ContactState& first_one) : first(first_one) {}  // NOLINT: implicit, since most switches have one contact
  ContactStates(std::same_as<bool> auto acts) : first(acts) {}        // NOLINT: implicit; most laws only act or do not act
  ContactStates(const ContactState& first_one, std::span<const ContactState> others) : first(first_one), further(others) {}

  ContactState first;
  std::span<const ContactState> further = {};
};

enum class DriveKind { electrode, dispersion, piezo };

class Switch {
 public:
  /// Builds the switch from a device. Throws InvalidInput for a device that validate() refuses. The constructor reuses
  /// normalised modes and quadrature of the switch `like` when they are the same, and otherwise starts from the modes of
  /// `like`: the result is the same up to rounding, and faster to build.
  explicit Switch(const Device& device, const SwitchOptions& options = {}, const Switch* like = nullptr);

  [[nodiscard]] const Device& device() const { return device_; }
  /// Returns the modes of the structure without electric and other forces.
  [[nodiscard]] const ModalBasis& basis() const { return basis_; }
  /// Returns the quadrature points at which the distributed force laws act.
  [[nodiscard]] const PointQuadrature& quadrature() const { return quadrature_; }
  [[nodiscard]] int modes() const { return basis_.modes(); }
  /// Returns the number of drives: the electrodes in order, then the dispersion force, then the piezo, if the device has them.
  /// The values of electrodes and piezo are voltages [V]; that of the dispersion force is its factor minus 1.
  [[nodiscard]] std::size_t drives() const { return driven_laws_.size() + (device_.piezo ? 1 : 0); }
  [[nodiscard]] DriveKind drive_kind(std::size_t drive) const {
    if (drive < electrodes_) return DriveKind::electrode;
    return drive < driven_laws_.size() ? DriveKind::dispersion : DriveKind::piezo;
  }
  /// Returns the neutral voltage V0 [V], at which an electrode does not pull; it is not 0 when the dielectric of the electrode
  /// is charged. Returns 0 for the other drives.
  [[nodiscard]] double neutral_voltage(std::size_t drive) const { return drive < electrodes_ ? neutral_voltages_[drive] : 0; }
  /// Returns the factor by which this value of the drive scales its force law: (V - V0)^2 for an electrode of neutral voltage
  /// V0, or the force factor.
  [[nodiscard]] double strength(std::size_t drive, double value) const {
    if (drive >= electrodes_) return 1 + value;
    const double acting = value - neutral_voltages_[drive];
    return acting * acting;
  }
  /// Returns the derivative of strength() with respect to the drive's value: 2 (V - V0) for an electrode of neutral voltage V0,
  /// otherwise 1.
  [[nodiscard]] double strength_slope(std::size_t drive, double value) const {
    return drive < electrodes_ ? 2 * (value - neutral_voltages_[drive]) : 1;
  }
  /// Returns the value of the drive with this strength(); for an electrode the voltage that is not below its neutral voltage.
  [[nodiscard]] double value_of_strength(std::size_t drive, double strength) const {
    return drive < electrodes_ ? neutral_voltages_[drive] + std::sqrt(strength) : strength - 1;
  }
  [[nodiscard]] bool has_piezo() const { return device_.piezo.has_value(); }
  [[nodiscard]] bool has_contact() const { return contact_ != nullptr; }
  /// Returns the number of contacts. Functions without the number of a contact concern the first contact, which closes the
  /// switch.
  [[nodiscard]] std::size_t contacts() const { return contact_ ? 1 + further_.size() : 0; }
  [[nodiscard]] const ContactLaw& contact(std::size_t c = 0) const { return c == 0 ? *contact_ : *further_[c - 1].law; }
  /// Returns the height above the plane of first touch at which the contact law begins to act [m]; 0 for most laws, and without
  /// contact.
  [[nodiscard]] double contact_reach(std::size_t c = 0) const;
  /// Returns true when the contact acts along its pad or along the face of a dielectric. The law of such a contact is active at
  /// all times: the force acts at every point of the pad or face that is beyond the contact plane.
  [[nodiscard]] bool has_spread_contact(std::size_t c = 0) const { return c == face_at_ || (c == 0 && pad_ != nullptr); }
  /// Returns the state of a contact before its first touch: the contact acts only within the reach of its law.
  [[nodiscard]] ContactState untouched(const double* q) const {
    const double reach = contact_reach();
    return has_spread_contact() || (reach > 0 && contact_deflection(q) > contact_gap_ - reach);
  }
  /// Returns the law of a rigid contact; null when the contact is not rigid.
  [[nodiscard]] const RigidContact* rigid_contact() const;
  /// Returns the gas law; null without gas.
  [[nodiscard]] const GasLaw* gas() const { return gas_.get(); }
  [[nodiscard]] const std::optional<MidPlaneStretching>& stretching() const { return stretching_; }
  /// Returns the distance of contact point c from its contact plane at rest [m].
  [[nodiscard]] double contact_gap(std::size_t c = 0) const { return c == 0 ? contact_gap_ : further_[c - 1].gap; }
  /// Returns the gap below which every law is continued by its tangent and a run counts as having touched the electrode [m]: a
  /// hundredth of the gap d0 at rest. The gap is negative, below the face, for a switch that closes on a dielectric: minus half
  /// of Dielectric::depth(), or minus d0 for a rigid face (wall), which no beam passes. The laws of a film are continued from a
  /// hundredth of d0 in any case.
  [[nodiscard]] double gap_floor() const {
    if (const Landing* landing = device_.landing(); landing != nullptr && landing->is_wall()) return -device_.gap.electrode;
    return device_.closes_on_dielectric() ? -device_.dielectric_depth() / 2 : device_.gap.electrode / 100;
  }
  /// Returns the interference at which the contact law carries the force that bends the beam by the contact gap [m]: the scale
  /// of penetration.
  [[nodiscard]] double penetration_scale() const { return penetration_scale_; }

  /// Scratch memory of one run: a Switch is shared between threads, a Workspace is not.
  struct Workspace {
    GapField field;
    Eigen::ArrayXd load, by_deflection, by_velocity;
  };
  [[nodiscard]] Workspace workspace() const;

  /// Returns the number of states of a compressible gas film, its pressures (model/gas/reynolds_film.h), which follow the modal
  /// coordinates and velocities and are 0 at rest; 0 for other gas laws.
  [[nodiscard]] std::size_t film_states() const;
  /// Returns a scale for the gas film's pressure states, for error weights: the uniform film pressure that bends the beam by
  /// the contact gap, over the ambient pressure.
  [[nodiscard]] double film_scale() const;

  /// Computes modal accelerations [m kg^(1/2) / s^2] for modal coordinates q, velocities v and drive voltages [V]; arrays of
  /// modes() doubles. `film` are the pressures of a compressible gas film; null stands for a film at rest.
  void accelerations(const double* q, const double* v, std::span<const double> volts, const ContactStates& contacts,
                     Workspace& work, double* result, const double* film = nullptr) const;
  /// Computes the time derivatives of a state (modal coordinates q, velocities v, film pressures) except q', which is v: the
  /// accelerations, then the rates of the film pressures.
  void rates(const double* state, std::span<const double> volts, const ContactStates& contacts, Workspace& work,
             double* result) const;
  /// Computes the modal forces of the drives at unit strength (of the piezo: per volt), modes x drives, in the gap field that
  /// was last computed with `work`. Overwrites the load in `work`.
  void drive_forces(Workspace& work, Eigen::Ref<Eigen::MatrixXd> by_strength) const;
  /// Computes the derivatives of the modal accelerations with respect to modal coordinates q and velocities v: modes x modes
  /// each.
  void jacobian(const double* q, const double* v, std::span<const double> volts, const ContactStates& contacts, Workspace& work,
                Eigen::Ref<Eigen::MatrixXd> by_q, Eigen::Ref<Eigen::MatrixXd> by_v) const;
  /// Adds the contribution of a compressible gas film to the derivatives of (q', rates()) by the state (q, v, film); `work` has
  /// the gap field of this state.
  void add_film_derivatives(const double* state, const Workspace& work, Eigen::Ref<Eigen::MatrixXd> derivatives) const;

  /// Modal accelerations, with derivatives, of the motion before the first touch, in which no contact and no compressible film
  /// acts. The accelerations are linear in the strengths of the drives (strength() of an electrode, the factor of the
  /// dispersion force, V of the piezo).
  struct FreeMotion {
    Eigen::VectorXd accelerations;  ///< modal accelerations [m kg^(1/2) / s^2]
    Eigen::MatrixXd by_q, by_v;     ///< derivatives by modal coordinates and velocities, modes x modes
    Eigen::MatrixXd by_strength;    ///< derivatives of the modal accelerations by the strengths of the drives, modes x drives
  };
  [[nodiscard]] FreeMotion free_motion(const double* q, const double* v, std::span<const double> strengths,
                                       Workspace& work) const;
  /// Returns second derivatives of the sum over modes of multiplier_i q_i'' in the motion before the first touch, by (q, v,
  /// strengths), the modal coordinates, velocities and strengths of the drives: symmetric, 2 modes + drives rows. They are
  /// exact, also below the gaps at which laws are continued by their tangents: loads are linear in the velocity.
  [[nodiscard]] Eigen::MatrixXd free_motion_curvature(const double* q, const double* v, std::span<const double> strengths,
                                                      const double* multipliers, Workspace& work) const;

  /// Returns the deflection of contact c [m] from modal coordinates q, or its velocity [m/s] from modal velocities, positive
  /// towards its plane.
  [[nodiscard]] double contact_deflection(const double* q, std::size_t c = 0) const {
    return c == 0 ? basis_.contact_deflection(q) : basis_.at(q).dot(further_[c - 1].shape);
  }
  /// Returns the mode shapes phi_i at a contact [kg^(-1/2)], positive towards the plane of the contact.
  [[nodiscard]] const Eigen::VectorXd& contact_shape(std::size_t c = 0) const {
    return c == 0 ? basis_.contact_shape() : further_[c - 1].shape;
  }
  /// Returns the smallest gap along the beam in the gap field last computed with `work` [m].
  [[nodiscard]] static double smallest_gap(const Workspace& work) { return work.field.smallest_gap; }
  /// Returns true when the beam is within a hundredth of the gap at rest of an electrode or a gas film's wall on the far side,
  /// in the gap field last computed with `work`.
  [[nodiscard]] bool at_far_side(const Workspace& work) const {
    return std::isfinite(most_gap_) && work.field.gap.head(quadrature_.points()).maxCoeff() > most_gap_;
  }

  /// Returns the stable static equilibrium with all drives at 0, modal coordinates [m kg^(1/2)]. Returns none when the beam
  /// collapses by itself, by the dispersion force or the charge on a dielectric, or rests on the contact plane.
  [[nodiscard]] const std::optional<Eigen::VectorXd>& rest() const { return rest_; }
  /// Returns the open equilibrium under these values of all drives, in modal coordinates, reached from the straight beam as the
  /// values grow from 0; a run starts from this equilibrium.
  [[nodiscard]] std::optional<Eigen::VectorXd> open_equilibrium(std::span<const double> values) const;
  /// Returns the capacitance of a drive, the derivative of its charge by its voltage [F]; 0 unless the drive is an electrode.
  [[nodiscard]] double capacitance(std::size_t drive, const double* q, Workspace& work) const;
  /// Returns the potential energy of a drive's force law at unit strength [J]; 0 for the piezo.
  [[nodiscard]] double law_potential(std::size_t drive, const double* q, Workspace& work) const;
  /// Returns minus the derivative of potential() with respect to the drive's value: for an electrode its charge less the charge
  /// at its neutral voltage, for the piezo its charge [C]; for the dispersion force minus the potential of its law [J].
  [[nodiscard]] double charge(std::size_t drive, double value, const double* q, Workspace& work) const;
  /// Elastic energy of the beam, without piezo coupling and contact [J].
  [[nodiscard]] double elastic_energy(const double* q) const;
  /// Returns true when the motion always loses energy: by gas, modal damping, or a contact law that depends on the rate.
  [[nodiscard]] bool damped() const {
    return !passive_laws_.empty() || film_ || device_.structure.damping_ratio > 0 || has_damped_contact();
  }
  [[nodiscard]] bool has_damped_contact() const;
  /// Returns the power dissipated by gas and modal damping [W]; without `film` a compressible gas film is taken as at rest.
  [[nodiscard]] double dissipated_power(const double* q, const double* v, Workspace& work, const double* film = nullptr) const;
  /// Returns the power dissipated by gas and modal damping in the gap field last computed with `work`, for modal velocities `v`
  /// [W].
  [[nodiscard]] double dissipated_power(const double* v, Workspace& work, const double* film = nullptr) const;
  /// Returns the energy stored in a compressible gas film in a state (modal coordinates, velocities, film pressures) [J]; 0
  /// without such a film.
  [[nodiscard]] double film_energy(const double* state, Workspace& work) const;
  /// Returns the force of a contact on the beam [N] in a state in which the contact law acts; the next functions return its
  /// stored energy [J] and dissipated power [W].
  [[nodiscard]] double contact_push(const double* q, const double* v, const ContactState& contact, std::size_t c = 0) const;
  [[nodiscard]] double contact_stored(const double* q, const ContactState& contact, std::size_t c = 0) const;
  [[nodiscard]] double contact_dissipation(const double* q, const double* v, std::size_t c = 0) const;
  /// Returns the energy that bends the beam by the contact gap at the contact point [J]: the scale of a closing's energies.
  [[nodiscard]] double bending_energy() const { return bending_energy_; }
  /// Returns the energy of the switch with its sources at constant voltages: elastic + contact + dispersion - 1/2 C (V - V0)^2
  /// of the electrodes - V times charge of the piezo [J]. The gradient is minus the static force.
  [[nodiscard]] double potential(const double* q, std::span<const double> volts, const ContactStates& contacts,
                                 Workspace& work) const;

 private:
  /// Computes modal basis and quadrature from the modes of the structure.
  template <class Modes>
  void set_modes(const Modes& structure, double points_per_length, int fewest_points, const Switch* like);
  /// Calls f(xi, share, interference) for every point at which the first contact acts. The distance from the contact point
  /// towards the clamp is xi [m]; `share` is the quadrature weight over the pad (1 for a contact at one point).
  template <class F>
  void for_contact_points(const double* q, F&& f) const;
  /// Returns the velocity of the first contact's pad towards the contact plane, at the distance xi from the contact point
  /// [m/s].
  [[nodiscard]] double contact_rate(const double* v, double xi) const;
  /// A contact of the switch after the first one.
  struct FurtherContact {
    std::shared_ptr<const ContactLaw> law;
    Eigen::VectorXd shape;  // mode shapes at the contact, positive towards the contact plane [kg^(-1/2)]
    double gap = 0;         // distance of the contact point from its contact plane at rest [m]
  };
  /// Calls f(contact, state, interference) for every contact after the first one whose law acts.
  template <class F>
  void for_further_contacts(const double* q, const ContactStates& contacts, F&& f) const;
  [[nodiscard]] bool face_acts(const ContactStates& contacts) const {
    if (face_ == nullptr || face_at_ == 0) return face_ != nullptr && contacts.first.active;
    return contacts.further.empty() || contacts.further[face_at_ - 1].active;
  }
  void add_pad_force(const double* q, const double* v, double* result) const;
  [[nodiscard]] double penetration_under(double force) const;
  /// Returns the pressure of the faces of the electrodes' dielectrics on the beam, which is the law of the contact along the
  /// face.
  [[nodiscard]] std::shared_ptr<const DistributedLaw> face_pressure() const;
  /// Returns the gap field (gap and velocity at the quadrature points) of a beam without velocity.
  [[nodiscard]] GapField still_field(const double* q) const;
  void set_free_field(const double* q, const double* v, Workspace& work) const;
  /// Returns the values of the drives that produce a share of the forces of `values`: this share of the strength of an
  /// electrode or the dispersion force, or of the voltage of the piezo.
  [[nodiscard]] std::vector<double> share_of(double share, std::span<const double> values) const;
  /// Finds the open equilibrium from the straight beam, in increments of the load if necessary.
  [[nodiscard]] std::optional<Eigen::VectorXd> loaded_equilibrium(std::span<const double> values) const;
  [[nodiscard]] std::optional<Eigen::VectorXd> equilibrium_from(Eigen::VectorXd q, std::span<const double> values) const;

  Device device_;
  std::shared_ptr<const SampledModes> sampled_;
  ModalBasis basis_;
  PointQuadrature quadrature_;
  std::size_t electrodes_ = 0;
  std::vector<double> neutral_voltages_;  // neutral voltage of each electrode, at which it does not pull [V]
  // One force law per electrode, then that of the dispersion force.
  std::vector<std::shared_ptr<const DistributedLaw>> driven_laws_;
  std::vector<std::shared_ptr<const DistributedLaw>> passive_laws_;  // force laws that dissipate: gas films, dampers
  std::shared_ptr<const ContactLaw> contact_;
  std::vector<FurtherContact> further_;
  std::shared_ptr<const PadQuadrature> pad_;  // quadrature over the contact pad; null unless the contact acts along its pad
  // Pressure of a contact along the face of a dielectric; null without such a contact.
  std::shared_ptr<const DistributedLaw> face_;
  std::size_t face_at_ = std::numeric_limits<std::size_t>::max();  // index of the contact along the face of a dielectric
  std::shared_ptr<const GasLaw> gas_;
  std::shared_ptr<const ReynoldsFilm> film_;
  std::optional<MidPlaneStretching> stretching_;
  std::optional<Eigen::VectorXd> rest_;
  // Largest gap to the near electrode at which the run goes on [m]: beyond it the moving part is too close to an electrode or
  // gas film wall on the far side.
  double most_gap_ = std::numeric_limits<double>::infinity();
  double contact_gap_ = 0;  // distance of the first contact point from its contact plane at rest [m]
  double penetration_scale_ = 0;
  double bending_energy_ = 0;
};

}  // namespace softland
