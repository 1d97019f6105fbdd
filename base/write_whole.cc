#include "base/write_whole.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <fstream>
#include <system_error>

#include "base/companion.h"
#include "base/output_lost.h"
#include "base/read_file.h"
#include "base/require.h"

namespace softland {
namespace {

/// Closes the descriptor and removes the temporary file unless rename_to() succeeded.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::filesystem::path& beside) {
    static std::atomic<unsigned> serial{0};
    do {
      name_ = fmt::format("{}.{}-{}.tmp", beside.string(), ::getpid(), serial++);
      descriptor_ = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (descriptor_ < 0 && errno == EEXIST);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (descriptor_ < 0) return;
    ::close(descriptor_);
    if (!renamed_) ::unlink(name_.c_str());
  }
  [[nodiscard]] bool open() const { return descriptor_ >= 0; }
  [[nodiscard]] bool write(std::string_view content) const {
    while (!content.empty()) {
      const ssize_t written = ::write(descriptor_, content.data(), content.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return false;
      content.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
  }
  [[nodiscard]] bool sync() const { return ::fsync(descriptor_) == 0; }
  /// Gives a file that replaces another one the permissions of the replaced file.
  [[nodiscard]] bool adopt_rights(const std::filesystem::path& path) const {
    std::error_code missing;
    const auto old = std::filesystem::status(path, missing);
    if (missing || !std::filesystem::is_regular_file(old)) return true;
    return ::fchmod(descriptor_, static_cast<mode_t>(old.permissions() & std::filesystem::perms::all)) == 0;
  }
  [[nodiscard]] bool rename_to(const std::filesystem::path& path) {
    renamed_ = ::rename(name_.c_str(), path.c_str()) == 0;
    return renamed_;
  }

 private:
  std::string name_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

/// Returns the file to which a symbolic link leads, so that the link is not replaced.
std::filesystem::path behind_links(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_symlink(path, error)) return path;
  const std::filesystem::path target = std::filesystem::canonical(path, error);
  return error ? path : target;
}

/// Returns an error message with the path, the failed action and the text of errno.
std::string failure(const std::filesystem::path& path, const char* what) {
  return fmt::format("{}: cannot {}: {}", path.string(), what, std::generic_category().message(errno));
}

/// Throws, unless the file operation `what` on the path was `done`: OutputLost for a full disk or an input/output error, and
/// InvalidInput for any other error.
void require_place(bool done, const std::filesystem::path& path, const char* what) {
  if (done) return;
  if (errno == ENOSPC || errno == EDQUOT || errno == EIO) throw OutputLost(failure(path, what));
  throw InvalidInput(failure(path, what));
}

}  // namespace

void check_writable(const std::filesystem::path& path) {
  const std::filesystem::path target = behind_links(path);
  require_no_companion(target, path.string());
  require_place(TemporaryFile(target).open(), path, "write in its folder");
  std::error_code missing;
  const auto old = std::filesystem::status(target, missing);
  if (missing || !std::filesystem::exists(old)) return;
  errno = EISDIR;
  require_place(!std::filesystem::is_directory(old), path, "replace it");
  require(std::filesystem::is_regular_file(old), path.string() + ": is no regular file, so it is not replaced");
  require(!was_read(target), path.string() + ": is read by this run, so its output does not replace it");
  require(!begins_as_database(target), path.string() + ": is the store of a study, so it is not replaced");
}

std::string name_to_be(const std::string& name) {
  constexpr std::string_view ending = ".tmp";
  if (!name.ends_with(ending)) return name;
  const std::size_t end = name.size() - ending.size(), dot = name.rfind('.', end - 1);
  const bool is_ours = dot != std::string::npos && name.find_first_not_of("0123456789-", dot + 1) == end;
  return is_ours ? name.substr(0, dot) : name;
}

void write_whole(const std::filesystem::path& path, std::string_view content) {
  write_whole(path, [&](const std::function<void(std::string_view)>& sink) { sink(content); });
}

void write_whole(const std::filesystem::path& path,
                 const std::function<void(const std::function<void(std::string_view)>&)>& content) {
  check_writable(path);
  const std::filesystem::path target = behind_links(path);
  const auto written = [&](bool done, const char* what) {
    if (!done) throw OutputLost(failure(path, what));
  };
  TemporaryFile temporary(target);
  require_place(temporary.open(), path, "write in its folder");
  content([&](std::string_view piece) { written(temporary.write(piece), "write"); });
  written(temporary.sync(), "write");
  written(temporary.adopt_rights(target), "set its access rights");
  require_place(temporary.rename_to(target), path, "replace it");
  const std::filesystem::path folder = target.has_parent_path() ? target.parent_path() : ".";
  const int directory = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  written(directory >= 0, "open its folder");
  // EINVAL is no failure: some file systems cannot sync a folder and report this so. The rename itself has been done.
  const bool synced = ::fsync(directory) == 0 || errno == EINVAL;
  const int reason = errno;
  ::close(directory);
  errno = reason;
  written(synced, "sync its folder");
}

}  // namespace softland
