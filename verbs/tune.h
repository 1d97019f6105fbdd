// Verb `tune`: tunes a waveform on one device, one closing after another. In the program, a command or a person closes the
// device; in Python, a function does.
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
  std::vector<std::string> wafer;     ///< folders of earlier tunings of devices of the same wafer
  std::vector<std::string> contact;   ///< settings for reading recorded voltages of the contact, KEY=VALUE
  std::optional<std::string> format;  ///< format of the files with the voltages of a shot (one closing)
  Sampling sampling;                  ///< sampling of the voltage sources in the tuning
  int closings = usual_closings;
  std::chrono::milliseconds patience = std::chrono::minutes(1);
  TunerOptions tuner{.jobs = one_per_core()};
  LaboratoryArguments laboratory;

  /// Starts a tuning of this scene with the options of the request. Throws InvalidInput.
  [[nodiscard]] TuningSession session(const SceneFile& file) const;
};
/// Reads the options of `tune` from the arguments. Throws InvalidRequest.
[[nodiscard]] TuneRequest tune_request(const Arguments& arguments);

}  // namespace softland::verbs
