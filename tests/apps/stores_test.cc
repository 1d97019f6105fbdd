// The verbs that work on stores of studies.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

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

// Runs the example of docs/scale.md literally.
TEST_F(Table, IsNotNeededByPandas_pandas) {
  std::string python;
  for (const char* name : {"python3", "/usr/bin/python3"}) {
    if (python.empty() && std::system(fmt::format("{} -c 'import pandas' >/dev/null 2>&1", name).c_str()) == 0) python = name;
  }
  if (python.empty()) GTEST_SKIP() << "skipped: no pandas; needs: python3-pandas";
  make_store(at("map.sqlite"), 300);
  const std::string document = read(fs::path(SOFTLAND_SOURCE_DIR) / "docs/scale.md"), begin = "```python\n";
  const std::size_t first = document.find(begin) + begin.size();
  write(at("example.py"), document.substr(first, document.find("```", first) - first) +
                              "for p, v in zip(frame.point, frame.impact_velocity_m_s): print('row', p, float(v).hex())\n");
  ASSERT_EQ(std::system(fmt::format("cd '{}' && {} example.py > read.txt", here.path().string(), python).c_str()), 0);
  std::istringstream lines(read(at("read.txt")));
  int rows = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("row ")) continue;
    std::istringstream cells(line.substr(4));
    int point = 0;
    std::string number;
    cells >> point >> number;
    const double value = row_of(point).values[1];
    const double number_read = std::strtod(number.c_str(), nullptr);
    EXPECT_TRUE(std::isnan(value) ? std::isnan(number_read) : number_read == value) << point << ": " << number;
    ++rows;
  }
  EXPECT_EQ(rows, 300);
}

TEST_F(Table, AsCsvIsReadByOthersToTheBit) {
  if (std::system("command -v python3 >/dev/null 2>&1") != 0) GTEST_SKIP() << "skipped: no Python; needs: python3";
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
      EXPECT_EQ(cell == "-", std::isnan(value)) << point;
      EXPECT_TRUE(std::isnan(value) || std::strtod(cell.c_str(), nullptr) == value) << point;
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

TEST_F(Table, HasTheSameBytesOnStandardOutputAndInAFile) {
  {
    StudyStore store(at("a.sqlite"), test::plan_of(3), test::origin(), StudyStore::Opening::fresh);
    for (int point = 0; point < 3; ++point) {
      StoredRow row = row_of(point);
      row.reason = std::vector<std::string>{"\x01\x1b[31m \u202e\u2028", "no UTF-8: \xff\xc3",
                                            "two\nlines,\t\"quoted\"\r"}[static_cast<std::size_t>(point)];
      store.add(row);
    }
    store.close();
  }
  const std::string csv = printed({"table", "a.sqlite", "--csv"});
  EXPECT_EQ(printed({"table", "a.sqlite", "--out", "a.csv"}), "");
  EXPECT_EQ(read(at("a.csv")), csv);
  EXPECT_THAT(csv, AllOf(HasSubstr("\\u001b[31m"), HasSubstr("\"two\nlines,\t\"\"quoted\"\"")));
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

TEST_F(Table, ShowsMultiplesOfAPullInVoltageWithoutPrefixes) {
  const Outcome o = here.run({"explore", "gold.toml", "--vary", "waveform.main.level=0.95 Vdp:1.25 Vdp:2", "--out", "a.sqlite"});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(printed({"table", "a.sqlite"}), AllOf(HasSubstr(" 0.95\u00a0Vdp"), HasSubstr(" 1.25\u00a0Vdp")));
}

TEST_F(Table, NamesWhatItCannotTake) {
  make_store(at("a.sqlite"), 10);
  expect_bad({"table", "a.sqlite", "--where", "bounces > 1"},
             "--where \"bounces > 1\": no such column: bounces; choose from the columns point, ");
  expect_bad({"table", "a.sqlite", "--where", "1); drop table results; --"}, "--where \"1); drop table results; --\": ");
  expect_bad({"table", "a.sqlite", "--select", "point,bounces"},
             "--select point,bounces: unknown column \"bounces\"; choose from point, gap_contact_m, ");
  expect_bad({"table", "a.sqlite", "--out", "a.sqlite"}, "--out a.sqlite: is a store");
  expect_bad({"table", "a.sqlite", "--out", "no folder/a.csv"}, "no folder/a.csv: cannot write in its folder");
  expect_bad({"table", "gold.toml"}, "gold.toml: is not a store of softland");
  expect_bad({"table", "nothing"}, "nothing: the file does not exist");
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
                      HasSubstr("  no_contact "), HasSubstr(fmt::format("  written now by       process {} on ", ::getpid()))));
  }
  EXPECT_THAT(printed({"status", "a.sqlite"}), HasSubstr("  written now by       nobody\n"));
  make_store(at("b.sqlite"), 10);
  const json both = json::parse(printed({"status", "a.sqlite", "b.sqlite", "--json", "-"}));
  EXPECT_EQ(both["points"], 260);
  EXPECT_EQ(both["done"], 35);
  EXPECT_EQ(both["stores"][0]["shard"], "2/4");
  EXPECT_EQ(both["stores"][0]["writer"], nullptr);
  EXPECT_EQ(both["stores"][1]["sessions"][0]["rows"], 10);
  EXPECT_EQ(both["stores"][1]["sessions"][0]["program"], test::origin().program);
  EXPECT_EQ(both["stores"][1]["plan"], content_key("grid of 10 points").hexadecimal());
  expect_bad({"status", "a.sqlite", "gold.toml"}, "gold.toml: is not a store of softland");
}

TEST_F(MergeVerb, MakesOneStoreOfParts) {
  for (int index = 1; index <= 3; ++index)
    make_store(at(fmt::format("part {}.sqlite", index)), 100, {.index = index, .count = 3});
  const Outcome early = here.run({"merge", "part 1.sqlite", "part 3.sqlite", "--complete", "--out", "all.sqlite"});
  EXPECT_EQ(early.status, 4);
  EXPECT_THAT(early.err, AllOf(HasSubstr("33 of 100 points are missing"), HasSubstr("no part was given for 2/3")));
  EXPECT_FALSE(fs::exists(at("all.sqlite")));
  EXPECT_EQ(printed({"merge", "part 1.sqlite", "part 2.sqlite", "part 3.sqlite", "--complete", "--out", "all.sqlite"}),
            "100 of 100 points from 3 parts in all.sqlite\n");
  make_store(at("whole.sqlite"), 100);
  EXPECT_EQ(dump(at("all.sqlite")), dump(at("whole.sqlite")));
  expect_bad({"merge", "part 1.sqlite", "--out", "all.sqlite"}, "all.sqlite: exists already; it is not replaced");
  expect_bad({"merge", "part 1.sqlite"}, "--out is required");
  make_store(at("other.sqlite"), 99);
  expect_bad({"merge", "part 1.sqlite", "other.sqlite", "--out", "new.sqlite"},
             "other.sqlite: must have the same plan as part 1.sqlite");
}

TEST_F(Stores, KeepTheNamesOfTheirCompanions) {
  make_store(at("a.sqlite"), 10);
  make_store(at("b.sqlite"), 10);
  const std::vector<std::string> vary{"--vary", "waveform.main.level=20 V:24 V:2"};
  const auto with = [](std::vector<std::string> words, std::initializer_list<std::string> more) {
    words.insert(words.end(), more);
    return words;
  };
  const std::vector<std::string> explore = with({"explore", "gold.toml"}, {vary[0], vary[1]});
  for (const char* ending : {"-wal", "-shm", "-journal", ".lock"}) {
    const std::string name = std::string("a.sqlite") + ending;
    const std::string reason = name + ": is the name of a file that the store ";
    expect_bad({"table", "b.sqlite", "--out", name}, reason);
    expect_bad({"table", "a.sqlite", "--out", name}, reason);
    expect_bad({"modes", "gold.toml", "--json", name}, reason);
    expect_bad({"simulate", "gold.toml", "--out", name}, "--out " + reason);
    expect_bad({"merge", "b.sqlite", "--out", name}, reason);
    expect_bad(with(explore, {"--out", name}), reason);
    expect_bad(with(explore, {"--point", "1", "--out", name}), reason);
    expect_bad(with(explore, {"--out", "new.sqlite", "--json", std::string("new.sqlite") + ending}),
               fmt::format("--json new.sqlite{}: is a companion file of the store new.sqlite", ending));
    EXPECT_FALSE(fs::exists(at(name)));
    EXPECT_FALSE(fs::exists(at("new.sqlite")));
  }
  EXPECT_EQ(dump(at("a.sqlite")), dump(at("b.sqlite")));
}

// The store of a running exploration is removed, and another one is made in its place.
TEST_F(Stores, ThatAreMadeAnewUnderTheirRunEndItAtOnce) {
  const pid_t child = here.start({"explore", "gold.toml", "--vary", "waveform.main.level=20 V:24 V:20000", "--jobs", "1", "--set",
                                  "structure.modes=2", "--set", "simulate.accuracy=1e-3", "--out", "a.sqlite", "--quiet"});
  const auto rows = [&] { return fs::exists(at("a.sqlite")) ? test::rows_in(at("a.sqlite")).size() : 0; };
  for (int i = 0; i < 600 && rows() == 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  ASSERT_GT(rows(), 0u);
  for (const char* ending : {"", "-wal", "-shm"}) fs::remove(at(std::string("a.sqlite") + ending));
  make_store(at("b.sqlite"), 10);
  fs::rename(at("b.sqlite"), at("a.sqlite"));
  const Outcome o = here.finish(child);
  EXPECT_EQ(o.status, 74) << o.err;
  EXPECT_THAT(o.err, AllOf(HasSubstr("softland: a.sqlite: was removed, moved or replaced while it was written"),
                           HasSubstr("a.sqlite.rescued")));
  EXPECT_EQ(test::rows_in(at("a.sqlite")).size(), 10u);
  EXPECT_GT(test::rows_in(at("a.sqlite.rescued")).size(), 0u);
}

TEST_F(Stores, AreOfNoMorePartsThanTheStudyHasPoints) {
  for (const char* shard : {"1/2147483647", "1/3", "3/3"})
    expect_bad({"explore", "gold.toml", "--vary", "waveform.main.level=20 V:24 V:2", "--shard", shard},
               std::string("--shard ") + shard + ": a study of 2 points has at most 2 parts");
  EXPECT_FALSE(fs::exists(at("softland-out.sqlite")));
}

// Every verb that reads a damaged store reports it as bad input.
TEST_F(Stores, ThatAreDamagedAreBadInputToEveryVerb) {
  ASSERT_EQ(
      here.run({"explore", "gold.toml", "--vary", "waveform.main.level=20 V:24 V:3", "--out", "sound.sqlite", "--quiet"}).status,
      0);
  for (const char* sql :
       {"UPDATE study SET shards = 0", "ALTER TABLE results DROP COLUMN bounce_count",
        "UPDATE results SET bounce_count = 77 WHERE point = 1", "UPDATE results SET point = 1e300 WHERE point = 2",
        "PRAGMA writable_schema = 1; UPDATE sqlite_schema SET sql = replace(sql, 'INTEGER', 'INTEG(R') WHERE name = "
        "'results'"}) {
    fs::remove(at("a.sqlite"));
    fs::copy(at("sound.sqlite"), at("a.sqlite"));
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open(at("a.sqlite").c_str(), &database), SQLITE_OK);
    ASSERT_EQ(sqlite3_exec(database, sql, nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(database);
    sqlite3_close(database);
    for (const std::vector<std::string>& words : {std::vector<std::string>{"table", "a.sqlite"},
                                                  {"report", "a.sqlite"},
                                                  {"merge", "a.sqlite", "--out", "b.sqlite"},
                                                  {"explore", "a.sqlite", "--resume", "--quiet"}}) {
      const Outcome o = here.run(words);
      EXPECT_EQ(o.status, 2) << sql << ", " << words.front();
      EXPECT_THAT(o.err, HasSubstr("a.sqlite: the store is damaged: ")) << sql << ", " << words.front();
    }
  }
}

class SlurmVerb : public Stores {
 protected:
  static constexpr const char* folder = "it's $(a) \"map\"";

  SlurmVerb() {
    fs::create_directory(at(folder));
    write(at("map.toml"),
          "[plan]\nscene = \"gold.toml\"\n"
          "set = [\"structure.modes=2\", \"simulate.accuracy=1e-3\", \"simulate.duration=80 us\"]\n"
          "vary = [\"waveform.main.level=20 V:24 V:11\"]\n");
    write(at("script.sh"), printed({"slurm", "map.toml", "--tasks", "3", "--out", std::string(folder) + "/map.sqlite"}));
    // A substitute for Slurm's sbatch: it records its arguments and runs the script at once.
    write(at("sbatch"), R"(#!/bin/bash
printf '%s\n' "$*" >>"$(dirname -- "$0")/asked.txt"
array= wrap= script=
for word; do
  case $word in
    --array=*) array=${word#*=} ;;
    --wrap=*) wrap=${word#*=} ;;
    -*) ;;
    *) script=$word ;;
  esac
done
if [ -n "$wrap" ]; then bash -c "$wrap" >&2; fi
for task in $(seq "${array%-*}" "${array#*-}"); do SLURM_ARRAY_TASK_ID=$task SLURM_CPUS_PER_TASK=2 bash "$script" >&2; done
echo '42;cluster'
)");
    fs::permissions(at("sbatch"), fs::perms::owner_all);
  }
  [[nodiscard]] int submitted(const std::string& words = "") const {
    return std::system(
        fmt::format("cd '{0}' && PATH='{0}':\"$PATH\" bash script.sh {1} >told.txt 2>log.txt", here.path().string(), words)
            .c_str());
  }
};

TEST_F(SlurmVerb, PrintsAScriptThatASubmissionRunsToTheBitsOfOneRun) {
  ASSERT_EQ(submitted(), 0) << read(at("log.txt"));
  const std::string parts = (at(folder) / "map-parts").string();
  EXPECT_EQ(read(at("told.txt")), fmt::format("parts: job 42, merge: job 42, logs in {}\n", parts));
  EXPECT_THAT(read(at("asked.txt")),
              AllOf(StartsWith(fmt::format("--parsable --array=1-3 --chdir={} --output=part-%a.log {}/script.sh\n--parsable",
                                           parts, here.path().string())),
                    HasSubstr("--dependency=afterok:42 --kill-on-invalid-dep=yes")));
  ASSERT_EQ(here.run({"explore", "map.toml", "--out", "whole.sqlite", "--quiet"}).status, 0);
  EXPECT_EQ(dump(at(folder) / "map.sqlite"), dump(at("whole.sqlite")));
  EXPECT_EQ(test::rows_in(at("whole.sqlite")).size(), 11u);
  // The existing file is not replaced, and nothing is submitted for it.
  fs::remove(at("asked.txt"));
  EXPECT_NE(submitted(), 0);
  EXPECT_THAT(read(at("log.txt")), HasSubstr("map.sqlite exists already"));
  EXPECT_FALSE(fs::exists(at("asked.txt")));
}

TEST_F(SlurmVerb, KeepsTheNumberOfPartsOfOneThatIsSubmittedAlone) {
  ASSERT_EQ(submitted("2-2"), 0);
  const StudyReader part(at(folder) / "map-parts/part-2-of-3.sqlite");
  EXPECT_EQ(part.plan().shard, (Shard{.index = 2, .count = 3}));
  EXPECT_FALSE(fs::exists(at(folder) / "map.sqlite"));
  EXPECT_THAT(read(at("log.txt")), HasSubstr("part-1-of-3.sqlite: the file does not exist"));
  ASSERT_EQ(submitted("1-3"), 0);
  EXPECT_EQ(test::rows_in(at(folder) / "map.sqlite").size(), 11u);
  EXPECT_EQ(part.sessions().size(), 2u) << "the part went on with what it held";
}

TEST_F(SlurmVerb, PrintsAScriptWithoutFaults) {
  if (std::system("command -v shellcheck >/dev/null 2>&1") != 0) GTEST_SKIP() << "skipped: no shellcheck; needs: shellcheck";
  EXPECT_EQ(std::system(fmt::format("cd '{}' && shellcheck script.sh", here.path().string()).c_str()), 0);
}

TEST_F(SlurmVerb, TakesThePlanOfAStoreToo) {
  ASSERT_EQ(here.run({"explore", "map.toml", "--out", "whole.sqlite", "--quiet"}).status, 0);
  const auto plan_in = [](const std::string& script) {
    const std::size_t begin = script.find("cat <<");
    return script.substr(begin, script.rfind("end of plan") - begin);
  };
  const std::string script = printed({"slurm", "whole.sqlite", "--tasks", "3"});
  EXPECT_EQ(plan_in(script), plan_in(read(at("script.sh"))));
  EXPECT_THAT(script, HasSubstr("/softland-out.sqlite"));
}

TEST_F(SlurmVerb, NamesTheFilesThatItWasToldWhateverTheirBytes) {
  for (const char* given :
       {"no UTF-8 \xff\xc3(", "a\u2028b", "\u202egnp", "it's \\ \u202e", "line\nline\ttab", "gr\u00fcn \u00b5m"}) {
    const std::string name = given;
    fs::create_directory(at(name));
    write(at("script.sh"), printed({"slurm", "map.toml", "--tasks", "3", "--out", name + "/map.sqlite"}));
    write(at("tell.sh"), "eval \"$(grep -a '^out=\\|^parts=' script.sh)\"; printf '%s|%s' \"$out\" \"$parts\"\n");
    ASSERT_EQ(std::system(fmt::format("cd '{}' && bash tell.sh >told.txt", here.path().string()).c_str()), 0);
    EXPECT_EQ(read(at("told.txt")), (at(name) / "map.sqlite").string() + "|" + (at(name) / "map-parts").string());
  }
}

TEST_F(SlurmVerb, NamesWhatItCannotTake) {
  expect_bad({"slurm", "map.toml"}, "--tasks is required");
  expect_bad({"slurm", "map.toml", "--tasks", "0"}, "--tasks 0: must be a whole number from 1 on");
  expect_bad({"slurm", "map.toml", "--tasks", "12"}, "--tasks 12: must be at most 11 for a study of 11 points");
  expect_bad({"slurm", "map.toml", "--tasks", "2", "--cpus", "x"}, "--cpus x: must be a whole number from 1 on");
  expect_bad({"slurm", "map.toml", "--tasks", "2", "--out", "gold.toml"}, "gold.toml: exists already");
  write(at("front.toml"),
        "[plan]\nscene = \"gold.toml\"\nvary = [\"waveform.main.level=20 V:24 V\"]\nsample = \"nsga2:100\"\n"
        "pareto = \"initial_contact_time,impact_velocity\"\n");
  expect_bad({"slurm", "front.toml", "--tasks", "2"},
             "a search for a Pareto front depends on its earlier points and cannot be divided");
  expect_bad({"slurm", "gold.toml", "--tasks", "2"}, "gold.toml: must be a store, or a plan file, which has a section [plan]");
}

}  // namespace
}  // namespace softland
