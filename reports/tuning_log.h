// The closings of a tuning on disk: each is there for good before the next is fired, so that a power cut loses the one under way.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "reports/tuning_lines.h"

namespace softland {

/// Of what tells apart tunings that cannot go on with each other, in a file.
inline constexpr const char* origin_key = "tuning";

/// closings.jsonl: a line that says what is tuned, one with the recipes that its proposals begin from, then one for each shot
/// with what came of it.
class TuningLog {
 public:
  struct Closing {
    nlohmann::json shot;  ///< as the device was told
    ContactRecord record;
    std::size_t line = 0;  ///< in the file, counted from 1
  };

  /// Goes on with the file, or begins it anew: one that is there then gets another name, closings-1.jsonl. `origin` tells apart
  /// what cannot go on with each other: its keys and values. Throws InvalidInput with file, line and rule where the file holds
  /// something else, or is of another origin; OutputLost where it cannot be written.
  TuningLog(std::filesystem::path file, const nlohmann::json& origin, bool resume);
  ~TuningLog();
  TuningLog(const TuningLog&) = delete;
  TuningLog& operator=(const TuningLog&) = delete;

  /// Those that the file held when it was opened.
  [[nodiscard]] const std::vector<Closing>& closings() const { return closings_; }
  /// Those of the file; empty where it ended before they were found.
  [[nodiscard]] const std::vector<Recipe>& recipes() const { return recipes_; }
  /// Where an earlier file went that was not gone on with; empty where there was none.
  [[nodiscard]] const std::filesystem::path& kept_aside() const { return kept_aside_; }
  /// Both throw OutputLost where the line is not on the disk.
  void append(const std::vector<Recipe>& recipes);
  void append(const ToldShot& shot, const ContactRecord& record);
  /// "OUT/closings.jsonl:4"
  [[nodiscard]] std::string place(const Closing& closing) const;

 private:
  [[nodiscard]] std::size_t read(const nlohmann::json& origin);
  void open(std::size_t size);
  void write(const nlohmann::json& line);

  std::filesystem::path file_, kept_aside_;
  std::vector<Closing> closings_;
  std::vector<Recipe> recipes_;
  int descriptor_ = -1;
};

}  // namespace softland
