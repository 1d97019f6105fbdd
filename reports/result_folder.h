// The folder in which a run leaves its results. A run writes into a subfolder. When all results are complete, they replace the
// results of an earlier run in the folder, so that the folder is always complete.
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
  /// Creates and locks the folder for a run with the command line `command`, which will write `files` to the folder. The run
  /// continues the files `kept` of an earlier run, which stay in place. Messages begin with `called`, such as "--out run1".
  /// Throws InvalidInput, before any change, if the run cannot write there, or if one of `files` that is not continued is an
  /// input of this run.
  ResultFolder(const std::filesystem::path& folder, const std::string& called, const std::string& command,
               const std::vector<std::string>& files, const std::vector<std::string>& kept = {});

  /// Writes a file into the subfolder of unfinished results.
  void write(const std::string& name, std::string_view content);
  /// Returns the path at which another writer may write a file of the unfinished results; the writer must close the file before
  /// publish().
  [[nodiscard]] std::filesystem::path place(const std::string& name);
  /// Continues the unfinished results of a killed run, which are in the folder `stage`.
  void adopt(const std::filesystem::path& stage);
  /// Returns the paths that a file of this name may have in `folder`, among finished and unfinished results, the newest first.
  [[nodiscard]] static std::vector<std::filesystem::path> places(const std::filesystem::path& folder, const std::string& name);
  /// Returns the final folder of the results of this run: the folder of --out, or the subfolder of unfinished results if the
  /// run was interrupted and the folder has results of an earlier run.
  [[nodiscard]] std::filesystem::path destination(bool interrupted) const;
  /// Moves the results to destination(). In the folder of --out they replace results of earlier runs; `files` that this run has
  /// not written, and unfinished results of the same kind of run, are removed.
  void publish(bool interrupted);

  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

 private:
  void make_stage();
  void remove_abandoned() const;
  void check_lock() const;

  // Removes a folder that this run has created, if the folder is empty at the end.
  struct RemoveEmpty {
    void operator()(const std::filesystem::path* folder) const;
  };

  // Removes the folder; declared before the lock, and so destroyed after the lock.
  std::unique_ptr<const std::filesystem::path, RemoveEmpty> made_;
  std::filesystem::path folder_;
  std::vector<std::string> files_, written_, kept_;
  std::unique_ptr<const LockFile> lock_;
  std::filesystem::path stage_;
};

}  // namespace softland
