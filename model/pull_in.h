// The statics of snapping in and release: static and dynamic pull-in, release, and the closed equilibrium.
//
// Consider static equilibria of one electrode at voltage V, with the other drives at a bias:   omega_i^2 q_i = V^2 g_i(q) +
// f_i(q) - phi_i(x_c) P(y(x_c) - dt) with f the dispersion force at factor 1. They are followed by the deflection of the
// contact point, which passes the fold without turning back; V^2 is an unknown there. The same functions take the dispersion
// force as the drive, its factor as the unknown.
//
// A charge on the dielectric shifts all voltages by V0 = Switch::neutral_voltage(): V - V0 stands for V above. Voltages are
// those above V0, which a positive drive reaches; a negative drive reaches 2 V0 minus these.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "base/watch.h"
#include "model/status.h"
#include "model/switch.h"

namespace softland {

enum class StaticKind { fold, contact };
[[nodiscard]] std::string_view to_string(StaticKind kind);

/// Returns true when this drive pulls towards the contact: an electrode on the far side has no pull-in voltage.
[[nodiscard]] bool pulls_in(const Device& device, std::size_t drive);

struct StaticPullIn {
  Status status = Status::not_run;
  double voltage = std::numeric_limits<double>::quiet_NaN();     ///< Vsp [V]; for the dispersion force its factor less one
  double deflection = std::numeric_limits<double>::quiet_NaN();  ///< deflection of the contact point there [m]
  StaticKind kind = StaticKind::fold;  ///< fold of the branch, or the contact point reaches the contact plane before it
};

/// Constant values of the other drives: one value per drive, as in Switch::drives(); the value of the drive in question is
/// ignored. If empty, all of them are 0.
using Bias = std::span<const double>;

/// Finds the fold of the static branch of `drive`, or the voltage at which the contact point reaches the contact plane if that
/// comes first. The branch of an electrode begins at the switch's rest under the bias, without a field of its own. The status
/// is collapsed_at_rest where there is no rest there or at 0 V, no_contact for an electrode on the far side. The branch of the
/// dispersion force begins at factor 0, so that a negative answer shows by how much the nominal force is too strong. Throws
/// InvalidInput for a bias of another number of drives.
[[nodiscard]] StaticPullIn static_pull_in(const Switch& model, std::size_t drive, Bias bias = {});

/// An equilibrium, stable or not, in which a drive holds the contact point.
struct HeldEquilibrium {
  Eigen::VectorXd q;                                          ///< modal coordinates [m kg^(1/2)]
  double voltage = std::numeric_limits<double>::quiet_NaN();  ///< voltage of the drive [V]
};
/// Returns the equilibrium whose contact point has this deflection [m], on the branch that static_pull_in() and
/// release_voltage() follow; none where it cannot be followed so far, or the drive would have to push. Throws as
/// static_pull_in() does.
[[nodiscard]] std::optional<HeldEquilibrium> held_by_drive(const Switch& model, std::size_t drive, double deflection,
                                                           Bias bias = {});

/// The stable open equilibria through which one drive carries the contact point from rest to the contact plane, with the other
/// drives at a bias. The path of an electrode on the near side ends at a fold where its contact lies beyond one.
struct StablePath {
  std::vector<double> deflections;  ///< deflection of the contact point, from rest under the bias to the plane, evenly [m]
  std::vector<double> values;       ///< value of the drive there, from 0 V on, without turning back [V]
  [[nodiscard]] double reaches() const { return values.back(); }
  /// Returns the slope of the deflection by the drive's value at the contact plane [m/V].
  [[nodiscard]] double slope() const {
    const std::size_t last = values.size() - 1;
    return (deflections[last] - deflections[last - 1]) / (values[last] - values[last - 1]);
  }
};
/// Returns none where no such path exists, or it could not be followed. Throws as static_pull_in() does.
[[nodiscard]] std::optional<StablePath> stable_path(const Switch& model, std::size_t drive, Bias bias = {});

/// The least voltage of the closed branch, and the deflection of the contact point there.
struct ReleasePoint {
  double voltage = std::numeric_limits<double>::quiet_NaN();     ///< voltage as of release_voltage() [V]
  double deflection = std::numeric_limits<double>::quiet_NaN();  ///< [m]
};
[[nodiscard]] ReleasePoint release_point(const Switch& model, std::size_t drive, Bias bias = {});
/// Returns the release voltage [V]: the smallest voltage above V0 with a closed equilibrium. It is 0 where the dispersion
/// force, or the bias, keeps the switch closed by itself, and negative where a charge on the dielectric keeps it closed at 0 V.
/// It is NaN where there is no contact law, where the contact is too soft to keep the beam off the electrode at any voltage, or
/// where the branch could not be followed. Throws as static_pull_in() does.
[[nodiscard]] double release_voltage(const Switch& model, std::size_t drive, Bias bias = {});

/// An equilibrium of the beam on the contact.
struct ClosedEquilibrium {
  Eigen::VectorXd q;         ///< modal coordinates [m kg^(1/2)]
  double contact_force = 0;  ///< [N]
  double potential = 0;      ///< Switch::potential there [J]
  /// Smallest eigenvalue of the tangent of the static forces there, over all modes that the contact leaves free [rad^2/s^2];
  /// infinite where it leaves none. A beam leaves an equilibrium where it is not positive, however slowly.
  double smallest_eigenvalue = std::numeric_limits<double>::quiet_NaN();
  /// Returns the coordinates for ClosingOptions::begins_closed; valid as long as this.
  [[nodiscard]] std::span<const double> coordinates() const { return {q.data(), static_cast<std::size_t>(q.size())}; }
};
/// Returns the closed equilibrium under constant voltages nearest to the contact plane, if one exists with a contact force
/// above zero. It exists with one electrode at V and all other drives at 0 V above the release voltage, up to where the beam is
/// pulled onto the electrode.
[[nodiscard]] std::optional<ClosedEquilibrium> closed_equilibrium(const Switch& model, std::span<const double> volts);
/// Finds the same by Newton's method from that of a slightly different switch and voltages, where that ends on a stable one;
/// this takes a hundredth of the work.
[[nodiscard]] std::optional<ClosedEquilibrium> closed_equilibrium_near(const Switch& model, std::span<const double> volts,
                                                                       const ClosedEquilibrium& near);

/// Returns true when the modes in use suffice to decide whether a closed equilibrium is stable: a beam clamped at both ends
/// leaves it by a motion that the first mode does not have.
[[nodiscard]] bool judges_stability(const Switch& model);

/// Returns true for a closed equilibrium that the switch does not leave: a stable one, as far as its modes can show.
[[nodiscard]] bool keeps_closed(const Switch& model, const std::optional<ClosedEquilibrium>& closed);

/// Returns the voltage of `drive`, above V0, from which on the closed switch collapses onto the electrode [V], with the other
/// drives at `volts`: beyond it, its closed equilibrium is unstable or gone. The search covers a tenth to ten times its value
/// in `volts`, or of the release voltage where that is larger, both counted from V0; the result is NaN if none lies there. The
/// relative precision is `precision`.
[[nodiscard]] double pull_through_voltage(const Switch& model, std::size_t drive, std::span<const double> volts,
                                          double precision = 1e-6);

/// Finds the same, upwards from its value in `volts`, by Newton's method, which begins at a closed equilibrium of a slightly
/// different switch and voltages; this takes a fifth of the work.
[[nodiscard]] double pull_through_voltage_near(const Switch& model, std::size_t drive, std::span<const double> volts,
                                               const ClosedEquilibrium& near, double precision = 1e-6);

/// Return, for a switch at rest in `q` without contact, the modal forces [N kg^(-1/2)], and the smallest eigenvalue of their
/// tangent [rad^2/s^2].
[[nodiscard]] Eigen::VectorXd static_force(const Switch& model, const Eigen::VectorXd& q, std::span<const double> volts);
[[nodiscard]] double open_tangent_eigenvalue(const Switch& model, const Eigen::VectorXd& q, std::span<const double> volts);

/// Default relative width of the bracket of a dynamic pull-in voltage; its upper end is returned.
inline constexpr double dynamic_pull_in_precision = 1e-7;

/// Dynamic pull-in voltage Vdp [V]: the smallest constant step from rest under the bias whose contact point reaches the contact
/// plane within 100 periods of the first mode, whether or not it stays, to `precision`. It is at most the static pull-in
/// voltage, at which even the thickest film finally yields. It is NaN with a status when static pull-in under the same bias
/// fails, or `watch` asks to stop. Throws as static_pull_in() does.
struct DynamicPullIn {
  Status status = Status::not_run;
  double voltage = std::numeric_limits<double>::quiet_NaN();  ///< [V]; for the dispersion force its factor less one
};
[[nodiscard]] DynamicPullIn dynamic_pull_in(const Switch& model, std::size_t drive, const StaticPullIn& static_result,
                                            Bias bias = {}, const Watch& watch = {}, double tolerance = 1e-8,
                                            double precision = dynamic_pull_in_precision);

/// Returns true when a constant step of `drive` to `value` from rest under the bias reaches the contact plane. This decides
/// with one trial whether `value` is at least the dynamic pull-in voltage. Returns true where the bias leaves no open state.
/// Throws as static_pull_in() does.
[[nodiscard]] bool step_closes(const Switch& model, std::size_t drive, double value, Bias bias = {}, const Watch& watch = {},
                               double tolerance = 1e-8);

}  // namespace softland
