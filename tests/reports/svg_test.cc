#include "document/svg.h"

#include <gmock/gmock.h>

#include "base/require.h"
#include "reports/closing_charts.h"
#include "reports/closing_record.h"
#include "sample_result.h"
#include "tests/support/xml.h"

namespace softland {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(SvgPicture, IsWellFormedAndTellsTheFinding) {
  const std::string svg = svg_gap_chart(read_closing(test::sample_optimize_result(6000)));
  EXPECT_EQ(test::xml_fault(svg), "");
  EXPECT_THAT(svg,
              HasSubstr("<title>Softland&#39;s waveform closes the switch bounce-free at 44.5\u00a0µs; with the plain step it"));
  EXPECT_THAT(svg, HasSubstr("Time (µs)"));
  EXPECT_THAT(svg, HasSubstr("Gap (nm)"));
  EXPECT_THAT(svg, HasSubstr("Voltage (mV)"));
  EXPECT_THAT(svg, HasSubstr("803\u00a0nm"));
  EXPECT_THAT(svg, HasSubstr(">contact plane<"));
  EXPECT_LT(svg.size(), 150'000u);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

TEST(SvgPicture, IsWellFormedForHostileAndForEmptyResults) {
  json result = test::sample_simulate_result(600);
  result["title"] = "a <b> & \"c\" \x01 <script>";
  result["best"]["waveforms"]["]]> <x>"] = {{0, 1}};
  EXPECT_EQ(test::xml_fault(svg_gap_chart(read_closing(result))), "");
  EXPECT_EQ(test::xml_fault(svg_gap_chart(read_closing(json::object()))), "");
  EXPECT_THROW((void)svg_gap_chart(read_closing(json::array())), InvalidInput);
}

TEST(SvgPicture, OfACurveThatStandsStillHasFiniteCoordinates) {
  const json still{
      {"kind", "simulate"},
      {"curves", {{"best", {{"time_s", {0, 1e-6, 2e-6}}, {"tip_gap_m", {0, 0, 0}}, {"contact_force_N", {0, 0, 0}}}}}}};
  const std::string svg = svg_gap_chart(read_closing(still));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

TEST(XmlFault, FindsFaults) {
  EXPECT_EQ(test::xml_fault("<a b=\"1\"><c/>x &amp; y</a>\n"), "");
  for (const char* bad : {"", "<a>", "<a></b>", "<a b=1/>", "<a b=\"1\" b=\"2\"/>", "<a>&x</a>", "<a/><b/>", "<a b=\"<\"/>"}) {
    EXPECT_NE(test::xml_fault(bad), "") << bad;
  }
}

}  // namespace
}  // namespace softland
