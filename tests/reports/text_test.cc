#include "reports/text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "sample_result.h"

namespace softland {
namespace {

using nlohmann::json;
using softland::testing::sample_optimize_result;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::size_t few_rows = 601;

TEST(Wrapped, BreaksAtBlanksOnly) {
  EXPECT_EQ(wrapped("", 5), "");
  EXPECT_EQ(wrapped("one two", 7), "one two");
  EXPECT_EQ(wrapped("one two", 6), "one\ntwo");
  EXPECT_EQ(wrapped("a longer-than-that word", 6), "a\nlonger-than-that\nword");
  EXPECT_EQ(wrapped("µµ µµ µ", 5), "µµ µµ\nµ") << "columns, not bytes";
}

TEST(TextReport, KeepsItsSentencesWithinAHundredColumns) {
  std::istringstream lines(text_report(sample_optimize_result(few_rows)));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 110U) << line;  // bytes
}

TEST(TextReport, ConfirmsOnlyAWinnerThatLandsSoftly) {
  json result = sample_optimize_result(few_rows);
  ASSERT_EQ(result["best"]["metrics"]["bounce_count"], 0);
  EXPECT_THAT(text_report(result), HasSubstr("1 of 2 confirmations"));
  result["best"]["metrics"]["bounce_count"] = 7;
  EXPECT_THAT(text_report(result), Not(HasSubstr("onfirm")));
}

TEST(TextReport, PassesOverWhatIsNotThere) {
  for (const char* text : {"{}", R"({"kind": "optimize"})", R"({"kind": "simulate", "warnings": [1, "so"], "checks": 2})"})
    EXPECT_NO_THROW((void)text_report(json::parse(text))) << text;
}

}  // namespace
}  // namespace softland
