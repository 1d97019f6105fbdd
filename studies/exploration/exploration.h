// What an exploration computes at a point of its plan: one row of figures, and how it ended. A point depends on its scene and on
// the options of the study only; every row is what the verb of the same name gives for the scene of its point, to the bit.
//
//   simulate    every figure of merit of the closing under the scene's waveforms, with `certify` their errors too. Closings run
//               one at a time: in lanes (model/ensemble/fleet.h) their last digits would differ.
//   pull-in     static and dynamic pull-in voltage and release voltage; of a switch without electrodes the factors of the
//               dispersion force
//   robustness  yields and quantiles of the figures over `samples` devices that differ as [spread] says, under the scene's own
//               waveforms
//   limit, release, effects, check
//               the numbers of the record that the verb gives: its columns are those of the record of the plan's own scene
//   optimize    a whole search on the nominal device, which does not begin with half its budget as that of the verb: the figures
//               of the waveform found, its parameters, the goal, and the plain step's figures beside them
//
// A point is never an exception: one whose scene cannot be has the status `infeasible` and the reason, numerical trouble its own.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/choice.h"
#include "base/watch.h"
#include "config/plan.h"
#include "objectives/figures.h"
#include "studies/devices/row_status.h"
#include "studies/exploration/pull_in_memory.h"

namespace softland {

enum class PointStudy { simulate, pull_in, robustness, optimize };
inline constexpr auto point_studies = std::to_array<Named<PointStudy>>({{PointStudy::simulate, "simulate"},
                                                                        {PointStudy::pull_in, "pull-in"},
                                                                        {PointStudy::robustness, "robustness"},
                                                                        {PointStudy::optimize, "optimize"}});
static_assert(is_complete<point_studies>());

/// A column of figures.
struct PointFigure {
  std::string quantity;  ///< "impact_velocity"
  std::string name;      ///< for people: "Impact speed"
  std::string unit;      ///< of SI; empty for a count, a share, yes or no (1 or 0)
};

/// Of a searched parameter: "main.level_1_V" is "main.level_1" in V.
[[nodiscard]] PointFigure parameter_figure(const std::string& name);
/// Of a figure of merit, with something before its quantity and after its name.
[[nodiscard]] PointFigure figure_column(const Figure& figure, const std::string& before = {}, const std::string& words = {});

/// A study that is known from outside: any verb that looks at one scene.
struct OtherStudy {
  using Options = std::map<std::string, std::string>;
  /// The numbers of its record, "touch.least_time_s", and how it ended. Yes or no is 1 or 0.
  struct Record {
    std::string status;
    std::vector<std::pair<std::string, double>> numbers;
  };

  std::string name;
  /// Throws InvalidInput where an option is none of the study, or breaks its rule.
  std::function<void(const Options&)> check;
  /// Throws Interrupted where `watch` asks to stop, and InvalidInput.
  std::function<Record(const SceneFile&, const Options&, std::uint64_t seed, int jobs, const Watch&)> record;
};
using OtherStudies = std::vector<OtherStudy>;

struct PointRow {
  std::string status;
  std::string reason = {};
  std::vector<double> figures;  ///< as Exploration::figures(); NaN: there is none
  std::string scene = {};       ///< of a search: that of its waveform, which `simulate` runs to the same figures
  /// Of a search: what drives it, as straight lines to look at [s], [V], by drive.
  std::map<std::string, std::vector<std::pair<double, double>>> waveforms = {};
};

/// Checks the study and its options, and writes out those that are not given, so that the plan does not hang on a default. Throws
/// InvalidInput, beginning with the place of the entry.
void complete(PlanRequest& request, const OtherStudies& others = {});

class Exploration {
 public:
  /// The plan's study must be complete. `columns`: those of the record of another study, where they are known; without them the
  /// record of the plan's own scene is made for them. Throws InvalidInput where the scene of the plan lacks what the study needs.
  explicit Exploration(Plan plan, const Watch& watch = {}, const OtherStudies& others = {},
                       std::vector<PointFigure> columns = {});

  [[nodiscard]] const Plan& plan() const { return plan_; }
  [[nodiscard]] const std::vector<PointFigure>& figures() const { return figures_; }
  /// Everything that decides the row of a scene: equal texts have equal rows.
  [[nodiscard]] std::string content(const SceneFile& scene) const;
  /// The drives of a scene of the plan as broken lines [s, V]; none where the scene cannot be.
  [[nodiscard]] std::map<std::string, std::vector<std::pair<double, double>>> waveforms(const SceneFile& scene,
                                                                                        const Watch& watch = {});
  /// The row of a scene of the plan. May be called on any thread; `jobs` more of them for one point do not change it. Throws
  /// Interrupted where `watch` asks to stop.
  [[nodiscard]] PointRow row(const SceneFile& scene, int jobs = 1, const Watch& watch = {});

 private:
  void list_figures(const Watch& watch);
  [[nodiscard]] PointRow computed(const SceneFile& scene, int jobs, const Watch& watch);
  [[nodiscard]] PointRow simulated(const SceneFile& scene, int jobs, const Watch& watch);
  [[nodiscard]] PointRow pulled_in(const SceneFile& scene, const Watch& watch);
  [[nodiscard]] PointRow on_devices(const SceneFile& scene, int jobs, const Watch& watch);
  [[nodiscard]] PointRow recorded(const SceneFile& scene, int jobs, const Watch& watch);
  [[nodiscard]] PointRow optimized(const SceneFile& scene, int jobs, const Watch& watch);
  [[nodiscard]] PreparedScene prepared(const SceneFile& scene, bool default_limits, const Watch& watch);

  Plan plan_;
  std::optional<PointStudy> study_;  // none: the other one
  std::optional<OtherStudy> other_;
  std::vector<PointFigure> figures_;
  AskedFigures asked_ = {};              // by the scene of the plan
  std::vector<std::string> parameters_;  // of a search
  bool shares_switches_ = false;         // points of the plan may have the same switch
  PullInMemory pull_in_;
};

}  // namespace softland
