// A scene that is ready to run: the switch composed, its pull-in voltages known if a unit needs them, every drive a signal in
// volts.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/watch.h"
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

/// The bias of the other drives for the pull-in voltages of this one: Scene::standing, its own at 0 V.
[[nodiscard]] std::vector<double> bias_of(const Scene& scene, std::size_t drive);

/// Note about an electrode with a face on either side that pulls away from the contact where the switch rests.
inline constexpr std::string_view pulls_away = "it pulls away from the contact; its other side is nearer";

struct DescribedEffects;

struct PreparedScene {
  Scene scene;
  Switch model;
  std::map<std::string, ElectrodePullIn> pull_in;  ///< electrodes whose pull-in was needed
  /// Pull-in voltages with the other drives at 0 V, of electrodes whose limits alone are in Vsp or Vdp, and which have none
  /// under the levels of the other drives.
  std::map<std::string, PullInVoltages> pull_in_of_limits = {};
  Drives drives;         ///< drives in volts; the load of a source with a resistance is the open switch
  double duration = 0;   ///< window [s]
  double tolerance = 0;  ///< tolerance of the integrator
  /// Time from which on the drives stay at their levels just before [s]: see closing_of().
  double held_from = std::numeric_limits<double>::infinity();
  SwitchOptions quadrature = {};
  double quadrature_accuracy = 0;  ///< accuracy for which it was chosen
  /// The described effects, and those that effects = "auto" left out. The scene above is the one without them.
  std::shared_ptr<const DescribedEffects> effects = {};

  /// Names of the drives in the order of Switch::drives().
  [[nodiscard]] std::vector<std::string> drive_names() const { return softland::drive_names(scene.device); }
  /// One waveform per drive in that order; a drive without one stays at 0 V.
  [[nodiscard]] std::vector<Waveform> in_drive_order(const DriveWaveforms& waveforms) const;
  /// The scene's own waveforms in that order, with those of `instead` for some drives.
  [[nodiscard]] std::vector<Waveform> waveforms(const DriveWaveforms& instead = {}) const;
  /// Level of every drive before t = 0, in that order [V].
  [[nodiscard]] std::vector<double> values_before() const;
  /// The state in which runs start.
  [[nodiscard]] StartState start() const { return scene.begins_closed ? StartState::closed : StartState::open; }
  /// The open switch at rest under those levels. None without a stable equilibrium.
  [[nodiscard]] std::optional<Eigen::VectorXd> rest() const { return model.open_equilibrium(values_before()); }
  /// The equilibrium in which runs start: that, or the stable closed one if the scene begins closed. Empty if it does not
  /// exist.
  [[nodiscard]] std::optional<Eigen::VectorXd> start_equilibrium() const;
  /// The commanded signal of drive k for a waveform of its own or another: the waveform from t = 0 on, and the scene's level
  /// before. Throws as signal() does.
  [[nodiscard]] Signal told(std::size_t k, const Waveform& waveform) const;
  /// One commanded signal per drive in that order.
  [[nodiscard]] std::vector<Signal> told(const std::vector<Waveform>& waveforms) const;
  /// One signal per drive in that order, as applied by its source; a drive without one stays at 0 V.
  [[nodiscard]] std::vector<Signal> signals() const;
  [[nodiscard]] std::vector<Signal> driven(const std::vector<Waveform>& waveforms) const { return driven(told(waveforms)); }
  /// The outputs of the sources for these commanded signals, one per drive in that order.
  [[nodiscard]] std::vector<Signal> driven(std::vector<Signal> told) const;
  /// The output of the source of drive k for a signal, with gain, offset and delay of the scene, or with others.
  [[nodiscard]] Signal driven(std::size_t k, const Signal& told) const { return driven(k, told, drives[k].errors); }
  [[nodiscard]] Signal driven(std::size_t k, const Signal& told, const SourceErrors& errors) const;
  /// The commanded samples of its converter; the commanded signal if it takes none.
  [[nodiscard]] Signal told_samples(std::size_t k, const Signal& told) const;
  /// The limits of drive k; no limits if the scene has none.
  [[nodiscard]] DriverLimits limits(std::size_t k) const { return drives[k].limits.value_or(DriverLimits{}); }
  /// The pull-in voltages as units.
  [[nodiscard]] std::map<std::string, PullInVoltages> voltage_units() const;
  /// The scene with all of its open values computed.
  [[nodiscard]] SceneFile resolved() const { return softland::resolved(scene, voltage_units()); }
};

/// Why waveforms of a scene whose drives stand at `before` do not begin as those of this one do; empty if they do. `before` is
/// by drive; a missing drive stands at 0 V.
[[nodiscard]] std::string begins_elsewhere(const DriveWaveforms& waveforms, const std::map<std::string, double>& before,
                                           const PreparedScene& scene);

/// Throws InvalidInput about the key of a scene whose runs begin closed, for a study that closes the switch from its open
/// state. `study` says what it does, in the third person.
void require_open_start(const Scene& scene, std::string_view study);

/// "waveform.main.before_state": the key of the state in which a run begins. It belongs to the first drive that has it or is
/// not at 0 V before t = 0, else to the first drive that has a waveform.
[[nodiscard]] std::string before_state_path(const PreparedScene& scene);

/// "; waveform.main.before_state = "closed" begins there": a hint to the other start state than the one that is missing.
[[nodiscard]] std::string other_start_hint(const PreparedScene& scene);

/// Words for the state in which runs begin, or for the other one if that does not exist; empty if the scene has no words about
/// it.
[[nodiscard]] std::string start_words(const PreparedScene& scene);

/// Integrator tolerance that delivers a relative `accuracy` of t_i, v_i, B_H and the peak force.
[[nodiscard]] double tolerance_for(double accuracy, bool stiff = false);  ///< `stiff`: with a compressible film

/// Finds the pull-in voltages of an electrode of a switch, by its number, under a bias of the other drives:
/// electrode_pull_in(), or a memory of its results.
using PullInFinder = std::function<ElectrodePullIn(const Switch& model, std::size_t electrode, Bias bias, const Watch& watch)>;
[[nodiscard]] ElectrodePullIn electrode_pull_in(const Switch& model, std::size_t electrode, Bias bias, const Watch& watch = {});

/// Prepares a scene for statics: it is read and its switch composed, but no pull-in voltage is found, and no drive, window or
/// tolerance is known. It has no warnings of the quadrature. Throws as read_scene() does.
[[nodiscard]] PreparedScene prepare_statics(const SceneFile& file);

/// Reads, composes and resolves a scene. Pull-in voltages are computed for the electrodes that need them (and, with
/// `default_limits`, for all that have no written limit). The choices of the scene are not made yet (auto_settings.h): modes =
/// "auto" stands for the usual number, effects = "auto" for all of them.
/// Throws InvalidInput for a bad scene, or for one whose pull-in voltage is needed and does not exist; Interrupted if `watch`
/// asks to stop.
[[nodiscard]] PreparedScene prepare(const SceneFile& file, bool default_limits = false, const Watch& watch = {},
                                    const PullInFinder& find_pull_in = electrode_pull_in);

}  // namespace softland
