// What a tuning knows and proposes: JSON with SI units in the names, a line for a log, and a document.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "reports/document.h"
#include "reports/result_maker.h"
#include "studies/tuning/tuner.h"

namespace softland {

/// How a tuning stands.
enum class TuningEnd { under_way, done, closings_used, stopped, interrupted, failed };
/// "closings_used"
[[nodiscard]] std::string_view name_of(TuningEnd end);
/// Throws InvalidInput for a name that there is not.
[[nodiscard]] TuningEnd tuning_end(std::string_view name);

/// A closing that was recorded.
struct TunedClosing {
  TunerShot shot;
  ContactRecord record;
};

/// What is reported, as it stands now.
struct TuningReport {
  PreparedScene scene;                 ///< that the belief is about
  std::vector<TunedClosing> closings;  ///< in their order, those that failed included
  TunerShot next, kept;
  BeliefSummary belief;
  std::optional<std::string> broken_assumption;
  double step_closing_time = 0;  ///< first touch of the plain step on the nominal device [s]
  Approach approach = Approach::fast;
  double step_permanent_contact = Metrics::unset;  ///< where the approach is quasi-static [s]
  int bounce_free_in_a_row = 0;
  bool spread_assumed = false;
  std::uint64_t seed = 1;
  TuningEnd end = TuningEnd::under_way;

  /// The shot of this number was recorded without a bounce.
  [[nodiscard]] bool was_bounce_free(int shot) const;
  /// Whether any was.
  [[nodiscard]] bool ever_bounce_free() const;
  /// Tells whether the last closing was of the waveform kept, and without a bounce.
  [[nodiscard]] bool lands() const;
};
/// A tuning that has ended keeps the waveform of its last closing where that did not bounce.
[[nodiscard]] TuningReport tuning_report(const Tuner& tuner, std::vector<TunedClosing> closings, const TunerOptions& options,
                                         TuningEnd end);

[[nodiscard]] nlohmann::json tuning_json(const TuningReport& report, const Provenance& provenance);
[[nodiscard]] nlohmann::json belief_json(const TunedBelief& belief);
/// What the JSON of a tuning tells of its device. Throws InvalidInput with the rule: "holds no belief ...".
[[nodiscard]] TunedBelief tuned_belief(const nlohmann::json& written);
/// One line: what the last closing was, and what is expected of the next.
[[nodiscard]] std::string closing_words(const TuningReport& report);
/// What is known of the device, every closing's record under the predicted one, and the voltages that are kept and proposed.
[[nodiscard]] Document tuning_document(const TuningReport& report, const Provenance& provenance);

}  // namespace softland
