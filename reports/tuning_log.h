// The log keeps the closings of a tuning on disk: each is written before the next is fired, so that a power cut loses only the
// current one.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "reports/tuning_lines.h"

namespace softland {

/// This key of a file holds the values that tell apart tunings which cannot continue each other.
inline constexpr const char* origin_key = "tuning";

/// closings.jsonl has a line on the tuned device, one with the recipes that its proposals begin from, then one for each shot
/// with its record.
class TuningLog {
 public:
  struct Closing {
    nlohmann::json shot;  ///< shot as it was sent to the device
    ContactRecord record;
    std::size_t line = 0;  ///< line in the file, counted from 1
  };

  /// Continues the file, or begins it anew: an existing one then gets another name, closings-1.jsonl. The keys and values of
  /// `origin` tell apart tunings that cannot continue each other. Throws InvalidInput with file, line and rule where the file
  /// holds something else, or is of another origin; OutputLost where it cannot be written.
  TuningLog(std::filesystem::path file, const nlohmann::json& origin, bool resume);
  ~TuningLog();
  TuningLog(const TuningLog&) = delete;
  TuningLog& operator=(const TuningLog&) = delete;

  /// Returns the closings that the file held when it was opened.
  [[nodiscard]] const std::vector<Closing>& closings() const { return closings_; }
  /// Returns the recipes of the file; empty where it ended before they were found.
  [[nodiscard]] const std::vector<CandidateWaveform>& recipes() const { return recipes_; }
  /// Returns the new name of an earlier file that was not continued; empty where there was none.
  [[nodiscard]] const std::filesystem::path& moved_to() const { return kept_aside_; }
  /// Both throw OutputLost where the line is not on the disk.
  void append(const std::vector<CandidateWaveform>& recipes);
  void append(const CommandedShot& shot, const ContactRecord& record);
  /// Returns "OUT/closings.jsonl:4".
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
