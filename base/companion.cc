#include "base/companion.h"

#include <sys/stat.h>

#include <cstring>
#include <fstream>
#include <mutex>
#include <set>
#include <system_error>
#include <utility>

#include "base/require.h"

namespace softland {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view database_magic{"SQLite format 3\0", 16};

std::mutex databases_guard;
std::set<std::pair<dev_t, ino_t>>& databases() {
  static std::set<std::pair<dev_t, ino_t>> all;
  return all;
}

fs::path real_path(const fs::path& path) {
  std::error_code error;
  const fs::path found = fs::weakly_canonical(fs::absolute(path), error);
  return error ? path : found;
}

// Returns true for a regular file that is a database. A file that mark_as_database() has marked is not opened for the check.
bool is_database(const fs::path& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return false;
  {
    const std::lock_guard lock(databases_guard);
    if (databases().contains({info.st_dev, info.st_ino})) return true;
  }
  return begins_as_database(path);
}

}  // namespace

bool begins_as_database(const fs::path& path) {
  std::array<char, database_magic.size()> begin{};
  std::ifstream in(path, std::ios::binary);
  return in.read(begin.data(), begin.size()) && std::memcmp(begin.data(), database_magic.data(), database_magic.size()) == 0;
}

bool is_companion(const fs::path& path, const fs::path& of) {
  const std::string name = real_path(path).string(), database = real_path(of).string();
  for (const std::string_view ending : companion_endings) {
    if (name == database + std::string(ending)) return true;
  }
  return false;
}

void require_no_companion(const fs::path& path, const std::string& shown) {
  const std::string name = real_path(path).string();
  for (const std::string_view ending : companion_endings) {
    if (!name.ends_with(ending)) continue;
    const std::string database = name.substr(0, name.size() - ending.size());
    require(!is_database(database), [&] {
      return shown + ": is the name of a file that the store " + database +
             " needs for itself, and must not be overwritten; choose another name";
    });
  }
}

void mark_as_database(const fs::path& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) return;
  const std::lock_guard lock(databases_guard);
  databases().emplace(info.st_dev, info.st_ino);
}

}  // namespace softland
