#include "reports/text_table.h"

#include <gtest/gtest.h>

namespace softland::internal {
namespace {

TEST(TextTable, AlignsWordsToTheLeftAndNumbersToTheRight) {
  EXPECT_EQ(
      text_table({{.head = "Figure", .width = 8, .is_words = true}, {.head = "value", .width = 10}, {.is_words = true, .gap = 2}},
                 {{"t_i", "25.3 µs", "late"}, {"B_H", "∞"}, {"a long name", "1"}}),
      "Figure       value\n"
      "t_i        25.3 µs  late\n"
      "B_H              ∞\n"
      "a long name         1\n");
}

TEST(TextTable, GrowsWithItsWidestCell) {
  EXPECT_EQ(text_table({{.head = "n", .grows = true},
                        {.head = "ended by", .is_words = true, .gap = 2, .grows = true},
                        {.head = "x", .gap = 1}},
                       {{"100", "goal", "1"}, {"7", "a time budget", "2"}}),
            "  n  ended by      x\n"
            "100  goal          1\n"
            "  7  a time budget 2\n");
}

}  // namespace
}  // namespace softland::internal
