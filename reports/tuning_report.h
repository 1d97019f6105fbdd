// The state of a tuning as a report: JSON with SI units in the names, a line for a log, and a document.
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

/// The state of a tuning while it runs, or the way in which it ended.
enum class TuningEnd { under_way, done, closings_used, stopped, interrupted, failed };
inline constexpr auto tuning_ends = std::to_array<Named<TuningEnd>>({{TuningEnd::under_way, "under_way"},
                                                                     {TuningEnd::done, "done"},
                                                                     {TuningEnd::closings_used, "closings_used"},
                                                                     {TuningEnd::stopped, "stopped"},
                                                                     {TuningEnd::interrupted, "interrupted"},
                                                                     {TuningEnd::failed, "failed"}});
static_assert(is_complete<tuning_ends>());

/// A closing of the real device whose contact was recorded in a tuning.
struct TunedClosing {
  TunerShot shot;
  ContactRecord record;
};

/// The results of a tuning so far.
struct TuningReport {
  /// The voltages of a shot (one closing of the real device); the factor of the dispersion force is not a voltage.
  struct Shot {
    int number = 0;
    /// Commanded voltages of the shot by electrode or piezo: time [s] and voltage [V].
    std::map<std::string, Points> waveforms = {};
    /// Time for which the last voltages are held [s]; cost that the tuner predicts for the closing under these voltages.
    double hold_time = 0, expected_cost = 0;
    PredictedRecord predicted = {};
  };
  struct Closing {
    Shot shot;
    ContactRecord record;
  };
  Origin origin;
  std::vector<Closing> closings = {};  ///< all closings of the tuning in their order, also those without a contact record
  Shot next, kept;
  BeliefSummary belief = {};
  std::optional<std::string> broken_assumption = {};
  double step_closing_time = 0;  ///< time of first touch under the plain step on the nominal device [s]
  Approach approach = Approach::fast;
  /// Time to permanent contact under the plain step [s]; NaN unless the waveform approaches the contact quasi-statically.
  double step_permanent_contact = Metrics::unset;
  int bounce_free_in_a_row = 0;
  bool spread_assumed = false;
  std::uint64_t seed = 1;
  double tolerance = Metrics::unset;  ///< relative tolerance of the integrator in simulations of the tuning
  TuningEnd end = TuningEnd::under_way;
  nlohmann::json setting = {};  ///< values of scene and options that distinguish tunings which cannot continue each other

  /// Returns true if closing number `shot` of the device was recorded without a bounce.
  [[nodiscard]] bool was_bounce_free(int shot) const;
  /// Returns true if any closing of the device was recorded without a bounce.
  [[nodiscard]] bool ever_bounce_free() const;
  /// Returns true if the last closing of the real device used the waveform `kept` and had no bounce.
  [[nodiscard]] bool ended_bounce_free() const;
};
/// Returns the waveform that a tuning keeps as its best. After the end of the tuning, this is the waveform of the last closing
/// if that closing was bounce-free.
[[nodiscard]] TunerShot kept_shot(const Tuner& tuner, const std::vector<TunedClosing>& closings, TuningEnd end);
[[nodiscard]] TuningReport::Shot shot_of(const PreparedScene& scene, const TunerShot& shot);
[[nodiscard]] TuningReport tuning_report(const Tuner& tuner, const std::vector<TunedClosing>& closings,
                                         const TunerOptions& options, TuningEnd end, const std::string& command);

/// Names the members of the JSON.
void members(internal::Archive& a, TuningReport& record);
[[nodiscard]] nlohmann::json json_of(const TuningReport& report);
[[nodiscard]] TuningReport read_tuning(const nlohmann::json& from);
[[nodiscard]] nlohmann::json belief_json(const TunedBelief& belief);
/// Reads the belief about a device that belief_json() wrote; throws InvalidInput for other JSON.
[[nodiscard]] TunedBelief read_belief(const nlohmann::json& coordinates);
/// Reads the estimate of the device, means and deviations of its quantities, from the JSON of a tuning. Throws InvalidInput
/// with the rule: "holds no belief ...".
[[nodiscard]] TunedBelief tuned_belief(const nlohmann::json& written);
/// Returns one line on the last closing of a tuning and the prediction for the next closing.
[[nodiscard]] std::string closing_prose(const TuningReport& report);
/// Returns the report on a tuning, with the estimate of the device, the measured and the predicted contact record of every
/// closing, and the voltages of the kept and the proposed waveform.
[[nodiscard]] Document tuning_document(const TuningReport& report);

}  // namespace softland
