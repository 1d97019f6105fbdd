#include "document/csv_cell.h"

#include <gtest/gtest.h>

#include <limits>

namespace softland::internal {
namespace {

TEST(CsvCell, OfAMissingNumberIsEmpty) {
  EXPECT_EQ(csv_cell(2.5e-5), "2.5e-05");
  EXPECT_EQ(csv_cell(std::numeric_limits<double>::quiet_NaN()), "");
  EXPECT_EQ(csv_cell(std::numeric_limits<double>::infinity()), "");
}

TEST(CsvCell, OfATextThatWouldBeSplitIsQuoted) {
  EXPECT_EQ(csv_cell("Ipopt: Restoration_Failed"), "Ipopt: Restoration_Failed");
  EXPECT_EQ(csv_cell("12 V, \"full\""), "\"12 V, \"\"full\"\"\"");
}

}  // namespace
}  // namespace softland::internal
