#include "apps/result_folder.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <ctime>
#include <system_error>

#include "base/output_lost.h"
#include "base/read_file.h"
#include "base/require.h"
#include "reports/files.h"

namespace softland::apps {
namespace {

namespace fs = std::filesystem;

constexpr const char* lock_name = "softland.lock";
constexpr std::string_view word = "process ";  // that a lock begins with
constexpr int most_stages = 100;

std::string reason(int error) { return std::generic_category().message(error); }

// Who holds a lock, as it says so itself.
std::string owner(const std::string& command) {
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '?';
  return fmt::format("{}{} on {} since {:%Y-%m-%d %H:%M:%S} UTC: {}", word, ::getpid(), host.data(),
                     fmt::gmtime(std::time(nullptr)), command);
}

fs::path created(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  require(!error, fmt::format("--out {}: the folder cannot be created: {}", folder, error.message()));
  return folder;
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder, const std::string& place, const std::string& command) : file_(folder / lock_name) {
  for (;;) {
    descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    require(descriptor_ >= 0, fmt::format("{}: the folder cannot be written to: {}", place, reason(errno)));
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      const int error = errno;
      const bool held = error == EWOULDBLOCK;
      std::array<char, 4096> text{};
      const ssize_t length = held ? ::pread(descriptor_, text.data(), text.size(), 0) : 0;
      ::close(descriptor_);
      const std::string who = length > 0 ? std::string(text.data(), static_cast<std::size_t>(length)) : "unknown";
      throw InvalidInput(held ? fmt::format("{}: another run works in this folder ({})", place, who)
                              : fmt::format("{}: the folder cannot be locked: {}", place, reason(error)));
    }
    // Whoever held it may have removed the file between our opening and locking it.
    if (held()) break;
    ::close(descriptor_);
  }
  // A file of that name that no run has made is somebody else's.
  std::array<char, word.size()> begin{};
  const ssize_t there = ::pread(descriptor_, begin.data(), begin.size(), 0);
  if (there != 0 && (there < 0 || std::string_view(begin.data(), static_cast<std::size_t>(there)) != word)) {
    ::close(descriptor_);
    throw InvalidInput(fmt::format("{}: {} is no lock of softland; move it or name another folder", place, file_.string()));
  }
  const std::string text = owner(command);
  const bool written = ::ftruncate(descriptor_, 0) == 0 && ::pwrite(descriptor_, text.data(), text.size(), 0) >= 0;
  static_cast<void>(written);  // on a full disk the lock holds without its words
}

FolderLock::~FolderLock() {
  if (held()) ::unlink(file_.c_str());
  ::close(descriptor_);
}

bool FolderLock::held() const {
  struct stat ours {
  }, there{};
  return ::fstat(descriptor_, &ours) == 0 && ::stat(file_.c_str(), &there) == 0 && ours.st_ino == there.st_ino &&
         ours.st_dev == there.st_dev;
}

ResultFolder::ResultFolder(const std::string& folder, const std::string& command, const std::vector<std::string>& files)
    : folder_(created(folder)), files_(files), lock_(std::make_unique<FolderLock>(folder_, "--out " + folder, command)) {
  for (const std::string& name : files_) {
    std::error_code ignored;
    require(!fs::is_directory(folder_ / name, ignored),
            fmt::format("--out {}: {} is a folder, where a result would be written", folder, (folder_ / name).string()));
    require(!was_read(folder_ / name), fmt::format("--out {}: {} would be replaced, which this run reads; name another folder",
                                                   folder, (folder_ / name).string()));
  }
}

fs::path ResultFolder::staged(int k) const { return folder_ / (k == 1 ? "unfinished" : fmt::format("unfinished-{}", k)); }

fs::path ResultFolder::destination(bool interrupted) const {
  const bool taken = std::any_of(files_.begin(), files_.end(), [&](const std::string& name) {
    std::error_code ignored;
    return fs::exists(folder_ / name, ignored);
  });
  return interrupted && taken ? stage_ : folder_;
}

void ResultFolder::remove_abandoned() const {
  std::error_code error;
  for (int k = 1; k <= most_stages; ++k) {
    const fs::path stage = staged(k);
    if (!fs::is_directory(stage, error)) continue;
    // Only what this kind of run leaves: a search is not given up for a simulation in the same folder.
    bool ours = true;
    for (const auto& entry : fs::directory_iterator(stage, error))
      ours = ours && std::find(files_.begin(), files_.end(), entry.path().filename()) != files_.end() && !was_read(entry.path());
    if (ours) fs::remove_all(stage, error);
  }
}

void ResultFolder::check_lock() const {
  if (!lock_->held()) throw OutputLost(fmt::format("{}: the folder was removed or replaced during this run", folder_.string()));
}

void ResultFolder::write(const std::string& name, std::string_view content) {
  check_lock();
  std::error_code error;
  // Results of a run that was killed are all there is of it: they stay until these are finished.
  for (int k = 1; stage_.empty(); ++k) {
    require(k <= most_stages, fmt::format("{} and {} more hold results of runs that were killed: move or remove them",
                                          staged(1).string(), most_stages - 1));
    const bool fresh = fs::create_directory(staged(k), error);
    if (error) throw OutputLost(fmt::format("{}: cannot be created: {}", staged(k).string(), error.message()));
    if (fresh) stage_ = staged(k);
  }
  write_whole(stage_ / name, content);
  if (std::find(written_.begin(), written_.end(), name) == written_.end()) written_.push_back(name);
}

void ResultFolder::publish(bool interrupted) {
  check_lock();
  if (destination(interrupted) != folder_) return;
  std::error_code error;
  for (const std::string& name : written_) {
    if (const fs::file_status old = fs::status(folder_ / name, error); fs::is_regular_file(old)) {
      fs::permissions(stage_ / name, old.permissions(), error);  // what replaces a file gets its access rights
    }
    fs::rename(stage_ / name, folder_ / name, error);
    if (error)
      throw OutputLost(
          fmt::format("{}: cannot be replaced by {}: {}", (folder_ / name).string(), (stage_ / name).string(), error.message()));
  }
  for (const std::string& name : files_) {
    if (std::find(written_.begin(), written_.end(), name) == written_.end()) fs::remove(folder_ / name, error);
  }
  fs::remove(stage_, error);
  remove_abandoned();
  stage_.clear();
  written_.clear();
}

}  // namespace softland::apps
