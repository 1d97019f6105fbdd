// The verbs that work on stores of studies.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "program.h"
#include "tests/store/sample.h"

namespace softland {
namespace {

using nlohmann::json;
using test::dump;
using test::make_store;
using test::row_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class Stores : public testing::Test {
 protected:
  [[nodiscard]] fs::path at(const std::string& name) const { return here.path() / name; }
  [[nodiscard]] std::string printed(const std::vector<std::string>& words) const {
    const Outcome o = here.run(words);
    EXPECT_EQ(o.status, 0) << o.err;
    EXPECT_EQ(o.err, "");
    return o.out;
  }
  void expect_bad(const std::vector<std::string>& words, const std::string& reason) const {
    const Outcome o = here.run(words);
    EXPECT_EQ(o.status, 2) << o.err;
    EXPECT_THAT(o.err, AllOf(StartsWith("softland: "), HasSubstr(reason)));
    EXPECT_EQ(o.out, "");
  }
  const Workplace here;
};

using Table = Stores;
using StatusVerb = Stores;
using MergeVerb = Stores;

TEST_F(Table, AsCsvIsReadByOthersToTheBit) {
  if (std::system("command -v python3 >/dev/null 2>&1") != 0) GTEST_SKIP() << "python3 is not installed";
  make_store(at("a b.sqlite"), 300);
  write(at("table.csv"), printed({"table", "a b.sqlite", "--csv"}));
  write(at("read.py"),
        "import csv\n"
        "rows = list(csv.DictReader(open('table.csv', newline='')))\n"
        "for r in rows:\n"
        "    v = [r[k] for k in ('gap_contact_m', 'impact_velocity_m_s', 'bounce_count', 'bounce_time_s')]\n"
        "    print(r['point'], r['status'], r['reason'], *['-' if x == '' else float(x).hex() for x in v], sep='|')\n");
  ASSERT_EQ(std::system(fmt::format("cd '{}' && python3 read.py > read.txt", here.path().string()).c_str()), 0);
  std::istringstream lines(read(at("read.txt")));
  std::string line;
  for (int point = 0; point < 300; ++point) {
    ASSERT_TRUE(std::getline(lines, line));
    const StoredRow row = row_of(point);
    std::istringstream cells(line);
    std::string cell;
    for (const std::string& expected : {std::to_string(point), row.status, row.reason}) {
      std::getline(cells, cell, '|');
      EXPECT_EQ(cell, expected) << point;
    }
    for (const double value : row.values) {
      std::getline(cells, cell, '|');
      if (std::isnan(value)) EXPECT_EQ(cell, "-") << point;
      if (!std::isnan(value)) EXPECT_EQ(std::strtod(cell.c_str(), nullptr), value) << point;
    }
  }
  EXPECT_FALSE(std::getline(lines, line));
}

TEST_F(Table, GoesToAFileWhole) {
  make_store(at("a.sqlite"), 3000);
  const std::string csv = printed({"table", "a.sqlite", "--csv"});
  EXPECT_THAT(csv, StartsWith("point,gap_contact_m,impact_velocity_m_s,bounce_count,bounce_time_s,status,reason\n0,1e-06,"));
  EXPECT_THAT(csv, HasSubstr(",,,no_contact,\"the tip stays above, \"\"open\"\"\"\n"));
  EXPECT_EQ(printed({"table", "a.sqlite", "--out", "a.csv"}), "");
  EXPECT_EQ(read(at("a.csv")), csv);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3001);
}

TEST_F(Table, HasTheRowsAndColumnsThatAreAskedFor) {
  make_store(at("a.sqlite"), 100);
  EXPECT_EQ(printed({"table", "a.sqlite", "--csv", "--where", "point in (3, 5)", "--select", "bounce_count,point,gap.contact"}),
            "bounce_count,point,gap_contact_m\n0,3,1.0029296875e-06\n0,5,1.0048828125e-06\n");
  EXPECT_EQ(printed({"table", "a.sqlite", "--csv", "--where", "point = 3", "--select", "content,extra"}),
            "content,extra\n" + row_of(3).content.hexadecimal() + ",\n");
  const std::string people = printed({"table", "a.sqlite", "--where", "point = 7"});
  EXPECT_THAT(people, AllOf(HasSubstr("gap_contact_m"), HasSubstr("1.0068\u00a0µm"), HasSubstr("the tip stays above, \"open\"")));
}

TEST_F(Table, NamesWhatItCannotTake) {
  make_store(at("a.sqlite"), 10);
  expect_bad({"table", "a.sqlite", "--where", "bounces > 1"},
             "--where \"bounces > 1\": no such column: bounces; the columns are point, ");
  expect_bad({"table", "a.sqlite", "--where", "1); drop table results; --"}, "--where \"1); drop table results; --\": ");
  expect_bad({"table", "a.sqlite", "--select", "point,bounces"},
             "--select point,bounces: there is no column \"bounces\"; there are point, gap_contact_m, ");
  expect_bad({"table", "a.sqlite", "--out", "a.sqlite"}, "--out a.sqlite: is a store");
  expect_bad({"table", "a.sqlite", "--out", "no folder/a.csv"}, "no folder/a.csv: cannot write in its folder");
  expect_bad({"table", "gold.toml"}, "gold.toml: is no store of softland");
  expect_bad({"table", "nothing"}, "nothing: there is no such file");
  EXPECT_EQ(printed({"table", "a.sqlite", "--csv", "--select", "point", "--where", "point > 8"}), "point\n9\n");
}

TEST_F(StatusVerb, TellsHowFarAStudyIs) {
  {
    StudyStore store(at("a.sqlite"), test::plan_of(1000, {.index = 2, .count = 4}), test::origin(), StudyStore::Opening::fresh);
    for (int point = 1; point < 100; point += 4) store.add(row_of(point));
    store.flush();
    const std::string writing = printed({"status", "a.sqlite"});
    EXPECT_THAT(writing,
                AllOf(StartsWith("a.sqlite: 25 of 250 points, part 2/4 of 1000\n"), HasSubstr("  done "),
                      HasSubstr("  no_contact "), HasSubstr(fmt::format("  writes now           process {} on ", ::getpid()))));
  }
  EXPECT_THAT(printed({"status", "a.sqlite"}), HasSubstr("  writes now           nobody\n"));
  make_store(at("b.sqlite"), 10);
  const json both = json::parse(printed({"status", "a.sqlite", "b.sqlite", "--json", "-"}));
  EXPECT_EQ(both["points"], 260);
  EXPECT_EQ(both["done"], 35);
  EXPECT_EQ(both["stores"][0]["shard"], "2/4");
  EXPECT_EQ(both["stores"][0]["writer"], nullptr);
  EXPECT_EQ(both["stores"][1]["sessions"][0]["rows"], 10);
  EXPECT_EQ(both["stores"][1]["sessions"][0]["program"], test::origin().program);
  EXPECT_EQ(both["stores"][1]["plan"], content_key("grid of 10 points").hexadecimal());
  expect_bad({"status", "a.sqlite", "gold.toml"}, "gold.toml: is no store of softland");
}

TEST_F(MergeVerb, MakesOneStoreOfParts) {
  for (int index = 1; index <= 3; ++index)
    make_store(at(fmt::format("part {}.sqlite", index)), 100, {.index = index, .count = 3});
  const Outcome early = here.run({"merge", "part 1.sqlite", "part 3.sqlite", "--complete", "--out", "all.sqlite"});
  EXPECT_EQ(early.status, 4);
  EXPECT_THAT(early.err, AllOf(HasSubstr("33 of 100 points are missing"), HasSubstr("no part was given of 2/3")));
  EXPECT_FALSE(fs::exists(at("all.sqlite")));
  EXPECT_EQ(printed({"merge", "part 1.sqlite", "part 2.sqlite", "part 3.sqlite", "--complete", "--out", "all.sqlite"}),
            "100 of 100 points of 3 parts in all.sqlite\n");
  make_store(at("whole.sqlite"), 100);
  EXPECT_EQ(dump(at("all.sqlite")), dump(at("whole.sqlite")));
  expect_bad({"merge", "part 1.sqlite", "--out", "all.sqlite"}, "all.sqlite: exists already; it is not replaced");
  expect_bad({"merge", "part 1.sqlite"}, "--out is required");
  make_store(at("other.sqlite"), 99);
  expect_bad({"merge", "part 1.sqlite", "other.sqlite", "--out", "new.sqlite"},
             "other.sqlite: holds another plan than part 1.sqlite");
}

}  // namespace
}  // namespace softland
