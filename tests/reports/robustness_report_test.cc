// What the user reads of devices that differ, made here of outcomes that are easy to count.
#include "reports/robustness_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <string>

#include "studies/choices.h"

namespace softland::robustness_report_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

struct Study {
  Prepared nominal;
  RobustnessOptions options;
  Robustness found;
  Sensitivity sensitivity;
  std::vector<DeviceCourse> courses;

  [[nodiscard]] RobustnessReport report() const {
    return {.nominal = nominal,
            .found = found,
            .options = options,
            .command = "softland robustness 'a & b.toml'",
            .sensitivity = sensitivity,
            .courses = courses};
  }
};

const Study& study() {
  static const Study made = [] {
    SceneFile file = SceneFile::load(std::string(SOFTLAND_SOURCE_DIR) + "/scenes/mem-gold.toml");
    for (const char* set : {"waveform.main.level=17.771 V", "waveform.main.rise_time=20 us", "driver.main.max_voltage=25 V",
                            "simulate.duration=100 us"})
      file.set(set);
    Study s{.nominal = prepare(file), .options = {.samples = 64, .jobs = 2, .worth_of_measuring = true}, .found = {}};
    s.found = robustness(s.nominal,
                         {{.name = "<slow>, \"mine\"",
                           .waveforms = s.nominal.drives.waveforms,
                           .calibration = {.pull_in_error = 0.01, .frequency_error = 0.0}}},
                         s.options);
    s.sensitivity = sensitivity(s.nominal, s.found.drives.back(), 32, s.options);
    s.courses = device_courses(s.nominal, s.found.drives.back(), s.found, s.options);
    return s;
  }();
  return made;
}

TEST(RobustnessReport, OfATerminalHasEveryDriveAndWhatMeasuringIsWorth) {
  const std::string text = robustness_text(study().report());
  for (const char* words :
       {"64 devices of the spread: gap.electrode and gap.contact ± 2.0 % (normal)", "plain step", "<slow>, \"mine\"",
        "Known of every device", "\nnothing ", "\nVdp and frequency ", "\nVdp ± 1.0 %, frequency exactly ",
        "Share of the variance, alone / in all", "\nstructure.thickness "})
    EXPECT_THAT(text, HasSubstr(words));
  RobustnessReport bare = study().report();
  bare.sensitivity = {};
  EXPECT_THAT(robustness_text(bare), Not(HasSubstr("Share of the variance")));
}

TEST(RobustnessReport, AsJsonHoldsWhatTheStudyFound) {
  const nlohmann::json j = robustness_json(study().report());
  EXPECT_EQ(j["kind"], "robustness");
  EXPECT_EQ(j["devices"], 64);
  ASSERT_EQ(j["drives"].size(), 2U);
  ASSERT_EQ(j["by_knowledge"].size(), 4U);
  EXPECT_TRUE(j["drives"][0]["calibration"]["Vdp_error"].is_null());
  EXPECT_EQ(j["drives"][1]["calibration"]["Vdp_error"], 0.01);
  const auto& index = study().sensitivity.figures[1].estimate.indices->total[0];
  EXPECT_EQ(j["sensitivity"]["figures"]["largest_impact_velocity_m_s"]["variables"]["gaps"]["total"]["value"], index.value);
  for (const DriveRobustness& d : study().found.drives) EXPECT_EQ(d.outcomes.size(), 64U);
}

TEST(RobustnessReport, AsCsvHasALinePerDevice) {
  std::istringstream in(robustness_csv(study().report()));
  std::string line;
  std::getline(in, line);
  EXPECT_THAT(line, HasSubstr("device,gaps,structure.thickness,structure.youngs_modulus,plain step: status,"));
  EXPECT_THAT(line, HasSubstr("\"<slow>, \"\"mine\"\": status\"")) << "names may hold commas and quotes";
  int lines = 0;
  while (std::getline(in, line)) ++lines;
  EXPECT_EQ(lines, 64);
}

TEST(RobustnessReport, ShowsOfJitterTheTimeOfAnEdge) {
  SceneFile file = study().nominal.scene.file;
  file.set(R"(spread={"driver.main.jitter"={distribution="uniform", half_width="50 ns"}})");
  Study jittered{.nominal = prepare(file), .options = {.samples = 64}, .found = {}};
  jittered.found = robustness(jittered.nominal, {}, jittered.options);
  EXPECT_THAT(robustness_text(jittered.report()), HasSubstr("The sources of the drives err as the spread says."));
  for (const bool err : {false, true}) {
    const bool said =
        robustness_html((err ? jittered : study()).report()).find("The sources of the drives err") < std::string::npos;
    EXPECT_EQ(said, err);
  }
  std::istringstream in(robustness_csv(jittered.report()));
  std::string line;
  std::getline(in, line);
  std::set<double> times;
  while (std::getline(in, line)) times.insert(std::stod(line.substr(line.find(',') + 1)));
  EXPECT_EQ(times.size(), 64U);
  for (const double time : times) EXPECT_LT(std::abs(time), 50e-9);
  EXPECT_GT(*times.rbegin() - *times.begin(), 70e-9);
  // A plain step that is late by it is late by it.
  const std::size_t k = jittered.found.drives[0].worst[0];
  const double shown = robustness_json(jittered.report())["drives"][0]["worst"][0]["values"]["driver.main.jitter"];
  EXPECT_TRUE(times.contains(shown));
  const SceneFile own = scene_of_device(jittered.nominal, jittered.found.drives[0], k, jittered.options);
  const Signal drive = prepare(own).signals().front();
  EXPECT_EQ(drive.pieces().back().begin, std::max(0.0, shown));
}

TEST(RobustnessReport, AsAPageHasEverySectionAndEscapesNames) {
  const std::string page = robustness_html(study().report());
  for (const char* id : {"charts", "knowledge", "figures", "sensitivity", "worst", "reproduce", "scene"})
    EXPECT_THAT(page, HasSubstr(std::string("<section id=\"") + id + "\">")) << id;
  EXPECT_THAT(page, Not(HasSubstr("<slow>")));
  EXPECT_THAT(page, HasSubstr("&lt;slow&gt;, &quot;mine&quot;"));
  EXPECT_THAT(page, HasSubstr("softland robustness &#39;a &amp; b.toml&#39;"));
  EXPECT_THAT(page, HasSubstr("data-chart=\"share-v-max\""));
  EXPECT_THAT(page, HasSubstr("data-chart=\"courses\""));
  EXPECT_LT(page.size(), 1'000'000U);
}

TEST(RobustnessReport, ShowsThePlainStepAloneAndDevicesThatDoNotClose) {
  Study bare{.nominal = study().nominal, .options = {.samples = 8}, .found = study().found};
  bare.found.drives.resize(1);
  bare.found.by_knowledge.clear();
  DriveRobustness& step = bare.found.drives[0];
  step.outcomes.resize(8);
  step.worst = {3};
  step.outcomes[3] = {.metrics = {}, .failure = "gap.contact must be <less>"};
  bare.found.devices = 8;
  const std::string page = robustness_html(bare.report());
  EXPECT_THAT(page, HasSubstr("gap.contact must be &lt;less&gt;"));
  EXPECT_THAT(page, HasSubstr("Under the plain step"));
  EXPECT_THAT(page, Not(HasSubstr("id=\"knowledge\"")));
  EXPECT_EQ(robustness_json(bare.report())["drives"][0]["failures"]["gap.contact must be <less>"], 1);
}

TEST(Sensitivity, SaysWhereFirstContactComesFrom) {
  const Sensitivity& found = study().sensitivity;
  ASSERT_EQ(found.figures.size(), 3U);
  ASSERT_TRUE(found.figures[0].estimate.indices);
  EXPECT_EQ(found.variables, (std::vector<std::string>{"gaps", "structure.thickness", "structure.youngs_modulus"}));
  double sum = 0;
  for (const SobolIndex& index : found.figures[0].estimate.indices->first_order) sum += index.value;
  EXPECT_NEAR(sum, 1, 0.15) << "the time of first contact is nearly a sum";
}

TEST(DeviceCourses, AreThoseOfTheQuantilesOfTheHighestRebound) {
  ASSERT_EQ(study().courses.size(), 3U);
  const std::vector<DeviceOutcome>& outcomes = study().found.drives.back().outcomes;
  double before = -1;
  for (const DeviceCourse& course : study().courses) {
    const double height = outcomes[course.device].metrics.major_bounce_height;
    EXPECT_GE(height, before);
    before = height;
    int lower = 0;
    for (const DeviceOutcome& o : outcomes) lower += o.metrics.major_bounce_height < height;
    EXPECT_NEAR(lower, course.probability * 64, 1.5);
    EXPECT_EQ(metrics(course.trajectory, study().nominal.scene.metrics).major_bounce_height, height) << "the same closing";
  }
}

}  // namespace
}  // namespace softland::robustness_report_test
