// A scene prepared for a search: the plain step as baseline, the space of waveforms that may be tried, and the cost of a
// candidate on the nominal device.
//
// The baseline is a step of the searched electrode to the scene's hold level. The step has no rise time unless the voltage
// source's slew is limited. The piezo stays at 0 V unless the piezo is the only drive; then it steps to its hold level. Every
// candidate waveform is scored over a fixed time after its first contact and until one period in contact after its waveforms'
// last breakpoint. A candidate must touch within 2.5 times the baseline's time of first contact and stay within the voltage
// sources' limits. A candidate is infeasible if the beam comes near the electrode.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/condition.h"
#include "objectives/cost.h"
#include "studies/closing/simulate.h"
#include "studies/search/evaluation_memory.h"
#include "studies/search/guided_search.h"
#include "studies/search/search_space.h"
#include "waveforms/signal_slopes.h"

namespace softland {

/// A waveform with this cost or more does not bring the switch to its contact: see cost().
inline constexpr double never_touched = 10;

struct RecordedClosing;
/// The point of the search space whose cost was computed last, with its simulated closing, which a gradient at this point uses
/// again.
struct LastClosing {
  std::vector<double> x = {};
  std::shared_ptr<const RecordedClosing> closing = {};
};

/// The switch of the scene, modelled with more modes.
struct RicherBeam {
  Switch model;
  /// Potential energy of this model in its closed state [J], see ClosingOptions::closed_potential.
  double closed_potential = std::numeric_limits<double>::quiet_NaN();
};

struct SearchSetting {
  Aim target;
  std::vector<Condition> conditions;  ///< conditions on conditioned_figures that a closing must fulfil
  PreparedScene given;                ///< the scene that the user gave
  PreparedScene baseline_scene;       ///< the scene with the waveforms of the plain step
  Closing baseline;
  CostScale scale;
  double baseline_cost = 0;
  ClosingOptions run;  ///< options for simulating the closing of a candidate waveform
  SearchSpace space;
  /// Number of the waveform family, by which a memory of evaluations distinguishes the families of a search.
  std::size_t family = 0;
  /// Limits of the searched waveforms by drive: those of the voltage sources, or slower voltage edges.
  std::map<std::string, DriverLimits> limits;
  /// Models of the switch with more modes. If there are any, the cost of a candidate waveform is the worst over its closings
  /// with the scene's modes and with these models.
  std::vector<RicherBeam> richer = {};

  /// Returns the scene with the waveforms `searched`; other drives are as in the plain step. Throws InvalidInput if a scene
  /// file cannot describe one of the waveforms.
  [[nodiscard]] SceneFile scene(const DriveWaveforms& searched) const;
  /// Returns the scene with the waveforms of the point `x` of the search space; none if a scene file cannot describe these
  /// waveforms.
  [[nodiscard]] std::optional<SceneFile> scene_at(std::span<const double> x) const;
  /// Returns the scene with the waveforms `searched`, ready to run: see prepared_with().
  [[nodiscard]] PreparedScene prepared(const DriveWaveforms& searched) const;
  /// Returns one waveform per drive, in the order of Switch::drives(): `searched`, and the plain step for the other drives.
  [[nodiscard]] std::vector<Waveform> drives(const DriveWaveforms& searched) const;
  /// True if the waveforms stay within the limits of their voltage sources.
  [[nodiscard]] bool is_allowed(const DriveWaveforms& searched) const;
  /// Returns the commanded signals of all drives, or nothing if one of `searched` exceeds the limits of its voltage source.
  [[nodiscard]] std::optional<std::vector<Signal>> allowed_commands(const DriveWaveforms& searched) const;
  /// Returns the options for simulating a candidate waveform with the given drive signals.
  [[nodiscard]] ClosingOptions run_of(const std::vector<Signal>& signals) const;
  [[nodiscard]] SearchCosts price(const std::vector<Signal>& signals) const;
  /// Computes the costs of a point of the search space on the nominal device; infinite if the waveforms leave the limits of a
  /// voltage source. Costs in `memory` are not computed again; a simulated closing is stored in `last`.
  [[nodiscard]] SearchCosts cost_at(std::span<const double> x, EvaluationMemory* memory = nullptr,
                                    LastClosing* last = nullptr) const;
  /// Returns the gradient of the cost of `aim` by the waveform parameters, at a point on the nominal device, then the gradients
  /// of followed_conditions(), as in Conditions::gradients. Exact except at grazing contacts; NaN where no gradient exists.
  /// `groups` (of parameter_groups()) and `last` (the closing at this point, if known) only save time.
  [[nodiscard]] std::vector<double> gradient_at(std::span<const double> x, const Aim& aim,
                                                const std::vector<ParameterGroup>& groups = {},
                                                const LastClosing* last = nullptr) const;
  /// Returns groups of waveform parameters that change different pieces of the drive signals, and can be differentiated
  /// together.
  [[nodiscard]] std::vector<ParameterGroup> parameter_groups() const;
  /// Returns the derivatives of the signals of all drives by the waveform parameters.
  [[nodiscard]] SignalSlopes signal_slopes(std::span<const double> x, const std::vector<ParameterGroup>& groups = {}) const;
  /// Returns the conditions that a gradient-based optimizer handles as constraints: those on figures with a gradient. Other
  /// conditions, on counts, only add to the cost.
  [[nodiscard]] std::vector<Condition> followed_conditions() const;
  /// Returns the reason why the cost of `aim` or a condition has no gradient, as text; empty if all have gradients.
  [[nodiscard]] std::string gradient_refusal(const Aim& aim) const;
  /// Throws InvalidInput with the name of the start and the reason if the search cannot begin with one of `starts`.
  void check_starts(const std::vector<StartingWaveforms>& starts) const;
  /// True if the waveforms of the scene itself are the plain step.
  [[nodiscard]] bool starts_as_step() const;
  /// Returns the scene with `limits` as the limits of its voltage sources.
  [[nodiscard]] PreparedScene within_limits() const;

 private:
  /// Adds figures that the simulation of a candidate does not compute: of the closed switch at rest, and of the drive signals.
  [[nodiscard]] Metrics with_rest_and_drives(Metrics metrics, const std::vector<Signal>& signals) const;
  [[nodiscard]] SearchCosts price_of(const RecordedClosing& closing) const;
  [[nodiscard]] bool keeps_limits(const std::string& drive, const Waveform& waveform, const Signal& commanded) const;
  [[nodiscard]] SearchCosts worst_price(const RecordedClosing& closing) const;
};

/// Throws InvalidInput if the scene does not request the computation of the condition's figure.
void require_asked(const Condition& condition, const AskedFigures& asked);

/// Prepares a scene for a search in one waveform family. Throws InvalidInput for a scene or a waveform family that cannot be
/// searched, and Interrupted if `progress` asks to stop.
[[nodiscard]] SearchSetting search_setting(const SceneFile& file, const Aim& target, Actuator actuator, const std::string& family,
                                           const Progress& progress, std::vector<Condition> conditions = {},
                                           const OwnWaveforms& own = {});

/// Returns one setting for each waveform family in `families`: see families_of(). The settings differ in `family` and `space`
/// only.
[[nodiscard]] std::vector<SearchSetting> search_settings(const SceneFile& file, const Aim& target, Actuator actuator,
                                                         const std::string& families, const Progress& progress,
                                                         std::vector<Condition> conditions = {}, const OwnWaveforms& own = {});
/// Returns the parameters of all waveform families, named drive.name, or family.drive.name if there are several families.
[[nodiscard]] FamilyColumns searched_columns(const std::vector<SearchSetting>& settings, const std::string& families);

/// Returns the sum of the relative violations of the conditions, each at most 10.
[[nodiscard]] double broken(const std::vector<Condition>& conditions, const Metrics& metrics);

/// Returns the scene of `prepared` in volts, with `waveforms` on their drives.
[[nodiscard]] SceneFile with_waveforms(const PreparedScene& prepared, const DriveWaveforms& waveforms);
/// True if a scene file can describe all waveforms: none comes from the user's code.
[[nodiscard]] bool can_be_written(const DriveWaveforms& waveforms);
/// Returns the scene of `prepared` with `waveforms` on their drives, ready to run: read_back() of its text, with the parts from
/// the user's code, which no text can describe.
[[nodiscard]] PreparedScene prepared_with(const PreparedScene& prepared, DriveWaveforms waveforms, const PreparedScene& given);
/// Reads the scene's text back, so that `simulate best.toml` gives the same numbers. Warnings are those of `given`, the user's
/// file.
[[nodiscard]] PreparedScene read_back(const SceneFile& file, const std::string& name, const PreparedScene& given);

/// Returns the settings for a first tournament: the limits of the searched electrodes are reduced to their default
/// (default_limit() in config/scene.h). `names` are the waveform families of the settings. The result is empty if the scene's
/// limits are not wider, or if the hold level exceeds the default limit.
[[nodiscard]] std::vector<SearchSetting> within_usual_room(const std::vector<SearchSetting>& settings, Actuator actuator,
                                                           const std::vector<std::string>& names);

}  // namespace softland
