// Records of a contact, and the faults of invalid ones.
#include "studies/inverse/contact_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace softland {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr double microsecond = 1e-6;

ContactRecord with_edges(std::vector<ContactEdge> edges) { return {.edges = std::move(edges)}; }

TEST(ContactRecords, EdgesTellTouchAndOpenings) {
  const ContactRecord record =
      with_edges({{3 * microsecond, true}, {4 * microsecond, false}, {6 * microsecond, true}, {9 * microsecond, false}});
  EXPECT_THAT(record_fault(record), IsEmpty());
  EXPECT_EQ(first_touch(record), 3 * microsecond);
  const std::vector<ContactOpening> open = openings(record);
  ASSERT_EQ(open.size(), 2U);
  EXPECT_EQ(open[0].begin, 4 * microsecond);
  EXPECT_EQ(open[0].end, 6 * microsecond);
  EXPECT_EQ(open[1].end, std::numeric_limits<double>::infinity());
  EXPECT_EQ(bounce_count(record), 2);
  EXPECT_FALSE(is_bounce_free(record));
}

TEST(ContactRecords, OnlyAClosingThatIsKnownToStayClosedIsFreeOfBounces) {
  EXPECT_TRUE(is_bounce_free(with_edges({{microsecond, true}})));
  EXPECT_TRUE(is_bounce_free({.closing_time = microsecond, .bounce_count = 0}));
  EXPECT_FALSE(is_bounce_free({.closing_time = microsecond}));
  EXPECT_FALSE(is_bounce_free({.closing_time = microsecond, .bounce_count = 2}));
  EXPECT_FALSE(is_bounce_free({}));
  EXPECT_FALSE(is_bounce_free({.edges = {{microsecond, true}}, .error = "no trigger"}));
}

TEST(ContactRecords, AnInvalidRecordIsRefusedWithItsKey) {
  EXPECT_THAT(record_fault(with_edges({{1, false}})), HasSubstr("edges_s"));
  EXPECT_THAT(record_fault(with_edges({{1, true}, {2, true}})), HasSubstr("alternate"));
  EXPECT_THAT(record_fault(with_edges({{2, true}, {1, false}})), HasSubstr("in order"));
  EXPECT_THAT(record_fault(with_edges({{-1, true}})), HasSubstr("above 0"));
  EXPECT_THAT(record_fault(with_edges({{0, true}})), HasSubstr("above 0")) << "the drives begin there";
  EXPECT_EQ(record_fault(with_edges({{1e-5, true}, {2e-5, false}, {3e-5, true}}), 3e-5), "");
  EXPECT_THAT(record_fault(with_edges({{1e-5, true}, {2e-5, false}, {3e-5, true}}), 2.9e-5), HasSubstr("ends at 2.9e-05 s"));
  EXPECT_THAT(record_fault(with_edges({{std::nan(""), true}})), HasSubstr("finite"));
  EXPECT_THAT(record_fault({.edges = {{1, true}}, .closing_time = 1}), HasSubstr("beside"));
  EXPECT_THAT(record_fault({.closing_time = -1}), HasSubstr("closing_time_s"));
  EXPECT_THAT(record_fault({.closing_time = 1, .bounce_count = -1}), HasSubstr("bounce_count"));
  EXPECT_THAT(record_fault({.bounce_count = 1}), HasSubstr("bounce_count: must be 0 for a contact that stayed open"));
  EXPECT_THAT(record_fault({.closing_time = 1, .loudness = 0}), HasSubstr("loudness"));
  EXPECT_THAT(record_fault({.edges = {{1, false}}, .error = "no trigger"}), IsEmpty());
}

}  // namespace
}  // namespace softland
