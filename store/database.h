// Wraps SQLite: connections, statements, transactions, and SQLite's error codes as exceptions of softland.
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

#include "base/progress.h"
#include "base/require.h"

namespace softland::internal {

/// Thrown when the database file breaks the rules of its format.
class DamagedStore : public InvalidInput {
 public:
  using InvalidInput::InvalidInput;
};

/// Thrown when a statement fails that succeeds on any undamaged database.
class StatementFailed : public DamagedStore {
 public:
  StatementFailed(const std::string& message, std::string reason) : DamagedStore(message), reason_(std::move(reason)) {}
  /// Returns SQLite's message about why the statement failed.
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  std::string reason_;
};

/// The mode in which a database is opened.
enum class Access {
  write,      ///< change an existing database
  create,     ///< change a database, and create a missing one
  recover,    ///< read, in a writable folder: an unfinished transaction of a process that died is rolled back
  read_only,  ///< read, in a folder that is not writable
  immutable   ///< read a file that no process writes to, without a log and without locks
};

/// Device and inode number, which identify a file under any name; absent where the file does not exist.
using FileNumber = std::pair<unsigned long long, unsigned long long>;
[[nodiscard]] std::optional<FileNumber> number_of(const std::filesystem::path& file);

/// Records that this process has a database file open. The locks of SQLite belong to the process and are lost when the process
/// closes any other descriptor of the file. An open file must therefore not be opened again to look at its content.
class OpenFile {
 public:
  explicit OpenFile(const std::filesystem::path& file);
  ~OpenFile();
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  [[nodiscard]] static bool is_open(const std::filesystem::path& file);
  /// Returns true if the path leads to the recorded file.
  [[nodiscard]] bool is(const std::filesystem::path& file) const { return number_ && number_ == number_of(file); }

 private:
  std::optional<FileNumber> number_;
};

class Statement;

class Database {
 public:
  /// Opens the database file; `shown` is its name in messages. All functions of the class throw OutputLost if data cannot be
  /// written to the disk, DamagedStore, Interrupted, or InvalidInput.
  Database(const std::filesystem::path& file, Access access, std::string shown);

  /// Runs SQL statements and ignores their results.
  void run(const std::string& sql) const;
  [[nodiscard]] Statement prepare(const std::string& sql) const;
  /// Returns the first column of the first row of an SQL query, as text.
  [[nodiscard]] std::string text_of(const std::string& sql) const;
  [[nodiscard]] std::int64_t number_of(const std::string& sql) const;
  /// Throws the exception of softland for a result code of SQLite.
  [[noreturn]] void fail(int code) const;

  /// Returns true if the path still leads to the open database file, which was not removed, moved or replaced.
  [[nodiscard]] bool is_at(const std::filesystem::path& path) const;
  /// Makes SQLite leave a write-ahead log at the path when it closes the database: the log belongs to another database by now.
  void leave_log() const;
  /// Writes the whole content of the database into a new file, which must be empty or missing.
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

/// A prepared SQL statement; the database must outlive it. SQLite numbers parameters from 1, columns from 0.
class Statement {
 public:
  Statement(const Database& database, const std::string& sql);

  Statement& bind(int parameter, std::int64_t value);
  Statement& bind(int parameter, double value);  ///< binds a number to a parameter of the statement; NaN becomes NULL
  Statement& bind(int parameter, std::string_view value);
  Statement& bind(int parameter, std::span<const unsigned char> value);
  /// Binds a text to a parameter of the statement without a copy; the text must live until the statement has been run.
  Statement& lend(int parameter, std::string_view value);
  Statement& lend(int parameter, std::span<const unsigned char> value);
  /// Goes to the next row of the result; returns false after the last row. The statement can then be bound and run again.
  bool step();
  void reset();

  [[nodiscard]] std::int64_t integer(int column) const { return sqlite3_column_int64(handle_.get(), column); }
  [[nodiscard]] bool is_null(int column) const { return sqlite3_column_type(handle_.get(), column) == SQLITE_NULL; }
  [[nodiscard]] double number(int column) const;  ///< returns a number of the current row; NULL becomes NaN
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

/// During its lifetime, statements throw Interrupted when `progress` requests a stop.
class InterruptibleQuery {
 public:
  InterruptibleQuery(const Database& database, const Progress& progress);
  InterruptibleQuery(const InterruptibleQuery&) = delete;
  InterruptibleQuery& operator=(const InterruptibleQuery&) = delete;
  ~InterruptibleQuery() { sqlite3_progress_handler(database_.handle(), 0, nullptr, nullptr); }

 private:
  const Database& database_;
  const Progress& progress_;
};

/// An SQL transaction. The destructor rolls back changes that were not committed.
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

/// During its lifetime, all reads see one state of the database, even if another process writes.
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
