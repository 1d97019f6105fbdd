// A lock file, by which one process at a time works in a folder or on a database file. Its content describes the process.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace softland {

/// The folder or file from which a lock keeps other runs away, in the words of messages.
struct LockedPlace {
  std::string name;      ///< name of the folder or file, with which messages begin: "--out run1"
  std::string kind;      ///< word for the place in messages: "folder" or "folder of the store"
  std::string occupied;  ///< message when another process has the lock: "another run works in this folder"
};

/// Excludes other runs during the lifetime of this object, by flock on `file`, which the constructor creates and the destructor
/// removes. The lock of a process ends with the process.
class LockFile {
 public:
  /// Throws InvalidInput with the words of `place` when the file cannot be created, is not a lock file, or another run has
  /// locked it.
  LockFile(const std::filesystem::path& file, const LockedPlace& place, const std::string& command);
  ~LockFile();
  LockFile(const LockFile&) = delete;
  LockFile& operator=(const LockFile&) = delete;
  /// Returns true when the lock file still exists at its path; a user may have removed or renamed its folder.
  [[nodiscard]] bool held() const;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

/// Returns a description of the process that has the lock, "process 4711 on node3 since 2026-01-31 12:00:00 UTC: softland
/// optimize"; none when no process has it.
[[nodiscard]] std::optional<std::string> holder_of(const std::filesystem::path& file);

/// Returns the name of this machine; "?" where it has none.
[[nodiscard]] std::string host_name();

}  // namespace softland
