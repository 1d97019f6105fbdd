// The files of a store: what stands where one is or should be, and how it may be opened.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "base/lock_file.h"
#include "store/database.h"

namespace softland::internal {

/// In the header of every store, "SoLa": it tells one from other databases.
inline constexpr std::int64_t store_application = 0x536F4C61;

/// Throws InvalidInput with path and reason unless this is a regular file that begins as a store does.
void require_store(const std::filesystem::path& path);

/// Throws InvalidInput where a store that is made here would be, or have beside it, what belongs to somebody else.
void require_room(const std::filesystem::path& path);

/// Keeps other writers off the store, under whatever name. Throws InvalidInput with the name of the other one.
[[nodiscard]] std::unique_ptr<const LockFile> lock_store(const std::filesystem::path& path, const std::string& command);
[[nodiscard]] std::filesystem::path lock_of(const std::filesystem::path& path);

/// Opens it for reading in the way that its place allows.
[[nodiscard]] std::unique_ptr<const Database> open_to_read(const std::filesystem::path& path);

/// How the writer keeps what is not yet in the file: "WAL" lets others read meanwhile, "TRUNCATE" is the only safe one where
/// several machines see the file: the index of a write-ahead log lives in the memory of one. `type`: as statfs() tells.
[[nodiscard]] const char* journal_on(long type);
[[nodiscard]] const char* journal_at(const std::filesystem::path& path);

/// Copies a damaged store with its log to FILE.damaged, unless that is this copy already, and says so in a sentence.
[[nodiscard]] std::string kept_copy(const std::filesystem::path& path);

/// Copies a store that no longer stands at `path` to a file of its own, FILE.rescued beside it, or where the folder is gone too
/// in the current one or that of temporary files. Returns its path. Throws OutputLost, beginning with `said`, where none takes
/// it.
[[nodiscard]] std::filesystem::path copied_to_rescue(const Database& database, const std::filesystem::path& path,
                                                     const std::string& said);

/// A store in the making, beside the place it is made for: under its own name it is whole. Goes when it gets none.
class UnnamedStore {
 public:
  explicit UnnamedStore(std::filesystem::path name);
  UnnamedStore(const UnnamedStore&) = delete;
  UnnamedStore& operator=(const UnnamedStore&) = delete;
  ~UnnamedStore();
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Once nobody has it open. Throws InvalidInput where the name is taken, OutputLost where it cannot be given.
  void give_name() const;

 private:
  std::filesystem::path name_, path_;
};

}  // namespace softland::internal
