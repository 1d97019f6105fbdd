// The folder that a run leaves its results in. Whatever happens, what is there is whole: results are written into a folder inside
// it, and only when all of them are there do they take the places of what an earlier run has left.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/lock_file.h"

namespace softland::apps {

class ResultFolder {
 public:
  /// Creates and locks the folder for the run `command`, which will leave `files` in it. Throws InvalidInput, before anything is
  /// changed, where that is not possible or one of these files is an input of this run.
  ResultFolder(const std::string& folder, const std::string& command, const std::vector<std::string>& files);

  /// Writes a file of the unfinished results.
  void write(const std::string& name, std::string_view content);
  /// Where the results written will be: in the folder, but those of a run that was `interrupted` stay where they are if an
  /// earlier run has left its own.
  [[nodiscard]] std::filesystem::path destination(bool interrupted) const;
  /// Puts them there. In the folder they replace what earlier runs of the same kind have left: all of `files`, and results that
  /// never became finished.
  void publish(bool interrupted);

  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

 private:
  [[nodiscard]] std::filesystem::path staged(int k) const;
  void remove_abandoned() const;
  void check_lock() const;

  std::filesystem::path folder_;
  std::vector<std::string> files_, written_;
  std::unique_ptr<const LockFile> lock_;
  std::filesystem::path stage_;
};

}  // namespace softland::apps
