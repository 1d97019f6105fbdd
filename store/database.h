// SQLite behind values: connections, statements, and its error codes as the exceptions of this program.
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "base/require.h"
#include "base/watch.h"

namespace softland::internal {

/// Thrown when the file breaks the rules of its format.
class DamagedStore : public InvalidInput {
 public:
  using InvalidInput::InvalidInput;
};

/// Thrown for a statement that a sound store accepts and this one does not, or that fails at one of its rows.
class StatementFailed : public DamagedStore {
 public:
  StatementFailed(const std::string& message, std::string reason) : DamagedStore(message), reason_(std::move(reason)) {}
  /// Returns the reason in the words of SQLite.
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  std::string reason_;
};

/// The mode in which a database is opened.
enum class Access {
  write,      ///< change an existing database
  create,     ///< the same, and create a missing one
  recover,    ///< read, from a writable place: the unfinished work of a process that died is put in order
  read_only,  ///< read, from a place that is not writable
  immutable   ///< read, from a place that nobody writes to, without a log: nothing is locked
};

/// Device and inode, which identify a file under any name; none where the file does not exist.
using FileNumber = std::pair<unsigned long long, unsigned long long>;
[[nodiscard]] std::optional<FileNumber> number_of(const std::filesystem::path& file);

/// Remembers that this process has the file open. SQLite's locks belong to the process and vanish when it closes any other
/// descriptor of the file, so nobody may look into a file that is open.
class OpenFile {
 public:
  explicit OpenFile(const std::filesystem::path& file);
  ~OpenFile();
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  /// True when an OpenFile remembers this file.
  [[nodiscard]] static bool is_open(const std::filesystem::path& file);
  /// True when this is the file at the path.
  [[nodiscard]] bool is(const std::filesystem::path& file) const { return number_ && number_ == number_of(file); }

 private:
  std::optional<FileNumber> number_;
};

class Statement;

class Database {
 public:
  /// Throws as every function here: OutputLost where data does not reach the disk, DamagedStore, Interrupted, or InvalidInput;
  /// `shown` names the file in messages.
  Database(const std::filesystem::path& file, Access access, std::string shown);

  /// Runs statements that return nothing of interest.
  void run(const std::string& sql) const;
  [[nodiscard]] Statement prepare(const std::string& sql) const;
  /// Returns the first column of the first row.
  [[nodiscard]] std::string text_of(const std::string& sql) const;
  [[nodiscard]] std::int64_t number_of(const std::string& sql) const;
  /// Throws the exception that belongs to a result code.
  [[noreturn]] void fail(int code) const;

  /// True when the file at this path is the open one: somebody may have removed, moved or replaced it.
  [[nodiscard]] bool is_at(const std::filesystem::path& path) const;
  /// Leaves the log where it is when the database is closed: the file of that name then belongs to another database.
  void leave_log() const;
  /// Writes the whole content into a new file, which must be empty or missing.
  void copy_to(const std::filesystem::path& file) const;

  [[nodiscard]] sqlite3* handle() const { return handle_.get(); }
  [[nodiscard]] const std::string& shown() const { return shown_; }

 private:
  struct Close {
    void operator()(sqlite3* handle) const { sqlite3_close_v2(handle); }
  };
  std::string shown_;
  bool writes_;
  std::optional<OpenFile> open_;
  std::unique_ptr<sqlite3, Close> handle_;
};

/// A prepared statement. Parameters are numbered from 1, columns from 0, as SQLite does. The database must outlive it.
class Statement {
 public:
  Statement(const Database& database, const std::string& sql);

  Statement& bind(int parameter, std::int64_t value);
  Statement& bind(int parameter, double value);  ///< NaN becomes NULL
  Statement& bind(int parameter, std::string_view value);
  Statement& bind(int parameter, std::span<const unsigned char> value);
  /// Binds without a copy: the value must live until the statement has been run.
  Statement& lend(int parameter, std::string_view value);
  Statement& lend(int parameter, std::span<const unsigned char> value);
  /// Returns true when there is a row; after false the statement can be bound and run again.
  bool step();
  void reset();

  [[nodiscard]] std::int64_t integer(int column) const { return sqlite3_column_int64(handle_.get(), column); }
  [[nodiscard]] bool is_null(int column) const { return sqlite3_column_type(handle_.get(), column) == SQLITE_NULL; }
  [[nodiscard]] double number(int column) const;  ///< NULL becomes NaN
  [[nodiscard]] std::string text(int column) const;
  [[nodiscard]] std::span<const unsigned char> blob(int column) const;
  [[nodiscard]] sqlite3_stmt* handle() const { return handle_.get(); }

 private:
  void check(int code) const {
    if (code != SQLITE_OK) database_->fail(code);
  }
  struct Finalize {
    void operator()(sqlite3_stmt* handle) const { sqlite3_finalize(handle); }
  };
  const Database* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> handle_;
};

/// While it lives statements end with Interrupted when the watch is asked to stop.
class StopWatched {
 public:
  StopWatched(const Database& database, const Watch& watch);
  StopWatched(const StopWatched&) = delete;
  StopWatched& operator=(const StopWatched&) = delete;
  ~StopWatched() { sqlite3_progress_handler(database_.handle(), 0, nullptr, nullptr); }

 private:
  const Database& database_;
  const Watch& watch_;
};

/// A transaction: changes that were not committed are rolled back.
class Transaction {
 public:
  explicit Transaction(const Database& database) : database_(database) { database_.run("BEGIN IMMEDIATE"); }
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  ~Transaction() {
    if (sqlite3_get_autocommit(database_.handle()) == 0) sqlite3_exec(database_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
  }
  void commit() { database_.run("COMMIT"); }

 private:
  const Database& database_;
};

/// While it lives all reads see the same moment, whoever writes.
class Snapshot {
 public:
  explicit Snapshot(const Database& database) : database_(database), begun_(sqlite3_get_autocommit(database.handle()) != 0) {
    if (begun_) database_.run("BEGIN");
  }
  Snapshot(const Snapshot&) = delete;
  Snapshot& operator=(const Snapshot&) = delete;
  ~Snapshot() {
    if (begun_) sqlite3_exec(database_.handle(), "COMMIT", nullptr, nullptr, nullptr);
  }

 private:
  const Database& database_;
  bool begun_;
};

}  // namespace softland::internal
