// Tests what `softland release` recommends, on synthetic openings.
#include "reports/release_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace softland::release_report_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

ReleaseRecord::Run opening(double settling_time, double residual_vibration, double drives_end) {
  return {.figures = {.status = Status::done,
                      .release_time = 1e-6,
                      .settling_time = settling_time,
                      .overshoot = 0,
                      .residual_vibration = residual_vibration},
          .message = {},
          .drives_end = drives_end,
          .waveforms = {}};
}

ReleaseRecord opened(double settling_time, double residual_vibration) {
  return {.status = "done",
          .band = 150e-9,
          .band_share = 0.05,
          .plain = opening(OpeningFigures::unset, 3e-6, 10e-9),
          .best = opening(settling_time, residual_vibration, 4e-6)};
}

// The text in one line.
std::string said(const ReleaseRecord& record) {
  std::string text = text_of(record);
  for (char& one : text) one = one == '\n' ? ' ' : one;
  return text;
}

TEST(ReleaseReport, RecommendsNothingWithoutAGain) {
  const std::string text = said(opened(OpeningFigures::unset, 2.99e-6));
  EXPECT_THAT(text,
              HasSubstr("No waveform is recommended: the best one is not yet at rest when the window ends, a gain below 5.0 %."));
  EXPECT_THAT(text, Not(HasSubstr("times less")));
}

TEST(ReleaseReport, TellsTheGainAndHowLongTheWaveformLasts) {
  const std::string text = said(opened(9e-6, 1e-6));
  EXPECT_THAT(text, HasSubstr("with the found waveform it is at rest after 9.00\u00a0µs."));
  EXPECT_THAT(text, HasSubstr("3.0 times less"));
  EXPECT_THAT(text, HasSubstr("The found waveform ends after 4.00\u00a0µs"));
  EXPECT_THAT(text, Not(HasSubstr("recommended")));
}

}  // namespace
}  // namespace softland::release_report_test
