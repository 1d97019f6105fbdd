// The request of a search, in the words that a command line, a plan and a store share, and the search that it describes.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/scene.h"
#include "studies/search/optimize.h"
#include "studies/search/robust_optimize.h"
#include "studies/search/robust_search_study.h"

namespace softland {

/// Words of SearchRequest::robust beside a measure: for the nominal design and for devices, or for the nominal design alone.
inline constexpr std::string_view by_race = "auto", nominal_alone = "none";

/// Words of SearchRequest::hold_step: the instant is searched with the actuator pzt, or is t = 0.
inline constexpr std::string_view step_is_chosen = "chosen", step_is_fixed = "fixed";

/// A search request. Empty members, and none, are not given: see completed().
struct SearchRequest {
  std::string target = {};                  ///< "bounce", "0.7 bounce + 0.3 energy"
  std::string actuator = {};                ///< "electrostatic", "pzt", "both"
  std::string waveform = {};                ///< families: "knots+dual-pulse"
  std::string optimizer = {};               ///< "auto", or a method
  std::string robust = {};                  ///< by_race, nominal_alone, or the measure of a search over devices
  std::string hold_step = {};               ///< instant of a plain step of the electrode: step_is_chosen or step_is_fixed
  std::string calibrate = {};               ///< calibration of every device: "Vdp:1 %,frequency"; empty: that of the scene
  std::vector<std::string> constrain = {};  ///< conditions: "peak_contact_force < 20 uN"
  std::optional<std::string> samples = {};  ///< devices
  std::optional<std::string> budget = {};   ///< evaluations, or closings of devices, "2500", or time, "90 s"
  std::optional<std::string> seed = {};
  std::optional<std::string> seeds = {};  ///< number of searches, from `seed` on

  /// True if devices are searched by one measure.
  [[nodiscard]] bool is_by_measure() const { return robust != by_race && robust != nominal_alone; }
};

/// Visits the words of requests, each with its name: visit(name, word of the first, of the second, ...). They are std::string,
/// or std::optional<std::string> if they need not be given. The conditions are not among them.
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

/// Fills in the words of `other` where none are given.
[[nodiscard]] SearchRequest or_else(SearchRequest request, const SearchRequest& other);

/// Fills in the defaults, which suit the scene and each other, except for optional words.
[[nodiscard]] SearchRequest completed(SearchRequest request, const SceneFile& scene);

/// Parts that take the place of words that no text can hold.
struct OwnParts {
  std::shared_ptr<const OwnObjective> objective = nullptr;  ///< objective in the place of the target
  OwnWaveforms waveforms = {};
};

/// A search, or several that differ in their seeds, ready to run.
struct PlannedSearch {
  SceneFile scene;                                 ///< scene with the requested calibration
  OptimizeOptions options;                         ///< options with the first of the seeds, on one thread
  std::optional<RobustOptions> robust;             ///< options of a search over devices by one measure
  std::optional<RobustSearchOptions> for_devices;  ///< options of a search that races measures and families
  std::uint64_t seeds = 1;

  [[nodiscard]] std::uint64_t seed(std::uint64_t k) const { return options.seed + k; }
  /// Devices that are searched by one measure, or fresh ones of the verdict; 0: none.
  [[nodiscard]] std::uint64_t devices() const { return robust ? robust->samples : for_devices ? for_devices->verdict : 0; }
};

inline constexpr std::uint64_t most_seeds = 100'000;

/// Reads the words of a completed() request. `families` are those of a race over devices; empty: all. A request without
/// hold_step is of a version before the quasi-static approach, and is searched as it was then. Throws InvalidRequest with
/// field, value and rule.
[[nodiscard]] PlannedSearch planned(const SearchRequest& request, SceneFile scene, const std::string& families = {},
                                    const OwnParts& own = {});

}  // namespace softland
