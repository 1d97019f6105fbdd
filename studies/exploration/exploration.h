// The computation of an exploration at one point of its plan, the stored list of points: a row of figures, and a status. The
// row depends only on the scene of the point and on the options of the study. It is bit for bit the result of the command
// (verb) of the same name for that scene.
//
//   simulate    every figure of merit of the closing under the scene's waveforms, with `certify` also the errors of the
//               figures. Closings run one at a time: in SIMD lanes (model/ensemble/ensemble_closings.h) their last digits would
//               differ.
//   pull-in     static and dynamic pull-in voltage and release voltage; for a switch without electrodes the factors of the
//               dispersion force.
//   robustness  yields and quantiles of the figures over `samples` varied devices of [spread], under the scene's own
//               waveforms.
//   limit, release, effects, check
//               the numbers of the command's record (its results); the record of the plan's own scene gives the columns.
//   optimize    a whole search on the nominal device: the figures of the found waveform, its parameters, whether it meets
//               the goal, and the figures of the plain step; the search never begins with half its budget.
//
// A point whose scene fails throws no exception: the status is `infeasible`, with the reason, for an impossible scene, and
// otherwise that of the numerical failure.
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
#include "base/progress.h"
#include "config/plan.h"
#include "studies/devices/row_status.h"
#include "studies/exploration/pull_in_memory.h"
#include "studies/search/evaluation_store.h"

namespace softland {

enum class PointStudy { simulate, pull_in, robustness, optimize };
inline constexpr auto point_studies = std::to_array<Named<PointStudy>>({{PointStudy::simulate, "simulate"},
                                                                        {PointStudy::pull_in, "pull-in"},
                                                                        {PointStudy::robustness, "robustness"},
                                                                        {PointStudy::optimize, "optimize"}});
static_assert(is_complete<point_studies>());

/// A command (verb) that takes one scene and is registered from outside of this file as a study of explorations.
struct OtherStudy {
  using Options = std::map<std::string, std::string>;
  /// The numbers of a command's record (its results), such as "touch.least_time_s", and its status. Flags are 1 for true, 0 for
  /// false.
  struct Record {
    std::string status;
    std::vector<std::pair<std::string, double>> numbers;
  };

  std::string name;
  /// A function that throws InvalidInput for an option that the study does not have, and for an invalid value of an option.
  std::function<void(const Options&)> check;
  /// A function that returns the record of the command for a scene. Throws InvalidInput for a scene without a record, and
  /// Interrupted if `progress` asks to stop.
  std::function<Record(const SceneFile&, const Options&, std::uint64_t seed, int jobs, const Progress&)> record;
};
using OtherStudies = std::vector<OtherStudy>;

struct PointRow {
  std::string status;
  std::string reason = {};
  std::vector<double> figures;  ///< figures of the point in the order of Exploration::figures(); NaN if not available
  /// Only for points that run a search: scene with the found waveform; `simulate` gives it the same figures.
  std::string scene = {};
  /// Only for points that run a search: waveforms by drive for plots, as the ends of straight lines [s, V].
  std::map<std::string, std::vector<std::pair<double, double>>> waveforms = {};
};

/// Checks the study of a request and its options, and adds the options that are not given, so that the plan (stored request)
/// does not depend on defaults. Throws InvalidInput; the message begins with the place of the invalid entry.
void complete(PlanRequest& request, const OtherStudies& others = {});

class Exploration {
 public:
  /// `plan` is the stored request of the exploration; its study must be complete: see complete(). `columns` are the columns of
  /// the record of a registered study, if known; otherwise the record of the plan's own scene is computed to find them. Throws
  /// InvalidInput if the scene of the plan lacks something that the study needs.
  explicit Exploration(Plan plan, const Progress& progress = {}, const OtherStudies& others = {},
                       std::vector<PointFigure> columns = {});

  [[nodiscard]] const Plan& plan() const { return plan_; }
  [[nodiscard]] const std::vector<PointFigure>& figures() const { return figures_; }
  /// Returns a text that contains everything on which the row of a scene depends: equal texts have equal rows, which are
  /// computed once.
  [[nodiscard]] std::string content(const SceneFile& scene) const;
  /// Returns the drive waveforms of a scene of the exploration as the ends of straight lines [s, V]; none for an impossible
  /// scene.
  [[nodiscard]] std::map<std::string, std::vector<std::pair<double, double>>> waveforms(const SceneFile& scene,
                                                                                        const Progress& progress = {});
  /// Returns the row (status and figures) of a scene of the plan. May be called on any thread; the number `jobs` of threads for
  /// one point does not change the row. Throws Interrupted if `progress` asks to stop.
  [[nodiscard]] PointRow row(const SceneFile& scene, int jobs = 1, const Progress& progress = {});

 private:
  void list_figures(const Progress& progress);
  [[nodiscard]] PointRow computed(const SceneFile& scene, int jobs, const Progress& progress);
  [[nodiscard]] PointRow simulated(const SceneFile& scene, int jobs, const Progress& progress);
  [[nodiscard]] PointRow pulled_in(const SceneFile& scene, const Progress& progress);
  [[nodiscard]] PointRow on_devices(const SceneFile& scene, int jobs, const Progress& progress);
  [[nodiscard]] PointRow recorded(const SceneFile& scene, int jobs, const Progress& progress);
  [[nodiscard]] PointRow optimized(const SceneFile& scene, int jobs, const Progress& progress);
  [[nodiscard]] PreparedScene prepared(const SceneFile& scene, bool default_limits, const Progress& progress);

  Plan plan_;
  std::optional<PointStudy> study_;  // study that the exploration runs at every point; none for a registered study (`other_`)
  std::optional<OtherStudy> other_;
  std::vector<PointFigure> figures_;
  AskedFigures asked_ = {};              // optional figures of merit that the scene of the exploration requests
  std::vector<std::string> parameters_;  // names of the waveform parameters that a search at a point varies
  bool shares_switches_ = false;         // true to remember pull-in voltages, since several points may have the same switch
  PullInMemory pull_in_;
};

}  // namespace softland
