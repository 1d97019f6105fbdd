// Options on the errors of instruments in a laboratory: the verb `device` simulates these errors, the verb `tune` expects them.
#pragma once

#include <optional>

#include "config/scene.h"
#include "studies/inverse/contact_record.h"
#include "verbs/options.h"

namespace softland::verbs {

/// Errors of laboratory instruments; an error that the user does not give has a default, which depends on the scene.
struct LaboratoryArguments {
  std::optional<double> edge_error = {}, unseen = {}, gain_error = {}, shot_error = {};
  /// Standard deviation of the delay between drive waveforms and contact records [s]; an option of `tune` only.
  std::optional<double> trigger_delay = {};
  /// Threshold of the capacitance from which on the contact counts as closed, for an instrument that measures the capacitance
  /// [F].
  std::optional<double> capacitance = {};

  /// Returns the given errors of the instruments, and the defaults of all other errors. Throws InvalidInput for a scene that
  /// cannot be read.
  [[nodiscard]] LaboratoryErrors errors(const SceneFile& file) const;
};

template <class Archive>
void laboratory_options(Archive& a, LaboratoryArguments& r) {
  a.program().quantity("edge-error", r.edge_error, {dimension::time}, "TIME",
                       "standard deviation of the recorded time at which the contact closes or opens (default: 50 ns, "
                       "at most 1/200 of the period of the first mode)");
  a.program().quantity(
      "unseen", r.unseen, {dimension::time}, "TIME",
      "contact openings shorter than this are not detected (default: 100 ns, at most 1/100 of the period of the first mode)");
  a.program().quantity("gain-error", r.gain_error, {dimension::none}, "SHARE",
                       "standard deviation of the gain error of a source, which is constant but unknown (default: 0.5 %)");
  a.program().quantity("shot-error", r.shot_error, {dimension::none}, "SHARE",
                       "standard deviation of the gain from shot to shot (default: 0.02 %)");
  a.quantity(
      "capacitance", r.capacitance, {dimension::capacitance, positive, "a capacitance above 0 F, such as \"1.2 pF\""},
      "THRESHOLD",
      "for a switch that lands on a dielectric: records give the times when the capacitance of the closing electrode is above "
      "this threshold, such as \"1.2 pF\", instead of the times when the contact is closed (docs/tune.md)");
}

}  // namespace softland::verbs
