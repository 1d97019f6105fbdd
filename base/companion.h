// Companions of a database: the files that SQLite has beside an open database, and the lock file that a run puts beside it.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace softland {

/// Endings that the name of a companion adds to the name of its database.
inline constexpr std::array<std::string_view, 4> companion_endings{"-wal", "-shm", "-journal", ".lock"};

/// Returns true when `path` is the name of a companion of the database `of`. Neither file has to exist.
[[nodiscard]] bool is_companion(const std::filesystem::path& path, const std::filesystem::path& of);

/// Returns true for a file that begins as every SQLite file does. Opens and closes the file, which ends the locks that this
/// process has on it.
[[nodiscard]] bool begins_as_database(const std::filesystem::path& path);

/// Throws InvalidInput, with a message that begins with `shown`, when `path` is the name of a companion of an existing
/// database: writing to that file would destroy the database.
void require_no_companion(const std::filesystem::path& path, const std::string& shown);

/// Marks a file as a database that this process has open. require_no_companion() then does not open the file: closing any
/// descriptor of a file releases the locks that the process has on this file.
void mark_as_database(const std::filesystem::path& path);

}  // namespace softland
