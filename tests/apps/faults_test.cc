// Tests faults around the program, for every verb: lost output, signals, bad files. The verbs are those that the program lists,
// so that a new one is included.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "program.h"
#include "tests/exchange/mode_samples.h"

namespace softland {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

constexpr int bad_input = 2, output_lost = 74, interrupted = 130;
constexpr std::array stopping_signals{SIGINT, SIGTERM, SIGHUP, SIGXCPU};

struct Call {
  std::vector<std::string> quick;  ///< prints something at once
  std::vector<std::string> slow;   ///< runs for many seconds; empty for a verb that never does
};

const std::vector<std::string> in_volts{"--set", "waveform.main.level=17 V", "--set", "driver.main.max_voltage=60 V"};

std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// The first word that is not an option is the input of the verb.
std::map<std::string, Call> calls() {
  const std::vector<std::string> short_window{"--set", "simulate.duration=60 us"},
      long_window{"--set", "simulate.duration=100 ms"};
  const std::vector<std::string> many{"--set", "structure.modes=20", "--set", "gas.model=reynolds"};
  const std::vector<std::string> pulse{"--set",
                                       "waveform.main={family=\"pulse\", levels=[\"20 V\", \"0 V\", \"17 V\"], "
                                       "times=[\"20 us\", "
                                       "\"32 us\"]}"};
  const std::vector<std::string> gold{"gold.toml"};
  return {
      {"simulate", {gold + in_volts + short_window, gold + in_volts + many + long_window}},
      {"pull-in", {gold + in_volts, gold + in_volts + many}},
      {"modes", {gold + in_volts, gold + many}},
      {"check",
       {gold + in_volts, gold + in_volts + many + long_window +
                             std::vector<std::string>{"--set", "simulate.effects=auto", "--set", "simulate.accuracy=1e-8"}}},
      {"effects", {gold + in_volts + short_window, gold + in_volts + many + long_window}},
      {"accuracy", {gold + std::vector<std::string>{"--set", "waveform.main.level=3 V"}, {"slow.toml"}}},
      {"optimize",
       {gold + in_volts + std::vector<std::string>{"--robust", "none", "--budget", "6", "--set", "simulate.duration=150 us"},
        gold + in_volts + std::vector<std::string>{"--robust", "none", "--budget", "1000000"}}},
      {"limit",
       {gold + in_volts + std::vector<std::string>{"--set", "structure.modes=1", "--no-curves"},
        gold + in_volts + std::vector<std::string>{"--set", "structure.modes=12"}}},
      {"release",
       {gold + in_volts + std::vector<std::string>{"--budget", "40"},
        gold + in_volts + std::vector<std::string>{"--budget", "10000000"}}},
      {"cycle",
       {gold + in_volts + short_window + std::vector<std::string>{"--rate", "5 kHz", "--no-scan", "--cycles", "2"},
        gold + in_volts + std::vector<std::string>{"--rate", "1 kHz", "--search", "--budget", "10000000"}}},
      {"robustness",
       {gold + in_volts + short_window + std::vector<std::string>{"--samples", "10"},
        gold + in_volts + std::vector<std::string>{"--samples", "1000000"}}},
      {"calibrate",
       {gold + in_volts + pulse + std::vector<std::string>{"--samples", "16", "--steps", "1.5"},
        gold + in_volts + pulse + std::vector<std::string>{"--samples", "100000"}}},
      {"explore",
       {gold + in_volts + short_window + std::vector<std::string>{"--vary", "gap.contact=1.9 um,2 um", "--resume"},
        gold + in_volts + many + long_window + std::vector<std::string>{"--vary", "gap.contact=1.9 um:2.1 um:9"}}},
      {"fit", {gold + in_volts + std::vector<std::string>{"--data", "bench.toml", "--starts", "1"}, {}}},
      {"tune",
       {gold + in_volts +
            std::vector<std::string>{"--set", "structure.modes=1", "--effort", "0.01", "--closings", "1", "--device",
                                     "echo '{\"shot\":1,\"edges_s\":[[3e-05,1]]}'"},
        gold + in_volts + std::vector<std::string>{"--effort", "100", "--device", "cat"}}},
      {"device", {gold + in_volts, {}}},
      {"table", {{"part.sqlite"}, {}}},
      {"status", {{"part.sqlite"}, {}}},
      {"merge", {{"part.sqlite", "--out", "merged.sqlite"}, {}}},
      {"slurm", {{"part.sqlite", "--tasks", "2", "--out", "later.sqlite"}, {}}},
      {"new", {{"plate"}, {}}},
      {"export", {{"volts.toml"}, {"slow.toml"}}},
      {"report", {{"run"}, {}}},
      {"read", {{"scope.csv"}, {}}},
  };
}

// Makes the scenes of the verbs that take no --set, and a line for those that read standard input.
std::unique_ptr<Workplace> workplace() {
  auto place = std::make_unique<Workplace>();
  const std::string gold = shipped("mem-gold.toml");
  write(place->path() / "volts.toml", edited(edited(gold, "1.25 Vdp", "17 V"), "1.5 Vdp", "60 V"));
  write(place->path() / "stdin.txt", "{\"shot\":1,\"hold_s\":1e-4,\"drives\":{\"main\":{\"time_s\":[0],\"V\":[17]}}}\n");
  write(place->path() / "bench.toml", "[[measurement]]\nquantity = \"frequency\"\nvalue = \"25 kHz\"\nerror = \"1 %\"\n");
  write(place->path() / "scope.csv", "TIME,CH1\n0,0\n1e-6,1\n2e-6,17\n");
  write(place->path() / "slow.toml", edited(edited(gold, "modes = 4", "modes = 20"), "\"strip\"", "\"reynolds\""));
  return place;
}

class Faults : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    here = workplace().release();
    ASSERT_EQ(here->run(std::vector<std::string>{"explore"} + calls()["explore"].quick +
                        std::vector<std::string>{"--out", "part.sqlite"})
                  .status,
              0);
    ASSERT_EQ(
        here->run(std::vector<std::string>{"simulate"} + calls()["simulate"].quick + std::vector<std::string>{"--out", "run"})
            .status,
        0);
    std::istringstream help(here->run({"--help"}).out);
    bool listed = false;
    for (std::string line; std::getline(help, line);) {
      if (line == "Verbs:") {
        listed = true;
      } else if (line.empty()) {
        listed = false;
      } else if (listed && line[2] != ' ') {
        verbs.push_back(line.substr(2, line.find(' ', 2) - 2));
      }
    }
  }
  static void TearDownTestSuite() {
    delete here;
    here = nullptr;
  }
  static std::vector<std::string> words(const std::string& verb, const std::vector<std::string>& more) {
    fs::remove(here->path() / "merged.sqlite");  // a merge does not replace a store
    return std::vector<std::string>{verb} + more;
  }
  static bool reads_stores_only(const std::string& verb) { return verb == "table" || verb == "status" || verb == "merge"; }
  static bool takes(const std::string& verb, const char* option) {
    return here->run({verb, "--help"}).out.find(std::string("\n  ") + option) != std::string::npos;
  }

  static void expect_each_ends(const std::vector<std::pair<std::string, int>>& told);

  static inline Workplace* here = nullptr;
  static inline std::vector<std::string> verbs;
};

// A pipe whose buffer is full.
class FullPipe {
 public:
  FullPipe() {
    if (pipe2(ends_, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    fcntl(ends_[1], F_SETFL, O_NONBLOCK);
    const std::string block(4096, 'x');
    while (::write(ends_[1], block.data(), block.size()) > 0) {
    }
    fcntl(ends_[1], F_SETFL, 0);
  }
  ~FullPipe() {
    ::close(ends_[0]);
    ::close(ends_[1]);
  }
  FullPipe(const FullPipe&) = delete;
  FullPipe& operator=(const FullPipe&) = delete;
  [[nodiscard]] int end() const { return ends_[1]; }

 private:
  int ends_[2];
};

TEST_F(Faults, AreTriedOnEveryVerb) {
  std::vector<std::string> known;
  for (const auto& [verb, call] : calls()) known.push_back(verb);
  EXPECT_THAT(verbs, testing::UnorderedElementsAreArray(known)) << "say above how a new verb is called";
}

TEST_F(Faults, OutputThatIsLostIsAnErrorOfEveryVerb_optimized) {
  const int full = open("/dev/full", O_WRONLY | O_CLOEXEC);
  int broken[2];
  ASSERT_EQ(pipe2(broken, O_CLOEXEC), 0);
  close(broken[0]);
  const std::map<std::string, std::pair<int, std::string>> places{{"full disk", {full, "No space left on device"}},
                                                                  {"closed", {Workplace::closed, "Bad file descriptor"}},
                                                                  {"closed pipe", {broken[1], "Broken pipe"}}};
  for (const std::string& verb : verbs) {
    for (const auto& [place, out] : places) {
      const Outcome o = here->run(words(verb, calls()[verb].quick), SOFTLAND_PROGRAM, out.first);
      EXPECT_EQ(o.status, output_lost) << verb << ", " << place;
      EXPECT_THAT(o.err, HasSubstr("softland: standard output: could not be written: " + out.second)) << verb << ", " << place;
    }
    if (!takes(verb, "--json")) continue;
    const std::vector<std::string> as_json = calls()[verb].quick + std::vector<std::string>{"--json", "-"};
    EXPECT_EQ(here->run(words(verb, as_json), SOFTLAND_PROGRAM, full).status, output_lost) << verb << " --json -";
  }
  for (const std::vector<std::string>& told : {std::vector<std::string>{"--help"}, {"--version"}, {"optimize", "--help"}})
    EXPECT_EQ(here->run(told, SOFTLAND_PROGRAM, full).status, output_lost) << told.front();
  close(full);
  close(broken[1]);
}

// The kernel then sends a signal that by default would end the program without a message.
TEST_F(Faults, AFileAboveItsLimitIsAnErrorOfEveryVerbThatWritesOne_optimized) {
  const auto limited = [&](const std::vector<std::string>& more) {
    return here->run(std::vector<std::string>{"-c", "ulimit -f 0; exec \"$0\" \"$@\"", SOFTLAND_PROGRAM} + more, "/bin/sh",
                     open("/dev/null", O_WRONLY | O_CLOEXEC));
  };
  for (const std::string& verb : verbs) {
    for (const char* option : {"--json", "--out"}) {
      if (!takes(verb, option)) continue;
      if (verb == "accuracy" && option == std::string("--out")) continue;  // accuracy writes no report for this quick scene
      if (verb == "slurm") continue;                                       // its --out names the script
      std::vector<std::string> more = calls()[verb].quick;
      if (verb != "merge")
        more = more + std::vector<std::string>{option, option == std::string("--out") ? "lost-" + verb : "lost.json"};
      if (verb == "modes" && option == std::string("--out")) {
        write(here->path() / "beam.frd", test::sample_frd());
        more = {"--from", "beam.frd", "--axis", "x", "--direction", "-z", option, "lost.csv"};
      }
      if (verb == "pull-in" && option == std::string("--out")) more = more + std::vector<std::string>{"--sweep", "0 V:10 V:3"};
      if (verb == "optimize" && option == std::string("--json")) more = more + std::vector<std::string>{"--out", "lost"};
      EXPECT_EQ(limited(words(verb, more)).status, output_lost) << verb << " " << option;
      EXPECT_THAT(read(here->path() / "stderr.txt"), Not(HasSubstr("internal"))) << verb << " " << option;
    }
  }
  EXPECT_FALSE(fs::exists(here->path() / "lost.json"));
  EXPECT_FALSE(fs::exists(here->path() / "lost-simulate/report.html"));
}

// True if every member of `part`, at any depth, has the same value in `all`.
bool holds(const json& all, const json& part) {
  if (!part.is_object() || !all.is_object()) return all == part;
  return std::ranges::all_of(part.items(),
                             [&](const auto& one) { return all.contains(one.key()) && holds(all[one.key()], one.value()); });
}

// The folder has the output of --json as well, in some verbs with further members such as curves.
TEST_F(Faults, TheJsonOfAFolderIsThatOfTheOption_optimized) {
  int compared = 0;
  for (const std::string& verb : verbs) {
    if (!takes(verb, "--json") || !takes(verb, "--out") || reads_stores_only(verb) || verb == "slurm" || verb == "explore" ||
        verb == "modes")
      continue;
    std::vector<std::string> more = calls()[verb].quick;
    if (verb == "accuracy") more = {"gold.toml", "--set", "structure.modes=1", "--set", "simulate.duration=60 us"};
    if (verb == "pull-in") more = more + std::vector<std::string>{"--sweep", "0 V:10 V:3"};
    const fs::path folder = here->path() / ("told-" + verb);
    const Outcome o = here->run(words(verb, more + std::vector<std::string>{"--json", "told.json", "--out", folder.string()}));
    ASSERT_TRUE(fs::exists(here->path() / "told.json")) << verb << ": " << o.err;
    const json told = json::parse(read(here->path() / "told.json"));
    fs::remove(here->path() / "told.json");
    if (!fs::is_directory(folder)) continue;  // the verb writes a table
    for (const fs::directory_entry& one : fs::directory_iterator(folder)) {
      if (one.path().extension() != ".json") continue;
      ++compared;
      const json kept = json::parse(read(one.path()));
      for (const auto& [key, value] : told.items())
        EXPECT_TRUE(kept.contains(key) && holds(kept[key], value)) << verb << ": " << key << " in " << one.path().filename();
    }
  }
  EXPECT_GE(compared, 7);
}

// Sends each verb its signal while it waits.
void Faults::expect_each_ends(const std::vector<std::pair<std::string, int>>& told) {
  std::vector<std::unique_ptr<Workplace>> places;
  std::vector<pid_t> children;
  const FullPipe pipe;
  for (const auto& [verb, signal] : told) {
    const auto& place = places.emplace_back(workplace());
    fs::copy(here->path() / "run", place->path() / "run", fs::copy_options::recursive);
    fs::copy(here->path() / "part.sqlite", place->path() / "part.sqlite");
    children.push_back(place->start(words(verb, calls()[verb].quick), SOFTLAND_PROGRAM, pipe.end()));
  }
  for (const pid_t child : children) wait_until_it_waits(child);
  for (std::size_t k = 0; k < told.size(); ++k) EXPECT_EQ(kill(children[k], told[k].second), 0);
  for (std::size_t k = 0; k < told.size(); ++k)
    EXPECT_EQ(places[k]->finish(children[k]).status, interrupted) << told[k].first << ", signal " << told[k].second;
}

TEST_F(Faults, ASignalEndsEveryVerbThatWaitsForItsReader_optimized) {
  std::vector<std::pair<std::string, int>> told;
  for (const std::string& verb : verbs) told.emplace_back(verb, stopping_signals[told.size() % std::size(stopping_signals)]);
  expect_each_ends(told);
}

TEST_F(Faults, EverySignalEndsEveryVerbThatWaitsForItsReader_slow) {
  for (const int signal : stopping_signals) {
    std::vector<std::pair<std::string, int>> told;
    for (const std::string& verb : verbs) told.emplace_back(verb, signal);
    expect_each_ends(told);
  }
}

TEST_F(Faults, EverySignalEndsEveryVerbThatComputesAndItsJsonSaysSo_slow) {
  for (const int signal : stopping_signals) {
    std::vector<std::pair<std::string, std::unique_ptr<Workplace>>> places;
    std::vector<pid_t> children;
    for (const std::string& verb : verbs) {
      if (calls()[verb].slow.empty()) continue;
      const auto& place = places.emplace_back(verb, workplace()).second;
      std::vector<std::string> more = calls()[verb].slow;
      if (takes(verb, "--json")) more = more + std::vector<std::string>{"--json", "out.json"};
      children.push_back(place->start(words(verb, more)));
    }
    for (const pid_t child : children) wait_until_it_computes(child);
    const auto sent = std::chrono::steady_clock::now();
    for (const pid_t child : children) EXPECT_EQ(kill(child, signal), 0);
    for (std::size_t k = 0; k < children.size(); ++k) {
      const auto& [verb, place] = places[k];
      const Outcome o = place->finish(children[k]);
      EXPECT_EQ(o.status, interrupted) << verb << ", signal " << signal << ": " << o.err;
      if (!takes(verb, "--json")) continue;
      const std::string told = read(place->path() / "out.json");
      const json j = json::parse(told, nullptr, false);
      EXPECT_THAT(told, Not(HasSubstr("is not reached"))) << verb;
      EXPECT_EQ(j.is_object() ? j.value("status", "") : "", "interrupted")
          << verb << ", signal " << signal << ": " << told.substr(0, 200);
    }
    EXPECT_LT(std::chrono::steady_clock::now() - sent, 60s) << "signal " << signal;
  }
}

// A closing terminal sends SIGHUP twice, `timeout` SIGTERM, and the kernel SIGXCPU every second.
TEST_F(Faults, ASignalThatComesAgainLetsResultsBeSaved) {
  for (const int signal : {SIGTERM, SIGHUP, SIGXCPU}) {
    const auto place = workplace();
    const pid_t child = place->start(words("simulate", calls()["simulate"].slow + std::vector<std::string>{"--out", "out"}));
    wait_until_it_computes(child);
    for (int i = 0; i < 50; ++i) {
      kill(child, signal);
      std::this_thread::sleep_for(2ms);
    }
    EXPECT_EQ(place->finish(child).status, interrupted) << "signal " << signal;
    EXPECT_EQ(json::parse(read(place->path() / "out/result.json"), nullptr, false).value("status", ""), "interrupted");
  }
}

TEST_F(Faults, ASecondCtrlCEndsAtOnce) {
  const FullPipe pipe;
  const pid_t child = here->start({"new", "plate"}, SOFTLAND_PROGRAM, pipe.end());
  wait_until_it_waits(child);
  for (int i = 0; i < 100 && process_state(child).state != 'Z'; ++i) {
    kill(child, SIGINT);
    std::this_thread::sleep_for(10ms);
  }
  EXPECT_EQ(here->finish(child).status, -SIGINT);
}

// A terminal shows a progress bar, which is removed when the verb ends; with --quiet it shows none.
TEST_F(Faults, EveryVerbThatTakesLongShowsHowFarItIs_slow) {
  // After chroot, /dev/pts may be missing.
  const int found = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (found < 0 || grantpt(found) != 0) GTEST_SKIP() << "skipped: no pseudo-terminals";
  close(found);
  for (const bool quiet : {false, true}) {
    std::vector<std::pair<std::string, std::unique_ptr<Workplace>>> places;
    std::vector<pid_t> children;
    std::vector<int> terminals;
    for (const std::string& verb : verbs) {
      if (calls()[verb].slow.empty() || (quiet && !takes(verb, "--quiet"))) continue;
      const int terminal = terminals.emplace_back(posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC));
      ASSERT_TRUE(grantpt(terminal) == 0 && unlockpt(terminal) == 0);
      const int screen = open(ptsname(terminal), O_RDWR | O_NOCTTY | O_CLOEXEC);
      const auto& place = places.emplace_back(verb, workplace()).second;
      std::vector<std::string> more = calls()[verb].slow;
      if (quiet) more.emplace_back("--quiet");
      children.push_back(place->start(words(verb, more), SOFTLAND_PROGRAM, Workplace::to_file, screen));
      close(screen);
    }
    for (const pid_t child : children) wait_until_it_computes(child);
    std::this_thread::sleep_for(1500ms);
    for (std::size_t k = 0; k < children.size(); ++k) {
      kill(children[k], SIGTERM);
      EXPECT_EQ(places[k].second->finish(children[k]).status, interrupted) << places[k].first;
      std::string shown;
      std::array<char, 4096> block{};
      for (ssize_t n = 0; (n = ::read(terminals[k], block.data(), block.size())) > 0;)
        shown.append(block.data(), static_cast<std::size_t>(n));
      close(terminals[k]);
      if (quiet) {
        EXPECT_THAT(shown, testing::AnyOf("", "softland: interrupted\r\n")) << places[k].first;
      } else {
        EXPECT_THAT(shown, testing::ContainsRegex("\r\\[[#.]{24}\\] [^\r]*[0-9] s[^\r]*\033\\[K")) << places[k].first;
      }
    }
  }
}

// A signal that is ignored from the start, as under nohup, stays ignored.
TEST_F(Faults, AnIgnoredSignalStaysIgnored) {
  const pid_t child =
      here->start({"-c", "trap '' HUP; : > ignoring; exec \"$0\" simulate gold.toml", SOFTLAND_PROGRAM}, "/bin/sh");
  for (int i = 0; i < 600 && !fs::exists(here->path() / "ignoring"); ++i) std::this_thread::sleep_for(10ms);
  for (int i = 0; i < 20; ++i) {
    std::this_thread::sleep_for(5ms);
    kill(child, SIGHUP);
  }
  EXPECT_EQ(here->finish(child).status, 0);
}

TEST_F(Faults, WhatIsNoRegularFileOrTooLargeIsReadByNoVerb) {
  mkfifo((here->path() / "pipe.toml").c_str(), 0600);
  fs::create_directory(here->path() / "folder.toml");
  write(here->path() / "large.toml", "");
  fs::resize_file(here->path() / "large.toml", 100'000'000);  // a sparse file
  const std::map<std::string, std::string> files{{"/dev/zero", "is a device, it must be a regular file"},
                                                 {"pipe.toml", "is a pipe, it must be a regular file"},
                                                 {"folder.toml", "is a folder, it must be a regular file"},
                                                 {"large.toml", "is too large, it must have at most 64 MiB"},
                                                 {"absent.toml", "cannot be read: No such file or directory"}};
  for (const auto& [name, message] : files) {
    for (const std::string& verb : verbs) {
      if (verb == "new") continue;  // it reads no file of the user
      std::vector<std::string> more = calls()[verb].quick;
      more.front() = name;
      const Outcome o = here->run(words(verb, more));
      EXPECT_EQ(o.status, bad_input) << verb << " " << name;
      const bool needs_a_file = verb == "fit" || verb == "optimize" || verb == "explore" || verb == "read";
      if (name == "folder.toml" && !needs_a_file && !reads_stores_only(verb))
        continue;  // an empty folder, which the verb takes for a folder of results
      if (reads_stores_only(verb)) {
        EXPECT_THAT(o.err, testing::StartsWith("softland: " + name + ": ")) << verb;
      } else {
        EXPECT_EQ(o.err, "softland: " + name + ": " + message + "\n") << verb;
      }
    }
    // A table of a waveform, named by the scene.
    write(here->path() / "table.toml", edited(shipped("mem-gold.toml"), "family = \"step\"\nlevel = \"1.25 Vdp\"",
                                              "family = \"table\"\nfile = \"" + name + "\""));
    const Outcome o = here->run({"simulate", "table.toml"});
    EXPECT_EQ(o.status, bad_input) << name;
    EXPECT_THAT(o.err, HasSubstr(message)) << name;
  }
  // The text of results is read in the same way.
  fs::create_directory(here->path() / "zero");
  fs::create_symlink("/dev/zero", here->path() / "zero/result.json");
  for (const char* verb : {"report", "export", "robustness", "calibrate"})
    EXPECT_EQ(here->run({verb, "zero"}).err, "softland: zero/result.json: is a device, it must be a regular file\n");
}

TEST_F(Faults, NoOutputTakesThePlaceOfAnInput) {
  const std::string scene = shipped("mem-gold.toml");
  fs::create_symlink("gold.toml", here->path() / "link.toml");
  fs::create_hard_link(here->path() / "gold.toml", here->path() / "hard.toml");
  const std::string absolute = (here->path() / "gold.toml").string();
  for (const std::string& verb : verbs) {
    if (!takes(verb, "--json")) continue;
    const std::vector<std::string> inputs = reads_stores_only(verb) || verb == "read"
                                                ? std::vector<std::string>{calls()[verb].quick.front()}
                                                : std::vector<std::string>{"gold.toml", "link.toml", "hard.toml", absolute};
    for (const std::string& place : inputs) {
      const Outcome o = here->run(words(verb, calls()[verb].quick + std::vector<std::string>{"--json", place}));
      EXPECT_EQ(o.status, bad_input) << verb << " " << place;
      EXPECT_EQ(o.err.substr(0, o.err.find('\n')).substr(std::max<std::size_t>(o.err.find(place), 0)),
                place + (place.ends_with(".sqlite") ? ": is the store of a study, so it is not replaced"
                                                    : ": is read by this run, so its output does not replace it"))
          << verb;
    }
  }
  EXPECT_EQ(read(here->path() / "gold.toml"), scene);
  // A table that the scene names, and the scene of an earlier search.
  fs::create_directory(here->path() / "both");
  write(here->path() / "both/trajectory.csv", "time_s,main\n0,0\n1e-6,17\n");
  write(here->path() / "both/best.toml",
        edited(scene, "family = \"step\"\nlevel = \"1.25 Vdp\"", "family = \"table\"\nfile = \"trajectory.csv\""));
  const std::string before = read(here->path() / "both/best.toml");
  EXPECT_EQ(here->run({"simulate", "both/best.toml", "--out", "both"}).err,
            "softland: --out both: both/trajectory.csv would be replaced, which this run reads; name another folder\n");
  EXPECT_EQ(here->run({"optimize", "both/best.toml", "--quiet", "--out", "both"}).err,
            "softland: --out both: both/best.toml would be replaced, which this run reads; name another folder\n");
  EXPECT_EQ(read(here->path() / "both/best.toml"), before);
  EXPECT_EQ(here->run({"simulate", "gold.toml", "--out", "one", "--json", "one/result.json"}).err,
            "softland: --json one/result.json: is the result.json that --out writes; name another file\n");
}

TEST_F(Faults, OnlyARegularFileIsReplaced) {
  mkfifo((here->path() / "pipe.json").c_str(), 0600);
  const Outcome o = here->run({"modes", "gold.toml", "--json", "pipe.json"});
  EXPECT_EQ(o.status, bad_input);
  EXPECT_EQ(o.err, "softland: pipe.json: is no regular file, so it is not replaced\n");
  EXPECT_TRUE(fs::is_fifo(here->path() / "pipe.json"));
  write(here->path() / "real.json", "old");
  fs::create_symlink("real.json", here->path() / "link.json");
  EXPECT_EQ(here->run({"modes", "gold.toml", "--json", "link.json"}).status, 0);
  EXPECT_TRUE(fs::is_symlink(here->path() / "link.json"));
  EXPECT_TRUE(json::accept(read(here->path() / "real.json")));
}

// True for bytes that control a terminal: C0 except line feed and tab, DEL, and in UTF-8 C1 and characters of direction.
bool acts_on_a_terminal(const std::string& text) {
  const bool control = std::any_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && c != '\n' && c != '\t') || byte == 0x7f;
  });
  return control || text.find("\u009b") != std::string::npos || text.find("\u202e") != std::string::npos ||
         text.find("\u2066") != std::string::npos;
}

TEST_F(Faults, NothingThatActsOnATerminalReachesIt_slow) {
  const std::string evil = "\x1b]0;owned\a\x1b[31m\u009b2J\u202eabc\u2066\x7f";
  const std::string title = R"("\u001b]0;owned\u0007\u001b[31m\u009b2J\u202eabc\u2066\u007f")";
  const std::string scene = shipped("mem-gold.toml");
  const std::string name = evil + ".toml";
  write(here->path() / name, "title = " + title + scene.substr(scene.find('\n', scene.find("title = "))));
  ASSERT_EQ(here->run({"simulate", name, "--set", "simulate.duration=60 us", "--out", evil}).status, 0);
  for (const std::string& verb : verbs) {
    std::vector<std::string> more = calls()[verb].quick;
    more.front() = verb == "report" ? evil : name;
    if (verb == "optimize") more = more + std::vector<std::string>{"--out", evil + "2"};
    for (const std::vector<std::string>& also :
         {std::vector<std::string>{}, std::vector<std::string>{"--json", "-"}, std::vector<std::string>{evil},
          std::vector<std::string>{"--set", evil + "=" + evil}, std::vector<std::string>{"--" + evil}}) {
      const Outcome o = here->run(words(verb, more + also));
      EXPECT_FALSE(acts_on_a_terminal(o.out)) << verb;
      EXPECT_FALSE(acts_on_a_terminal(o.err)) << verb;
      if (!also.empty() && also.front() == "--json" && o.status == 0) {
        ASSERT_TRUE(json::accept(o.out)) << verb;
        const json j = json::parse(o.out);
        EXPECT_EQ(j.value("title", evil), evil) << "the same text, escaped";
      }
    }
  }
  const Outcome o = here->run({evil});
  EXPECT_EQ(o.status, bad_input);
  EXPECT_FALSE(acts_on_a_terminal(o.err));
}

TEST_F(Faults, NoNameAndNoTitleBeginsALineOfItsOwn_optimized) {
  const std::string name = "a\nforged\tb", scene = shipped("mem-gold.toml");
  write(here->path() / name, "title = \"t\\nforged\\tu\"" + scene.substr(scene.find('\n', scene.find("title = "))));
  const Outcome made = here->run({"simulate", name, "--set", "simulate.duration=60 us", "--out", name + ".out", "--json", "-"});
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_THAT(json::parse(made.out)["command"].get<std::string>(), HasSubstr("softland simulate $'a\\012forged\\011b' --set "));
  for (const std::string& verb : verbs) {
    std::vector<std::string> more = calls()[verb].quick;
    more.front() = verb == "report" ? name + ".out" : name;
    if (takes(verb, "--out")) more = more + std::vector<std::string>{"--out", name + "." + verb};
    if (verb == "pull-in") more = more + std::vector<std::string>{"--sweep", "0 V:10 V:3"};
    const Outcome o = here->run(words(verb, more));
    EXPECT_THAT(o.out + o.err, Not(HasSubstr("\nforged"))) << verb;
  }
  for (const char* file : {"report.html", "gap.svg"})
    EXPECT_THAT(read(here->path() / (name + ".out") / file), Not(HasSubstr("\nforged"))) << file;
}

TEST_F(Faults, TwoRunsDoNotWorkInOneFolder) {
  const Workplace place;
  const pid_t child = place.start(words("optimize", calls()["optimize"].slow + std::vector<std::string>{"--out", "out"}));
  for (int i = 0; i < 600 && !fs::exists(place.path() / "out/unfinished/best.toml"); ++i) std::this_thread::sleep_for(50ms);
  fs::copy(here->path() / "run/result.json", place.path() / "out/result.json");
  // The output of the second run goes elsewhere.
  for (const std::vector<std::string>& second : {std::vector<std::string>{"optimize", "gold.toml", "--quiet"},
                                                 {"simulate", "gold.toml"},
                                                 {"accuracy", "gold.toml"},
                                                 {"report", "out"}}) {
    std::vector<std::string> more = second;
    more[1] = (place.path() / more[1]).string();
    const std::string out = (place.path() / "out").string();
    const Outcome o = here->run(more + std::vector<std::string>{"--out", out});
    EXPECT_EQ(o.status, bad_input) << second.front();
    EXPECT_THAT(o.err, HasSubstr("softland: --out " + out + ": another run works in this folder (process " +
                                 std::to_string(child) + " on "))
        << second.front();
    EXPECT_THAT(o.err, HasSubstr(" UTC: softland optimize gold.toml")) << second.front();
  }
  kill(child, SIGKILL);
  EXPECT_EQ(place.finish(child).status, -SIGKILL);
  EXPECT_TRUE(fs::exists(place.path() / "out/softland.lock")) << "of a dead process";
  EXPECT_EQ(place.run({"report", "out"}).status, 0);
  EXPECT_FALSE(fs::exists(place.path() / "out/softland.lock"));
  EXPECT_TRUE(fs::exists(place.path() / "out/unfinished/best.toml")) << "what the killed search had found";
}

// ---- changes of the folder of a run

TEST_F(Faults, WhatAKilledSearchLeftMayBeRefinedInPlace) {
  const Workplace place;
  fs::create_directories(place.path() / "out/unfinished");
  fs::copy(place.path() / "gold.toml", place.path() / "out/unfinished/best.toml");
  const std::string before = read(place.path() / "out/unfinished/best.toml");
  const Outcome o = place.run(words("optimize", std::vector<std::string>{"out/unfinished/best.toml"} + in_volts +
                                                    std::vector<std::string>{"--robust", "none", "--budget", "6", "--set",
                                                                             "simulate.duration=150 us", "--out", "out"}));
  EXPECT_NE(o.status, bad_input) << o.err;
  EXPECT_EQ(read(place.path() / "out/unfinished/best.toml"), before) << "the scene that it read";
}

TEST_F(Faults, AFolderThatVanishesIsOutputThatIsLost_optimized) {
  const Workplace place;
  const pid_t child =
      place.start(words("optimize", std::vector<std::string>{"gold.toml"} + in_volts +
                                        std::vector<std::string>{"--robust", "none", "--budget", "2 s", "--out", "out"}));
  for (int i = 0; i < 600 && !fs::exists(place.path() / "out/unfinished/best.toml"); ++i) std::this_thread::sleep_for(20ms);
  fs::rename(place.path() / "out", place.path() / "gone");  // move it at once, whatever is being written in it
  // Another run works there now.
  fs::create_directories(place.path() / "out");
  write(place.path() / "out/softland.lock", "process 1 on elsewhere");
  const Outcome o = place.finish(child);
  EXPECT_EQ(o.status, output_lost) << o.err;
  EXPECT_THAT(o.err, HasSubstr("out: the folder was removed or replaced during this run"));
  EXPECT_EQ(read(place.path() / "out/softland.lock"), "process 1 on elsewhere");
}

TEST_F(Faults, NothingInTheFolderIsTakenForWhatItIsNot) {
  const Workplace place;
  const auto into = [&](const std::string& folder) {
    return place.run(words("simulate", calls()["simulate"].quick + std::vector<std::string>{"--out", folder}));
  };
  fs::create_directories(place.path() / "notes");
  write(place.path() / "notes/softland.lock", "my notes");
  const Outcome notes = into("notes");
  EXPECT_EQ(notes.status, bad_input);
  EXPECT_THAT(notes.err, HasSubstr("is not a lock file of softland"));
  EXPECT_EQ(read(place.path() / "notes/softland.lock"), "my notes");
  fs::create_directories(place.path() / "taken/result.json");
  const Outcome taken = into("taken");
  EXPECT_EQ(taken.status, bad_input);
  EXPECT_THAT(taken.err, HasSubstr("result.json is a folder"));
}

TEST_F(Faults, JsonKeepsOffStandardOutputAndUnfinishedResults) {
  const Workplace place;  // standard output is stdout.txt in that folder
  fs::create_directories(place.path() / "out");
  for (const std::string file :
       {"out/softland.lock", "out/unfinished", "out/unfinished/result.json", "out/unfinished-2", "stdout.txt"}) {
    const Outcome o =
        place.run(words("simulate", calls()["simulate"].quick + std::vector<std::string>{"--out", "out", "--json", file}));
    EXPECT_EQ(o.status, bad_input) << file;
    EXPECT_THAT(o.err, HasSubstr("--json " + file + ": ")) << file;
  }
}

TEST_F(Faults, ResultsKeepTheAccessRightsOfThoseTheyReplace) {
  const Workplace place;
  const auto run = [&] {
    return place.run(words("simulate", calls()["simulate"].quick + std::vector<std::string>{"--out", "out"})).status;
  };
  ASSERT_EQ(run(), 0);
  const auto mine = fs::perms::owner_read | fs::perms::owner_write;
  fs::permissions(place.path() / "out/result.json", mine);
  ASSERT_EQ(run(), 0);
  EXPECT_EQ(fs::status(place.path() / "out/result.json").permissions(), mine);
}

}  // namespace
}  // namespace softland
