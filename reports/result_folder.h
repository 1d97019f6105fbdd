// The folder that a run leaves its results in. Whatever happens, what is there is whole: results are written into a folder inside
// it, and only when all of them are there do they take the places of what an earlier run has left.
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
  /// Creates and locks the folder for the run `command`, which will leave `files` in it; of those it goes on with the `kept` ones
  /// of an earlier run, which stay where they are. Messages begin with `called`, "--out run1". Throws InvalidInput, before
  /// anything is changed, where that is not possible or one of the others is an input of this run.
  ResultFolder(const std::filesystem::path& folder, const std::string& called, const std::string& command,
               const std::vector<std::string>& files, const std::vector<std::string>& kept = {});

  /// Writes a file of the unfinished results.
  void write(const std::string& name, std::string_view content);
  /// Where a file of the unfinished results is to be written by somebody else, who must have let it go before publish().
  [[nodiscard]] std::filesystem::path place(const std::string& name);
  /// Goes on with the unfinished results of a run that was killed, which are in `stage`.
  void adopt(const std::filesystem::path& stage);
  /// Places in `folder` where a file of this name may be, of results that are unfinished or not: the newest first.
  [[nodiscard]] static std::vector<std::filesystem::path> places(const std::filesystem::path& folder, const std::string& name);
  /// Where the results written will be: in the folder, but those of a run that was `interrupted` stay where they are if an
  /// earlier run has left its own.
  [[nodiscard]] std::filesystem::path destination(bool interrupted) const;
  /// Puts them there. In the folder they replace what earlier runs of the same kind have left: all of `files`, and results that
  /// never became finished.
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

  std::unique_ptr<const std::filesystem::path, RemoveEmpty> made_;  // goes after the lock
  std::filesystem::path folder_;
  std::vector<std::string> files_, written_, kept_;
  std::unique_ptr<const LockFile> lock_;
  std::filesystem::path stage_;
};

}  // namespace softland
