// Plans of explorations: their points, their identity, and what is refused.
#include "config/plan.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "base/require.h"
#include "small_scene.h"

namespace softland::plan_test {
namespace {

PlanRequest request(const std::vector<std::string>& vary, const std::string& sample = {}) {
  PlanRequest asked{.scene = SceneFile::parse(small_scene, "small.toml"), .vary = vary, .sample = sample};
  asked.place = [vary](std::string_view key, std::size_t number) {
    return fmt::format("--{}{}", key, key == "vary" && number < vary.size() ? " " + vary[number] : "");
  };
  return asked;
}
Plan plan(const std::vector<std::string>& vary, const std::string& sample = {}) { return Plan(request(vary, sample)); }

std::string refusal(const std::vector<std::string>& vary, const std::string& sample = {}) {
  try {
    (void)plan(vary, sample);
    return {};
  } catch (const InvalidInput& error) {
    return error.what();
  }
}

Plan read_again(const Plan& p) { return Plan(read_plan(SceneFile::parse(p.text(), "again.toml"))); }

Scene scene_at(const Plan& p, std::uint64_t k) { return read_scene(p.scene(p.values(k))); }

TEST(Plan, OfAGridHasAllCombinationsTheLastVariableFastest) {
  const Plan p = plan({"structure.length=245 um:275 um:4", "gap.contact=1.6um,2.4um"});
  ASSERT_EQ(p.points(), 8U);
  ASSERT_EQ(p.variables().size(), 2U);
  EXPECT_EQ(p.variables()[0].unit(), "m");
  const std::vector<double> lengths{245e-6, 255e-6, 265e-6, 275e-6}, gaps{1.6e-6, 2.4e-6};
  for (std::uint64_t k = 0; k < 8; ++k) {
    EXPECT_EQ(p.values(k), (std::vector<double>{lengths[k / 2], gaps[k % 2]})) << k;
    const Scene scene = scene_at(p, k);
    EXPECT_EQ(scene.device.structure.length, lengths[k / 2]);
    EXPECT_EQ(scene.device.gap.contact, gaps[k % 2]);
  }
  EXPECT_THROW((void)p.values(8), InvalidInput);
}

TEST(Plan, OfAFinerGridMeetsTheValuesOfTheCoarserOne) {
  for (const std::string log : {"", ":log"}) {
    const auto values = [&](int n) {
      return plan({fmt::format("gas.viscosity=1.1e-6 Pa s:3.7e-5 Pa s:{}{}", n, log)}).variables()[0].values;
    };
    const std::vector<double> coarse = values(7), fine = values(25);
    for (std::size_t i = 0; i < coarse.size(); ++i) EXPECT_EQ(coarse[i], fine[4 * i]) << log;
    EXPECT_EQ(fine.back(), 3.7e-5);
  }
}

TEST(Plan, InEqualRatiosIsGeometric) {
  const std::vector<double> values = plan({"gas.viscosity=1e-6 Pa s:1e-4 Pa s:3:log"}).variables()[0].values;
  EXPECT_EQ(values, (std::vector<double>{1e-6, 1e-5, 1e-4}));
}

TEST(Plan, InMultiplesOfAPullInVoltageKeepsThem) {
  const Plan p = plan({"waveform.main.level=1.05 Vdp:1.6 Vdp:12"});
  EXPECT_EQ(p.variables()[0].unit(), "Vdp");
  EXPECT_EQ(p.values(11).front(), 1.6);
  const Scene scene = scene_at(p, 0);
  EXPECT_EQ(scene.need_pull_in, std::vector<std::string>{"main"});
  EXPECT_EQ(
      std::get<Step>(scene.drives({{"main", {.static_pull_in = 50, .dynamic_pull_in = 40}}}).at("main").waveform.value()).level,
      1.05 * 40);
}

// A position that is a length varies by a percentage of that length. One that is a percentage varies by percentages of the
// beam's length.
TEST(Plan, OfAPlaceVariesAsItIsWritten) {
  const Plan of_length = plan({"electrode.main.span[2]=50 %:100 %:2"});
  EXPECT_TRUE(of_length.variables()[0].is_factor);
  EXPECT_EQ(scene_at(of_length, 0).device.electrodes[0].end, Place(120e-6));
  PlanRequest of_share = request({"electrode.main.span[2]=50 %:100 %:2"});
  of_share.scene.set(R"(electrode.main.span=["20 %", "tip"])");
  const Plan p(of_share);
  EXPECT_FALSE(p.variables()[0].is_factor);
  EXPECT_EQ(scene_at(p, 0).device.electrodes[0].end, Place::share(0.5));
  EXPECT_EQ(refusal({"electrode.main.span[2]=200 um:240 um:2"}), "");
  PlanRequest of_pads = request({"electrode.main.span[2]=50 %:100 %:2"});
  of_pads.scene.set(R"(electrode.main.span=[["20 um", "60 um"], ["80 um", "tip"]])");
  EXPECT_THROW((void)Plan(of_pads), InvalidInput);
  PlanRequest beside = request({"gap.contact=1.9 um:2 um:2"});
  beside.scene.set(R"(electrode.main.span=[["20 um", "60 um"], ["80 um", "tip"]])");
  const Electrode pads = scene_at(Plan(beside), 0).device.electrodes[0];
  EXPECT_EQ(pads.begin, Place(20e-6));
  EXPECT_EQ(pads.further, (std::vector<Span>{{Place(80e-6), Place::share(1)}}));
}

TEST(Plan, OfAFactorMultipliesTheScenesOwnNumbers) {
  const Plan p = plan({"gap.electrode * gap.contact=0.9:1.1:3", "structure.thickness=90 %:110 %:3"});
  EXPECT_EQ(p.variables()[0].name, "gap.electrode*gap.contact");
  EXPECT_TRUE(p.variables()[1].is_factor);
  EXPECT_EQ(p.values(8), (std::vector<double>{1.1, 1.1}));
  const Scene scene = scene_at(p, 8);
  EXPECT_EQ(scene.device.gap.electrode, 3.5e-6 * 1.1);
  EXPECT_EQ(scene.device.gap.contact, 2e-6 * 1.1);
  EXPECT_EQ(scene.device.structure.thickness, 4e-6 * 1.1);
}

TEST(Plan, ReachesElementsOfListsWholeNumbersAndChoices) {
  const Plan p = plan({"electrode.main.span[2]=200 um:240 um:2", "structure.modes=2:6:3", "waveform.piezo.levels[2]=0.5 V,0.7 V",
                       "electrode.main.fringing=none,linear", "structure.plate_strain=false,true"});
  ASSERT_EQ(p.points(), 48U);
  const Scene scene = scene_at(p, 0);
  EXPECT_EQ(scene.device.electrodes[0].end, 200e-6);
  EXPECT_EQ(scene.device.electrodes[0].begin, 60e-6);
  EXPECT_EQ(scene.device.structure.modes, 2);
  EXPECT_EQ(scene.device.electrodes[0].fringing, Fringing::none);
  EXPECT_EQ(p.values(47), (std::vector<double>{240e-6, 6, 0.7, 2, 2}));
  EXPECT_EQ(p.scene(p.values(47)).json()["waveform"]["piezo"]["levels"][1], "0.7 V");
}

TEST(Plan, OfASobolSampleGrowsWithoutMovingItsPoints) {
  const std::vector<std::string> box{"structure.length=245 um:275 um", "gas.viscosity=1e-6 Pa s:1e-4 Pa s:log"};
  const Plan few = plan(box, "sobol:16"), many = plan(box, "sobol:64");
  for (std::uint64_t k = 0; k < 16; ++k) EXPECT_EQ(few.values(k), many.values(k));
  std::set<int> strata;
  for (std::uint64_t k = 0; k < 64; ++k) {
    const std::vector<double> x = many.values(k);
    EXPECT_TRUE(x[0] >= 245e-6 && x[0] <= 275e-6);
    strata.insert(static_cast<int>(std::log(x[1] / 1e-6) / std::log(100.0) * 64));
  }
  EXPECT_EQ(strata.size(), 64U);
  EXPECT_NE(few.values(3), plan(box, "lhs:16").values(3));
}

TEST(Plan, OfAListHasItsRows) {
  std::string folder = (std::filesystem::temp_directory_path() / "softland-plan-XXXXXX").string();
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  const std::string path = folder + "/points.csv";
  std::ofstream(path) << "# measured\nstructure.length [um],structure.modes,waveform.main.level [Vdp]\n245,3,1.2\n251.5,4,1.3\n";
  PlanRequest asked = request({});
  read_list(asked, path);
  const Plan p(asked);
  ASSERT_EQ(p.points(), 2U);
  EXPECT_EQ(p.values(0), (std::vector<double>{245e-6, 3, 1.2}));
  EXPECT_EQ(p.values(1), (std::vector<double>{251.5e-6, 4, 1.3}));
  EXPECT_EQ(scene_at(p, 1).device.structure.modes, 4);
  const Plan again = read_again(p);
  EXPECT_EQ(again.text(), p.text());
  EXPECT_EQ(again.values(1), p.values(1));
  std::filesystem::remove_all(folder);
}

TEST(Plan, IsItsTextWhichReadsBackToIt) {
  for (const std::string sample : {"", "sobol:9", "lhs:9"}) {
    const std::string n = sample.empty() ? ":3" : "";
    PlanRequest asked = request({"structure.length=245 um:275 um" + n, "gap.electrode*gap.contact=0.9:1.1" + n,
                                 "structure.thickness=95 %:105 %" + n, "waveform.main.level=1.1 Vdp:1.4 Vdp" + n},
                                sample);
    asked.options["certify"] = "true";
    asked.seed = 7;
    const Plan p(asked), again = read_again(p);
    EXPECT_EQ(again.text(), p.text());
    ASSERT_EQ(again.points(), p.points());
    for (std::uint64_t k = 0; k < p.points(); ++k) {
      EXPECT_EQ(again.values(k), p.values(k));
      EXPECT_EQ(again.scene(again.values(k)).text(), p.scene(p.values(k)).text());
    }
  }
}

TEST(Plan, OfASearchHasABoxAndFiguresInsteadOfPoints) {
  PlanRequest asked =
      request({"structure.length=245 um:275 um", "gas.viscosity=1e-6 Pa s:1e-4 Pa s:log", "structure.modes=2:6"}, "nsga2:300");
  EXPECT_THROW((void)Plan(asked), InvalidInput) << "it needs its figures";
  asked.pareto = "initial_contact_time,impact_velocity";
  const Plan p(asked), again = read_again(p);
  EXPECT_TRUE(again.is_search());
  EXPECT_EQ(again.points(), 300U);
  EXPECT_EQ(again.pareto(), asked.pareto);
  EXPECT_EQ(again.text(), p.text());
  EXPECT_EQ(p.values_in_box({0, 0, 0}), (std::vector<double>{245e-6, 1e-6, 2}));
  EXPECT_EQ(p.values_in_box({1, 1, 1}), (std::vector<double>{275e-6, 1e-4, 6}));
  EXPECT_EQ(p.values_in_box({0.5, 0.5, 0.5}), (std::vector<double>{260e-6, 1e-5, 4}));
  EXPECT_THROW((void)p.values(0), InvalidInput);
  asked.sample = "sobol:300";
  EXPECT_THROW((void)Plan(asked), InvalidInput) << "figures belong to a search";
}

TEST(Plan, IsTheSameHoweverItIsWritten) {
  PlanRequest one = request({"structure.length=245 um:275 um:4"}),
              other = request({"structure.length=0.000245m,255um,265 um,0.275 mm"});
  other.scene = SceneFile::parse(edited(small_scene, "contact = \"2 um\"", "contact = \"2000 nm\" # the same"), "other.toml");
  EXPECT_EQ(Plan(one).text(), Plan(other).text());
  other.seed = 2;
  EXPECT_NE(Plan(one).text(), Plan(other).text());
}

TEST(Plan, HoldsASceneThatNeedsNoOtherFile) {
  const Plan p = plan({"structure.length=245 um:275 um:4"});
  const SceneFile alone = SceneFile::parse(p.base().text(), "alone.toml", "/nowhere");
  EXPECT_EQ(canonical(alone, "scene").text(), p.base().text());
  const Scene given = read_scene(SceneFile::parse(small_scene, "small.toml")), same = read_scene(alone);
  EXPECT_EQ(part_of<Beam>(given.device.structure).youngs_modulus, part_of<Beam>(same.device.structure).youngs_modulus);
  EXPECT_EQ(given.device.piezo->d31, same.device.piezo->d31);
  EXPECT_EQ(given.simulate.accuracy, same.simulate.accuracy);
}

TEST(Plan, ReadsAFile) {
  const std::string text = fmt::format(R"([plan]
scene_text = '''
{}'''
study = "robustness"
samples = 200
seed = 3
vary = ["structure.length=245 um:275 um:4",
        "gap.contact=1.6 um:2.4 um:5"]
)",
                                       small_scene);
  const PlanRequest asked = read_plan(SceneFile::parse(text, "map.toml"));
  EXPECT_EQ(asked.study, "robustness");
  EXPECT_EQ(asked.options.at("samples"), "200");
  EXPECT_EQ(asked.seed, 3U);
  EXPECT_EQ(Plan(asked).points(), 20U);
  EXPECT_FALSE(is_plan(SceneFile::parse(small_scene, "small.toml")));
}

TEST(Plan, RefusesWhatAFileSaysWrongWithItsPlace) {
  const auto told = [](const std::string& lines) -> std::string {
    try {
      (void)Plan(read_plan(SceneFile::parse(fmt::format("[plan]\nscene_text = '''\n{}'''\n{}", small_scene, lines), "map.toml")));
      return {};
    } catch (const InvalidInput& error) {
      return error.what();
    }
  };
  const auto line = 4 + std::count(small_scene.begin(), small_scene.end(), '\n');  // number of the line after the scene
  const std::string place = fmt::format("map.toml:{}: plan.", line);
  EXPECT_EQ(told("vari = 1\n"), place + "vari = 1: unknown key (did you mean 'vary'?)");
  EXPECT_EQ(told("vary = [3]\n"), place + "vary = [3]: value 1: expected a text in quotes");
  EXPECT_EQ(told("seed = -1\n"), place + "seed = -1: must be a whole number from 0 on");
  EXPECT_EQ(told("vary = [\"structure.lenght=1 um:2 um:3\"]\n"),
            place +
                "vary = [\"structure.lenght=1 um:2 um:3\"]: value 1, structure.lenght=1 um:2 um:3: 'structure.lenght': unknown "
                "key (did you mean 'length'?)");
}

TEST(Plan, RefusesWhatIsNone) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> grids{
      {{"structure.length"}, "must be KEY=LOW:HIGH:N"},
      {{"structure.length=1 um:2 um"}, "must be KEY=LOW:HIGH:N"},
      {{"structure.length=1 um:2 um:0"}, "must be a whole number of values"},
      {{"structure.length=1 um:2 um:x"}, "must be a whole number of values"},
      {{"structure.length=1 um:2 um:1"}, "one value cannot be at both ends"},
      {{"structure.length=1:2:3"}, "no unit (expected a length such as 250 um, or a percentage of the scene's value)"},
      {{"structure.length=1 V:2 V:3"}, "expected a length [m], got a voltage [V]"},
      {{"structure.length=1 um:2 V:3"}, "'1 um' is a length [m], but '2 V' is a voltage [V]"},
      {{"structure.length=1 parsec:2 um:3"}, "unknown unit 'parsec'"},
      {{"structure.length=-1 um:2 um:3:log"}, "two ends other than 0"},
      {{"structure.kind=1:2:3"}, "list its values"},
      {{"structure.kind=cantilever,bridge"}, "'bridge': unknown value"},
      {{"structure.mass=1 kg:2 kg:3"}, "does not belong to structure.kind"},
      {{"structure.modes=1.5:3:3"}, "must be a whole number"},
      {{"structure.modes=1:2:5"}, "5 values in equal steps from 1 to 2 are not whole numbers; 2 values are"},
      {{"structure.modes=2:8:5"},
       "--vary structure.modes=2:8:5: 5 values in equal steps from 2 to 8 are not whole numbers; 2, 3, 4, 7 values are"},
      {{"structure.modes=2:8:100"}, "100 values in equal steps from 2 to 8 are not whole numbers; 2, 3, 4, 7 values are"},
      {{"structur.length=1 um:2 um:3"}, "unknown section (did you mean 'structure'?)"},
      {{"surface.elastic_modulus=1 N/m:2 N/m:3"}, "the scene does not have this section"},
      {{"electrode.main.span=1 um:2 um:3"}, "is a list of 2: name one element"},
      {{"electrode.main.span[3]=1 um:2 um:3"}, "is a list of 2: name one element"},
      {{"structure.length[1]=1 um:2 um:3"}, "must be a list"},
      {{"title=a,b"}, "unknown section"},
      {{"gap.electrode*gap.contact=1 um:2 um:3"}, "several keys vary by one factor"},
      {{"gap.contact=1 um:2 um:3", "gap.electrode*gap.contact=0.9:1.1:3"}, "gap.contact varies already"},
      {{"gap.contact*gap.contact=0.9:1.1:3"}, "names gap.contact twice"},
      {{"structure.damping_ratio*gap.contact=0.9:1.1:3"}, "is 0 in the scene: no factor changes it"},
      {{"structure.length=1 um:2 um:100000", "gap.contact=1 um:2 um:100000"}, "the plan must have at most"},
  };
  for (const auto& [vary, words] : grids) {
    const std::string told = refusal(vary);
    EXPECT_NE(told.find(words), std::string::npos) << vary.back() << ": " << told;
    EXPECT_EQ(told.find("--vary") == 0, words != "the plan must have at most") << told;
  }
  EXPECT_NE(refusal({"structure.length=1 um:2 um:3"}, "sobol:8").find("KEY=LOW:HIGH or KEY=LOW:HIGH:log"), std::string::npos);
  EXPECT_NE(refusal({"structure.length=1 um,2 um"}, "sobol:8").find("KEY=LOW:HIGH"), std::string::npos);
  EXPECT_NE(refusal({}, "sobol:8").find("nothing to sample"), std::string::npos);
  for (const std::string sample : {"halton:8", "sobol", "sobol:0", "sobol:-1", "sobol:1:2"})
    EXPECT_EQ(refusal({"structure.length=1 um:2 um"}, sample).find("--sample: "), 0U) << sample;
}

}  // namespace
}  // namespace softland::plan_test
