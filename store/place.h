// The files of a store (a database of study results): checks what exists at the path of a store, and opens, locks and copies
// its files.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "base/lock_file.h"
#include "store/database.h"

namespace softland::internal {

/// Application id "SoLa" in the header of every study database, which distinguishes it from other databases.
inline constexpr std::int64_t store_application = 0x536F4C61;

/// Throws InvalidInput with path and reason unless the path is a regular file that begins as a study database does.
void require_store(const std::filesystem::path& path);

/// Throws InvalidInput if a new database file at the path would replace an existing file, or if SQLite would replace a log or
/// journal left beside the path.
void require_room(const std::filesystem::path& path);

/// Locks the database file against other writers, also under another name of the file. Throws InvalidInput with a description
/// of the writer that holds the lock.
[[nodiscard]] std::unique_ptr<const LockFile> lock_store(const std::filesystem::path& path, const std::string& command);
[[nodiscard]] std::filesystem::path lock_of(const std::filesystem::path& path);

/// Opens the database file for reading, by the access mode that the permissions of its folder allow.
[[nodiscard]] std::unique_ptr<const Database> open_to_read(const std::filesystem::path& path);

/// Returns the journal mode of SQLite for a file system. "WAL" lets other processes read during a write. Only "TRUNCATE" is
/// safe if several machines use the file, because the index of a write-ahead log is in the memory of one machine. `type` is
/// the file system as statfs() reports it.
[[nodiscard]] const char* journal_on(long type);
[[nodiscard]] const char* journal_at(const std::filesystem::path& path);

/// Copies a damaged database file with its log to FILE.damaged, unless that copy exists. Returns a message about the copy.
[[nodiscard]] std::string kept_copy(const std::filesystem::path& path);

/// Copies a database file that no longer exists at `path`, but is still open, to another file: FILE.rescued beside `path`; if
/// the folder is gone too, in the current folder or that of temporary files. Returns the path of the copy. Throws OutputLost,
/// with a message that begins with `said`, if no folder accepts the copy.
[[nodiscard]] std::filesystem::path copied_to_rescue(const Database& database, const std::filesystem::path& path,
                                                     const std::string& said);

/// A database file under construction, in a temporary file beside its final path. give_name() renames the complete database
/// file; without a call of give_name() the file is removed.
class UnnamedStore {
 public:
  explicit UnnamedStore(std::filesystem::path name);
  UnnamedStore(const UnnamedStore&) = delete;
  UnnamedStore& operator=(const UnnamedStore&) = delete;
  ~UnnamedStore();
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Renames the complete database file to its final path; no process may have the file open. Throws InvalidInput if the path
  /// exists, and OutputLost if the file cannot be renamed.
  void give_name() const;

 private:
  std::filesystem::path name_, path_;
};

}  // namespace softland::internal
