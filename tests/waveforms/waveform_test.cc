#include "waveforms/waveform.h"

#include <gtest/gtest.h>

#include "tests/waveforms/expect_invalid.h"

namespace softland {
namespace {

TEST(Waveform, CompilesLikeItsFamily) {
  const Step step{.level = 3, .rise_time = 1};
  const Harmonic harmonic{.base = 1, .amplitude = 2, .angular_frequency = 3};
  const Pulse pulse{.levels = {1, 2}, .times = {1}, .edge = 0.5};
  const Table table{.time = {0, 1}, .voltage = {1, 2}};
  EXPECT_EQ(signal(Waveform(step)).pieces(), signal(step).pieces());
  EXPECT_EQ(signal(Waveform(harmonic)).pieces(), signal(harmonic).pieces());
  EXPECT_EQ(signal(Waveform(pulse)).pieces(), signal(pulse).pieces());
  EXPECT_EQ(signal(Waveform(table)).pieces(), signal(table).pieces());
}

TEST(Waveform, KnowsTheNamesOfItsFamilies) {
  EXPECT_EQ(family(Step{}), "step");
  EXPECT_EQ(family(Harmonic{}), "harmonic");
  EXPECT_EQ(family(Pulse{}), "pulse");
  EXPECT_EQ(family(Table{}), "table");
}

TEST(Waveform, PassesOnWhatItsFamilyRefuses) {
  test::expect_invalid([] { (void)signal(Waveform(Step{.rise_time = -1})); }, {"rise_time", "-1 s"});
}

}  // namespace
}  // namespace softland
