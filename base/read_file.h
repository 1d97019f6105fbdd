// Reads files: whole, within a bound of size, and regular files only.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace softland {

/// The largest file that is read [byte]. Scenes, measured waveforms and results stay far below.
inline constexpr std::size_t largest_file = std::size_t{64} << 20;

/// Returns the content of a file. Throws InvalidInput with path and reason where the file cannot be opened or read, is not a
/// regular file (a folder, a device, or a pipe, without waiting for data), or is larger than `largest_file`.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

/// Returns the content of a file as read_file() does, but does not mark the file as an input of this run: results of the run
/// may overwrite the file.
[[nodiscard]] std::string look_into(const std::filesystem::path& path);

/// Marks a file that other code reads, such as a database, as an input of this run.
void mark_as_read(const std::filesystem::path& path);

/// Returns true for a file that this process has read with read_file() or passed to mark_as_read(), and that still has the name
/// under which it was read. Results must not replace such an input.
[[nodiscard]] bool was_read(const std::filesystem::path& path);

}  // namespace softland
