#include "store/tables.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <set>
#include <utility>

#include "base/lock_file.h"
#include "base/require.h"
#include "base/shortened.h"
#include "store/place.h"

namespace softland::internal {
namespace {

constexpr std::size_t most_columns = 1900;  // SQLite accepts 2000 columns per table
// SQL for the current time. SQLite has no date after the year 9999, but the clock of a machine may be later.
constexpr const char* now = "ifnull(strftime('%Y-%m-%d %H:%M:%f', 'now'), 'after the year 9999')";
constexpr int first_with_checksums = 2;  // first version of the tables that has checksums

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

std::string_view word_of(ColumnKind kind) { return kind == ColumnKind::variable ? "variable" : "figure"; }

ContentKey key_of(std::span<const unsigned char> bytes) {
  ContentKey key;
  if (bytes.size() != 16) return key;
  for (std::size_t i = 0; i < 8; ++i) {
    key.high = key.high << 8 | bytes[i];
    key.low = key.low << 8 | bytes[8 + i];
  }
  return key;
}

// Returns a name quoted for SQL.
std::string sql_name(std::string_view name) {
  std::string text = "\"";
  for (const char c : name) text += c == '"' ? "\"\"" : std::string(1, c);
  return text + "\"";
}

// Returns a number as the database returns it after storing: -0 becomes 0.
double kept(double value) { return value + 0.0; }

bool has_checksums(const Database& database) { return database.number_of("PRAGMA user_version") >= first_with_checksums; }

// A checksum, with 32 bits, of numbers and texts, equal on all machines. A change of one word always changes the sum before it
// is cut to 32 bits, and the boundary between two texts counts. The checksum is faster than a hash of the text of a row: 300
// 000 rows are written per second.
class Checksum {
 public:
  void add(std::uint64_t word) { state_ = (std::rotl(state_, 27) ^ word) * 0x9E3779B97F4A7C15; }
  void add(std::int64_t number) { add(static_cast<std::uint64_t>(number)); }
  void add(double number) { add(std::isnan(number) ? ~std::uint64_t{0} : std::bit_cast<std::uint64_t>(kept(number))); }
  void add(std::string_view text) {
    add(std::uint64_t{text.size()});
    for (; !text.empty(); text.remove_prefix(std::min<std::size_t>(8, text.size()))) add(word_at(text));
  }
  [[nodiscard]] std::int64_t value() const {
    const std::uint64_t mixed = (state_ ^ state_ >> 29) * 0xBF58476D1CE4E5B9;
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(mixed >> 32));
  }

 private:
  static std::uint64_t word_at(std::string_view text) {
    std::uint64_t word = 0;
    if constexpr (std::endian::native == std::endian::little) {
      if (text.size() >= sizeof word) {
        std::memcpy(&word, text.data(), sizeof word);
        return word;
      }
    }
    for (std::size_t i = 0; i < std::min(text.size(), sizeof word); ++i)
      word |= std::uint64_t{static_cast<unsigned char>(text[i])} << (8 * i);
    return word;
  }

  std::uint64_t state_ = 0x94D049BB133111EB;
};

std::int64_t checksum_of(const StoredRow& row) {
  Checksum sum;
  sum.add(row.point);
  sum.add(row.content.high);
  sum.add(row.content.low);
  sum.add(std::string_view(row.status));
  sum.add(std::string_view(row.reason));
  sum.add(std::string_view(row.extra));
  for (const double value : row.values) sum.add(value);
  return sum.value();
}

std::int64_t checksum_of(const StoredPlan& plan) {
  Checksum sum;
  sum.add(std::string_view(plan.text));
  sum.add(plan.points);
  sum.add(plan.seed);
  sum.add(std::int64_t{plan.shard.index});
  sum.add(std::int64_t{plan.shard.count});
  for (const StoredColumn& column : plan.columns) {
    for (const std::string* text : {&column.key, &column.name, &column.unit}) sum.add(std::string_view(*text));
    sum.add(word_of(column.kind));
  }
  return sum.value();
}

bool same_number(double a, double b) { return std::isnan(a) ? std::isnan(b) : kept(a) == kept(b); }

}  // namespace

std::array<unsigned char, 16> bytes_of(const ContentKey& key) {
  std::array<unsigned char, 16> bytes{};
  for (std::size_t i = 0; i < 8; ++i) {
    bytes[i] = static_cast<unsigned char>(key.high >> (56 - 8 * i));
    bytes[8 + i] = static_cast<unsigned char>(key.low >> (56 - 8 * i));
  }
  return bytes;
}

void check_plan(const StoredPlan& plan) {
  require(plan.points >= 1, fmt::format("a study must have at least one point, but has {}", plan.points));
  require(plan.columns.size() <= most_columns,
          fmt::format("a store must have at most {} columns, but the plan has {}", most_columns, plan.columns.size()));
  std::set<std::string> keys(fixed_columns.begin(), fixed_columns.end());
  for (const StoredColumn& column : plan.columns) {
    const bool word =
        !column.key.empty() && column_key(column.key, "") == column.key && (column.key[0] < '0' || column.key[0] > '9');
    require(word, fmt::format("the column \"{}\" must be a word of letters, digits and underscores", shortened(column.key)));
    require(
        keys.insert(lower(column.key)).second,
        fmt::format("two columns of the study are called {}; names must differ by more than upper and lower case", column.key));
  }
}

void create_tables(const Database& database, const std::vector<StoredColumn>& columns) {
  Transaction transaction(database);
  database.run(fmt::format("PRAGMA application_id = {}", store_application));
  database.run(fmt::format("PRAGMA user_version = {}", store_schema));
  database.run(
      "CREATE TABLE study(plan INTEGER PRIMARY KEY, text TEXT NOT NULL, digest TEXT NOT NULL, points INTEGER NOT NULL, "
      "seed TEXT NOT NULL, shard INTEGER NOT NULL, shards INTEGER NOT NULL, "
      "checksum INTEGER NOT NULL);CREATE TABLE columns(position INTEGER PRIMARY KEY, key TEXT NOT NULL, name TEXT NOT NULL, "
      "unit TEXT NOT NULL, kind TEXT NOT NULL);CREATE TABLE session(session INTEGER PRIMARY KEY, plan INTEGER NOT NULL, "
      "program TEXT NOT NULL, processor TEXT NOT NULL, command TEXT NOT NULL, host TEXT NOT NULL, process INTEGER NOT NULL, "
      "began TEXT NOT NULL, last TEXT NOT NULL, rows INTEGER NOT NULL);CREATE TABLE tally(plan INTEGER NOT NULL, "
      "status TEXT NOT NULL, rows INTEGER NOT NULL, PRIMARY KEY(plan, status)) WITHOUT ROWID");
  std::string sql =
      "CREATE TABLE results(plan INTEGER NOT NULL, point INTEGER NOT NULL, content BLOB NOT NULL, status TEXT NOT NULL, "
      "reason TEXT NOT NULL, extra TEXT NOT NULL, checksum INTEGER NOT NULL";
  for (const StoredColumn& column : columns) sql += ", " + sql_name(column.key) + " REAL";
  database.run(sql + ", PRIMARY KEY(plan, point)) WITHOUT ROWID");
  Statement insert = database.prepare("INSERT INTO columns(key, name, unit, kind) VALUES(?, ?, ?, ?)");
  for (const StoredColumn& column : columns)
    insert.bind(1, column.key).bind(2, column.name).bind(3, column.unit).bind(4, word_of(column.kind)).step();
  transaction.commit();
}

void check_schema(const Database& database) {
  const std::int64_t schema = database.number_of("PRAGMA user_version");
  require(schema <= store_schema,
          fmt::format("{}: was written by a later version of softland (store schema {}; this version reads up to {})",
                      database.shown(), schema, store_schema));
  const std::int64_t tables = database.number_of(
      "SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name IN ('study', 'columns', 'session', 'results', 'tally')");
  if (tables != 5 || schema < 1 || database.number_of("SELECT count(*) FROM session JOIN study USING(plan)") < 1)
    throw DamagedStore(fmt::format("{}: the store is damaged: tables are missing", database.shown()));
}

namespace {

std::vector<StoredColumn> columns_in(const Database& database) {
  std::vector<StoredColumn> found;
  Statement columns = database.prepare("SELECT key, name, unit, kind FROM columns ORDER BY position");
  while (columns.step()) {
    const ColumnKind kind = columns.text(3) == word_of(ColumnKind::variable) ? ColumnKind::variable : ColumnKind::figure;
    found.push_back({.key = columns.text(0), .name = columns.text(1), .unit = columns.text(2), .kind = kind});
  }
  return found;
}

// Throws DamagedStore for an impossible number of points of the study, or an impossible part `index` of `count` of the study:
// other numbers are computed from them.
void require_sound(const Database& database, std::int64_t points, std::int64_t index, std::int64_t count) {
  constexpr std::int64_t most_points = std::int64_t{1} << 53;
  const auto damaged = [&](const std::string& what) {
    return DamagedStore(fmt::format("{}: the store is damaged: {}", database.shown(), what));
  };
  if (points < 1 || points > most_points) throw damaged(fmt::format("its plan has {} points", points));
  if (index < 1 || index > count || count > std::numeric_limits<int>::max())
    throw damaged(fmt::format("it holds the part {}/{} of its plan", index, count));
}

}  // namespace

NumberedPlan current_plan(const Database& database) {
  NumberedPlan found;
  const bool checked = has_checksums(database);
  Statement study = database.prepare(fmt::format(
      "SELECT plan, text, points, seed, shard, shards, {} FROM study WHERE plan = (SELECT plan FROM session ORDER BY session "
      "DESC LIMIT 1)",
      checked ? "checksum" : "0"));
  if (!study.step()) throw DamagedStore(fmt::format("{}: the store is damaged: it has no plan", database.shown()));
  require_sound(database, study.integer(2), study.integer(4), study.integer(5));
  found.number = study.integer(0);
  found.plan = {.text = study.text(1), .points = study.integer(2), .columns = columns_in(database), .seed = 0, .shard = {}};
  found.plan.seed = std::strtoull(study.text(3).c_str(), nullptr, 10);
  found.plan.shard = {.index = static_cast<int>(study.integer(4)), .count = static_cast<int>(study.integer(5))};
  if (checked && study.integer(6) != checksum_of(found.plan))
    throw DamagedStore(fmt::format("{}: the store is damaged: its plan has changed since it was written", database.shown()));
  return found;
}

std::int64_t number_of_plan(const Database& database, const std::string& text) {
  Statement plan = database.prepare("SELECT plan FROM study WHERE text = ?");
  plan.bind(1, text);
  return plan.step() ? plan.integer(0) : 0;
}

std::int64_t insert_plan(const Database& database, const StoredPlan& plan) {
  const bool checked = has_checksums(database);
  Statement insert =
      database.prepare(fmt::format("INSERT INTO study(text, digest, points, seed, shard, shards{}) VALUES(?, ?, ?, ?, ?, ?{})",
                                   checked ? ", checksum" : "", checked ? ", ?" : ""));
  insert.bind(1, plan.text).bind(2, content_key(plan.text).hexadecimal()).bind(3, plan.points).bind(4, std::to_string(plan.seed));
  insert.bind(5, std::int64_t{plan.shard.index}).bind(6, std::int64_t{plan.shard.count});
  if (checked) insert.bind(7, checksum_of(plan));
  insert.step();
  return sqlite3_last_insert_rowid(database.handle());
}

std::int64_t insert_session(const Database& database, std::int64_t plan, const StoredOrigin& origin) {
  const std::string moment = database.text_of(fmt::format("SELECT {}", now));
  insert_session(database, plan,
                 {.program = origin.program,
                  .processor = origin.processor,
                  .command = origin.command,
                  .host = host_name(),
                  .process = ::getpid(),
                  .began = moment,
                  .last = moment});
  return sqlite3_last_insert_rowid(database.handle());
}

void insert_session(const Database& database, std::int64_t plan, const StoredSession& session) {
  Statement insert = database.prepare(
      "INSERT INTO session(plan, program, processor, command, host, process, began, last, rows) VALUES(?, ?, ?, ?, ?, ?, ?, ?, "
      "?)");
  insert.bind(1, plan).bind(2, session.program).bind(3, session.processor).bind(4, session.command).bind(5, session.host);
  insert.bind(6, session.process).bind(7, session.began).bind(8, session.last).bind(9, session.rows).step();
}

SessionTally::SessionTally(const Database& database, std::int64_t plan, std::int64_t session)
    : plan_(plan),
      session_(session),
      to_session_(database, fmt::format("UPDATE session SET rows = rows + ?1, last = {} WHERE session = ?2", now)),
      to_tally_(database, "INSERT INTO tally VALUES(?1, ?2, ?3) ON CONFLICT(plan, status) DO UPDATE SET rows = rows + ?3") {}

void SessionTally::note(const std::map<std::string, std::int64_t>& rows_by_status) {
  std::int64_t rows = 0;
  for (const auto& [status, count] : rows_by_status) {
    to_tally_.bind(1, plan_).bind(2, status).bind(3, count).step();
    rows += count;
  }
  to_session_.bind(1, rows).bind(2, session_).step();
}

std::vector<StoredSession> sessions_in(const Database& database) {
  Statement statement = database.prepare(
      "SELECT program, processor, command, host, process, began, last, rows, (julianday(last) - julianday(began)) "
      "* 86400 FROM session ORDER BY session");
  std::vector<StoredSession> all;
  while (statement.step()) {
    all.push_back({.program = statement.text(0),
                   .processor = statement.text(1),
                   .command = statement.text(2),
                   .host = statement.text(3),
                   .process = statement.integer(4),
                   .began = statement.text(5),
                   .last = statement.text(6),
                   .seconds = statement.number(8),
                   .rows = statement.integer(7)});
  }
  return all;
}

std::map<std::string, std::int64_t> tally_of(const Database& database, std::int64_t plan) {
  Statement statement = database.prepare("SELECT status, rows FROM tally WHERE plan = ?");
  statement.bind(1, plan);
  std::map<std::string, std::int64_t> tally;
  while (statement.step()) tally[statement.text(0)] = statement.integer(1);
  return tally;
}

std::string select_rows(const Database& database, const std::vector<StoredColumn>& columns) {
  // A missing checksum counts as a wrong one, unless the database file has a schema without checksums.
  std::string sql =
      fmt::format("SELECT point, content, status, reason, extra, {}", has_checksums(database) ? "ifnull(checksum, 0)" : "NULL");
  for (const StoredColumn& column : columns) sql += ", " + sql_name(column.key);
  return sql + " FROM results";
}

StoredRow row_in(const Database& database, const Statement& statement, std::size_t values) {
  constexpr int checksum = 5, first_value = 6;
  StoredRow row{.point = statement.integer(0),
                .content = key_of(statement.blob(1)),
                .status = statement.text(2),
                .reason = statement.text(3),
                .values = std::vector<double>(values),
                .extra = statement.text(4)};
  for (std::size_t i = 0; i < values; ++i) row.values[i] = statement.number(first_value + static_cast<int>(i));
  if (!statement.is_null(checksum) && statement.integer(checksum) != checksum_of(row))
    throw DamagedStore(fmt::format("{}: the store is damaged: the row of point {} has changed since it was written",
                                   database.shown(), row.point));
  return row;
}

RowReader::RowReader(const Database& database, const NumberedPlan& plan, Of what, const std::string& where)
    : snapshot_(database),
      database_(database),
      number_(plan.number),
      points_(plan.plan.points),
      shard_(plan.plan.shard),
      values_(plan.plan.columns.size()),
      what_(what),
      all_(where.empty()),
      statement_(database, (what == Of::points ? "SELECT point FROM results" : select_rows(database, plan.plan.columns)) +
                               " WHERE plan = ?1" + (where.empty() ? "" : " AND (" + where + "\n)") + " ORDER BY point") {
  statement_.bind(1, number_);
}

void RowReader::fail(const std::string& reason) const {
  throw DamagedStore(fmt::format("{}: the store is damaged: {}", database_.shown(), reason));
}

bool RowReader::next() {
  if (ended_ || !statement_.step()) {
    if (!std::exchange(ended_, true) && all_) compare();
    return false;
  }
  if (what_ == Of::points)
    row_.point = statement_.integer(0);
  else
    row_ = row_in(database_, statement_, values_);
  if (row_.point < 0 || row_.point >= points_ || !shard_.contains(row_.point))
    fail(fmt::format("it has point {}, which does not belong to its part of the plan", row_.point));
  if (row_.point <= last_) fail(fmt::format("point {} follows point {}", row_.point, last_));
  last_ = row_.point;
  count();
  return true;
}

void RowReader::count() {
  ++rows_;
  if (what_ == Of::points) return;
  if (counted_ == by_status_.end() || counted_->first != row_.status) counted_ = by_status_.try_emplace(row_.status, 0).first;
  ++counted_->second;
}

void RowReader::compare() const {
  std::int64_t told = 0;
  const std::map<std::string, std::int64_t> tally = tally_of(database_, number_);
  for (const auto& [status, rows] : tally) told += rows;
  if (rows_ != told) fail(fmt::format("it has {} rows, and {} were written", rows_, told));
  if (what_ == Of::points) return;
  for (const auto& [status, rows] : tally) {
    const auto found = by_status_.find(status);
    const std::int64_t counted = found == by_status_.end() ? 0 : found->second;
    if (counted != rows) fail(fmt::format("{} rows are {}, and {} were written", counted, shortened(status), rows));
  }
}

namespace {

std::string insert_rows(const std::vector<StoredColumn>& columns, bool has_checksums) {
  std::string names = "plan, point, content, status, reason, extra", marks = "?, ?, ?, ?, ?, ?";
  if (has_checksums) names += ", checksum", marks += ", ?";
  for (const StoredColumn& column : columns) {
    names += ", " + sql_name(column.key);
    marks += ", ?";
  }
  return fmt::format("INSERT INTO results({}) VALUES({}) ON CONFLICT DO NOTHING", names, marks);
}

}  // namespace

RowWriter::RowWriter(const Database& database, std::int64_t plan, const std::vector<StoredColumn>& columns)
    : database_(database),
      plan_(plan),
      columns_(columns),
      has_checksums_(has_checksums(database)),
      insert_(database, insert_rows(columns, has_checksums_)),
      select_(database, select_rows(database, columns) + " WHERE plan = ? AND point = ?") {}

bool RowWriter::write(const StoredRow& row) {
  const std::array<unsigned char, 16> content = bytes_of(row.content);
  insert_.bind(1, plan_).bind(2, row.point).lend(3, content).lend(4, row.status).lend(5, row.reason).lend(6, row.extra);
  int parameter = 7;
  if (has_checksums_) insert_.bind(parameter++, checksum_of(row));
  for (const double value : row.values) insert_.bind(parameter++, kept(value));
  insert_.step();
  if (sqlite3_changes(database_.handle()) == 1) return true;
  select_.bind(1, plan_).bind(2, row.point);
  if (!select_.step())
    throw DamagedStore(
        fmt::format("{}: the store is damaged: point {} is found by one query and not by another", database_.shown(), row.point));
  const StoredRow there = row_in(database_, select_, columns_.size());
  select_.reset();
  const std::string other = difference(there, row, columns_);
  if (!other.empty())
    throw Contradiction(fmt::format("{}: point {} already has a different row: {}", database_.shown(), row.point, other));
  return false;
}

std::string difference(const StoredRow& a, const StoredRow& b, const std::vector<StoredColumn>& columns) {
  if (a.status != b.status) return fmt::format("status {} and {}", a.status, b.status);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (!same_number(a.values[i], b.values[i])) return fmt::format("{} {} and {}", columns[i].key, a.values[i], b.values[i]);
  }
  if (a.content != b.content) return fmt::format("content {} and {}", a.content.hexadecimal(), b.content.hexadecimal());
  if (a.reason != b.reason) return fmt::format("reason \"{}\" and \"{}\"", shortened(a.reason), shortened(b.reason));
  return a.extra == b.extra ? "" : "the data in extra";
}

}  // namespace softland::internal
