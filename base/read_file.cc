#include "base/read_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/require.h"

namespace softland {
namespace {

// The files read so far and their names. Device and inode identify a file, since other names, links and relative paths may lead
// to the same file. The names are stored too: in a long process a new file may get the inode of a deleted one.
using Identity = std::pair<dev_t, ino_t>;
std::mutex guard;
std::map<Identity, std::set<std::filesystem::path>>& files_read() {
  static std::map<Identity, std::set<std::filesystem::path>> all;
  return all;
}

// Returns device and inode of a file; none when the file does not exist.
std::optional<Identity> identity_of(const std::filesystem::path& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) return {};
  return Identity{info.st_dev, info.st_ino};
}

std::string_view kind(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

class Descriptor {
 public:
  // O_NONBLOCK prevents that opening a pipe waits for a writer.
  explicit Descriptor(const std::filesystem::path& path) : number_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

}  // namespace

std::string look_into(const std::filesystem::path& path) {
  const std::string name = path.string();
  const auto check = [&](bool done) {
    if (!done) throw InvalidInput(name + ": cannot be read: " + std::generic_category().message(errno));
  };
  const Descriptor file(path);
  check(file.number() >= 0);
  struct stat info {};
  check(::fstat(file.number(), &info) == 0);
  require(S_ISREG(info.st_mode), name + ": is " + std::string(kind(info.st_mode)) + ", it must be a regular file");
  std::string content, block(std::size_t{1} << 16, '\0');
  for (;;) {
    const ssize_t count = ::read(file.number(), block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    check(count >= 0);
    if (count == 0) break;
    content.append(block, 0, static_cast<std::size_t>(count));
    // Check the size while reading: the size in `info` is 0 for files of /proc, and a file may grow.
    require(content.size() <= largest_file,
            name + ": is too large, it must have at most " + std::to_string(largest_file >> 20) + " MiB");
  }
  return content;
}

std::string read_file(const std::filesystem::path& path) {
  std::string content = look_into(path);
  mark_as_read(path);
  return content;
}

void mark_as_read(const std::filesystem::path& path) {
  const std::optional<Identity> file = identity_of(path);
  if (!file) return;
  const std::lock_guard lock(guard);
  files_read()[*file].insert(std::filesystem::absolute(path));
}

bool was_read(const std::filesystem::path& path) {
  const std::optional<Identity> file = identity_of(path);
  if (!file) return false;
  const std::lock_guard lock(guard);
  const auto found = files_read().find(*file);
  return found != files_read().end() &&
         std::ranges::any_of(found->second, [&](const auto& name) { return identity_of(name) == file; });
}

}  // namespace softland
