#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>

#include <algorithm>
#include <memory>
#include <queue>
#include <set>
#include <system_error>
#include <utility>

#include "base/require.h"
#include "store/place.h"
#include "store/study_store.h"
#include "store/tables.h"

namespace softland {

using namespace internal;
namespace fs = std::filesystem;

namespace {

// The rows of one partial database file of a study, in the order of their points.
class StorePart {
 public:
  explicit StorePart(const fs::path& path) : database_(open_to_read(path)) {
    check_schema(*database_);
    current_ = current_plan(*database_);
    database_->run("PRAGMA cache_size = -64");  // a small cache, because a merge may read a thousand files
  }
  [[nodiscard]] const StoredPlan& plan() const { return current_.plan; }
  [[nodiscard]] const StoredRow& row() const { return rows_->row(); }
  [[nodiscard]] const Database& database() const { return *database_; }

  bool next() {
    if (!rows_) rows_.emplace(*database_, current_, RowReader::Of::rows);
    return rows_->next();
  }

 private:
  std::unique_ptr<const Database> database_;
  NumberedPlan current_;
  std::optional<RowReader> rows_;
};

using Parts = std::vector<std::unique_ptr<StorePart>>;

// Raises the limit of open files of the process for a merge of `parts` database files. Every file needs one descriptor, or
// three if the process that wrote the file was killed.
void allow_files(std::size_t parts) {
  rlimit limit{};
  const rlim_t needed = 4 * parts + 64;
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= needed) return;
  limit.rlim_cur = std::min(limit.rlim_max, needed);
  static_cast<void>(::setrlimit(RLIMIT_NOFILE, &limit));
}

Parts opened(const std::vector<fs::path>& paths) {
  allow_files(paths.size());
  Parts parts;
  std::set<fs::path> seen;
  for (const fs::path& path : paths) {
    parts.push_back(std::make_unique<StorePart>(path));
    require(seen.insert(fs::canonical(path)).second, fmt::format("{}: must not be given twice", path.string()));
    const StoredPlan &first = parts.front()->plan(), &plan = parts.back()->plan();
    require(plan.text == first.text && std::ranges::equal(plan.columns, first.columns, &StoredColumn::holds_as) &&
                plan.points == first.points,
            fmt::format("{}: must have the same plan as {}", path.string(), paths.front().string()));
  }
  return parts;
}

// Adds the names of the first few missing database files to the notes; each holds one part of the study.
void add_missing_parts(std::vector<std::string>& notes, const Parts& parts) {
  constexpr std::size_t most_names = 20;
  const int count = parts.front()->plan().shard.count;
  std::set<int> given;
  for (const auto& part : parts) {
    if (part->plan().shard.count == count) given.insert(part->plan().shard.index);
  }
  const std::size_t missing = static_cast<std::size_t>(count) - given.size();
  if (missing == 0 || count == 1) return;
  std::vector<std::string> names;
  for (int index = 1; names.size() < std::min(missing, most_names); ++index) {
    if (!given.contains(index)) names.push_back(fmt::format("{}/{}", index, count));
  }
  if (missing > names.size()) names.push_back(fmt::format("and {} more", missing - names.size()));
  notes.push_back(fmt::format("no part was given for {}", fmt::join(names, ", ")));
}

// Returns notes on points of the study that no merged file holds, listed by the parts of the study to which they belong.
std::vector<std::string> notes_on(const Parts& parts, const StoredPlan& plan, std::int64_t rows) {
  std::vector<std::string> notes;
  if (rows < plan.points) notes.push_back(fmt::format("{} of {} points are missing", plan.points - rows, plan.points));
  if (rows < plan.points) add_missing_parts(notes, parts);
  std::set<std::string> programs, processors;
  for (const auto& part : parts) {
    for (const StoredSession& session : sessions_in(part->database())) {
      programs.insert(session.program);
      processors.insert(session.processor);
    }
  }
  if (programs.size() > 1)
    notes.push_back(fmt::format("the parts were computed by several programs: {}", fmt::join(programs, "; ")));
  if (processors.size() > 1)
    notes.push_back(fmt::format("the parts were computed on several processors: {}", fmt::join(processors, "; ")));
  return notes;
}

// Writes the rows of all merged files in the order of their points.
std::int64_t write_rows(const Database& database, std::int64_t number, Parts& parts, const StoredPlan& plan, std::int64_t session,
                        const Progress& progress) {
  // The file with the smallest next point is read first; of files with the same next point, the one given first.
  const auto later = [&](std::size_t a, std::size_t b) {
    return std::pair(parts[a]->row().point, a) > std::pair(parts[b]->row().point, b);
  };
  std::priority_queue<std::size_t, std::vector<std::size_t>, decltype(later)> next(later);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i]->next()) next.push(i);
  }
  RowWriter writer(database, number, plan.columns);
  std::map<std::string, std::int64_t> by_status;
  std::int64_t rows = 0;
  std::optional<StoredRow> last;
  std::string last_name;
  while (!next.empty()) {
    if (rows % 1000 == 0) {
      progress.throw_if_stopped();
      progress.tell("merging", static_cast<double>(rows) / static_cast<double>(plan.points));
    }
    const std::size_t first = next.top();
    next.pop();
    StorePart& part = *parts[first];
    const StoredRow& row = part.row();
    const bool again = last && last->point == row.point;
    const std::string other = again ? difference(*last, row, plan.columns) : "";
    require(other.empty(), fmt::format("{} and {} must hold the same row for point {}, but differ in {}", last_name,
                                       part.database().shown(), row.point, other));
    if (!again && writer.write(row)) {
      ++rows;
      ++by_status[row.status];
    }
    last = row;
    last_name = part.database().shown();
    if (part.next()) next.push(first);
  }
  SessionTally(database, number, session).note(by_status);
  return rows;
}

}  // namespace

Merged merge_studies(const std::vector<fs::path>& paths, const fs::path& out, const StoredOrigin& origin,
                     const MergeOptions& options) {
  require(!paths.empty(), "a merge needs at least one part");
  std::error_code ignored;
  require(!fs::exists(fs::symlink_status(out, ignored)), fmt::format("{}: exists already; it is not replaced", out.string()));
  Parts parts = opened(paths);
  require_room(out);
  const auto lock = lock_store(out, origin.command);
  Merged merged{.plan = parts.front()->plan(), .rows = 0, .written = false, .notes = {}};
  merged.plan.shard = {};
  const UnnamedStore made(out);
  {
    const Database database(made.path(), Access::create, out.string());
    // The temporary database file is removed after a failure, so that it needs no crash-safe journal.
    database.run("PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF");
    create_tables(database, merged.plan.columns);
    Transaction transaction(database);
    const std::int64_t number = insert_plan(database, merged.plan);
    for (const auto& part : parts) {
      for (const StoredSession& session : sessions_in(part->database())) insert_session(database, number, session);
    }
    const std::int64_t session = insert_session(database, number, origin);
    merged.rows = write_rows(database, number, parts, merged.plan, session, options.progress);
    transaction.commit();
  }
  merged.written = !options.complete || merged.rows == merged.plan.points;
  if (merged.written) made.give_name();
  merged.notes = notes_on(parts, merged.plan, merged.rows);
  return merged;
}

}  // namespace softland
