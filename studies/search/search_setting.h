// A scene made ready for a search: the plain step that every candidate is measured by, the waveforms that may be tried, and how a
// candidate is scored on the nominal device.
//
// Baseline: a step of the searched electrode to the scene's hold level, without rise time unless the driver's slew limit asks for
// one, piezo 0 V unless it is the only drive, which then steps to its hold level. Every candidate is scored over a fixed time
// after its own first contact and until one period in contact after its last breakpoint, must touch within 2.5 times the
// baseline's first-touch time, stays inside the driver's limits, and is infeasible if the beam comes near the electrode.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/criterion.h"
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
/// The point that was priced last, and its closing: the gradient there needs no other.
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
  std::vector<Criterion> conditions;  ///< that a landing has to fulfil, on conditioned_figures
  PreparedScene given;                ///< the scene
  PreparedScene baseline_scene;       ///< under the plain step
  Closing baseline;
  CostScale scale;
  double baseline_cost = 0;
  ClosingOptions run;  ///< of a candidate
  SearchSpace space;
  std::size_t family = 0;                      ///< its number among those that share a memory
  std::map<std::string, DriverLimits> limits;  ///< that searched waveforms keep: those of the drivers, or gentler edges
  /// Where there are any, a candidate is priced by the worst of its closings with the scene's modes and with these.
  std::vector<RicherBeam> richer = {};

  /// The scene with these waveforms of the searched drives; the others stand as in the baseline. Throws InvalidInput where one
  /// cannot be written into a scene.
  [[nodiscard]] SceneFile scene(const DriveWaveforms& searched) const;
  /// The same ready to run: prepared_with().
  [[nodiscard]] PreparedScene prepared(const DriveWaveforms& searched) const;
  /// One waveform per drive of the switch, in its order.
  [[nodiscard]] std::vector<Waveform> drives(const DriveWaveforms& searched) const;
  /// Whether the searched drives stay inside their limits.
  [[nodiscard]] bool is_allowed(const DriveWaveforms& searched) const;
  /// What the sources of all drives are told where they do; else nothing.
  [[nodiscard]] std::optional<std::vector<Signal>> allowed_told(const DriveWaveforms& searched) const;
  /// How a candidate under these signals is run.
  [[nodiscard]] ClosingOptions run_of(const std::vector<Signal>& signals) const;
  [[nodiscard]] SearchCosts price(const std::vector<Signal>& signals) const;
  /// Of a point of the search space, on the nominal device; infinite where it leaves the limits of a driver. What `memory` holds
  /// is not simulated again; what is, becomes `last`.
  [[nodiscard]] SearchCosts price_at(std::span<const double> x, EvaluationMemory* memory = nullptr,
                                     LastClosing* last = nullptr) const;
  /// The gradient of a cost at a point of the search space, by the parameters, and after it that of each of
  /// followed_conditions(), as Conditions::gradients: of the nominal device, exact but where touches graze. NaN where there is
  /// none. The same numbers, sooner, with `groups`, which hold for all points or are not used, and where `last` is of this point.
  [[nodiscard]] std::vector<double> gradient_at(std::span<const double> x, const Aim& aim,
                                                const std::vector<ParameterGroup>& groups = {},
                                                const LastClosing* last = nullptr) const;
  /// The parameters by the pieces of the signals that they move.
  [[nodiscard]] std::vector<ParameterGroup> parameter_groups() const;
  /// How the signals of all drives change with the parameters.
  [[nodiscard]] SignalSlopes signal_slopes(std::span<const double> x, const std::vector<ParameterGroup>& groups = {}) const;
  /// The conditions that a method with a gradient follows by itself: those on figures that have one. Of a count, which changes by
  /// jumps, the cost alone tells.
  [[nodiscard]] std::vector<Criterion> followed_conditions() const;
  /// Why a cost has no gradient here, or a condition, in words; empty where they have.
  [[nodiscard]] std::string gradient_refusal(const Aim& aim) const;
  /// Throws InvalidInput with the name of the first that a search cannot begin with, and why.
  void check_starts(const std::vector<StartingWaveforms>& starts) const;
  /// Whether the scene holds no waveform but the plain step.
  [[nodiscard]] bool begins_plainly() const;
  /// The scene, whose drivers have the limits that searched waveforms keep.
  [[nodiscard]] PreparedScene within_limits() const;

 private:
  /// With the figures that a run of a search does not measure.
  [[nodiscard]] Metrics with_rest_and_drives(Metrics metrics, const std::vector<Signal>& signals) const;
  [[nodiscard]] SearchCosts price_of(const RecordedClosing& closing) const;
  [[nodiscard]] bool keeps_limits(const std::string& drive, const Waveform& waveform, const Signal& told) const;
  [[nodiscard]] SearchCosts worst_price(const RecordedClosing& closing) const;
};

/// Throws InvalidInput where the scene does not ask for the figure of a condition.
void require_asked(const Criterion& condition, const AskedFigures& asked);

/// Throws InvalidInput for a scene or a family that cannot be searched; Interrupted where `watch` asks to stop.
[[nodiscard]] SearchSetting search_setting(const SceneFile& file, const Aim& target, Actuator actuator, const std::string& family,
                                           const Watch& watch, std::vector<Criterion> conditions = {},
                                           const OwnWaveforms& own = {});

/// One for each of the families that are named: families_of(). They differ in family and space alone.
[[nodiscard]] std::vector<SearchSetting> search_settings(const SceneFile& file, const Aim& target, Actuator actuator,
                                                         const std::string& families, const Watch& watch,
                                                         std::vector<Criterion> conditions = {}, const OwnWaveforms& own = {});
/// The parameters of all families, by drive.name, of several by family.drive.name.
[[nodiscard]] FamilyColumns searched_columns(const std::vector<SearchSetting>& settings, const std::string& families);

/// By how much a closing breaks the conditions, added up; each by at most 10.
[[nodiscard]] double broken(const std::vector<Criterion>& conditions, const Metrics& metrics);

/// The scene of `prepared` in volts, with other waveforms on some drives.
[[nodiscard]] SceneFile with_waveforms(const PreparedScene& prepared, const DriveWaveforms& waveforms);
/// Whether a scene file can hold them all: none is a user's own.
[[nodiscard]] bool can_be_written(const DriveWaveforms& waveforms);
/// The scene of `prepared` with other waveforms on some drives, ready to run: read_back() of its text, with what no text can hold
/// put in beside it.
[[nodiscard]] PreparedScene prepared_with(const PreparedScene& prepared, DriveWaveforms waveforms, const PreparedScene& given);
/// Text of the scene, read back: what a user's `simulate best.toml` will run. Warnings stay those about the file that the user
/// wrote.
[[nodiscard]] PreparedScene read_back(const SceneFile& file, const std::string& name, const PreparedScene& given);

}  // namespace softland
