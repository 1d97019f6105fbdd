#include "document/text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <sstream>

#include "document/svg.h"
#include "reports/closing_charts.h"
#include "reports/closing_document.h"
#include "reports/closing_record.h"
#include "sample_result.h"
#include "tests/support/printed.h"

namespace softland {
namespace {

using nlohmann::json;
using softland::test::sample_optimize_result;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::size_t few_rows = 601;

TEST(Wrapped, BreaksAtBlanksOnly) {
  EXPECT_EQ(wrapped("", 5), "");
  EXPECT_EQ(wrapped("one two", 7), "one two");
  EXPECT_EQ(wrapped("one two", 6), "one\ntwo");
  EXPECT_EQ(wrapped("a longer-than-that word", 6), "a\nlonger-than-that\nword");
  EXPECT_EQ(wrapped("a\nb\tc\x1b", 100), "a\\u000ab\\u0009c\\u001b") << "of a name";
  EXPECT_EQ(wrapped("µµ µµ µ", 5), "µµ µµ\nµ") << "columns, not bytes";
}

/// Returns the visible text of a page: without scripts, figures, the listed scene and tags.
std::string read_aloud(const std::string& page) {
  std::string text;
  for (std::size_t at = page.find("<main>"); at < page.size();) {
    const std::size_t tag = std::min(page.find('<', at), page.size());
    text += page.substr(at, tag - at) + " ";
    if (tag == page.size()) break;
    std::string_view end = ">";
    for (const std::string_view hidden : {"script", "svg", "pre"}) {
      if (page.compare(tag + 1, hidden.size(), hidden) == 0)
        end = hidden == "svg" ? "</svg>" : hidden == "pre" ? "</pre>" : "</script>";
    }
    at = std::min(page.find(end, tag), page.size() - end.size()) + end.size();
  }
  return text;
}

TEST(EveryReport, PrintsReadableNumbers) {
  for (json result : {sample_optimize_result(few_rows), softland::test::sample_simulate_result(few_rows)}) {
    EXPECT_EQ(absurd_number(terminal_text(closing_document(read_closing(result)))), "");
    // Figures of a landing so soft that its residuals are rounding errors, and errors from a run of the same kind.
    for (const char* part : {"metrics", "errors"}) {
      for (auto& [key, value] : result[part].items()) {
        if (value.is_number_float() && !key.starts_with("initial")) value = 35.3e-18 * (part[0] == 'e' ? 1e-3 : 1);
      }
    }
    result["errors"]["initial_contact_time_s"] = 26e-18;
    result["metrics"]["major_bounce_height_m"] = 35.3e-15;
    result["best"]["metrics"] = result["metrics"];
    result["best"]["parameters"]["piezo.phase_rad"] = -1.23456789012;
    EXPECT_EQ(absurd_number(terminal_text(closing_document(read_closing(result)))), "")
        << terminal_text(closing_document(read_closing(result)));
    EXPECT_EQ(absurd_number(read_aloud(page_html(closing_document(read_closing(result))))), "");
  }
}

/// Replaces every number of `value` whose index is a multiple of `period`; `turn` counts them.
void damage(json& value, double absurd, int period, int& turn) {
  if (value.is_structured()) {
    for (json& inner : value) damage(inner, absurd, period, turn);
  } else if (value.is_number() && ++turn % period == 0) {
    value = absurd;
  }
}

/// Returns the first badly written number of a report; empty if there is none.
std::string misshapen(const std::string& report) {
  static const std::regex none(".{0,40}\\b(nan|inf)\\b"), long_number(".{0,40}[0-9]{26}");
  std::string text = report;
  for (std::size_t begin = 0; (begin = text.find("<script", begin)) != std::string::npos;)
    text.erase(begin, text.find("</script>", begin) - begin);
  std::smatch found;
  return std::regex_search(text, found, none) || std::regex_search(text, found, long_number) ? found.str() : std::string();
}

TEST(EveryReport, DrawsAndPrintsAbsurdNumbers_slow) {
  for (json whole : {sample_optimize_result(60), softland::test::sample_simulate_result(60)}) {
    whole["scene"]["structure"] = {{"kind", "cantilever"}, {"length", "250 um"}};
    whole["scene"]["gap"] = {{"electrode", "3.5 um"}, {"contact", "2 um"}};
    whole["scene"]["contact"] = {{"pad_length", "1e300 um"}};
    whole["scene"]["waveform"]["piezo"] = {{"family", "pulse"}, {"times", {"1e300 s", "x"}}, {"edge", "5 us"}};
    whole["scene"]["driver"]["main"] = {{"min_voltage", "0 V"}, {"max_voltage", "1e300 V"}};
    for (const double absurd : {1e300, -1e308, 1.797e308, 5e-324, -1e-300, 1e99}) {
      for (const int period : {1, 2, 3, 5, 7}) {
        json result = whole;
        int turn = 0;
        damage(result, absurd, period, turn);
        for (const std::string& report : {terminal_text(closing_document(read_closing(result))),
                                          svg_gap_chart(read_closing(result)), page_html(closing_document(read_closing(result)))})
          EXPECT_EQ(misshapen(report), "") << absurd << ", every " << period << "th number of a result of " << whole["kind"];
      }
    }
  }
}

TEST(TextReport, KeepsItsSentencesWithinAHundredColumns) {
  std::istringstream lines(terminal_text(closing_document(read_closing(sample_optimize_result(few_rows)))));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 110U) << line;  // in bytes
}

TEST(TextReport, ConfirmsOnlyAWinnerThatLandsSoftly) {
  json result = sample_optimize_result(few_rows);
  ASSERT_EQ(result["best"]["metrics"]["bounce_count"], 0);
  EXPECT_THAT(terminal_text(closing_document(read_closing(result))), HasSubstr("in 1 of 2"));
  result["best"]["metrics"]["bounce_count"] = 7;
  EXPECT_THAT(terminal_text(closing_document(read_closing(result))), Not(HasSubstr("simulated again")));
}

TEST(TextReport, LeavesOutMissingParts) {
  for (const char* text : {"{}", R"({"kind": "optimize"})", R"({"kind": "simulate", "warnings": [1, "so"], "checks": 2})"})
    EXPECT_NO_THROW((void)terminal_text(closing_document(read_closing(json::parse(text))))) << text;
}

TEST(TextReport, SaysWhoGivesTheRangeOfTheSettlingTimeAndTheCount) {
  json result = softland::test::sample_simulate_result(few_rows);
  EXPECT_THAT(terminal_text(closing_document(read_closing(result))), HasSubstr("softland simulate --certify"));
  result["certified"] = json::object();
  EXPECT_THAT(terminal_text(closing_document(read_closing(result))), Not(HasSubstr("--certify")));
  result.erase("certified");
  result["metrics"]["bounce_count"] = 0;
  EXPECT_THAT(terminal_text(closing_document(read_closing(result))), Not(HasSubstr("--certify")))
      << "a landing without rebounds is not chaotic";
}

TEST(TextReport, GivesIllConditionedFiguresAsMedianAndRange) {
  json result = softland::test::sample_simulate_result(few_rows);
  EXPECT_THAT(terminal_text(closing_document(read_closing(result))), Not(HasSubstr("Certified")));
  result["certified"] = json::object();
  EXPECT_THAT(terminal_text(closing_document(read_closing(result))), HasSubstr("no figure is ill-conditioned"));
  result["certified"]["bounce_count"] = {{"median", 54.5}, {"low", 44}, {"high", 60}, {"runs", 16}};
  result["certified"]["permanent_contact_time_s"] = {{"median", 305e-6}, {"low", 280e-6}, {"high", 336e-6}, {"runs", 16}};
  result["cloud"] = {{"runs", 16}, {"grazing_rebound", nullptr}};
  EXPECT_THAT(terminal_text(closing_document(read_closing(result))),
              ::testing::ContainsRegex("Rebounds .* median 54.5, 44 to 60 in 16 runs\n"));
  EXPECT_THAT(terminal_text(closing_document(read_closing(result))),
              HasSubstr("median 305.0\u00a0µs, 280.0\u00a0µs to 336.0\u00a0µs in 16 runs\n"));
  EXPECT_THAT(terminal_text(closing_document(read_closing(result))), Not(HasSubstr("The runs diverge")));
  result["cloud"]["grazing_rebound"] = {
      {"rebound", 7}, {"time_s", 85.2e-6}, {"height_m", 1.01e-9}, {"impact_velocity_m_s", 2e-3}, {"at_significant_height", true}};
  const auto words = [&] {
    std::string text = terminal_text(closing_document(read_closing(result)));
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
  };
  EXPECT_THAT(words(), HasSubstr("statistics are those of 16 runs"));
  EXPECT_THAT(words(),
              HasSubstr("The runs diverge at rebound 7 (85.20\u00a0µs, 1.01\u00a0nm high), close to the height from which "
                        "rebounds count."));
  result["cloud"]["grazing_rebound"]["at_significant_height"] = false;
  EXPECT_THAT(words(), HasSubstr("after the slowest impact until then (2.00\u00a0mm/s)."));
}

}  // namespace
}  // namespace softland
