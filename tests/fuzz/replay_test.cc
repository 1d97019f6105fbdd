// Runs every kept input of the fuzzers, and every shipped scene. The build names the targets in SOFTLAND_REPLAYED.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "tests/fuzz/targets.h"

namespace softland::fuzz {
namespace {

namespace fs = std::filesystem;

const fs::path source = SOFTLAND_SOURCE_DIR;

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files{fs::recursive_directory_iterator(folder), {}};
  std::erase_if(files, [](const fs::path& file) { return !fs::is_regular_file(file); });
  std::sort(files.begin(), files.end());
  return files;
}

class Replay : public ::testing::TestWithParam<Target> {};

TEST_P(Replay, NoKeptInputEndsOtherwiseThanTakenOrRefused) {
  constexpr std::chrono::seconds longest{5};  // the limit of run_fuzzers
  constexpr std::size_t fewest = 5;
  std::vector<fs::path> files = files_in(source / "tests/fuzz/corpus" / GetParam().name);
  EXPECT_GE(files.size(), fewest);
  if (GetParam().name == "scene") {
    for (const fs::path& shipped : files_in(source / "scenes")) files.push_back(shipped);
  }
  for (const fs::path& file : files) {
    std::ifstream stream(file, std::ios::binary);
    ASSERT_TRUE(stream.is_open()) << file;
    const std::string input{std::istreambuf_iterator<char>(stream), {}};
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_NO_THROW(GetParam().read(input)) << file;
    EXPECT_LT(std::chrono::steady_clock::now() - begin, longest) << file;
  }
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Replay, ::testing::ValuesIn(SOFTLAND_REPLAYED),
                         [](const auto& target) { return std::string(target.param.name); });

}  // namespace
}  // namespace softland::fuzz
