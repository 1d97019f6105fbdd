// The request of a search as text, as on the command line, in plans (stored requests) and in database files, and the search
// that the request describes.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "config/scene.h"
#include "studies/search/optimize.h"
#include "studies/search/robust_optimize.h"
#include "studies/search/robust_search_study.h"

namespace softland {

/// Values of SearchRequest::robust that are not a measure of risk: a tournament over devices, with a search on the nominal
/// device in parallel; or a search on the nominal device alone.
inline constexpr std::string_view by_tournament = "auto", nominal_alone = "none";

/// Values of SearchRequest::hold_step, with the piezo as actuator: the search chooses the instant of the electrode's plain
/// step, or the step is at t = 0.
inline constexpr std::string_view step_is_chosen = "chosen", step_is_fixed = "fixed";

/// The request of a search. A member that is empty was not given: completed() fills it in.
struct SearchRequest {
  std::string target = {};     ///< target of the search: "bounce", "0.7 bounce + 0.3 energy"
  std::string actuator = {};   ///< actuator whose waveforms are searched: "electrostatic", "pzt", "both"
  std::string waveform = {};   ///< waveform families to search: "knots+dual-pulse"
  std::string optimizer = {};  ///< optimizer: "auto", or the name of a method
  std::string robust = {};     ///< search over devices: by_tournament, nominal_alone, or the measure of risk to minimise
  std::string hold_step = {};  ///< instant of the electrode's plain step: step_is_chosen or step_is_fixed
  std::string calibrate = {};  ///< measurements of a per-device calibration: "Vdp:1 %,frequency"; empty: that of the scene
  std::vector<std::string> constrain = {};  ///< conditions that the waveform must fulfil: "peak_contact_force < 20 uN"
  std::optional<std::string> samples = {};  ///< number of varied devices in the search
  /// Budget of the search: evaluations, or closings of devices, "2500", or time, "90 s".
  std::optional<std::string> budget = {};
  std::optional<std::string> seed = {};
  std::optional<std::string> seeds = {};  ///< number of searches of a study, with the seeds `seed`, `seed` + 1, ...

  /// True for a search over devices by one measure of risk.
  [[nodiscard]] bool is_by_measure() const { return robust != by_tournament && robust != nominal_alone; }
};

/// Calls visit(name, member of the first request, of the second, ...) for each text member of the requests: std::string, or
/// std::optional<std::string> for optional members. The conditions are not visited.
template <class Visit, class... Requests>
void visit_prose(const Visit& visit, Requests&... requests) {
  visit("target", requests.target...);
  visit("actuator", requests.actuator...);
  visit("waveform", requests.waveform...);
  visit("optimizer", requests.optimizer...);
  visit("robust", requests.robust...);
  visit("hold-step", requests.hold_step...);
  visit("calibrate", requests.calibrate...);
  visit("samples", requests.samples...);
  visit("budget", requests.budget...);
  visit("seed", requests.seed...);
  visit("seeds", requests.seeds...);
}

/// Returns `request`; each empty member gets its value from `other`.
[[nodiscard]] SearchRequest or_else(SearchRequest request, const SearchRequest& other);

/// Returns `request` with defaults, which depend on the scene and on the other members, for all empty members except the
/// optional members.
[[nodiscard]] SearchRequest completed(SearchRequest request, const SceneFile& scene);

/// Parts of a search request from the user's code, which no text can describe.
struct OwnParts {
  std::shared_ptr<const OwnObjective> objective = nullptr;  ///< objective of the search that replaces the target; may be null
  OwnWaveforms waveforms = {};
};

/// A search, or several searches that differ in their seeds, ready to run.
struct PlannedSearch {
  SceneFile scene;                      ///< scene to search, with the requested calibration
  OptimizeOptions options;              ///< options of the search with the first seed, on one thread
  std::optional<RobustOptions> robust;  ///< options of a search over devices by one measure of risk; none for another search
  /// Options of a search over devices with a tournament of measures and waveform families.
  std::optional<RobustSearchOptions> for_devices;
  std::uint64_t seeds = 1;

  [[nodiscard]] std::uint64_t seed(std::uint64_t k) const { return options.seed + k; }
  /// Returns the number of devices on which candidate waveforms are tried by one measure of risk, or of fresh devices after a
  /// tournament; 0: nominal device only.
  [[nodiscard]] std::uint64_t devices() const { return robust ? robust->samples : for_devices ? for_devices->verdict : 0; }
};

inline constexpr std::uint64_t most_seeds = 100'000;

/// Parses a completed() request. `families` are the waveform families of a tournament over devices; empty: all. A request
/// without hold_step comes from a version before the quasi-static approach, and gives the search of that version. Throws
/// InvalidRequest with field, value and rule.
[[nodiscard]] PlannedSearch planned(const SearchRequest& request, SceneFile scene, const std::string& families = {},
                                    const OwnParts& own = {});

/// The result of a search: on the nominal device, over devices by one measure of risk, or over devices by a tournament of
/// waveform families.
struct FoundSearch {
  std::variant<OptimizeResult, RobustResult, RobustSearchResult> result;

  /// Returns the found waveform, with the closing of the nominal device.
  [[nodiscard]] const OptimizeResult& best() const;
  [[nodiscard]] OptimizeResult& best();
  [[nodiscard]] bool interrupted() const { return best().search.termination == Termination::interrupted; }
  /// True if the found waveform is better than the plain step: on the varied devices if the search has simulated any, else on
  /// the nominal device.
  [[nodiscard]] bool is_success() const;
};

/// Runs the search with the first of its seeds. A search over varied devices of a scene without [spread] uses the spread of
/// assume_spread(). Throws the exceptions of optimize().
[[nodiscard]] FoundSearch run(PlannedSearch& search);

}  // namespace softland
