// One process at a time: a file beside the place of work, locked by the process that works there, with its description as
// content.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace softland {

/// The place that a lock protects from other runs, in words for messages.
struct LockedPlace {
  std::string name;      ///< messages begin with it: "--out run1"
  std::string kind;      ///< kind of the place that cannot be written to where the lock cannot be made: "folder"
  std::string occupied;  ///< message for a held lock: "another run works in this folder"
};

/// Keeps other runs out while it lives: flock on `file`, which it creates and removes. A process that died holds nothing.
class LockFile {
 public:
  /// Throws InvalidInput with the words of `place` where the file cannot be made, is not a lock, or another run holds it.
  LockFile(const std::filesystem::path& file, const LockedPlace& place, const std::string& command);
  ~LockFile();
  LockFile(const LockFile&) = delete;
  LockFile& operator=(const LockFile&) = delete;
  /// True when the lock still exists where it was made: somebody may have removed or renamed its folder.
  [[nodiscard]] bool held() const;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

/// Returns the current holder of the lock, "process 4711 on node3 since 2026-01-31 12:00:00 UTC: softland optimize"; none if
/// free.
[[nodiscard]] std::optional<std::string> holder_of(const std::filesystem::path& file);

/// Returns the name of this machine; "?" where it has none.
[[nodiscard]] std::string host_name();

}  // namespace softland
