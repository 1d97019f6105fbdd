// The computation of an exploration at a point of its plan: one row of figures, and a status. A point depends on its scene and
// on the options of the study only; every row is the result of the verb of the same name for the scene of its point, to the
// bit.
//
//   simulate    every figure of merit of the closing under the scene's waveforms, with `certify` their errors too. Closings run
//               one at a time: in lanes (model/ensemble/fleet.h) their last digits would differ.
//   pull-in     static and dynamic pull-in voltage and release voltage; for a switch without electrodes the factors of the
//               dispersion force
//   robustness  yields and quantiles of the figures over `samples` varied devices as [spread] says, under the scene's own
//               waveforms
//   limit, release, effects, check
//               the numbers of the verb's record: the columns are those of the record of the plan's own scene
//   optimize    a whole search on the nominal device, which does not begin with half its budget as that of the verb: the
//               figures of the waveform found, its parameters, the goal, and the plain step's figures beside them
//
// A point never throws: an impossible scene has the status `infeasible` and the reason, numerical trouble its own status.
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
#include "studies/devices/row_status.h"
#include "studies/exploration/pull_in_memory.h"
#include "studies/search/figure_columns.h"

namespace softland {

enum class PointStudy { simulate, pull_in, robustness, optimize };
inline constexpr auto point_studies = std::to_array<Named<PointStudy>>({{PointStudy::simulate, "simulate"},
                                                                        {PointStudy::pull_in, "pull-in"},
                                                                        {PointStudy::robustness, "robustness"},
                                                                        {PointStudy::optimize, "optimize"}});
static_assert(is_complete<point_studies>());

/// A study that is registered from outside: any verb that takes one scene.
struct OtherStudy {
  using Options = std::map<std::string, std::string>;
  /// The numbers of its record, "touch.least_time_s", and its status. Yes or no is 1 or 0.
  struct Record {
    std::string status;
    std::vector<std::pair<std::string, double>> numbers;
  };

  std::string name;
  /// Throws InvalidInput if an option is not one of the study, or breaks its rule.
  std::function<void(const Options&)> check;
  /// Throws Interrupted if `watch` asks to stop, and InvalidInput.
  std::function<Record(const SceneFile&, const Options&, std::uint64_t seed, int jobs, const Watch&)> record;
};
using OtherStudies = std::vector<OtherStudy>;

struct PointRow {
  std::string status;
  std::string reason = {};
  std::vector<double> figures;  ///< figures as Exploration::figures(); NaN: not available
  std::string scene = {};       ///< scene with the found waveform, which `simulate` runs to the same figures; for a search
  /// Waveforms of a search as straight lines, for plots [s], [V], by drive.
  std::map<std::string, std::vector<std::pair<double, double>>> waveforms = {};
};

/// Checks the study and its options, and writes out those that are not given, so that the plan does not depend on defaults.
/// Throws InvalidInput, beginning with the place of the entry.
void complete(PlanRequest& request, const OtherStudies& others = {});

class Exploration {
 public:
  /// The plan's study must be complete. `columns` are those of the record of another study, if known; else the record of the
  /// plan's own scene is made for them. Throws InvalidInput if the scene of the plan lacks what the study needs.
  explicit Exploration(Plan plan, const Watch& watch = {}, const OtherStudies& others = {},
                       std::vector<PointFigure> columns = {});

  [[nodiscard]] const Plan& plan() const { return plan_; }
  [[nodiscard]] const std::vector<PointFigure>& figures() const { return figures_; }
  /// The text of everything that decides the row of a scene: equal texts have equal rows.
  [[nodiscard]] std::string content(const SceneFile& scene) const;
  /// The drives of a scene of the plan as broken lines [s, V]; none for an impossible scene.
  [[nodiscard]] std::map<std::string, std::vector<std::pair<double, double>>> waveforms(const SceneFile& scene,
                                                                                        const Watch& watch = {});
  /// The row of a scene of the plan. May be called on any thread; `jobs` threads for one point do not change it. Throws
  /// Interrupted if `watch` asks to stop.
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
  std::optional<PointStudy> study_;  // none: the study is other_
  std::optional<OtherStudy> other_;
  std::vector<PointFigure> figures_;
  AskedFigures asked_ = {};              // figures that the scene of the plan asks for
  std::vector<std::string> parameters_;  // parameters of a search
  bool shares_switches_ = false;         // points of the plan may have the same switch
  PullInMemory pull_in_;
};

}  // namespace softland
