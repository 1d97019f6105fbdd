// Tests the verbs of a laboratory as users do: a practice device, and the tuning of a waveform.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "program.h"

namespace softland {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::vector<json> lines_of(const std::string& text) {
  std::vector<json> all;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) all.push_back(json::parse(line, nullptr, false));
  return all;
}

const std::vector<std::string> in_volts{"--set", "waveform.main.level=17 V", "--set", "driver.main.max_voltage=21 V"};

std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

class DeviceVerb : public testing::Test {
 protected:
  [[nodiscard]] Outcome told(const std::string& lines, const std::vector<std::string>& more = {}) const {
    write(here.path() / "stdin.txt", lines);
    return here.run(std::vector<std::string>{"device", "gold.toml"} + in_volts + more);
  }
  static std::string shot(int number, const std::string& drives = R"({"main":{"time_s":[0],"V":[17.7]}})") {
    return "{\"shot\":" + std::to_string(number) + ",\"hold_s\":1e-4,\"drives\":" + drives + "}\n";
  }
  Workplace here;
};

TEST_F(DeviceVerb, AnswersEveryShotWithTheRecordOfALaboratory) {
  const Outcome o = told(shot(1) + "\n" + shot(2) + "{\"done\":true}\n" + shot(3));
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(o.err, "") << "nothing of the device is told";
  const std::vector<json> answers = lines_of(o.out);
  ASSERT_EQ(answers.size(), 2U) << "none after the end";
  for (const json& one : answers) {
    EXPECT_EQ(keys(one), (std::set<std::string>{"shot", "edges_s"}));
    EXPECT_GT(one["edges_s"].size(), 3U);
    EXPECT_EQ(one["edges_s"][0][1], 1);
  }
  EXPECT_EQ(told(shot(1) + shot(2)).out, o.out) << "the end of the input ends it too";
  EXPECT_EQ(told(shot(2) + shot(1)).out, lines_of(o.out)[1].dump() + "\n" + lines_of(o.out)[0].dump() + "\n")
      << "shots do not depend on each other";
  EXPECT_NE(told(shot(1) + shot(2), {"--seed", "2"}).out, o.out);
  EXPECT_NE(told(shot(1) + shot(2), {"--model", "modes=+1|gas=veijola|stiffness=1.1"}).out, o.out);
}

TEST_F(DeviceVerb, RefusesWhatItCannotDoAndGoesOn) {
  const std::vector<std::pair<std::string, std::string>> lines{
      {"shoot\n", "the line must be a JSON object: shoot"},
      {"{\"shot\":2}\n", "hold_s: is missing"},
      {"{\"shot\":1.5,\"hold_s\":1e-4,\"drives\":{}}\n", "shot = 1.5: must be a whole number from 1 on"},
      {"{\"shot\":2,\"hold_s\":0,\"drives\":{}}\n", "hold_s = 0: must be above 0"},
      {"{\"shot\":2,\"hold\":1,\"drives\":{}}\n", "hold: unknown key; choose one of shot, hold_s, drives"},
      {shot(2, "{}"), "drives = {}: must be"},
      {shot(2, R"({"main":{"time_s":[0,1e-6],"V":[5]}})"), "drives.main: time_s has 2 numbers and V has 1: must be as many"},
      {shot(2, R"({"main":{"time_s":[0,2e-6,1e-6],"V":[5,5,5]}})"), "drives.main.time_s: must begin at 0 and never decrease"},
      {shot(2, R"({"main":{"time_s":[0],"V":["5 V"]}})"), "drives.main.V = \"5 V\": must be a number"},
      {shot(2, R"({"pzt":{"time_s":[0],"V":[5]}})"), "drives.pzt: unknown drive; choose one of main"},
      {shot(2, R"({"main":{"time_s":[0],"V":[21.5]}})"), "drives.main: the voltage reaches 21.5 V"},
      {shot(2, R"({"main":{"time_s":[0],"V":[-1]}})"), "drives.main: "}};
  std::string all;
  for (const auto& [line, rule] : lines) all += line;
  const Outcome o = told(all + shot(7));
  EXPECT_EQ(o.status, 0);
  const std::vector<json> answers = lines_of(o.out);
  ASSERT_EQ(answers.size(), lines.size() + 1);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(keys(answers[i]), (std::set<std::string>{"shot", "error"})) << lines[i].first;
    EXPECT_THAT(answers[i]["error"].get<std::string>(), HasSubstr(lines[i].second)) << lines[i].first;
  }
  EXPECT_EQ(answers[0]["shot"], nullptr);
  EXPECT_EQ(answers[1]["shot"], 2);
  EXPECT_TRUE(answers.back().contains("edges_s")) << "the shot after them";
}

TEST_F(DeviceVerb, BeginsItsRecordsLateByItsTriggerDelay) {
  const auto edges = [&](const std::vector<std::string>& more) { return lines_of(told(shot(1), more).out)[0]["edges_s"]; };
  const json exact = edges({}), late = edges({"--trigger-delay", "1 us"}), early = edges({"--trigger-delay", "-1 us"});
  ASSERT_EQ(late.size(), exact.size());
  constexpr double rounding = 1e-12;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    EXPECT_NEAR(late[k][0].get<double>(), exact[k][0].get<double>() - 1e-6, rounding);
    EXPECT_NEAR(early[k][0].get<double>(), exact[k][0].get<double>() + 1e-6, rounding);
  }
  EXPECT_THAT(lines_of(told(shot(1), {"--trigger-delay", "1 ms"}).out)[0]["error"].get<std::string>(),
              HasSubstr("the record begins after the contact has closed"));
}

TEST_F(DeviceVerb, NamesTheOptionThatItCannotTake) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> refused{
      {{"--edge-error", "50"}, "--edge-error 50: no unit (expected a time such as \"20 us\")"},
      {{"--unseen", "-1 ns"}, "--unseen -1 ns: must be a time [s], at least 0"},
      {{"--gain-error", "x"}, "--gain-error x: "},
      {{"--trigger-delay", "1 V"}, "--trigger-delay 1 V: must be a time [s]"},
      {{"--drift", "1 %/0"}, "--drift SHARE/ 0: must be a whole number from 1 on"},
      {{"--model", "modes=5"}, "--model modes=5: 'modes=5' must be modes=+N, gas=NAME, stiffness=FACTOR or a key"},
      {{"--model", "gas=air"}, "gas=air: must be "},
      {{"--model", "gap.contact=2 V"}, "--set gap.contact"},
      {{"--seed", "-1"}, "--seed -1: must be a whole number from 0 on"}};
  for (const auto& [words, rule] : refused) {
    const Outcome o = told("", words);
    EXPECT_EQ(o.status, 2) << rule;
    EXPECT_THAT(o.err, HasSubstr(rule));
  }
}

// A device that is tuned quickly: a plate on a spring with one degree of freedom.
constexpr const char* plate = R"(
[structure]
kind = "plate"
mass = "100 ng"
stiffness = "1 N/m"
area = "10000 um^2"
[gap]
electrode = "3 um"
contact = "1.5 um"
[electrode.main]
fringing = "none"
[gas]
model = "linear"
quality_factor = 2
[contact]
model = "linear"
stiffness = "1 kN/m"
[waveform.main]
family = "step"
level = "1.3 Vdp"
[driver.main]
max_voltage = "1.6 Vdp"
[simulate]
accuracy = 1e-4
)";

class TuneVerb : public testing::Test {
 protected:
  TuneVerb() { write(here.path() / "plate.toml", plate); }
  static std::string device(const std::string& more = "") {
    return std::string(SOFTLAND_PROGRAM) + " device plate.toml --seed 4 " + more;
  }
  static std::vector<std::string> words(const std::string& command, const std::vector<std::string>& more = {}) {
    return std::vector<std::string>{"tune", "plate.toml", "--device", command, "--effort", "0.2", "--jobs", "1", "--out", "out"} +
           more;
  }
  [[nodiscard]] json tune_json(const std::string& folder = "out") const {
    return json::parse(read(here.path() / folder / "tune.json"), nullptr, false);
  }
  [[nodiscard]] std::size_t logged(const std::string& folder = "out") const {
    return lines_of(read(here.path() / folder / "closings.jsonl")).size() - 2;
  }
  Workplace here;
};

TEST_F(TuneVerb, LandsADeviceAndLeavesWhatItKnows_optimized) {
  const Outcome o = here.run(words(device(), {"--json", "told.json"}));
  EXPECT_EQ(o.status, 0) << o.err;
  const json j = tune_json();
  EXPECT_EQ(json::parse(read(here.path() / "told.json")), j);
  EXPECT_EQ(j["status"], "done");
  EXPECT_EQ(j["bounce_free_in_a_row"], 5);
  EXPECT_EQ(j["broken_assumption"], nullptr);
  EXPECT_EQ(j["closings"].size(), logged());
  EXPECT_EQ(j["best"]["bounce_free"], true);
  EXPECT_GT(j["belief"]["quantities"].size(), 2U);
  EXPECT_THAT(o.err, AllOf(HasSubstr("softland: closing 1 "), HasSubstr("prediction for the next: touch at ")));
  EXPECT_THAT(o.out, HasSubstr("closes bounce-free"));
  EXPECT_THAT(read(here.path() / "out/tune.html"), HasSubstr("<section id=\"records\">"));
  // The voltages of best.toml are those of best.csv, and within the limits.
  const Outcome run = here.run({"simulate", "out/best.toml", "--quiet", "--json", "-"});
  EXPECT_TRUE(run.status == 0 || run.status == 4) << run.err;
  const Outcome exported = here.run({"export", "out"});
  EXPECT_EQ(exported.out, read(here.path() / "out/best.csv"));
  EXPECT_THAT(exported.err, HasSubstr("this waveform was tuned on one device"));
}

// A tuning continues after a kill, and ends bit for bit like an uninterrupted one.
TEST_F(TuneVerb, GoesOnAfterAKillToTheSameBits_optimized) {
  ASSERT_EQ(here.run(words(device(), {"--closings", "4"})).status % 4, 0);
  const std::string whole = read(here.path() / "out/closings.jsonl");
  const json unbroken = tune_json();
  fs::rename(here.path() / "out", here.path() / "whole");
  const pid_t child = here.start(words(device(), {"--closings", "4"}));
  for (int i = 0; i < 6000 && !fs::exists(here.path() / "out/tune.json"); ++i) std::this_thread::sleep_for(10ms);
  kill(child, SIGKILL);
  EXPECT_EQ(here.finish(child).status, -SIGKILL);
  const std::size_t before = logged();
  EXPECT_GE(before, 1U);
  const Outcome o = here.run(words(device(), {"--closings", "4", "--resume"}));
  EXPECT_EQ(o.status % 4, 0) << o.err;
  EXPECT_EQ(read(here.path() / "out/closings.jsonl"), whole);
  for (const char* part : {"closings", "best", "next", "belief", "status"}) EXPECT_EQ(tune_json()[part], unbroken[part]) << part;
  const Outcome other = here.run(words(device(), {"--resume", "--seed", "2"}));
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("out/closings.jsonl:1: its closings are of another seed: 1 instead of 2"));
  // It starts from the recipes in the log.
  json recipes = lines_of(whole)[1];
  ASSERT_TRUE(recipes.contains("recipes"));
  const auto resumed_with = [&](const std::string& line) {
    const std::size_t begin = whole.find('\n') + 1, end = whole.find('\n', begin);
    write(here.path() / "out/closings.jsonl", whole.substr(0, begin) + line + whole.substr(end));
    return here.run(words(device(), {"--closings", "4", "--resume"})).err;
  };
  recipes["recipes"][0]["x"][1] = 1.02 * recipes["recipes"][0]["x"][1].get<double>();
  EXPECT_THAT(resumed_with(recipes.dump()), HasSubstr("out/closings.jsonl:3: this program proposes another shot"));
  recipes["recipes"][0]["x"].erase(0);
  EXPECT_THAT(resumed_with(recipes.dump()), HasSubstr("out/closings.jsonl: a recipe has"));
  recipes["recipes"][0]["approach"] = "glide";
  EXPECT_THAT(resumed_with(recipes.dump()), HasSubstr("recipes.approach = \"glide\": must be \"catch\" or \"quasi-static\""));
  recipes["recipes"][0]["approach"] = "quasi-static";
  EXPECT_THAT(resumed_with(recipes.dump()), HasSubstr("no drive that is shaped can carry the switch to its contact"));
  EXPECT_THAT(resumed_with(R"({"recipes":[]})"), HasSubstr("out/closings.jsonl:2: recipes = []: must be a list of recipes"));
}

TEST_F(TuneVerb, BeginsWithWhatAnotherDeviceOfTheWaferTold_optimized) {
  ASSERT_EQ(here.run(words(device(), {"--closings", "2", "--quiet"})).status % 4, 0);
  const json first = tune_json();
  fs::rename(here.path() / "out", here.path() / "first");
  const Outcome o = here.run(words(device(), {"--closings", "1", "--quiet", "--wafer", "first"}));
  ASSERT_EQ(o.status % 4, 0) << o.err;
  const json next = tune_json();
  EXPECT_NE(next["closings"][0]["waveforms"], first["closings"][0]["waveforms"]);
  EXPECT_LT(next["closings"][0]["expected_cost"], first["closings"][0]["expected_cost"]);
  EXPECT_NE(next["belief"]["coordinates"]["prior"], first["belief"]["coordinates"]["prior"]);
  // With --resume the wafer must be the same one.
  EXPECT_EQ(here.run(words(device(), {"--closings", "1", "--quiet", "--resume", "--wafer", "first"})).status % 4, 0);
  const Outcome without = here.run(words(device(), {"--closings", "1", "--quiet", "--resume"}));
  EXPECT_EQ(without.status, 2);
  EXPECT_THAT(without.err, HasSubstr("its closings are of another wafer"));
  const Outcome other = here.run(words(device(), {"--wafer", "first", "--set", "gap.contact=1.4 um"}));
  EXPECT_THAT(other.err, HasSubstr("--wafer first: first/tune.json: is a tuning of another scene"));
  EXPECT_THAT(here.run(words(device(), {"--wafer", "none"})).err, HasSubstr("--wafer none: none/tune.json"));
  fs::create_directory(here.path() / "empty");
  write(here.path() / "empty/tune.json", "{}");
  EXPECT_THAT(here.run(words(device(), {"--wafer", "empty"})).err, HasSubstr("empty/tune.json: is a tuning of another scene"));
}

TEST_F(TuneVerb, LosesNothingWhereTheDeviceDies_optimized) {
  const std::string dying = "read -r line; echo \"$line\" | " + device() + "; read -r line; exit 5";
  const Outcome o = here.run(words(dying));
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, HasSubstr("ended with status 5 before it answered shot 2"));
  EXPECT_EQ(logged(), 1U);
  EXPECT_EQ(tune_json()["closings"].size(), 1U);
  EXPECT_EQ(tune_json()["status"], "failed");
  EXPECT_EQ(here.run(words(device(), {"--closings", "2", "--resume"})).status % 4, 0);
  EXPECT_EQ(logged(), 2U);
}

TEST_F(TuneVerb, GivesUpWhereShotAfterShotGivesNoRecord_optimized) {
  const Outcome o = here.run(
      words("n=1; while read -r line; do echo \"{\\\"shot\\\":$n,\\\"error\\\":\\\"no trigger\\\"}\"; n=$((n+1)); done"));
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, HasSubstr("3 shots in a row gave no record; the device said of the last one: no trigger"));
  EXPECT_EQ(logged(), 3U);
}

TEST_F(TuneVerb, EndsItsDeviceWhenItIsInterrupted_optimized) {
  const pid_t child = here.start(words("echo $$ > pid; exec sleep 100"));
  for (int i = 0; i < 6000 && read(here.path() / "pid").find('\n') == std::string::npos; ++i) std::this_thread::sleep_for(10ms);
  const pid_t device_process = std::stoi(read(here.path() / "pid"));
  kill(child, SIGINT);
  const Outcome o = here.finish(child);
  EXPECT_EQ(o.status, 130) << o.err;
  EXPECT_EQ(kill(device_process, 0), -1);
  EXPECT_EQ(tune_json()["status"], "interrupted");
}

TEST_F(TuneVerb, HelpNamesTheAnswerOfWhoDoesNotKnow) {
  EXPECT_THAT(here.run({"tune", "--help"}).out, HasSubstr("\"?\" for an unknown number of openings"));
}

// Invalid answers are refused with a message, and asked for again.
TEST_F(TuneVerb, AsksAPersonWhatTheOscilloscopeShowed_optimized) {
  write(here.path() / "edges.csv", "time_s,closed\n2e-05,1\n2.2e-05,0\n2.4e-05,1\n");
  write(here.path() / "stdin.txt",
        "soon\n36\n36 V\n-3 us\n9 s\n 21.5 us \nmany\n-1\n2\nfailed\nfile none.csv\nfile edges.csv\nnever\nstop\n");
  const Outcome o = here.run({"tune", "plate.toml", "--by-hand", "--effort", "0.2", "--jobs", "1", "--out", "out", "--quiet"});
  EXPECT_EQ(o.status, 4) << "no closing was without a bounce: " << o.err;
  for (const char* said :
       {"load out/shot-1.csv into the generator", "did the contact first close", "36 V: must be a time with its unit",
        "-3 us: must be a time", "9 s: must not be after the end of the record",
        "bounces: many: must be a whole number from 0 on", "none.csv: cannot be read", "shot 4: load out/shot-4.csv"})
    EXPECT_THAT(o.err, HasSubstr(said));
  const json j = tune_json();
  EXPECT_EQ(j["status"], "stopped");
  ASSERT_EQ(j["closings"].size(), 4U);
  EXPECT_EQ(j["closings"][0]["record"], json({{"shot", 1}, {"closing_time_s", 21.5e-6}, {"bounce_count", 2}}));
  EXPECT_EQ(j["closings"][1]["record"]["error"], "the shot failed");
  EXPECT_EQ(j["closings"][2]["record"]["edges_s"].size(), 3U);
  EXPECT_EQ(j["closings"][3]["record"]["edges_s"].size(), 0U);
  EXPECT_TRUE(fs::exists(here.path() / "out/shot-4.csv"));
  write(here.path() / "out/shot-of-mine.csv", "");
  // The voltages that a device would receive, as a waveform for softland.
  write(here.path() / "shot.toml",
        edited(plate, "family = \"step\"\nlevel = \"1.3 Vdp\"", "family = \"table\"\nfile = \"out/shot-1.csv\""));
  EXPECT_EQ(here.run({"check", "shot.toml", "--quiet"}).status, 0);
  const auto held = [&] {
    return std::stod(read(here.path() / "out/shot-1.csv").substr(read(here.path() / "out/shot-1.csv").rfind(',') + 1));
  };
  const double held_at_switch = held();
  // Another tuning in the folder writes its own shots there, for a generator with an amplifier.
  write(here.path() / "stdin.txt", "21.5 us\n2\nstop\n");
  const Outcome amplified = here.run({"tune", "plate.toml", "--by-hand", "--effort", "0.2", "--jobs", "1", "--out", "out",
                                      "--quiet", "--set", "driver.main.amplifier=20"});
  EXPECT_THAT(amplified.err,
              HasSubstr("load out/shot-1.csv into the generator, main in volts at the input of an amplifier of gain 20, "));
  EXPECT_NEAR(held(), held_at_switch / 20, 1e-12 * held_at_switch);
  EXPECT_TRUE(fs::exists(here.path() / "out/shot-2.csv"));
  EXPECT_FALSE(fs::exists(here.path() / "out/shot-4.csv"));
  EXPECT_TRUE(fs::exists(here.path() / "out/shot-of-mine.csv"));
}

// Each format of export for a generator with an amplifier of gain 20, read back.
TEST_F(TuneVerb, WritesItsShotsInEveryFormatOfExport_optimized) {
  const std::vector<std::string> sources{"--sample-rate", "25 MHz", "--bits", "14", "--amplifier", "20"};
  const auto shot_in = [&](const std::string& format, const std::vector<std::string>& more) {
    write(here.path() / "stdin.txt", "stop\n");
    return here.run(std::vector<std::string>{"tune", "plate.toml", "--by-hand", "--format", format, "--effort", "0.02", "--jobs",
                                             "1", "--out", "out", "--quiet"} +
                    more);
  };
  const std::string known = here.run({"export", "plate.toml", "--format", "none"}).err;
  std::istringstream names(known.substr(known.find("one of ") + 7));
  int written = 0;
  for (std::string format; std::getline(names, format, ',');) {
    format.erase(std::remove_if(format.begin(), format.end(), [](unsigned char c) { return std::isspace(c) != 0; }),
                 format.end());
    const Outcome o = shot_in(format, sources);
    if (format == "spice-model" || format == "spice-bench" || format == "verilog-a") {
      EXPECT_EQ(o.status, 2) << format;
      EXPECT_THAT(o.err, HasSubstr("--format " + format + ": is a model of the switch"));
      continue;
    }
    ++written;
    ASSERT_EQ(o.status, 4) << format << ": " << o.err;
    const bool is_of_all = format == "csv" || format == "spice-pwl" || format == "codes";
    const std::string file = std::string("out/shot-1") + (is_of_all ? "" : "-main") +
                             (format == "keysight-arb" ? ".arb"
                              : format == "spice-pwl"  ? ".cir"
                                                       : ".csv");
    EXPECT_THAT(o.err, HasSubstr("load " + file + " into the generator")) << format;
    std::vector<std::string> words{"read", file, "--json", "-"};
    if (format == "codes") words = words + std::vector<std::string>{"--set", "interval=40 ns"};
    const Outcome back = here.run(words);
    ASSERT_EQ(back.status, 0) << format << ": " << back.err;
    const json channel = json::parse(back.out)["channels"][0];
    const double held = tune_json()["next"]["waveforms"]["main"].back()[1].get<double>();
    const json limits =
        json::parse(here.run({"check", "out/best.toml", "--json", "-", "--quiet"}).out)["scene"]["driver"]["main"];
    constexpr double highest_code = 16383, of_samples = 2e-4;  // highest code of 14 bits; error over the range
    const double highest = std::stod(limits["max_voltage"].get<std::string>());
    const double last = channel["last"].get<double>() * (format == "codes" ? highest / highest_code : 20);
    EXPECT_NEAR(last, held, of_samples * highest) << format;
    if (format != "csv" && format != "spice-pwl") {
      EXPECT_GT(channel["samples"].get<int>(), 100) << format;
    }
  }
  EXPECT_EQ(written, 8);
  // Settings of the source in the scene give the same file. Without any settings the shot is refused.
  ASSERT_EQ(shot_in("rigol-csv", sources).status, 4);
  const std::string by_options = read(here.path() / "out/shot-1-main.csv");
  ASSERT_EQ(shot_in("rigol-csv", {"--set", "driver.main.sample_rate=25 MHz", "--set", "driver.main.bits=14", "--set",
                                  "driver.main.amplifier=20"})
                .status,
            4);
  EXPECT_EQ(read(here.path() / "out/shot-1-main.csv"), by_options);
  EXPECT_THAT(shot_in("rigol-csv", {}).err, HasSubstr("drive 'main' takes no samples: give --sample-rate"));
  EXPECT_THAT(shot_in("codes", {"--sample-rate", "25 MHz"}).err, HasSubstr("drive 'main' has no integers: give --bits"));
  EXPECT_THAT(shot_in("rigol", sources).err, HasSubstr("--format rigol: must be one of csv"));
}

// A waveform that landed once and bounces when it is fired again is no success; one that lands again is. The touch times are
// those that the tuner expects, so that a waveform that landed remains the best known.
TEST_F(TuneVerb, FiresTheWaveformKeptOnceMoreBeforeItEnds_optimized) {
  constexpr int most = 6;
  const auto answered = [&](int shot, const json& touch, int bounces, const std::vector<std::string>& more) {
    const json answer{{"shot", shot}, {"closing_time_s", touch}, {"bounce_count", bounces}};
    return here.run(words("read -r line; echo '" + answer.dump() + "'; read -r line",
                          std::vector<std::string>{"--quiet", "--closings", std::to_string(shot)} + more));
  };
  ASSERT_EQ(answered(1, 2.15e-5, 0, {}).status, 0);
  ASSERT_EQ(answered(1, tune_json()["closings"][0]["predicted"]["touch_median_s"], 0, {}).status, 0);
  const auto was_fired_before = [](const json& closings) {
    for (std::size_t k = 0; k + 1 < closings.size(); ++k) {
      if (closings[k]["waveforms"] == closings.back()["waveforms"]) return true;
    }
    return false;
  };
  for (int shot = 2; shot <= most; ++shot) {
    const json touch = tune_json()["next"]["predicted"]["touch_median_s"];
    fs::remove_all(here.path() / "before");
    fs::copy(here.path() / "out", here.path() / "before", fs::copy_options::recursive);
    const Outcome lands = answered(shot, touch, 0, {"--resume"});
    ASSERT_EQ(lands.status, 0) << lands.err;
    EXPECT_EQ(tune_json()["best"]["landed_last"], true);
    EXPECT_EQ(tune_json()["best"]["shot"], shot);
    if (!was_fired_before(tune_json()["closings"])) continue;
    fs::remove_all(here.path() / "out");
    fs::copy(here.path() / "before", here.path() / "out", fs::copy_options::recursive);
    const Outcome bounces = answered(shot, touch, 3, {"--resume"});
    EXPECT_EQ(bounces.status, 4) << "it landed before, and not when it was fired last: " << bounces.err;
    EXPECT_TRUE(was_fired_before(tune_json()["closings"]));
    EXPECT_EQ(tune_json()["best"]["landed_last"], false);
    return;
  }
  FAIL() << "no waveform that landed is kept";
}

// The voltage at the contact, in the file of an oscilloscope.
TEST_F(TuneVerb, TakesTheFileOfAnOscilloscope_optimized) {
  write(here.path() / "scope.csv", "time (us),CH1 (V)\n0,3.3\n20,3.3\n22,0.1\n24,0.1\n26,3.3\n28,0.1\n30,0.1\n");
  write(here.path() / "stdin.txt", "file none.csv\nfile scope.csv\nstop\n");
  const auto words = [](const std::vector<std::string>& more) {
    return std::vector<std::string>{"tune",   "plate.toml", "--by-hand", "--effort", "0.2",
                                    "--jobs", "1",          "--out",     "out",      "--quiet"} +
           more;
  };
  const Outcome o = here.run(words({"--contact", "threshold=1.7 V", "--contact", "closed=below"}));
  EXPECT_EQ(o.status, 4) << o.err;
  EXPECT_THAT(o.err, HasSubstr("none.csv"));
  const json edges = tune_json()["closings"][0]["record"]["edges_s"];
  ASSERT_EQ(edges.size(), 3U);
  const std::vector<double> due{21e-6, 25e-6, 27e-6};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(edges[k][0].get<double>(), due[k], 1e-12);
    EXPECT_EQ(edges[k][1], k % 2 == 0 ? 1 : 0);
  }
  EXPECT_THAT(here.run(words({"--contact", "closed=below"})).err, HasSubstr("scope.csv: missing key 'threshold'"));
  EXPECT_THAT(here.run({"tune", "plate.toml", "--device", "x", "--contact", "threshold=1 V"}).err,
              HasSubstr("--contact requires --by-hand: it says how to read the recorded files"));
}

TEST_F(TuneVerb, TakesTheCaptureOfALogicAnalyser_optimized) {
  write(here.path() / "capture.vcd",
        "$timescale 1 us $end $var wire 1 ! D0 $end $var wire 1 \" D1 $end $enddefinitions $end\n"
        "#0 0! 1\"\n#21 1!\n#25 0!\n#27 1!\n");
  write(here.path() / "stdin.txt", "file capture.vcd\nstop\n");
  const Outcome o = here.run(
      {"tune", "plate.toml", "--by-hand", "--effort", "0.2", "--jobs", "1", "--out", "out", "--quiet", "--contact", "column=D0"});
  EXPECT_EQ(o.status, 4) << o.err;
  EXPECT_EQ(tune_json()["closings"][0]["record"]["edges_s"], json::parse("[[21e-6, 1], [25e-6, 0], [27e-6, 1]]"));
}

// A switch that closes within nanoseconds: the assumed errors of the instruments scale with it.
TEST_F(TuneVerb, TakesASwitchThatIsQuickerThanAnOscilloscope_slow) {
  fs::copy_file(fs::path(SOFTLAND_SOURCE_DIR) / "scenes/nem-tin.toml", here.path() / "nem.toml");
  const Outcome o = here.run({"tune", "nem.toml", "--device", std::string(SOFTLAND_PROGRAM) + " device nem.toml --seed 3",
                              "--effort", "0.02", "--closings", "1", "--out", "out", "--quiet"});
  EXPECT_EQ(o.status % 4, 0) << o.err;
  EXPECT_EQ(logged(), 1U);
}

TEST_F(TuneVerb, NamesTheOptionThatItCannotTake) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> refused{
      {{}, "give either --device COMMAND or --by-hand: it says how shots are fired"},
      {{"--device", "x", "--by-hand"}, "give either --device COMMAND or --by-hand"},
      {{"--device", "x", "--closings", "0"}, "--closings 0: must be a whole number from 1 on"},
      {{"--device", "x", "--timeout", "0 s"}, "--timeout 0 s: must be above 0 s"},
      {{"--device", "x", "--timeout", "3"}, "--timeout 3: no unit (expected a time such as \"20 us\")"},
      {{"--device", "x", "--constrain", "initial_contact_time < 33"}, "--constrain: "},
      {{"--device", "x", "--constrain", "impact_velocity < 1 mm/s"}, "a condition must limit initial_contact_time from above"},
      {{"--device", "x", "--trigger-delay", "1 V"}, "--trigger-delay 1 V: must be a time [s]"},
      {{"--device", "x", "--format", "csv"}, "--format, --sample-rate, --bits and --amplifier require --by-hand"},
      {{"--by-hand", "--amplifier", "0"}, "--amplifier"},
      {{"--device", "x", "--actuator", "hand"}, "--actuator hand: must be electrostatic"},
      {{"--device", "x", "--resume"}, "closings.jsonl: there is no such file"}};
  for (const auto& [words, rule] : refused) {
    const Outcome o = here.run(std::vector<std::string>{"tune", "plate.toml"} + words);
    EXPECT_EQ(o.status, 2) << rule;
    EXPECT_THAT(o.err, HasSubstr(rule));
    EXPECT_THAT(o.err, Not(HasSubstr("internal")));
  }
}

}  // namespace
}  // namespace softland
