// Writes files such that a crash leaves either the complete old or the complete new content.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace softland {

/// Throws InvalidInput with path and reason unless write_whole() may write to `path`. The folder must exist and be writable.
/// `path` must not be a folder, a device, a pipe, a database or its companion, nor, under any name, a file that this run has
/// read. Call this function before a long computation.
void check_writable(const std::filesystem::path& path);

/// Writes `content` to `path` whole: a temporary name in the same folder, fsync, rename, fsync of the folder. A symbolic link
/// remains; the file to which it leads is replaced. After any failure an existing file is unchanged and the temporary file is
/// removed. Throws the exceptions of check_writable(), and OutputLost with path and reason if the content cannot be written, as
/// on a full disk.
void write_whole(const std::filesystem::path& path, std::string_view content);

/// Writes a file as write_whole() above does, from content that comes in parts: `content` passes each part to its argument.
void write_whole(const std::filesystem::path& path,
                 const std::function<void(const std::function<void(std::string_view)>&)>& content);

/// Returns, for the temporary name of a file that a killed run left behind, the final name that write_whole() would have given
/// to the file. Returns all other names unchanged.
[[nodiscard]] std::string name_to_be(const std::string& name);

}  // namespace softland
