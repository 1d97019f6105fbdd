#include "store/database.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <new>
#include <system_error>

#include "base/output_lost.h"

namespace softland::internal {
namespace {

constexpr int patience = 10'000;  // time to wait for another program that has locked the file [ms]

std::mutex open_mutex;
std::map<FileNumber, int>& open_files() {
  static std::map<FileNumber, int> files;
  return files;
}

// Returns the path of the database file as a URI; only a URI can mark the file as immutable.
std::string uri_of(const std::filesystem::path& file) {
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(file).string()) {
    const bool plain = c != '%' && c != '?' && c != '#';
    uri += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return uri + "?immutable=1";
}

std::string reason_of(sqlite3* handle, int code) {
  if (handle == nullptr) return sqlite3_errstr(code);
  const int error = sqlite3_system_errno(handle);
  const bool of_system = (code & 0xFF) == SQLITE_IOERR || (code & 0xFF) == SQLITE_CANTOPEN;
  return of_system && error != 0 ? fmt::format("{} ({})", sqlite3_errmsg(handle), std::generic_category().message(error))
                                 : sqlite3_errmsg(handle);
}

}  // namespace

std::optional<FileNumber> number_of(const std::filesystem::path& file) {
  struct stat found {};
  if (::stat(file.c_str(), &found) != 0) return std::nullopt;
  return FileNumber{found.st_dev, found.st_ino};
}

OpenFile::OpenFile(const std::filesystem::path& file) : number_(number_of(file)) {
  const std::lock_guard lock(open_mutex);
  if (number_) ++open_files()[*number_];
}

OpenFile::~OpenFile() {
  const std::lock_guard lock(open_mutex);
  if (number_ && --open_files()[*number_] == 0) open_files().erase(*number_);
}

bool OpenFile::is_open(const std::filesystem::path& file) {
  const std::optional<FileNumber> number = number_of(file);
  const std::lock_guard lock(open_mutex);
  return number && open_files().contains(*number);
}

Database::Database(const std::filesystem::path& file, Access access, std::string shown)
    : shown_(std::move(shown)), writes_(access == Access::write || access == Access::create) {
  const bool reads = access == Access::read_only || access == Access::immutable;
  int flags = reads ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE;
  if (access == Access::create) flags |= SQLITE_OPEN_CREATE;
  if (access == Access::immutable) flags |= SQLITE_OPEN_URI;
  sqlite3* handle = nullptr;
  // The path is made absolute, because SQLite does not read "file:..." or ":memory:" as the name of a file.
  const std::string name = access == Access::immutable ? uri_of(file) : std::filesystem::absolute(file).string();
  const int code = sqlite3_open_v2(name.c_str(), &handle, flags, nullptr);
  handle_.reset(handle);
  if (code != SQLITE_OK) fail(handle != nullptr ? sqlite3_extended_errcode(handle) : code);
  open_.emplace(file);
  sqlite3_extended_result_codes(handle, 1);
  sqlite3_busy_timeout(handle, patience);
  // SQLite options: text in double quotes must be a column, never a string, and the schema of a damaged file must not run
  // functions.
  sqlite3_db_config(handle, SQLITE_DBCONFIG_DQS_DML, 0, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_DQS_DDL, 0, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  if (access == Access::recover) run("PRAGMA query_only = 1");
}

void Database::fail(int code) const {
  const std::string reason = reason_of(handle_.get(), code);
  if (code == SQLITE_READONLY_DBMOVED)
    throw OutputLost(fmt::format("{}: was removed, moved or replaced while it was written", shown_));
  switch (code & 0xFF) {
    case SQLITE_NOMEM:
      throw std::bad_alloc();
    case SQLITE_INTERRUPT:
      throw Interrupted();
    case SQLITE_FULL:
    case SQLITE_IOERR:
      if (!writes_) throw InvalidInput(fmt::format("{}: cannot be read: {}", shown_, reason));
      throw OutputLost(fmt::format("{}: {}", shown_, reason));
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
    case SQLITE_FORMAT:
      throw DamagedStore(fmt::format("{}: the store is damaged: {}", shown_, reason));
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
    case SQLITE_PROTOCOL:
      throw InvalidInput(fmt::format("{}: another program has locked the file: {}; try again when it has ended", shown_, reason));
    case SQLITE_PERM:
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
    case SQLITE_AUTH:
    case SQLITE_TOOBIG:
      throw InvalidInput(fmt::format("{}: {}", shown_, reason));
    case SQLITE_ERROR:
    case SQLITE_CONSTRAINT:
    case SQLITE_MISMATCH:
    case SQLITE_SCHEMA:
      throw StatementFailed(fmt::format("{}: the store is damaged: {}", shown_, reason), reason);
    default:
      throw std::runtime_error(fmt::format("{}: SQLite: {} ({})", shown_, reason, code));
  }
}

bool Database::is_at(const std::filesystem::path& path) const {
  // The device and inode of the file are read after it was opened; SQLite reports if the file was moved in between.
  int moved = 0;
  const int code = sqlite3_file_control(handle_.get(), "main", SQLITE_FCNTL_HAS_MOVED, &moved);
  return open_->is(path) && (code != SQLITE_OK || moved == 0);
}

void Database::leave_log() const { sqlite3_db_config(handle_.get(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr); }

void Database::copy_to(const std::filesystem::path& file) const {
  const Database copy(file, Access::create, file.string());
  sqlite3_backup* backup = sqlite3_backup_init(copy.handle(), "main", handle_.get(), "main");
  if (backup == nullptr) copy.fail(sqlite3_extended_errcode(copy.handle()));
  const int step = sqlite3_backup_step(backup, -1), finish = sqlite3_backup_finish(backup);
  if (finish != SQLITE_OK) copy.fail(finish);
  if (step != SQLITE_DONE) copy.fail(step);
}

void Database::run(const std::string& sql) const {
  const int code = sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(code);
}

Statement Database::prepare(const std::string& sql) const { return {*this, sql}; }

std::string Database::text_of(const std::string& sql) const {
  Statement statement = prepare(sql);
  return statement.step() ? statement.text(0) : std::string();
}

std::int64_t Database::number_of(const std::string& sql) const {
  Statement statement = prepare(sql);
  return statement.step() ? statement.integer(0) : 0;
}

Statement::Statement(const Database& database, const std::string& sql) : database_(&database) {
  sqlite3_stmt* handle = nullptr;
  const int code = sqlite3_prepare_v2(database.handle(), sql.c_str(), static_cast<int>(sql.size()), &handle, nullptr);
  handle_.reset(handle);
  check(code);
}

Statement& Statement::bind(int parameter, std::int64_t value) {
  check(sqlite3_bind_int64(handle_.get(), parameter, value));
  return *this;
}

Statement& Statement::bind(int parameter, double value) {
  check(std::isnan(value) ? sqlite3_bind_null(handle_.get(), parameter) : sqlite3_bind_double(handle_.get(), parameter, value));
  return *this;
}

Statement& Statement::bind(int parameter, std::string_view value) {
  check(sqlite3_bind_text64(handle_.get(), parameter, value.empty() ? "" : value.data(), value.size(), SQLITE_TRANSIENT,
                            SQLITE_UTF8));
  return *this;
}

Statement& Statement::bind(int parameter, std::span<const unsigned char> value) {
  check(sqlite3_bind_blob64(handle_.get(), parameter, value.data(), value.size(), SQLITE_TRANSIENT));
  return *this;
}

Statement& Statement::lend(int parameter, std::string_view value) {
  check(
      sqlite3_bind_text64(handle_.get(), parameter, value.empty() ? "" : value.data(), value.size(), SQLITE_STATIC, SQLITE_UTF8));
  return *this;
}

Statement& Statement::lend(int parameter, std::span<const unsigned char> value) {
  check(sqlite3_bind_blob64(handle_.get(), parameter, value.data(), value.size(), SQLITE_STATIC));
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(handle_.get());
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) {
    // Reset the statement only after fail() has read SQLite's message about the failed step: a reset changes this message.
    struct Reset {
      Statement* statement;
      ~Reset() { statement->reset(); }
    } reset{this};
    database_->fail(code);
  }
  reset();
  return false;
}

void Statement::reset() { sqlite3_reset(handle_.get()); }

double Statement::number(int column) const {
  return is_null(column) ? std::numeric_limits<double>::quiet_NaN() : sqlite3_column_double(handle_.get(), column);
}

std::string Statement::text(int column) const {
  const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(handle_.get(), column));
  return bytes == nullptr ? std::string()
                          : std::string(bytes, static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column)));
}

std::span<const unsigned char> Statement::blob(int column) const {
  const auto* bytes = static_cast<const unsigned char*>(sqlite3_column_blob(handle_.get(), column));
  return {bytes, static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column))};
}

InterruptibleQuery::InterruptibleQuery(const Database& database, const Progress& progress)
    : database_(database), progress_(progress) {
  constexpr int operations = 10'000;  // SQLite instructions between two checks for an interruption, less than 1 ms
  const auto stopped = [](void* self) { return static_cast<const InterruptibleQuery*>(self)->progress_.stopped() ? 1 : 0; };
  sqlite3_progress_handler(database.handle(), operations, stopped, this);
}

}  // namespace softland::internal
