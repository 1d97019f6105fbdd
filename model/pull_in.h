// The statics of pull-in and release: static and dynamic pull-in, release, and the closed equilibrium.
//
// Consider static equilibria of one electrode at voltage V, with the other drives at a bias:
//
//   omega_i^2 q_i = V^2 g_i(q) + f_i(q) - phi_i(x_c) P(y(x_c) - dt)
//
// The q_i are modal coordinates, g_i modal forces of the electrode at 1 V, f_i those of the dispersion force at factor 1. The
// phi_i are mode shapes, y(x_c) is the deflection of the contact point, dt the contact gap, P the contact force. The deflection
// of the contact point, which keeps growing through the fold, parametrises the branch of these equilibria; V^2 is an unknown.
// The factor of the dispersion force takes the place of V^2 when that force is the drive.
//
// A charge on the dielectric shifts all voltages by V0 = Switch::neutral_voltage(): V above is then V - V0. Of the two voltages
// with the same force, V and 2 V0 - V, the functions return the one above V0.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "base/progress.h"
#include "model/status.h"
#include "model/switch.h"

namespace softland {

enum class StaticKind { fold, contact };
[[nodiscard]] std::string_view to_string(StaticKind kind);

/// Returns true when this drive pulls towards the contact: an electrode on the far side has no pull-in voltage.
[[nodiscard]] bool pulls_in(const Device& device, std::size_t drive);

struct StaticPullIn {
  Status status = Status::not_run;
  double voltage = std::numeric_limits<double>::quiet_NaN();     ///< static pull-in voltage [V]; for dispersion its factor - 1
  double deflection = std::numeric_limits<double>::quiet_NaN();  ///< deflection of the contact point at the pull-in voltage [m]
  /// Tells whether the branch of equilibria turns back (fold), or reaches the contact plane before it would.
  StaticKind kind = StaticKind::fold;
};

/// Constant values of the other drives: one value per drive, as in Switch::drives(); the value of the drive whose pull-in is
/// computed is ignored. If empty, all other drives are at 0.
using Bias = std::span<const double>;

/// Finds the static pull-in voltage of `drive`: at the fold of its branch of equilibria, or where the contact point reaches the
/// contact plane if the plane comes first. The branch of an electrode begins at the open equilibrium under the bias, with this
/// electrode at its neutral voltage V0, where it does not pull. The status is collapsed_at_rest when this equilibrium, or the
/// one with this electrode at 0 V, does not exist, and no_contact for an electrode on the far side. The branch of the
/// dispersion force begins at factor 0, so that a negative result shows by how much the nominal force is too strong. Throws
/// InvalidInput when the bias has another number of drives.
[[nodiscard]] StaticPullIn static_pull_in(const Switch& model, std::size_t drive, Bias bias = {});

/// An equilibrium, stable or not, in which a drive holds the contact point.
struct HeldEquilibrium {
  Eigen::VectorXd q;                                          ///< modal coordinates of the equilibrium [m kg^(1/2)]
  double voltage = std::numeric_limits<double>::quiet_NaN();  ///< voltage of the drive that holds the contact point [V]
};
/// Returns the equilibrium whose contact point has this deflection [m], on the branch of static_pull_in() and
/// release_voltage(). Returns none when the branch could not be computed up to this deflection, or the drive would have to push
/// the beam away. Throws InvalidInput as static_pull_in() does.
[[nodiscard]] std::optional<HeldEquilibrium> held_by_drive(const Switch& model, std::size_t drive, double deflection,
                                                           Bias bias = {});

/// The stable open equilibria through which one drive moves the contact point from rest to the contact plane, with the other
/// drives at a bias. The equilibria of an electrode on the near side end at pull-in when the contact plane is beyond the
/// pull-in deflection.
struct StablePath {
  /// Deflections of the contact point, from rest under the bias to the contact plane, evenly spaced [m].
  std::vector<double> deflections;
  std::vector<double> values;  ///< voltage of the drive at each deflection, from 0 V on, monotone [V]
  [[nodiscard]] double reaches() const { return values.back(); }
  /// Returns the slope of the contact point's deflection by the drive's voltage at the contact plane [m/V].
  [[nodiscard]] double slope() const {
    const std::size_t last = values.size() - 1;
    return (deflections[last] - deflections[last - 1]) / (values[last] - values[last - 1]);
  }
};
/// Returns the stable open equilibria of a drive up to the contact plane; none when they do not exist or could not be computed.
/// Throws InvalidInput as static_pull_in() does.
[[nodiscard]] std::optional<StablePath> stable_path(const Switch& model, std::size_t drive, Bias bias = {});

/// The least voltage at which an equilibrium on the contact exists, and the deflection of the contact point there.
struct ReleasePoint {
  double voltage = std::numeric_limits<double>::quiet_NaN();     ///< release voltage as release_voltage() returns it [V]
  double deflection = std::numeric_limits<double>::quiet_NaN();  ///< deflection of the contact point at release [m]
};
[[nodiscard]] ReleasePoint release_point(const Switch& model, std::size_t drive, Bias bias = {});
/// Returns the release voltage [V]: the smallest voltage with a closed equilibrium, counted from the neutral voltage V0, at
/// which the electrode does not pull. The voltage is 0 when the dispersion force, or the bias, keeps the switch closed by
/// itself, and negative when a charge on the dielectric keeps the switch closed at 0 V. The voltage is NaN without a contact
/// law, when the contact is too soft to keep the beam off the electrode at any voltage, and when the branch could not be
/// computed. Throws InvalidInput as static_pull_in() does.
[[nodiscard]] double release_voltage(const Switch& model, std::size_t drive, Bias bias = {});

/// An equilibrium of the beam on the contact.
struct ClosedEquilibrium {
  Eigen::VectorXd q;         ///< modal coordinates of the equilibrium [m kg^(1/2)]
  double contact_force = 0;  ///< force of the contact [N]
  double potential = 0;      ///< energy of the equilibrium, Switch::potential() [J]
  /// Smallest eigenvalue of the tangent stiffness of the static forces, over all motions that the contact allows [rad^2/s^2];
  /// infinite when the contact allows no motion. The equilibrium is unstable when the eigenvalue is not positive.
  double smallest_eigenvalue = std::numeric_limits<double>::quiet_NaN();
  /// Returns the modal coordinates for ClosingOptions::begins_closed; valid during the lifetime of this object.
  [[nodiscard]] std::span<const double> coordinates() const { return {q.data(), static_cast<std::size_t>(q.size())}; }
};
/// Returns the closed equilibrium under constant voltages nearest to the contact plane, if one exists with a contact force
/// above zero. The equilibrium with one electrode at V and all other drives at 0 V exists from the release voltage up to the
/// voltage at which the beam collapses onto the electrode.
[[nodiscard]] std::optional<ClosedEquilibrium> closed_equilibrium(const Switch& model, std::span<const double> volts);
/// Returns closed_equilibrium(), found by Newton's method from the closed equilibrium of a slightly different switch and
/// voltages, if the method ends on a stable equilibrium. This takes a hundredth of the work of a full search.
[[nodiscard]] std::optional<ClosedEquilibrium> closed_equilibrium_near(const Switch& model, std::span<const double> volts,
                                                                       const ClosedEquilibrium& near);

/// Returns true when the modes of the switch suffice to decide whether a closed equilibrium is stable. One mode of a beam
/// clamped at both ends does not: such a beam leaves the equilibrium by a motion in other modes.
[[nodiscard]] bool judges_stability(const Switch& model);

/// Returns true when the closed equilibrium exists and is stable. It counts as stable when judges_stability() is false.
[[nodiscard]] bool keeps_closed(const Switch& model, const std::optional<ClosedEquilibrium>& closed);

/// Returns the voltage of `drive`, above its neutral voltage V0, from which the closed switch collapses onto the electrode [V],
/// with the other drives at `volts`: above this voltage the closed equilibrium is unstable or does not exist. The search begins
/// at the value of `drive` in `volts`, or at the release voltage if that is larger, and covers a tenth to ten times this value,
/// counted from V0. The result is NaN if the collapse is not in this range. The relative precision is `precision`.
[[nodiscard]] double pull_through_voltage(const Switch& model, std::size_t drive, std::span<const double> volts,
                                          double precision = 1e-6);

/// Returns pull_through_voltage(), found by Newton's method upwards from the value of `drive` in `volts`. The search begins at
/// a closed equilibrium of a slightly different switch and voltages, which takes a fifth of the work of a full search.
[[nodiscard]] double pull_through_voltage_near(const Switch& model, std::size_t drive, std::span<const double> volts,
                                               const ClosedEquilibrium& near, double precision = 1e-6);

/// Return the modal forces [N kg^(-1/2)] on a switch at rest in `q` without contact, and the smallest eigenvalue of minus their
/// derivative by q [rad^2/s^2].
[[nodiscard]] Eigen::VectorXd static_force(const Switch& model, const Eigen::VectorXd& q, std::span<const double> volts);
[[nodiscard]] double open_tangent_eigenvalue(const Switch& model, const Eigen::VectorXd& q, std::span<const double> volts);

/// Default relative width of the bracket of a dynamic pull-in voltage; the result is the bracket's upper end.
inline constexpr double dynamic_pull_in_precision = 1e-7;

/// Dynamic pull-in voltage Vdp [V]: the smallest constant voltage step, from rest under the bias of the other drives, under
/// which the contact point reaches the contact plane within 100 periods of the first mode, whether or not the switch stays
/// closed. Vdp has the relative error `precision`. It is at most the static pull-in voltage, at which the switch closes with
/// any damping. Vdp is NaN with a status when static pull-in under the same bias fails, or `progress` asks to stop. Throws
/// InvalidInput as static_pull_in() does.
struct DynamicPullIn {
  Status status = Status::not_run;
  /// Dynamic pull-in voltage [V]; for the dispersion force its factor minus 1.
  double voltage = std::numeric_limits<double>::quiet_NaN();
};
[[nodiscard]] DynamicPullIn dynamic_pull_in(const Switch& model, std::size_t drive, const StaticPullIn& static_result,
                                            Bias bias = {}, const Progress& progress = {}, double tolerance = 1e-8,
                                            double precision = dynamic_pull_in_precision);

/// Returns true when a constant step of `drive` to `value` from rest under the bias reaches the contact plane: `value` is then
/// at least the dynamic pull-in voltage. Returns true when the bias leaves no open state. Throws InvalidInput as
/// static_pull_in() does.
[[nodiscard]] bool step_closes(const Switch& model, std::size_t drive, double value, Bias bias = {},
                               const Progress& progress = {}, double tolerance = 1e-8);

}  // namespace softland
