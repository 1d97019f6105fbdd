// The knowledge and the proposals of a tuning: JSON with SI units in the names, a line for a log, and a document.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "document/document.h"
#include "reports/origin.h"
#include "studies/inverse/tuner.h"

namespace softland {

/// The state of a tuning.
enum class TuningEnd { under_way, done, closings_used, stopped, interrupted, failed };
inline constexpr auto tuning_ends = std::to_array<Named<TuningEnd>>({{TuningEnd::under_way, "under_way"},
                                                                     {TuningEnd::done, "done"},
                                                                     {TuningEnd::closings_used, "closings_used"},
                                                                     {TuningEnd::stopped, "stopped"},
                                                                     {TuningEnd::interrupted, "interrupted"},
                                                                     {TuningEnd::failed, "failed"}});
static_assert(is_complete<tuning_ends>());

/// A closing that was recorded.
struct TunedClosing {
  TunerShot shot;
  ContactRecord record;
};

/// The record of a tuning as it stands now.
struct TuningReport {
  /// A shot by the voltages of its drives: a factor of the dispersion force is not a voltage.
  struct Shot {
    int number = 0;
    std::map<std::string, Points> waveforms = {};  ///< commanded voltages by drive: time [s] and voltage [V]
    double hold_time = 0, expected_cost = 0;       ///< see TunerShot
    PredictedRecord predicted = {};
  };
  struct Closing {
    Shot shot;
    ContactRecord record;
  };
  Origin origin;
  std::vector<Closing> closings = {};  ///< all closings in their order, also those that failed
  Shot next, kept;
  BeliefSummary belief = {};
  std::optional<std::string> broken_assumption = {};
  double step_closing_time = 0;  ///< first touch of the plain step on the nominal device [s]
  Approach approach = Approach::fast;
  double step_permanent_contact = Metrics::unset;  ///< set where the approach is quasi-static [s]
  int bounce_free_in_a_row = 0;
  bool spread_assumed = false;
  std::uint64_t seed = 1;
  double tolerance = Metrics::unset;  ///< tolerance of the integrator
  TuningEnd end = TuningEnd::under_way;
  nlohmann::json setting = {};  ///< tells apart tunings that cannot go on with each other

  /// Tells whether the shot of this number was recorded without a bounce.
  [[nodiscard]] bool was_bounce_free(int shot) const;
  /// Tells whether any shot was.
  [[nodiscard]] bool ever_bounce_free() const;
  /// Tells whether the last closing was of the waveform kept, and without a bounce.
  [[nodiscard]] bool lands() const;
};
/// A tuning that has ended keeps the waveform of its last closing where that did not bounce.
[[nodiscard]] TunerShot kept_shot(const Tuner& tuner, const std::vector<TunedClosing>& closings, TuningEnd end);
[[nodiscard]] TuningReport::Shot shot_of(const PreparedScene& scene, const TunerShot& shot);
[[nodiscard]] TuningReport tuning_report(const Tuner& tuner, const std::vector<TunedClosing>& closings,
                                         const TunerOptions& options, TuningEnd end, const std::string& command);

[[nodiscard]] nlohmann::json json_of(const TuningReport& report);
[[nodiscard]] TuningReport read_tuning(const nlohmann::json& from);
[[nodiscard]] nlohmann::json belief_json(const TunedBelief& belief);
/// Reads the belief about the device from the JSON of a tuning. Throws InvalidInput with the rule: "holds no belief ...".
[[nodiscard]] TunedBelief tuned_belief(const nlohmann::json& written);
/// Returns one line on the last closing and the expectation for the next.
[[nodiscard]] std::string closing_prose(const TuningReport& report);
/// Shows the knowledge of the device, every closing's record under the predicted one, and the voltages that are kept and
/// proposed.
[[nodiscard]] Document tuning_document(const TuningReport& report);

}  // namespace softland
