// The files that a database keeps beside it while it is written: what has their names belongs to it.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace softland {

/// Ends of the names of what SQLite, and the lock of a store, keep beside a file.
inline constexpr std::array<std::string_view, 4> companion_endings{"-wal", "-shm", "-journal", ".lock"};

/// Whether `path` is a companion that the database `of` has or may get, by its name.
[[nodiscard]] bool is_companion(const std::filesystem::path& path, const std::filesystem::path& of);

/// Throws InvalidInput, beginning with `shown`, where `path` is the companion of a database that is there: what is written to it
/// destroys that.
void require_no_companion(const std::filesystem::path& path, const std::string& shown);

/// For databases that this process opens: they are not looked into again, since locks of a process go with any descriptor that it
/// closes.
void mark_as_database(const std::filesystem::path& path);

}  // namespace softland
