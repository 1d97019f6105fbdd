// Expressions that select rows: they can compare, and do nothing else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/require.h"
#include "tests/store/sample.h"

namespace softland::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::ThrowsMessage;
using Query = WithStore;

TEST_F(Query, ChoosesRowsByColumns) {
  make_store(file, 1024);
  const auto expect = [&](const std::string& where, const std::function<bool(const StoredRow&)>& chosen) {
    std::vector<StoredRow> expected;
    for (std::int64_t point = 0; point < 1024; ++point) {
      if (chosen(row_of(point))) expected.push_back(row_of(point));
    }
    EXPECT_EQ(dump(rows_in(file, where)), dump(expected)) << where;
  };
  expect("bounce_count < 3", [](const StoredRow& row) { return row.values[2] < 3; });
  expect("status = 'no_contact' or gap_contact_m > 1.5e-6",
         [](const StoredRow& row) { return row.status == "no_contact" || row.values[0] > 1.5e-6; });
  expect("point between 10 and 20", [](const StoredRow& row) { return row.point >= 10 && row.point <= 20; });
  expect("reason like '%(\"open\")%' or \"bounce_count\" is null",
         [](const StoredRow& row) { return std::isnan(row.values[2]); });
  expect("abs(impact_velocity_m_s) < sqrt(0.04)", [](const StoredRow& row) { return std::abs(row.values[1]) < std::sqrt(0.04); });
}

TEST_F(Query, RefusesWhatIsNoComparison) {
  make_store(file, 10);
  for (const char* where : {"1) or (1",
                            "1; drop table results",
                            "1) union select * from results -- ",
                            "1 /*",
                            "1 -- ",
                            "'open",
                            "(1",
                            "1)",
                            "select 1",
                            "point in (select point from results)",
                            "exists (SELECT 1)",
                            "no_such_column > 1",
                            "'a' = \"a\"",
                            "point >",
                            "sum(point) > 1",
                            "load_extension('x')",
                            "randomblob(1000000000) = 1",
                            "zeroblob(1e9) = x''",
                            "?1 = 1",
                            ":a = 1",
                            "writefile('a', 'b')",
                            "printf('%1000000000d', 1) = ''",
                            "pragma_user_version() = 1",
                            "sqlite_version() = ''",
                            "rowid = 1"}) {
    EXPECT_THAT([&] { static_cast<void>(rows_in(file, where)); },
                ThrowsMessage<InvalidInput>(HasSubstr(fmt::format("--where \"{}\": ", where))))
        << where;
  }
  EXPECT_THAT([&] { static_cast<void>(rows_in(file, "bounces > 1")); },
              ThrowsMessage<InvalidInput>(
                  AllOf(HasSubstr("no such column: bounces"),
                        HasSubstr("point, status, reason, gap_contact_m, impact_velocity_m_s, bounce_count, bounce_time_s"))));
  EXPECT_EQ(rows_in(file).size(), 10u);
}

TEST_F(Query, SaysWhatFailsAtARow) {
  make_store(file, 10);
  for (const char* where :
       {"abs(-9223372036854775808) > 1", "abs(point - 9223372036854775807 - 1) > 1", "status like 'x' escape 'ab'"}) {
    EXPECT_THAT([&] { static_cast<void>(rows_in(file, where)); },
                ThrowsMessage<InvalidInput>(AllOf(HasSubstr(fmt::format("--where \"{}\": ", where)), Not(HasSubstr("damaged")))))
        << where;
  }
}

TEST_F(Query, StopsWhenItIsAsked) {
  make_store(file, 3000);
  const std::atomic<bool> stop = true;
  EXPECT_THROW(StudyReader(file).read([](const StoredRow&) {}, {.where = "bounce_count < 0"}, {.stop = &stop}), Interrupted);
}

}  // namespace
}  // namespace softland::test
