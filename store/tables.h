// The tables of a store, and what stands in them.
//
//   study    one row per plan: its text, digest of that, points, seed, shard, checksum of these and of columns
//   columns  of results, with name, unit and kind
//   session  one row per run: program, processor, command, host, process, times, rows written
//   results  (plan, point) -> content, status, reason, extra, checksum of all that stands in the row, and the columns
//   tally    (plan, status) -> rows
//
// Stores of schema 1 have no checksums; they are read, and gone on with, as they are.
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

/// Columns of results besides those of the plan.
inline constexpr std::array<const char*, 7> fixed_columns{"plan", "point", "content", "status", "reason", "extra", "checksum"};

/// Throws InvalidInput unless a store can hold such a plan.
void check_plan(const StoredPlan& plan);

/// Makes the tables for rows of these columns.
void create_tables(const Database& database, const std::vector<StoredColumn>& columns);

/// Throws InvalidInput where the tables are of a later schema, DamagedStore where they are not all there.
void check_schema(const Database& database);

/// A plan as the store holds it.
struct NumberedPlan {
  std::int64_t number = 0;
  StoredPlan plan;
};
/// That of the last session.
[[nodiscard]] NumberedPlan current_plan(const Database& database);
/// The number of a plan with this text, and the shard it has; none: 0.
[[nodiscard]] std::int64_t number_of_plan(const Database& database, const std::string& text);
[[nodiscard]] std::int64_t insert_plan(const Database& database, const StoredPlan& plan);

/// A session that begins now. Returns its number.
std::int64_t insert_session(const Database& database, std::int64_t plan, const StoredOrigin& origin);
/// The same for one that another store holds.
void insert_session(const Database& database, std::int64_t plan, const StoredSession& session);
/// Notes rows that were written in it just now.
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

/// "SELECT ... FROM results" of the columns that row_in() reads.
[[nodiscard]] std::string select_rows(const Database& database, const std::vector<StoredColumn>& columns);
[[nodiscard]] std::array<unsigned char, 16> bytes_of(const ContentKey& key);
/// Throws DamagedStore where the row is not what was written.
[[nodiscard]] StoredRow row_in(const Database& database, const Statement& statement, std::size_t values);

/// The rows of a plan in the order of their points.
class RowReader {
 public:
  enum class Of {
    rows,   ///< all that stands in them
    points  ///< their numbers only, which is ten times as quick
  };
  /// `where`: an expression over the columns; empty: all rows.
  RowReader(const Database& database, const NumberedPlan& plan, Of what, const std::string& where = {});
  /// Goes to the next row; false: that was the last one. Throws DamagedStore where a row is not what was written, where points
  /// do not rise or are none of the plan's, and at the end where there are more or fewer rows than were counted.
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

/// A row that is there already with other bits.
class Contradiction : public InvalidInput {
 public:
  using InvalidInput::InvalidInput;
};

/// Writes rows of one plan.
class RowWriter {
 public:
  RowWriter(const Database& database, std::int64_t plan, const std::vector<StoredColumn>& columns);
  /// Whether the row was new. One that is there with the same bits stays. Throws Contradiction where it has others.
  bool write(const StoredRow& row);

 private:
  const Database& database_;
  std::int64_t plan_;
  std::vector<StoredColumn> columns_;
  bool has_checksums_;
  Statement insert_, select_;
};

/// What makes two rows of one point different, in words; empty: they hold the same bits.
[[nodiscard]] std::string difference(const StoredRow& a, const StoredRow& b, const std::vector<StoredColumn>& columns);

}  // namespace softland::internal
