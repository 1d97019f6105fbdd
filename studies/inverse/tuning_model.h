// A scene prepared for a belief about one of its devices: independent standard normal coordinates z for the quantities in which
// the device may differ from the scene, and the closings of such devices.
//
// The quantities of [spread] have the distributions that [spread] gives them. The following quantities vary as well, if the
// scene has them and [spread] does not:
//
//   gain of each tuned drive               normal, LaboratoryErrors::gain_error
//   gas.viscosity                          lognormal, 5 %
//   stiffness or modulus of the contacts   lognormal, 10 %
//   contact gaps over electrode gap        normal, 3 %, also if [spread] varies both gaps by a common factor
//   trigger delay                          normal, LaboratoryErrors::trigger_delay, plus 0.3 % of the closing time of the plain
//                                          step
//
// Several contacts that make the connection share one quantity of each kind. If devices of the same wafer were tuned before,
// the coordinates are those of the prediction for the next device (wafer.h). Jitter is left out, since it is random for every
// edge and not a quantity of the device.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/progress.h"
#include "studies/devices/ensemble.h"
#include "studies/inverse/tuner.h"
#include "studies/inverse/wafer.h"

namespace softland {

/// Returns the section of a contact: "contact", or "contact.NAME" if there are several.
[[nodiscard]] inline std::string path_of(const Contact& contact) {
  return contact.name.empty() ? "contact" : "contact." + contact.name;
}

/// The scales of a scene's closing by which costs and errors are divided.
struct TuningScales {
  double closing_time = 0;  ///< T_0: time of first contact under the plain step on the nominal device [s]
  double gap = 0;           ///< rest gap of the contact [m]
  double rebound = 0;       ///< least height of a rebound that counts as significant [m]
  double rise = 0;  ///< capacitance of the closed state less that of the open state [F]; 0 if the capacitance is not recorded
  /// Requested limit of the time of first contact [s]; infinite for no limit.
  double latest_touch = std::numeric_limits<double>::infinity();
  /// Permanent contact time of the plain step on the nominal device [s]; NaN unless the approach is quasi-static.
  double permanent_contact = std::numeric_limits<double>::quiet_NaN();
  [[nodiscard]] double speed() const { return gap / closing_time; }  ///< unit of velocities in costs and errors [m/s]
};

/// A simulated device that stands for the belief about a device.
struct Particle {
  Eigen::VectorXd z;
  SampledDevice sampled;
  double delay = 0;  ///< delay of the device's record behind the drive waveforms [s]
};

/// The contact in a closing as an instrument without errors would record it.
template <class Openings>
struct SeenClosing {
  double touch = std::numeric_limits<double>::quiet_NaN();  ///< time of first contact after the drive waveforms begin [s]
  /// Impact velocity at the time `touch` [m/s]. If the capacitance is recorded instead of the contact, the velocity is
  /// estimated: time derivative of the capacitance, divided by TuningScales::rise, times the contact gap.
  double speed = std::numeric_limits<double>::quiet_NaN();
  Openings openings = {};  ///< time spans in which the contact is open, by time after the drive waveforms begin [s]
};

/// A simulated closing of a device of a belief, without errors of measurement.
struct PredictedClosing {
  bool followed = false;  ///< true if the closing was simulated to the end of its simulated time
  /// Time of first contact after the drive waveforms begin [s]; NaN without contact.
  double touch = std::numeric_limits<double>::quiet_NaN();
  double speed = std::numeric_limits<double>::quiet_NaN();    ///< impact velocity of the first touch of the contact [m/s]
  double fastest = std::numeric_limits<double>::quiet_NaN();  ///< largest impact velocity of all touches of the contact [m/s]
  double highest = 0;                                         ///< height of the highest rebound [m]
  /// Time spans in which the contact is open, by time after the drive waveforms begin [s].
  std::vector<ContactOpening> openings = {};
  double delay = 0;  ///< delay of the record of the closing behind the drive waveforms [s]
  /// The contact in the closing as the capacitance shows it; none if the instrument records the contact.
  std::optional<SeenClosing<std::vector<ContactOpening>>> by_capacitance = {};
  [[nodiscard]] bool closes() const { return followed && touch == touch; }
  [[nodiscard]] SeenClosing<std::span<const ContactOpening>> seen() const {
    if (by_capacitance) return {by_capacitance->touch, by_capacitance->speed, by_capacitance->openings};
    return {touch, speed, openings};
  }
  /// True if a record of the closing shows that the switch closes.
  [[nodiscard]] bool is_seen_to_close() const { return followed && !std::isnan(seen().touch); }
  /// Returns the time of first contact in a record of the closing [s]; NaN without contact.
  [[nodiscard]] double recorded_touch() const { return seen().touch - delay; }
  /// Returns the time from which on the contact stays closed [s]; infinite if the contact is open at the end of the run.
  [[nodiscard]] double stays_from() const { return openings.empty() ? touch : std::max(touch, openings.back().end); }
};

/// A shot (closing) to simulate: a device of the belief, and one waveform for every drive.
struct PredictedShot {
  const Particle* device = nullptr;
  const std::vector<Waveform>* waveforms = nullptr;
  double gain = 1;  ///< gain that all voltage sources have in this shot
};

class TuningModel {
 public:
  /// Throws the exceptions of the constructor of Tuner.
  TuningModel(const SceneFile& file, const TunerOptions& options, const Progress& progress);
  TuningModel(const TuningModel&) = delete;
  TuningModel& operator=(const TuningModel&) = delete;

  [[nodiscard]] const TunerOptions& options() const { return options_; }
  /// Returns the scene with all quantities in [spread] except the trigger delay, prepared for closings with an accuracy of
  /// 1e-4.
  [[nodiscard]] const PreparedScene& nominal() const { return nominal_; }
  [[nodiscard]] const TuningScales& scales() const { return scales_; }
  /// Returns the approach to the contact that the waveforms make: fast unless choose() was called.
  [[nodiscard]] Approach approach() const { return approach_; }
  /// True if a varied drive can move the switch to its contact through stable equilibria.
  [[nodiscard]] bool has_stable_path() const { return std::isfinite(step_stays_from_); }
  /// Sets the approach to the contact. Throws InvalidInput for a quasi-static approach if the scene has no stable path to
  /// contact.
  void choose(Approach approach);
  [[nodiscard]] bool spread_is_assumed() const { return spread_is_assumed_; }
  /// True if closings are computed in SIMD lanes, several devices at once.
  [[nodiscard]] bool is_in_lanes() const {
    return why_not_in_lanes(nominal_.model).empty() && options_.vectors != Vectors::none &&
           !options_.laboratory.sees_capacitance();
  }
  /// Returns the number of coordinates z; the last coordinate is the trigger delay.
  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(nominal_.scene.spread.variables.size()) + 1; }
  /// True for a coordinate that does not change the units of voltage and time: viscosity, contact stiffness, trigger delay.
  [[nodiscard]] bool is_nuisance(Eigen::Index k) const { return nuisances_[static_cast<std::size_t>(k)]; }
  /// Returns the standard deviation of the trigger delay (of contact records behind the drives) before the first record [s].
  [[nodiscard]] double delay_deviation() const;
  /// Returns the trigger delay of the device at z, by which its contact records begin late [s].
  [[nodiscard]] double delay(const Eigen::VectorXd& z) const { return delay_deviation() * spread_point(z)[size() - 1]; }

  /// Replaces the coordinates z by coordinates in which the belief `prior` about z is standard normal.
  void begin_with(const NormalBelief& prior);
  [[nodiscard]] const std::optional<NormalBelief>& prior() const { return prior_; }
  /// Converts a belief in the current coordinates to the coordinates of [spread].
  [[nodiscard]] NormalBelief in_spread(const NormalBelief& belief) const;

  /// Returns the values of the varied quantities of the device at z (DeviceSpread::to_values).
  [[nodiscard]] std::vector<double> values(const Eigen::VectorXd& z) const;
  /// Returns the ratio of contact gap to electrode gap of a device with these values, relative to that of the scene. None if
  /// [spread] varies the contact gap as a separate quantity.
  [[nodiscard]] std::optional<double> gap_ratio(std::span<const double> values) const;
  /// Returns the name of the ratio of contact to electrode gap, "gap.contact / gap.electrode", for a scene that has such a
  /// ratio.
  [[nodiscard]] std::string gap_ratio_name() const {
    return nominal_.scene.spread.variables[gap_ratio_->contact].name + " / gap.electrode";
  }
  /// Returns the deviation of the gap ratio of the device at z from that of the scene, in units of gap_ratio_deviation; none if
  /// the scene has no gap ratio.
  [[nodiscard]] std::optional<double> gap_ratio_coordinate(const Eigen::VectorXd& z) const;
  /// Returns the device nearest to z that has the gap ratio of the scene; z if the scene has no gap ratio.
  [[nodiscard]] Eigen::VectorXd with_gap_ratio_of_scene(const Eigen::VectorXd& z) const;
  /// Standard deviation of the ratio of contact to electrode gap in a belief, although the devices of [spread] all have the
  /// same ratio.
  static constexpr double gap_ratio_deviation = 0.03;
  [[nodiscard]] std::vector<Particle> devices(std::span<const Eigen::VectorXd> points, const Progress& progress = {}) const;
  /// Returns the applied voltages of a shot, one signal per drive.
  [[nodiscard]] std::vector<Signal> signals(const PredictedShot& shot) const;
  /// Simulates the closings of these shots (device and waveforms), in order. An outcome does not depend on the other shots.
  /// Throws Interrupted if `progress` asks to stop.
  [[nodiscard]] std::vector<PredictedClosing> close(std::span<const PredictedShot> shots, const Progress& progress = {}) const;
  /// Returns the time for which a closing with contact is simulated after the last breakpoint of the waveforms [s].
  [[nodiscard]] double hold_time() const;

  /// Units of a device at z relative to those of the nominal device; their logarithms are linear in z, to first order. The unit
  /// of the commanded voltages is the static pull-in voltage of the closing electrode divided by the gain of its source. The
  /// unit of time is the period of the first mode.
  struct Units {
    double volts = 1, time = 1;
  };
  [[nodiscard]] Units units(const Eigen::VectorXd& z) const;
  /// Returns the derivative of ln Units::volts by the coordinates of [spread].
  [[nodiscard]] const Eigen::VectorXd& volts_slope() const { return volts_slope_; }
  /// Returns the level of the closing electrode below which at most one in a thousand devices of this distribution of z
  /// collapses onto the electrode [V]; infinite if no device collapses.
  [[nodiscard]] double safe_level(const NormalBelief& belief) const;

 private:
  [[nodiscard]] PreparedScene prepared(const SceneFile& given, const Progress& progress);
  void loosen_contact_gap(DeviceSpread& spread, const std::vector<std::string>& gaps);
  void find_units(const Progress& progress);
  [[nodiscard]] Eigen::VectorXd spread_point(const Eigen::VectorXd& z) const {
    return prior_ ? Eigen::VectorXd(prior_->mean + prior_factor_ * z) : z;
  }

  TunerOptions options_;
  bool spread_is_assumed_ = false;
  struct GapRatio {
    std::size_t contact;  // index in [spread] of the variable of the contact gap
    // Index in [spread] of the variable of the other gaps, if the contact gap varies with them.
    std::optional<std::size_t> shared;
  };
  std::optional<GapRatio> gap_ratio_;
  PreparedScene nominal_;
  std::vector<bool> nuisances_;
  std::unique_ptr<const Ensemble> ensemble_;
  std::unique_ptr<const DeviceDrives> drives_;
  TuningScales scales_;
  Approach approach_ = Approach::fast;
  // Permanent contact time under the plain step [s]; NaN without a stable path to the contact.
  double step_stays_from_ = std::numeric_limits<double>::quiet_NaN();
  std::optional<std::size_t> electrode_;  // index of the electrode that closes the switch in Switch::drives()
  Eigen::VectorXd volts_slope_, time_slope_, pulled_through_slope_;
  std::optional<NormalBelief> prior_;
  Eigen::MatrixXd prior_factor_;  // factor L of the prior's covariance L L^T in the coordinates of [spread]
  // Collapse voltage of the nominal device under its closing electrode [V].
  double pulled_through_ = std::numeric_limits<double>::infinity();
};

}  // namespace softland
