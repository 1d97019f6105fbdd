// The files that a database keeps beside it while it is written: files of these names belong to it.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace softland {

/// Endings of the files that SQLite, and the lock of a store, keep beside a file.
inline constexpr std::array<std::string_view, 4> companion_endings{"-wal", "-shm", "-journal", ".lock"};

/// Returns true when `path` is, by its name, a companion that the database `of` has or may get.
[[nodiscard]] bool is_companion(const std::filesystem::path& path, const std::filesystem::path& of);

/// Returns true for a regular file that begins as every SQLite file does.
[[nodiscard]] bool is_database(const std::filesystem::path& path);

/// Throws InvalidInput, beginning with `shown`, where `path` is the companion of an existing database: writing to it would
/// destroy the database.
void require_no_companion(const std::filesystem::path& path, const std::string& shown);

/// Marks a database that this process opens: it is not looked into again, since locks of a process go with any descriptor that
/// it closes.
void mark_as_database(const std::filesystem::path& path);

}  // namespace softland
