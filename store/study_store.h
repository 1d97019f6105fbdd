// A store: one file that holds the plan of a study (its request), the rows of its computed points, and the program that
// computed each row. A power cut does not damage the file.
//
// The file is a database of SQLite 3 and is readable on every machine. It has one writer at a time, which holds FILE.lock while
// it works, and any number of readers at any time. Rows become durable in batches of `rows_per_commit` or `seconds_per_commit`,
// whichever comes first. If the process or the machine fails, at most the rows of the last second are lost.
//
// A row has the number of its point in the plan, and a content key, which identifies the resolved scene that was computed. A
// study may continue with another plan of the same columns, a finer grid or a larger sample. find() then gives the rows that
// the earlier plans hold for equal content, so that no point is computed twice.
//
//   StudyStore store("map.sqlite", plan, origin, StudyStore::Opening::resume);
//   const std::vector<bool> done = store.done();
//   ... on any thread, for each point of plan.shard that is not done ...
//     if (auto known = store.find(content)) { known->point = point; store.add(*std::move(known)); } else store.add(computed);
//   store.close();
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/content_key.h"
#include "base/progress.h"

namespace softland {

/// Version of the tables of a study database. A database file of a later version is refused.
inline constexpr int store_schema = 2;
inline constexpr std::size_t rows_per_commit = 1000;
inline constexpr double seconds_per_commit = 1;  ///< longest time in which a written row is not yet durable [s]

/// The kind of a column of a study database: a variable of the study, or a figure of merit.
enum class ColumnKind { variable, figure };

struct StoredColumn {
  std::string key;   ///< name of a column in the database and in the header of CSV, for example "gap_contact_m"
  std::string name;  ///< key of a variable in the scene, such as "gap.contact", or readable name of a figure of merit
  std::string unit;  ///< SI unit of a column, such as "m/s"; empty for a count, a ratio, yes or no
  ColumnKind kind = ColumnKind::figure;
  bool operator==(const StoredColumn&) const = default;
  /// Returns true when both columns hold the same quantity. Two versions of softland may word the name of a figure of merit
  /// differently.
  [[nodiscard]] bool holds_as(const StoredColumn& other) const {
    return key == other.key && unit == other.unit && kind == other.kind && (kind == ColumnKind::figure || name == other.name);
  }
};

/// Returns the name of a database column from name and unit: ("gap.contact", "m") gives "gap_contact_m".
[[nodiscard]] std::string column_key(std::string_view name, std::string_view unit);

/// The share of a study's points that one part of the study computes: every `count`-th point, from index - 1 on, so that all
/// parts cost about the same.
struct Shard {
  int index = 1;  ///< number of the part of the study, 1 to count
  int count = 1;
  [[nodiscard]] bool contains(std::int64_t point) const { return point % count == index - 1; }
  /// Returns how many of the study's points 0 ... points - 1 belong to this part.
  [[nodiscard]] std::int64_t size(std::int64_t points) const { return (points - index + count) / count; }
  bool operator==(const Shard&) const = default;
};

/// Reads the part of a study from text: "3/8" is the third of eight parts. Throws InvalidInput unless 1 <= index <= count.
[[nodiscard]] Shard shard_from(std::string_view text);

struct StoredPlan {
  std::string text;                   ///< canonical text of a study's request, equal for equal requests, without the shard
  std::int64_t points = 0;            ///< number of points of the study, numbered 0 ... points - 1
  std::vector<StoredColumn> columns;  ///< columns of every result row, in this order
  std::uint64_t seed = 0;
  Shard shard = {};  ///< part of the study's points that this database file holds
};

/// The program and the processor of a computation, which influence the last digits of its results.
struct StoredOrigin {
  std::string program;    ///< name, version and hash of the program that computed a row
  std::string processor;  ///< name of the processor that computed a row, and its vector instructions in use
  std::string command;
};

struct StoredRow {
  std::int64_t point = 0;
  ContentKey content = {};
  std::string status;       ///< outcome of the computation of a point: "done", "no_contact", "numerical_failure"
  std::string reason = {};  ///< reason if the computation of the point did not succeed
  /// Variables and figures of the point, one per column [SI]; NaN where not known; -0 is stored as 0.
  std::vector<double> values;
  std::string extra = {};  ///< further data of the point as JSON, such as the waveform found there; may be empty
};

/// A run of the program that wrote to a database file.
struct StoredSession {
  std::string program, processor, command;  ///< program, processor and command line of the run
  std::string host;
  std::int64_t process = 0;
  std::string began, last;  ///< start of the run and time of its last commit: UTC, "2026-01-31 12:00:00.000"
  double seconds = 0;       ///< time from the start of the run to its last commit [s]
  std::int64_t rows = 0;    ///< number of rows that the run wrote
};

/// Returns true for a regular file that begins like a study database. Other kinds of files, such as pipes, are not opened.
[[nodiscard]] bool is_store(const std::filesystem::path& path);

/// Returns a description of the process that currently writes to the database file, such as "process 4711 on node3 since ...:
/// softland explore ..."; none if no process does.
[[nodiscard]] std::optional<std::string> writer_of(const std::filesystem::path& path);

/// Writes the rows of a study to a database file, which has one writer at a time.
class StudyStore {
 public:
  enum class Opening {
    fresh,  ///< create the database file, which must not exist
    resume  ///< continue an existing database file with the same columns and shard, with an equal or another plan
  };

  /// Creates or continues the database file of a study. Throws InvalidInput with path and reason if `path` must not exist but
  /// does. Throws InvalidInput, too, if the file is not a study database, has a later schema or other columns, or is not
  /// writable, or if another process writes to it. Throws OutputLost if the disk is full. A damaged file is copied to
  /// FILE.damaged.
  StudyStore(const std::filesystem::path& path, const StoredPlan& plan, const StoredOrigin& origin, Opening opening);
  /// Commits waiting rows to the database file without reporting errors; close() reports errors.
  ~StudyStore();
  StudyStore(const StudyStore&) = delete;
  StudyStore& operator=(const StudyStore&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const;
  /// Returns for every point of the study whether the database file held a row of the point when it was opened.
  [[nodiscard]] std::vector<bool> done() const;
  /// Returns true if the database file holds rows of earlier plans (requests) of the study, which find() can return.
  [[nodiscard]] bool has_earlier_plans() const;
  /// Returns the number of rows of earlier plans (requests) of the study.
  [[nodiscard]] std::int64_t earlier_rows() const;
  /// Returns a row that an earlier plan (request) of the study has for this content key, which identifies the computed scene;
  /// none without such a row. May be called on any thread.
  [[nodiscard]] std::optional<StoredRow> find(const ContentKey& content) const;

  /// Queues a row, which another thread writes. A row that is equal to a row in the database file is ignored. Throws
  /// InvalidInput if the database file has a different row of this point, or if the row does not fit the plan. Throws
  /// OutputLost if earlier rows could not be written; the next call writes the earlier rows again. May be called on any thread.
  void add(StoredRow row);
  /// Waits until all queued rows are on the disk. Throws OutputLost or InvalidInput as add() does.
  void flush();
  /// Calls flush(), and removes the write-ahead log and the lock file, so that only the database file remains. Throws
  /// OutputLost or InvalidInput as add() does.
  void close();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// A selection of rows of a study by an SQL expression of the columns and of `point`, `status` and `reason`; empty for all
/// rows.
struct StudyQuery {
  std::string where = {};
};

/// Reads the database file of a study, even while another process writes to it, without changing its content.
class StudyReader {
 public:
  /// Opens the database file of a study. Throws InvalidInput with path and reason if the file is not a study database, has a
  /// later schema, is damaged, or cannot be read.
  explicit StudyReader(const std::filesystem::path& path);
  ~StudyReader();
  StudyReader(StudyReader&&) noexcept;
  StudyReader& operator=(StudyReader&&) noexcept;

  [[nodiscard]] const std::filesystem::path& path() const;
  /// Returns the plan (request) of the study with which the last run wrote to the file.
  [[nodiscard]] const StoredPlan& plan() const;
  [[nodiscard]] std::vector<StoredSession> sessions() const;
  /// Returns the number of rows of the current plan by their status, such as "done".
  [[nodiscard]] std::map<std::string, std::int64_t> by_status() const;

  /// Calls row(...) for the rows of the current plan that the query selects, in the order of their points. Throws InvalidInput
  /// with --where and the expression if the expression is invalid or not a plain expression of columns; Interrupted after a
  /// request to stop.
  void read(const std::function<void(const StoredRow&)>& row, const StudyQuery& query = {}, const Progress& progress = {}) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

struct MergeOptions {
  bool complete = false;  ///< true: write no merged file while points of the study are missing
  Progress progress = {};
};

/// The result of merging the database files of a study's parts.
struct Merged {
  StoredPlan plan;  ///< plan of the merged study; its shard is 1/1
  std::int64_t rows = 0;
  bool written = false;
  std::vector<std::string> notes;  ///< notes on missing points, and on parts that different programs or processors computed
};

/// Merges the database files of a study's parts into one file `out`, which must not exist. Throws InvalidInput with the names
/// of the files if they have different plans, or different rows for a point.
[[nodiscard]] Merged merge_studies(const std::vector<std::filesystem::path>& paths, const std::filesystem::path& out,
                                   const StoredOrigin& origin, const MergeOptions& options = {});

}  // namespace softland
