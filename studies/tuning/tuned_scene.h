// A scene made ready for a belief about one device of it: the quantities that the device may differ in, as independent standard
// normal coordinates z, and the closings of such devices.
//
// To the quantities of [spread], which keep their distributions, come, where a scene has such a thing and does not vary it yet:
//
//   gain of each shaped drive              normal, as told
//   gas.viscosity                          lognormal, 5 %
//   stiffness or modulus of the contacts   lognormal, 10 %
//   contact gaps over electrode gap        normal, 3 %, beside the factor that they may share
//   trigger delay                          normal, as told, and beside that 0.3 % of the closing time of the plain step
//
// Contacts that make the connection together have one quantity of each kind.
//
// Where devices of the same wafer were tuned before, coordinates are those of what they tell of the next (wafer.h).
//
// What is drawn per edge (jitter) is scatter, not a quantity of the device, and is left out.
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
#include "studies/tuning/tuner.h"
#include "studies/tuning/wafer.h"

namespace softland {

/// The section of a contact: "contact", or "contact.NAME" of several.
[[nodiscard]] inline std::string path_of(const Contact& contact) {
  return contact.name.empty() ? "contact" : "contact." + contact.name;
}

/// What is large and what is small in a scene.
struct TuningScales {
  double closing_time = 0;  ///< T_0: first touch of the plain step on the nominal device [s]
  double gap = 0;           ///< contact gap [m]
  double rebound = 0;       ///< significant rebound [m]
  double rise = 0;          ///< the capacitance of the closed state less that of the open one [F]; 0: no record tells of it
  double latest_touch = std::numeric_limits<double>::infinity();  ///< that is asked for [s]
  /// When the plain step's contact stays on the nominal device; NaN unless the approach is quasi-static [s].
  double permanent_contact = std::numeric_limits<double>::quiet_NaN();
  [[nodiscard]] double speed() const { return gap / closing_time; }  ///< [m/s]
};

/// A device that a belief thinks of.
struct ImaginedDevice {
  Eigen::VectorXd z;
  SampledDevice sampled;
  double delay = 0;  ///< the time by which its records begin late [s]
};

/// A closing as an instrument without errors sees it.
template <class Openings>
struct SeenClosing {
  double touch = std::numeric_limits<double>::quiet_NaN();  ///< when the contact first closes, since the drives began [s]
  double speed =
      std::numeric_limits<double>::quiet_NaN();  ///< then; of a capacitance, over its rise, times the contact gap [m/s]
  Openings openings = {};                        ///< since the drives began [s]
};

/// A closing of an imagined device, as exact as its model.
struct ImaginedClosing {
  bool followed = false;                                      ///< to the end of its window
  double touch = std::numeric_limits<double>::quiet_NaN();    ///< first touch since the drives began [s]; NaN: none
  double speed = std::numeric_limits<double>::quiet_NaN();    ///< of the first touch [m/s]
  double fastest = std::numeric_limits<double>::quiet_NaN();  ///< of all touches [m/s]
  double highest = 0;                                         ///< rebound [m]
  std::vector<ContactOpening> openings = {};                  ///< since the drives began [s]
  double delay = 0;                                           ///< the time by which its record begins late [s]
  /// The same closing by its capacitance; none where an instrument sees the contact.
  std::optional<SeenClosing<std::vector<ContactOpening>>> by_capacitance = {};
  [[nodiscard]] bool closes() const { return followed && touch == touch; }
  [[nodiscard]] SeenClosing<std::span<const ContactOpening>> seen() const {
    if (by_capacitance) return {by_capacitance->touch, by_capacitance->speed, by_capacitance->openings};
    return {touch, speed, openings};
  }
  /// A record shows that it closes.
  [[nodiscard]] bool is_seen_to_close() const { return followed && !std::isnan(seen().touch); }
  /// When a record shows the first touch [s]; NaN: none.
  [[nodiscard]] double recorded_touch() const { return seen().touch - delay; }
  /// From when on the contact stays [s]; infinite where it is open at last.
  [[nodiscard]] double stays_from() const { return openings.empty() ? touch : std::max(touch, openings.back().end); }
};

/// One device under one waveform of every drive.
struct ImaginedShot {
  const ImaginedDevice* device = nullptr;
  const std::vector<Waveform>* waveforms = nullptr;
  double gain = 1;  ///< of all sources in this shot
};

class TunedScene {
 public:
  /// Throws what Tuner throws.
  TunedScene(const SceneFile& file, const TunerOptions& options, const Watch& watch);
  TunedScene(const TunedScene&) = delete;
  TunedScene& operator=(const TunedScene&) = delete;

  [[nodiscard]] const TunerOptions& options() const { return options_; }
  /// With the spread of all quantities but the trigger delay, prepared for closings of an accuracy of 1e-4.
  [[nodiscard]] const PreparedScene& nominal() const { return nominal_; }
  [[nodiscard]] const TuningScales& scales() const { return scales_; }
  /// How its waveforms close the switch: fast, unless another approach is chosen.
  [[nodiscard]] Approach approach() const { return approach_; }
  /// Whether a drive that is shaped can carry the switch to its contact through stable equilibria.
  [[nodiscard]] bool has_stable_path() const { return std::isfinite(step_stays_from_); }
  /// Throws InvalidInput for a quasi-static approach without such a path.
  void choose(Approach approach);
  [[nodiscard]] bool spread_is_assumed() const { return spread_is_assumed_; }
  /// Whether closings go in lanes.
  [[nodiscard]] bool is_in_lanes() const {
    return why_not_in_lanes(nominal_.model).empty() && options_.vectors != Vectors::none &&
           !options_.laboratory.sees_capacitance();
  }
  /// Number of coordinates, of which the trigger delay is the last.
  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(nominal_.scene.spread.variables.size()) + 1; }
  /// Which coordinates are of [spread] or the gain of a source: what moves the units of volts and time.
  [[nodiscard]] bool is_nuisance(Eigen::Index k) const { return nuisances_[static_cast<std::size_t>(k)]; }
  /// One standard deviation of the trigger delay before anything is recorded [s].
  [[nodiscard]] double delay_deviation() const;
  /// The trigger delay of a device at z: its records begin late by so much [s].
  [[nodiscard]] double delay(const Eigen::VectorXd& z) const { return delay_deviation() * spread_point(z)[size() - 1]; }

  /// From now on coordinates are those of this belief about z: standard normal where it is.
  void begin_with(const NormalBelief& prior);
  [[nodiscard]] const std::optional<NormalBelief>& prior() const { return prior_; }
  /// A belief in the coordinates as it is in those of the spread.
  [[nodiscard]] NormalBelief in_spread(const NormalBelief& belief) const;

  /// Values of the varying quantities, as DeviceSpread::to_values, at z.
  [[nodiscard]] std::vector<double> values(const Eigen::VectorXd& z) const;
  /// Contact gap over electrode gap of a device with these values, over that of the scene; none where [spread] has the contact
  /// gap as a quantity of its own.
  [[nodiscard]] std::optional<double> gap_ratio(std::span<const double> values) const;
  /// "gap.contact / gap.electrode"; for a scene that has such a ratio.
  [[nodiscard]] std::string gap_ratio_name() const {
    return nominal_.scene.spread.variables[gap_ratio_->contact].name + " / gap.electrode";
  }
  /// The deviations that the ratio of z is from the scene's; none as above.
  [[nodiscard]] std::optional<double> gap_ratio_coordinate(const Eigen::VectorXd& z) const;
  /// The nearest point whose ratio is that of the scene; z where there is no such ratio.
  [[nodiscard]] Eigen::VectorXd with_gap_ratio_of_scene(const Eigen::VectorXd& z) const;
  /// One standard deviation of that ratio, of which a device of the spread has none.
  static constexpr double gap_ratio_deviation = 0.03;
  [[nodiscard]] std::vector<ImaginedDevice> devices(std::span<const Eigen::VectorXd> points, const Watch& watch = {}) const;
  /// What the sources of a device give.
  [[nodiscard]] std::vector<Signal> signals(const ImaginedShot& shot) const;
  /// The closings, in order. An outcome does not depend on what else is closed. Throws Interrupted.
  [[nodiscard]] std::vector<ImaginedClosing> close(std::span<const ImaginedShot> shots, const Watch& watch = {}) const;
  /// The time after the last breakpoint that a closing is followed for where it has touched [s].
  [[nodiscard]] double hold_time() const;

  /// Of a device at z over those of the nominal one, to first order in the logarithm: units of the told volts of the electrode
  /// that closes the switch (its static pull-in voltage over the gain of its source), and of time (the period of the first mode).
  struct Units {
    double volts = 1, time = 1;
  };
  [[nodiscard]] Units units(const Eigen::VectorXd& z) const;
  /// How ln volts changes with z of the spread.
  [[nodiscard]] const Eigen::VectorXd& volts_slope() const { return volts_slope_; }
  /// Of the devices with this mean and covariance of z, at most one in a thousand is pulled through its contact by a level of
  /// that electrode below this [V]; infinite where none is.
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
    std::optional<std::size_t> shared;  // of the other gaps, where it moves with them
  };
  std::optional<GapRatio> gap_ratio_;
  PreparedScene nominal_;
  std::vector<bool> nuisances_;
  std::unique_ptr<const Ensemble> ensemble_;
  std::unique_ptr<const DeviceDrives> drives_;
  TuningScales scales_;
  Approach approach_ = Approach::fast;
  double step_stays_from_ = std::numeric_limits<double>::quiet_NaN();  // [s]; NaN without a stable path
  std::optional<std::size_t> electrode_;                               // that closes the switch, among the drives
  Eigen::VectorXd volts_slope_, time_slope_, pulled_through_slope_;
  std::optional<NormalBelief> prior_;
  Eigen::MatrixXd prior_factor_;                                     // L L^T is its covariance
  double pulled_through_ = std::numeric_limits<double>::infinity();  // of the nominal device [V]
};

}  // namespace softland
