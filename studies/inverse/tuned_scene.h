// A scene made ready for a belief about one of its devices: the quantities in which the device may differ, as independent
// standard normal coordinates z, and the closings of such devices.
//
// The quantities of [spread] keep their distributions. A scene with such things that it does not vary gets further ones:
//
//   gain of each shaped drive              normal, as given
//   gas.viscosity                          lognormal, 5 %
//   stiffness or modulus of the contacts   lognormal, 10 %
//   contact gaps over electrode gap        normal, 3 %, beside the factor that they may share
//   trigger delay                          normal, as given, and beside that 0.3 % of the closing time of the plain step
//
// Contacts that make the connection together have one quantity of each kind.
//
// If devices of the same wafer were tuned before, coordinates are those of their prediction for the next one (wafer.h).
//
// Jitter is drawn per edge: it is scatter, not a quantity of the device, and is left out.
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

#include "base/watch.h"
#include "studies/devices/ensemble.h"
#include "studies/inverse/tuner.h"
#include "studies/inverse/wafer.h"

namespace softland {

/// The section of a contact: "contact", or "contact.NAME" if there are several.
[[nodiscard]] inline std::string path_of(const Contact& contact) {
  return contact.name.empty() ? "contact" : "contact." + contact.name;
}

/// The scales of a scene.
struct TuningScales {
  double closing_time = 0;  ///< T_0: first touch of the plain step on the nominal device [s]
  double gap = 0;           ///< contact gap [m]
  double rebound = 0;       ///< significant rebound [m]
  double rise = 0;          ///< capacitance of the closed state less that of the open one [F]; 0: not recorded
  double latest_touch = std::numeric_limits<double>::infinity();  ///< requested latest first touch [s]
  /// Permanent contact time of the plain step on the nominal device; NaN unless the approach is quasi-static [s].
  double permanent_contact = std::numeric_limits<double>::quiet_NaN();
  [[nodiscard]] double speed() const { return gap / closing_time; }  ///< [m/s]
};

/// A device of a belief.
struct ImaginedDevice {
  Eigen::VectorXd z;
  SampledDevice sampled;
  double delay = 0;  ///< time by which its records begin late [s]
};

/// A closing as an instrument without errors sees it.
template <class Openings>
struct SeenClosing {
  double touch = std::numeric_limits<double>::quiet_NaN();  ///< first closing of the contact, since the drives began [s]
  /// Speed at that time [m/s]; of a capacitance, its rate over its rise, times the contact gap.
  double speed = std::numeric_limits<double>::quiet_NaN();
  Openings openings = {};  ///< openings, since the drives began [s]
};

/// A simulated closing of such a device, as exact as its model.
struct ImaginedClosing {
  bool followed = false;                                      ///< simulated to the end of its window
  double touch = std::numeric_limits<double>::quiet_NaN();    ///< first touch since the drives began [s]; NaN: none
  double speed = std::numeric_limits<double>::quiet_NaN();    ///< speed of the first touch [m/s]
  double fastest = std::numeric_limits<double>::quiet_NaN();  ///< largest speed of all touches [m/s]
  double highest = 0;                                         ///< highest rebound [m]
  std::vector<ContactOpening> openings = {};                  ///< openings, since the drives began [s]
  double delay = 0;                                           ///< time by which its record begins late [s]
  /// The same closing by its capacitance; none if an instrument sees the contact.
  std::optional<SeenClosing<std::vector<ContactOpening>>> by_capacitance = {};
  [[nodiscard]] bool closes() const { return followed && touch == touch; }
  [[nodiscard]] SeenClosing<std::span<const ContactOpening>> seen() const {
    if (by_capacitance) return {by_capacitance->touch, by_capacitance->speed, by_capacitance->openings};
    return {touch, speed, openings};
  }
  /// True if a record shows that it closes.
  [[nodiscard]] bool is_seen_to_close() const { return followed && !std::isnan(seen().touch); }
  /// Time of the first touch in a record [s]; NaN: none.
  [[nodiscard]] double recorded_touch() const { return seen().touch - delay; }
  /// Time from which on the contact stays closed [s]; infinite if it is open at the end.
  [[nodiscard]] double stays_from() const { return openings.empty() ? touch : std::max(touch, openings.back().end); }
};

/// One device under one waveform of every drive.
struct ImaginedShot {
  const ImaginedDevice* device = nullptr;
  const std::vector<Waveform>* waveforms = nullptr;
  double gain = 1;  ///< gain of all sources in this shot
};

class TunedScene {
 public:
  /// Throws what Tuner throws.
  TunedScene(const SceneFile& file, const TunerOptions& options, const Watch& watch);
  TunedScene(const TunedScene&) = delete;
  TunedScene& operator=(const TunedScene&) = delete;

  [[nodiscard]] const TunerOptions& options() const { return options_; }
  /// The scene with the spread of all quantities but the trigger delay, prepared for closings of an accuracy of 1e-4.
  [[nodiscard]] const PreparedScene& nominal() const { return nominal_; }
  [[nodiscard]] const TuningScales& scales() const { return scales_; }
  /// The approach of its waveforms: fast, unless another one is chosen.
  [[nodiscard]] Approach approach() const { return approach_; }
  /// True if a shaped drive can carry the switch to its contact through stable equilibria.
  [[nodiscard]] bool has_stable_path() const { return std::isfinite(step_stays_from_); }
  /// Throws InvalidInput for a quasi-static approach without such a path.
  void choose(Approach approach);
  [[nodiscard]] bool spread_is_assumed() const { return spread_is_assumed_; }
  /// True if closings are computed in lanes.
  [[nodiscard]] bool is_in_lanes() const {
    return why_not_in_lanes(nominal_.model).empty() && options_.vectors != Vectors::none &&
           !options_.laboratory.sees_capacitance();
  }
  /// Number of coordinates; the last one is the trigger delay.
  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(nominal_.scene.spread.variables.size()) + 1; }
  /// False for a coordinate of [spread] or of the gain of a source: these move the units of volts and time.
  [[nodiscard]] bool is_nuisance(Eigen::Index k) const { return nuisances_[static_cast<std::size_t>(k)]; }
  /// One standard deviation of the trigger delay before the first record [s].
  [[nodiscard]] double delay_deviation() const;
  /// The trigger delay of a device at z: its records begin late by so much [s].
  [[nodiscard]] double delay(const Eigen::VectorXd& z) const { return delay_deviation() * spread_point(z)[size() - 1]; }

  /// Changes the coordinates to those of this belief about z, in which it is standard normal.
  void begin_with(const NormalBelief& prior);
  [[nodiscard]] const std::optional<NormalBelief>& prior() const { return prior_; }
  /// Converts a belief in the coordinates to those of the spread.
  [[nodiscard]] NormalBelief in_spread(const NormalBelief& belief) const;

  /// Values of the varied quantities, as DeviceSpread::to_values, at z.
  [[nodiscard]] std::vector<double> values(const Eigen::VectorXd& z) const;
  /// Contact gap over electrode gap of a device with these values, over that of the scene; none if the contact gap is a
  /// quantity of [spread] by itself.
  [[nodiscard]] std::optional<double> gap_ratio(std::span<const double> values) const;
  /// "gap.contact / gap.electrode"; for a scene that has such a ratio.
  [[nodiscard]] std::string gap_ratio_name() const {
    return nominal_.scene.spread.variables[gap_ratio_->contact].name + " / gap.electrode";
  }
  /// The difference of the ratio at z from the scene's, in deviations; none as above.
  [[nodiscard]] std::optional<double> gap_ratio_coordinate(const Eigen::VectorXd& z) const;
  /// The nearest point with the ratio of the scene; z if there is no such ratio.
  [[nodiscard]] Eigen::VectorXd with_gap_ratio_of_scene(const Eigen::VectorXd& z) const;
  /// One standard deviation of that ratio. Devices of the spread have no variation of it.
  static constexpr double gap_ratio_deviation = 0.03;
  [[nodiscard]] std::vector<ImaginedDevice> devices(std::span<const Eigen::VectorXd> points, const Watch& watch = {}) const;
  /// Signals of the sources of a device.
  [[nodiscard]] std::vector<Signal> signals(const ImaginedShot& shot) const;
  /// Computes the closings, in order. An outcome does not depend on the other shots. Throws Interrupted.
  [[nodiscard]] std::vector<ImaginedClosing> close(std::span<const ImaginedShot> shots, const Watch& watch = {}) const;
  /// The time for which a closing that has touched is followed after the last breakpoint [s].
  [[nodiscard]] double hold_time() const;

  /// Units of a device at z over those of the nominal one, to first order in the logarithm. The unit of the commanded volts is
  /// that of the closing electrode: its static pull-in voltage over the gain of its source. The unit of time is the period of
  /// the first mode.
  struct Units {
    double volts = 1, time = 1;
  };
  [[nodiscard]] Units units(const Eigen::VectorXd& z) const;
  /// Derivative of ln volts by z of the spread.
  [[nodiscard]] const Eigen::VectorXd& volts_slope() const { return volts_slope_; }
  /// The level of that electrode below which at most one in a thousand devices with this mean and covariance of z collapses
  /// onto the electrode [V]; infinite if none does.
  [[nodiscard]] double safe_level(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance) const;

 private:
  [[nodiscard]] PreparedScene prepared(const SceneFile& given, const Watch& watch);
  void loosen_contact_gap(DeviceSpread& spread, const std::vector<std::string>& gaps);
  void find_units(const Watch& watch);
  [[nodiscard]] Eigen::VectorXd spread_point(const Eigen::VectorXd& z) const {
    return prior_ ? Eigen::VectorXd(prior_->mean + prior_factor_ * z) : z;
  }

  TunerOptions options_;
  bool spread_is_assumed_ = false;
  struct GapRatio {
    std::size_t contact;                // variable of the contact gap
    std::optional<std::size_t> shared;  // variable of the other gaps, if it moves with them
  };
  std::optional<GapRatio> gap_ratio_;
  PreparedScene nominal_;
  std::vector<bool> nuisances_;
  std::unique_ptr<const Ensemble> ensemble_;
  std::unique_ptr<const DeviceDrives> drives_;
  TuningScales scales_;
  Approach approach_ = Approach::fast;
  double step_stays_from_ = std::numeric_limits<double>::quiet_NaN();  // [s]; NaN without a stable path
  std::optional<std::size_t> electrode_;                               // electrode that closes the switch, among the drives
  Eigen::VectorXd volts_slope_, time_slope_, pulled_through_slope_;
  std::optional<NormalBelief> prior_;
  Eigen::MatrixXd prior_factor_;                                     // factor L; L L^T is its covariance
  double pulled_through_ = std::numeric_limits<double>::infinity();  // level of collapse of the nominal device [V]
};

}  // namespace softland
