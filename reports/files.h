// Files that are either the old one or the new one, never half of it.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "reports/closing_record.h"

namespace softland {

/// Throws InvalidInput with path and reason unless write_whole() may write there: the folder exists and is writable, and `path`
/// is neither a folder nor a device or pipe nor a database or its companion nor, under whatever name, a file that this run has
/// read. For what takes long to compute, to be asked before.
void check_writable(const std::filesystem::path& path);

/// Writes `content` to `path` whole: a temporary name in the same folder, fsync, rename, fsync of the folder. Of a symbolic link
/// the file behind it is replaced. Whatever goes wrong, an existing file stays as it was and the temporary one is removed. Throws
/// as check_writable() does, and OutputLost with path and reason where the content does not get there, as on a full disk.
void write_whole(const std::filesystem::path& path, std::string_view content);

/// The same for content that comes in pieces: it is written as `content` hands it to its argument.
void write_whole(const std::filesystem::path& path,
                 const std::function<void(const std::function<void(std::string_view)>&)>& content);

/// Of the temporary name under which a killed run left a file that it wrote: the name that it was to get. Other names are as they
/// are.
[[nodiscard]] std::string name_to_be(const std::string& name);

/// The curve of a run as CSV: header time_s,tip_gap_m,tip_velocity_m_s,contact_force_N,contact_resistance_ohm (those that exist);
/// one line per row, shortest text that reads back to the same number, an empty field for what is not finite.
[[nodiscard]] std::string trajectory_csv(const CurveRecord& curve);

}  // namespace softland
