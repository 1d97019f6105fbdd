#include "apps/result_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "base/output_lost.h"
#include "base/read_file.h"
#include "base/require.h"
#include "reports/files.h"

namespace softland::apps {
namespace {

namespace fs = std::filesystem;

constexpr const char* lock_name = "softland.lock";
constexpr int most_stages = 100;

fs::path created(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  require(!error, fmt::format("--out {}: the folder cannot be created: {}", folder, error.message()));
  return folder;
}

}  // namespace

ResultFolder::ResultFolder(const std::string& folder, const std::string& command, const std::vector<std::string>& files)
    : folder_(created(folder)),
      files_(files),
      lock_(std::make_unique<LockFile>(folder_ / lock_name,
                                       LockedPlace{"--out " + folder, "folder", "another run works in this folder"}, command)) {
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
