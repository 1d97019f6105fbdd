// A scene that is ready to run: its switch is composed, its pull-in voltages are computed if voltages are in units of them, and
// every drive is a signal in volts.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "config/scene.h"
#include "model/closing.h"
#include "model/pull_in.h"
#include "model/switch.h"
#include "studies/closing/quadrature.h"
#include "waveforms/signal.h"

namespace softland {

struct ElectrodePullIn {
  StaticPullIn statically;
  DynamicPullIn dynamically;
};

/// Returns the constant voltages (bias) of the other drives under which pull-in voltages of drive number `drive` are computed
/// [V]: their hold voltages, or 0 V for hold voltages in units of pull-in voltages (Scene::standing). The entry of `drive`
/// itself is 0.
[[nodiscard]] std::vector<double> bias_of(const Scene& scene, std::size_t drive);

/// Note about an electrode with a face on either side of the beam that pulls the switch at rest away from the contact.
inline constexpr std::string_view pulls_away = "it pulls away from the contact; its other side is nearer";

struct DescribedEffects;

struct PreparedScene {
  Scene scene;
  Switch model;
  std::map<std::string, ElectrodePullIn> pull_in;  ///< pull-in voltages by electrode, if waveforms or limits need them as units
  /// Pull-in voltages with the other drives at 0 V, for voltage limits. An electrode has an entry if only its limits are in Vsp
  /// or Vdp, and if it has no pull-in voltages under the levels of the other drives.
  std::map<std::string, PullInVoltages> pull_in_of_limits = {};
  Drives drives;         ///< voltage sources by drive; a source with a resistance charges the capacitance of the open switch
  double duration = 0;   ///< simulated time of the scene [s]
  double tolerance = 0;  ///< relative tolerance of the integrator for the scene
  /// Time from which on the drives stay constant at their levels just before this time [s]; set by closing_of() for a scene
  /// with an opening.
  double held_from = std::numeric_limits<double>::infinity();
  SwitchOptions quadrature = {};
  double quadrature_accuracy = 0;  ///< relative accuracy of the loads for which the quadrature was chosen
  /// The scene with all described effects, and the effects that effects = "auto" left out; null without effects = "auto". The
  /// member `scene` lacks the effects that were left out.
  std::shared_ptr<const DescribedEffects> effects = {};

  /// Returns the names of the drives in the order of Switch::drives().
  [[nodiscard]] std::vector<std::string> drive_names() const { return softland::drive_names(scene.device); }
  /// Returns one waveform per drive, in the order of drive_names(); a drive without a waveform stays at 0 V.
  [[nodiscard]] std::vector<Waveform> in_drive_order(const DriveWaveforms& waveforms) const;
  /// Returns the scene's own waveforms in the order of drive_names(); `instead` replaces those of the drives that it names.
  [[nodiscard]] std::vector<Waveform> waveforms(const DriveWaveforms& instead = {}) const;
  /// Returns the level of every drive before t = 0, in the order of drive_names() [V].
  [[nodiscard]] std::vector<double> values_before() const;
  /// Returns the state in which runs start: open or closed.
  [[nodiscard]] StartState start() const { return scene.begins_closed ? StartState::closed : StartState::open; }
  /// Returns the equilibrium of the open switch under the levels before t = 0; none if it is not stable or does not exist.
  [[nodiscard]] std::optional<Eigen::VectorXd> rest() const { return model.open_equilibrium(values_before()); }
  /// Returns the equilibrium in which runs start: the open equilibrium, or the stable closed equilibrium if the scene begins
  /// closed. Empty if this equilibrium does not exist.
  [[nodiscard]] std::optional<Eigen::VectorXd> start_equilibrium() const;
  /// Returns the commanded signal of drive k for a waveform: the waveform from t = 0 on, and the scene's level before. Throws
  /// the exceptions of signal().
  [[nodiscard]] Signal commanded(std::size_t k, const Waveform& waveform) const;
  /// Returns one commanded signal per drive, in the order of drive_names().
  [[nodiscard]] std::vector<Signal> commanded(const std::vector<Waveform>& waveforms) const;
  /// Returns the applied voltage of every drive, in the order of drive_names(); a drive without a waveform stays at 0 V.
  [[nodiscard]] std::vector<Signal> signals() const;
  [[nodiscard]] std::vector<Signal> applied(const std::vector<Waveform>& waveforms) const {
    return applied(commanded(waveforms));
  }
  /// Returns the applied voltages for these commanded signals, one per drive, in the order of drive_names().
  [[nodiscard]] std::vector<Signal> applied(std::vector<Signal> commanded) const;
  /// Returns the applied voltage of drive k for a commanded signal. Gain, offset and delay of its source are those of the
  /// scene, or `errors`.
  [[nodiscard]] Signal applied(std::size_t k, const Signal& commanded) const { return applied(k, commanded, drives[k].errors); }
  [[nodiscard]] Signal applied(std::size_t k, const Signal& commanded, const SourceErrors& errors) const;
  /// Returns the commanded signal as the samples of drive k's converter; unchanged if the source of the drive does not sample.
  [[nodiscard]] Signal commanded_samples(std::size_t k, const Signal& commanded) const;
  /// Returns the limits of the voltage source of drive k; no limits if the scene has none.
  [[nodiscard]] DriverLimits limits(std::size_t k) const { return drives[k].limits.value_or(DriverLimits{}); }
  /// Returns the pull-in voltages of the electrodes, which are the units Vsp and Vdp [V].
  [[nodiscard]] std::map<std::string, PullInVoltages> voltage_units() const;
  /// Returns the scene with every default written out and all voltages in volts.
  [[nodiscard]] SceneFile resolved() const { return softland::resolved(scene, voltage_units()); }
};

/// Returns the reason why the waveforms of another scene begin at other levels than the waveforms of `scene`; empty if the
/// levels are the same. `before` has the level of each drive of the other scene before t = 0; a missing drive is at 0 V.
[[nodiscard]] std::string initial_state_difference(const DriveWaveforms& waveforms, const std::map<std::string, double>& before,
                                                   const PreparedScene& scene);

/// Throws InvalidInput, with the key that sets the start state, if runs begin closed. Studies that close the switch from its
/// open state call this function. `study` says in the third person what the study does: "accuracy closes the switch".
void require_open_start(const Scene& scene, std::string_view study);

/// Returns the key of the state in which a run begins, such as "waveform.main.before_state": of the first drive that has this
/// key or is not at 0 V before t = 0, else of the first drive that has a waveform.
[[nodiscard]] std::string before_state_path(const PreparedScene& scene);

/// Returns a hint for error messages that says how to start runs in the other state, open or closed:
/// "; waveform.main.before_state = "closed" begins there".
[[nodiscard]] std::string other_start_hint(const PreparedScene& scene);

/// Describes the state in which runs begin, or the other start state if the requested state does not exist. Empty if runs begin
/// open and at 0 V.
[[nodiscard]] std::string start_prose(const PreparedScene& scene);

/// Returns the integrator tolerance for a relative `accuracy` of t_i, v_i, B_H (contact time, velocity, rebound) and peak
/// force.
[[nodiscard]] double tolerance_for(double accuracy, bool stiff = false);  ///< `stiff`: the scene has a compressible gas film

/// Finds the pull-in voltages of an electrode of a switch, by its number, under a bias of the other drives. The function is
/// electrode_pull_in(), or a function that remembers earlier results of electrode_pull_in().
using PullInFinder =
    std::function<ElectrodePullIn(const Switch& model, std::size_t electrode, Bias bias, const Progress& progress)>;
[[nodiscard]] ElectrodePullIn electrode_pull_in(const Switch& model, std::size_t electrode, Bias bias,
                                                const Progress& progress = {});

/// Prepares a scene for statics: reads the scene and composes its switch. Pull-in voltages, drives, simulated time and
/// tolerance are not computed, and there are no warnings about the quadrature. Throws the exceptions of read_scene().
[[nodiscard]] PreparedScene prepare_statics(const SceneFile& file);

/// Reads, composes and resolves a scene. Pull-in voltages are computed for the electrodes whose waveforms or
/// limits are in units of them, and with `default_limits` for all electrodes. Choices that the scene leaves open are not made yet
/// (auto_settings.h): modes = "auto" stands for a default number, and effects = "auto" for all effects. Throws InvalidInput for
/// an invalid scene, and for a scene whose pull-in voltage is needed and does not exist. Throws Interrupted if `progress` asks
/// to stop.
[[nodiscard]] PreparedScene prepare(const SceneFile& file, bool default_limits = false, const Progress& progress = {},
                                    const PullInFinder& find_pull_in = electrode_pull_in);

}  // namespace softland
