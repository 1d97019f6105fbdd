// A study that survives a power cut: one file that holds a plan, its completed points, and who computed them.
//
// The file is a database of SQLite 3 and is readable on every machine. It has one writer at a time, which holds FILE.lock while
// it works, and any number of readers at any time. Rows become durable in batches of `rows_per_commit` or `seconds_per_commit`,
// whichever comes first. Whatever happens to process or machine, at most the rows of that last second are lost, and the rest of
// the store is whole.
//
// A row belongs to a point of a plan by its number, and to a computation by its content: the key of the resolved scene. A study
// may continue with another plan of the same columns, a finer grid or a larger sample. find() then gives the rows that the
// earlier plans hold for equal content, so that no point is computed twice.
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
#include "base/watch.h"

namespace softland {

/// Version of the tables. A store of a later one is refused.
inline constexpr int store_schema = 2;
inline constexpr std::size_t rows_per_commit = 1000;
inline constexpr double seconds_per_commit = 1;  ///< time after the first row that is not yet durable [s]

/// The content of a column: something that the plan varies, or a figure of a closing.
enum class ColumnKind { variable, figure };

struct StoredColumn {
  std::string key;   ///< name in the database and in the header of CSV: "gap_contact_m"; see column_key()
  std::string name;  ///< key of the scene, "gap.contact", or the figure's name for people
  std::string unit;  ///< SI unit, "m/s"; empty for a count, a ratio, yes or no
  ColumnKind kind = ColumnKind::figure;
  bool operator==(const StoredColumn&) const = default;
};

/// Returns a name with its unit as a word of letters, digits and underscores: ("gap.contact", "m") is "gap_contact_m".
[[nodiscard]] std::string column_key(std::string_view name, std::string_view unit);

/// The share of a plan that one part of a study computes: every `count`-th point, from index - 1 on, so that all parts cost
/// about the same.
struct Shard {
  int index = 1;  ///< 1 to count
  int count = 1;
  [[nodiscard]] bool contains(std::int64_t point) const { return point % count == index - 1; }
  /// Returns the number of points among 0 ... points - 1 that the shard contains.
  [[nodiscard]] std::int64_t size(std::int64_t points) const { return (points - index + count) / count; }
  bool operator==(const Shard&) const = default;
};

/// Reads a shard: "3/8" is the third of eight. Throws InvalidInput unless 1 <= index <= count.
[[nodiscard]] Shard shard_from(std::string_view text);

struct StoredPlan {
  std::string text;                   ///< canonical text: equal plans are equal bytes. It does not include the shard
  std::int64_t points = 0;            ///< number of points, numbered 0 ... points - 1
  std::vector<StoredColumn> columns;  ///< columns of every row, in this order
  std::uint64_t seed = 0;
  Shard shard = {};  ///< share of the plan that this file holds
};

/// The program and processor of a computation: they may change the last digits of its results.
struct StoredOrigin {
  std::string program;    ///< name, version and hash of the program
  std::string processor;  ///< name of the processor, and its instructions that are used
  std::string command;
};

struct StoredRow {
  std::int64_t point = 0;
  ContentKey content = {};
  std::string status;          ///< outcome of the computation: "done", "no_contact", "numerical_failure"
  std::string reason = {};     ///< reason in words, where it did not succeed
  std::vector<double> values;  ///< values, one per column [SI]; NaN where not known. The sign of a zero is not kept
  std::string extra = {};      ///< JSON of further data of the point, such as the waveform found there; may be empty
};

/// One run of the program on a store.
struct StoredSession {
  std::string program, processor, command;  ///< see StoredOrigin
  std::string host;
  std::int64_t process = 0;
  std::string began, last;  ///< UTC, "2026-01-31 12:00:00.000"; `last`: time of the last commit
  double seconds = 0;       ///< time between `began` and `last` [s]
  std::int64_t rows = 0;    ///< number of rows written in the session
};

/// Returns true for a regular file that begins as a store does. Nothing else is opened, so that it never waits for a pipe.
[[nodiscard]] bool is_store(const std::filesystem::path& path);

/// Returns the current writer of the store in words ("process 4711 on node3 since ...: softland explore ..."); none without
/// one.
[[nodiscard]] std::optional<std::string> writer_of(const std::filesystem::path& path);

/// The one writer of a store.
class StudyStore {
 public:
  enum class Opening {
    fresh,  ///< the file must not exist
    resume  ///< an existing one is continued: this plan, or another of the same columns and shard
  };

  /// Creates or continues the store. Throws InvalidInput with path and reason where `path` exists and should not, is not a
  /// store, is a store of a later schema or of other columns, or cannot be written to; and, with its name, where another
  /// process writes into it. Throws OutputLost where the disk is full. A damaged store is left as it is, with a copy of it
  /// beside: FILE.damaged.
  StudyStore(const std::filesystem::path& path, const StoredPlan& plan, const StoredOrigin& origin, Opening opening);
  /// Commits what it can without reporting errors: call close() to learn of them.
  ~StudyStore();
  StudyStore(const StudyStore&) = delete;
  StudyStore& operator=(const StudyStore&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const;
  /// Returns, for every point of the plan, whether the store held it when it was opened.
  [[nodiscard]] std::vector<bool> done() const;
  /// True when the store holds rows of other plans, so that find() may find something.
  [[nodiscard]] bool has_earlier_plans() const;
  /// Returns the number of these rows.
  [[nodiscard]] std::int64_t earlier_rows() const;
  /// Returns a row of an earlier plan with this content. May be called on any thread.
  [[nodiscard]] std::optional<StoredRow> find(const ContentKey& content) const;

  /// Takes a row to be written; returns soon. A row that the store holds with the same bits changes nothing. Throws
  /// InvalidInput where the store has a row of this point with other bits, or the row does not fit the plan. Throws OutputLost
  /// where earlier rows could not be written; these are kept and tried again with the next call. May be called on any thread.
  void add(StoredRow row);
  /// Waits until all rows taken are durable. Throws as add().
  void flush();
  /// Calls flush(), then leaves the file alone in its folder, without log or lock. Throws as add().
  void close();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// A selection of rows in the words of SQL: an expression over the columns and `point`, `status`, `reason`; empty for all rows.
struct StudyQuery {
  std::string where = {};
};

/// A store in its current state, whether or not somebody writes into it. It never changes the content.
class StudyReader {
 public:
  /// Throws InvalidInput with path and reason where this is not a store, a store of a later schema, a damaged one, or cannot be
  /// read.
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

  /// Calls row(...) for the rows of the plan that the query selects, in the order of their points. Throws InvalidInput naming
  /// --where and the expression where that cannot be understood or does more than compare; Interrupted when asked to stop.
  void read(const std::function<void(const StoredRow&)>& row, const StudyQuery& query = {}, const Watch& watch = {}) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

struct MergeOptions {
  bool complete = false;  ///< true to write nothing while points are missing
  Watch watch = {};
};

/// The result of a merge.
struct Merged {
  StoredPlan plan;  ///< plan of the study, with the shard 1/1
  std::int64_t rows = 0;
  bool written = false;
  std::vector<std::string> notes;  ///< notes on missing points, and on parts of several programs or processors
};

/// Merges the parts of a study into one store `out`, which must not exist. Throws InvalidInput with the names where parts are
/// of different plans, or hold a point with different bits.
[[nodiscard]] Merged merge_studies(const std::vector<std::filesystem::path>& paths, const std::filesystem::path& out,
                                   const StoredOrigin& origin, const MergeOptions& options = {});

}  // namespace softland
