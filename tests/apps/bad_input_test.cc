// Every mistake of a user is refused with one complete sentence and exit status 2.
#include <gtest/gtest.h>

#include "program.h"
#include "tests/support/access_rights.h"

namespace softland {
namespace {

struct Case {
  std::vector<std::string> words;
  std::string message;
};

class BadInput : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    here = new Workplace;
    const std::string gold = shipped("mem-gold.toml"), pzt = shipped("mem-gold-pzt.toml");
    const auto file = [](const char* name, const std::string& text) { write(here->path() / name, text); };
    file("unit.toml", edited(gold, "\"250 um\"", "\"250 V\""));
    file("typo.toml", edited(gold, "\nwidth", "\nwidht"));
    file("unlimited.toml", edited(pzt, "[driver.piezo]\nmin_voltage = \"-1 V\"\nmax_voltage = \"1 V\"\n", ""));
    file("broken.toml", "[structure\n");
    file("empty.toml", "");
    file("empty.json", "{}");
    file("nonsense.json", "nonsense");
    file("odd.json", R"({"kind": 3})");
    file("bare.json", R"({"kind": "simulate", "version": "0.1.0"})");
    file("damaged.json", R"({"kind": "calibrate", "version": "0.1.0", "command": ""})");
    file("tuned.json", R"({"kind": "tuned", "version": "0.1.0"})");
    file("explored.json", R"({"kind": "exploration", "version": "0.1.0"})");
    file("foreign.json", R"({"kind": "simulate", "version": "9.1"})");
    fs::create_directory(here->path() / "folder");
    fs::create_directory(here->path() / "earlier");
    for (const char* name : earlier_files) file((std::string("earlier/") + name).c_str(), "of an earlier search");
    fs::create_directories(here->path() / "odd/result.json");
  }
  static void TearDownTestSuite() {
    delete here;
    here = nullptr;
  }
  /// Compares only the text before and after "…" in a message: lists that the program makes from a table are not repeated here.
  static void expect_message(const std::string& said, const std::string& message, const std::string& line) {
    const std::string whole = "softland: " + message + "\n", ellipsis = "…";
    const std::size_t gap = whole.find(ellipsis);
    if (gap == std::string::npos) {
      EXPECT_EQ(said, whole) << line;
    } else {
      EXPECT_TRUE(said.starts_with(whole.substr(0, gap))) << said << line;
      EXPECT_TRUE(said.ends_with(whole.substr(gap + ellipsis.size()))) << said << line;
    }
  }
  static void expect_refused(const std::vector<Case>& cases) {
    for (const auto& [words, message] : cases) {
      std::string line;
      for (const std::string& word : words) line += " " + word;
      const Outcome o = here->run(words);
      EXPECT_EQ(o.status, 2) << line;
      expect_message(o.err, message, line);
      EXPECT_EQ(o.out, "") << line;
    }
  }
  static inline Workplace* here = nullptr;
  static constexpr const char* earlier_files[] = {"best.toml",   "best.csv",        "report.html",
                                                  "result.json", "evaluations.csv", "trajectory.csv"};
};

TEST_F(BadInput, Verbs) {
  const std::string missing = "a verb is required: simulate, … or read (see softland --help)";
  expect_refused({
      {{}, missing},
      {{"frobnicate"}, "unknown verb 'frobnicate' (see softland --help)"},
      {{"simulte", "gold.toml"}, "unknown verb 'simulte' (did you mean 'simulate'?) (see softland --help)"},
      {{"pullin", "gold.toml"}, "unknown verb 'pullin' (did you mean 'pull-in'?) (see softland --help)"},
      {{"simulate", "gold.toml", "--sett", "a=1"},
       "The following arguments were not expected: --sett a=1 (did you mean '--set'?) (see softland simulate --help)"},
      {{"--frob"}, missing},
  });
}

TEST_F(BadInput, LongWordsAreCut) {
  const std::string word(10'000, 'x');
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{{word},
                                                                                     {"check", word},
                                                                                     {"new", word},
                                                                                     {"check", "gold.toml", word},
                                                                                     {"check", "gold.toml", "--set", word},
                                                                                     {"optimize", "gold.toml", "--target", word},
                                                                                     {"optimize", "gold.toml", "--seed", word},
                                                                                     {"export", "gold.toml", "--format", word}}) {
    const Outcome o = here->run(words);
    EXPECT_EQ(o.status, 2);
    EXPECT_LT(o.err.size(), 500U) << o.err;
    EXPECT_NE(o.err.find("xxx…"), std::string::npos) << o.err;
  }
  const Outcome check = here->run({"check", "gold.toml", "--set", "title=" + word});
  EXPECT_EQ(check.status, 0);
  EXPECT_LT(check.out.find('\n'), 200U) << check.out;
}

TEST_F(BadInput, Options) {
  expect_refused({
      {{"simulate", "gold.toml", "--frob"}, "The following argument was not expected: --frob (see softland simulate --help)"},
      {{"simulate", "gold.toml", "extra"}, "The following argument was not expected: extra (see softland simulate --help)"},
      {{"simulate", "gold.toml", "--json"}, "--json: 1 required FILE missing (see softland simulate --help)"},
      {{"simulate", "gold.toml", "--set"}, "--set: 1 required KEY=VALUE missing (see softland simulate --help)"},
      {{"accuracy", "gold.toml", "--jobs"}, "The following argument was not expected: --jobs (see softland accuracy --help)"},
      {{"new", "a", "b"}, "The following argument was not expected: b (see softland new --help)"},
      {{"optimize", "gold.toml", "--certify"},
       "The following argument was not expected: --certify (see softland optimize --help)"},
      {{"optimize", "--resume", "--out", "folder"},
       "--resume: folder holds no search to continue; name its folder by --out, or omit --resume"},
      {{"optimize", "gold.toml", "--robust", "wrost"},
       "--robust wrost: unknown statistic 'wrost': choose one of cvar:0.9, quantile:0.95, mean+2sigma, worst, yield and "
       "yield:\"bounce_count == 0\""},
      {{"optimize", "gold.toml", "--robust", "cvar:2"}, "--robust cvar:2: the level of cvar must be at least 0 and less than 1"},
      {{"optimize", "gold.toml", "--robust", "worst", "--constrain", "t_i < 3 V"},
       "--constrain: initial_contact_time in 't_i < 3 V' must be a time [s]"},
      {{"optimize", "gold.toml", "--robust", "worst", "--calibrate", "Vsp"},
       "--calibrate Vsp: unknown measurement 'Vsp'; choose from Vdp, frequency, piezo and time, "
       "with an error such as Vdp:1 % or time:50 ns"},
      {{"optimize", "gold.toml", "--robust", "worst", "--calibrate", "Vdp,piezo"},
       "--set calibration.piezo.error=\"0 %\": [calibration.piezo]: needs a [piezo] layer, whose deflection is measured"},
      {{"optimize", "gold.toml", "--robust", "worst", "--calibrate", "Vdp:1 %,frequency,Vdp:2 %"},
       "--calibrate Vdp:1 %,frequency,Vdp:2 %: Vdp is given twice; give it once"},
      {{"robustness", "gold.toml", "--calibrate", "frequency,frequency in 3 classes"},
       "--calibrate frequency,frequency in 3 classes: frequency is given twice; give it once"},
      {{"calibrate", "gold.toml", "--error", "time:1 %,Vdp:1 %,time:1 %"},
       "--error time:1 %,Vdp:1 %,time:1 %: time is given twice; give it once"},
      {{"optimize", "gold.toml", "--robust", "worst", "--waveform", "knots+catch"},
       "--waveform knots+catch: a search over devices takes one family"},
      {{"optimize", "gold.toml", "--waveform", "knots+"}, "--waveform knots+: a family before or after '+' is missing"},
      {{"optimize", "gold.toml", "--robust", "worst", "--samples", "3"}, "--samples 3: must be a whole number from 8 on"},
      {{"optimize", "gold.toml", "--robust", "worst", "--optimizer", "bobyqa"},
       "--optimizer bobyqa: a robust search has a method of its own"},
      {{"optimize", "gold.toml", "--samples=3"}, "--samples 3: must be a whole number from 100 on"},
      {{"optimize", "gold.toml", "--robust", "none", "--samples=300"},
       "--calibrate and --samples are for a search over devices: they say nothing with --robust none"},
      {{"optimize", "gold.toml", "--robust", "auto", "--seeds", "2"},
       "--seeds: is for searches on the nominal device, or over devices by one measure such as --robust cvar:0.9"},
      {{"optimize", "gold.toml", "--robust", "worst", "--constrain", "t_i < 0 step"},
       "--constrain: '0' in 't_i < 0 step' must be a factor above 0 on the figure of the plain step"},
      {{"optimize", "gold.toml", "--calibrate", "Vdp:1 %,time:50 ns"},
       "--set calibration.time.error=\"50 ns\": [calibration.time]: must not be combined with Vdp, "
       "which gives the voltage scale of a device as well"},
      {{"pull-in", "pzt.toml", "--bias", "piezo"}, "--bias piezo: must be of the form NAME=VOLTAGE, such as \"piezo=-1.5 V\""},
      {{"pull-in", "pzt.toml", "--bias", "pieso=1 V"}, "--bias pieso=1 V: unknown drive (did you mean 'piezo'?)"},
      {{"pull-in", "pzt.toml", "--bias", "piezo=1"}, "--bias piezo=1: no unit (expected a voltage such as \"45 V\")"},
      {{"pull-in", "pzt.toml", "--bias", "piezo=2 MV"},
       "--bias piezo=2 MV: must be a voltage [V] from -1 MV to 1 MV, such as \"45 V\""},
      {{"pull-in", "gold.toml", "--sweep", "0 V:20 V:9"},
       "--sweep and --out must be given together: the sweep is written to the folder of --out"},
      {{"pull-in", "gold.toml", "--out", "swept", "--sweep", "0 V:20 V"},
       "--sweep 0 V:20 V: must be of the form FIRST:LAST:N, such as \"0 V:40 V:81\""},
      {{"pull-in", "gold.toml", "--out", "swept", "--sweep", "0 V:20:9"},
       "--sweep 0 V:20:9: no unit (expected a voltage such as \"45 V\")"},
      {{"pull-in", "gold.toml", "--out", "swept", "--sweep", "2 V:2 V:9"}, "--sweep 2 V:2 V:9: FIRST and LAST must differ"},
      {{"export", "gold.toml", "--measured", "Vdp=14"}, "--measured Vdp = 14: no unit (expected a voltage such as \"45 V\")"},
      {{"export", "gold.toml", "--device-vdp", "3 A"}, "--device-vdp 3 A: must be a voltage [V] above 0, such as \"45 V\""},
      {{"export", "gold.toml", "--device-frequency", "0 Hz"},
       "--device-frequency 0 Hz: must be a frequency [Hz] above 0, such as \"30 kHz\""},
      {{"robustness", "gold.toml", "--calibrate", "Vdp:99 %"}, "--set calibration.Vdp.error=\"99 %\": must be in [0, 0.5]"},
      {{"robustness", "gold.toml", "--calibrate", "Vdp in 1 classes"},
       "--set calibration.classes=1: must be a whole number from 2 to 256"},
      {{"robustness", "gold.toml", "--calibrate", "Vdp in many classes"},
       "--set calibration.classes=many: must be a whole number from 2 to 256"},
      {{"calibrate", "gold.toml", "--samples", "9"}, "--samples 9: must be a whole number from 16 on"},
      {{"calibrate", "gold.toml", "--error", "Vdp"},
       "--error Vdp: must be Vdp, Vsp, release, frequency, piezo or time with an error from 0 to 50 %, such as \"Vdp:1 %\""},
      {{"calibrate", "gold.toml", "--error", "Vdp:1 %,mass:1 %"},
       "--error Vdp:1 %,mass:1 %: must be Vdp, Vsp, release, frequency, piezo or time with an error from 0 to 50 %, such as "
       "\"Vdp:1 "
       "%\""},
      {{"calibrate", "gold.toml", "--error", "time:1 s"},
       "--error time:1 s: must be Vdp, Vsp, release, frequency, piezo or time with an error from 0 to 50 %, such as \"Vdp:1 %\""},
      {{"calibrate", "gold.toml", "--steps", "1.2,1.1"},
       "--steps 1.2,1.1: must be increasing multiples of Vdp from 1 to 10, such as 1.1,1.25,1.5"},
      {{"calibrate", "gold.toml", "--quiet"},
       "gold.toml: its drive is the plain step, which lands no device softly: there is no waveform to calibrate. Give what softland "
       "optimize has found"},
      {{"robustness", "gold.toml", "--samples", "0"}, "--samples 0: must be a whole number from 1 on"},
      {{"robustness", "gold.toml", "--samples", "3000000000"}, "--samples 3000000000: must be at most 2147483648"},
      {{"robustness", "gold.toml", "--points", "grid"}, "--points grid: must be sobol, latin_hypercube or monte_carlo"},
      {{"robustness"}, "SCENE is required (see softland robustness --help)"},
      {{"robustness", "gold.toml", "none.toml"}, "none.toml: cannot be read: No such file or directory"},
  });
}

TEST_F(BadInput, SceneFiles) {
  expect_refused({
      {{"calibrate"}, "SCENE is required (see softland calibrate --help)"},
      {{"simulate"}, "SCENE is required (see softland simulate --help)"},
      {{"accuracy"}, "SCENE is required (see softland accuracy --help)"},
      {{"accuracy", "none.toml"}, "none.toml: cannot be read: No such file or directory"},
      {{"pull-in"}, "SCENE is required (see softland pull-in --help)"},
      {{"simulate", "none.toml"}, "none.toml: cannot be read: No such file or directory"},
      {{"modes", "none.toml"}, "none.toml: cannot be read: No such file or directory"},
      {{"optimize", "none.toml"}, "none.toml: cannot be read: No such file or directory"},
      {{"simulate", "folder"},
       "folder: is a folder without result.json, best.toml or release.toml; give a scene file, such as folder/NAME.toml, or the folder of --out"},
      {{"cycle", "gold.toml", "--budget", "60"},
       "--target, --actuator, --waveform, --budget: must be given together with --search"},
      {{"optimize", "gold.toml", "--cycle", "1 kHz", "--samples", "3"},
       "--no-scan, --samples: must not be given with a search, which simulates the nominal design at one rate"},
      {{"fit", "folder", "--data", "bench.toml"}, "folder: is a folder, it must be a regular file"},
      {{"simulate", "broken.toml"}, "broken.toml:1:11: not TOML: Error while parsing table header: expected ']', saw '\\n'"},
      {{"simulate", "empty.toml"}, "empty.toml: section [structure] is missing"},
      {{"simulate", "unit.toml"}, "unit.toml:12: structure.length = \"250 V\": expected a length [m], got a voltage [V]"},
      {{"check", "typo.toml"}, "typo.toml:13: structure.widht = \"20 um\": unknown key (did you mean 'width'?)"},
  });
}

TEST_F(BadInput, Assignments) {
  const auto set = [](const char* assignment) { return std::vector<std::string>{"simulate", "gold.toml", "--set", assignment}; };
  expect_refused({
      {set("gap.contact"), "--set gap.contact: must be of the form key.path=value"},
      {set("=3"), "--set =3: not a key path such as structure.length"},
      {set("gap.contct=1 um"), "--set gap.contct=1 um: unknown key (did you mean 'contact'?)"},
      {set("gap.contact=1 V"), "--set gap.contact=1 V: expected a length [m], got a voltage [V]"},
      {set("gap.contact=-1"), "--set gap.contact=-1: no unit (expected a length such as \"2 um\")"},
      {set("gap.contact=-1 um"), "--set gap.contact=-1 um: must be in [1 pm, 1 m]"},
      {set("gap.contact=9 um"), "--set gap.contact=9 um: must be less than gap.electrode = \"3.5 um\""},
  });
}

TEST_F(BadInput, Searches_long) {
  const auto search = [](std::vector<std::string> words) {
    words.insert(words.begin(), {"optimize", "gold.toml", "--quiet", "--out", "earlier"});
    return words;
  };
  const std::string budget = ": must be a whole number of evaluations such as 2500, or a time such as \"90 s\"";
  expect_refused({
      {search({"--target", "softness"}),
       "--target softness: must be bounce, …, or a weighted sum such as \"0.7 bounce + 0.3 energy\""},
      {search({"--constrain", "t_i < 3 V"}), "--constrain: initial_contact_time in 't_i < 3 V' must be a time [s]"},
      {search({"--actuator", "magnetic"}), "--actuator magnetic: must be electrostatic, pzt or both"},
      {search({"--waveform", "table"}), "--waveform table: must be step, …"},
      {search({"--waveform", "spline"}), "--waveform spline: must be step, …"},
      {search({"--budget", "0"}), "--budget 0" + budget},
      {search({"--budget", "-5"}), "--budget -5" + budget},
      {search({"--budget", "1.5"}), "--budget 1.5" + budget},
      {search({"--budget", "abc"}), "--budget abc" + budget},
      {search({"--budget", "90 m"}), "--budget 90 m" + budget},
      {search({"--budget", "0 s"}), "--budget 0 s" + budget},
      {search({"--budget", ""}), "--budget ''" + budget},
      {{"simulate", "gold.toml", "--certify", "--jobs", "0"}, "--jobs 0: must be a whole number from 1 on"},
      {search({"--jobs", "0"}), "--jobs 0: must be a whole number from 1 on"},
      {search({"--jobs", "-1"}), "--jobs -1: must be a whole number from 1 on"},
      {search({"--jobs", "two"}), "--jobs two: must be a whole number from 1 on"},
      {search({"--jobs", ""}), "--jobs '': must be a whole number from 1 on"},
      {search({"--jobs", "99999999999"}), "--jobs 99999999999: must be a whole number from 1 to 2147483647"},
      {search({"--seed", "-1"}), "--seed -1: must be a whole number from 0 on"},
      {search({"--seed", "x"}), "--seed x: must be a whole number from 0 on"},
      {search({"--seed", "1.5"}), "--seed 1.5: must be a whole number from 0 on"},
      {search({"--seed", ""}), "--seed '': must be a whole number from 0 on"},
      {search({"--seed", "18446744073709551616"}),
       "--seed 18446744073709551616: must be a whole number from 0 to 18446744073709551615"},
      {search({"--seeds", "0"}), "--seeds 0: must be a whole number from 1 on"},
      {search({"--seeds", "1,4"}), "--seeds 1,4: must be a whole number from 1 on"},
      {search({"--seeds", "100001"}), "--seeds 100001: must be at most 100000"},
      {search({"--seeds", "3", "--seed", "18446744073709551614"}),
       "--seeds 3: from --seed 18446744073709551614 on there are not so many"},
      {search({"--seeds", "3", "--budget", "9 s"}),
       "--budget 9 s: searches from several seeds are compared at equal effort, so their budget is a number of evaluations"},
      {search({"--start", "none.toml"}), "none.toml: cannot be read: No such file or directory"},
      {search({"--json", ""}), "--json: must not be empty (see softland optimize --help)"},
      {{"optimize", "gold.toml", "--out", ""}, "--out: must not be empty (see softland optimize --help)"},
      {{"optimize", ""}, "SCENE: must not be empty (see softland optimize --help)"},
      {search({"--actuator", "pzt"}), "optimize --actuator pzt|both needs a [piezo] section, and the scene has none"},
      {{"optimize", "unlimited.toml", "--quiet", "--out", "earlier", "--actuator", "pzt"},
       "optimize needs [driver.piezo] with min_voltage and max_voltage: it never searches an unlimited drive"},
  });
  // The tests of optimizers check all names.
  const std::string unknown = here->run(search({"--optimizer", "magic"})).err;
  EXPECT_TRUE(unknown.starts_with("softland: --optimizer magic: must be one of auto, ")) << unknown;
}

TEST_F(BadInput, CostsNoEarlierResult_optimized) {
  for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{{"--target", "softness"},
                                                                                    {"--actuator", "magnetic"},
                                                                                    {"--actuator", "pzt"},
                                                                                    {"--waveform", "table"},
                                                                                    {"--optimizer", "magic"},
                                                                                    {"--budget", ""},
                                                                                    {"--jobs", "0"},
                                                                                    {"--seed", "-1"},
                                                                                    {"--set", "gap.contact=1 V"},
                                                                                    {"--set", "gap.contact=9 um"},
                                                                                    {"--set", "waveform.main.level=9 Vdp"},
                                                                                    {"--set", "simulate.duration=2 us"}}) {
    std::vector<std::string> words{"optimize", "gold.toml", "--out", "earlier"};
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_EQ(here->run(words).status, 2) << more.back();
  }
  EXPECT_EQ(here->run({"optimize", "none.toml", "--out", "earlier"}).status, 2);
  for (const char* name : earlier_files) EXPECT_EQ(read(here->path() / "earlier" / name), "of an earlier search") << name;
}

TEST_F(BadInput, PlacesToWriteTo_optimized) {
  expect_refused({
      {{"simulate", "gold.toml", "--out", "/proc/x"}, "--out /proc/x: the folder cannot be created: No such file or directory"},
      {{"optimize", "gold.toml", "--quiet", "--out", "/proc/x"},
       "--out /proc/x: the folder cannot be created: No such file or directory"},
      {{"optimize", "gold.toml", "--quiet", "--out", "gold.toml"},
       "--out gold.toml: the folder cannot be created: Not a directory"},
      {{"accuracy", "gold.toml", "--out", "/proc/x"}, "--out /proc/x: the folder cannot be created: No such file or directory"},
      {{"modes", "gold.toml", "--json", "/proc/x.json"}, "/proc/x.json: cannot write in its folder: No such file or directory"},
      {{"modes", "gold.toml", "--json", "folder"}, "folder: cannot replace it: Is a directory"},
  });
}

TEST_F(BadInput, Results) {
  expect_refused({
      {{"export", "nonsense.json"}, "nonsense.json: is not a result of softland"},
      {{"export", "empty.json"}, "empty.json: is not a result of softland"},
      {{"export", "none"}, "none: cannot be read: No such file or directory"},
      {{"export", "folder"},
       "folder: is a folder without result.json, best.toml or release.toml; give a scene file, such as folder/NAME.toml, or the folder of --out"},
      {{"export", "gold.toml", "--format", "wav"},
       "--format wav: must be one of csv, spice-pwl, codes, spice-model, spice-bench, verilog-a, keysight-arb, siglent-csv, "
       "tektronix-csv, rigol-csv, digilent-csv"},
      {{"report", "nonsense.json"}, "nonsense.json: is not a result of softland"},
      {{"report", "empty.json"}, "empty.json: is not a result of softland"},
      {{"export", "none.json"}, "none.json: cannot be read: No such file or directory"},
      {{"report", "none"}, "none: cannot be read: No such file or directory"},
      {{"report", "folder"}, "folder: must hold one of result.json, …; name the folder of --out"},
      {{"report", "damaged.json"}, "damaged.json: \"devices\" is missing"},
      {{"report", "tuned.json"}, "tuned.json: no report is made for JSON of kind 'tuned'"},
      {{"report", "explored.json"}, "explored.json: \"store\" must name the store of the exploration, but '' is not a store"},
      {{"report", "odd"}, "odd/result.json: is a folder, it must be a regular file"},
      {{"report", "gold.toml"}, "gold.toml: is not a result of softland"},
      {{"report", "odd.json"}, "odd.json: is not a result of softland"},
      {{"report", "bare.json"}, "bare.json: \"metrics\" is missing"},
      {{"report", "foreign.json"}, "foreign.json: is a result of softland 9.1, of which softland 0.1.0 makes no report"},
      {{"new", "magnet"},
       "new magnet: must be one of cantilever, cantilever-pzt, hinged-plate, clamped-clamped, plate, two-contacts, "
       "two-electrodes, capacitive-bridge, nem-cantilever, nem-casimir"},
  });
}

TEST_F(BadInput, ResultsThatMayNotBeRead) {
  write(here->path() / "secret.json", "{}");
  fs::permissions(here->path() / "secret.json", fs::perms::none);
  test::expect_where_access_rights_bind([] {
    expect_refused({{{"report", "secret.json"}, "secret.json: cannot be read: Permission denied"},
                    {{"export", "secret.json"}, "secret.json: cannot be read: Permission denied"}});
  });
}

}  // namespace
}  // namespace softland
