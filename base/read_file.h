// How every file is read: whole, within a bound, and only if it is a regular file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace softland {

/// The largest file that is read [byte]. Scenes, measured waveforms and results stay far below.
inline constexpr std::size_t largest_file = std::size_t{64} << 20;

/// The content of a file. Throws InvalidInput with path and reason where it cannot be opened or read, is not a regular file
/// (a folder, a device, a pipe: it is not waited for), or is larger than `largest_file`.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

/// The same of a file that is no input of this run: results may replace it.
[[nodiscard]] std::string look_into(const std::filesystem::path& path);

/// For files that others read, such as databases.
void mark_as_read(const std::filesystem::path& path);

/// Whether this is a file that was read in this process, by read_file() or as mark_as_read() was told, and that still bears the
/// name it was read by, among whatever others: results must not replace it.
[[nodiscard]] bool was_read(const std::filesystem::path& path);

}  // namespace softland
