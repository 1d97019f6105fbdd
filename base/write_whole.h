// A file written here is either the old one or the new one, never half of it.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace softland {

/// Throws InvalidInput with path and reason unless write_whole() may write there. The folder must exist and be writable. `path`
/// must not be a folder, a device, a pipe, a database or its companion, nor, under any name, a file that this run has read.
/// Call it before a long computation.
void check_writable(const std::filesystem::path& path);

/// Writes `content` to `path` whole: a temporary name in the same folder, fsync, rename, fsync of the folder. A symbolic link
/// keeps its place; the file behind it is replaced. Whatever goes wrong, an existing file stays as it was and the temporary one
/// is removed. Throws as check_writable() does, and OutputLost with path and reason where the content does not get there, as on
/// a full disk.
void write_whole(const std::filesystem::path& path, std::string_view content);

/// Does the same for content that comes in pieces: it is written as `content` hands it to its argument.
void write_whole(const std::filesystem::path& path,
                 const std::function<void(const std::function<void(std::string_view)>&)>& content);

/// Returns the final name of a file that a killed run left under a temporary name. Other names are returned unchanged.
[[nodiscard]] std::string name_to_be(const std::string& name);

}  // namespace softland
