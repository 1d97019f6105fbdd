#include "store/study_store.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <charconv>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <limits>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "base/companion.h"
#include "base/output_lost.h"
#include "base/require.h"
#include "base/shortened.h"
#include "store/place.h"
#include "store/tables.h"

namespace softland {

using namespace internal;
namespace fs = std::filesystem;

std::string column_key(std::string_view name, std::string_view unit) {
  std::string key;
  const auto append = [&](std::string_view text) {
    for (const char c : text) {
      const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
      if (plain) key += c;
      if (!plain && c != '^' && !key.empty() && key.back() != '_') key += '_';
    }
  };
  append(name);
  if (!unit.empty()) append("_" + std::string(unit));
  return key;
}

Shard shard_from(std::string_view text) {
  Shard shard{.index = 0, .count = 0};
  const char* end = text.data() + text.size();
  const auto [slash, first] = std::from_chars(text.data(), end, shard.index);
  bool valid = first == std::errc() && slash != end && *slash == '/';
  if (valid) {
    const auto [last, second] = std::from_chars(slash + 1, end, shard.count);
    valid = second == std::errc() && last == end && shard.index >= 1 && shard.index <= shard.count;
  }
  require(valid, fmt::format("\"{}\" must be a part i/N of a study with 1 <= i <= N, such as 3/8 for the third of eight",
                             shortened(text)));
  return shard;
}

namespace {

constexpr std::size_t rows_that_wait = 16 * rows_per_commit;
// Size [byte] up to which a file's whole content is checked for damage when the file is opened.
constexpr std::uintmax_t checked_size = std::uintmax_t{64} << 20;

void require_only_name(const fs::path& path) {
  struct stat found {};
  const bool linked = ::stat(path.c_str(), &found) == 0 && found.st_nlink > 1;
  require(!linked,
          fmt::format("{}: must not have a second name (hard link), under which its log would not be found; copy the file",
                      path.string()));
}

void create_store(const fs::path& path, const StoredPlan& plan, const StoredOrigin& origin) {
  const UnnamedStore made(path);
  {
    const Database database(made.path(), Access::create, path.string());
    database.run("PRAGMA journal_mode = MEMORY");
    create_tables(database, plan.columns);
    Transaction transaction(database);
    static_cast<void>(insert_session(database, insert_plan(database, plan), origin));
    transaction.commit();
  }
  made.give_name();
}

void require_same_columns(const Database& database, const StoredPlan& there, const StoredPlan& plan) {
  std::string other;
  for (std::size_t i = 0; i < std::max(there.columns.size(), plan.columns.size()) && other.empty(); ++i) {
    if (i >= there.columns.size()) other = fmt::format("it lacks {}", plan.columns[i].key);
    if (i >= plan.columns.size()) other = fmt::format("it also has {}", there.columns[i].key);
    if (other.empty() && !there.columns[i].holds_as(plan.columns[i]))
      other = fmt::format("it has {} where this study has {}", there.columns[i].key, plan.columns[i].key);
  }
  require(other.empty(), fmt::format("{}: holds a study with other columns ({}); name another file", database.shown(), other));
  const auto words = [](const Shard& shard) { return fmt::format("{}/{}", shard.index, shard.count); };
  require(there.shard == plan.shard, fmt::format("{}: holds part {} of a study, not {}; name another file", database.shown(),
                                                 words(there.shard), words(plan.shard)));
}

}  // namespace

class StudyStore::Implementation {
 public:
  Implementation(const fs::path& path, const StoredPlan& plan, const StoredOrigin& origin, Opening opening);
  ~Implementation();

  void add(StoredRow row);
  void flush();
  void close();

  const fs::path path_;
  StoredPlan plan_;
  std::unique_ptr<const LockFile> lock_;
  std::unique_ptr<Database> database_;
  std::int64_t number_ = 0;
  bool has_earlier_ = false;
  std::int64_t earlier_rows_ = 0;
  std::vector<bool> done_;

  mutable std::mutex finding_;
  std::unique_ptr<const Database> earlier_;  // separate connection, so that find() does not wait for a write to the disk
  mutable std::optional<Statement> find_;

 private:
  void open();
  void start_session(const StoredOrigin& origin, bool resumed);
  void read_done();
  void prepare_finding();
  void work();
  void commit(const std::vector<StoredRow>& rows);
  void commit_batch(std::unique_lock<std::mutex>& lock);
  void keep_in_place();
  void move_to_rescue(const std::string& what);
  void begin_writing();
  void end_log();
  void rethrow_failure();
  void let_go();

  std::optional<RowWriter> rows_;
  std::optional<SessionTally> tally_;
  fs::path log_;  // path of SQLite's write-ahead log; empty if there is no log
  std::optional<FileNumber> log_number_;
  // Message that names the file with the rescued rows of a removed database file; only the writing thread uses it.
  std::string rescued_;

  std::mutex mutex_;
  std::condition_variable for_writer_, for_callers_;
  std::vector<StoredRow> waiting_;
  std::chrono::steady_clock::time_point due_;
  bool committing_ = false, hurried_ = false, stopping_ = false;
  std::exception_ptr failure_;        // failure to write rows to the database file; the waiting rows are written again later
  std::exception_ptr contradiction_;  // error about a row that contradicts the database file and was not written
  std::string lost_;                  // copy, for calling threads, of the message about a removed database file
  std::thread writer_;
};

StudyStore::Implementation::Implementation(const fs::path& path, const StoredPlan& plan, const StoredOrigin& origin,
                                           Opening opening)
    : path_(path), plan_(plan) {
  check_plan(plan);
  std::error_code ignored;
  const auto is_there = [&] {
    const bool there = fs::exists(fs::status(path, ignored));
    require(opening == Opening::resume || !there,
            fmt::format("{}: exists already; it is not replaced (--resume continues a study)", path.string()));
    return there;
  };
  if (is_there())
    require_store(path);
  else
    require_room(path);
  lock_ = lock_store(path, origin.command);
  const bool resumed = is_there();  // another run may have created the database file since the first check
  if (!resumed) create_store(path, plan, origin);
  try {
    open();
    start_session(origin, resumed);
  } catch (const DamagedStore& error) {
    let_go();
    throw InvalidInput(fmt::format("{}; {}", error.what(), kept_copy(path)));
  }
  writer_ = std::thread([this] { work(); });
}

void StudyStore::Implementation::open() {
  require_store(path_);
  require_only_name(path_);
  std::error_code ignored;
  database_ = std::make_unique<Database>(fs::canonical(path_), Access::write, path_.string());
  mark_as_database(path_);
  require(sqlite3_db_readonly(database_->handle(), "main") == 0,
          fmt::format("{}: the file cannot be written to", path_.string()));
  check_schema(*database_);
  if (fs::file_size(path_, ignored) <= checked_size) {
    const std::string found = database_->text_of("PRAGMA quick_check(1)");
    if (found != "ok") throw DamagedStore(fmt::format("{}: the store is damaged: {}", path_.string(), found));
  }
}

void StudyStore::Implementation::start_session(const StoredOrigin& origin, bool resumed) {
  const NumberedPlan there = current_plan(*database_);
  require_same_columns(*database_, there.plan, plan_);
  // All plans of a database file share its table of columns. The columns keep the names that the version of the program which
  // created the file gave them.
  plan_.columns = there.plan.columns;
  number_ = number_of_plan(*database_, plan_.text);
  read_done();
  database_->run(fmt::format("PRAGMA journal_mode = {}; PRAGMA synchronous = FULL", journal_at(path_)));
  Transaction transaction(*database_);
  if (number_ == 0) number_ = insert_plan(*database_, plan_);
  if (resumed) static_cast<void>(insert_session(*database_, number_, origin));
  has_earlier_ = database_->number_of("SELECT count(*) FROM study") > 1;
  if (has_earlier_) database_->run("CREATE INDEX IF NOT EXISTS by_content ON results(content)");
  transaction.commit();
  begin_writing();
  if (!has_earlier_) return;
  earlier_rows_ = database_->number_of(fmt::format("SELECT ifnull(sum(rows), 0) FROM tally WHERE plan != {}", number_));
  prepare_finding();
}

// Reads which points of the study have rows already. It runs before anything is written, so that a damaged database file is not
// changed.
void StudyStore::Implementation::read_done() {
  done_.resize(static_cast<std::size_t>(plan_.points));
  if (number_ == 0) return;
  std::error_code ignored;
  const bool small = fs::file_size(path_, ignored) <= checked_size;
  RowReader rows(*database_, {.number = number_, .plan = plan_}, small ? RowReader::Of::rows : RowReader::Of::points);
  while (rows.next()) done_[static_cast<std::size_t>(rows.row().point)] = true;
}

void StudyStore::Implementation::begin_writing() {
  rows_.emplace(*database_, number_, plan_.columns);
  tally_.emplace(*database_, number_, database_->number_of("SELECT max(session) FROM session"));
  log_ = fs::path(sqlite3_db_filename(database_->handle(), "main")).string() + "-wal";
  log_number_ = internal::number_of(log_);
  if (!log_number_) log_.clear();
}

void StudyStore::Implementation::prepare_finding() {
  earlier_ = std::make_unique<const Database>(fs::canonical(path_), Access::recover, path_.string());
  find_.emplace(*earlier_,
                select_rows(*earlier_, plan_.columns) + " WHERE content = ? AND plan != ? ORDER BY plan, point LIMIT 1");
}

StudyStore::Implementation::~Implementation() {
  try {
    close();
  } catch (...) {  // errors are ignored here, since close() reports errors, which the caller should call
  }
}

void StudyStore::Implementation::let_go() {
  find_.reset();
  earlier_.reset();
  rows_.reset();
  tally_.reset();
  database_.reset();
}

// Saves the content of a removed database file, and later rows, to another file: a removed file remains writable until the
// process closes it, and is then lost.
void StudyStore::Implementation::keep_in_place() {
  if (!rescued_.empty()) return;
  if (!database_->is_at(path_)) {
    database_->leave_log();
    if (earlier_) earlier_->leave_log();
    move_to_rescue(path_.string());
  } else if (!log_.empty() && internal::number_of(log_) != log_number_) {
    move_to_rescue(log_.string());
  }
}

void StudyStore::Implementation::move_to_rescue(const std::string& what) {
  const std::string said = fmt::format("{}: was removed, moved or replaced while it was written", what);
  const fs::path rescue = copied_to_rescue(*database_, path_, said);
  auto rescued = std::make_unique<Database>(rescue, Access::write, rescue.string());
  rescued->run(fmt::format("PRAGMA journal_mode = {}; PRAGMA synchronous = FULL", journal_at(rescue)));
  rows_.reset();
  tally_.reset();
  database_ = std::move(rescued);
  begin_writing();
  rescued_ = fmt::format("{}; all of its rows, and those computed since, are in the store {}", said, rescue.string());
}

// Throws errors of the writing thread that have occurred since the last call of this function; the writing thread then writes
// the waiting rows again.
void StudyStore::Implementation::rethrow_failure() {
  for (std::exception_ptr* told : {&failure_, &contradiction_}) {
    if (!*told) continue;
    for_writer_.notify_one();
    std::rethrow_exception(std::exchange(*told, nullptr));
  }
  if (!lost_.empty()) throw OutputLost(lost_);
}

void StudyStore::Implementation::add(StoredRow row) {
  const bool fits =
      row.point >= 0 && row.point < plan_.points && plan_.shard.contains(row.point) && row.values.size() == plan_.columns.size();
  require(fits,
          fmt::format("{}: a row of point {} with {} values does not belong to a plan of {} points and {} columns, part {}/{}",
                      path_.string(), row.point, row.values.size(), plan_.points, plan_.columns.size(), plan_.shard.index,
                      plan_.shard.count));
  std::unique_lock lock(mutex_);
  for_callers_.wait(lock, [&] { return waiting_.size() < rows_that_wait || failure_ != nullptr; });
  if (waiting_.empty())
    due_ = std::chrono::steady_clock::now() +
           std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(seconds_per_commit));
  waiting_.push_back(std::move(row));
  if (waiting_.size() == 1 || waiting_.size() >= rows_per_commit) for_writer_.notify_one();
  rethrow_failure();
}

void StudyStore::Implementation::flush() {
  std::unique_lock lock(mutex_);
  failure_ = nullptr;  // rows that could not be written are written again now
  hurried_ = true;
  for_writer_.notify_one();
  for_callers_.wait(lock, [&] { return failure_ != nullptr || (waiting_.empty() && !committing_); });
  hurried_ = false;
  rethrow_failure();
}

void StudyStore::Implementation::close() {
  if (!database_) return;
  std::exception_ptr failure;
  if (writer_.joinable()) {
    try {
      flush();
    } catch (...) {
      failure = std::current_exception();
    }
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
      for_writer_.notify_one();
    }
    writer_.join();
  }
  try {
    end_log();
  } catch (...) {
    if (!failure) failure = std::current_exception();
  }
  let_go();
  lock_.reset();
  if (failure) std::rethrow_exception(failure);
}

// Merges the write-ahead log into the database file, so that no second file remains.
void StudyStore::Implementation::end_log() {
  const bool was_told = !rescued_.empty();
  if (rows_) keep_in_place();
  find_.reset();
  earlier_.reset();
  // Do not wait for locks: if another process is reading, that process removes the log when it ends.
  sqlite3_busy_timeout(database_->handle(), 0);
  sqlite3_exec(database_->handle(), "PRAGMA journal_mode = DELETE", nullptr, nullptr, nullptr);
  log_.clear();
  if (rows_) keep_in_place();
  if (!was_told && !rescued_.empty()) throw OutputLost(rescued_);
}

// Runs the writing thread. After a failure the thread waits until another thread calls the store, which reports the failure.
void StudyStore::Implementation::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    for_writer_.wait(lock, [&] { return stopping_ || (!failure_ && !waiting_.empty()); });
    if (stopping_) return;
    const auto enough = [&] { return stopping_ || hurried_ || waiting_.size() >= rows_per_commit; };
    for_writer_.wait_until(lock, due_, enough);
    if (stopping_) return;
    commit_batch(lock);
  }
}

void StudyStore::Implementation::commit_batch(std::unique_lock<std::mutex>& lock) {
  std::vector<StoredRow> rows = std::exchange(waiting_, {});
  committing_ = true;
  lock.unlock();
  std::exception_ptr failure, contradiction;
  try {
    keep_in_place();
    commit(rows);
  } catch (const Contradiction&) {
    contradiction = std::current_exception();
  } catch (const DamagedStore& error) {
    failure = std::make_exception_ptr(OutputLost(error.what()));
  } catch (...) {
    failure = std::current_exception();
  }
  try {
    if (!failure) keep_in_place();
  } catch (...) {
    failure = std::current_exception();
    rows.clear();  // the database file holds these rows now
  }
  lock.lock();
  committing_ = false;
  lost_ = rescued_;
  if (failure) waiting_.insert(waiting_.begin(), std::make_move_iterator(rows.begin()), std::make_move_iterator(rows.end()));
  if (failure) failure_ = failure;
  if (contradiction) contradiction_ = contradiction;
  for_callers_.notify_all();
}

// Writes rows to the database file. A row that contradicts the file is not written, and is reported.
void StudyStore::Implementation::commit(const std::vector<StoredRow>& rows) {
  std::optional<Contradiction> contradiction;
  std::map<std::string, std::int64_t> by_status;
  Transaction transaction(*database_);
  for (const StoredRow& row : rows) {
    try {
      if (rows_->write(row)) ++by_status[row.status];
    } catch (const Contradiction& error) {
      contradiction = error;
    }
  }
  tally_->note(by_status);
  transaction.commit();
  if (contradiction) throw Contradiction(*contradiction);
}

StudyStore::StudyStore(const fs::path& path, const StoredPlan& plan, const StoredOrigin& origin, Opening opening)
    : implementation_(std::make_unique<Implementation>(path, plan, origin, opening)) {}

StudyStore::~StudyStore() = default;

const fs::path& StudyStore::path() const { return implementation_->path_; }

std::vector<bool> StudyStore::done() const { return implementation_->done_; }

bool StudyStore::has_earlier_plans() const { return implementation_->has_earlier_; }

std::int64_t StudyStore::earlier_rows() const { return implementation_->earlier_rows_; }

std::optional<StoredRow> StudyStore::find(const ContentKey& content) const {
  if (!implementation_->has_earlier_) return std::nullopt;
  const std::lock_guard lock(implementation_->finding_);
  Statement& find = *implementation_->find_;
  find.reset();
  find.bind(1, bytes_of(content)).bind(2, implementation_->number_);
  if (!find.step()) return std::nullopt;
  StoredRow row = row_in(*implementation_->earlier_, find, implementation_->plan_.columns.size());
  find.reset();
  return row;
}

void StudyStore::add(StoredRow row) { implementation_->add(std::move(row)); }

void StudyStore::flush() { implementation_->flush(); }

void StudyStore::close() { implementation_->close(); }

}  // namespace softland
