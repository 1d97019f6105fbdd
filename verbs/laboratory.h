// The laboratory verbs share these options about the instruments: `device` simulates these errors, `tune` expects them.
#pragma once

#include <optional>

#include "config/scene.h"
#include "studies/inverse/contact_record.h"
#include "verbs/options.h"

namespace softland::verbs {

/// Errors that are not given are the usual ones of the scene.
struct ToldErrors {
  std::optional<double> edge_error = {}, unseen = {}, gain_error = {}, shot_error = {};
  std::optional<double> trigger_delay = {};  ///< delay that `tune` expects; it alone has the option
  std::optional<double> capacitance = {};    ///< threshold, for an instrument that measures the capacitance

  /// Returns the errors. Throws InvalidInput for a scene that cannot be read.
  [[nodiscard]] LaboratoryErrors errors(const SceneFile& file) const;
};

template <class Archive>
void laboratory_options(Archive& a, ToldErrors& r) {
  a.program().quantity("edge-error", r.edge_error, {dimension::time}, "TIME",
                       "error of the time of an edge of the contact, one standard deviation (default: 50 ns, at most "
                       "a 200th of the period of the first mode)");
  a.program().quantity("unseen", r.unseen, {dimension::time}, "TIME",
                       "openings of the contact shorter than this are not seen (default: 100 ns, "
                       "at most a 100th of that period)");
  a.program().quantity("gain-error", r.gain_error, {dimension::none}, "SHARE",
                       "error of the gain of a source, constant but unknown, one standard deviation (default: 0.5 %)");
  a.program().quantity("shot-error", r.shot_error, {dimension::none}, "SHARE",
                       "scatter of the gain from shot to shot, one standard deviation (default: 0.02 %)");
  a.quantity(
      "capacitance", r.capacitance, {dimension::capacitance, positive, "a capacitance above 0 F"}, "THRESHOLD",
      "records tell when the capacitance of the electrode that closes the switch is above this, \"1.2 pF\", instead of when "
      "its contact is closed: for a switch that lands on a dielectric (docs/tune.md)");
}

}  // namespace softland::verbs
