#include "base/read_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "base/require.h"

namespace softland {
namespace {

namespace fs = std::filesystem;

class ReadFile : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  // Remove the folder at the end only: a new file could get the inode of a removed one, which counts as read.
  void TearDown() override { made.push_back(folder); }
  static void TearDownTestSuite() {
    for (const fs::path& one : made) fs::remove_all(one);
  }
  fs::path file(const std::string& name, const std::string& content) const {
    std::ofstream(folder / name, std::ios::binary) << content;
    return folder / name;
  }
  static std::string refusal(const fs::path& path) {
    try {
      static_cast<void>(read_file(path));
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "was not refused";
  }
  fs::path folder;
  static inline std::vector<fs::path> made;
};

TEST_F(ReadFile, GivesEveryByte) {
  std::string content("one\0two\r\n", 9);
  for (int i = 0; i < 20; ++i) content += content;  // many blocks
  EXPECT_EQ(read_file(file("a", content)), content);
  EXPECT_EQ(read_file(file("b", "")), "");
  EXPECT_NE(read_file("/proc/self/status"), "") << "a regular file without a size";
}

TEST_F(ReadFile, RefusesWhatIsNoRegularFileWithoutWaiting) {
  EXPECT_EQ(refusal("/dev/zero"), "/dev/zero: is a device, it must be a regular file");
  EXPECT_EQ(refusal(folder), folder.string() + ": is a folder, it must be a regular file");
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(refusal(pipe), pipe.string() + ": is a pipe, it must be a regular file");
  const fs::path absent = folder / "absent";
  EXPECT_EQ(refusal(absent), absent.string() + ": cannot be read: No such file or directory");
}

TEST_F(ReadFile, HasABound) {
  const fs::path path = file("large", "");
  fs::resize_file(path, largest_file);
  EXPECT_EQ(read_file(path).size(), largest_file);
  fs::resize_file(path, largest_file + 1);
  EXPECT_EQ(refusal(path), path.string() + ": is too large, it must have at most 64 MiB");
}

TEST_F(ReadFile, IsRememberedUnderEveryName) {
  const fs::path read = file("read", "x"), other = file("other", "x");
  EXPECT_FALSE(was_read(read));
  static_cast<void>(read_file(read));
  fs::create_symlink("read", folder / "link");
  fs::create_hard_link(read, folder / "hard");
  for (const char* name : {"read", "link", "hard", "./read"}) EXPECT_TRUE(was_read(folder / name)) << name;
  EXPECT_FALSE(was_read(other));
  EXPECT_FALSE(was_read(folder / "absent"));
}

TEST_F(ReadFile, IsForgottenOnceDeletedThoughAnotherFileGetsItsInode) {
  for (int k = 0; k < 50; ++k) {
    const fs::path read = file("gone", "x");
    static_cast<void>(read_file(read));
    fs::remove(read);
    EXPECT_FALSE(was_read(file("new", "y"))) << k;
    fs::remove(folder / "new");
  }
}

}  // namespace
}  // namespace softland
