// A scene made ready for a search: the plain step as reference of all candidates, the waveforms that may be tried, and the
// score of a candidate on the nominal device.
//
// The baseline is a step of the searched electrode to the scene's hold level. It has no rise time unless the driver's slew
// limit asks for one. The piezo stays at 0 V unless it is the only drive, which then steps to its hold level. Every candidate
// is scored over a fixed time after its own first contact and until one period in contact after its last breakpoint. It must
// touch within 2.5 times the baseline's first-touch time and stay inside the driver's limits. It is infeasible if the beam
// comes near the electrode.
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

/// Costs from here on are of waveforms that never touch: see cost().
inline constexpr double never_touched = 10;

struct RecordedClosing;
/// The point that was priced last, and its closing, which the gradient there reuses.
struct LastClosing {
  std::vector<double> x = {};
  std::shared_ptr<const RecordedClosing> closing = {};
};

/// A switch with more modes than the scene's.
struct RicherBeam {
  Switch model;
  double closed_potential = std::numeric_limits<double>::quiet_NaN();  ///< see ClosingOptions
};

struct SearchSetting {
  Aim target;
  std::vector<Condition> conditions;  ///< conditions for a landing, on conditioned_figures
  PreparedScene given;                ///< the given scene
  PreparedScene baseline_scene;       ///< the scene under the plain step
  Closing baseline;
  CostScale scale;
  double baseline_cost = 0;
  ClosingOptions run;  ///< run of a candidate
  SearchSpace space;
  std::size_t family = 0;                      ///< its number among those that share a memory
  std::map<std::string, DriverLimits> limits;  ///< limits of searched waveforms: those of the drivers, or gentler edges
  /// Richer beams: if there are any, a candidate is priced by the worst of its closings with the scene's modes and with these.
  std::vector<RicherBeam> richer = {};

  /// The scene with these waveforms of the searched drives; the others stand as in the baseline. Throws InvalidInput if a scene
  /// file cannot hold one.
  [[nodiscard]] SceneFile scene(const DriveWaveforms& searched) const;
  /// The scene at a point; none if a scene file cannot hold its waveforms.
  [[nodiscard]] std::optional<SceneFile> scene_at(std::span<const double> x) const;
  /// The same ready to run: prepared_with().
  [[nodiscard]] PreparedScene prepared(const DriveWaveforms& searched) const;
  /// One waveform per drive of the switch, in its order.
  [[nodiscard]] std::vector<Waveform> drives(const DriveWaveforms& searched) const;
  /// True if the searched drives stay inside their limits.
  [[nodiscard]] bool is_allowed(const DriveWaveforms& searched) const;
  /// Commanded signals of all drives, or nothing if the searched ones leave their limits.
  [[nodiscard]] std::optional<std::vector<Signal>> allowed_commands(const DriveWaveforms& searched) const;
  /// Options of the run of a candidate under these signals.
  [[nodiscard]] ClosingOptions run_of(const std::vector<Signal>& signals) const;
  [[nodiscard]] SearchCosts price(const std::vector<Signal>& signals) const;
  /// Prices a point of the search space on the nominal device; infinite if it leaves the limits of a driver. Results in
  /// `memory` are not simulated again; a simulated closing becomes `last`.
  [[nodiscard]] SearchCosts cost_at(std::span<const double> x, EvaluationMemory* memory = nullptr,
                                    LastClosing* last = nullptr) const;
  /// The gradient of a cost at a point of the search space, by the parameters, on the nominal device. The gradients of
  /// followed_conditions() come after it, as in Conditions::gradients. Exact except where touches graze; NaN where no gradient
  /// exists. `groups`, which hold for all points or are not used, and `last`, if it is of this point, give the same numbers
  /// sooner.
  [[nodiscard]] std::vector<double> gradient_at(std::span<const double> x, const Aim& aim,
                                                const std::vector<ParameterGroup>& groups = {},
                                                const LastClosing* last = nullptr) const;
  /// The parameters, grouped by the pieces of the signals that they move.
  [[nodiscard]] std::vector<ParameterGroup> parameter_groups() const;
  /// Derivatives of the signals of all drives by the parameters.
  [[nodiscard]] SignalSlopes signal_slopes(std::span<const double> x, const std::vector<ParameterGroup>& groups = {}) const;
  /// The conditions that a method with a gradient follows by itself: those on figures that have one. Counts change by jumps,
  /// and only affect the cost.
  [[nodiscard]] std::vector<Condition> followed_conditions() const;
  /// Why a cost or a condition has no gradient here, in words; empty if all have.
  [[nodiscard]] std::string gradient_refusal(const Aim& aim) const;
  /// Throws InvalidInput with the name of the first that a search cannot begin with, and the reason.
  void check_starts(const std::vector<StartingWaveforms>& starts) const;
  /// True if the scene holds no waveform but the plain step.
  [[nodiscard]] bool starts_as_step() const;
  /// The scene with the limits of searched waveforms in its drivers.
  [[nodiscard]] PreparedScene within_limits() const;

 private:
  /// Adds the figures that a run of a search does not measure.
  [[nodiscard]] Metrics with_rest_and_drives(Metrics metrics, const std::vector<Signal>& signals) const;
  [[nodiscard]] SearchCosts price_of(const RecordedClosing& closing) const;
  [[nodiscard]] bool keeps_limits(const std::string& drive, const Waveform& waveform, const Signal& commanded) const;
  [[nodiscard]] SearchCosts worst_price(const RecordedClosing& closing) const;
};

/// Throws InvalidInput if the scene does not ask for the figure of a condition.
void require_asked(const Condition& condition, const AskedFigures& asked);

/// Throws InvalidInput for a scene or a family that cannot be searched; Interrupted if `progress` asks to stop.
[[nodiscard]] SearchSetting search_setting(const SceneFile& file, const Aim& target, Actuator actuator, const std::string& family,
                                           const Progress& progress, std::vector<Condition> conditions = {},
                                           const OwnWaveforms& own = {});

/// Returns one setting for each of the named families: families_of(). They differ in family and space alone.
[[nodiscard]] std::vector<SearchSetting> search_settings(const SceneFile& file, const Aim& target, Actuator actuator,
                                                         const std::string& families, const Progress& progress,
                                                         std::vector<Condition> conditions = {}, const OwnWaveforms& own = {});
/// The parameters of all families, by drive.name, or by family.drive.name if there are several.
[[nodiscard]] FamilyColumns searched_columns(const std::vector<SearchSetting>& settings, const std::string& families);

/// Sum of the violations of the conditions, each at most 10.
[[nodiscard]] double broken(const std::vector<Condition>& conditions, const Metrics& metrics);

/// The scene of `prepared` in volts, with other waveforms on some drives.
[[nodiscard]] SceneFile with_waveforms(const PreparedScene& prepared, const DriveWaveforms& waveforms);
/// True if a scene file can hold them all: none is a user's own.
[[nodiscard]] bool can_be_written(const DriveWaveforms& waveforms);
/// The scene of `prepared` with other waveforms on some drives, ready to run: read_back() of its text, with the parts that no
/// text can hold added to it.
[[nodiscard]] PreparedScene prepared_with(const PreparedScene& prepared, DriveWaveforms waveforms, const PreparedScene& given);
/// The scene's text, read back: a user's `simulate best.toml` runs the same. Warnings stay those about the file that the user
/// wrote.
[[nodiscard]] PreparedScene read_back(const SceneFile& file, const std::string& name, const PreparedScene& given);

}  // namespace softland
