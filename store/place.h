// The files of a store: what exists at its place, and how it may be opened.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "base/lock_file.h"
#include "store/database.h"

namespace softland::internal {

/// Application id in the header of every store, "SoLa": it tells a store from other databases.
inline constexpr std::int64_t store_application = 0x536F4C61;

/// Throws InvalidInput with path and reason unless this is a regular file that begins as a store does.
void require_store(const std::filesystem::path& path);

/// Throws InvalidInput where a new store would replace a file of somebody else, or have one beside it as its companion.
void require_room(const std::filesystem::path& path);

/// Keeps other writers off the store, under whatever name. Throws InvalidInput with the name of the other writer.
[[nodiscard]] std::unique_ptr<const LockFile> lock_store(const std::filesystem::path& path, const std::string& command);
[[nodiscard]] std::filesystem::path lock_of(const std::filesystem::path& path);

/// Opens the store for reading in the way that its place allows.
[[nodiscard]] std::unique_ptr<const Database> open_to_read(const std::filesystem::path& path);

/// Returns the journal mode, which decides where the writer keeps what is not yet in the file. "WAL" lets others read
/// meanwhile. "TRUNCATE" is the only safe one where several machines see the file: the index of a write-ahead log lives in the
/// memory of one. `type` is the file system as statfs() reports it.
[[nodiscard]] const char* journal_on(long type);
[[nodiscard]] const char* journal_at(const std::filesystem::path& path);

/// Copies a damaged store with its log to FILE.damaged, unless that is this copy already, and reports this in a sentence.
[[nodiscard]] std::string kept_copy(const std::filesystem::path& path);

/// Copies a store that no longer exists at `path` to a file of its own. The file is FILE.rescued beside it; if the folder is
/// gone too, in the current folder or that of temporary files. Returns its path. Throws OutputLost, beginning with `said`,
/// where no place accepts it.
[[nodiscard]] std::filesystem::path copied_to_rescue(const Database& database, const std::filesystem::path& path,
                                                     const std::string& said);

/// A store under construction, beside its final place: it gets its own name only when it is complete. It is removed when it
/// gets none.
class UnnamedStore {
 public:
  explicit UnnamedStore(std::filesystem::path name);
  UnnamedStore(const UnnamedStore&) = delete;
  UnnamedStore& operator=(const UnnamedStore&) = delete;
  ~UnnamedStore();
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Gives the store its name once nobody has it open. Throws InvalidInput where the name is taken, OutputLost where it cannot
  /// be given.
  void give_name() const;

 private:
  std::filesystem::path name_, path_;
};

}  // namespace softland::internal
