// Figures as a function of numbers of a scene.
#include "studies/devices/evaluator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/require.h"
#include "studies/closing/auto_settings.h"

namespace softland {
namespace {

SceneFile gold() { return SceneFile::load(SOFTLAND_SOURCE_DIR "/scenes/mem-gold.toml"); }

const Figure& first_contact = figure_of("initial_contact_time_s");

// The rows are the values of devices of a spread: both must give the same figures.
TEST(Evaluator, RowsHaveTheBitsOfTheDevicesOfASpread) {
  SceneFile file = gold();
  file.erase("spread");
  file.set(R"(spread."gap.contact"={distribution="normal",standard_deviation="40 nm"})");
  const PreparedScene nominal = prepare_and_choose(file);
  const Ensemble ensemble(nominal, 5);
  const auto closed = close_all(ensemble, {{.waveforms = nominal.waveforms()}}, {.duration = nominal.duration});
  const Evaluator evaluator(gold(), {"gap.contact"}, {first_contact});
  std::vector<double> rows, figures(5);
  for (std::uint64_t k = 0; k < 5; ++k) rows.push_back(ensemble.values(k)[0]);
  std::vector<RowEnd> ends(5);
  evaluator.evaluate(rows, figures, ends, 2);
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(figures[k], closed[0][k].metrics.initial_contact_time);
    EXPECT_EQ(ends[k].status, to_string(closed[0][k].metrics.status));
  }
}

TEST(Evaluator, AnImpossibleRowIsNaNWithTheReason) {
  const Evaluator evaluator(gold(), {"gap.contact"}, {first_contact});
  const std::vector<double> rows{2e-6, 5e-6};  // in the second row the contact lies beyond the electrode
  std::vector<double> figures(2);
  std::vector<RowEnd> ends(2);
  evaluator.evaluate(rows, figures, ends, 1);
  EXPECT_GT(figures[0], 0);
  EXPECT_TRUE(std::isnan(figures[1]));
  EXPECT_EQ(ends[1].status, "infeasible");
  EXPECT_FALSE(ends[1].reason.empty());
}

TEST(Evaluator, TheLevelOfAWaveformCountsInVolts) {
  const Evaluator evaluator(gold(), {"waveform.main.level", "driver.main.gain"}, {first_contact});
  const double level = evaluator.nominal()[0];
  EXPECT_EQ(evaluator.units()[0], "V");
  const std::vector<double> rows{0.9 * level, 1, level, 0.9};
  std::vector<double> figures(2);
  std::vector<RowEnd> ends(2);
  evaluator.evaluate(rows, figures, ends, 1);
  EXPECT_NEAR(figures[0] / figures[1], 1, 1e-9);
}

TEST(Evaluator, RefusesKeysAndFiguresThatItDoesNotKnow) {
  using testing::HasSubstr;
  const auto message = [](std::vector<std::string> keys, const Figure& figure) {
    try {
      const Evaluator made(gold(), std::move(keys), {figure});
      return std::string();
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
  };
  EXPECT_THAT(message({"gap.contakt"}, first_contact), HasSubstr("contact"));
  EXPECT_THAT(message({"waveform.main.levle"}, first_contact), HasSubstr("level"));
  EXPECT_THAT(message({"waveform.mian.level"}, first_contact), HasSubstr("main"));
  EXPECT_THAT(message({"gap.contact", "gap.contact"}, first_contact), HasSubstr("twice"));
  EXPECT_THAT(message({"gap.contact"}, figure_of("hold_force_N")), HasSubstr("hold_force"));
}

}  // namespace
}  // namespace softland
