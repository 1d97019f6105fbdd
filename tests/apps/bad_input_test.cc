// Everything a user can get wrong is refused with one whole sentence and exit status 2.
#include <gtest/gtest.h>

#include "program.h"

namespace softland {
namespace {

struct Case {
  std::vector<std::string> words;
  std::string message;
};

class BadInput : public testing::Test {
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
    fs::create_directory(here->path() / "folder");
    fs::create_directory(here->path() / "earlier");
    file("earlier/best.toml", gold);
    file("earlier/result.json", "{}");
  }
  static void TearDownTestSuite() {
    delete here;
    here = nullptr;
  }
  static void expect_refused(const std::vector<Case>& cases) {
    for (const auto& [words, message] : cases) {
      std::string line;
      for (const std::string& word : words) line += " " + word;
      const Outcome o = here->run(words);
      EXPECT_EQ(o.status, 2) << line;
      EXPECT_EQ(o.err, "softland: " + message + "\n") << line;
      EXPECT_EQ(o.out, "") << line;
    }
  }
  static inline Workplace* here = nullptr;
};

TEST_F(BadInput, Verbs) {
  expect_refused({
      {{}, "A subcommand is required (see softland --help)"},
      {{"frobnicate"}, "there is no verb 'frobnicate' (see softland --help)"},
      {{"--frob"}, "A subcommand is required (see softland --help)"},
      {{"effects", "gold.toml"}, "the verb 'effects' is not available yet"},
      {{"explore", "gold.toml", "--shard", "1/2"}, "the verb 'explore' is not available yet"},
      {{"robustness", "gold.toml"}, "the verb 'robustness' is not available yet"},
      {{"accuracy", "gold.toml"}, "the verb 'accuracy' is not available yet"},
  });
}

TEST_F(BadInput, Options) {
  expect_refused({
      {{"simulate", "gold.toml", "--frob"}, "The following argument was not expected: --frob (see softland simulate --help)"},
      {{"simulate", "gold.toml", "extra"}, "The following argument was not expected: extra (see softland simulate --help)"},
      {{"simulate", "gold.toml", "--json"}, "--json: 1 required TEXT missing (see softland simulate --help)"},
      {{"simulate", "gold.toml", "--set"}, "--set: 1 required TEXT missing (see softland simulate --help)"},
      {{"new", "a", "b"}, "The following argument was not expected: b (see softland new --help)"},
      {{"simulate", "gold.toml", "--certify"}, "the option --certify is not available yet"},
      {{"optimize", "gold.toml", "--resume"}, "the option --resume is not available yet"},
      {{"optimize", "gold.toml", "--robust", "worst"}, "the option --robust is not available yet"},
      {{"optimize", "--samples=3"}, "the option --samples is not available yet"},
  });
}

TEST_F(BadInput, SceneFiles) {
  expect_refused({
      {{"simulate"}, "scene is required (see softland simulate --help)"},
      {{"pull-in"}, "scene is required (see softland pull-in --help)"},
      {{"simulate", "none.toml"}, "none.toml: cannot be opened: No such file or directory"},
      {{"modes", "none.toml"}, "none.toml: cannot be opened: No such file or directory"},
      {{"optimize", "none.toml"}, "none.toml: cannot be opened: No such file or directory"},
      {{"simulate", "folder"}, "folder: is a directory, not a scene file"},
      {{"simulate", "broken.toml"}, "broken.toml:1:11: not TOML: Error while parsing table header: expected ']', saw '\\n'"},
      {{"simulate", "empty.toml"}, "empty.toml: section [structure] is missing"},
      {{"simulate", "unit.toml"}, "unit.toml:12: structure.length = \"250 V\": expected a length [m], got a voltage [V]"},
      {{"check", "typo.toml"}, "typo.toml:13: structure.widht = \"20 um\": unknown key (did you mean 'width'?)"},
  });
}

TEST_F(BadInput, Assignments) {
  const auto set = [](const char* assignment) { return std::vector<std::string>{"simulate", "gold.toml", "--set", assignment}; };
  expect_refused({
      {set("gap.contact"), "--set gap.contact: not of the form key.path=value"},
      {set("=3"), "--set =3: not a key path such as structure.length"},
      {set("gap.contct=1 um"), "--set gap.contct=1 um: unknown key (did you mean 'contact'?)"},
      {set("gap.contact=1 V"), "--set gap.contact=1 V: expected a length [m], got a voltage [V]"},
      {set("gap.contact=-1"), "--set gap.contact=-1: no unit (expected a length such as \"2 um\")"},
      {set("gap.contact=-1 um"), "--set gap.contact=-1 um: must be greater than 0 m"},
      {set("gap.contact=9 um"), "--set gap.contact=9 um: must be less than gap.electrode = \"3.5 um\""},
  });
}

TEST_F(BadInput, Searches) {
  const auto search = [](std::vector<std::string> words) {
    words.insert(words.begin(), {"optimize", "gold.toml", "--quiet", "--out", "earlier"});
    return words;
  };
  const std::string budget = ": must be a whole number of evaluations such as 2500, or a time such as \"90 s\"";
  expect_refused({
      {search({"--target", "softness"}), "--target softness: must be bounce, settling, rebound, count, impact or energy"},
      {search({"--actuator", "magnetic"}), "--actuator magnetic: must be electrostatic, pzt or both"},
      {search({"--waveform", "table"}), "--waveform table: only step, pulse and harmonic have parameters to search"},
      {search({"--waveform", "spline"}), "--waveform spline: only step, pulse and harmonic have parameters to search"},
      {search({"--optimizer", "magic"}),
       "optimizer \"magic\" is unknown; there are auto, bobyqa, sbplx, nelder-mead, slsqp, mma, ccsaq, ipopt, cma-es, crs2, "
       "isres, "
       "esch, direct-l, mlsl"},
      {search({"--budget", "0"}), "--budget 0" + budget},
      {search({"--budget", "-5"}), "--budget -5" + budget},
      {search({"--budget", "1.5"}), "--budget 1.5" + budget},
      {search({"--budget", "abc"}), "--budget abc" + budget},
      {search({"--budget", "90 m"}), "--budget 90 m" + budget},
      {search({"--budget", "0 s"}), "--budget 0 s" + budget},
      {search({"--jobs", "-1"}), "--jobs -1: must be at least 1"},
      {search({"--jobs", "two"}), "Could not convert: --jobs = two (see softland optimize --help)"},
      {search({"--seed", "x"}), "Could not convert: --seed = x (see softland optimize --help)"},
      {search({"--actuator", "pzt"}), "optimize --actuator pzt|both needs a [piezo] section, and the scene has none"},
      {{"optimize", "unlimited.toml", "--quiet", "--out", "earlier", "--actuator", "pzt"},
       "optimize needs [driver.piezo] with min_voltage and max_voltage: it never searches an unlimited drive"},
  });
}

// Not refused yet: 0 means one per core, and -1 wraps round.
TEST_F(BadInput, DISABLED_JobsAndSeedsOutOfRange) {
  expect_refused({
      {{"optimize", "gold.toml", "--quiet", "--budget", "3", "--jobs", "0"}, "--jobs 0: must be at least 1"},
      {{"optimize", "gold.toml", "--quiet", "--budget", "3", "--seed", "-1"}, "--seed -1: must be a whole number from 0 on"},
  });
}

// Not so yet: the folder is emptied before the scene and the options are checked.
TEST_F(BadInput, DISABLED_CostsNoEarlierResult) {
  EXPECT_EQ(read(here->path() / "earlier/best.toml"), shipped("mem-gold.toml"));
  EXPECT_EQ(read(here->path() / "earlier/result.json"), "{}");
}

TEST_F(BadInput, PlacesToWriteTo) {
  expect_refused({
      {{"simulate", "gold.toml", "--out", "/proc/x"}, "--out /proc/x: the folder cannot be created: No such file or directory"},
      {{"optimize", "gold.toml", "--quiet", "--out", "/proc/x"},
       "--out /proc/x: the folder cannot be created: No such file or directory"},
      {{"optimize", "gold.toml", "--quiet", "--out", "gold.toml"},
       "--out gold.toml: the folder cannot be created: Not a directory"},
      {{"modes", "gold.toml", "--json", "/proc/x.json"}, "/proc/x.json: cannot write in its folder: No such file or directory"},
      {{"modes", "gold.toml", "--json", "folder"}, "folder: cannot replace it: Is a directory"},
  });
}

TEST_F(BadInput, Results) {
  expect_refused({
      {{"export", "nonsense.json"}, "nonsense.json: is not a result.json of softland"},
      {{"export", "empty.json"}, "empty.json: is not a result.json of softland"},
      {{"export", "none"}, "none: cannot be opened: No such file or directory"},
      {{"export", "folder"}, "folder/best.toml: cannot be opened: No such file or directory"},
      {{"export", "gold.toml", "--format", "wav"}, "--format wav: must be csv or spice-pwl"},
      {{"report", "nonsense.json"}, "nonsense.json: is not a result.json of softland"},
      {{"report", "empty.json"}, "empty.json: is not a result.json of softland"},
      {{"report", "none"}, "none: cannot be read"},
      {{"report", "folder"}, "folder/result.json: cannot be read"},
      {{"report", "gold.toml"}, "gold.toml: is not a result.json of softland"},
      {{"new", "magnet"}, "new magnet: must be cantilever or cantilever-pzt"},
  });
}

}  // namespace
}  // namespace softland
