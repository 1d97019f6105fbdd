// The log writes the closings of a tuning to the disk: each closing is written before the next shot, so that a power cut loses
// only the current closing.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "reports/tuning_lines.h"

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

}  // namespace softland
