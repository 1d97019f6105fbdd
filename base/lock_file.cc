#include "base/lock_file.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <ctime>
#include <string_view>
#include <system_error>

#include "base/require.h"

namespace softland {
namespace {

constexpr std::string_view word = "process ";  // first word in a lock file; the number of the process that has the lock follows
// Number of attempts to lock the file: holder_of() takes a shared lock for a moment, so one failed attempt does not mean that
// another run has the lock.
constexpr int most_attempts = 20;
constexpr useconds_t between_attempts = 10'000;  // wait between two attempts to lock the file [us]

std::string reason(int error) { return std::generic_category().message(error); }

std::string owner(const std::string& command) {
  return fmt::format("{}{} on {} since {:%Y-%m-%d %H:%M:%S} UTC: {}", word, ::getpid(), host_name(),
                     fmt::gmtime(std::time(nullptr)), command);
}

bool locked(int descriptor) {
  for (int attempt = 1; ::flock(descriptor, LOCK_EX | LOCK_NB) != 0; ++attempt) {
    if (errno != EWOULDBLOCK || attempt == most_attempts) return false;
    ::usleep(between_attempts);
  }
  return true;
}

std::string words_in(int descriptor) {
  std::array<char, 4096> text{};
  const ssize_t length = ::pread(descriptor, text.data(), text.size(), 0);
  return length > 0 ? std::string(text.data(), static_cast<std::size_t>(length)) : "unknown";
}

}  // namespace

std::string host_name() {
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '?';
  return host.data();
}

LockFile::LockFile(const std::filesystem::path& file, const LockedPlace& place, const std::string& command) : file_(file) {
  for (;;) {
    descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    require(descriptor_ >= 0, fmt::format("{}: the {} cannot be written to: {}", place.name, place.kind, reason(errno)));
    if (!locked(descriptor_)) {
      const int error = errno;
      const bool taken = error == EWOULDBLOCK;
      const std::string who = taken ? words_in(descriptor_) : "";
      ::close(descriptor_);
      throw InvalidInput(taken ? fmt::format("{}: {} ({})", place.name, place.occupied, who)
                               : fmt::format("{}: the {} cannot be locked: {}", place.name, place.kind, reason(error)));
    }
    // Open and lock the file again if it is gone: its previous holder may have removed it after this process opened it and
    // before this process locked it.
    if (held()) break;
    ::close(descriptor_);
  }
  // Refuse to overwrite a file of this name that is not a lock file of this program: it does not begin with `word`.
  std::array<char, word.size()> begin{};
  const ssize_t there = ::pread(descriptor_, begin.data(), begin.size(), 0);
  if (there != 0 && (there < 0 || std::string_view(begin.data(), static_cast<std::size_t>(there)) != word)) {
    ::close(descriptor_);
    throw InvalidInput(fmt::format("{}: {} is not a lock file of softland; move it or choose another {}", place.name,
                                   file_.string(), place.kind));
  }
  const std::string text = owner(command);
  const bool written = ::ftruncate(descriptor_, 0) == 0 && ::pwrite(descriptor_, text.data(), text.size(), 0) >= 0;
  static_cast<void>(written);  // the lock is valid even when a full disk leaves its file empty
}

LockFile::~LockFile() {
  if (held()) ::unlink(file_.c_str());
  ::close(descriptor_);
}

bool LockFile::held() const {
  struct stat ours {
  }, there{};
  return ::fstat(descriptor_, &ours) == 0 && ::stat(file_.c_str(), &there) == 0 && ours.st_ino == there.st_ino &&
         ours.st_dev == there.st_dev;
}

std::optional<std::string> holder_of(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return std::nullopt;
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor < 0) return std::nullopt;
  const bool taken = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  std::optional<std::string> who;
  if (taken) who = words_in(descriptor);
  ::close(descriptor);
  return who;
}

}  // namespace softland
