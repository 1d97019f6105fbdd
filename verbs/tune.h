// Verb `tune`: a waveform tuned on one device, closing after closing. Who fires the shots is for the doors: a command or a person
// for the program, a function for Python.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "config/bench.h"
#include "reports/generator_export.h"
#include "reports/tuning_session.h"
#include "verbs/laboratory.h"
#include "verbs/study.h"

namespace softland::verbs {

struct TuneRequest {
  std::string device;
  bool by_hand = false, resume = false;
  std::vector<std::string> wafer;     ///< folders of earlier tunings
  std::vector<std::string> contact;   ///< how recorded voltages of the contact are read
  std::optional<std::string> format;  ///< the format of the files of shots
  Sampling sampling;                  ///< how the sources take samples
  int closings = usual_closings;
  std::chrono::milliseconds patience = std::chrono::minutes(1);
  TunerOptions tuner{.jobs = one_per_core()};
  ToldErrors laboratory;

  /// A tuning of this scene. Throws InvalidInput.
  [[nodiscard]] TuningSession session(const SceneFile& file) const;
};
/// Throws InvalidRequest.
[[nodiscard]] TuneRequest tune_request(const Told& told);

}  // namespace softland::verbs
