// A laboratory closes the real device once for every shot of a tuning, under the voltages of that shot. The laboratory is a
// command that controls instruments, or a person with an oscilloscope.
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
  /// Applies the voltages of a shot to the device. Returns the measured times at which the contact closes and opens; none if
  /// the user wants no more shots. `sent` holds the signals of the shot as the voltage sources receive them. Throws
  /// InvalidInput if the laboratory reports no measurement, and Interrupted after a signal to stop.
  [[nodiscard]] virtual std::optional<ContactRecord> fire(const CommandedShot& shot, const SentSignals& sent) = 0;
  /// Tells the laboratory that no further closing of the device follows.
  virtual void finish() {}

 protected:
  TuningLab() = default;
  TuningLab(const TuningLab&) = default;
  TuningLab& operator=(const TuningLab&) = default;
};

/// Makes a laboratory from a shell command, which exchanges the lines of reports/tuning_lines.h with this program. `patience`
/// is the longest wait for a line.
[[nodiscard]] std::unique_ptr<TuningLab> command_lab(const std::string& command, std::chrono::milliseconds patience);

struct HandLabRequest {
  std::filesystem::path folder;
  bool goes_on = false;  ///< true: continue an earlier tuning in `folder`, and keep its files of waveforms (shot-N.csv)
  std::string format = "csv";
  /// Settings for finding, in a recorded voltage across the contact, the times at which the contact closes and opens; none: the
  /// user reports these times.
  std::optional<ContactTraceKeys> contact = {};
};
/// Makes a laboratory in which a person applies the voltages and reports what the device did. The voltages of each shot are
/// written to FOLDER/shot-N.csv, or in another format of the verb `export` (scene_export.h). The program asks for the
/// observation on standard error until it reads a valid answer. Keeps a reference to the scene.
[[nodiscard]] std::unique_ptr<TuningLab> hand_lab(HandLabRequest request, const PreparedScene& scene);

/// Reads the times at which a contact closes and opens from a CSV file: a header time_s,closed and a row for each edge, with 1
/// where the contact closes and 0 where it opens. Throws InvalidInput with file, line and rule.
[[nodiscard]] ContactRecord read_edges_file(const std::string& file);
/// Reads the times at which a contact closes and opens from a recorded voltage across the contact. Throws the exceptions of
/// read_edges_file().
[[nodiscard]] ContactRecord read_contact_trace(const std::string& file, const ContactTraceKeys& keys);

}  // namespace softland::apps
