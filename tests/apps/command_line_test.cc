// Tests the output of the verbs when they succeed.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "program.h"
#include "tests/support/printed.h"

namespace softland {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// Returns the verbs that --help lists.
std::vector<std::string> every_verb(const Workplace& here) {
  const std::string help = here.run({"--help"}).out;
  const std::size_t begin = help.find("\nVerbs:\n");
  const std::string list = help.substr(begin, help.find("\n\n", begin) - begin);
  std::vector<std::string> verbs;
  const std::regex line("\n  ([a-z-]+) ");
  for (std::sregex_iterator at(list.begin(), list.end(), line), end; at != end; ++at) verbs.push_back((*at)[1]);
  return verbs;
}

TEST(Help, OfEveryVerbHasExamplesAndNamesNothingThatDoesNotExist) {
  const Workplace here;
  std::vector<std::string> verbs = every_verb(here);
  EXPECT_THAT(verbs, testing::IsSupersetOf({"simulate", "pull-in", "optimize", "report"}));
  verbs.insert(verbs.begin(), "");
  for (const std::string& verb : verbs) {
    std::vector<std::string> words;
    if (!verb.empty()) words.push_back(verb);
    words.emplace_back("--help");
    const Outcome o = here.run(words);
    EXPECT_EQ(o.status, 0) << verb;
    EXPECT_EQ(o.err, "") << verb;
    EXPECT_THAT(o.out, HasSubstr("Example")) << verb;
    EXPECT_THAT(o.out, HasSubstr("\n  softland " + verb)) << verb;
    EXPECT_THAT(o.out, HasSubstr("Usage: softland " + verb)) << verb;
    EXPECT_THAT(o.out, Not(HasSubstr("ubcommand"))) << verb;
    EXPECT_THAT(o.out, Not(HasSubstr("TEXT"))) << verb;
  }
}

TEST(Help, OfTheProgramNamesEveryExitStatus) {
  const Workplace here;
  EXPECT_THAT(here.run({"--help"}).out, HasSubstr("\nExit status:\n  0    done"));
}

TEST(Program, TellsItsVersion) {
  const Workplace here;
  const Outcome o = here.run({"--version"});
  EXPECT_EQ(o.status, 0);
  EXPECT_THAT(o.out, testing::MatchesRegex("softland [0-9]+\\.[0-9]+\\.[0-9]+[^\n]*\n"));
}

// An electrode with faces on both sides of the beam, of which the back one is nearer.
TEST(PullInVoltage, OfAnElectrodeThatPullsAwayIsNone) {
  const Workplace here;
  const std::string scene = edited(shipped("gap-closing-actuator.toml"), "electrode = \"", "electrode = \"5");
  write(here.path() / "away.toml", scene);
  const auto line =
      std::count(scene.begin(), scene.begin() + static_cast<std::ptrdiff_t>(scene.find("gap", scene.find("[electrode.main]"))),
                 '\n') +
      1;
  const Outcome checked = here.run({"check", "away.toml"});
  EXPECT_EQ(checked.status, 0) << checked.err;
  EXPECT_THAT(checked.out, HasSubstr("pulls away from the contact in the rest position: no pull-in voltage"));
  EXPECT_THAT(checked.out, HasSubstr(fmt::format("warning: away.toml:{}: electrode.main.gap = ", line)));
  EXPECT_THAT(here.run({"pull-in", "away.toml"}).out, HasSubstr("pulls away from the contact where the switch rests"));
  const Outcome needed = here.run({"simulate", "away.toml", "--set", "waveform.main.level=1.2 Vdp"});
  EXPECT_EQ(needed.status, 2);
  EXPECT_THAT(needed.err, HasSubstr("electrode.main"));
}

TEST(Program, CalledOptimizeIsThatVerb) {
  const Workplace here;
  const std::string link = (fs::path(SOFTLAND_PROGRAM).parent_path() / "optimize").string();
  const Outcome called = here.run({"--help"}, link);
  EXPECT_EQ(called.status, 0);
  EXPECT_EQ(called.out, here.run({"optimize", "--help"}).out);
  EXPECT_EQ(here.run({"gold.toml", "--target", "softness"}, link).err,
            here.run({"optimize", "gold.toml", "--target", "softness"}).err);
  EXPECT_THAT(here.run({"gold.toml", "--target", "softness"}, link).err,
              testing::StartsWith("softland: --target softness: must be bounce, "));
}

TEST(Robustness, RefusesAResultThatBeginsElsewhere) {
  const Workplace here;
  const Outcome o = here.run({"robustness", "gold.toml", "early.toml", "--samples", "4"});
  EXPECT_EQ(o.status, 2);
  const std::string gold = shipped("mem-gold.toml");
  write(here.path() / "early.toml", edited(gold, "level = \"1.25 Vdp\"", "level = \"17 V\"\nbefore = \"3 V\""));
  const Outcome refused = here.run({"robustness", "gold.toml", "early.toml", "--samples", "4"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("early.toml: the drive 'main' stands at 3 V before its waveform, and at 0 V in the scene"));
}

TEST(Simulate, PrintsTheAgreedJsonAndNothingElse) {
  const Workplace here;
  const Outcome o = here.run({"simulate", "gold.toml", "--json", "-"});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(o.err, "");
  const json j = json::parse(o.out);
  EXPECT_EQ(keys(j), (std::set<std::string>{"status", "metrics", "errors", "natural_frequencies_rad_s", "pull_in", "work",
                                            "warnings", "scene", "version", "command", "kind", "title", "tolerance", "made_with",
                                            "closed_state", "collapse_time_s", "static_deflection_m", "capacitance_F"}));
  const std::set<std::string> figures{"initial_contact_time_s", "permanent_contact_time_s", "bounce_time_s",
                                      "bounce_count",           "major_bounce_height_m",    "first_rebound_time_s",
                                      "impact_velocity_m_s",    "peak_contact_force_N",     "impact_energy_J",
                                      "hold_force_N",           "steady_force_time_s",      "least_force_after_touch_N",
                                      "capacitance_F",          "static_deflection_m",      "overshoot_m",
                                      "open_settling_time_s",   "drive_energy_J",           "peak_voltage_V",
                                      "peak_slew_V_s"};
  std::set<std::string> with_settled = figures;
  with_settled.insert("settled");
  EXPECT_EQ(keys(j["metrics"]), with_settled);
  EXPECT_EQ(keys(j["errors"]), figures);
  for (const char* chaotic : {"permanent_contact_time_s", "bounce_time_s", "bounce_count"}) {
    EXPECT_TRUE(j["errors"][chaotic].is_null()) << chaotic << ": two runs cannot tell its range";
  }
  EXPECT_GT(j["errors"]["impact_velocity_m_s"], 0);
  EXPECT_EQ(keys(j["pull_in"]), (std::set<std::string>{"static_V", "dynamic_V", "by_modes"}));
  EXPECT_EQ(keys(j["work"]), (std::set<std::string>{"integrator", "steps", "rhs_evaluations", "wall_s"}));
  EXPECT_EQ(j["natural_frequencies_rad_s"].size(), 4U);
  EXPECT_TRUE(j["metrics"]["peak_slew_V_s"].is_null()) << "a jump has no finite slew";
  EXPECT_EQ(j["scene"]["gap"]["contact"], "2 um");
}

TEST(Simulate, NeedsNoPullInForADriveInVolts) {
  const Workplace here;
  const Outcome o = here.run({"simulate", "gold.toml", "--set", "waveform.main.level=20 V", "--set",
                              "driver.main.max_voltage=90 V", "--set", "simulate.duration=60 us", "--json", "-"});
  EXPECT_TRUE(json::parse(o.out)["pull_in"].is_null());
}

TEST(Simulate, RunsItsOwnResolvedSceneToTheSameDigits_long) {
  const Workplace here;
  ASSERT_EQ(here.run({"simulate", "gold.toml", "--out", "first"}).status, 0);
  const json first = json::parse(read(here.path() / "first/result.json"));
  write(here.path() / "resolved.toml", first["scene_toml"]);
  const json second = json::parse(here.run({"simulate", "resolved.toml", "--json", "-"}).out);
  EXPECT_EQ(first["metrics"], second["metrics"]);
  EXPECT_EQ(first["errors"], second["errors"]);
}

TEST(Simulate, LeavesResultReportAndTrajectory) {
  const Workplace here;
  const Outcome o = here.run({"simulate", "gold.toml", "--out", "a/b", "--json", "copy.json", "--quiet"});
  EXPECT_EQ(o.status, 0);
  EXPECT_EQ(o.err, "");
  EXPECT_THAT(o.out, HasSubstr("\nIn a/b: report.html, gap.svg, result.json, trajectory.csv\n"));
  const std::string text = read(here.path() / "a/b/result.json"), short_text = read(here.path() / "copy.json");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
  EXPECT_LT(short_text.size(), 10'000U);
  const json whole = json::parse(text), copy = json::parse(short_text);
  for (const auto& [key, value] : copy.items()) EXPECT_EQ(value, whole[key]) << key;
  EXPECT_EQ(here.run({"export", "a/b"}).out, here.run({"export", "gold.toml"}).out);
  EXPECT_THAT(read(here.path() / "a/b/report.html"), HasSubstr("<html"));
  EXPECT_FALSE(read(here.path() / "a/b/trajectory.csv").empty());
  fs::remove(here.path() / "a/b/report.html");
  EXPECT_EQ(here.run({"report", "a/b"}).status, 0);
  EXPECT_THAT(read(here.path() / "a/b/report.html"), HasSubstr("<html"));
}

TEST(Simulate, GivesAForceFactorAsTheFactorItIsAndNeverAsAVoltage_long) {
  const Workplace here;
  write(here.path() / "casimir.toml", shipped("nem-casimir.toml"));
  ASSERT_EQ(here.run({"simulate", "casimir.toml", "--out", "run"}).status, 0);
  const json j = json::parse(read(here.path() / "run/result.json"));
  EXPECT_EQ(j["best"]["waveforms"], json({{"dispersion", {{0, 1}, {0, 1.25}, {j["curves"]["best"]["time_s"].back(), 1.25}}}}));
  EXPECT_EQ(j["metrics"]["peak_voltage_V"], 0);
  EXPECT_THAT(read(here.path() / "run/gap.svg"), HasSubstr("Force factor"));
  EXPECT_EQ(here.run({"optimize", "casimir.toml"}).err,
            "softland: --actuator electrostatic|both needs an electrode, and the scene has none; the factor of a "
            "dispersion force is not searched\n");
}

TEST(Simulate, EndsWithFourWhenTheSwitchDoesNotClose) {
  const Workplace here;
  const Outcome o = here.run({"simulate", "gold.toml", "--set", "simulate.duration=5 us", "--json", "-"});
  EXPECT_EQ(o.status, 4);
  const json j = json::parse(o.out);
  EXPECT_EQ(j["status"], "no_contact");
  EXPECT_TRUE(j["metrics"]["initial_contact_time_s"].is_null());
  EXPECT_TRUE(j["metrics"]["bounce_count"].is_null());
}

TEST(Simulate, EndsWithZeroWhenNoClosingWasDue) {
  const Workplace here;
  const Outcome o = here.run({"simulate", "gold.toml", "--set", "waveform.main.level=0.5 Vdp", "--json", "-"});
  EXPECT_EQ(o.status, 0);
  const json j = json::parse(o.out);
  EXPECT_EQ(j["status"], "open");
  EXPECT_GT(j["metrics"]["static_deflection_m"], 1e-8);
  EXPECT_GT(j["metrics"]["capacitance_F"], 1e-15);
  EXPECT_GT(j["metrics"]["overshoot_m"], 1e-9);
  EXPECT_TRUE(j["metrics"]["settled"].is_null());
  EXPECT_THAT(here.run({"simulate", "gold.toml", "--set", "waveform.main.level=0.5 Vdp"}).out,
              HasSubstr("The switch stays open, as commanded, "));
}

TEST(Simulate, CertifiesItsFigures_long) {
  const Workplace here;
  const Outcome plain = here.run({"simulate", "gold.toml", "--set", "simulate.accuracy=1e-3", "--json", "-"});
  const Outcome o =
      here.run({"simulate", "gold.toml", "--set", "simulate.accuracy=1e-3", "--certify", "--json", "-", "--out", "run"});
  ASSERT_EQ(o.status, 0) << o.err;
  const json j = json::parse(o.out), before = json::parse(plain.out);
  std::set<std::string> more = keys(before);
  more.insert({"certified", "cloud"});
  EXPECT_EQ(keys(j), more);
  EXPECT_EQ(j["metrics"], before["metrics"]);
  EXPECT_EQ(keys(j["errors"]), keys(before["errors"]));
  EXPECT_GT(j["errors"]["hold_force_N"], 0);
  ASSERT_TRUE(j["certified"].contains("permanent_contact_time_s"));
  const json& cloud = j["certified"]["permanent_contact_time_s"];
  EXPECT_EQ(keys(cloud), (std::set<std::string>{"median", "low", "high", "runs"}));
  EXPECT_LT(cloud["low"], cloud["high"]);
  EXPECT_EQ(j["cloud"]["runs"], 16);
  EXPECT_EQ(keys(j["cloud"]["grazing_rebound"]),
            (std::set<std::string>{"rebound", "time_s", "height_m", "impact_velocity_m_s", "at_significant_height"}));
  EXPECT_THAT(here.run({"report", "run"}).out, HasSubstr("Certified: "));
  EXPECT_EQ(here.run({"simulate", "gold.toml", "--set", "waveform.main.level=3 V", "--certify"}).status, 0);
}

TEST(Simulate, CertifiesTheSameOnAnyNumberOfThreads_optimized) {
  const Workplace here;
  const auto certified = [&](const char* jobs) {
    const Outcome o = here.run({"simulate", "gold.toml", "--certify", "--jobs", jobs, "--json", "-"});
    EXPECT_EQ(o.status, 0) << o.err;
    json j = json::parse(o.out);
    j.erase("command");
    j["work"].erase("wall_s");
    return j;
  };
  EXPECT_EQ(certified("1"), certified("3"));
}

TEST(PullIn, PrintsTheAgreedJson) {
  const Workplace here;
  const Outcome o = here.run({"pull-in", "gold.toml", "--quiet", "--json", "-"});
  ASSERT_EQ(o.status, 0);
  EXPECT_EQ(o.err, "");
  const json j = json::parse(o.out);
  EXPECT_EQ(keys(j), (std::set<std::string>{"kind", "status", "pull_in", "electrodes", "stable_path", "scene", "version",
                                            "made_with", "command"}));
  EXPECT_EQ(j["electrodes"], (json{{"main", {{"status", j["status"]}, {"pull_in", j["pull_in"]}}}}));
  EXPECT_EQ(keys(j["pull_in"]), (std::set<std::string>{"static_V", "static_kind", "deflection_m", "dynamic_V", "dynamic_kind",
                                                       "release_V", "pulled_through_V", "by_modes"}));
  EXPECT_EQ(j["status"], "done");
  EXPECT_LT(j["pull_in"]["dynamic_V"], j["pull_in"]["static_V"]);
  EXPECT_LT(j["pull_in"]["release_V"], j["pull_in"]["static_V"]);
}

TEST(PullIn, TellsSeveralElectrodesByName) {
  const Workplace here;
  write(here.path() / "two-electrodes.toml", shipped("two-electrodes.toml"));
  const std::vector<std::string> words{"two-electrodes.toml", "--quiet", "--json", "-"};
  const auto run = [&](const std::string& verb) {
    std::vector<std::string> all = words;
    all.insert(all.begin(), verb);
    return json::parse(here.run(all).out);
  };
  const json j = run("pull-in");
  EXPECT_EQ(keys(j), (std::set<std::string>{"kind", "status", "pull_in", "electrodes", "stable_path", "scene", "version",
                                            "made_with", "command"}));
  EXPECT_EQ(keys(j["pull_in"]), (std::set<std::string>{"main", "upper"}));
  EXPECT_EQ(j["status"], "done") << "the far electrode need not pull in";
  EXPECT_EQ(j["electrodes"]["upper"]["status"], "no_contact");
  EXPECT_EQ(j["pull_in"]["main"], run("check")["pull_in"]);
}

// A charge shifts the voltages of both polarities, and may keep a closed switch closed at 0 V.
TEST(PullIn, SaysWhatAChargeOnTheDielectricDoes) {
  const Workplace here;
  const auto charged = [&](const char* verb, const char* charge) {
    return std::vector<std::string>{
        verb,    "gold.toml",
        "--set", "gap.contact=3.2 um",
        "--set", fmt::format(R"(electrode.main.dielectric={{thickness="0.2 um",permittivity=7.6,charge="{}"}})", charge)};
  };
  const auto voltages = [&](const char* charge) {
    std::vector<std::string> words = charged("pull-in", charge);
    words.insert(words.end(), {"--json", "-", "--quiet"});
    return json::parse(here.run(words).out)["pull_in"];
  };
  const json without = voltages("0 C/m^2"), little = voltages("-0.5 mC/m^2"), much = voltages("4 mC/m^2");
  EXPECT_FALSE(without.contains("neutral_V"));
  EXPECT_NEAR(little["neutral_V"].get<double>(), 1.486, 1e-3);
  for (const char* voltage : {"static_V", "release_V", "pulled_through_V"})
    EXPECT_NEAR(little[voltage].get<double>() - little["neutral_V"].get<double>(), without[voltage].get<double>(), 1e-4)
        << voltage;
  EXPECT_LT(much["release_V"].get<double>(), 0);
  const std::string stuck = here.run(charged("pull-in", "4 mC/m^2")).out;
  EXPECT_THAT(stuck, HasSubstr("  charge           leaves no field at \u2212"
                               "11.889"));
  EXPECT_THAT(stuck, HasSubstr("a closed switch stays closed at 0 V"));
  EXPECT_THAT(here.run(charged("pull-in", "-0.5 mC/m^2")).out, Not(HasSubstr("stays closed")));
  const Outcome checked = here.run(charged("check", "4 mC/m^2"));
  EXPECT_THAT(checked.out, HasSubstr("its charge leaves no field at \u2212"
                                     "11.889"));
  EXPECT_THAT(checked.out, HasSubstr("keeps a closed switch closed at 0 V"));
}

TEST(PullIn, SaysAtWhichBiasItsVoltagesAre_optimized) {
  const Workplace here;
  const std::vector<std::string> own{"pull-in", "pzt.toml", "--set", R"(waveform.piezo={family="step",level="0.3 V"})"};
  const Outcome held = here.run(own), given = here.run({"pull-in", "pzt.toml", "--bias", "piezo=0.3 V"});
  EXPECT_EQ(held.status, 0) << held.err;
  EXPECT_EQ(held.out, given.out) << "its hold level, or what --bias says";
  EXPECT_THAT(held.out, HasSubstr("  under            piezo 300.00"));
  EXPECT_THAT(here.run({"pull-in", "pzt.toml"}).out, Not(HasSubstr("under")));
  const auto voltage = [&](const char* bias) {
    return json::parse(here.run({"pull-in", "pzt.toml", "--json", "-", "--bias", bias}).out)["pull_in"]["static_V"].get<double>();
  };
  EXPECT_LT(voltage("piezo=-0.1 V"), voltage("piezo=0 V"));
  EXPECT_GT(voltage("piezo=0.3 V"), voltage("piezo=0 V"));
  EXPECT_EQ(json::parse(here.run({"pull-in", "pzt.toml", "--json", "-", "--bias", "piezo=0.3 V"}).out)["bias_V"],
            (json{{"piezo", 0.3}}));
  const Outcome check = here.run({"check", "pzt.toml", "--set", own.back()});
  EXPECT_THAT(check.out, HasSubstr(", under piezo 300.00"));
}

TEST(PullIn, WritesASweepAndDrawsIt) {
  const Workplace here;
  const Outcome o = here.run({"pull-in", "gold.toml", "--sweep", "0 V:20 V:41", "--out", "swept"});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("sweep.csv, sweep.svg"));
  EXPECT_THAT(o.out, HasSubstr("  pull-in position 1.653"));
  const std::string csv = read(here.path() / "swept/sweep.csv"), svg = read(here.path() / "swept/sweep.svg");
  EXPECT_TRUE(csv.starts_with("voltage_V,deflection_m,capacitance_F,branch,status\n0,0,")) << csv.substr(0, 80);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * 41);
  EXPECT_THAT(svg, HasSubstr("Pull-in at 15.23"));
  EXPECT_THAT(svg, HasSubstr(">down<"));
}

TEST(PullIn, SaysInEveryRowOfASweepHowTheSwitchStands) {
  const Workplace here;
  const auto swept = [&](const std::string& range) {
    const Outcome o = here.run({"pull-in", "gold.toml", "--sweep", range, "--out", "swept", "--json", "-"});
    EXPECT_EQ(o.status, 0) << o.err;
    return json::parse(o.out)["sweep"];
  };
  std::set<std::string> states;
  for (const char* range : {"0 V:20 V:11", "0 V:200 V:6"}) {
    const json rows = swept(range);
    std::istringstream csv(read(here.path() / "swept/sweep.csv"));
    std::string line;
    std::getline(csv, line);
    for (const json& row : rows) {
      const std::string status = row["status"];
      states.insert(status);
      ASSERT_TRUE(std::getline(csv, line));
      EXPECT_TRUE(line.ends_with("," + row["branch"].get<std::string>() + "," + status)) << line;
      const bool is_through = status == "collapsed_onto_electrode";
      EXPECT_EQ(row["deflection_m"].is_null(), is_through) << row;
      EXPECT_EQ(row["capacitance_F"].is_null(), is_through) << row;
      EXPECT_EQ(line.find(",,,") != std::string::npos, is_through) << line;
    }
  }
  EXPECT_EQ(states, (std::set<std::string>{"open", "closed", "collapsed_onto_electrode"}));
}

TEST(PullIn, GivesWhatItHasWhereItIsInterrupted_optimized) {
  const Workplace here;
  // The static voltage is printed at once, the dynamic one takes minutes.
  const std::vector<std::string> slow{"pull-in", "gold.toml", "--set", "structure.modes=20", "--set", "gas.model=reynolds"};
  for (const bool as_json : {false, true}) {
    std::vector<std::string> words = slow;
    if (as_json) words.insert(words.end(), {"--json", "-"});
    const pid_t child = here.start(words);
    wait_until_it_computes(child);
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    kill(child, SIGINT);
    const Outcome o = here.finish(child);
    EXPECT_EQ(o.status, 130) << o.err;
    if (!as_json) {
      EXPECT_THAT(o.out, HasSubstr("  static pull-in   "));
      EXPECT_THAT(o.out, HasSubstr("  dynamic pull-in  not known: the search for it was interrupted"));
      EXPECT_THAT(o.out,
                  HasSubstr("interrupted before these results were found: dynamic pull-in of electrode main; the stable path."));
      continue;
    }
    const json j = json::parse(o.out);
    EXPECT_EQ(j["status"], "interrupted");
    EXPECT_TRUE(j["pull_in"]["static_V"].is_number()) << j;
    EXPECT_TRUE(j["pull_in"]["release_V"].is_number()) << j;
    EXPECT_TRUE(j["pull_in"]["dynamic_V"].is_null()) << j;
    EXPECT_EQ(j["left_out"], (json{"dynamic pull-in of electrode main", "the stable path"}));
  }
}

TEST(PullIn, SaysWhenTheDynamicOneEqualsTheStaticOne_optimized) {
  const Workplace here;
  EXPECT_THAT(here.run({"pull-in", "gold.toml"}).out, Not(HasSubstr("overdamped")));
  for (const char* verb : {"pull-in", "check"}) {
    const std::string text = here.run({verb, "gold.toml", "--set", "gas.viscosity=0.1 Pa s"}).out;
    EXPECT_THAT(text, HasSubstr("(overdamped: equals the static one)")) << verb;
  }
}

// tests/verbs checks the JSON of every study.
TEST(Report, FindsWhatAStudyLeftInItsFolder_optimized) {
  const Workplace here;
  ASSERT_NE(here.run({"release", "gold.toml", "--budget", "60", "--samples", "0", "--set", "structure.modes=1", "--out", "open"})
                .status,
            2);
  const std::string svg = read(here.path() / "open/release.svg");
  const Outcome o = here.run({"report", "open", "--out", "again"});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("\nIn again: release.svg\n"));
  EXPECT_EQ(read(here.path() / "again/release.svg"), svg);
  write(here.path() / "open/release.json", edited(read(here.path() / "open/release.json"), "\"band_m\"", "\"band_km\""));
  const Outcome damaged = here.run({"report", "open"});
  EXPECT_EQ(damaged.status, 2);
  EXPECT_THAT(damaged.err, HasSubstr("open/release.json: \"band_"));
  EXPECT_EQ(read(here.path() / "open/release.svg"), svg) << "it is left alone";
}

TEST(Check, SaysWhenTheSwitchHasNoOpenState) {
  const Workplace here;
  write(here.path() / "casimir.toml", shipped("nem-casimir.toml"));
  EXPECT_THAT(here.run({"check", "casimir.toml", "--set", "gap.electrode=45 nm"}).out,
              HasSubstr("dispersion force     no open state: the switch closes by itself if the force has at least 0.7253 of its "
                        "nominal "
                        "strength\n"));
  write(here.path() / "tin.toml", shipped("nem-tin.toml"));
  for (const char* verb : {"check", "pull-in"}) {
    const Outcome o = here.run({verb, "tin.toml", "--set", "gap.electrode=3 nm", "--set", "gap.contact=2 nm", "--set",
                                "waveform.main.level=1 V", "--set", "driver.main.max_voltage=2 V"});
    EXPECT_EQ(o.status, verb == std::string("pull-in") ? 4 : 0) << verb;
    const std::string& text = o.out;
    EXPECT_THAT(text, HasSubstr("no pull-in voltage: the switch has no open state")) << verb;
    EXPECT_THAT(text, Not(HasSubstr("none"))) << verb;
  }
}

TEST(Modes, PrintsTheAgreedJson) {
  const Workplace here;
  const Outcome o = here.run({"modes", "gold.toml", "--quiet", "--set", "structure.modes=6", "--json", "-"});
  ASSERT_EQ(o.status, 0);
  EXPECT_EQ(o.err, "");
  const json j = json::parse(o.out);
  EXPECT_EQ(keys(j), (std::set<std::string>{"command", "kind", "made_with", "natural_frequencies_rad_s", "version", "warnings"}));
  const std::vector<double> omega = j["natural_frequencies_rad_s"];
  EXPECT_EQ(omega.size(), 6U);
  EXPECT_TRUE(std::is_sorted(omega.begin(), omega.end()));
}

TEST(Check, TellsHowASwitchRestsThatIsNotStraight) {
  const Workplace here;
  const auto check = [&](const std::string& setting) {
    const Outcome o = here.run({"check", "gold.toml", "--json", "-", "--quiet", "--set", setting});
    EXPECT_EQ(o.status, 0) << o.err;
    return nlohmann::json::parse(o.out);
  };
  const std::string table =
      "structure.rest_shape={positions=[\"0 um\", \"80 um\", \"tip\"], heights=[\"0 nm\", \"-40 nm\", \"300 nm\"]}";
  const nlohmann::json bent = check(table)["rest_shape"];
  constexpr double rounding = 1e-15;
  EXPECT_NEAR(bent["far_end_rise_m"].get<double>(), 300e-9, rounding);
  EXPECT_NEAR(bent["far_end_gap_m"].get<double>(), 3.8e-6, rounding);
  EXPECT_NEAR(bent["contact_rise_m"].get<double>(), 295e-9, rounding);
  EXPECT_NEAR(bent["contact_gap_m"].get<double>(), 2.295e-6, rounding);
  EXPECT_NEAR(bent["least_electrode_gap_m"].get<double>(), 3.46e-6, rounding);
  const Outcome text = here.run({"check", "gold.toml", "--set", table});
  EXPECT_THAT(text.out,
              testing::AllOf(
                  HasSubstr("the far end rests 300.0\u00a0nm further from the near electrode than that of a straight structure"),
                  HasSubstr("contact gap 2.295\u00a0µm"), HasSubstr("the smallest gap over an electrode is 3.460\u00a0µm")));
  EXPECT_GT(check("structure.stress_gradient=0.1 MPa/um")["rest_shape"]["contact_rise_m"].get<double>(), 0);
  EXPECT_FALSE(check("structure.stress_gradient=0 Pa/m").contains("rest_shape"));
}

TEST(EveryVerb, PrintsNumbersThatPeopleRead_slow) {
  const Workplace here;
  for (const char* scene : {"nem-tin.toml", "nem-casimir.toml", "two-electrodes.toml", "hung-senturia.toml"})
    write(here.path() / scene, shipped(scene));
  const std::vector<std::vector<std::string>> calls{
      {"check", "gold.toml"},
      {"check", "pzt.toml"},
      {"check", "nem-tin.toml"},
      {"check", "nem-casimir.toml"},
      {"check", "two-electrodes.toml"},
      {"check", "hung-senturia.toml"},
      {"modes", "gold.toml"},
      {"modes", "nem-tin.toml"},
      {"modes", "two-electrodes.toml"},
      {"pull-in", "gold.toml"},
      {"pull-in", "nem-tin.toml"},
      {"simulate", "pzt.toml"},
      {"simulate", "nem-tin.toml"},
      {"simulate", "nem-casimir.toml"},
      {"simulate", "two-electrodes.toml"},
      {"simulate", "gold.toml", "--set", "structure.damping_ratio=1e-9", "--set", "simulate.effects=auto", "--set",
       "simulate.duration=60 us"},
      {"simulate", "gold.toml", "--set", "simulate.accuracy=1e-10", "--set", "simulate.duration=60 us"},
      {"effects", "hung-senturia.toml"},
      {"effects", "gold.toml", "--set", "simulate.duration=60 us"},
      {"accuracy", "gold.toml", "--quiet", "--set", "simulate.duration=40 us"}};
  for (const std::vector<std::string>& words : calls) {
    const Outcome o = here.run(words);
    EXPECT_EQ(o.status, 0) << words[0] << " " << words[1] << ": " << o.err;
    EXPECT_EQ(absurd_number(o.out + o.err), "") << words[0] << " " << words[1] << ":\n" << o.out << o.err;
  }
}

TEST(New, WritesScenesThatCheckAccepts_long) {
  const Workplace here;
  for (const char* kind : {"cantilever", "cantilever-pzt", "clamped-clamped", "hinged-plate", "plate", "two-electrodes",
                           "two-contacts", "capacitive-bridge", "nem-cantilever", "nem-casimir"}) {
    const Outcome fresh = here.run({"new", kind});
    EXPECT_EQ(fresh.status, 0);
    EXPECT_EQ(fresh.err, "");
    write(here.path() / "new.toml", fresh.out);
    const Outcome checked = here.run({"check", "new.toml"});
    EXPECT_EQ(checked.status, 0) << checked.err;
    EXPECT_THAT(checked.out, HasSubstr("new.toml: valid"));
    EXPECT_THAT(checked.out, HasSubstr(kind == std::string("nem-casimir") ? "dispersion force" : "Vdp"));
  }
}

TEST(Check, PrintsTheKnudsenNumberOfTheScenesOwnGas) {
  const Workplace here;
  const auto check = [&](const char* setting) { return here.run({"check", "gold.toml", "--set", setting}).out; };
  EXPECT_THAT(check("gas.mean_free_path=\"70 nm\""),
              HasSubstr("Knudsen number       0.02 at the rest gap, 0.0467 in the closed state (mean free path 70\u00a0nm)"));
  // mu / p sqrt(pi R_g T / 2) with the viscosity of the scene.
  EXPECT_THAT(check("gas.pressure=\"1 kPa\""), HasSubstr("(mean free path 6.84\u00a0µm)"));
}

TEST(Effects, PrintATableAndTheAgreedJson_long) {
  const Workplace here;
  const Outcome table = here.run({"effects", "gold.toml", "--set", "simulate.duration=60 us"});
  const Outcome data = here.run({"effects", "gold.toml", "--set", "simulate.duration=60 us", "--json", "-"});
  EXPECT_EQ(table.status, 0) << table.err;
  EXPECT_THAT(table.out, HasSubstr("* strip"));
  EXPECT_THAT(table.out, HasSubstr("range of the figures over the gas laws"));
  const json j = json::parse(data.out);
  EXPECT_EQ(keys(j), (std::set<std::string>{"kind", "status", "left_out", "effects", "not_compared", "duration_s",
                                            "relative_spread", "scene", "version", "command", "made_with"}));
  EXPECT_EQ(j["effects"].size(), 7U);
  EXPECT_EQ(keys(j["effects"][0]),
            (std::set<std::string>{"section", "choice", "in_scene", "status", "magnitude", "dimensionless_group", "metrics",
                                   "relative_change", "rhs_s", "warnings"}));
  EXPECT_GT(j["relative_spread"]["gas"]["impact_velocity"], 0);
  EXPECT_GT(j["effects"][1]["rhs_s"], 0);
  ASSERT_EQ(j["left_out"].size(), 3U);
  EXPECT_EQ(keys(j["left_out"][2]), (std::set<std::string>{"effect", "choice", "magnitude", "dimensionless_group", "metrics",
                                                           "relative_change", "influence", "rhs_s"}));
  EXPECT_EQ(j["left_out"][2]["effect"], "gas");
  EXPECT_THAT(table.out, HasSubstr("left out"));
}

TEST(Effects, SayFirstThatTheSwitchDoesNotCloseAndEndWithFour) {
  const Workplace here;
  const Outcome o = here.run({"effects", "gold.toml", "--set", "waveform.main.level=5 V", "--set", "simulate.duration=60 us"});
  EXPECT_EQ(o.status, 4) << o.err;
  EXPECT_THAT(o.out, testing::StartsWith("The switch does not close within 60.0\u00a0µs. There are no figures to compare"));
}

TEST(Effects, AreChosenByTheSceneAndSaidInTheResult) {
  const Workplace here;
  const Outcome o = here.run({"simulate", "gold.toml", "--set", "simulate.duration=60 us", "--set",
                              "structure.damping_ratio=1e-9", "--set", "simulate.effects=auto", "--json", "-"});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.err, HasSubstr("one evaluation of the equations of motion takes "));
  const json j = json::parse(o.out);
  ASSERT_EQ(j["effects"]["left_out"].size(), 1U);
  EXPECT_EQ(j["effects"]["left_out"][0]["effect"], "structure.damping_ratio");
  EXPECT_LT(j["effects"]["left_out"][0]["influence"], 1e-3);
  EXPECT_EQ(j["scene"]["simulate"]["effects"], "all") << "the scene written is the one that ran";
}

// The last digits depend on the program, which is identified by its hash, and on the processor.
TEST(Results, SayWhatTheyWereMadeWith_long) {
  const Workplace here;
  const Outcome o = here.run({"simulate", "gold.toml", "--set", "simulate.duration=20 us", "--json", "-", "--out", "made"});
  const json made = json::parse(o.out)["made_with"];
  EXPECT_EQ(keys(made),
            (std::set<std::string>{"program", "compiler", "options", "instruction_set", "vectors", "c_library", "processor"}));
  const std::string program = made["program"];
  ASSERT_EQ(program.size(), 40U);
  std::string bytes;
  for (std::size_t i = 0; i < program.size(); i += 2) bytes += static_cast<char>(std::stoi(program.substr(i, 2), nullptr, 16));
  EXPECT_NE(read(SOFTLAND_PROGRAM).find(bytes), std::string::npos);
  EXPECT_THAT(made["options"].get<std::string>(), HasSubstr("-fno-math-errno"));
  const std::string processors = read("/proc/cpuinfo");
  if (processors.find("model name") != std::string::npos) {
    EXPECT_NE(processors.find(": " + made["processor"].get<std::string>() + "\n"), std::string::npos);
  }
  const std::string page = read(here.path() / "made/report.html");
  EXPECT_THAT(page, HasSubstr("program " + program.substr(0, 12)));
  EXPECT_THAT(page, HasSubstr(made["c_library"].get<std::string>()));
}

TEST(Accuracy, PrintsATableAndTheAgreedJsonAndDraws_long) {
  const Workplace here;
  const Outcome o =
      here.run({"accuracy", "gold.toml", "--quiet", "--set", "simulate.duration=60 us", "--json", "a.json", "--out", "acc"});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(o.err, "");
  EXPECT_THAT(o.out, HasSubstr("the fastest setting with which t_i, v_i, B_H and peak force are that accurate"));
  EXPECT_THAT(o.out, HasSubstr("\nIn acc: report.html, accuracy.svg, accuracy.json\n"));
  EXPECT_THAT(read(here.path() / "acc/accuracy.svg"), HasSubstr("accuracy against computing time"));
  EXPECT_THAT(read(here.path() / "acc/report.html"), HasSubstr("softland accuracy gold.toml"));
  const json j = json::parse(read(here.path() / "a.json"));
  EXPECT_EQ(j, json::parse(read(here.path() / "acc/accuracy.json")));
  EXPECT_EQ(keys(j),
            (std::set<std::string>{"kind", "status", "scene", "scene_toml", "version", "made_with", "command", "reference",
                                   "rows", "modes", "without_restart_at_contact", "cloud", "recommendations"}));
  const json& row = j["rows"][0];
  EXPECT_EQ(j["without_restart_at_contact"].size(), 35U);
  EXPECT_EQ(keys(row), (std::set<std::string>{"integrator", "tolerance", "points_per_length", "modes", "relative_errors",
                                              "metrics", "steps", "rhs_evaluations", "cpu_s", "runs"}));
  EXPECT_EQ(keys(row["relative_errors"]), (std::set<std::string>{"initial_contact_time_s", "impact_velocity_m_s",
                                                                 "major_bounce_height_m", "peak_contact_force_N"}));
  EXPECT_EQ(keys(j["cloud"]["bounce_count"]), (std::set<std::string>{"low", "median", "high", "runs"}));
  EXPECT_EQ(j["cloud"]["major_bounce_height_m"]["well_conditioned"], true);
  EXPECT_EQ(keys(j["recommendations"][0]), (std::set<std::string>{"accuracy", "words", "setting"}));
  EXPECT_LE(j["recommendations"][1]["setting"]["relative_errors"]["major_bounce_height_m"], 1e-3);
}

TEST(Accuracy, EndsWithFourWhenTheSwitchDoesNotClose) {
  const Workplace here;
  const Outcome o = here.run({"accuracy", "gold.toml", "--set", "waveform.main.level=0.5 Vdp", "--out", "acc"});
  EXPECT_EQ(o.status, 4);
  EXPECT_THAT(o.out, HasSubstr("The switch does not touch within the window"));
  EXPECT_FALSE(fs::exists(here.path() / "acc"));
}

TEST(Check, CitesTheLimitOfTheScenesOwnFilm_optimized) {
  const Workplace here;
  const std::string scene = std::string(SOFTLAND_SOURCE_DIR) + "/scenes/gap-closing-actuator.toml";
  const auto said = [&](const std::string& law) {
    return here.run({"check", scene, "--quiet", "--set", "gas={ model = \"" + law + "\" }"}).out;
  };
  EXPECT_THAT(said("strip"), HasSubstr("(first mode; the law strip holds below about 10)"));
  EXPECT_THAT(said("reynolds"), HasSubstr("(first mode; the law reynolds holds below about 1000)"));
  EXPECT_THAT(said("guo-alexeenko"), HasSubstr("(first mode)"));
}

TEST(Export, RefusesAForceFactorBecauseItIsNoVoltage) {
  const Workplace here;
  const Outcome bad = here.run({"export", std::string(SOFTLAND_SOURCE_DIR) + "/scenes/nem-casimir.toml"});
  EXPECT_EQ(bad.status, 2);
  EXPECT_THAT(bad.err, HasSubstr("nem-casimir.toml:"));
  EXPECT_THAT(bad.err, HasSubstr("there is no waveform to export: 'dispersion' is a factor of the model"));
}

TEST(Export, SaysOfAnOptionWhatTheSceneSaysOfItsKey) {
  const Workplace here;
  const std::string scene = std::string(SOFTLAND_SOURCE_DIR) + "/scenes/mem-gold.toml";
  const Outcome bad = here.run({"export", scene, "--format", "siglent-csv", "--sample-rate", "1 MHz", "--bits", "99"});
  EXPECT_EQ(bad.status, 2);
  EXPECT_THAT(bad.err, HasSubstr("--bits 99: [driver.main]"));
  EXPECT_THAT(bad.err, Not(HasSubstr("--set")));
}

TEST(Export, SaysHowFarAMeasuredTimeIsFromTheNominalOne) {
  const Workplace here;
  const std::string scene = std::string(SOFTLAND_SOURCE_DIR) + "/scenes/mem-gold.toml";
  // 3 us of 36.83 us.
  EXPECT_THAT(here.run({"export", scene, "--measured", "time=3 us"}).err, HasSubstr("differs from the nominal device by 91.9 %"));
}

TEST(Check, WarnsOfAGasBeyondTheLimitsOfItsLaw) {
  const Workplace here;
  const std::string scene = std::string(SOFTLAND_SOURCE_DIR) + "/scenes/mem-gold.toml";
  const Outcome text = here.run({"check", scene, "--quiet", "--set", "gas.pressure=10 Pa"});
  EXPECT_THAT(text.out, HasSubstr("warning: gas law strip: Knudsen number 456 exceeds"));
  EXPECT_THAT(here.run({"check", scene, "--quiet"}).out, Not(HasSubstr("Knudsen number 0")));
}

TEST(CommandLine, ARefusedSceneLeavesNoFolder) {
  const Workplace here;
  const std::string scene = std::string(SOFTLAND_SOURCE_DIR) + "/scenes/mem-gold.toml";
  std::filesystem::create_directory(here.path() / "there");
  for (const std::string verb : {"simulate", "accuracy", "optimize", "limit", "release", "robustness"}) {
    SCOPED_TRACE(verb);
    EXPECT_EQ(here.run({verb, scene, "--set", "gap.contact=-1 um", "--out", "refused"}).status, 2);
    EXPECT_FALSE(std::filesystem::exists(here.path() / "refused"));
    EXPECT_EQ(here.run({verb, scene, "--set", "gap.contact=-1 um", "--out", "there"}).status, 2);
    EXPECT_TRUE(std::filesystem::exists(here.path() / "there"));
  }
  EXPECT_EQ(here.run({"pull-in", scene, "--out", "refused"}).status, 2);
  EXPECT_FALSE(std::filesystem::exists(here.path() / "refused"));
}

TEST(CommandLine, AnOptionIsNotTakenForTheValueOfAnother) {
  const Workplace here;
  const std::string scene = std::string(SOFTLAND_SOURCE_DIR) + "/scenes/mem-gold.toml";
  for (const std::vector<std::string>& words : {std::vector<std::string>{"simulate", scene, "--json", "--quiet"},
                                                {"optimize", "--json", "--bogus"},
                                                {"limit", scene, "--out", "--no-curves"},
                                                {"limit", scene, "--actuator", "--quiet"}}) {
    const Outcome bad = here.run(words);
    EXPECT_EQ(bad.status, 2);
    EXPECT_THAT(bad.err, HasSubstr("a value is missing: " + words.back() + " is an option"));
    EXPECT_FALSE(std::filesystem::exists(here.path() / words.back()));
  }
}

TEST(Read, ShowsWhatAFileHolds) {
  const Workplace here;
  write(here.path() / "scope.csv", "x-axis,1\nsecond,Volt\n-1E-06,+0.5\n0E-06,+1.5\n1E-06,+2.5\n");
  const Outcome text = here.run({"read", "scope.csv"});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("Keysight CSV: 1 [V], 3 samples, every 1 us, from -1 us to 1 us"));
  const json data = json::parse(here.run({"read", "scope.csv", "--json", "-"}).out);
  EXPECT_EQ(data["time"], (json{{"first_s", -1e-6}, {"last_s", 1e-6}, {"interval_s", 1e-6}, {"repeated", 0}}));
  EXPECT_EQ(
      data["channels"],
      json::array(
          {{{"name", "1"}, {"unit", "V"}, {"samples", 3}, {"first", 0.5}, {"last", 2.5}, {"minimum", 0.5}, {"maximum", 2.5}}}));
  EXPECT_EQ(data["left_out"], json::array());
  const Outcome plot = here.run({"read", "scope.csv", "--plot", "--json", "scope.json"});
  EXPECT_THAT(plot.out, HasSubstr("<svg"));
  EXPECT_EQ(json::parse(read(here.path() / "scope.json")), data);
}

TEST(Read, NamesWhatItCannotRead) {
  const Workplace here;
  write(here.path() / "fft.csv", "Frequency (Hz),CH1 (dBV)\n0,1\n1,2\n");
  write(here.path() / "comma.csv", "0,5\n1,7\n");
  const auto said = [&](const std::vector<std::string>& words) {
    const Outcome o = here.run(words);
    EXPECT_EQ(o.status, 2) << o.out;
    return o.err;
  };
  EXPECT_THAT(said({"read", "fft.csv"}), HasSubstr("fft.csv: the file holds a spectrum"));
  EXPECT_THAT(said({"read", "comma.csv"}), HasSubstr("decimal = "));
  EXPECT_EQ(here.run({"read", "comma.csv", "--set", "decimal=,"}).status, 0);
  EXPECT_THAT(here.run({"read", "comma.csv", "--set", "decimal=,", "--set", "interval=2 us"}).out,
              HasSubstr("every 2 us, from 0 s to 2 us"));
  EXPECT_THAT(said({"read", "comma.csv", "--set", "scale=2"}), HasSubstr("is not a key for reading a file"));
  EXPECT_THAT(said({"read", "comma.csv", "--set", "decimals=,"}), HasSubstr("did you mean 'decimal'?"));
  EXPECT_THAT(said({"read", "comma.csv", "--plot", "--json", "-"}), HasSubstr("standard output"));
  EXPECT_THAT(said({"read", "absent.csv"}), HasSubstr("absent.csv: cannot be read"));
}

TEST(Export, PrintsTheWaveformsOfAScene) {
  const Workplace here;
  const Outcome csv = here.run({"export", "gold.toml"}), pwl = here.run({"export", "gold.toml", "--format", "spice-pwl"});
  EXPECT_EQ(csv.status, 0);
  EXPECT_THAT(csv.out, HasSubstr("main"));
  EXPECT_EQ(pwl.status, 0);
  EXPECT_THAT(pwl.out, HasSubstr("PWL"));
}

// Returns the rows of a waveform file with one drive.
std::vector<std::array<double, 2>> waveform(const std::string& csv) {
  std::vector<std::array<double, 2>> rows;
  std::istringstream in(csv.substr(csv.find("\n", csv.find("time_s")) + 1));
  std::array<double, 2> row{};
  for (char comma = 0; in >> row[0] >> comma >> row[1];) rows.push_back(row);
  return rows;
}

TEST(Export, PrintsTheWaveformOfOneDeviceInItsOwnUnits_optimized) {
  const Workplace here;
  write(here.path() / "pulse.toml",
        edited(edited(edited(shipped("mem-gold.toml"), "family = \"step\"", "family = \"pulse\""), "level = \"1.25 Vdp\"",
                      "levels = [\"16 V\", \"3 V\", \"15 V\"]\ntimes = [\"20 us\", \"33 us\"]\nedge = \"1 us\""),
               "1.5 Vdp", "25 V"));
  const json pull_in = json::parse(here.run({"pull-in", "pulse.toml", "--json", "-"}).out);
  const json modes = json::parse(here.run({"modes", "pulse.toml", "--json", "-"}).out);
  const double own_volts = pull_in["pull_in"]["dynamic_V"],
               own_frequency = modes["natural_frequencies_rad_s"][0].get<double>() / 6.283185307179586;
  const auto nominal = waveform(here.run({"export", "pulse.toml"}).out);
  const Outcome o = here.run({"export", "pulse.toml", "--device-vdp", std::to_string(1.1 * own_volts) + " V",
                              "--device-frequency", std::to_string(own_frequency / 1.2) + " Hz"});
  ASSERT_EQ(o.status, 0) << o.err;
  const auto own = waveform(o.out);
  ASSERT_GT(nominal.size(), 5U);
  ASSERT_EQ(own.size(), nominal.size());
  for (std::size_t i = 0; i + 1 < own.size(); ++i) {  // the last row is at the end of the window
    EXPECT_NEAR(own[i][0], 1.2 * nominal[i][0], 1e-5 * own[i][0]);
    EXPECT_NEAR(own[i][1], 1.1 * nominal[i][1], 1e-5 * own[i][1]);
  }
  // A value that is not measured is that of the nominal device.
  EXPECT_EQ(waveform(here.run({"export", "pulse.toml", "--device-frequency", std::to_string(own_frequency) + " Hz"}).out).size(),
            nominal.size());
}

std::string sampled_gold() {
  return edited(edited(shipped("mem-gold.toml"), "level = \"1.25 Vdp\"", "level = \"17.7 V\"\nrise_time = \"2.34 us\""),
                "max_voltage = \"1.5 Vdp\"",
                "max_voltage = \"22 V\"\nsample_rate = \"25 MHz\"\nbits = 12\nbandwidth = \"1 MHz\"\nmax_slew = \"20 V/us\"");
}

// The samples are on the generator's own grid. Read back under the same driver they give the same closing.
TEST(Export, HoldsTheCommandedSamples_optimized) {
  const Workplace here;
  write(here.path() / "sampled.toml", sampled_gold());
  const Outcome told = here.run({"export", "sampled.toml"});
  ASSERT_EQ(told.status, 0) << told.err;
  const auto rows = waveform(told.out);
  ASSERT_EQ(rows.size(), 60U) << "up to 2.36 us, and the first";
  for (std::size_t k = 0; k < rows.size(); ++k) EXPECT_EQ(rows[k][0], static_cast<double>(k) / 25e6);
  write(here.path() / "told.csv", told.out);
  write(here.path() / "again.toml", edited(sampled_gold(), "family = \"step\"\nlevel = \"17.7 V\"\nrise_time = \"2.34 us\"",
                                           "family = \"table\"\nfile = \"told.csv\""));
  const json first = json::parse(here.run({"simulate", "sampled.toml", "--quiet", "--json", "-"}).out),
             again = json::parse(here.run({"simulate", "again.toml", "--quiet", "--json", "-"}).out);
  EXPECT_EQ(again["metrics"].dump(), first["metrics"].dump());
  EXPECT_EQ(again["errors"].dump(), first["errors"].dump());
  EXPECT_EQ(here.run({"export", "again.toml"}).out, told.out);

  const Outcome integers = here.run({"export", "sampled.toml", "--format", "codes"});
  EXPECT_THAT(integers.out, testing::StartsWith("index,main\n0,0\n1,"));
  EXPECT_THAT(integers.out, HasSubstr("\n59,3295\n")) << "17.7 V of 22 V in 4095 steps";
  const Outcome output = here.run({"export", "sampled.toml", "--signal", "output"});
  ASSERT_EQ(output.status, 0) << output.err;
  EXPECT_NE(output.out, told.out);
  EXPECT_GT(waveform(output.out).size(), 2 * rows.size()) << "the answer of the filter";
  // Without errors, filter and samples the output of a source is the commanded waveform.
  EXPECT_EQ(here.run({"export", "gold.toml"}).out, here.run({"export", "gold.toml", "--signal", "output"}).out);
  for (const auto& [words, said] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"gold.toml", "--format", "codes"}, "no driver takes samples"},
           {{"sampled.toml", "--format", "codes", "--signal", "output"}, "a generator takes the commanded samples"},
           {{"gold.toml", "--signal", "both"}, "--signal both: must be told or output"}}) {
    std::vector<std::string> all{"export"};
    all.insert(all.end(), words.begin(), words.end());
    const Outcome bad = here.run(all);
    EXPECT_EQ(bad.status, 2) << said;
    EXPECT_THAT(bad.err, HasSubstr(said));
  }
}

// A landing that a low sample rate spoils.
std::string landing_gold() {
  return edited(
      edited(shipped("mem-gold.toml"), "family = \"step\"\nlevel = \"1.25 Vdp\"", "family = \"table\"\nfile = \"landing.csv\""),
      "max_voltage = \"1.5 Vdp\"", "max_voltage = \"22 V\"");
}

TEST(Export, ForAGeneratorTellsHowTheSwitchClosesAsSampled_optimized) {
  const Workplace here;
  write(here.path() / "landing.csv",
        "time_s,main\n0,0\n0,17.62466013928794\n1.6487295722408488e-06,21.320702395063936\n1.652118037496e-05,21.3206951563\n"
        "2.783202841320688e-05,0\n3.673540044825161e-05,18.197171607619715\n6.21815511979105e-05,19.618909216948126\n"
        "8.907219901692676e-05,21.112071872909596\n0.00012199774589255393,19.365491280069566\n0.00012364648118146727,"
        "17.76726028859526\n");
  write(here.path() / "landing.toml", landing_gold());
  const auto exported = [&](const std::string& rate, const std::string& bits, const std::string& format) {
    return here.run({"export", "landing.toml", "--format", format, "--sample-rate", rate, "--bits", bits, "--amplifier", "20"});
  };
  const Outcome fine = exported("100 MHz", "16", "keysight-arb");
  ASSERT_EQ(fine.status, 0) << fine.err;
  EXPECT_THAT(fine.out, HasSubstr("Sample Rate:100000000\n"));
  EXPECT_THAT(fine.err, HasSubstr("MS/s, 16 bit), the nominal design behaves as follows: the switch closes"));
  EXPECT_THAT(fine.err, Not(HasSubstr("warning")));
  const Outcome coarse = exported("2 MHz", "5", "rigol-csv");
  EXPECT_THAT(coarse.err, HasSubstr("MS/s, 5 bit), the nominal design behaves as follows: the switch first touches"));
  EXPECT_THAT(coarse.err, HasSubstr("warning: without sampling, the switch closes"));

  // The exported file, read back by a scene, gives the same closing.
  write(here.path() / "fine.csv", exported("100 MHz", "16", "tektronix-csv").out);
  write(here.path() / "back.toml", edited(landing_gold(), "file = \"landing.csv\"", "file = \"fine.csv\"\nscale = 20"));
  const std::vector<std::string> sampled{
      "--quiet", "--json", "-", "--set", "driver.main.sample_rate=100 MHz", "--set", "driver.main.bits=16"};
  const auto metrics = [&](const std::string& scene) {
    std::vector<std::string> words{"simulate", scene};
    words.insert(words.end(), sampled.begin(), sampled.end());
    const Outcome o = here.run(words);
    EXPECT_EQ(o.status, 0) << o.err;
    return json::parse(o.out)["metrics"].dump();
  };
  EXPECT_EQ(metrics("back.toml"), metrics("landing.toml"));

  for (const auto& [words, said] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"--format", "awg"}, "--format awg: must be one of csv, spice-pwl, codes, spice-model"},
           {{"--format", "rigol-csv"}, "drive 'main' takes no samples: give --sample-rate"},
           {{"--format", "rigol-csv", "--sample-rate", "27 V"}, "--sample-rate 27 V: [driver.main] expected a frequency"},
           {{"--format", "siglent-csv", "--sample-rate", "150 MHz"},
            "Siglent SDG1000X takes at most 16384; choose a sample rate of at most "},
           {{"--format", "keysight-arb", "--sample-rate", "1 MHz", "--amplifier", "0"}, "must be above 0"},
           {{"--format", "keysight-arb", "--sample-rate", "1 MHz", "--marker", "1 s"}, "must be within the waveform"},
           {{"--format", "digilent-csv", "--sample-rate", "1 MHz", "--marker", "1 us"}, "cannot hold a marker"},
           {{"--format", "csv", "--amplifier", "20"}, "belong to the file of a generator"},
           {{"--drive", "piezo"}, "unknown drive; choose one of main"}}) {
    std::vector<std::string> all{"export", "landing.toml"};
    all.insert(all.end(), words.begin(), words.end());
    const Outcome bad = here.run(all);
    EXPECT_EQ(bad.status, 2) << said;
    EXPECT_THAT(bad.err, HasSubstr(said));
  }
}

// The closing, its limits and all messages have the voltages at the switch. Only the samples of the generator are smaller.
TEST(Export, AnAmplifierOfTheDriverIsCountedOnce) {
  const Workplace here;
  const auto scene = [&](const std::string& name, const std::string& keys) {
    write(here.path() / name,
          edited(edited(shipped("mem-gold.toml"), "level = \"1.25 Vdp\"", "level = \"18 V\""), "max_voltage = \"1.5 Vdp\"",
                 "max_voltage = \"40 V\"\nsample_rate = \"25 MHz\"\nbits = 14\n" + keys + "#"));
    return name;
  };
  scene("plain.toml", ""), scene("amplified.toml", "amplifier = 20\n"), scene("gain.toml", "gain = 20\n");
  const auto exported = [&](const std::string& file, const std::string& format, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"export", file, "--format", format};
    words.insert(words.end(), more.begin(), more.end());
    return here.run(words);
  };
  const Outcome refused = exported("gain.toml", "siglent-csv", {"--amplifier", "20"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, testing::AllOf(HasSubstr("driver.main.gain = 20"), HasSubstr("key amplifier")));
  for (const std::string format : {"keysight-arb", "siglent-csv", "tektronix-csv", "rigol-csv", "digilent-csv"}) {
    SCOPED_TRACE(format);
    const Outcome by_key = exported("amplified.toml", format), by_option = exported("plain.toml", format, {"--amplifier", "20"});
    ASSERT_EQ(by_key.status, 0) << by_key.err;
    EXPECT_EQ(by_key.out, by_option.out);
    EXPECT_EQ(by_key.err, by_option.err);
    EXPECT_THAT(by_key.err, HasSubstr("those at the switch divided by 20\n"));
    const Outcome instead = exported("amplified.toml", format, {"--amplifier", "10"});
    EXPECT_EQ(instead.out, exported("plain.toml", format, {"--amplifier", "10"}).out);
    EXPECT_THAT(instead.err, testing::AllOf(HasSubstr("divided by 10, not "), HasSubstr(" the 20 of [driver.main]")));
  }
  const std::string siglent = exported("amplified.toml", "siglent-csv").out;
  EXPECT_NEAR(std::stod(siglent.substr(siglent.find("\n2,") + 3)), 18.0 / 20, 40.0 / 16384 / 20);
  for (const std::string format : {"csv", "spice-pwl", "codes"})
    EXPECT_EQ(exported("amplified.toml", format).out, exported("plain.toml", format).out);
  EXPECT_THAT(exported("amplified.toml", "csv").err,
              HasSubstr("voltages are those at the switch, 20 V for each volt of its source"));
  const auto figures = [&](const std::string& file) {
    const Outcome o = here.run({"simulate", file, "--quiet", "--json", "-"});
    EXPECT_EQ(o.status, 0) << o.err;
    return json::parse(o.out)["metrics"].dump();
  };
  EXPECT_EQ(figures("amplified.toml"), figures("plain.toml"));
  const Outcome checked = here.run({"check", "amplified.toml"});
  EXPECT_THAT(checked.out, HasSubstr("amplifier 20: the source gives at most 899.96"));
  EXPECT_THAT(checked.out, HasSubstr("Vdp 14.214"));
}

TEST(Export, WritesTheSwitchForACircuit) {
  const Workplace here;
  const Outcome model = here.run({"export", "gold.toml", "--format", "spice-model"});
  ASSERT_EQ(model.status, 0) << model.err;
  EXPECT_THAT(model.out, HasSubstr(".subckt softland_switch main g s d y vel force"));
  EXPECT_THAT(model.out, HasSubstr(".ends softland_switch"));
  const Outcome bench = here.run({"export", "gold.toml", "--format", "spice-bench"});
  EXPECT_THAT(bench.out, HasSubstr("\n.tran "));
  EXPECT_THAT(bench.out, HasSubstr("softland_main"));
  const Outcome module = here.run({"export", "gold.toml", "--format", "verilog-a"});
  EXPECT_THAT(module.out, HasSubstr("module softland_switch(main, g, s, d, y, vel, force);"));
  EXPECT_THAT(module.out, HasSubstr("endmodule"));
  const auto refused = [&](const char* scene) {
    const Outcome o = here.run({"export", std::string(SOFTLAND_SOURCE_DIR) + "/scenes/" + scene, "--format", "spice-model"});
    EXPECT_EQ(o.status, 2) << scene;
    return o.err;
  };
  EXPECT_THAT(refused("hung-senturia.toml"), HasSubstr("compressible gas film"));
  EXPECT_THAT(refused("nem-casimir.toml"), HasSubstr("Casimir force between gold"));
  write(here.path() / "several.toml",
        edited(shipped("new/two-contacts.toml"), "[electrode.main]", "[electrode.main]\nfringing = \"bao-2001\""));
  EXPECT_THAT(here.run({"export", "several.toml", "--format", "spice-model"}).err,
              HasSubstr("a model of this switch for circuits cannot be written: it has fringing by bao-2001 (its charge is an "
                        "integral) and several contacts\n"));
}

// A verb that takes a scene also takes the folder of a result, and its result.json.
TEST(Scenes, AreTakenFromResults_optimized) {
  const Workplace here;
  ASSERT_EQ(here.run({"simulate", "gold.toml", "--out", "run", "--quiet", "--set", "structure.modes=2", "--set",
                      "simulate.duration=60 us"})
                .status,
            0);
  for (const char* verb : {"simulate", "check", "pull-in", "modes"}) {
    const auto text = [&](const std::string& scene) {
      const Outcome o = here.run({verb, scene, "--quiet"});
      EXPECT_EQ(o.status, 0) << verb << " " << scene << o.err;
      return std::regex_replace(o.out, std::regex("run\\S*"), "run");
    };
    EXPECT_EQ(text("run"), text("run/result.json")) << verb;
  }
  for (const char* verb :
       {"simulate", "check", "pull-in", "modes", "effects", "accuracy", "limit", "release", "tune", "device"}) {
    std::string help = here.run({verb, "--help"}).out;
    std::ranges::replace(help, '\n', ' ');
    EXPECT_THAT(std::regex_replace(help, std::regex(" +"), " "),
                HasSubstr("result folder (the --out of an earlier run), or result.json"))
        << verb;
  }
  fs::create_directory(here.path() / "empty");
  const Outcome empty = here.run({"simulate", "empty"});
  EXPECT_EQ(empty.status, 2);
  EXPECT_THAT(
      empty.err,
      HasSubstr(
          "empty: is a folder without result.json, best.toml or release.toml; give a scene file, such as empty/NAME.toml, or the folder of --out"));
}

// A pin is renamed if its name has another meaning in the model, in SPICE or in Verilog-A, and a message says so.
TEST(Export, RenamesPinsWithTheNameOfSomethingElse) {
  const Workplace here;
  const std::string gold = shipped("mem-gold.toml");
  const auto exported = [&](const std::string& drive, const char* format) {
    std::string scene = gold;
    for (const char* section : {"electrode", "waveform", "driver"})
      scene = edited(scene, std::string("[") + section + ".main]", std::string("[") + section + "." + drive + "]");
    write(here.path() / "named.toml", scene);
    const Outcome o = here.run({"export", "named.toml", "--format", format});
    EXPECT_EQ(o.status, 0) << o.err;
    return std::pair(o.out, o.err);
  };
  for (const char* format : {"spice-model", "spice-bench", "verilog-a"}) {
    const std::string usual = exported("main", format).first;
    for (const std::string drive : {"g", "S", "d", "y", "vel", "force", "at", "rate", "push", "y0", "u3", "w12", "gnd", "time",
                                    "end", "0-g", "9", "Module"}) {
      const auto [text, said] = exported(drive, format);
      std::string pin = "drive_";
      for (const char c : drive)
        pin += std::isalnum(static_cast<unsigned char>(c)) != 0 ? static_cast<char>(std::tolower(c)) : '_';
      EXPECT_THAT(said, HasSubstr("drive " + drive + " is the pin " + pin)) << format;
      std::string again = text.substr(text.find('\n', text.find("is the pin")) + 1);
      for (const auto& [name, by] : {std::pair("drive_" + pin, "drive_main"), std::pair(pin, "main")}) {
        for (std::size_t at = 0; (at = again.find(name, at)) != std::string::npos;) again.replace(at, name.size(), by);
      }
      EXPECT_TRUE(usual.ends_with(again)) << format << " " << drive;
    }
  }
  std::string scene = shipped("two-electrodes.toml");
  for (const char* section : {"electrode", "waveform", "driver"}) {
    scene = edited(scene, std::string("[") + section + ".main]", std::string("[") + section + ".a-b]");
    scene = edited(scene, std::string("[") + section + ".upper]", std::string("[") + section + ".a_b]");
  }
  write(here.path() / "alike.toml", scene);
  const Outcome alike = here.run({"export", "alike.toml", "--format", "spice-bench"});
  EXPECT_EQ(alike.status, 0) << alike.err;
  EXPECT_THAT(alike.out, HasSubstr(".subckt softland_switch a_b a_b_2 g s d"));
  EXPECT_THAT(alike.out, HasSubstr("Xdrive_a_b_2 a_b_2 0 softland_a_b_2"));
  EXPECT_THAT(alike.err, HasSubstr("drive a_b is the pin a_b_2"));
}

// The simulator is ngspice, if installed, with trapezoidal steps.
TEST(Export, OfTheSwitchForACircuitClosesAsItDoes_slow) {
  if (std::system("command -v ngspice >/dev/null 2>&1") != 0) GTEST_SKIP() << "skipped: no circuit simulator; needs: ngspice";
  const Workplace here;
  const std::string scene = std::string(SOFTLAND_SOURCE_DIR) + "/scenes/gap-closing-actuator.toml";
  write(here.path() / "bench.cir", here.run({"export", scene, "--format", "spice-bench"}).out);
  ASSERT_EQ(std::system(("cd '" + here.path().string() + "' && ngspice -b bench.cir > ngspice.txt 2>&1").c_str()), 0);
  const std::string said = read(here.path() / "ngspice.txt");
  const auto measured = [&](const std::string& name) {
    const std::size_t at = said.find("\n" + name);
    return at == std::string::npos ? 0.0 : std::stod(said.substr(said.find('=', at) + 1));
  };
  const json metrics = json::parse(here.run({"simulate", scene, "--quiet", "--json", "-"}).out)["metrics"];
  const double time = metrics["initial_contact_time_s"], speed = metrics["impact_velocity_m_s"];
  EXPECT_NEAR(measured("t_i"), time, 1e-5 * time);
  EXPECT_NEAR(measured("v_i"), speed, 1e-3 * speed);
}

TEST(Export, OfTheContactIsARecordThatIsReadBack_optimized) {
  const Workplace here;
  const std::string scene = std::string(SOFTLAND_SOURCE_DIR) + "/scenes/ohmic-gold.toml";
  const auto run = [&](const std::vector<std::string>& options) {
    std::vector<std::string> words{"export", scene};
    words.insert(words.end(), options.begin(), options.end());
    return here.run(words);
  };
  for (const std::string format : {"csv", "vcd", "pwl"}) {
    const Outcome one = run({"--contact-record", format});
    EXPECT_EQ(one.status, 0) << one.err;
    EXPECT_EQ(one.err, "");
    write(here.path() / ("contact." + format), one.out);
    const std::string column = format == "pwl" ? "softland_closed.Vdrive" : "closed";
    const Outcome back = here.run({"read", "contact." + format, "--set", "column=" + column, "--json", "-"});
    ASSERT_EQ(back.status, 0) << back.err;
    const json channel = json::parse(back.out)["channels"][0];
    EXPECT_EQ(channel["first"], 0);
    EXPECT_EQ(channel["last"], 1);
  }
  const auto of_three = [&](const std::string& seed) {
    return run({"--contact-record", "vcd", "--devices", "3", "--seed", seed}).out;
  };
  const Outcome devices = run({"--contact-record", "vcd", "--devices", "3"});
  EXPECT_EQ(devices.out, of_three("1"));
  EXPECT_NE(devices.out, of_three("2"));
  EXPECT_THAT(devices.out, HasSubstr("$scope module device_2 $end"));
  for (const auto& [words, said] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"--contact-record", "wav"}, "--contact-record wav: must be csv, vcd or pwl"},
           {{"--devices", "3"}, "--devices, --seed: must be given together with --contact-record"},
           {{"--contact-record", "csv", "--seed", "3"}, "--seed: chooses devices: give --devices as well"},
           {{"--contact-record", "csv", "--bits", "3"},
            "--contact-record csv: exports states of the contact: omit the options for waveforms"},
           {{"--contact-record", "csv", "--devices", "0"}, "--devices 0: must be"}}) {
    const Outcome refused = run(words);
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(refused.err, HasSubstr(said));
  }
}

TEST(Export, TakesWhatWasMeasuredAndSaysWhatIsStrange_optimized) {
  const Workplace here;
  const auto run = [&](const std::string& measured) { return here.run({"export", "gold.toml", "--measured", measured}); };
  const Outcome usual = run("Vdp=14.6 V,frequency=10.2 kHz");
  ASSERT_EQ(usual.status, 0) << usual.err;
  EXPECT_EQ(usual.out, here.run({"export", "gold.toml", "--device-vdp", "14.6 V", "--device-frequency", "10.2 kHz"}).out);
  EXPECT_THAT(usual.err,
              HasSubstr("--measured Vdp = 14.6 V: its error is taken to be 1 %, because [calibration] gives none for Vdp"));
  EXPECT_THAT(usual.err, Not(HasSubstr("warning")));
  const Outcome strange = run("Vdp=7 V");
  EXPECT_EQ(strange.status, 0);
  EXPECT_THAT(strange.err, HasSubstr("warning: --measured Vdp = 7 V: "));
  EXPECT_THAT(strange.err, HasSubstr("times the standard deviation of devices and measurement"));
  EXPECT_THAT(run("frequency=30 kHz").err, HasSubstr("warning: --measured frequency = 30 kHz: "));
  EXPECT_THAT(here.run({"export", "gold.toml", "--device-vdp", "7 V"}).err, HasSubstr("warning: --device-vdp 7 V: "));
  for (const auto& [measured, said] : std::vector<std::pair<std::string, std::string>>{
           {"Vdp=20 V", "--measured Vdp = 20 V: the waveform of this device: drive 'main': the voltage reaches 25 V, above"},
           {"Vdp=3 A", "--measured Vdp = 3 A: must be a voltage [V] above 0"},
           {"Vdp=14 V,Vdp=14 V", "Vdp is given twice"},
           {"mass=3 kg", "unknown measurement 'mass=3 kg'; choose from Vdp, frequency, piezo and time"},
           {"piezo=1.6 %/V", "piezo cannot be measured: there is no [piezo]"},
           {"piezo=31 nm/V", "--measured piezo = 31 nm/V: must be an inverse voltage [1/V] above 0, such as \"1.6 %/V\""},
           {"Vdp", "unknown measurement 'Vdp'"}}) {
    const Outcome bad = run(measured);
    EXPECT_EQ(bad.status, 2) << measured;
    EXPECT_THAT(bad.err, HasSubstr(said));
  }
}

// With half the deflection per volt the piezo needs twice the voltage; the electrode does not.
TEST(Export, GivesAPiezoVoltsByWhatOneDeflects_optimized) {
  const Workplace here;
  write(here.path() / "pzt.toml",
        edited(shipped("mem-gold-pzt.toml"), "[driver.main]",
               "[waveform.piezo]\nfamily = \"pulse\"\nlevels = [\"0.3 V\", \"0 V\"]\ntimes = [\"9 us\"]\n\n[driver.main]"));
  const json ranked =
      json::parse(here.run({"calibrate", "pzt.toml", "--samples", "16", "--steps", "1.25", "--quiet", "--json", "-"}).out);
  const json& figure = ranked["figures"].back();
  ASSERT_EQ(figure["name"], "piezo");
  const std::string half = fmt::format("piezo={} %/V", 50 * figure["nominal"].get<double>());
  const Outcome own = here.run({"export", "pzt.toml", "--measured", half}), nominal = here.run({"export", "pzt.toml"});
  ASSERT_EQ(own.status, 0) << own.err;
  EXPECT_THAT(own.err, HasSubstr("warning: --measured piezo = "));
  const auto voltages = [](const std::string& csv) {  // returns the voltages of the electrode and of the piezo
    std::vector<std::array<double, 2>> rows;
    std::istringstream in(csv.substr(csv.find('\n') + 1));
    double time = 0;
    std::array<double, 2> row{};
    for (char comma = 0; in >> time >> comma >> row[0] >> comma >> row[1];) rows.push_back(row);
    return rows;
  };
  const auto before = voltages(nominal.out), after = voltages(own.out);
  ASSERT_GT(before.size(), 2U);
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(after[i][0], before[i][0]);
    EXPECT_NEAR(after[i][1], 2 * before[i][1], 1e-12);
  }
  EXPECT_EQ(before[1][1], 0.3) << "after the step from 0 V";
}

// The scene of an amplifier whose gain is set 2 % too high.
TEST(Sources, HaveAGainThatCanBeSetAndVaried_optimized) {
  const Workplace here;
  const auto contact = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"simulate", "gold.toml", "--quiet", "--json", "-", "--set", "simulate.accuracy=1e-4"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome o = here.run(words);
    EXPECT_EQ(o.status, 0) << o.err;
    return json::parse(o.out)["metrics"]["initial_contact_time_s"].get<double>();
  };
  const double usual = contact({}), higher = contact({"--set", "driver.main.gain=1.02"}),
               by_level = contact({"--set", "waveform.main.level=1.275 Vdp"});
  EXPECT_LT(higher, usual);
  EXPECT_NEAR(higher, by_level, 1e-9 * usual);
  EXPECT_NEAR(contact({"--set", "driver.main.delay=1 us"}), usual + 1e-6, 1e-9 * usual);
  EXPECT_LT(contact({"--set", "driver.main.offset=0.2 V"}), usual);
  const Outcome explored = here.run({"explore", "gold.toml", "--quiet", "--vary", "driver.main.gain=0.98:1.02:3", "--set",
                                     "simulate.accuracy=1e-4", "--out", "gains.sqlite"});
  ASSERT_EQ(explored.status, 0) << explored.err;
  const Outcome table = here.run({"table", "gains.sqlite"});
  EXPECT_EQ(std::count(table.out.begin(), table.out.end(), '\n'), 4) << table.out;
  EXPECT_THAT(table.out, HasSubstr("steady_force_time_s"));
  // By default the commanded waveform is exported, whatever the source makes of it.
  const Outcome asked = here.run({"export", "gold.toml"});
  write(here.path() / "gain.toml", edited(shipped("mem-gold.toml"), "[driver.main]", "[driver.main]\ngain = 1.02"));
  EXPECT_EQ(here.run({"export", "gain.toml"}).out, asked.out);
  EXPECT_NE(here.run({"export", "gain.toml", "--signal", "output"}).out, asked.out);
}

}  // namespace
}  // namespace softland
