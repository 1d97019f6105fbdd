// Tests that a reported success is one: exit statuses and first lines for closings that do not last, are refused, or gain
// nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "program.h"
#include "tests/support/nickel_bridge.h"
#include "version.h"

namespace softland {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// A nickel bridge with its contact at the centre. From 66.1 V on it collapses onto the electrode, which is long to both sides.
const std::string bridge = [] {
  std::string text(test::nickel_bridge);
  for (const auto& [from, to] : {std::pair("modes = 5", "modes = 4"),
                                 {"contact = \"1.5 um\"", "contact = \"1.8 um\""},
                                 {"\"1.25 Vdp\"", "\"67 V\""},
                                 {"\"1.5 Vdp\"", "\"80 V\""}})
    text = edited(std::move(text), from, to);
  return text;
}();

// A plate between two electrodes with the same voltage.
const std::string between_two = R"(
[structure]
kind = "plate"
mass = "2.7e-11 kg"
stiffness = "1.92 N/m"
area = "10000 um^2"
[gap]
electrode = "3 um"
contact = "2.9 um"
[electrode.main]
fringing = "none"
side = "both"
gap = "3 um"
[contact]
model = "linear"
stiffness = "1e5 N/m"
[waveform.main]
family = "step"
level = "17.5 V"
[driver.main]
max_voltage = "30 V"
[simulate]
duration = "1 ms"
)";

json parsed(const Outcome& o) { return json::parse(o.out, nullptr, false); }

TEST(Success, IsNotAClosedStateThatIsPulledThrough_optimized) {
  const Workplace here;
  write(here.path() / "bridge.toml", bridge);
  const auto at = [&](const char* level) {
    return here.run({"simulate", "bridge.toml", "--quiet", "--json", "-", "--set", level});
  };
  const Outcome leaves = at("waveform.main.level=67 V"), stays = at("waveform.main.level=62 V");
  EXPECT_EQ(parsed(leaves)["status"], "not_settled");
  EXPECT_EQ(parsed(leaves)["closed_state"]["stable"], false);
  EXPECT_EQ(leaves.status, 4);
  EXPECT_EQ(parsed(stays)["closed_state"]["stable"], true);
  EXPECT_EQ(stays.status, 0) << stays.err;
  // A switch that is released on purpose has an open equilibrium to return to.
  const Outcome opens =
      here.run({"simulate", "bridge.toml", "--quiet", "--json", "-", "--set", "simulate.duration=60 us", "--set",
                R"(waveform.main={family="pulse",levels=["63 V","0 V"],times=["30 us"],edge="1 us"})"});
  EXPECT_EQ(parsed(opens)["status"], "not_settled") << opens.out;
  EXPECT_EQ(opens.status, 0) << opens.err;
}

TEST(Success, IsNotAVerdictThatMoreModesReverse_optimized) {
  const Workplace here;
  write(here.path() / "bridge.toml", bridge);
  const std::vector<std::string> at_64{"bridge.toml", "--quiet", "--set", "waveform.main.level=64 V"};
  const auto run = [&](const char* verb, std::vector<std::string> words, bool as_json) {
    words.insert(words.begin(), verb);
    if (as_json) words.insert(words.end(), {"--json", "-"});
    return here.run(words);
  };
  const Outcome flips = run("simulate", at_64, true);
  const json state = parsed(flips)["closed_state"];
  EXPECT_EQ(flips.status, 4) << flips.out;
  EXPECT_EQ(parsed(flips)["status"], "not_settled");
  EXPECT_EQ(parsed(flips)["metrics"]["settled"], false);
  EXPECT_EQ(state["stable"], false);
  EXPECT_EQ(state["by_modes"].size(), 3U) << state;
  EXPECT_GT(state["by_modes"]["4"], 0);
  EXPECT_EQ(state["by_modes"]["4"], state["smallest_eigenvalue_rad2_s2"]);
  EXPECT_LT(state["by_modes"]["8"], 0);
  EXPECT_LT(state["by_modes"]["16"], state["by_modes"]["8"]);
  EXPECT_NEAR(state["pulled_through_by_modes_V"]["main"]["converged"].get<double>(), 62.58, 0.05);
  const Outcome words = run("simulate", at_64, false);
  EXPECT_THAT(words.out.substr(0, 400), HasSubstr("Whether it stays closed depends on the number of modes"));
  EXPECT_THAT(words.out, Not(HasSubstr("ettled                                 yes")));
  EXPECT_EQ(run("robustness",
                {"bridge.toml", "--quiet", "--samples", "8", "--set", "waveform.main.level=64 V", "--set",
                 "spread.\"structure.thickness\"={distribution=\"normal\",cov=\"0.1 %\"}"},
                true)
                .status,
            4);
  // pull-in prints the shift of its voltages by more modes, and the limit of a shift above 1 %.
  const Outcome voltages = run("pull-in", {"bridge.toml", "--quiet"}, true);
  EXPECT_EQ(voltages.status, 0);
  EXPECT_NEAR(parsed(voltages)["pull_in"]["by_modes"]["pulled_through_V"]["4"].get<double>(), 66.09, 0.01);
  EXPECT_NEAR(parsed(voltages)["pull_in"]["by_modes"]["static_V"]["converged"].get<double>(),
              parsed(voltages)["pull_in"]["static_V"].get<double>(), 0.02);
  EXPECT_THAT(run("pull-in", {"bridge.toml", "--quiet"}, false).out,
              AllOf(HasSubstr("(fold of the static branch); more modes change it by −0.0085 %\n"),
                    HasSubstr("collapses onto the electrode; more modes change it by −5.3 %, to 62.58 V")));
  // A plate has no more modes.
  write(here.path() / "plate.toml", edited(between_two, "side = \"both\"\ngap = \"3 um\"\n", ""));
  const Outcome plate =
      run("simulate", {"plate.toml", "--quiet", "--set", "waveform.main.level=16 V", "--set", "gap.contact=2 um"}, true);
  EXPECT_EQ(plate.status, 0) << plate.out << plate.err;
  EXPECT_TRUE(parsed(plate)["closed_state"]["by_modes"].is_null());
  EXPECT_TRUE(parsed(plate)["closed_state"]["pulled_through_by_modes_V"].is_null());
}

TEST(Success, OfALimitSaysFirstThatTheHoldLevelsPullTheSwitchThrough_slow) {
  const Workplace here;
  write(here.path() / "bridge.toml", bridge);
  const std::vector<std::string> words{"limit", "bridge.toml", "--no-curves", "--quiet", "--impact-velocity", "5 mm/s"};
  std::vector<std::string> as_json = words;
  as_json.insert(as_json.end(), {"--json", "-"});
  const std::string text = here.run(words).out;
  EXPECT_THAT(text.substr(0, 300), HasSubstr("\n\nwarning: the hold levels do not keep the switch closed")) << text;
  const json j = parsed(here.run(as_json));
  EXPECT_EQ(j["closed_state"]["stable"], false);
  EXPECT_THAT(j["warnings"].dump(), HasSubstr("closed equilibrium is unstable"));
  as_json.insert(as_json.end(), {"--set", "waveform.main.level=60 V"});
  const json stable = parsed(here.run(as_json));
  EXPECT_EQ(stable["closed_state"]["stable"], true);
  EXPECT_THAT(stable["warnings"].dump(), Not(HasSubstr("closed")));
}

TEST(Success, OfALimitIsRefusedWhereTheElectrodePullsAway) {
  const Workplace here;
  write(here.path() / "away.toml", edited(between_two, "electrode = \"3 um\"", "electrode = \"30 um\""));
  const Outcome o = here.run({"limit", "away.toml", "--quiet", "--impact-velocity", "1 mm/s"});
  EXPECT_EQ(o.status, 2);
  EXPECT_EQ(o.err,
            "softland: away.toml:13: electrode.main.gap = \"3 um\": it pulls away from the contact; its other side is nearer\n");
}

TEST(NoStableRest, IsNotCalledOverdamped_optimized) {
  const Workplace here;
  write(here.path() / "two.toml", between_two);
  for (const char* verb : {"check", "pull-in"}) {
    const Outcome o = here.run({verb, "two.toml", "--quiet"});
    EXPECT_THAT(o.out, AllOf(HasSubstr("from there on its rest position is unstable"), Not(HasSubstr("overdamped"))));
    // In a very viscous film the step does not overshoot.
    const Outcome thick = here.run({verb, "gold.toml", "--quiet", "--set", "gas.viscosity=1 Pa s"});
    EXPECT_THAT(thick.out, HasSubstr("overdamped: equals the static one")) << thick.err;
  }
}

// Numbers that are not finite, at every place of a scene or its files, in every verb that takes a scene.
TEST(NotFinite, IsRefusedByEveryVerbWithItsKey) {
  const Workplace here;
  const std::string gold = shipped("mem-gold.toml");
  struct Written {
    std::string text, place;
  };
  std::vector<Written> all{
      {edited(gold, "\"250 um\"", "\"nan um\""), "structure.length"},
      {edited(gold, "\"250 um\"", "\"1e400 um\""), "structure.length"},
      {edited(gold, "modes = 4", "modes = nan"), "structure.modes"},
      {edited(gold, "level = \"1.25 Vdp\"", "level = \"inf Vdp\""), "waveform.main.level"},
      {edited(gold, "max_voltage = \"1.5 Vdp\"", "max_voltage = \"-inf V\""), "driver.main.max_voltage"},
      {edited(gold, "family = \"step\"\nlevel = \"1.25 Vdp\"", "family = \"table\"\nfile = \"nan.csv\""), "waveform.main.file"}};
  write(here.path() / "nan.csv", "time_s,main\n0,0\n1e-6,nan\n");
  for (const char* number : {"nan", "inf", "-inf"}) {
    all.push_back({edited(gold, "\"1 nm\"", std::string("\"") + number + " nm\""), "metrics.significant_rebound"});
    all.push_back({edited(gold, "accuracy = 1e-6", std::string("accuracy = ") + number), "simulate.accuracy"});
  }
  for (const auto& [text, place] : all) {
    write(here.path() / "odd.toml", text);
    for (const char* verb : {"simulate", "check", "pull-in", "modes", "effects", "accuracy", "optimize", "limit", "release",
                             "robustness", "calibrate", "export"}) {
      const Outcome o = here.run({verb, "odd.toml"});
      EXPECT_EQ(o.status, 2) << verb << " " << place << ": " << o.out;
      EXPECT_THAT(o.err, AllOf(StartsWith("softland: odd.toml:"), HasSubstr(place))) << verb;
      EXPECT_EQ(o.out, "") << verb;
    }
    const Outcome explored = here.run({"explore", "odd.toml", "--vary", "structure.width=10 um:20 um:2", "--out", "o.sqlite"});
    EXPECT_EQ(explored.status, 2) << place;
    EXPECT_THAT(explored.err, HasSubstr(place));
  }
  for (const char* speed : {"nan m/s", "inf m/s", "1e400 m/s"})
    EXPECT_EQ(here.run({"limit", "gold.toml", "--impact-velocity", speed}).status, 2) << speed;
}

// If too many devices cannot be built, a search cannot compare waveforms.
TEST(Success, OfARobustSearchIsNotThatOfDevicesThatAllFail_optimized) {
  const Workplace here;
  const std::string text = shipped("mem-gold.toml");
  write(here.path() / "half.toml",
        text.substr(0, text.find("[spread]")) +
            "[spread]\n\"electrode.main.span[2]\" = { distribution = \"normal\", standard_deviation = \"100 um\" }\n");
  const Outcome o = here.run({"optimize",
                              "half.toml",
                              "--quiet",
                              "--robust",
                              "cvar:0.9",
                              "--samples",
                              "16",
                              "--budget",
                              "200",
                              "--out",
                              "out",
                              "--jobs",
                              "1",
                              "--set",
                              "structure.modes=2",
                              "--set",
                              "simulate.accuracy=1e-3",
                              "--set",
                              "waveform.main.level=19 V",
                              "--set",
                              "driver.main.max_voltage=25 V"});
  EXPECT_EQ(o.status, 4) << o.err;
  std::string first_lines = o.out.substr(0, o.out.find("\n\n"));
  std::ranges::replace(first_lines, '\n', ' ');
  EXPECT_THAT(first_lines, AllOf(HasSubstr("outside the model"), HasSubstr("the search has gained nothing")))
      << o.out.substr(0, 800);
  const json found = json::parse(read(here.path() / "out/result.json"), nullptr, false);
  EXPECT_EQ(found["goal_met"], false);
  EXPECT_EQ(found["robust"]["measure_tells"], false);
  EXPECT_GT(found["robust"]["failing_share"], 0.3);
}

TEST(Start, OfAnotherRestIsRefused_optimized) {
  const Workplace here;
  const std::string gold = edited(edited(shipped("mem-gold.toml"), "1.25 Vdp", "19 V"), "1.5 Vdp", "25 V");
  write(here.path() / "here.toml", gold);
  write(here.path() / "there.toml", edited(gold, "level = \"19 V\"", "level = \"19 V\"\nbefore = \"3 V\""));
  const std::string reason = "the drive 'main' stands at 3 V before its waveform, and at 0 V in the scene";
  for (const char* verb : {"optimize", "limit"}) {
    const Outcome o = here.run({verb, "here.toml", "--quiet", "--start", "there.toml", "--out", "out"});
    EXPECT_EQ(o.status, 2) << verb << o.out;
    EXPECT_THAT(o.err, HasSubstr(reason)) << verb;
  }
}

TEST(SetElement, OfAListIsThatOfTheWholeList_optimized) {
  const Workplace here;
  const auto modes = [&](const std::string& assignment) {
    return here.run({"pull-in", "gold.toml", "--quiet", "--json", "-", "--set", assignment});
  };
  const Outcome whole = modes(R"(electrode.main.span=["60 um", "200 um"])"), element = modes("electrode.main.span[2]=200 um");
  EXPECT_EQ(element.status, 0) << element.err;
  const auto voltages = [](const Outcome& o) { return nlohmann::json::parse(o.out)["pull_in"]; };
  EXPECT_EQ(voltages(element), voltages(whole));
  EXPECT_EQ(voltages(modes("electrode.main.span[2]=tip")), voltages(modes(R"(electrode.main.span=["60 um", "tip"])")));
  EXPECT_EQ(modes("electrode.main.span[3]=tip").err,
            "softland: --set electrode.main.span[3]=tip: electrode.main.span is a list of 2, counted from 1\n");
  EXPECT_EQ(modes("piezo.span[1]=5 um").err,
            "softland: --set piezo.span[1]=5 um: piezo.span must be a list in this scene: give the whole list, such as --set "
            "'piezo.span=[\"10 um\", \"tip\"]'\n");
  EXPECT_EQ(modes("electrode.main.span[2]=2 V").err.substr(0, 47), "softland: --set electrode.main.span[2]=2 V: val");
}

// Files do not grow with the length of a run: a beam in vacuum bounces and vibrates for a thousand periods.
TEST(LongRuns, LeaveFilesThatCanBeReadAgain_optimized) {
  const Workplace here;
  const std::string gold = shipped("mem-gold.toml");
  write(here.path() / "long.toml", edited(edited(gold, "1.25 Vdp", "19 V"), "1.5 Vdp", "25 V"));
  const auto run = [&](const std::string& duration) {
    const Outcome o = here.run({"simulate", "long.toml", "--quiet", "--out", "out", "--set", "gas.viscosity=1e-9 Pa s", "--set",
                                "simulate.tolerance=1e-4", "--set", "simulate.duration=" + duration});
    EXPECT_EQ(o.status, 0) << o.err;
    const std::string csv = read(here.path() / "out/trajectory.csv");
    return std::pair(std::count(csv.begin(), csv.end(), '\n'), fs::file_size(here.path() / "out/result.json"));
  };
  const auto [rows, bytes] = run("20 ms");
  EXPECT_GT(rows, 10'000);
  EXPECT_LE(rows, 20'001);
  EXPECT_LT(bytes, std::uintmax_t{8} << 20U);
  EXPECT_EQ(here.run({"report", "out"}).status, 0);
  // The figures use all knots of the run.
  const json metrics = json::parse(read(here.path() / "out/result.json"), nullptr, false)["metrics"];
  const std::string csv = read(here.path() / "out/trajectory.csv");
  double highest = 0;
  bool touched = false;
  std::istringstream lines(csv.substr(csv.find('\n') + 1));
  for (std::string line; std::getline(lines, line);) {
    const double gap = std::strtod(line.c_str() + line.find(',') + 1, nullptr);
    touched = touched || gap <= 0;
    if (touched) highest = std::max(highest, gap);
  }
  EXPECT_NEAR(highest, metrics["major_bounce_height_m"].get<double>(), 1e-3 * highest) << "extremes stay";
}

TEST(LongRuns, HoldWaveformsOfManyPointsInABoundedResult_optimized) {
  const Workplace here;
  const std::string gold = edited(shipped("mem-gold.toml"), "1.5 Vdp", "30 V");
  std::string rows = "time_s,main\n";
  for (int k = 0; k <= 40'000; ++k)
    rows += std::to_string(6e-3 * k) + "e-6," + (k == 30'001 ? "19" : k % 2 == 0 ? "16" : "16.5") + "\n";
  write(here.path() / "many.csv", rows);
  write(here.path() / "table.toml",
        edited(gold, "family = \"step\"\nlevel = \"1.25 Vdp\"", "family = \"table\"\nfile = \"many.csv\""));
  write(here.path() / "sine.toml", edited(gold, "family = \"step\"\nlevel = \"1.25 Vdp\"",
                                          "family = \"harmonic\"\nbase = \"17 V\"\namplitude = \"2 V\"\nfrequency = \"20 MHz\""));
  for (const char* name : {"table", "sine"}) {
    const std::string scene = std::string(name) + ".toml";
    const Outcome o = here.run(
        {"simulate", scene, "--quiet", "--out", name, "--set", "simulate.tolerance=1e-3", "--set", "simulate.duration=240 us"});
    EXPECT_EQ(o.status, 0) << o.err;
    const std::string text = read(here.path() / name / "result.json");
    EXPECT_LT(text.size(), std::size_t{8} << 20U) << name;
    const json found = json::parse(text, nullptr, false)["best"]["waveforms"]["main"];
    EXPECT_LE(found.size(), 20'000U) << name;
    double highest = 0;
    for (const json& point : found) highest = std::max(highest, point[1].get<double>());
    EXPECT_NEAR(highest, 19, 0.01) << name << ": extremes stay";
    EXPECT_EQ(here.run({"report", name}).status, 0) << name;
  }
}

TEST(Check, AcceptsExactlyWhatSimulateRuns_optimized) {
  const Workplace here;
  write(here.path() / "bridge.toml", bridge);
  write(here.path() / "between.toml", between_two);
  for (const char* name : {"two-electrodes.toml", "gap-closing-actuator.toml", "nem-tin.toml", "hung-senturia.toml"})
    write(here.path() / name, shipped(name));
  struct Case {
    std::string scene;
    std::vector<std::string> changes;
  };
  const std::vector<Case> cases{
      {"gold.toml", {}},
      {"gold.toml", {"waveform.main.level=1.6 Vdp"}},
      {"gold.toml", {"waveform.main.level=1.6 Vdp", "driver.main.max_voltage=1.7 Vdp"}},
      {"gold.toml", {"waveform.main.level=40 V"}},
      {"gold.toml", {"waveform.main.level=-10 V"}},
      {"gold.toml", {"driver.main.max_slew=1 V/us"}},
      {"gold.toml", {"driver.main.max_slew=1 V/us", "waveform.main.rise_time=30 us"}},
      {"gold.toml", {"driver.main.max_slew=1 V/us", "waveform.main.rise_time=driver"}},
      {"gold.toml", {"driver.main.min_voltage=1 V"}},
      {"gold.toml", {"driver.main.sample_rate=1 GHz"}},
      {"gold.toml", {"driver.main.bits=10"}},
      {"gold.toml", {"driver.main.source_resistance=1 Mohm", "driver.main.parallel_capacitance=1 pF"}},
      {"gold.toml", {"driver.main.parallel_capacitance=1 pF"}},
      {"gold.toml", {"gap.contact=4 um"}},
      {"gold.toml", {"electrode.main.span=[\"60 um\", \"300 um\"]"}},
      {"gold.toml", {"contact.model=rigid"}},
      {"gold.toml", {"contact.asperity_height=1e-300 m"}},
      {"gold.toml", {"structure.modes=21"}},
      {"gold.toml", {"gas.model=veijola"}},
      {"gold.toml", {"waveform.main={family=\"harmonic\", base=\"10 V\", amplitude=\"1 V\", frequency=\"100 GHz\"}"}},
      {"gold.toml", {"waveform.main={family=\"pulse\", levels=[\"17 V\", \"3 V\"], times=[\"20 us\"], edge=\"25 us\"}"}},
      {"pzt.toml", {}},
      {"pzt.toml", {"waveform.piezo={family=\"step\", level=\"2 V\"}"}},
      {"pzt.toml", {"piezo.d31=0 pm/V"}},
      {"bridge.toml", {"structure.residual_stress=-1 GPa"}},
      {"bridge.toml", {"waveform.main.level=67 V"}},
      {"between.toml", {}},
      {"between.toml", {"electrode.main.gap=1 um", "waveform.main.level=1 Vsp"}},
      {"two-electrodes.toml", {}},
      {"two-electrodes.toml", {"waveform.upper.levels=[\"0 V\", \"250 V\", \"0 V\"]"}},
      {"two-electrodes.toml", {"waveform.upper={family=\"step\", level=\"1 Vdp\"}"}},
      {"gap-closing-actuator.toml", {}},
      {"nem-tin.toml", {}},
      {"nem-tin.toml", {"gap.electrode=10 nm", "gap.contact=8 nm"}},
      {"hung-senturia.toml", {"gas.model=veijola"}},
  };
  int refused = 0;
  for (const auto& [scene, changes] : cases) {
    const auto run = [&](const char* verb) {
      std::vector<std::string> words{verb, scene, "--quiet", "--set", "simulate.tolerance=1e-3"};
      for (const std::string& change : changes) words.insert(words.end(), {"--set", change});
      return here.run(words);
    };
    const Outcome checked = run("check"), simulated = run("simulate");
    EXPECT_EQ(checked.status == 2, simulated.status == 2) << scene << " " << testing::PrintToString(changes) << "\n"
                                                          << checked.err << simulated.err;
    EXPECT_THAT(checked.status, testing::AnyOf(0, 2)) << scene << " " << testing::PrintToString(changes) << checked.err;
    if (checked.status == 2 && simulated.status == 2) {
      EXPECT_EQ(checked.err, simulated.err) << "for one reason";
    }
    refused += checked.status == 2 ? 1 : 0;
  }
  EXPECT_GT(refused, 9);
  EXPECT_LT(refused, 22);
}

// A relay that is closed at 90 V, above its pull-in voltage, and switched off (circuitjs1, PR 289).
const std::string relay = R"(structure = { kind = "plate", mass = "1 ug", stiffness = "100 N/m", area = "0.04 mm^2" }
gap = { electrode = "4 um", contact = "3 um" }
electrode.main.fringing = "none"
gas = { model = "linear", quality_factor = 0.7 }
contact = { model = "linear", stiffness = "100 kN/m" }
waveform.main = { family = "step", before = "90 V", level = "0 V" }
)";

TEST(ClosedStart, IsNamedWhereTheOpenOneDoesNotExistAndTakenWhereItIsAskedFor) {
  const Workplace here;
  write(here.path() / "relay.toml", relay);
  const std::string named = "waveform.main.before_state = \"closed\" begins there";
  const Outcome without = here.run({"simulate", "relay.toml"});
  EXPECT_EQ(without.status, 4);
  EXPECT_THAT(without.out, HasSubstr("no stable equilibrium to start from"));
  EXPECT_THAT(without.err, AllOf(HasSubstr("3.011673"), HasSubstr(named), HasSubstr("collapsed_at_rest")));
  const json other = json::parse(here.run({"simulate", "relay.toml", "--json", "-"}).out);
  EXPECT_EQ(other["status"], "collapsed_at_rest");
  EXPECT_THAT(other["warnings"].dump(), HasSubstr("3.011673"));
  EXPECT_THAT(here.run({"check", "relay.toml"}).out, AllOf(HasSubstr("start                none"), HasSubstr("3.0117")));

  const std::vector<std::string> closed{"--set", "waveform.main.before_state=closed"};
  const auto with = [&](std::vector<std::string> words) {
    words.insert(words.end(), closed.begin(), closed.end());
    return here.run(words);
  };
  const Outcome text = with({"simulate", "relay.toml", "--out", "run"});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("The switch begins closed, opens and is at rest from"));
  const json j = json::parse(read(here.path() / "run/result.json"));
  EXPECT_EQ(j["status"], "done");
  for (const char* none : {"initial_contact_time_s", "impact_velocity_m_s", "bounce_time_s", "peak_contact_force_N"})
    EXPECT_TRUE(j["metrics"][none].is_null()) << none;
  EXPECT_THAT(here.run({"report", "run"}).out, HasSubstr("begins closed, opens and is at rest from"));
  // The trajectory begins on the contact, and ends open.
  std::istringstream rows(read(here.path() / "run/trajectory.csv"));
  std::string line, first, last;
  std::getline(rows, line);
  std::getline(rows, first);
  while (std::getline(rows, line)) last = line;
  EXPECT_THAT(first, HasSubstr("-1.167")) << "the gap to the plane [m], 11.67 nm closed";
  EXPECT_THAT(last, HasSubstr(",2.99999")) << "open, to less than a thousandth of the travel";

  EXPECT_THAT(with({"check", "relay.toml"}).out, HasSubstr("start                closed, its contact point at 3.0117"));
  write(here.path() / "closed.toml", edited(relay, "before = ", "before_state = \"closed\", before = "));
  EXPECT_EQ(here.run({"export", "closed.toml"}).status, 0);
  const Outcome explored = with({"explore", "relay.toml", "--vary", "gas.quality_factor=0.6,0.7", "--out", "x.sqlite"});
  EXPECT_EQ(explored.status, 0) << explored.err;
  EXPECT_THAT(here.run({"table", "x.sqlite"}).out, HasSubstr("done"));
}

TEST(ClosedStart, IsRefusedByNameByEveryVerbThatClosesTheSwitch) {
  const Workplace here;
  write(here.path() / "relay.toml", edited(relay, "before = \"90 V\"", "before = \"90 V\", before_state = \"closed\""));
  write(here.path() / "bench.toml", "[[measurement]]\nquantity = \"frequency\"\nvalue = \"25 kHz\"\nerror = \"1 %\"\n");
  write(here.path() / "stdin.txt", "{\"done\":true}\n");
  const std::vector<std::string> limits{"--set", "driver.main={max_voltage=\"120 V\"}"};
  const std::vector<std::vector<std::string>> verbs{
      {"optimize", "relay.toml"},
      {"optimize", "relay.toml", "--robust", "none"},
      {"limit", "relay.toml"},
      {"robustness", "relay.toml", "--set", "spread.\"gap.contact\"={distribution=\"normal\",cov=\"1 %\"}"},
      {"calibrate", "relay.toml"},
      {"effects", "relay.toml"},
      {"accuracy", "relay.toml"},
      {"fit", "relay.toml", "--data", "bench.toml"},
      {"tune", "relay.toml", "--device", "cat"},
      {"device", "relay.toml"},
      {"explore", "relay.toml", "--vary", "gap.contact=2.9 um,3 um", "--study", "optimize"}};
  for (std::vector<std::string> words : verbs) {
    words.insert(words.end(), limits.begin(), limits.end());
    const Outcome o = here.run(words);
    EXPECT_EQ(o.status, 2) << words[0] << ": " << o.out << o.err;
    EXPECT_THAT(o.err,
                AllOf(HasSubstr("relay.toml:6"), HasSubstr("waveform.main.before_state"), HasSubstr("from the open state")))
        << words[0];
  }
}

TEST(SummitsAtHold, AreToldByEveryReportThatTellsAContactForce_optimized) {
  const Workplace here;
  const std::vector<std::string> volts{"--set", "waveform.main.level=17 V", "--set", "driver.main.max_voltage=60 V"};
  const std::string few = "summits touch under the hold levels: fewer than one";
  const std::vector<std::vector<std::string>> verbs{
      {"simulate", "gold.toml", "--set", "simulate.duration=60 us"},
      {"check", "gold.toml"},
      {"release", "gold.toml", "--budget", "20", "--samples", "0"},
      {"robustness", "gold.toml", "--samples", "8", "--set", "simulate.duration=60 us"},
      {"limit", "gold.toml", "--no-curves", "--set", "structure.modes=1"},
      {"optimize", "gold.toml", "--robust", "none", "--budget", "6", "--set", "simulate.duration=150 us"}};
  for (std::vector<std::string> words : verbs) {
    words.insert(words.end(), volts.begin(), volts.end());
    if (words[0] != "check") words.insert(words.end(), {"--out", "of-" + words[0]});
    words.insert(words.end(), {"--json", "told.json"});
    const Outcome o = here.run(words);
    EXPECT_EQ(o.err.find("internal"), std::string::npos) << o.err;
    const json told = json::parse(read(here.path() / "told.json"));
    fs::remove(here.path() / "told.json");
    EXPECT_THAT(told["warnings"].dump(), HasSubstr(few)) << words[0];
    const std::string page =
        read(here.path() / ("of-" + words[0]) / (words[0] == "robustness" ? "robustness.html" : "report.html"));
    if (!page.empty()) {
      EXPECT_THAT(page, HasSubstr(few)) << words[0];
    }
    std::string text;
    for (const char one : o.out) text += one == '\n' ? ' ' : one;
    if (words[0] == "limit") continue;  // its text does not contain the force
    const std::size_t first = text.find(few);
    EXPECT_NE(first, std::string::npos) << words[0] << text;
    EXPECT_EQ(text.find(few, first + 1), std::string::npos) << words[0] << " repeats it";
  }
}

TEST(PiezoLayer, ThatIsNotCountedIsToldBesideTheDriveEnergy_optimized) {
  const Workplace here;
  const std::vector<std::string> words{"simulate", "pzt.toml",
                                       "--set",    "waveform.main.level=17 V",
                                       "--set",    "driver.main.max_voltage=60 V",
                                       "--set",    "simulate.duration=60 us"};
  const std::vector<std::string> drive{"--set", "waveform.piezo={family=\"step\", level=\"0.9 V\"}"};
  const auto energy = [&](std::vector<std::string> more) {
    more.insert(more.begin(), words.begin(), words.end());
    more.insert(more.end(), drive.begin(), drive.end());
    more.insert(more.end(), {"--json", "-"});
    return json::parse(here.run(more).out)["metrics"]["drive_energy_J"].get<double>();
  };
  const std::string sentence = "does not count the charging of the piezo layer";
  const std::vector<std::string> counted{"--set", "piezo.relative_permittivity=1500"};
  std::vector<std::string> told = words;
  told.insert(told.end(), counted.begin(), counted.end());
  EXPECT_THAT(here.run(words).out, HasSubstr(sentence));
  EXPECT_THAT(here.run(told).out, Not(HasSubstr(sentence)));
  // C V^2/2 of a layer of 235 x 20 um that is 1 um thick.
  const double charging = 8.8541878128e-12 * 1500 * 235e-6 * 20e-6 / 1e-6 * 0.9 * 0.9 / 2;
  EXPECT_NEAR(energy(counted) - energy({}), charging, 1e-6 * charging);
}

TEST(Check, SaysWhereFewerThanOneSummitIsInTouch) {
  const Workplace here;
  const auto said = [&](const std::string& density) {
    return here.run({"check", "gold.toml", "--quiet", "--set", "contact.asperity_density=" + density + " 1/m^2"}).out;
  };
  EXPECT_THAT(said("1e11"), HasSubstr("summits touch under the hold levels: fewer than one"));
  EXPECT_THAT(said("1e14"), AllOf(HasSubstr("summits touch under the hold levels"), Not(HasSubstr("fewer than one"))));
}

TEST(Export, OfASlowDeviceEndsOnTheHoldLevel) {
  const Workplace here;
  write(here.path() / "pulse.toml",
        edited(edited(edited(shipped("mem-gold.toml"), "family = \"step\"", "family = \"pulse\""), "level = \"1.25 Vdp\"",
                      "levels = [\"16 V\", \"3 V\", \"15 V\"]\ntimes = [\"20 us\", \"90 us\"]\nedge = \"1 us\""),
               "1.5 Vdp", "25 V"));
  const auto last = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"export", "pulse.toml"});
    const std::string text = here.run(words).out;
    return text.substr(text.rfind('\n', text.size() - 2) + 1);
  };
  const json modes = json::parse(here.run({"modes", "pulse.toml", "--json", "-"}).out);
  const double frequency = modes["natural_frequencies_rad_s"][0].get<double>() / 6.283185307179586;
  for (const double slower : {1.0, 7.0, 50.0})
    EXPECT_TRUE(last({"--device-frequency", std::to_string(frequency / slower) + " Hz"}).ends_with(",15\n")) << slower;
}

}  // namespace
}  // namespace softland
