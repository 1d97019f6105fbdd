// A session runs a tuning from its first shot (the voltages of one closing) to its last: it proposes the next shot, reads the
// contact record of that shot, and stores both. Instruments, a person or a function apply the shots to the device.
//
//   TuningSession tuning(scene, options);
//   tuning.keep("closings.jsonl", false);                  // each closing is on the disk before the next shot
//   tuning.begin();
//   while (tuning.learn_kept()) {}                         // continues an earlier tuning
//   while (!tuning.ends(usual_closings)) tuning.learn(measured(tuning.commanded()));
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/progress.h"
#include "reports/tuning_lines.h"
#include "reports/tuning_report.h"
#include "studies/inverse/tuner.h"

namespace softland {

/// Key of the first line of the log file of a tuning; its values distinguish tunings that cannot continue each other.
inline constexpr const char* origin_key = "tuning";

/// The log file closings.jsonl: a line on the tuned device, a line with the candidate waveforms from which the tuning begins,
/// then a line for each shot (voltages of one closing) with its contact record.
class TuningLog {
 public:
  struct Closing {
    nlohmann::json shot;  ///< voltages of the shot as they were sent to the device
    ContactRecord record;
    std::size_t line = 0;  ///< number of the closing's line in the log file, counted from 1
  };

  /// Continues the log file of a tuning, or begins a new one and renames the existing file to closings-1.jsonl. The keys and
  /// values of `origin` distinguish tunings that cannot continue each other. Throws InvalidInput with file, line and rule if
  /// the file is no such log or has another origin, and OutputLost if the file cannot be written.
  TuningLog(std::filesystem::path file, const nlohmann::json& origin, bool resume);
  ~TuningLog();
  TuningLog(const TuningLog&) = delete;
  TuningLog& operator=(const TuningLog&) = delete;

  /// Returns the closings that the log file had when it was opened.
  [[nodiscard]] const std::vector<Closing>& closings() const { return closings_; }
  /// Returns the candidate waveforms in the log file; empty if the file has only the line on the device.
  [[nodiscard]] const std::vector<CandidateWaveform>& recipes() const { return recipes_; }
  /// Returns the new name of an earlier log file that was not continued; empty if there was no earlier file.
  [[nodiscard]] const std::filesystem::path& moved_to() const { return kept_aside_; }
  /// The functions append() add a line to the log file. They throw OutputLost if the line could not be written to the disk.
  void append(const std::vector<CandidateWaveform>& recipes);
  void append(const CommandedShot& shot, const ContactRecord& record);
  /// Returns the log file and line of a closing: "OUT/closings.jsonl:4".
  [[nodiscard]] std::string place(const Closing& closing) const;

 private:
  [[nodiscard]] std::size_t read(const nlohmann::json& origin);
  void open(std::size_t size);
  void write(const nlohmann::json& line);

  std::filesystem::path file_, kept_aside_;
  std::vector<Closing> closings_;
  std::vector<CandidateWaveform> recipes_;
  int descriptor_ = -1;
};

/// Default of the largest number of closings in a tuning.
inline constexpr int usual_closings = 30;

class TuningSession {
 public:
  /// `wafer` names folders of completed tunings of other devices on the same wafer. Throws InvalidInput for a folder that has
  /// no tuning of this scene, and for options out of range.
  TuningSession(SceneFile file, TunerOptions options, std::span<const std::string> wafer = {});
  ~TuningSession();
  TuningSession(TuningSession&&) noexcept;
  TuningSession& operator=(TuningSession&&) noexcept;

  /// Stores the closings of the tuning in the file `log`: with `resume`, the session continues the closings in the file,
  /// otherwise it begins a new file. Returns the new name of an earlier file; empty if there was none. Throws as TuningLog.
  /// Call it before begin().
  std::filesystem::path keep(const std::filesystem::path& log, bool resume);
  /// Searches the candidate waveforms of the tuning, or reads them from the log. Throws the exceptions of the constructor of
  /// Tuner.
  void begin(const Progress& progress = {});
  /// Learns from the next closing that the log had when it was opened; returns false after the last of these closings. Throws
  /// InvalidInput if the tuning would have proposed another shot.
  bool learn_kept(const Progress& progress = {});

  [[nodiscard]] const Tuner& tuner() const;
  [[nodiscard]] const std::vector<TunedClosing>& closings() const;
  /// Returns the voltages of the next shot as they are sent to a device.
  [[nodiscard]] CommandedShot commanded() const;
  /// Writes the contact record of the next shot to the disk, and updates the estimate of the device by it. Throws InvalidInput
  /// for an impossible record, and OutputLost. Throws Interrupted after the record is on the disk but before it is learned:
  /// then call learn() with the record again.
  void learn(const ContactRecord& record, const Progress& progress = {});
  /// Returns how the tuning ends before its next shot, with success or because `most` closings are used; none if the tuning
  /// continues. The best waveform becomes the next shot if that is the last shot, or if other waveforms have closed the switch
  /// bounce-free often enough.
  [[nodiscard]] std::optional<TuningEnd> ends(int most);
  /// Throws InvalidInput if the last three closings of the device gave no contact record.
  void throw_if_failing() const;

  /// Returns the results of the tuning as tune.json holds them; `command` is the command line.
  [[nodiscard]] TuningReport report(TuningEnd end, const std::string& command = {}) const;
  /// Returns the texts of best.toml, best.csv, tune.json and tune.html for the current state of the tuning, by file name.
  [[nodiscard]] std::map<std::string, std::string> files(TuningEnd end, const std::string& command) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softland
