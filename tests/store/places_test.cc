// Tests all that may be in the place of a store, and the answer to each.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <functional>

#include "base/output_lost.h"
#include "base/require.h"
#include "store/place.h"
#include "store/tables.h"
#include "tests/store/sample.h"
#include "tests/support/access_rights.h"

namespace softland::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using Opening = StudyStore::Opening;
namespace fs = std::filesystem;

using Place = WithStore;

void write_at(const fs::path& file, long place, const std::string& bytes) {
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekp(place);
  stream << bytes;
}

std::string content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void run_sql(const fs::path& file, const char* sql) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(database, sql, nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(database);
  sqlite3_close(database);
}

// Expects that the file is neither read nor continued, for this reason, and stays unchanged.
void expect_refused(const fs::path& file, const std::string& reason) {
  const bool regular = fs::is_regular_file(file);
  const std::string before = regular ? content_of(file) : "";
  EXPECT_FALSE(is_store(file)) << file;
  EXPECT_THAT([&] { StudyReader{file}; }, ThrowsMessage<InvalidInput>(AllOf(HasSubstr(file.string()), HasSubstr(reason))));
  EXPECT_THAT([&] { StudyStore(file, plan_of(10), origin(), Opening::resume); }, ThrowsMessage<InvalidInput>(HasSubstr(reason)));
  EXPECT_THAT([&] { StudyStore(file, plan_of(10), origin(), Opening::fresh); },
              ThrowsMessage<InvalidInput>(HasSubstr("exists already")));
  EXPECT_EQ(regular ? content_of(file) : "", before);
}

TEST_F(Place, OfAFileThatIsNotAStoreIsRefused) {
  expect_refused(write("empty", ""), "is empty (0 bytes)");
  expect_refused(write("text", "title = \"a scene\"\n"), "is not a store of softland");
  expect_refused(write("long text", std::string(5000, 'x')), "is not a store of softland");
  run_sql(path("other"), "CREATE TABLE t(x)");
  expect_refused(path("other"), "is a database of SQLite, but not a store of softland");
  fs::create_directory(path("folder"));
  expect_refused(path("folder"), "is a folder");
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  expect_refused(path("pipe"), "must be a regular file");
  expect_refused("/dev/zero", "must be a regular file");
  EXPECT_FALSE(is_store(path("nothing")));
  EXPECT_THAT([&] { StudyReader{path("nothing")}; }, ThrowsMessage<InvalidInput>(HasSubstr("the file does not exist")));
  EXPECT_THAT([&] { StudyStore(path("no folder/a"), plan_of(10), origin(), Opening::resume); },
              ThrowsMessage<InvalidInput>(HasSubstr("the folder of the store cannot be written to: No such file")));
}

TEST_F(Place, OfAStoreIsRecognised) {
  make_store(file, 10);
  EXPECT_TRUE(is_store(file));
  fs::create_symlink(file, path("link"));
  EXPECT_TRUE(is_store(path("link")));
  EXPECT_EQ(rows_in(path("link")).size(), 10u);
}

TEST_F(Place, WithNamesThatSqliteWouldReadAsSomethingElse) {
  for (const char* name : {":memory:", "file:a?mode=memory", "100%41#?.sqlite", "-x", "a'b\"c"}) {
    make_store(path(name), 10);
    EXPECT_TRUE(fs::exists(path(name)));
    EXPECT_EQ(rows_in(path(name)).size(), 10u) << name;
  }
}

TEST_F(Place, OfAStoreOfALaterSchemaIsRefused) {
  make_store(file, 10);
  run_sql(file, "PRAGMA user_version = 3");
  const std::string before = content_of(file);
  EXPECT_THAT([&] { StudyReader{file}; },
              ThrowsMessage<InvalidInput>(
                  HasSubstr("was written by a later version of softland (store schema 3; this version reads up to 2)")));
  EXPECT_THAT([&] { StudyStore(file, plan_of(10), origin(), Opening::resume); },
              ThrowsMessage<InvalidInput>(HasSubstr("a later version of softland")));
  EXPECT_EQ(content_of(file), before);
}

TEST_F(Place, OfADamagedStoreKeepsItAndACopy) {
  make_store(file, 3000);
  write_at(file, static_cast<long>(fs::file_size(file)) / 2, std::string(20000, '\xAB'));
  const std::string before = content_of(file);
  for (int again = 0; again < 2; ++again) {
    EXPECT_THAT(
        [&] { StudyStore(file, plan_of(3000), origin(), Opening::resume); },
        ThrowsMessage<InvalidInput>(AllOf(HasSubstr("the store is damaged"), HasSubstr("study.sqlite.damaged is a copy"))));
    EXPECT_EQ(content_of(file), before);
    EXPECT_EQ(content_of(path("study.sqlite.damaged")), before);
    EXPECT_THAT(names_in(TemporaryFolder::path()), ElementsAre("study.sqlite", "study.sqlite.damaged"));
  }
  EXPECT_THAT([&] { static_cast<void>(rows_in(file)); }, ThrowsMessage<InvalidInput>(HasSubstr("the store is damaged")));
}

TEST_F(Place, OfAStoreThatWasCutShortIsRefused) {
  make_store(file, 3000);
  fs::resize_file(file, 8192);
  EXPECT_THAT([&] { StudyStore(file, plan_of(3000), origin(), Opening::resume); },
              ThrowsMessage<InvalidInput>(HasSubstr("the store is damaged")));
  EXPECT_THAT([&] { static_cast<void>(rows_in(file)); }, ThrowsMessage<InvalidInput>(HasSubstr("the store is damaged")));
}

TEST_F(Place, OfAStoreWithMissingTablesIsRefused) {
  make_store(file, 10);
  run_sql(file, "DROP TABLE tally");
  EXPECT_THAT([&] { StudyReader{file}; }, ThrowsMessage<InvalidInput>(HasSubstr("damaged: tables are missing")));
  EXPECT_THAT([&] { StudyStore(file, plan_of(10), origin(), Opening::resume); },
              ThrowsMessage<InvalidInput>(HasSubstr("is a copy")));
}

// Expects that the file is neither read nor continued, with a message that names file and fault.
void expect_damaged(const fs::path& file, std::int64_t points, const std::string& reason) {
  const auto is_damaged =
      ThrowsMessage<InvalidInput>(AllOf(HasSubstr(file.string() + ": the store is damaged"), HasSubstr(reason)));
  EXPECT_THAT([&] { static_cast<void>(rows_in(file)); }, is_damaged);
  EXPECT_THAT([&] { StudyStore(file, plan_of(points), origin(), Opening::resume); }, is_damaged);
}

TEST_F(Place, OfAStoreWhoseNumbersCannotBeIsRefused) {
  for (const auto& [sql, reason] :
       {std::pair{"UPDATE study SET shards = 0", "it holds the part 1/0 of its plan"},
        std::pair{"UPDATE study SET shards = -3", "it holds the part 1/-3 of its plan"},
        std::pair{"UPDATE study SET shard = 4294967297, shards = 4294967297", "the part 4294967297/"},
        std::pair{"UPDATE study SET points = 0", "its plan has 0 points"},
        std::pair{"UPDATE study SET points = 9223372036854775807", "its plan has 9223372036854775807"},
        std::pair{"UPDATE study SET points = 11", "its plan has changed since it was written"},
        std::pair{"UPDATE columns SET unit = 'mm' WHERE unit = 'm'", "its plan has changed"},
        std::pair{"ALTER TABLE results DROP COLUMN bounce_count", "no such column"},
        std::pair{"ALTER TABLE study DROP COLUMN seed", "no such column: seed"},
        std::pair{"DELETE FROM results WHERE point = 9", "it has 9 rows, and 10 were written"},
        std::pair{"UPDATE tally SET status = 'dome' WHERE status = 'done'", "0 rows are dome, and 9 were written"},
        std::pair{"UPDATE results SET bounce_count = 3 WHERE point = 4", "the row of point 4 has changed"},
        std::pair{"UPDATE results SET status = 'lost' WHERE point = 4", "the row of point 4 has changed"},
        std::pair{"UPDATE results SET point = 77 WHERE point = 4", "the row of point 77 has changed"}}) {
    fs::remove(file);
    make_store(file, 10);
    run_sql(file, sql);
    const auto is_damaged =
        ThrowsMessage<InvalidInput>(AllOf(HasSubstr("study.sqlite: the store is damaged: "), HasSubstr(reason)));
    EXPECT_THAT([&] { static_cast<void>(rows_in(file)); }, is_damaged) << sql;
  }
}

bool passes_check_of_sqlite(const fs::path& file) {
  try {
    return internal::Database(file, internal::Access::read_only, "study.sqlite").text_of("PRAGMA quick_check(1)") == "ok";
  } catch (const InvalidInput&) {
    return false;
  }
}

TEST_F(Place, WithAPageOfItsNeighbourIsRefused) {
  make_store(path("sound.sqlite"), 1000);
  const std::string sound = content_of(path("sound.sqlite"));
  constexpr std::size_t page = 4096;
  int unnoticed_by_sqlite = 0;
  for (std::size_t k = 1; (k + 2) * page <= sound.size(); ++k) {
    const std::string neighbour = sound.substr(k * page, page);
    static_cast<void>(write("study.sqlite", std::string(sound).replace((k + 1) * page, page, neighbour)));
    unnoticed_by_sqlite += passes_check_of_sqlite(file) ? 1 : 0;
    EXPECT_THAT([&] { static_cast<void>(rows_in(file)); }, ThrowsMessage<InvalidInput>(HasSubstr("the store is damaged"))) << k;
    EXPECT_THAT([&] { StudyStore(file, plan_of(1000), origin(), Opening::resume); },
                ThrowsMessage<InvalidInput>(HasSubstr("study.sqlite.damaged")))
        << k;
    fs::remove(path("study.sqlite.damaged"));
  }
  EXPECT_GT(unnoticed_by_sqlite, 0);
}

TEST_F(Place, WithAnyByteChangedGivesItsRowsOrIsRefused) {
  make_store(path("sound.sqlite"), 40);
  const std::string sound = content_of(path("sound.sqlite")), rows = dump(path("sound.sqlite"));
  int refused = 0;
  for (std::size_t k = 0; k < sound.size(); k += sound[k] == 0 ? 331 : 31) {
    std::string changed = sound;
    changed[k] = static_cast<char>(changed[k] ^ (1 << (k % 8)));
    static_cast<void>(write("study.sqlite", changed));
    try {
      const std::string found = dump(file);
      EXPECT_EQ(found, rows) << "byte " << k;
    } catch (const InvalidInput&) {
      ++refused;
    }
    try {
      StudyStore(file, plan_of(40), origin(), Opening::resume).close();
      EXPECT_EQ(dump(file), rows) << "byte " << k;
    } catch (const InvalidInput&) {
    }
    for (const std::string& name : names_in(TemporaryFolder::path())) {
      if (name != "sound.sqlite") fs::remove(path(name));
    }
  }
  EXPECT_GT(refused, 50);
}

TEST_F(Place, OfAStoreOfTheFirstSchemaIsReadAndGoneOnWith) {
  {
    StudyStore store(file, plan_of(100), origin(), Opening::fresh);
    for (int point = 0; point < 60; ++point) store.add(row_of(point));
  }
  run_sql(file,
          "ALTER TABLE results DROP COLUMN checksum; ALTER TABLE study DROP COLUMN checksum; PRAGMA user_version = 1; VACUUM");
  EXPECT_EQ(rows_in(file).size(), 60u);
  {
    StudyStore store(file, plan_of(100), origin(), Opening::resume);
    for (int point = 60; point < 100; ++point) store.add(row_of(point));
    store.close();
  }
  make_store(path("whole.sqlite"), 100);
  EXPECT_EQ(dump(file), dump(path("whole.sqlite")));
  static_cast<void>(merge_studies({file}, path("merged.sqlite"), origin()));
  EXPECT_EQ(dump(path("merged.sqlite")), dump(path("whole.sqlite")));
  run_sql(file, "DELETE FROM results WHERE point = 9");
  expect_damaged(file, 100, "it has 99 rows, and 100 were written");
  // Another plan with the same columns.
  fs::remove(file);
  make_store(file, 50);
  run_sql(file, "ALTER TABLE results DROP COLUMN checksum; ALTER TABLE study DROP COLUMN checksum; PRAGMA user_version = 1");
  StudyStore finer(file, plan_of(60), origin(), Opening::resume);
  EXPECT_TRUE(finer.find(row_of(7).content));
}

TEST_F(Place, OfACompanionOfAStoreIsNoPlaceForOne) {
  make_store(file, 10);
  make_store(path("part.sqlite"), 10);
  const std::string before = content_of(file);
  for (const char* ending : {"-wal", "-shm", "-journal", ".lock"}) {
    const fs::path companion = file.string() + ending;
    const auto is_refused = ThrowsMessage<InvalidInput>(
        AllOf(HasSubstr(companion.string() + ": is the name of a file that the store "), HasSubstr("must not be overwritten")));
    EXPECT_THAT([&] { StudyStore(companion, plan_of(10), origin(), Opening::fresh); }, is_refused);
    EXPECT_THAT([&] { StudyStore(companion, plan_of(10), origin(), Opening::resume); }, is_refused);
    EXPECT_THAT([&] { static_cast<void>(merge_studies({path("part.sqlite")}, companion, origin())); }, is_refused);
    EXPECT_FALSE(fs::exists(companion));
  }
  EXPECT_EQ(content_of(file), before);
}

TEST_F(Place, WithTheLogOfAStoreThatIsGoneIsNotTaken) {
  make_store(path("part.sqlite"), 10);
  for (const char* ending : {"-wal", "-shm", "-journal"}) {
    const std::string left = write(std::string("study.sqlite") + ending, "all that there is of it");
    const auto is_refused = ThrowsMessage<InvalidInput>(AllOf(HasSubstr(left), HasSubstr("move it or name another store")));
    EXPECT_THAT([&] { StudyStore(file, plan_of(10), origin(), Opening::fresh); }, is_refused);
    EXPECT_THAT([&] { StudyStore(file, plan_of(10), origin(), Opening::resume); }, is_refused);
    EXPECT_THAT([&] { static_cast<void>(merge_studies({path("part.sqlite")}, file, origin())); }, is_refused);
    EXPECT_EQ(content_of(left), "all that there is of it");
    EXPECT_FALSE(fs::exists(file));
    fs::remove(left);
  }
}

TEST_F(Place, TakesOneWriterWhoSaysItsName) {
  EXPECT_FALSE(writer_of(file));
  {
    StudyStore store(file, plan_of(10), origin(), Opening::fresh);
    ASSERT_TRUE(writer_of(file));
    EXPECT_THAT(*writer_of(file),
                AllOf(HasSubstr(fmt::format("process {} on ", ::getpid())), HasSubstr("softland explore a.toml")));
    fs::create_symlink(file, path("link"));
    for (const std::string& name : {file.string(), path("link")}) {
      EXPECT_THAT([&] { StudyStore(name, plan_of(10), origin(), Opening::resume); },
                  ThrowsMessage<InvalidInput>(
                      AllOf(HasSubstr("another run writes to this store (process "), HasSubstr("explore a.toml)"))));
    }
  }
  EXPECT_FALSE(writer_of(file));
  StudyStore(file, plan_of(10), origin(), Opening::resume).close();
}

TEST_F(Place, WithALockOfOneThatDiedIsFree) {
  make_store(file, 10);
  const std::string lock = write("study.sqlite.lock", "process 1 on elsewhere since 2026-01-31 12:00:00 UTC: softland explore");
  EXPECT_FALSE(writer_of(file));
  StudyStore(file, plan_of(10), origin(), Opening::resume).close();
  EXPECT_FALSE(fs::exists(lock));
}

TEST_F(Place, UnderTwoNamesIsNotWritten) {
  make_store(file, 10);
  fs::create_hard_link(file, path("other name"));
  EXPECT_THAT([&] { StudyStore(file, plan_of(10), origin(), Opening::resume); },
              ThrowsMessage<InvalidInput>(HasSubstr("must not have a second name")));
}

TEST_F(Place, ThatCannotBeWrittenToIsReadWithoutLitter) {
  make_store(file, 100);
  make_store(path("logged"), 100);
  // A writer leaves the store like this if its last reader ends after it: without a log, but with a header that allows one.
  run_sql(path("logged"), "PRAGMA journal_mode = WAL");
  fs::remove(path("logged-wal"));
  fs::remove(path("logged-shm"));
  const auto before = names_in(TemporaryFolder::path());
  fs::permissions(TemporaryFolder::path(), fs::perms::owner_read | fs::perms::owner_exec);
  expect_where_access_rights_bind([&] {
    EXPECT_EQ(rows_in(file).size(), 100u);
    EXPECT_EQ(rows_in(path("logged")).size(), 100u);
    EXPECT_THAT([&] { StudyStore(file, plan_of(100), origin(), Opening::resume); },
                ThrowsMessage<InvalidInput>(HasSubstr("the folder of the store cannot be written to: Permission denied")));
    EXPECT_THAT([&] { StudyStore(path("new"), plan_of(100), origin(), Opening::fresh); },
                ThrowsMessage<InvalidInput>(HasSubstr("Permission denied")));
  });
  fs::permissions(TemporaryFolder::path(), fs::perms::owner_all);
  EXPECT_EQ(names_in(TemporaryFolder::path()), before);
}

TEST_F(Place, OfAFileThatMayNotBeWrittenOrReadIsRefused) {
  make_store(file, 100);
  expect_where_access_rights_bind([&] {
    fs::permissions(file, fs::perms::owner_read);
    EXPECT_THAT([&] { StudyStore(file, plan_of(100), origin(), Opening::resume); },
                ThrowsMessage<InvalidInput>(HasSubstr("cannot be written to")));
    EXPECT_EQ(rows_in(file).size(), 100u);
    fs::permissions(file, fs::perms::none);
    EXPECT_THAT([&] { StudyReader{file}; }, ThrowsMessage<InvalidInput>(HasSubstr("Permission denied")));
  });
}

// A process that dies within a transaction of a rollback journal, such as one that is killed while it closes a store.
void leave_hot_journal(const fs::path& file) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    sqlite3* database = nullptr;
    sqlite3_open(file.c_str(), &database);
    sqlite3_exec(database, "PRAGMA cache_size = 2; BEGIN IMMEDIATE; UPDATE results SET status = 'lost'", nullptr, nullptr,
                 nullptr);
    sqlite3_db_cacheflush(database);
    ::raise(SIGKILL);
  }
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  ASSERT_GT(fs::file_size(file.string() + "-journal"), 0u);
}

TEST_F(Place, WithTheJournalOfOneThatDiedIsPutInOrder) {
  make_store(file, 3000);
  const std::string before = dump(file);
  leave_hot_journal(file);
  EXPECT_NE(content_of(file).find("lost"), std::string::npos);  // the file has a change to roll back
  fs::copy(TemporaryFolder::path(), path("copy"));
  fs::permissions(path("copy"), fs::perms::owner_read | fs::perms::owner_exec);
  expect_where_access_rights_bind([&] {
    EXPECT_THAT([&] { StudyReader{path("copy/study.sqlite")}; },
                ThrowsMessage<InvalidInput>(HasSubstr("copy it with its -journal")));
  });
  fs::permissions(path("copy"), fs::perms::owner_all);
  EXPECT_EQ(dump(file), before);
  EXPECT_EQ(dump(fs::path(path("copy/study.sqlite"))), before);
  StudyStore(path("copy/study.sqlite"), plan_of(3000), origin(), Opening::resume).close();
  EXPECT_THAT(names_in(path("copy")), ElementsAre("study.sqlite"));
}

TEST_F(Place, OnAFullDiskLosesNoAcceptedRow) {
  // A limit on the file size simulates a full disk, in a separate process.
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    [&]() noexcept {
      ::signal(SIGXFSZ, SIG_IGN);
      StudyStore store(file, plan_of(20000), origin(), Opening::fresh);
      for (int point = 0; point < 100; ++point) store.add(row_of(point));
      store.flush();
      rlimit limit{};
      ::getrlimit(RLIMIT_FSIZE, &limit);
      const rlim_t before = std::exchange(limit.rlim_cur, 100'000);
      ::setrlimit(RLIMIT_FSIZE, &limit);
      for (int point = 100; point < 5000; ++point) {
        try {
          store.add(row_of(point));
        } catch (const OutputLost& lost) {
          EXPECT_THAT(lost.what(), HasSubstr("study.sqlite: "));
        }
      }
      EXPECT_THROW(store.flush(), OutputLost);
      EXPECT_EQ(rows_in(file).size() % 100, 0u);
      EXPECT_LT(rows_in(file).size(), 5000u);
      limit.rlim_cur = before;  // there is room again: accepted rows are still there
      ::setrlimit(RLIMIT_FSIZE, &limit);
      store.flush();
      store.close();
    }();
    ::_exit(::testing::Test::HasFailure() ? 1 : 0);
  }
  int status = -1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0) << "see the failures above";
  make_store(path("whole.sqlite"), 5000);
  EXPECT_EQ(dump(file), dump(path("whole.sqlite")));
}

// Writes rows until the store reports that its file was replaced, and returns the message.
std::string said_while_writing(StudyStore& store, std::int64_t from, std::int64_t to) {
  for (std::int64_t point = from; point < to; ++point) {
    try {
      store.add(row_of(point));
      store.flush();
    } catch (const OutputLost& lost) {
      return lost.what();
    }
  }
  return "nothing";
}

TEST_F(Place, ThatIsRemovedOrReplacedDuringWritingLosesNoRow) {
  const auto replaced_by_another = [this] {
    fs::remove(file);
    fs::remove(file.string() + "-wal");
    fs::remove(file.string() + "-shm");
    make_store(path("another.sqlite"), 7);
    fs::rename(path("another.sqlite"), file);
  };
  const std::vector<std::function<void()>> events{
      [this] { fs::remove(file); }, [this] { fs::rename(file, path("moved.sqlite")); }, replaced_by_another,
      [this] { fs::remove(file), static_cast<void>(write("study.sqlite", "a text")); },
      [this] { fs::remove(file.string() + "-wal"); }};
  make_store(path("whole.sqlite"), 400);
  for (std::size_t event = 0; event < events.size(); ++event) {
    for (const auto& entry : fs::directory_iterator(TemporaryFolder::path())) {
      if (entry.path().filename() != "whole.sqlite") fs::remove(entry.path());
    }
    StudyStore store(file, plan_of(400), origin(), Opening::fresh);
    for (int point = 0; point < 100; ++point) store.add(row_of(point));
    store.flush();
    for (int point = 100; point < 200; ++point) store.add(row_of(point));
    events[event]();
    const std::string before = event == 2 || event == 3 ? content_of(file) : "";
    const std::string said = said_while_writing(store, 200, 202);
    EXPECT_THAT(said, AllOf(HasSubstr("study.sqlite"), HasSubstr("was removed, moved or replaced while it was written"),
                            HasSubstr("study.sqlite.rescued")))
        << event;
    // Threads that were computing meanwhile get the error when they add their rows.
    for (int point = 201; point < 400; ++point) EXPECT_THROW(store.add(row_of(point)), OutputLost);
    EXPECT_THROW(store.close(), OutputLost);
    EXPECT_EQ(dump(file.string() + ".rescued"), dump(path("whole.sqlite"))) << event;
    EXPECT_EQ(event == 2 || event == 3 ? content_of(file) : "", before) << "what stands there now is somebody else's";
    StudyStore(file.string() + ".rescued", plan_of(400), origin(), Opening::resume).close();
  }
}

TEST_F(Place, ThatIsTakenBeforeTheStoreIsClosedLosesNoRow) {
  StudyStore store(file, plan_of(100), origin(), Opening::fresh);
  for (int point = 0; point < 100; ++point) store.add(row_of(point));
  store.flush();
  fs::remove(file);
  make_store(path("another.sqlite"), 7);
  run_sql(path("another.sqlite"), "PRAGMA journal_mode = WAL");
  fs::rename(path("another.sqlite"), file);
  fs::remove(file.string() + "-wal");
  const std::string log = write("study.sqlite-wal", "");
  EXPECT_THAT([&] { store.close(); }, ThrowsMessage<OutputLost>(HasSubstr("study.sqlite.rescued")));
  EXPECT_TRUE(fs::exists(log)) << "the log of the other store";
  EXPECT_EQ(rows_in(file).size(), 7u);
  make_store(path("whole.sqlite"), 100);
  EXPECT_EQ(dump(file.string() + ".rescued"), dump(path("whole.sqlite")));
}

TEST_F(Place, WhoseFolderIsTakenIsRescuedElsewhere) {
  fs::create_directory(path("folder"));
  StudyStore store(path("folder/study.sqlite"), plan_of(100), origin(), Opening::fresh);
  for (int point = 0; point < 100; ++point) store.add(row_of(point));
  store.flush();
  fs::remove_all(path("folder"));
  const fs::path before = fs::current_path();
  fs::current_path(TemporaryFolder::path());
  EXPECT_THAT([&] { store.close(); }, ThrowsMessage<OutputLost>(HasSubstr(path("study.sqlite.rescued"))));
  fs::current_path(before);
  EXPECT_EQ(rows_in(path("study.sqlite.rescued")).size(), 100u);
}

TEST_F(Place, HeldByAnotherProgramIsReported) {
  make_store(file, 10);
  sqlite3* other = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &other), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(other, "BEGIN EXCLUSIVE", nullptr, nullptr, nullptr), SQLITE_OK);
  const internal::Database database(file, internal::Access::write, "study.sqlite");
  sqlite3_busy_timeout(database.handle(), 1);
  EXPECT_THAT([&] { internal::check_schema(database); },
              ThrowsMessage<InvalidInput>(HasSubstr("another program has locked the file")));
  sqlite3_close(other);
}

TEST(Journal, IsNoSharedMemoryWhereSeveralMachinesSeeTheFile) {
  EXPECT_STREQ(internal::journal_on(0xEF53), "WAL");                                                // ext4
  EXPECT_STREQ(internal::journal_on(0x01021994), "WAL");                                            // tmpfs
  EXPECT_STREQ(internal::journal_on(0x6969), "TRUNCATE");                                           // NFS
  EXPECT_STREQ(internal::journal_on(0x0BD00BD0), "TRUNCATE");                                       // Lustre
  EXPECT_STREQ(internal::journal_on(static_cast<long>(static_cast<int>(0xFF534D42))), "TRUNCATE");  // CIFS, sign-extended
}

}  // namespace
}  // namespace softland::test
