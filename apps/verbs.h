// One function per verb of the command line. Each returns the exit status (apps/exit_status.h); what keeps it from its end is an
// exception: see apps/failure.h.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

namespace softland::apps {

/// What every verb may be told.
struct Common {
  std::string command;           ///< the command line, for provenance
  std::string scene;             ///< path of the scene file
  std::vector<std::string> set;  ///< --set key=value, in order
  std::string json;              ///< file for the JSON, "-" for standard output, empty for none
  std::string out;               ///< folder for everything, empty for none
  bool quiet = false;
  const std::atomic<bool>* stop = nullptr;
};

struct OptimizeRequest {
  std::string target = "bounce";
  std::string actuator = "electrostatic";
  std::string waveform = "pulse";
  std::string optimizer = "auto";
  std::string robust;                   ///< the measure of a robust search; empty: the nominal device alone
  std::vector<std::string> conditions;  ///< of a robust search
  std::string calibration;              ///< what is measured on every device; empty: what the scene says
  std::optional<std::string> samples;   ///< devices of a robust search
  std::optional<std::string> budget;    ///< evaluations ("2500") or time ("90 s"); default: default_budget(), or default_closings
  std::optional<std::string> seed;      ///< default: 1
  std::optional<std::string> jobs;      ///< default: one per core
};

struct RobustnessRequest {
  std::vector<std::string> results;  ///< whose drives are judged as well
  std::string points = "sobol";
  std::string calibration;             ///< what is measured on every device; empty: what the scene says
  bool other_ways = false;             ///< ranges over a box, and polynomial chaos, beside the sample
  std::optional<std::string> samples;  ///< default: 2000
  std::optional<std::string> seed;     ///< default: 1
  std::optional<std::string> jobs;     ///< default: one per core
};

struct CalibrateRequest {
  std::string errors;                  ///< of measurements; empty: none err
  std::string steps;                   ///< whose closing times are measured; empty: the default ones
  std::optional<std::string> samples;  ///< default: 256
  std::optional<std::string> seed;     ///< default: 1
  std::optional<std::string> jobs;     ///< default: one per core
};

struct ExportRequest {
  std::string result, format = "csv";
  std::optional<std::string> device_pull_in, device_frequency;  ///< measured on the device that gets the waveform
};

/// `jobs`: threads of a certified run; default: one per core.
int simulate_verb(const Common& common, bool certified, const std::optional<std::string>& jobs);
int pull_in_verb(const Common& common);
int modes_verb(const Common& common);
int check_verb(const Common& common);
int effects_verb(const Common& common);
int accuracy_verb(const Common& common);
int optimize_verb(const Common& given, const OptimizeRequest& request);
int robustness_verb(const Common& common, const RobustnessRequest& request);
int calibrate_verb(const Common& common, const CalibrateRequest& request);
int new_verb(const std::string& kind);
int export_verb(const Common& common, const ExportRequest& request);
int report_verb(const Common& given, const std::string& result);

}  // namespace softland::apps
