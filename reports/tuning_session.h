// A tuning from its first shot to its last: what is fired next, what came of it, and where that is kept. For whoever fires the
// shots: instruments, a person, a function.
//
//   TuningSession tuning(scene, options);
//   tuning.keep("closings.jsonl", false);                  // each closing is on the disk before the next is fired
//   tuning.begin();
//   while (tuning.learn_kept()) {}                         // of a tuning that goes on
//   while (!tuning.ends(usual_closings)) tuning.learn(fired(tuning.told()));
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "base/watch.h"
#include "reports/tuning_lines.h"
#include "reports/tuning_report.h"
#include "studies/tuning/tuner.h"

namespace softland {

/// Closings at most, where nobody says how many.
inline constexpr int usual_closings = 30;

class TuningSession {
 public:
  /// `wafer`: folders of tunings of other devices of the wafer that have ended. Throws InvalidInput for one that is no tuning of
  /// this scene, and for options out of range.
  TuningSession(SceneFile file, TunerOptions options, std::span<const std::string> wafer = {});
  ~TuningSession();
  TuningSession(TuningSession&&) noexcept;
  TuningSession& operator=(TuningSession&&) noexcept;

  /// Keeps the closings in this file, see TuningLog, whose exceptions it throws: goes on with those in it, or begins it anew.
  /// Returns where an earlier file went; empty where there was none. Before begin().
  std::filesystem::path keep(const std::filesystem::path& log, bool resume);
  /// Searches the recipes, or takes those of the log. Throws what Tuner throws.
  void begin(const Watch& watch = {});
  /// Learns the next closing that the log held when it was opened; false where there is none left. Throws InvalidInput where
  /// another shot would have been proposed.
  bool learn_kept(const Watch& watch = {});

  [[nodiscard]] const Tuner& tuner() const;
  [[nodiscard]] const std::vector<TunedClosing>& closings() const;
  /// The next shot, as a device is told.
  [[nodiscard]] ToldShot told() const;
  /// Puts what came of the next shot on the disk, and learns it. Throws InvalidInput for a record that cannot be one, OutputLost,
  /// and Interrupted: then the record is on the disk, and is to be given again.
  void learn(const ContactRecord& record, const Watch& watch = {});
  /// How the tuning ends here: done, or `most` closings are used; none where it goes on. Where the next shot is the last one, or
  /// the switch has landed often enough by others than the waveform kept, the next shot is that one.
  [[nodiscard]] std::optional<TuningEnd> ends(int most);
  /// Throws InvalidInput where the last three shots gave no record.
  void throw_if_failing() const;

  /// The record that tune.json holds; `command`: the command line.
  [[nodiscard]] TuningReport report(TuningEnd end, const std::string& command = {}) const;
  /// best.toml, best.csv, tune.json and tune.html as they stand.
  [[nodiscard]] std::map<std::string, std::string> files(TuningEnd end, const std::string& command) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softland
