// A session runs a tuning from its first shot to its last: it proposes the next shot, takes its record, and keeps both.
// Instruments, a person or a function fire the shots.
//
//   TuningSession tuning(scene, options);
//   tuning.keep("closings.jsonl", false);                  // each closing is on the disk before the next is fired
//   tuning.begin();
//   while (tuning.learn_kept()) {}                         // continues an earlier tuning
//   while (!tuning.ends(usual_closings)) tuning.learn(fired(tuning.commanded()));
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "base/progress.h"
#include "reports/tuning_lines.h"
#include "reports/tuning_report.h"
#include "studies/inverse/tuner.h"

namespace softland {

/// Default for the largest number of closings.
inline constexpr int usual_closings = 30;

class TuningSession {
 public:
  /// `wafer` names folders of tunings of other devices of the wafer that have ended. Throws InvalidInput for one that is not a
  /// tuning of this scene, and for options out of range.
  TuningSession(SceneFile file, TunerOptions options, std::span<const std::string> wafer = {});
  ~TuningSession();
  TuningSession(TuningSession&&) noexcept;
  TuningSession& operator=(TuningSession&&) noexcept;

  /// Keeps the closings in this file, see TuningLog, whose exceptions it throws: continues those in it, or begins it anew.
  /// Returns the new name of an earlier file; empty without one. Call it before begin().
  std::filesystem::path keep(const std::filesystem::path& log, bool resume);
  /// Searches the recipes, or takes those of the log. Throws what Tuner throws.
  void begin(const Progress& progress = {});
  /// Learns the next closing that the log held when it was opened; returns false after the last one. Throws InvalidInput where
  /// another shot would have been proposed.
  bool learn_kept(const Progress& progress = {});

  [[nodiscard]] const Tuner& tuner() const;
  [[nodiscard]] const std::vector<TunedClosing>& closings() const;
  /// Returns the next shot as it is sent to a device.
  [[nodiscard]] CommandedShot commanded() const;
  /// Puts the record of the next shot on the disk, and learns it. Throws InvalidInput for an impossible record, and OutputLost.
  /// It throws Interrupted when the record is on the disk but not learned; give it again then.
  void learn(const ContactRecord& record, const Progress& progress = {});
  /// Returns how the tuning ends at this shot, with success or with `most` closings used; none if it continues. Makes the best
  /// waveform the next shot when that is the last one, or when other waveforms have closed the switch bounce-free often enough.
  [[nodiscard]] std::optional<TuningEnd> ends(int most);
  /// Throws InvalidInput where the last three shots gave no record.
  void throw_if_failing() const;

  /// Returns the record that tune.json holds; `command` is the command line.
  [[nodiscard]] TuningReport report(TuningEnd end, const std::string& command = {}) const;
  /// Returns best.toml, best.csv, tune.json and tune.html as they stand.
  [[nodiscard]] std::map<std::string, std::string> files(TuningEnd end, const std::string& command) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softland
