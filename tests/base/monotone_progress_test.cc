// Oracle: for any reported sequence, the shown progress of a name never decreases.
#include "base/monotone_progress.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <string>

namespace softland {
namespace {

TEST(MonotoneProgress, NeverRunsBackWhateverItIsTold) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> part(-0.1, 1.1);
  MonotoneProgress progress;
  std::map<std::string, double> shown;
  for (int i = 0; i < 10'000; ++i) {
    const auto [name, now] = progress.updated(i % 3 == 0 ? "closing" : "dynamic pull-in voltage", part(random));
    const auto before = shown.find(name);
    EXPECT_TRUE(before == shown.end() || now >= before->second) << name << " " << now;
    EXPECT_TRUE(now >= 0 && now <= 1) << now;
    shown[name] = now;
  }
  EXPECT_GT(shown.size(), 2U);
}

TEST(MonotoneProgress, NamesTheRoundThatBeginsAgainAndNotAPartThatComesLate) {
  MonotoneProgress progress;
  EXPECT_EQ(progress.updated("closing", 0.5), std::pair(std::string("closing"), 0.5));
  EXPECT_EQ(progress.updated("closing", 0.4), std::pair(std::string("closing"), 0.5));
  EXPECT_EQ(progress.updated("closing", 0.1), std::pair(std::string("closing (2)"), 0.1));
  EXPECT_EQ(progress.updated("cloud", 0.2), std::pair(std::string("cloud"), 0.2));
  EXPECT_EQ(progress.updated("closing", 0.3), std::pair(std::string("closing (2)"), 0.3));
}

}  // namespace
}  // namespace softland
