// Tests the commands that fire the shots of a tuning, and the log of their records: commands that answer, fail, die and hang.
#include "apps/tuning_lab.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <map>
#include <memory>
#include <string>
#include <thread>

#include "base/require.h"
#include "program.h"
#include "reports/tuning_session.h"
#include "waveforms/step.h"

namespace softland::apps {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

// SIGPIPE is ignored, as in our programs: writing to a closed pipe then returns an error.
class TuningLabs : public testing::Test {
 protected:
  static void SetUpTestSuite() { std::signal(SIGPIPE, SIG_IGN); }

  static CommandedShot shot(int number = 1) {
    return commanded_shot(number, 1e-4, {.signals = {{"main", Signal::constant(17)}}});
  }
  static ContactRecord fired(const std::string& command, std::chrono::milliseconds patience = 10s) {
    return *command_lab(command, patience)->fire(shot(), {});
  }
  static std::string refusal(const std::string& command, std::chrono::milliseconds patience = 10s) {
    try {
      (void)fired(command, patience);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return {};
  }
  Workplace here;
};

TEST_F(TuningLabs, TellACommandWhatToDoAndReadWhatCameOfIt) {
  const std::string file = (here.path() / "asked.jsonl").string();
  const auto lab =
      command_lab("while read -r line; do printf '%s\\n' \"$line\" >> '" + file +
                      "'; echo '{\"shot\":1,\"edges_s\":[[3.6e-05,1],[3.8e-05,0],[4.1e-05,1]],\"loudness\":2}'; done",
                  10s);
  const ContactRecord record = *lab->fire(shot(), {});
  ASSERT_EQ(record.edges.size(), 3U);
  EXPECT_EQ(record.edges[1].time, 3.8e-5);
  EXPECT_FALSE(record.edges[1].closed);
  EXPECT_EQ(record.loudness, 2);
  const json asked = json::parse(read(file));
  EXPECT_EQ(asked, json::parse(R"({"shot":1,"hold_s":1e-4,"drives":{"main":{"time_s":[0,0],"V":[0,17]}}})"));
  lab->finish();
  for (int i = 0; i < 100 && read(file).find("done") == std::string::npos; ++i) std::this_thread::sleep_for(10ms);
  EXPECT_THAT(read(file), HasSubstr("\n{\"done\":true}\n"));
}

TEST_F(TuningLabs, NameTheAmplifierBesideVoltsAtTheSwitch) {
  const SentSignals sent{.signals = {{"main", Signal::constant(18)}, {"upper", Signal::constant(9)}},
                         .amplifiers = {{"main", 20}}};
  const json line = shot_json(commanded_shot(1, 1e-4, sent));
  EXPECT_EQ(line, json::parse(R"({"shot":1,"hold_s":1e-4,"drives":{"main":{"time_s":[0,0],"V":[0,18],"amplifier":20},)"
                              R"("upper":{"time_s":[0,0],"V":[0,9]}}})"));
  const CommandedShot read_back = read_shot(line);
  EXPECT_EQ(shot_json(read_back), line);
  EXPECT_EQ(read_back.drives.at("main").voltage.back(), 18) << "a simulated device is driven by them";
  json wrong = line;
  wrong["drives"]["main"]["amplifier"] = 0;
  EXPECT_THROW((void)read_shot(wrong), InvalidInput);
}

TEST_F(TuningLabs, ReadEveryKindOfRecord) {
  EXPECT_EQ(fired(R"(echo '{"shot":1,"error":"no trigger"}')").error, "no trigger");
  const ContactRecord counted = fired(R"(echo '{"shot":1,"closing_time_s":3.6e-5,"bounce_count":2}')");
  EXPECT_EQ(counted.closing_time, 3.6e-5);
  EXPECT_EQ(counted.bounce_count, 2);
  for (const char* open : {R"(echo '{"shot":1,"edges_s":[]}')", R"(echo '{"shot":1,"closing_time_s":null}')"})
    EXPECT_FALSE(first_touch(fired(open)).has_value()) << open;
  EXPECT_EQ(fired(R"(printf '{"shot":1,"edges_s":[[1e-5,1]]}')").edges.size(), 1U) << "without a line feed at its end";
}

TEST_F(TuningLabs, SayWhatIsWrongWithEveryMalformedAnswer) {
  const std::map<std::string, std::string> answers{
      {"", "must be a JSON object: "},
      {"edges 36 us", "must be a JSON object: edges 36 us"},
      {"[1]", "must be a JSON object"},
      {R"({"shot":1)", "must be a JSON object"},
      {R"({"shot":1})", "must have edges_s, closing_time_s or error"},
      {R"({"edges_s":[]})", "shot: is missing"},
      {R"({"shot":2,"edges_s":[]})", "shot = 2: must be 1"},
      {R"({"shot":"1","edges_s":[]})", "shot = \"1\": must be a whole number"},
      {R"({"shot":1,"edge_s":[]})", "edge_s: unknown key; choose one of shot, edges_s"},
      {R"({"shot":1,"edges_s":3})", "edges_s = 3: must be a list of [time, 1"},
      {R"({"shot":1,"edges_s":[[1e-5,2]]})", "edges_s = [1e-05,2]: must be a list of [time, 1"},
      {R"({"shot":1,"edges_s":[[1e-5,0]]})", "edges_s: states must alternate, and the first edge closes the contact"},
      {R"({"shot":1,"edges_s":[[2e-5,1],[1e-5,0]]})", "edges_s: times must be finite, above 0 and in order"},
      {R"({"shot":1,"edges_s":[[1e999,1]]})", "must be a JSON object"},
      {R"({"shot":1,"edges_s":[[null,1]]})", "edges_s = null: must be a time"},
      {R"({"shot":1,"closing_time_s":"36 us"})", "closing_time_s = \"36 us\": must be a time in seconds, or null"},
      {R"({"shot":1,"closing_time_s":-1})", "closing_time_s: must be finite and above 0"},
      {R"({"shot":1,"closing_time_s":0,"bounce_count":0})", "closing_time_s: must be finite and above 0"},
      {R"({"shot":1,"closing_time_s":36.0,"bounce_count":0})", "closing_time_s: must be within the record, which ends at"},
      {R"({"shot":1,"edges_s":[[3e-5,1],[36.0,0]]})", "edges_s: must be within the record, which ends at"},
      {R"({"shot":1,"closing_time_s":1e-5,"bounce_count":-1})", "bounce_count = -1: must be a whole number from 0 on"},
      {R"({"shot":1,"closing_time_s":1e-5,"bounce_count":1.5})", "bounce_count = 1.5: must be a whole number from 0 on"},
      {R"({"shot":1,"closing_time_s":1e-5,"edges_s":[]})", "must have edges_s or closing_time_s, not both"},
      {R"({"shot":1,"edges_s":[],"bounce_count":0})", "bounce_count: belongs to closing_time_s"},
      {R"({"shot":1,"edges_s":[],"loudness":0})", "loudness: must be finite and above 0"},
      {R"({"shot":1,"error":""})", "error = \"\": must be a text"},
      {std::string(100, '[') + std::string(100, ']'), "is nested more than 8 deep"},
      {"\xff\xfe", "must be a JSON object"}};
  for (const auto& [answer, rule] : answers) {
    write(here.path() / "answer", answer + "\n");
    EXPECT_THAT(refusal("cat '" + (here.path() / "answer").string() + "'"),
                AllOf(StartsWith("--device cat "), HasSubstr(": invalid answer to shot 1: "), HasSubstr(rule)))
        << answer;
  }
}

TEST_F(TuningLabs, SayHowACommandEndedThatGaveNoAnswer) {
  EXPECT_THAT(refusal("exit 3"), HasSubstr("--device exit 3: ended with status 3 before it answered shot 1"));
  EXPECT_THAT(refusal("read -r line; kill -9 $$"), HasSubstr("was ended by signal 9 before it answered shot 1"));
  EXPECT_THAT(refusal("no-such-command"), HasSubstr("ended with status 127 before it answered shot 1"));
  EXPECT_THAT(refusal("read -r line; exec >&-; sleep 100"),
              HasSubstr("closed its standard input or output before it answered shot 1"));
  EXPECT_THAT(refusal("sleep 100", 100ms), HasSubstr("did not answer shot 1 within 100\u00a0ms; a longer --timeout"));
}

// The whole process group is ended: a pipeline has several processes, and one may ignore the signal.
TEST_F(TuningLabs, LeaveNoProcessBehind) {
  const std::string file = (here.path() / "pid").string();
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_NE(refusal("trap '' TERM; sleep 100 | { sh -c 'echo $PPID' > '" + file + "'; sleep 100; }", 300ms), "");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 10s);
  const pid_t child = std::stoi(read(file));
  const auto has_ended = [&] { return process_state(child).state == 'Z' || process_state(child).state == 'X'; };
  for (int i = 0; i < 200 && !has_ended(); ++i) std::this_thread::sleep_for(10ms);
  EXPECT_TRUE(has_ended());
}

TEST_F(TuningLabs, ReadFilesOfEdges) {
  write(here.path() / "edges.csv", "time_s,closed\n3.6e-05,1\n3.8e-05,0\n");
  const ContactRecord record = read_edges_file((here.path() / "edges.csv").string());
  ASSERT_EQ(record.edges.size(), 2U);
  EXPECT_EQ(record.edges[1].time, 3.8e-5);
  const auto refused = [&](const std::string& content) {
    write(here.path() / "edges.csv", content);
    try {
      (void)read_edges_file((here.path() / "edges.csv").string());
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(refused("time_s,closed\n3.6e-05,2\n"), HasSubstr("edges.csv:2: closed = 2: must be 1 or 0"));
  EXPECT_THAT(refused("time_s,closed\n3.6e-05,0\n"), HasSubstr("edges.csv: edges_s: states must alternate"));
  EXPECT_THAT(refused("t,closed\n3.6e-05,1\n"), HasSubstr("time_s"));
}

class TuningLogs : public TuningLabs {
 protected:
  [[nodiscard]] fs::path file() const { return here.path() / "closings.jsonl"; }
  [[nodiscard]] TuningLog log(bool resume, const json& origin = {{"seed", 1}}) const { return {file(), origin, resume}; }
  static ContactRecord touch(double time) { return {.edges = {{.time = time, .closed = true}}}; }
  std::string refused(const json& origin = {{"seed", 1}}) const {
    try {
      (void)log(true, origin);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return {};
  }
};

TEST_F(TuningLogs, GoOnWithWhatTheyHold) {
  {
    TuningLog first(file(), {{"seed", 1}}, false);
    first.append(shot(1), touch(3e-5));
    first.append(shot(2), {.error = "no trigger"});
  }
  const std::string whole = read(file());
  {
    TuningLog again(file(), {{"seed", 1}}, true);
    ASSERT_EQ(again.closings().size(), 2U);
    EXPECT_EQ(again.closings()[0].shot, shot_json(shot(1)));
    EXPECT_EQ(again.closings()[0].record.edges.front().time, 3e-5);
    EXPECT_EQ(again.closings()[1].record.error, "no trigger");
    EXPECT_EQ(again.place(again.closings()[1]), file().string() + ":3");
    again.append(shot(3), touch(4e-5));
  }
  EXPECT_THAT(read(file()), StartsWith(whole));
  EXPECT_EQ(TuningLog(file(), {{"seed", 1}}, true).closings().size(), 3U);
}

// A power cut may leave any part of the line that was being written.
TEST_F(TuningLogs, LoseTheClosingThatWasBeingWrittenAndNoOther) {
  {
    TuningLog first(file(), {{"seed", 1}}, false);
    first.append(shot(1), touch(3e-5));
    first.append(shot(2), touch(4e-5));
  }
  const std::string whole = read(file());
  const std::size_t second = whole.rfind("\n", whole.size() - 2) + 1;
  for (std::size_t size = second; size < whole.size(); ++size) {
    write(file(), whole.substr(0, size));
    TuningLog again(file(), {{"seed", 1}}, true);
    ASSERT_EQ(again.closings().size(), 1U) << size;
    again.append(shot(2), touch(4e-5));
    EXPECT_EQ(read(file()), whole) << size;
  }
}

TEST_F(TuningLogs, KeepTheClosingsOfAnEarlierRun) {
  { TuningLog first(file(), {{"seed", 1}}, false); }
  const std::string before = read(file());
  EXPECT_EQ(TuningLog(file(), {{"seed", 2}}, false).moved_to(), here.path() / "closings-1.jsonl");
  EXPECT_EQ(TuningLog(file(), {{"seed", 3}}, false).moved_to(), here.path() / "closings-2.jsonl");
  EXPECT_EQ(read(here.path() / "closings-1.jsonl"), before);
}

TEST_F(TuningLogs, SayWhyTheyCannotGoOn) {
  EXPECT_THAT(refused(), AllOf(StartsWith("resume: "), HasSubstr("no such file")));
  { TuningLog first(file(), {{"seed", 1}}, false); }
  EXPECT_THAT(refused({{"seed", 2}}), HasSubstr("closings.jsonl:1: its closings are of another seed: 1 instead of 2"));
  const std::string header = read(file());
  for (const auto& [line, rule] : std::map<std::string, std::string>{
           {"garbage", "closings.jsonl:2: must be a JSON object"},
           {R"({"shot":{}})", "closings.jsonl:2: must have shot and record"},
           {R"({"shot":{"shot":1,"hold_s":1,"drives":{}},"record":{}})", "closings.jsonl:2: drives = {}: must be "}}) {
    write(file(), header + line + "\n");
    EXPECT_THAT(refused(), HasSubstr(rule)) << line;
  }
  write(file(), "{}\n");
  EXPECT_THAT(refused(), HasSubstr("closings.jsonl:1: must be the log of a tuning"));
}

}  // namespace
}  // namespace softland::apps
