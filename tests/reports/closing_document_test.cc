#include "reports/closing_document.h"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <regex>

#include "base/require.h"
#include "document/escape.h"
#include "document/page_files.h"
#include "document/text.h"
#include "reports/closing_record.h"
#include "reports/device_picture.h"
#include "sample_result.h"

namespace softland {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::size_t megabyte = 1'000'000;

std::size_t occurrences(const std::string& text, std::string_view what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

/// Returns the resources that a browser would load: values of src and href, url(...) and @import, except fragments of the page.
std::vector<std::string> loads(const std::string& page) {
  static const std::regex pattern(R"re((?:\b(?:src|href|srcset)\s*=\s*["']?|url\(\s*["']?|@import\s+["']?)([^"'\s)>]+))re");
  std::vector<std::string> out;
  for (auto at = std::sregex_iterator(page.begin(), page.end(), pattern); at != std::sregex_iterator(); ++at) {
    if (const std::string target = (*at)[1]; !target.starts_with('#')) out.push_back(target);
  }
  return out;
}

TEST(HtmlReport, LoadsNothing) {
  EXPECT_THAT(loads(page_html(closing_document(read_closing(test::sample_optimize_result(2000))))), ::testing::IsEmpty());
  EXPECT_THAT(loads("<img src=\"https://a\"> <p style='background:url(x.png)'>"), ::testing::ElementsAre("https://a", "x.png"));
}

TEST(HtmlReport, ForbidsTheBrowserToLoadAnything) {
  EXPECT_THAT(page_html(closing_document(read_closing(json::object()))),
              HasSubstr("default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:"));
}

TEST(HtmlReport, StaysBelowAMegabyteForTwentyThousandRowsPerCurveAndALongScene) {
  json result = test::sample_optimize_result(20000);
  // Noise on every column, so that no row can be left out.
  for (const char* run : {"best", "baseline"}) {
    for (const char* column : {"tip_gap_m", "tip_velocity_m_s", "contact_force_N"}) {
      std::uint64_t state = 5;
      for (json& value : result["curves"][run][column]) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        value = value.get<double>() + 1e-6 * static_cast<double>(state >> 40) / 16777216.0;
      }
    }
  }
  std::string scene;
  while (scene.size() < 2 * megabyte) scene += "key = \"a <line> of a long table\"\n";
  result["scene_toml"] = scene;
  const std::string page = page_html(closing_document(read_closing(result)));
  EXPECT_LT(page.size(), megabyte);
  EXPECT_THAT(page, HasSubstr("bytes are not shown"));
}

TEST(HtmlReport, EscapesHostileText) {
  const std::string hostile = "</title></script><script>alert(1)</script><img src=x onerror='alert(2)'>\" {{data}} <!--";
  json result = test::sample_optimize_result(600);
  for (const char* key :
       {"title", "command", "version", "target", "actuator", "optimizer", "termination", "budget", "scene_toml"})
    result[key] = hostile;
  result["warnings"] = {hostile};
  result["reproduce"] = {hostile};
  result["checks"][0]["name"] = hostile;
  result["checks"][1]["name"] = hostile;
  result["best"]["parameters"][hostile] = hostile;
  result["best"]["waveforms"][hostile] = {{0, 0}, {1e-6, 1}};
  result["search"]["value_name"] = hostile;
  const std::string page = page_html(closing_document(read_closing(result)));
  const std::string tame = page_html(closing_document(read_closing(test::sample_optimize_result(600))));
  for (const char* tag : {"<script", "</script", "<img", "<title", "</title", "<!--"})
    EXPECT_EQ(occurrences(page, tag), occurrences(tame, tag)) << tag;
  EXPECT_THAT(page, HasSubstr("&lt;/title&gt;&lt;/script&gt;&lt;script&gt;alert(1)"));
}

TEST(HtmlReport, SaysEverythingWithoutAScript) {
  const std::string page = page_html(closing_document(read_closing(test::sample_optimize_result(600))));
  EXPECT_THAT(page, HasSubstr("<h1>Softland&#39;s waveform closes the switch bounce-free at 44.5\u00a0µs<span class=\"rest\">; "
                              "with the plain step it"));
  EXPECT_EQ(occurrences(page, "<svg class=\"still\""), 7u);
  for (const char* words :
       {"8.4 times shorter", "803.1\u00a0nm", "ill-conditioned", "tolerance 1e-9", "piezo.level_1</th><td>173.27\u00a0mV",
        "<p>The goal is met.</p>", "<td>57</td><td>0</td>", "With softland 0.1.0, seed 1:", "multi-start Nelder-Mead", "0.1.0",
        "youngs_modulus = &quot;78 GPa&quot;", "softland simulate out/best.toml", "plate_strain is off", "15.46\u00a0kHz"}) {
    EXPECT_THAT(page, HasSubstr(words));
  }
  EXPECT_THAT(page, Not(HasSubstr("{{")));
}

TEST(HtmlReport, ListsMoreThanNineLevelsInTheOrderOfTime) {
  json result = test::sample_optimize_result(600);
  json parameters;
  for (int k = 1; k <= 12; ++k) {
    parameters["piezo.level_" + std::to_string(k) + "_V"] = 0.1;
    parameters["piezo.duration_" + std::to_string(k) + "_s"] = 1e-6;
  }
  result["best"]["parameters"] = parameters;
  const std::string page = page_html(closing_document(read_closing(result)));
  std::size_t last = 0;
  for (int k = 1; k <= 12; ++k) {
    for (const char* stem : {"level_", "duration_"}) {
      const std::size_t at = page.find("piezo." + (stem + std::to_string(k)) + "<");
      ASSERT_NE(at, std::string::npos) << stem << k;
      EXPECT_GT(at, last) << stem << k;
      last = at;
    }
  }
}

TEST(HtmlReport, ListsParametersInTheOrderOfTimeWithTheirBounds) {
  json result = test::sample_optimize_result(300);
  result["best"]["bounds"] = {
      {"piezo.level_1_V", {-1, 1}}, {"piezo.level_2_V", {-1, 0.603}}, {"piezo.time_1_s", {19.7e-6, 90e-6}}};
  const std::string page = page_html(closing_document(read_closing(result)));
  std::size_t before = 0;
  for (const char* name : {"piezo.level_1<", "piezo.time_1<", "piezo.level_2<", "piezo.time_2<"}) {
    const std::size_t at = page.find(std::string("<th scope=\"row\">") + name);
    ASSERT_NE(at, std::string::npos) << name;
    EXPECT_GT(at, before) << name;
    before = at;
  }
  EXPECT_THAT(page, HasSubstr("<td>−1\u00a0V to 1\u00a0V</td>"));
  EXPECT_THAT(page, HasSubstr("<td>−1\u00a0V to 603\u00a0mV <span class=\"bound\">at its upper bound</span></td>"));
  EXPECT_THAT(page, HasSubstr("<td>19.7\u00a0µs to 90\u00a0µs <span class=\"bound\">at its lower bound</span></td>"));
}

TEST(HtmlReport, DrawsTheSwitchAndWhatEveryDriveDemands) {
  json result = test::sample_optimize_result(300);
  EXPECT_THAT(page_html(closing_document(read_closing(result))), Not(HasSubstr("id=\"sketch\"")));
  result["scene"]["structure"] = {{"kind", "cantilever"}, {"length", "250 um"}};
  result["scene"]["gap"] = {{"electrode", "3.5 um"}, {"contact", "2 um"}};
  result["scene"]["electrode"]["main"] = {{"span", {"60 um", "240 um"}}};
  result["scene"]["driver"]["piezo"] = {{"min_voltage", "-1 V"}, {"max_voltage", "1 V"}, {"max_slew", "1e6 V/s"}};
  const std::string page = page_html(closing_document(read_closing(result)));
  for (const char* words :
       {"id=\"sketch\"", "length 250\u00a0µm", "to the contact 2\u00a0µm", "to the electrode 3.5\u00a0µm", "electrode main",
        "Peak voltage, piezo</th>", "121\u00a0mV/µs", "upper limit of the driver", "lower limit of the driver",
        "The driver can supply −1\u00a0V to 1\u00a0V with a slew rate of at most 1\u00a0V/µs."})
    EXPECT_THAT(page, HasSubstr(words)) << words;
  EXPECT_THAT(page, HasSubstr("± integration only"));
  result["certified"] = json::object();
  EXPECT_THAT(page_html(closing_document(read_closing(result))), HasSubstr("± certified"));
}

// The assumed width of letters is above the average of any sans serif font.
TEST(DevicePicture, HoldsAllOfItsWords) {
  constexpr double letter = 7.5;  // width of a letter at 12.5 px
  for (const char* structure : {"cantilever", "clamped-clamped", "plate"}) {
    const std::string drawing = internal::device_picture({.structure = side_of_structure(structure),
                                                          .length = 612.5e-6,
                                                          .electrode_gap = 5.6312e-6,
                                                          .contact_gap = 4.6312e-6,
                                                          .electrodes = {{.name = "main", .span = {}}}});
    static const std::regex text("<text x=\"([0-9.]+)\" y=\"[0-9.]+\" text-anchor=\"start\">([^<]*)<"),
        box("viewBox=\"0 0 ([0-9]+)");
    std::smatch wide;
    ASSERT_TRUE(std::regex_search(drawing, wide, box));
    int found = 0;
    for (auto at = std::sregex_iterator(drawing.begin(), drawing.end(), text); at != std::sregex_iterator(); ++at, ++found)
      EXPECT_LE(std::stod((*at)[1]) + letter * static_cast<double>(internal::display_width((*at)[2].str())), std::stod(wide[1]))
          << (*at)[2];
    EXPECT_GE(found, 2) << structure;
  }
}

TEST(HtmlReport, OfASingleRunHasNoBaselineAndNoSearch) {
  const std::string page = page_html(closing_document(read_closing(test::sample_simulate_result(600))));
  EXPECT_THAT(page, HasSubstr("<h1>The switch first touches at 23.2\u00a0µs"));
  for (const char* words : {"id=\"figure-search\"", "Plain step</th>", "class=\"before\"", "<h2>Confirmation by re-runs"})
    EXPECT_THAT(page, Not(HasSubstr(words)));
}

TEST(HtmlReport, AcceptsAnyPartMissingNullOrOfAnotherType) {
  const json whole = test::sample_optimize_result(300);
  for (const auto& [key, value] : whole.items()) {
    for (const json& stand_in : {json(), json("text"), json(3.5), json::array(), json::object(), json{{1, 2}, "x", nullptr}}) {
      json result = whole;
      result[key] = stand_in;
      EXPECT_NO_THROW((void)page_html(closing_document(read_closing(result)))) << key << " = " << stand_in;
    }
    json result = whole;
    result.erase(key);
    EXPECT_NO_THROW((void)page_html(closing_document(read_closing(result)))) << "without " << key;
  }
  for (const char* run : {"best", "baseline"}) {
    for (const auto& [key, value] : whole["curves"][run].items()) {
      json result = whole;
      result["curves"][run][key] = json::array({nullptr, "x", 1});
      EXPECT_NO_THROW((void)page_html(closing_document(read_closing(result)))) << run << " " << key;
    }
  }
  EXPECT_NO_THROW((void)page_html(closing_document(read_closing(json::object()))));
  EXPECT_THROW((void)page_html(closing_document(read_closing(json::array()))), InvalidInput);
}

TEST(HtmlReport, SaysWhyAFigureIsMissing) {
  json result = test::sample_optimize_result(300);
  result["best"]["metrics"]["permanent_contact_time_s"] = nullptr;
  result["best"]["metrics"]["settled"] = false;
  EXPECT_THAT(page_html(closing_document(read_closing(result))), HasSubstr("<span class=\"after words\">not settled</span>"));
  result["best"]["metrics"]["initial_contact_time_s"] = nullptr;
  EXPECT_THAT(page_html(closing_document(read_closing(result))), HasSubstr("<span class=\"after words\">no contact</span>"));
  result["best"]["metrics"] = json::object();
  result["best"]["metrics"]["initial_contact_time_s"] = 1e-6;
  EXPECT_THAT(page_html(closing_document(read_closing(result))), HasSubstr("<span class=\"after words\">not known</span>"));
}

TEST(HtmlReport, OfARunWithoutContactRepeatsNoFourTimes) {
  json result = test::sample_simulate_result(300);
  EXPECT_THAT(page_html(closing_document(read_closing(result))), HasSubstr("<div class=\"key\">"));
  result["metrics"] = {{"initial_contact_time_s", nullptr}, {"settled", false}};
  EXPECT_THAT(page_html(closing_document(read_closing(result))), Not(HasSubstr("<div class=\"key\">")));
}

TEST(HtmlReport, AcceptsTextThatIsNotUtf8) {
  json result = test::sample_optimize_result(300);
  result["title"] = "\xff\xfe";
  result["best"]["waveforms"]["\xff"] = {{0, 1}};
  result["scene_toml"] = nullptr;
  result["scene"] = {{"title", "\xff"}};
  EXPECT_NO_THROW((void)page_html(closing_document(read_closing(result))));
}

TEST(ScriptJson, CannotEndTheScript) {
  EXPECT_EQ(internal::script_json({{"a", "</script><!--"}}), R"({"a":"\u003c/script>\u003c!--"})");
}

TEST(PageFiles, AreTheFilesOfTheSourceTree) {
  for (const char* name : {"page/page.html", "page/page.css", "page/page.js", "page/scripts.html", "uplot/uPlot.iife.min.js",
                           "uplot/uPlot.min.css", "uplot/LICENSE"}) {
    std::ifstream file(std::string(SOFTLAND_SOURCE_DIR) + "/document/" + name, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    EXPECT_FALSE(text.empty()) << name;
    EXPECT_EQ(internal::page_file(name), text) << name;
  }
  EXPECT_THROW((void)internal::page_file("page/none"), std::logic_error);
}

TEST(HtmlReport, CallsNoFigureIllConditionedWhoseErrorIsBelowItsDigits) {
  const auto note = [](double height, double error) {
    json result = softland::test::sample_simulate_result(600);
    result["metrics"]["major_bounce_height_m"] = result["best"]["metrics"]["major_bounce_height_m"] = height;
    result["errors"]["major_bounce_height_m"] = error;
    const std::string page = page_html(closing_document(read_closing(result)));
    const std::size_t row = page.find("Highest rebound", page.find("± integration only"));
    return page.substr(row, page.find("</tr>", row) - row).find("ill-conditioned") != std::string::npos;
  };
  EXPECT_FALSE(note(0, 1e-18)) << "no rebound, to rounding";
  EXPECT_TRUE(note(0, 3e-9)) << "the other run rebounds";
  EXPECT_TRUE(note(1e-9, 3e-9));
  EXPECT_FALSE(note(100e-9, 3e-9));
}

TEST(HtmlReport, GivesIllConditionedFiguresAsMedianAndRange) {
  json result = softland::test::sample_simulate_result(600);
  result["certified"]["bounce_count"] = {{"median", 54.5}, {"low", 44}, {"high", 60}, {"runs", 16}};
  result["cloud"] = {{"runs", 16}, {"grazing_rebound", nullptr}};
  const std::string page = page_html(closing_document(read_closing(result)));
  EXPECT_NE(page.find("<td>median 54.5, 44 to 60 in 16 runs <span class=\"note\">ill-conditioned</span></td>"),
            std::string::npos);
  EXPECT_NE(page.find("<p>Certified: the figures with a median"), std::string::npos);
}

}  // namespace
}  // namespace softland
