// Where the shots of a tuning are fired: a command that drives instruments, or a person beside an oscilloscope.
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
  /// Fires a shot and tells what was recorded; none where no more shots are wanted. `sent` are the signals of the shot. Throws
  /// InvalidInput where no record comes, Interrupted where a signal asks to stop.
  [[nodiscard]] virtual std::optional<ContactRecord> fire(const ToldShot& shot, const SentSignals& sent) = 0;
  /// There are no more shots.
  virtual void finish() {}

 protected:
  TuningLab() = default;
  TuningLab(const TuningLab&) = default;
  TuningLab& operator=(const TuningLab&) = default;
};

/// A command that the shell runs, which speaks the lines of reports/tuning_lines.h. It is given `patience` for each.
[[nodiscard]] std::unique_ptr<TuningLab> command_lab(const std::string& command, std::chrono::milliseconds patience);

struct HandLabRequest {
  std::filesystem::path folder;
  bool goes_on = false;  ///< an earlier tuning there is gone on with: its files of shots stay
  std::string format = "csv";
  std::optional<ContactTraceKeys> contact = {};  ///< how records of the contact's voltage are read, where there are any
};
/// Writes the voltages of each shot to FOLDER/shot-N.csv, or to files of another format of `export` (scene_export.h). Asks on
/// standard error for what was seen, until the answer on standard input can be one. Keeps a reference to the scene.
[[nodiscard]] std::unique_ptr<TuningLab> hand_lab(HandLabRequest request, const PreparedScene& scene);

/// Closing and opening of a contact in a CSV file: a header time_s,closed and a row for each edge, 1 where it closes and 0 where
/// it opens. Throws InvalidInput with file, line and rule.
[[nodiscard]] ContactRecord read_edges_file(const std::string& file);
/// The same of the voltage that an instrument recorded.
[[nodiscard]] ContactRecord read_contact_trace(const std::string& file, const ContactTraceKeys& keys);

}  // namespace softland::apps
