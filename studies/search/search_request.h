// What a search is asked for, in the words that a command line, a plan and a store share; and the search that this is.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/scene.h"
#include "studies/search/for_devices.h"
#include "studies/search/optimize.h"
#include "studies/search/robust_optimize.h"

namespace softland {

/// Words of SearchRequest::robust beside a measure: for the drawing and for devices, or for the drawing alone.
inline constexpr std::string_view by_race = "auto", nominal_alone = "none";

/// Words of SearchRequest::hold_step: with the actuator pzt its instant is searched, or it is t = 0.
inline constexpr std::string_view step_is_chosen = "chosen", step_is_fixed = "fixed";

/// What is empty, or none, is not given: see completed().
struct SearchRequest {
  std::string target = {};                  ///< "bounce", "0.7 bounce + 0.3 energy"
  std::string actuator = {};                ///< "electrostatic", "pzt", "both"
  std::string waveform = {};                ///< families: "knots+dual-pulse"
  std::string optimizer = {};               ///< "auto", or a method
  std::string robust = {};                  ///< by_race, nominal_alone, or the measure of a search over devices
  std::string hold_step = {};               ///< when a plain step of the electrode comes: step_is_chosen or step_is_fixed
  std::string calibrate = {};               ///< measured on every device: "Vdp:1 %,frequency"; empty: what the scene says
  std::vector<std::string> constrain = {};  ///< conditions: "peak_contact_force < 20 uN"
  std::optional<std::string> samples = {};  ///< devices
  std::optional<std::string> budget = {};   ///< evaluations, or closings of devices, "2500", or time, "90 s"
  std::optional<std::string> seed = {};
  std::optional<std::string> seeds = {};  ///< how many searches, from `seed` on

  /// Whether devices are searched by one measure.
  [[nodiscard]] bool is_by_measure() const { return robust != by_race && robust != nominal_alone; }
};

/// The words of requests, of each with its name: visit(name, word of the first, of the second, ...), which are std::string, or
/// std::optional<std::string> where they need not be given. The conditions are not among them.
template <class Visit, class... Requests>
void visit_words(const Visit& visit, Requests&... requests) {
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

/// With the words of `other` where none are given.
[[nodiscard]] SearchRequest or_else(SearchRequest request, const SearchRequest& other);

/// With the words of the defaults, which suit the scene and each other, but for what is optional.
[[nodiscard]] SearchRequest completed(SearchRequest request, const SceneFile& scene);

/// What takes the place of words that no text can hold.
struct OwnParts {
  std::shared_ptr<const OwnObjective> objective = nullptr;  ///< in the place of the target
  OwnWaveforms waveforms = {};
};

/// A search, or several that differ in their seeds, ready to run.
struct PlannedSearch {
  SceneFile scene;                               ///< with the calibration that is asked for
  OptimizeOptions options;                       ///< with the first of the seeds, on one thread
  std::optional<RobustOptions> robust;           ///< of a search over devices by one measure
  std::optional<ForDevicesOptions> for_devices;  ///< of one that races measures and families
  std::uint64_t seeds = 1;

  [[nodiscard]] std::uint64_t seed(std::uint64_t k) const { return options.seed + k; }
  /// Devices that are looked at by one measure, or fresh ones of the verdict; 0: none.
  [[nodiscard]] std::uint64_t devices() const { return robust ? robust->samples : for_devices ? for_devices->verdict : 0; }
};

inline constexpr std::uint64_t most_seeds = 100'000;

/// Reads the words of a completed() request. `families`: of a race over devices; empty: all. One that says nothing of hold_step
/// is of a version before the quasi-static approach, and is searched as it was then. Throws InvalidRequest with field, value and
/// rule.
[[nodiscard]] PlannedSearch planned(const SearchRequest& request, SceneFile scene, const std::string& families = {},
                                    const OwnParts& own = {});

}  // namespace softland
