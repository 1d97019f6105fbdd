// Requests of searches as texts: their defaults, their meaning, and the refusal of invalid ones.
#include "studies/search/search_request.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/studies/scenes.h"

namespace softland {
namespace {

PlannedSearch planned_of(const SearchRequest& request, const SceneFile& file) {
  return planned(completed(request, file), file, request.waveform);
}

TEST(SearchRequest, IsCompletedByWordsThatSuitTheSceneAndEachOther) {
  const SceneFile gold = scene("mem-gold.toml");
  const SearchRequest plain = completed({}, gold);
  EXPECT_EQ(plain.target, "bounce");
  EXPECT_EQ(plain.actuator, "electrostatic");
  EXPECT_EQ(plain.optimizer, "auto");
  EXPECT_EQ(plain.robust, "auto");
  EXPECT_EQ(plain.waveform, default_families(Shaped::electrode));
  EXPECT_FALSE(plain.budget || plain.seed || plain.seeds || plain.samples);
  EXPECT_EQ(completed({.seeds = "3"}, gold).robust, "none");
  EXPECT_EQ(completed({.robust = "cvar:0.9"}, gold).waveform, default_robust_family);
  EXPECT_EQ(completed({.robust = "cvar:0.9", .calibrate = "Vdp:1 %"}, gold).waveform, default_calibrated_family);
  EXPECT_EQ(completed({.actuator = "pzt"}, scene("mem-gold-pzt.toml")).waveform, default_families(Shaped::piezo));
  EXPECT_EQ(completed({.waveform = "catch", .robust = "yield"}, gold).waveform, "catch");
}

TEST(SearchRequest, ShapesAllDrivesOverDevicesAndOneForTheNominalDesign) {
  const SceneFile both = gold_pzt();
  EXPECT_EQ(completed({}, both).actuator, "both");
  for (const char* robust : {"none", "cvar:0.9"}) EXPECT_EQ(completed({.robust = robust}, both).actuator, "electrostatic");
  SceneFile alone = gold_pzt();
  for (const char* gone : {"electrode", "waveform.main", "driver.main"}) alone.erase(gone);
  EXPECT_EQ(completed({}, alone).actuator, "pzt");
}

TEST(SearchRequest, LetsTheStepComeLaterOverDevicesUnlessItIsFixed) {
  const SceneFile file = gold_pzt();
  EXPECT_TRUE(planned_of({.actuator = "pzt"}, file).for_devices->hold_step_is_chosen);
  EXPECT_FALSE(planned_of({.actuator = "pzt", .hold_step = "fixed"}, file).for_devices->hold_step_is_chosen);
  EXPECT_FALSE(planned_of({.actuator = "pzt"}, file).for_devices->is_of_before);
  // A plan of an earlier version has neither of these texts.
  SearchRequest old = completed({.actuator = "pzt"}, file);
  old.hold_step.clear();
  EXPECT_TRUE(planned(old, file).for_devices->is_of_before);
  EXPECT_THROW((void)planned_of({.actuator = "pzt", .hold_step = "late"}, file), InvalidRequest);
  EXPECT_THROW((void)planned_of({.actuator = "pzt", .robust = "none", .hold_step = "chosen"}, file), InvalidRequest);
  for (const char* robust : {"auto", "cvar:0.9"})
    EXPECT_THROW((void)planned_of({.actuator = "pzt", .waveform = "quasi-static", .robust = robust, .hold_step = "fixed"}, file),
                 InvalidRequest);
  EXPECT_EQ(planned_of({.actuator = "both", .waveform = "quasi-static", .hold_step = "fixed"}, file).for_devices->families,
            "quasi-static");
}

TEST(SearchRequest, SearchesTheQuasiStaticApproachOverDevicesAlone) {
  const SceneFile file = gold_pzt();
  const PlannedSearch alone = planned_of({.actuator = "pzt", .waveform = "quasi-static"}, file);
  EXPECT_EQ(alone.options.family, default_families(Shaped::piezo)) << "of the nominal design";
  EXPECT_EQ(alone.for_devices->families, "quasi-static");
  EXPECT_EQ(planned_of({.actuator = "pzt", .waveform = "catch+quasi-static:2"}, file).options.family, "catch");
  EXPECT_EQ(planned_of({.actuator = "pzt", .waveform = "quasi-static", .robust = "cvar:0.9"}, file).options.family,
            "quasi-static");
  EXPECT_THROW((void)planned_of({.actuator = "pzt", .waveform = "quasi-static", .robust = "none"}, file), InvalidRequest);
}

TEST(SearchRequest, TakesFromAnotherOnlyWhatItDoesNotSay) {
  const SearchRequest known{.target = "energy", .waveform = "catch", .constrain = {"bounce_count == 0"}, .budget = "100"};
  const SearchRequest both = or_else({.target = "impact", .seed = "7"}, known);
  EXPECT_EQ(both.target, "impact");
  EXPECT_EQ(both.waveform, "catch");
  EXPECT_EQ(both.budget, "100");
  EXPECT_EQ(both.seed, "7");
  EXPECT_EQ(both.constrain, known.constrain);
}

TEST(SearchRequest, WithoutWordsIsTheUsualSearch) {
  const SceneFile file = scene("mem-gold.toml");
  const OptimizeOptions usual = usual_options(file);
  const PlannedSearch search = planned_of({.robust = "none"}, file);
  EXPECT_EQ(search.options.family, usual.family);
  EXPECT_EQ(search.options.max_evaluations, usual.max_evaluations);
  EXPECT_EQ(search.options.more_evaluations, usual.more_evaluations);
  EXPECT_EQ(search.options.seed, usual.seed);
  EXPECT_FALSE(search.options.begins_with_half);
  EXPECT_FALSE(search.robust || search.for_devices);
  EXPECT_EQ(search.devices(), 0U);
}

TEST(SearchRequest, GivesItsBudgetToEveryKindOfSearch) {
  const SceneFile file = scene("mem-gold.toml");
  const PlannedSearch nominal = planned_of({.robust = "none", .budget = "400"}, file);
  EXPECT_EQ(nominal.options.max_evaluations, 400);
  EXPECT_EQ(nominal.options.more_evaluations, 0);
  EXPECT_TRUE(nominal.options.begins_with_half);
  EXPECT_FALSE(planned_of({.robust = "none", .budget = "400", .seeds = "2"}, file).options.begins_with_half);
  const PlannedSearch tournament = planned_of({.budget = "1000"}, file);
  EXPECT_EQ(tournament.options.max_evaluations + tournament.for_devices->closings, 1000);
  EXPECT_EQ(planned_of({.robust = "yield"}, file).options.max_evaluations, default_closings);
  const PlannedSearch timed = planned_of({.budget = "120 s"}, file);
  EXPECT_EQ(timed.options.max_seconds, 120);
  EXPECT_EQ(timed.for_devices->closings, 2 * tournament_closings);
  EXPECT_EQ(planned_of({.budget = "1 s"}, file).for_devices->closings, tournament_closings / 4);
}

TEST(SearchRequest, SharesItsConditionsBetweenNominalDesignAndDevices) {
  const SceneFile file = scene("mem-gold.toml");
  const PlannedSearch tournament =
      planned_of({.constrain = {"impact_velocity < 50 mm/s", "largest_impact_velocity < 60 mm/s"}}, file);
  EXPECT_EQ(tournament.for_devices->conditions.size(), 2U);
  EXPECT_LE(tournament.options.conditions.size(), 2U);
  EXPECT_EQ(planned_of({.robust = "yield", .constrain = {"impact_velocity < 50 mm/s"}}, file).robust->aim.conditions.size(), 1U);
  EXPECT_TRUE(planned_of({.robust = "yield", .constrain = {"impact_velocity < 50 mm/s"}}, file).options.conditions.empty());
}

struct Refused {
  SearchRequest request;
  std::string words;  // words of a command line
};

class RefusedSearch : public testing::TestWithParam<Refused> {};

TEST_P(RefusedSearch, NamesFieldValueAndRule) {
  const SceneFile file = scene("mem-gold.toml");
  try {
    static_cast<void>(planned_of(GetParam().request, file));
    FAIL() << GetParam().words;
  } catch (const InvalidRequest& error) {
    EXPECT_EQ(error.with_fields("--").substr(0, GetParam().words.size()), GetParam().words);
    EXPECT_EQ(std::string(error.what()).find("--"), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Words, RefusedSearch,
    testing::Values(Refused{{.target = "softness"}, "--target softness: "},
                    Refused{{.actuator = "magnetic"}, "--actuator magnetic: must be electrostatic, pzt or both"},
                    Refused{{.optimizer = "bobyqa", .robust = "yield"}, "--optimizer bobyqa: a robust search has a method"},
                    Refused{{.robust = "cvar:2"}, "--robust cvar:2: "},
                    Refused{{.calibrate = "mass"}, "--calibrate mass: unknown measurement 'mass'"},
                    Refused{{.calibrate = "Vdp,Vdp"}, "--calibrate Vdp,Vdp: Vdp is given twice; give it once"},
                    Refused{{.robust = "none", .calibrate = "Vdp"}, "--calibrate and --samples are for a search over devices"},
                    Refused{{.robust = "none", .samples = "200"}, "--calibrate and --samples are for a search over devices"},
                    Refused{{.constrain = {"beauty < 1"}}, "--constrain: "},
                    Refused{{.robust = "yield", .samples = "7"}, "--samples 7: must be a whole number from 8 on"},
                    Refused{{.samples = "99"}, "--samples 99: must be a whole number from 100 on"},
                    Refused{{.samples = "100001"}, "--samples 100001: must be at most 100000"},
                    Refused{{.budget = ""}, "--budget '': must be a whole number of evaluations"},
                    Refused{{.budget = "1.5"}, "--budget 1.5: must be a whole number of evaluations"},
                    Refused{{.budget = "0 s"}, "--budget 0 s: must be a whole number of evaluations"},
                    Refused{{.seed = "-1"}, "--seed -1: must be a whole number from 0 on"},
                    Refused{{.seed = "18446744073709551616"}, "--seed 18446744073709551616: must be a whole number from 0 to"},
                    Refused{{.seed = "18446744073709551615", .seeds = "2"}, "--seeds 2: from --seed 18446744073709551615 on"},
                    Refused{{.seeds = "0"}, "--seeds 0: must be a whole number from 1 on"},
                    Refused{{.seeds = "100001"}, "--seeds 100001: must be at most 100000"},
                    Refused{{.robust = "auto", .seeds = "2"}, "--seeds: is for searches on the nominal device"},
                    Refused{{.budget = "9 s", .seeds = "2"}, "--budget 9 s: searches from several seeds"}));

TEST(FoundSearch, IsThatOfItsKindToTheBit) {
  const SceneFile file = scene("mem-gold.toml", {"simulate.accuracy=1e-4"});
  PlannedSearch nominal = planned_of({.waveform = "pulse", .robust = "none", .budget = "60"}, file);
  const FoundSearch found = run(nominal);
  EXPECT_EQ(found.best().best_cost, optimize(file, nominal.options).best_cost);
  EXPECT_EQ(found.is_success(), found.best().is_success());

  PlannedSearch robust = planned_of({.waveform = "pulse", .robust = "yield", .samples = "8", .budget = "200"}, file);
  robust.robust->verdict = 8;
  const FoundSearch on_devices = run(robust);
  EXPECT_EQ(on_devices.best().best_cost, robust_optimize(robust.scene, robust.options, *robust.robust).found.best_cost);
}

TEST(FoundSearch, OverDevicesAssumesASpreadWhereThereIsNone) {
  SceneFile file = scene("mem-gold.toml", {"simulate.accuracy=1e-4"});
  file.erase("spread");
  PlannedSearch search = planned_of({.waveform = "pulse", .robust = "yield", .samples = "8", .budget = "60"}, file);
  search.robust->verdict = 8;
  EXPECT_FALSE(run(search).best().best_scene->scene.spread.empty());
}

}  // namespace
}  // namespace softland
