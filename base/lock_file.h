// One process at a time: a file beside what is worked on, locked by whoever works there, in which it says who it is.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace softland {

/// What a lock keeps other runs out of, in words for messages.
struct LockedPlace {
  std::string name;      ///< "--out run1": messages begin with it
  std::string kind;      ///< "folder": what cannot be written to where the lock cannot be made
  std::string occupied;  ///< "another run works in this folder"
};

/// Keeps other runs out while it lives: flock on `file`, which it makes and removes. A process that died holds nothing.
class LockFile {
 public:
  /// Throws InvalidInput with the words of `place` where the file cannot be made, is no lock, or another run holds it.
  LockFile(const std::filesystem::path& file, const LockedPlace& place, const std::string& command);
  ~LockFile();
  LockFile(const LockFile&) = delete;
  LockFile& operator=(const LockFile&) = delete;
  /// Whether the lock still stands where it was made: somebody may have removed or renamed its folder.
  [[nodiscard]] bool held() const;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

/// "process 4711 on node3 since 2026-01-31 12:00:00 UTC: softland optimize": who holds the lock now; none: nobody.
[[nodiscard]] std::optional<std::string> holder_of(const std::filesystem::path& file);

/// The name of this machine; "?" where it has none.
[[nodiscard]] std::string host_name();

}  // namespace softland
