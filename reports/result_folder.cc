#include "reports/result_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "base/companion.h"
#include "base/output_lost.h"
#include "base/read_file.h"
#include "base/require.h"
#include "base/write_whole.h"

namespace softland {
namespace {

namespace fs = std::filesystem;

constexpr const char* lock_name = "softland.lock";
constexpr int most_stages = 100;

fs::path staged(const fs::path& folder, int k) { return folder / (k == 1 ? "unfinished" : fmt::format("unfinished-{}", k)); }

bool is_of(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_there(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder, ignored);
}

fs::path created(const fs::path& folder, const std::string& called) {
  require_no_companion(folder, called);
  std::error_code error;
  fs::create_directories(folder, error);
  require(!error, [&] { return fmt::format("{}: the folder cannot be created: {}", called, error.message()); });
  return folder;
}

}  // namespace

ResultFolder::ResultFolder(const fs::path& folder, const std::string& called, const std::string& command,
                           const std::vector<std::string>& files, const std::vector<std::string>& kept)
    : made_(is_there(folder) ? nullptr : new fs::path(fs::absolute(folder))),
      folder_(created(folder, called)),
      files_(files),
      kept_(kept),
      lock_(std::make_unique<LockFile>(folder_ / lock_name, LockedPlace{called, "folder", "another run works in this folder"},
                                       command)) {
  for (const std::string& name : files_) {
    const std::string file = (folder_ / name).string();
    std::error_code ignored;
    require(!fs::is_directory(file, ignored),
            [&] { return fmt::format("{}: {} is a folder, where a result would be written", called, file); });
    require(is_of(kept_, name) || !was_read(file),
            [&] { return fmt::format("{}: {} would be replaced, which this run reads; name another folder", called, file); });
  }
}

void ResultFolder::RemoveEmpty::operator()(const fs::path* folder) const {
  std::error_code ignored;
  fs::remove(*folder, ignored);  // remove() keeps a folder that has files
  delete folder;
}

std::vector<fs::path> ResultFolder::places(const fs::path& folder, const std::string& name) {
  std::vector<fs::path> all;
  std::error_code ignored;
  for (int k = most_stages; k >= 1; --k) {
    if (fs::exists(staged(folder, k) / name, ignored)) all.push_back(staged(folder, k) / name);
  }
  if (fs::exists(folder / name, ignored)) all.push_back(folder / name);
  return all;
}

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
    const fs::path stage = staged(folder_, k);
    if (!fs::is_directory(stage, error)) continue;
    // Adopt unfinished results only of this verb's kind of run: a simulation must not discard the unfinished search in its
    // folder.
    bool ours = true;
    for (const auto& entry : fs::directory_iterator(stage, error)) {
      std::string name = name_to_be(entry.path().filename());
      for (const std::string_view end : companion_endings) {  // files that SQLite left beside the database file of a killed run
        if (name.ends_with(end)) name.resize(name.size() - end.size());
      }
      ours = ours && is_of(files_, name) && !was_read(entry.path());
    }
    if (ours) fs::remove_all(stage, error);
  }
}

void ResultFolder::check_lock() const {
  if (!lock_->held()) throw OutputLost(fmt::format("{}: the folder was removed or replaced during this run", folder_.string()));
}

void ResultFolder::make_stage() {
  check_lock();
  std::error_code error;
  // The unfinished results of a killed run may be the only results: keep them until the results of this run are complete.
  for (int k = 1; stage_.empty(); ++k) {
    const fs::path stage = staged(folder_, k);
    require(k <= most_stages, fmt::format("{} and {} more hold results of runs that were killed: move or remove them",
                                          staged(folder_, 1).string(), most_stages - 1));
    const bool fresh = fs::create_directory(stage, error);
    if (error) throw OutputLost(fmt::format("{}: cannot be created: {}", stage.string(), error.message()));
    if (fresh) stage_ = stage;
  }
}

fs::path ResultFolder::place(const std::string& name) {
  make_stage();
  if (!is_of(written_, name)) written_.push_back(name);
  return stage_ / name;
}

void ResultFolder::write(const std::string& name, std::string_view content) {
  make_stage();
  try {
    write_whole(stage_ / name, content);
  } catch (const InvalidInput&) {
    check_lock();  // the folder may have vanished while the file was written
    throw;
  }
  if (!is_of(written_, name)) written_.push_back(name);
}

void ResultFolder::adopt(const fs::path& stage) { stage_ = stage; }

void ResultFolder::publish(bool interrupted) {
  check_lock();
  if (destination(interrupted) != folder_) return;
  std::error_code error;
  for (const std::string& name : written_) {
    if (const fs::file_status old = fs::status(folder_ / name, error); fs::is_regular_file(old)) {
      fs::permissions(stage_ / name, old.permissions(), error);  // the new file has the permissions of the replaced file
    }
    fs::rename(stage_ / name, folder_ / name, error);
    if (error)
      throw OutputLost(
          fmt::format("{}: cannot be replaced by {}: {}", (folder_ / name).string(), (stage_ / name).string(), error.message()));
    // While another program reads a database file, the write-ahead log of the database remains: move this log too.
    const fs::path log = stage_ / (name + "-wal");
    if (fs::exists(log, error)) fs::rename(log, folder_ / (name + "-wal"), error);
  }
  for (const std::string& name : files_) {
    if (!is_of(written_, name) && !is_of(kept_, name)) fs::remove(folder_ / name, error);
  }
  fs::remove(stage_, error);
  remove_abandoned();
  stage_.clear();
  written_.clear();
}

}  // namespace softland
