#include "store/place.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <system_error>

#include "base/companion.h"
#include "base/output_lost.h"
#include "base/read_file.h"
#include "base/require.h"
#include "store/study_store.h"

namespace softland {
namespace internal {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view magic{"SQLite format 3\0", 16};
using Header = std::array<unsigned char, 100>;
// Offsets of fields in the header of an SQLite file [byte].
constexpr std::size_t version_for_reading = 19, application_id = 68;
constexpr int write_ahead = 2;

fs::path beside(const fs::path& path, const char* ending) {
  std::error_code ignored;
  const fs::path real = fs::weakly_canonical(path, ignored);
  return (real.empty() ? path : real).string() + ending;
}

bool has_content(const fs::path& file) {
  std::error_code error;
  return fs::file_size(file, error) > 0 && !error;
}

// Returns the header, the first bytes, of an SQLite file; none if the file is shorter or cannot be read.
std::optional<Header> header_of(const fs::path& path) {
  Header header{};
  std::ifstream in(path, std::ios::binary);
  if (!in.read(reinterpret_cast<char*>(header.data()), header.size())) return std::nullopt;
  return header;
}

std::uint32_t big_endian(const Header& header, std::size_t place) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | header[place + i];
  return value;
}

// Returns the reason why the file is not a study database; empty for a study database.
std::string fault_of(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) return "the file does not exist";
  if (error) return error.message();
  if (fs::is_directory(status)) return "is a folder, not a store";
  if (!fs::is_regular_file(status)) return "must be a regular file";
  if (OpenFile::is_open(path)) return {};
  if (::access(path.c_str(), R_OK) != 0) return std::generic_category().message(errno);
  if (fs::file_size(path, error) == 0 && !error) return "is empty (0 bytes); remove it or name another file";
  errno = 0;
  const std::optional<Header> header = header_of(path);
  if (!header && errno != 0) {
    const char* more = errno == EMFILE ? "; the limit of open files is too low (ulimit -n)" : "";
    return fmt::format("cannot be read: {}{}", std::generic_category().message(errno), more);
  }
  if (!header || std::memcmp(header->data(), magic.data(), magic.size()) != 0)
    return "is not a store of softland, or its beginning is damaged: it must begin as a database of SQLite";
  if (big_endian(*header, application_id) != store_application) return "is a database of SQLite, but not a store of softland";
  return {};
}

bool writable(const fs::path& path) {
  const fs::path folder = fs::absolute(beside(path, "")).parent_path();
  return ::access(path.c_str(), W_OK) == 0 && ::access(folder.c_str(), W_OK) == 0;
}

bool same_bytes(const fs::path& a, const fs::path& b) {
  std::ifstream one(a, std::ios::binary), other(b, std::ios::binary);
  std::array<char, 65536> from_one{}, from_other{};
  while (one && other) {
    one.read(from_one.data(), from_one.size());
    other.read(from_other.data(), from_other.size());
    if (one.gcount() != other.gcount() ||
        std::memcmp(from_one.data(), from_other.data(), static_cast<std::size_t>(one.gcount())) != 0)
      return false;
  }
  return one.eof() && other.eof();
}

// Writes the content of a file or folder to the disk (fsync); returns false if that fails.
bool synced(const fs::path& path, int flags) {
  const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool done = ::fsync(descriptor) == 0;
  const int error = errno;
  ::close(descriptor);
  errno = error;
  return done;
}

}  // namespace

void require_store(const fs::path& path) {
  const std::string fault = fault_of(path);
  require(fault.empty(), fmt::format("{}: {}", path.string(), fault));
}

void require_room(const fs::path& path) {
  require_no_companion(path, path.string());
  for (const char* ending : {"-wal", "-shm", "-journal"}) {
    const fs::path companion = beside(path, ending);
    std::error_code ignored;
    require(!fs::exists(fs::symlink_status(companion, ignored)), [&] {
      return fmt::format(
          "{}: the file {}, left by a removed store or another program, would be replaced; move it or name another store",
          path.string(), companion.string());
    });
  }
}

fs::path lock_of(const fs::path& path) { return beside(path, ".lock"); }

std::unique_ptr<const LockFile> lock_store(const fs::path& path, const std::string& command) {
  return std::make_unique<LockFile>(
      lock_of(path), LockedPlace{path.string(), "folder of the store", "another run writes to this store"}, command);
}

std::unique_ptr<const Database> open_to_read(const fs::path& path) {
  require_store(path);
  mark_as_read(path);
  mark_as_database(path);
  const fs::path real = beside(path, "");
  if (writable(path)) return std::make_unique<Database>(real, Access::recover, path.string());
  require(!has_content(beside(path, "-journal")),
          fmt::format("{}: has an unfinished transaction, and its folder is not writable; "
                      "copy it with its -journal to a writable folder",
                      path.string()));
  const bool has_log = has_content(beside(path, "-wal"));
  const std::optional<Header> header = has_log ? std::nullopt : header_of(real);
  const bool still = header && (*header)[version_for_reading] == write_ahead;
  try {
    return std::make_unique<Database>(real, still ? Access::immutable : Access::read_only, path.string());
  } catch (const InvalidInput& error) {
    if (!has_log) throw;
    throw InvalidInput(fmt::format("{}; copy it with its -wal to a writable folder", error.what()));
  }
}

const char* journal_on(long type) {
  constexpr std::array<unsigned long, 12> of_networks{
      0x6969,      // file system type of NFS
      0x517B,      // file system type of SMB
      0xFE534D42,  // file system type of SMB 2
      0xFF534D42,  // file system type of CIFS
      0x0BD00BD0,  // file system type of Lustre
      0x47504653,  // file system type of GPFS
      0x19830326,  // file system type of BeeGFS
      0x00C36400,  // file system type of Ceph
      0x013111A8,  // file system type of IBRIX
      0x01021997,  // file system type of 9P
      0x5346414F,  // file system type of AFS
      0xAAD7AAEA,  // file system type of PanFS
  };
  for (const unsigned long network : of_networks) {
    if ((static_cast<unsigned long>(type) & 0xFFFFFFFF) == network) return "TRUNCATE";
  }
  return "WAL";
}

const char* journal_at(const fs::path& path) {
  struct statfs found {};
  return ::statfs(path.c_str(), &found) == 0 ? journal_on(static_cast<long>(found.f_type)) : "WAL";
}

std::string kept_copy(const fs::path& path) {
  const fs::path real = beside(path, "");
  fs::path copy;
  for (int k = 1;; ++k) {
    copy = real.string() + (k == 1 ? ".damaged" : fmt::format(".damaged-{}", k));
    std::error_code error;
    if (!fs::exists(copy, error)) break;
    if (same_bytes(real, copy)) return fmt::format("it was not changed, and {} is a copy", copy.string());
  }
  std::error_code error;
  fs::copy_file(real, copy, error);
  if (error) return fmt::format("it was not changed; a copy could not be made: {}", error.message());
  for (const char* ending : {"-wal", "-journal"}) {
    std::error_code none;
    if (has_content(real.string() + ending)) fs::copy_file(real.string() + ending, copy.string() + ending, none);
  }
  return fmt::format("it was not changed, and {} is a copy", copy.string());
}

fs::path copied_to_rescue(const Database& database, const fs::path& path, const std::string& said) {
  std::string reasons;
  std::error_code ignored;
  for (const fs::path& folder : {fs::absolute(path).parent_path(), fs::current_path(ignored), fs::temp_directory_path(ignored)}) {
    try {
      fs::path name;
      for (int k = 1; name.empty() || fs::exists(fs::symlink_status(name, ignored)); ++k)
        name = folder / (path.filename().string() + (k == 1 ? ".rescued" : fmt::format(".rescued-{}", k)));
      const UnnamedStore made(name);
      database.copy_to(made.path());
      made.give_name();
      return name;
    } catch (const std::runtime_error& error) {
      reasons += fmt::format("; {}", error.what());
    }
  }
  throw OutputLost(fmt::format("{}, and its content could not be saved to another file{}", said, reasons));
}

UnnamedStore::UnnamedStore(fs::path name) : name_(std::move(name)), path_(fmt::format("{}.{}.new", name_.string(), ::getpid())) {
  std::error_code ignored;
  fs::remove(path_, ignored);
}

UnnamedStore::~UnnamedStore() {
  std::error_code ignored;
  fs::remove(path_, ignored);
}

void UnnamedStore::give_name() const {
  const auto failed = [&](const char* what) {
    return OutputLost(fmt::format("{}: cannot {}: {}", name_.string(), what, std::generic_category().message(errno)));
  };
  const auto taken = [&] { return InvalidInput(fmt::format("{}: exists already; it is not replaced", name_.string())); };
  if (!synced(path_, O_RDONLY)) throw failed("be written");
  int code = ::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, name_.c_str(), RENAME_NOREPLACE);
  // Rename with a check if the file system cannot refuse to replace a file; the lock file keeps other runs away from the name.
  if (code != 0 && (errno == EINVAL || errno == ENOSYS)) {
    std::error_code ignored;
    if (fs::exists(fs::symlink_status(name_, ignored))) throw taken();
    code = ::rename(path_.c_str(), name_.c_str());
  }
  if (code != 0 && errno == EEXIST) throw taken();
  if (code != 0) throw failed("be renamed");
  // Write the folder entry to the disk. A failure is ignored: not every file system supports this, and the file already has its
  // final name.
  static_cast<void>(synced(fs::absolute(name_).parent_path(), O_RDONLY | O_DIRECTORY));
}

}  // namespace internal

bool is_store(const std::filesystem::path& path) { return internal::fault_of(path).empty(); }

std::optional<std::string> writer_of(const std::filesystem::path& path) { return holder_of(internal::lock_of(path)); }

}  // namespace softland
