// A scene made ready to run: the switch composed, its pull-in voltages known where a unit needs them, every drive a signal in
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

/// What the other drives stand at where the pull-in voltages of this one are asked for: Scene::standing, its own at 0 V.
[[nodiscard]] std::vector<double> bias_of(const Scene& scene, std::size_t drive);

/// What is to be said of an electrode that has a face on either side and pulls away from the contact where the switch rests.
inline constexpr std::string_view pulls_away = "it pulls away from the contact; its other side is nearer";

struct DescribedEffects;

struct PreparedScene {
  Scene scene;
  Switch model;
  std::map<std::string, ElectrodePullIn> pull_in;  ///< electrodes whose pull-in was needed
  /// Of electrodes whose limits alone are in Vsp or Vdp, and which have none under what the other drives stand at: with these at
  /// 0 V.
  std::map<std::string, PullInVoltages> pull_in_of_limits = {};
  Drives drives;         ///< in volts; the load of a source with a resistance is the open switch
  double duration = 0;   ///< window [s]
  double tolerance = 0;  ///< of the integrator
  /// From then on its drives stay at what they are just before [s]: see closing_of().
  double held_from = std::numeric_limits<double>::infinity();
  SwitchOptions quadrature = {};
  double quadrature_accuracy = 0;  ///< that it was chosen for
  /// Where the scene says effects = "auto": what it describes and what was left out. The scene above is the one without.
  std::shared_ptr<const DescribedEffects> effects = {};

  /// Names of the drives in the order of Switch::drives().
  [[nodiscard]] std::vector<std::string> drive_names() const { return softland::drive_names(scene.device); }
  /// One waveform per drive in that order; what has none stays at 0 V.
  [[nodiscard]] std::vector<Waveform> in_drive_order(const DriveWaveforms& waveforms) const;
  /// The same of the scene's own, of some drives with others instead.
  [[nodiscard]] std::vector<Waveform> waveforms(const DriveWaveforms& instead = {}) const;
  /// What every drive stands at before t = 0, in that order [V].
  [[nodiscard]] std::vector<double> values_before() const;
  /// The state in which runs start.
  [[nodiscard]] StartState start() const { return scene.begins_closed ? StartState::closed : StartState::open; }
  /// The open switch at rest under those. None where there is no stable equilibrium.
  [[nodiscard]] std::optional<Eigen::VectorXd> rest() const { return model.open_equilibrium(values_before()); }
  /// The equilibrium in which runs start: that, or the stable closed one where the scene begins closed. Empty where it does not
  /// exist.
  [[nodiscard]] std::optional<Eigen::VectorXd> start_equilibrium() const;
  /// What the source of drive k is told for a waveform of its own or another: that from t = 0 on, and before what the scene says.
  /// Throws as signal() does.
  [[nodiscard]] Signal told(std::size_t k, const Waveform& waveform) const;
  /// One per drive in that order.
  [[nodiscard]] std::vector<Signal> told(const std::vector<Waveform>& waveforms) const;
  /// One signal per drive in that order, as its source gives it; what is not driven stays at 0 V.
  [[nodiscard]] std::vector<Signal> signals() const;
  [[nodiscard]] std::vector<Signal> driven(const std::vector<Waveform>& waveforms) const { return driven(told(waveforms)); }
  /// What the sources make of signals that they are told to give, one per drive in that order.
  [[nodiscard]] std::vector<Signal> driven(std::vector<Signal> told) const;
  /// What the source of drive k makes of a signal, with gain, offset and delay of the scene, or with others.
  [[nodiscard]] Signal driven(std::size_t k, const Signal& told) const { return driven(k, told, drives[k].errors); }
  [[nodiscard]] Signal driven(std::size_t k, const Signal& told, const SourceErrors& errors) const;
  /// The samples that its converter is told; what it is told where it takes none.
  [[nodiscard]] Signal told_samples(std::size_t k, const Signal& told) const;
  /// The limits of drive k: none that a scene does not have.
  [[nodiscard]] DriverLimits limits(std::size_t k) const { return drives[k].limits.value_or(DriverLimits{}); }
  /// The pull-in voltages as units.
  [[nodiscard]] std::map<std::string, PullInVoltages> voltage_units() const;
  /// The scene with everything that it leaves to be worked out.
  [[nodiscard]] SceneFile resolved() const { return softland::resolved(scene, voltage_units()); }
};

/// Why waveforms of a scene whose drives stand at `before` do not begin as those of this one do; empty where they do. `before`:
/// by drive, what is not there stands at 0 V.
[[nodiscard]] std::string begins_elsewhere(const DriveWaveforms& waveforms, const std::map<std::string, double>& before,
                                           const PreparedScene& scene);

/// Throws InvalidInput about the key of a scene whose runs begin closed, for a study that closes the switch from its open state:
/// `study` says what it does, in the third person.
void require_open_start(const Scene& scene, std::string_view study);

/// "waveform.main.before_state": the key that says in which state a run begins, of the first drive that says so or stands at
/// something before t = 0, else of the first drive that has a waveform.
[[nodiscard]] std::string before_state_path(const PreparedScene& scene);

/// "; waveform.main.before_state = "closed" begins there": what leads to the state of the other kind than a run asks for.
[[nodiscard]] std::string other_start_hint(const PreparedScene& scene);

/// Words for the state in which runs begin, or if that does not exist for the other one; empty where a scene says nothing of it.
[[nodiscard]] std::string start_words(const PreparedScene& scene);

/// Integrator tolerance that delivers a relative `accuracy` of t_i, v_i, B_H and the peak force.
[[nodiscard]] double tolerance_for(double accuracy, bool stiff = false);  ///< `stiff`: with a compressible film

/// Finds the pull-in voltages of an electrode of a switch, by its number, under a bias of the other drives: electrode_pull_in(),
/// or who remembers what that has found.
using PullInFinder = std::function<ElectrodePullIn(const Switch& model, std::size_t electrode, Bias bias, const Watch& watch)>;
[[nodiscard]] ElectrodePullIn electrode_pull_in(const Switch& model, std::size_t electrode, Bias bias, const Watch& watch = {});

/// What statics need of a scene: it is read and its switch composed, but no pull-in voltage is found, and no drive, window or
/// tolerance is known. It has no warnings of the quadrature. Throws as read_scene() does.
[[nodiscard]] PreparedScene prepare_statics(const SceneFile& file);

/// Reads, composes and resolves a scene; pull-in voltages are computed for the electrodes that need them (and, with
/// `default_limits`, for all that have no written limit). What the scene leaves to softland is not chosen yet (choices.h):
/// modes = "auto" stands for the usual number, effects = "auto" for all of them.
/// Throws InvalidInput for a bad scene, or one whose pull-in voltage is needed and does not exist; Interrupted where `watch` asks
/// to stop.
[[nodiscard]] PreparedScene prepare(const SceneFile& file, bool default_limits = false, const Watch& watch = {},
                                    const PullInFinder& find_pull_in = electrode_pull_in);

}  // namespace softland
