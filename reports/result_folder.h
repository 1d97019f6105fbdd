// The folder that a run leaves its results in is always whole: results are written into a folder inside it. They replace the
// results of an earlier run only when all of them are complete.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/lock_file.h"

namespace softland {

class ResultFolder {
 public:
  /// Creates and locks the folder for the run `command`, which will leave `files` in it. It continues the `kept` ones of an
  /// earlier run, which stay where they are. Messages begin with `called`, "--out run1". Throws InvalidInput, before any
  /// change, where that is not possible or one of the others is an input of this run.
  ResultFolder(const std::filesystem::path& folder, const std::string& called, const std::string& command,
               const std::vector<std::string>& files, const std::vector<std::string>& kept = {});

  /// Writes a file of the unfinished results.
  void write(const std::string& name, std::string_view content);
  /// Returns the path at which another writer may write a file of the unfinished results; it must close the file before
  /// publish().
  [[nodiscard]] std::filesystem::path place(const std::string& name);
  /// Continues the unfinished results of a killed run, which are in `stage`.
  void adopt(const std::filesystem::path& stage);
  /// Returns the possible places of a file of this name in `folder`, of results that are unfinished or not: the newest first.
  [[nodiscard]] static std::vector<std::filesystem::path> places(const std::filesystem::path& folder, const std::string& name);
  /// Returns the final place of the results written: the folder itself. Results of a run that was `interrupted` stay where they
  /// are if an earlier run has left its own.
  [[nodiscard]] std::filesystem::path destination(bool interrupted) const;
  /// Moves them to their destination. In the folder they replace the results of earlier runs of the same kind: all of `files`,
  /// and results that were never finished.
  void publish(bool interrupted);

  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

 private:
  void make_stage();
  void remove_abandoned() const;
  void check_lock() const;

  // Removes a folder that this run has made, when it leaves nothing there.
  struct RemoveEmpty {
    void operator()(const std::filesystem::path* folder) const;
  };

  std::unique_ptr<const std::filesystem::path, RemoveEmpty> made_;  // destroyed after the lock
  std::filesystem::path folder_;
  std::vector<std::string> files_, written_, kept_;
  std::unique_ptr<const LockFile> lock_;
  std::filesystem::path stage_;
};

}  // namespace softland
