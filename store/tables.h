// The tables of a database file of a study, and their content. A plan is the request of a study, a shard the part of its points
// that the file holds.
//
//   study    one row per plan: text, digest of the text, points, seed, shard, checksum of these and of the columns
//   columns  one row per column of results: name, unit and kind
//   session  one row per run: program, processor, command, host, process, times, rows written
//   results  (plan, point) -> content, status, reason, extra, checksum of the row, and the columns
//   tally    (plan, status) -> number of rows
//
// Stores of schema 1 have no checksums; they are read and continued without checksums.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "store/database.h"
#include "store/study_store.h"

namespace softland::internal {

/// Columns of the table `results` besides the variables and figures of the study.
inline constexpr std::array<const char*, 7> fixed_columns{"plan", "point", "content", "status", "reason", "extra", "checksum"};

/// Throws InvalidInput unless a database file can hold the study with this plan, for example when it has too many columns.
void check_plan(const StoredPlan& plan);

/// Creates the tables of a study whose results have these columns.
void create_tables(const Database& database, const std::vector<StoredColumn>& columns);

/// Throws InvalidInput for tables of a later version, and DamagedStore if tables are missing.
void check_schema(const Database& database);

/// A plan (request of a study) and its number in the database file.
struct NumberedPlan {
  std::int64_t number = 0;
  StoredPlan plan;
};
/// Returns the plan (request) with which the last run wrote to the database file.
[[nodiscard]] NumberedPlan current_plan(const Database& database);
/// Returns the number of the plan (request of a study) with this text and of its shard in the database file; 0 if no plan has
/// this text.
[[nodiscard]] std::int64_t number_of_plan(const Database& database, const std::string& text);
[[nodiscard]] std::int64_t insert_plan(const Database& database, const StoredPlan& plan);

/// Inserts a session (a run of the program) that begins now. Returns the number of the session.
std::int64_t insert_session(const Database& database, std::int64_t plan, const StoredOrigin& origin);
/// Inserts a session (a run of the program) that another database file holds.
void insert_session(const Database& database, std::int64_t plan, const StoredSession& session);
/// Counts the rows that a session (a run of the program) has just written.
class SessionTally {
 public:
  SessionTally(const Database& database, std::int64_t plan, std::int64_t session);
  void note(const std::map<std::string, std::int64_t>& rows_by_status);

 private:
  std::int64_t plan_, session_;
  Statement to_session_, to_tally_;
};
[[nodiscard]] std::vector<StoredSession> sessions_in(const Database& database);
[[nodiscard]] std::map<std::string, std::int64_t> tally_of(const Database& database, std::int64_t plan);

/// Returns the SQL text "SELECT ... FROM results" with the columns that row_in() reads.
[[nodiscard]] std::string select_rows(const Database& database, const std::vector<StoredColumn>& columns);
[[nodiscard]] std::array<unsigned char, 16> bytes_of(const ContentKey& key);
/// Returns the current result row of the statement. Throws DamagedStore if the row has changed since it was written.
[[nodiscard]] StoredRow row_in(const Database& database, const Statement& statement, std::size_t values);

/// Reads the rows of a plan (request of a study) in the order of their points.
class RowReader {
 public:
  enum class Of {
    rows,   ///< read the whole content of the rows
    points  ///< read the numbers of the points only, which is ten times faster
  };
  /// `where` is an SQL expression of the columns; empty for all rows.
  RowReader(const Database& database, const NumberedPlan& plan, Of what, const std::string& where = {});
  /// Goes to the next row of a study; returns false after the last row. Throws DamagedStore if a row has changed since it was
  /// written, if points do not increase or do not belong to the plan (request of the study), and at the end if the number of
  /// rows is wrong.
  bool next();
  [[nodiscard]] const StoredRow& row() const { return row_; }

 private:
  [[noreturn]] void fail(const std::string& reason) const;
  void count();
  void compare() const;

  Snapshot snapshot_;
  const Database& database_;
  std::int64_t number_, points_;
  Shard shard_;
  std::size_t values_;
  Of what_;
  bool all_, ended_ = false;
  Statement statement_;
  StoredRow row_;
  std::int64_t last_ = -1, rows_ = 0;
  std::map<std::string, std::int64_t, std::less<>> by_status_;
  std::map<std::string, std::int64_t, std::less<>>::iterator counted_ = by_status_.end();
};

/// Thrown if the database file has a row of the same point as a new row, but with different content.
class Contradiction : public InvalidInput {
 public:
  using InvalidInput::InvalidInput;
};

/// Writes rows of one plan (request of a study) to the database file.
class RowWriter {
 public:
  RowWriter(const Database& database, std::int64_t plan, const std::vector<StoredColumn>& columns);
  /// Writes a row; returns false if the database file already has an equal row. Throws Contradiction if the file has a
  /// different row of the same point.
  bool write(const StoredRow& row);

 private:
  const Database& database_;
  std::int64_t plan_;
  std::vector<StoredColumn> columns_;
  bool has_checksums_;
  Statement insert_, select_;
};

/// Returns a description of the difference between two rows of one point; empty if they are equal.
[[nodiscard]] std::string difference(const StoredRow& a, const StoredRow& b, const std::vector<StoredColumn>& columns);

}  // namespace softland::internal
