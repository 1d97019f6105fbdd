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

/// The file breaks the rules of its format.
class DamagedStore : public InvalidInput {
 public:
  using InvalidInput::InvalidInput;
};

/// A statement that a sound store understands and this one does not, or that fails at one of its rows.
class StatementFailed : public DamagedStore {
 public:
  StatementFailed(const std::string& message, std::string reason) : DamagedStore(message), reason_(std::move(reason)) {}
  /// In the words of SQLite.
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  std::string reason_;
};

/// How a database is opened.
enum class Access {
  write,      ///< what is there, to change it
  create,     ///< the same, made where it is missing
  recover,    ///< to read, from a place that may be written to: what a process that died has left unfinished is put in order
  read_only,  ///< from a place that may not
  immutable   ///< from one that nobody writes to and that has no log: nothing is locked
};

/// Device and inode: what a file is under any name. None where there is no file.
using FileNumber = std::pair<unsigned long long, unsigned long long>;
[[nodiscard]] std::optional<FileNumber> number_of(const std::filesystem::path& file);

/// Remembers that this process has the file open. SQLite's locks are those of the process and vanish when it closes any other
/// descriptor of the file, so that nobody looks into one that is open.
class OpenFile {
 public:
  explicit OpenFile(const std::filesystem::path& file);
  ~OpenFile();
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  /// Whether one of these remembers it.
  [[nodiscard]] static bool is_open(const std::filesystem::path& file);
  /// Whether this is the file.
  [[nodiscard]] bool is(const std::filesystem::path& file) const { return number_ && number_ == number_of(file); }

 private:
  std::optional<FileNumber> number_;
};

class Statement;

class Database {
 public:
  /// Throws as every function here: OutputLost where what is written does not reach the disk, DamagedStore, Interrupted, or
  /// InvalidInput; `shown` names the file in messages.
  Database(const std::filesystem::path& file, Access access, std::string shown);

  /// Runs statements that return nothing of interest.
  void run(const std::string& sql) const;
  [[nodiscard]] Statement prepare(const std::string& sql) const;
  /// The first column of the first row.
  [[nodiscard]] std::string text_of(const std::string& sql) const;
  [[nodiscard]] std::int64_t number_of(const std::string& sql) const;
  /// Throws what a result code means.
  [[noreturn]] void fail(int code) const;

  /// Whether the file at this path is the open one: somebody may have removed, moved or replaced it.
  [[nodiscard]] bool is_at(const std::filesystem::path& path) const;
  /// Leaves the log where it is when this is closed: what has its name then belongs to another file.
  void leave_log() const;
  /// Writes all that it holds into a file of its own, which may not hold anything yet.
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

/// Parameters are numbered from 1, columns from 0, as SQLite does. The database has to outlive it.
class Statement {
 public:
  Statement(const Database& database, const std::string& sql);

  Statement& bind(int parameter, std::int64_t value);
  Statement& bind(int parameter, double value);  ///< NaN: NULL
  Statement& bind(int parameter, std::string_view value);
  Statement& bind(int parameter, std::span<const unsigned char> value);
  /// Without a copy: what is lent has to live until the statement has been run.
  Statement& lend(int parameter, std::string_view value);
  Statement& lend(int parameter, std::span<const unsigned char> value);
  /// Whether there is a row; where there is none the statement can be bound and run again.
  bool step();
  void reset();

  [[nodiscard]] std::int64_t integer(int column) const { return sqlite3_column_int64(handle_.get(), column); }
  [[nodiscard]] bool is_null(int column) const { return sqlite3_column_type(handle_.get(), column) == SQLITE_NULL; }
  [[nodiscard]] double number(int column) const;  ///< NULL: NaN
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

/// All or nothing: what was not committed is rolled back.
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

/// While it lives everything that is read is of one moment, whoever writes.
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
