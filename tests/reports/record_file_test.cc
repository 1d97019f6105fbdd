#include <gtest/gtest.h>

#include "base/require.h"
#include "reports/closing_document.h"
#include "reports/closing_record.h"
#include "sample_result.h"

namespace softland {
namespace {

std::string parse_refusal(const std::string& content) {
  try {
    (void)parse_closing(content, "x.json");
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "was not refused";
}

TEST(ParseClosing, ReadsWhatTheVerbsWrite) {
  const nlohmann::json result = test::sample_optimize_result(10);
  EXPECT_EQ(parse_closing(result.dump(), "x.json"), result);
}

// Ends of pads in all forms that scenes allow: a percentage of the length, up to the tip, and several pads.
TEST(ReadClosing, KnowsWherePadsLie) {
  nlohmann::json result = test::sample_simulate_result(11);
  nlohmann::json& scene = result["scene"];
  scene["structure"]["length"] = "250 um";
  using nlohmann::json;
  scene["electrode"] = {{"main", {{"span", json::array({json::array({"60 um", "40 %"}), json::array({"150 um", "tip"})})}}}};
  scene["piezo"] = {{"span", json::array({"2 %", "tip"})}};
  const DrawnScene read = read_closing(result).scene;
  ASSERT_EQ(read.electrodes.size(), 2U);
  const auto expect = [](const DrawnScene::Span& span, double begin, double end) {
    ASSERT_TRUE(span);
    EXPECT_DOUBLE_EQ((*span)[0], begin);
    EXPECT_DOUBLE_EQ((*span)[1], end);
  };
  expect(read.electrodes[0].span, 60e-6, 100e-6);
  expect(read.electrodes[1].span, 150e-6, 250e-6);
  expect(read.piezo->span, 5e-6, 250e-6);
}

TEST(ReadClosing, MeasuresABeamOfSectionsByTheirLengths) {
  nlohmann::json result = test::sample_simulate_result(11);
  result["scene"]["structure"] = {{"kind", "cantilever"}, {"sections", {{{"length", "30 um"}}, {{"length", "120 um"}}}}};
  result["scene"]["electrode"] = {{"main", {{"span", {"40 um", "80 %"}}}}};
  const DrawnScene read = read_closing(result).scene;
  EXPECT_DOUBLE_EQ(read.length, 150e-6);
  ASSERT_TRUE(read.electrodes.at(0).span);
  EXPECT_DOUBLE_EQ((*read.electrodes[0].span)[1], 120e-6);
}

TEST(ParseClosing, RefusesWhatIsNoResult) {
  for (const char* content : {"", "nonsense", "{}", "[]", R"({"kind": 3})", R"({"kind": "effects"})", R"({"kind": "simulate")",
                              "{\"kind\": \"simulate\", \"title\": \"\xff\"}", R"({"kind": "simulate", "seed": 1e999})"}) {
    EXPECT_TRUE(parse_refusal(content).starts_with("x.json: is not a result of ")) << content;
  }
}

TEST(RequireReportable, TakesWhatTheVerbsWriteAndSaysWhatIsMissing) {
  const auto answer = [](const nlohmann::json& result) -> std::string {
    try {
      require_version(result, "x.json");
      require_reportable(result);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return {};
  };
  for (const nlohmann::json& whole : {test::sample_optimize_result(10), test::sample_simulate_result(10)}) {
    EXPECT_EQ(answer(whole), "");
    for (const char* part : {whole["kind"] == "optimize" ? "baseline" : "metrics", "scene"}) {
      nlohmann::json result = whole;
      result[part] = nullptr;
      EXPECT_EQ(answer(result), std::string("\"") + part + "\" is missing");
    }
    nlohmann::json result = whole;
    result["version"] = "0.2.0";
    EXPECT_EQ(answer(result), "x.json: is a result of softland 0.2.0, of which softland 0.1.0 makes no report");
    result.erase("version");
    EXPECT_EQ(answer(result), "x.json: does not say of which version of softland it is: \"version\" is missing");
  }
}

// A case that once overflowed the stack of the report: 300 000 brackets among the parameters.
TEST(ParseClosing, RefusesNestingThatNoReportCanWalkThrough) {
  const auto nested = [](std::size_t depth) {
    return R"({"kind": "optimize", "best": {"parameters": {"a": )" + std::string(depth, '[') + std::string(depth, ']') + "}}}";
  };
  EXPECT_EQ(parse_refusal(nested(300'000)), "x.json: is nested more than 64 deep");
  EXPECT_EQ(parse_refusal(nested(62)), "x.json: is nested more than 64 deep");
  EXPECT_NO_THROW((void)page_html(closing_document(read_closing(parse_closing(nested(61), "x.json")))));
}

}  // namespace
}  // namespace softland
