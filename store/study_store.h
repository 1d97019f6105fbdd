// A store: one file that holds the plan of a study, the rows of its computed points, and the program that computed each row. It
// survives a power cut.
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

/// Version of the tables. A database file of a later version is refused.
inline constexpr int store_schema = 2;
inline constexpr std::size_t rows_per_commit = 1000;
inline constexpr double seconds_per_commit = 1;  ///< time after the first row that is not yet durable [s]

/// The kind of a column: a variable of the plan, or a figure of a closing.
enum class ColumnKind { variable, figure };

struct StoredColumn {
  std::string key;   ///< name of the column in the database and in the header of CSV: "gap_contact_m"; see column_key()
  std::string name;  ///< key of the scene, such as "gap.contact", or readable name of a figure
  std::string unit;  ///< SI unit, "m/s"; empty for a count, a ratio, yes or no
  ColumnKind kind = ColumnKind::figure;
  bool operator==(const StoredColumn&) const = default;
};

/// Returns the name of a column in the database: ("gap.contact", "m") gives "gap_contact_m".
[[nodiscard]] std::string column_key(std::string_view name, std::string_view unit);

/// The share of a plan that one part of a study computes: every `count`-th point, from index - 1 on, so that all parts cost
/// about the same.
struct Shard {
  int index = 1;  ///< number of the part, 1 to count
  int count = 1;
  [[nodiscard]] bool contains(std::int64_t point) const { return point % count == index - 1; }
  /// Returns the number of points among 0 ... points - 1 that the shard contains.
  [[nodiscard]] std::int64_t size(std::int64_t points) const { return (points - index + count) / count; }
  bool operator==(const Shard&) const = default;
};

/// Reads a shard: "3/8" is the third of eight. Throws InvalidInput unless 1 <= index <= count.
[[nodiscard]] Shard shard_from(std::string_view text);

struct StoredPlan {
  std::string text;                   ///< canonical text of the plan, equal for equal plans; the shard is not part of the text
  std::int64_t points = 0;            ///< number of points, numbered 0 ... points - 1
  std::vector<StoredColumn> columns;  ///< columns of every row, in this order
  std::uint64_t seed = 0;
  Shard shard = {};  ///< share of the plan that this file holds
};

/// The program and the processor of a computation, which influence the last digits of its results.
struct StoredOrigin {
  std::string program;    ///< name, version and hash of the program
  std::string processor;  ///< name of the processor and its vector instructions in use
  std::string command;
};

struct StoredRow {
  std::int64_t point = 0;
  ContentKey content = {};
  std::string status;          ///< outcome of the computation: "done", "no_contact", "numerical_failure"
  std::string reason = {};     ///< reason if the computation did not succeed
  std::vector<double> values;  ///< values, one per column [SI]; NaN where not known. The sign of a zero is not kept
  std::string extra = {};      ///< JSON of further data of the point, such as the waveform found there; may be empty
};

/// A run of the program that wrote to a database file.
struct StoredSession {
  std::string program, processor, command;  ///< see StoredOrigin
  std::string host;
  std::int64_t process = 0;
  std::string began, last;  ///< UTC, "2026-01-31 12:00:00.000"; `last`: time of the last commit
  double seconds = 0;       ///< time between `began` and `last` [s]
  std::int64_t rows = 0;    ///< number of rows written in the session
};

/// Returns true for a regular file that begins like a study database. Other kinds of files, such as pipes, are not opened.
[[nodiscard]] bool is_store(const std::filesystem::path& path);

/// Returns a description of the current writer of the database file, such as "process 4711 on node3 since ...: softland explore
/// ..."; none if there is no writer.
[[nodiscard]] std::optional<std::string> writer_of(const std::filesystem::path& path);

/// Writes rows to a database file, which has one writer at a time.
class StudyStore {
 public:
  enum class Opening {
    fresh,  ///< the file must not exist
    resume  ///< an existing database file with the same columns and shard is continued, with this or another plan
  };

  /// Creates or continues the database file. Throws InvalidInput with path and reason if `path` must not exist but does. Throws
  /// InvalidInput, too, if the file is not a study database, has a later schema or other columns, or is not writable, or if
  /// another process writes to it. Throws OutputLost if the disk is full. A damaged file is copied to FILE.damaged.
  StudyStore(const std::filesystem::path& path, const StoredPlan& plan, const StoredOrigin& origin, Opening opening);
  /// Commits waiting rows without reporting errors; close() reports errors.
  ~StudyStore();
  StudyStore(const StudyStore&) = delete;
  StudyStore& operator=(const StudyStore&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const;
  /// Returns for every point of the plan whether the database file held a row of the point when it was opened.
  [[nodiscard]] std::vector<bool> done() const;
  /// Returns true if the database file holds rows of earlier plans, which find() can return.
  [[nodiscard]] bool has_earlier_plans() const;
  /// Returns the number of rows of earlier plans.
  [[nodiscard]] std::int64_t earlier_rows() const;
  /// Returns a row of an earlier plan with this content. May be called on any thread.
  [[nodiscard]] std::optional<StoredRow> find(const ContentKey& content) const;

  /// Queues a row, which another thread writes. A row that is equal to one in the database file is ignored. Throws InvalidInput
  /// if the database file has a different row of the same point, or if the row does not fit the plan. Throws OutputLost if
  /// earlier rows could not be written; the next call writes these rows again. May be called on any thread.
  void add(StoredRow row);
  /// Waits until all queued rows are on the disk. Throws as add().
  void flush();
  /// Calls flush(), and removes log and lock, so that only the database file remains. Throws as add().
  void close();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// A selection of rows by an SQL expression of the columns and of `point`, `status` and `reason`; empty for all rows.
struct StudyQuery {
  std::string where = {};
};

/// Reads a database file, even while another process writes to it, without changing its content.
class StudyReader {
 public:
  /// Opens the database file. Throws InvalidInput with path and reason if the file is not a study database, has a later schema,
  /// is damaged, or cannot be read.
  explicit StudyReader(const std::filesystem::path& path);
  ~StudyReader();
  StudyReader(StudyReader&&) noexcept;
  StudyReader& operator=(StudyReader&&) noexcept;

  [[nodiscard]] const std::filesystem::path& path() const;
  /// Returns the plan of the last session.
  [[nodiscard]] const StoredPlan& plan() const;
  [[nodiscard]] std::vector<StoredSession> sessions() const;
  /// Returns the number of rows of the plan by their status.
  [[nodiscard]] std::map<std::string, std::int64_t> by_status() const;

  /// Calls row(...) for the rows of the plan that the query selects, in the order of their points. Throws InvalidInput with
  /// --where and the expression if it is invalid or not a plain expression of columns; Interrupted after a request to stop.
  void read(const std::function<void(const StoredRow&)>& row, const StudyQuery& query = {}, const Progress& progress = {}) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

struct MergeOptions {
  bool complete = false;  ///< true to write nothing while points are missing
  Progress progress = {};
};

/// The result of a merge.
struct Merged {
  StoredPlan plan;  ///< plan of the study, with the shard 1/1
  std::int64_t rows = 0;
  bool written = false;
  std::vector<std::string> notes;  ///< notes on missing points, and on parts of several programs or processors
};

/// Merges the parts of a study into one database file `out`, which must not exist. Throws InvalidInput with the names of the
/// parts if they have different plans, or different rows for a point.
[[nodiscard]] Merged merge_studies(const std::vector<std::filesystem::path>& paths, const std::filesystem::path& out,
                                   const StoredOrigin& origin, const MergeOptions& options = {});

}  // namespace softland
