#include "base/write_whole.h"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <fstream>
#include <iterator>

#include "base/companion.h"
#include "base/output_lost.h"
#include "base/read_file.h"
#include "base/require.h"
#include "tests/support/access_rights.h"
#include "tests/support/temporary_folder.h"

namespace softland {
namespace {

using test::TemporaryFolder;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

std::string refusal(const fs::path& path, std::string_view words) {
  try {
    write_whole(path, words);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "was not refused";
}

std::string loss(const fs::path& path, std::string_view words) {
  try {
    write_whole(path, words);
  } catch (const OutputLost& error) {
    return error.what();
  }
  return "was not lost";
}

TEST(WriteWhole, WritesReplacesAndLeavesNothingElse) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "with space" / "result.json";
  fs::create_directory(file.parent_path());
  const std::string binary("one\0two\n", 8);
  write_whole(file, binary);
  EXPECT_EQ(content(file), binary);
  write_whole(file, "");
  EXPECT_EQ(content(file), "");
  EXPECT_EQ(entries(file.parent_path()), 1u);
}

TEST(WriteWhole, KeepsTheRightsOfTheFileItReplaces) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "a";
  write_whole(file, "old");
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  write_whole(file, "new");
  EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST(WriteWhole, NamesPathAndReasonWhenThereIsNoFolder) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "missing" / "report.html";
  EXPECT_THAT(refusal(file, "x"), HasSubstr(file.string()));
  EXPECT_THAT(refusal(file, "x"), HasSubstr("No such file or directory"));
}

TEST(WriteWhole, RemovesItsTemporaryFileWhenTheTargetIsAFolder) {
  const TemporaryFolder folder;
  const fs::path target = folder.path() / "taken";
  fs::create_directory(target);
  EXPECT_THAT(refusal(target, "x"), HasSubstr("cannot replace it: Is a directory"));
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(WriteWhole, KeepsTheOldFileWhenTheFolderIsReadOnly) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "kept";
  write_whole(file, "old");
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  test::expect_where_access_rights_bind([&] { EXPECT_THAT(refusal(file, "new"), HasSubstr("Permission denied")); });
  fs::permissions(folder.path(), fs::perms::owner_all);
  EXPECT_EQ(content(file), "old");
}

TEST(WriteWhole, KeepsTheOldFileWhenThereIsNoRoomForTheNewOne) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "kept";
  write_whole(file, "old");
  // A limit on the file size simulates a full disk: write() writes fewer bytes, then fails.
  struct rlimit usual {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &usual), 0);
  struct rlimit tight = usual;
  tight.rlim_cur = 4096;
  const auto before = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &tight), 0);
  const std::string message = loss(file, std::string(10'000, 'x'));
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &usual), 0);
  std::signal(SIGXFSZ, before);
  EXPECT_THAT(message, HasSubstr("kept: cannot write: File too large"));
  EXPECT_EQ(content(file), "old");
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(WriteWhole, LeavesALinkALink) {
  const TemporaryFolder folder;
  write_whole(folder.path() / "file", "old");
  fs::create_symlink("file", folder.path() / "link");
  write_whole(folder.path() / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
  EXPECT_EQ(content(folder.path() / "file"), "new");
}

TEST(WriteWhole, ReplacesNoDeviceAndNothingThatWasRead) {
  const TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe", input = folder.path() / "input";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(refusal(pipe, "x"), HasSubstr("pipe: is no regular file, so it is not replaced"));
  EXPECT_TRUE(fs::is_fifo(pipe));
  write_whole(input, "old");
  static_cast<void>(read_file(input));
  fs::create_symlink("input", folder.path() / "link");
  for (const char* name : {"input", "link"}) {
    EXPECT_THROW(check_writable(folder.path() / name), InvalidInput);
    EXPECT_THAT(refusal(folder.path() / name, "new"), HasSubstr("is read by this run, so its output does not replace it"));
  }
  EXPECT_EQ(content(input), "old");
  EXPECT_EQ(entries(folder.path()), 3u);
}

TEST(WriteWhole, ReplacesNoStore) {
  const TemporaryFolder folder;
  const std::string store = std::string("SQLite format 3\0", 16) + "rows";
  std::ofstream(folder.path() / "map.sqlite", std::ios::binary) << store;
  std::ofstream(folder.path() / "short", std::ios::binary) << "SQLite format 3";
  EXPECT_THAT(refusal(folder.path() / "map.sqlite", "{}"),
              HasSubstr("map.sqlite: is the store of a study, so it is not replaced"));
  EXPECT_EQ(content(folder.path() / "map.sqlite"), store);
  write_whole(folder.path() / "short", "{}");
  EXPECT_EQ(content(folder.path() / "short"), "{}");
}

TEST(WriteWhole, IsAskedBeforeWhetherItMay) {
  const TemporaryFolder folder;
  check_writable(folder.path() / "new");
  EXPECT_EQ(entries(folder.path()), 0u);
  EXPECT_THROW(check_writable(folder.path() / "missing/new"), InvalidInput);
  EXPECT_THROW(check_writable(folder.path()), InvalidInput);
}

// A database that is gone may leave its inode to a file that comes later.
TEST(WriteWhole, ReplacesAFileWithTheInodeOfAFormerDatabase) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "rows.csv";
  write_whole(file, "old");
  mark_as_database(file);
  write_whole(file, "new");
  EXPECT_EQ(content(file), "new");
}

TEST(NameToBe, IsThatOfAFileWhoseWriterWasKilled) {
  EXPECT_EQ(name_to_be("best.toml.4711-23.tmp"), "best.toml");
  for (const char* other : {"best.toml", "best.tmp", "best.toml.tmp", "my.files.tmp", ".tmp", "", "best.4711-23"})
    EXPECT_EQ(name_to_be(other), other);
}

}  // namespace
}  // namespace softland
