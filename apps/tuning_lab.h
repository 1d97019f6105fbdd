// A laboratory fires the shots of a tuning: a command that drives instruments, or a person beside an oscilloscope.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "apps/scenes.h"
#include "exchange/level_edges.h"
#include "reports/tuning_lines.h"
#include "studies/closing/sent_signals.h"

namespace softland::apps {

class TuningLab {
 public:
  virtual ~TuningLab() = default;
  /// Fires a shot and returns its record; none where no more shots are wanted. `sent` are the signals of the shot. Throws
  /// InvalidInput where no record comes, Interrupted where a signal asks to stop.
  [[nodiscard]] virtual std::optional<ContactRecord> fire(const ToldShot& shot, const SentSignals& sent) = 0;
  /// Ends the session: no more shots follow.
  virtual void finish() {}

 protected:
  TuningLab() = default;
  TuningLab(const TuningLab&) = default;
  TuningLab& operator=(const TuningLab&) = default;
};

/// Runs a command by the shell, which speaks the lines of reports/tuning_lines.h. It has `patience` for each.
[[nodiscard]] std::unique_ptr<TuningLab> command_lab(const std::string& command, std::chrono::milliseconds patience);

struct HandLabRequest {
  std::filesystem::path folder;
  bool goes_on = false;  ///< true: continues an earlier tuning there, whose files of shots stay
  std::string format = "csv";
  std::optional<ContactTraceKeys> contact = {};  ///< keys for reading records of the contact's voltage, where there are any
};
/// Writes the voltages of each shot to FOLDER/shot-N.csv, or to files of another format of `export` (scene_export.h). Asks on
/// standard error for the observation, until the answer on standard input is valid. Keeps a reference to the scene.
[[nodiscard]] std::unique_ptr<TuningLab> hand_lab(HandLabRequest request, const PreparedScene& scene);

/// Reads closing and opening of a contact from a CSV file: a header time_s,closed and a row for each edge, 1 where it closes
/// and 0 where it opens. Throws InvalidInput with file, line and rule.
[[nodiscard]] ContactRecord read_edges_file(const std::string& file);
/// Does the same for the voltage that an instrument recorded.
[[nodiscard]] ContactRecord read_contact_trace(const std::string& file, const ContactTraceKeys& keys);

}  // namespace softland::apps
