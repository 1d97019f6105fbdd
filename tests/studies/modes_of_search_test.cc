// Landings that are bouncy with more modes than the scene has: gentle edges, the worst of several beams, and further
// simulations of a winner.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/random.h"
#include "model/constants.h"
#include "studies/closing/auto_settings.h"
#include "studies/closing/checking_runs.h"
#include "studies/search/least_time.h"
#include "studies/search/optimize.h"
#include "studies/search/verification.h"
#include "tests/studies/scenes.h"

namespace softland {
namespace {

constexpr const char* families_with_slew = "step+pulse+catch+ramp+knots:6+coast+dual-pulse+staircase:4+s-curve+bspline:8+sines:4";

// A waveform with jumps: the beam lands with four modes, and rebounds with eight.
SceneFile landed_with_four_modes() {
  SceneFile file = gold_pzt({"simulate.duration=300 us"});
  file.set_waveform("piezo",
                    BSpline{.levels = {-0.14759406469072628, -0.33593656547169154, -0.6781618776155263, -0.9569755388600174,
                                       -0.43833753411517623, -0.9947848905786536, -0.7117460245344545, 0.9956114451761955,
                                       0.9489187859469514, 0.9236979507763792, 0.8429819293390053, 0.9664974161937026, 1,
                                       0.2712759246976191, -0.9906464786491784, -1, 0, 0},
                            .duration = 2.3647036736505757e-05});
  return file;
}

std::vector<double> somewhere(const SearchSpace& space, std::uint64_t number) {
  std::vector<double> x;
  for (const Variable& v : space.variables())
    x.push_back(std::lerp(v.lower, v.upper,
                          static_cast<double>(random_bits(7, Stream::library_seed, 1000 * number + x.size()) >> 11) / 0x1p53));
  return x;
}

// In every family that a search may try, a waveform takes at least a period of the highest mode to cross its range, and stays
// within the driver's own limits.
TEST(GentleEdges, AreThoseOfEveryWaveformOfEveryFamily) {
  const std::vector<SearchSetting> steep = search_settings(gold_pzt(), Target::bounce, Actuator::both, families_with_slew, {});
  const std::vector<SearchSetting> gentle = with_gentle_edges(steep, Actuator::both, families_with_slew);
  ASSERT_EQ(gentle.size(), steep.size());
  const double fastest = steep.front().given.model.basis().angular_frequencies().maxCoeff();
  bool steeper = false;
  for (std::size_t k = 0; k < gentle.size(); ++k) {
    for (std::uint64_t n = 0; n < 40; ++n) {
      const std::vector<double> x = somewhere(gentle[k].space, n);
      for (const auto& [drive, waveform] : gentle[k].space.waveforms(x)) {
        const DriverLimits& own = steep[k].given.drives.at(drive).limits.value();
        const double most = (own.max_voltage - own.min_voltage) * fastest / (2 * pi);
        EXPECT_LE(signal(waveform).peak_slew(), most * (1 + 1e-6)) << families_of(families_with_slew)[k] << ", " << drive;
        steeper = steeper || signal(steep[k].space.waveforms(somewhere(steep[k].space, n)).at(drive)).peak_slew() > 2 * most;
      }
    }
    EXPECT_EQ(gentle[k].given.drives.at("piezo").limits.value().max_slew, std::numeric_limits<double>::infinity())
        << "what the sources do stays as the scene says";
  }
  EXPECT_TRUE(steeper) << "there is something to be gentle about";
}

// The waveforms of a search begin at the voltage that the drive has before.
TEST(GentleEdges, BeginWhereADriveStandsBefore) {
  const SceneFile file =
      gold_pzt({"waveform.main.before=3 V", "waveform.piezo={family=\"step\", level=\"0 V\", before=\"0.4 V\"}"});
  const std::vector<SearchSetting> steep = search_settings(file, Target::bounce, Actuator::both, families_with_slew, {});
  const std::vector<SearchSetting> gentle = with_gentle_edges(steep, Actuator::both, families_with_slew);
  ASSERT_EQ(gentle.size(), steep.size());
  for (std::size_t k = 0; k < gentle.size(); ++k) {
    for (std::uint64_t n = 0; n < 20; ++n)
      EXPECT_TRUE(gentle[k].is_allowed(gentle[k].space.waveforms(somewhere(gentle[k].space, n))))
          << families_of(families_with_slew)[k];
  }
}

TEST(GentleEdges, AreNotForPlatesNorForDriversThatHaveTheirOwn) {
  const auto gentle_of = [](const SceneFile& file, Actuator actuator) {
    return with_gentle_edges(search_settings(file, Target::bounce, actuator, "pulse", {}), actuator, "pulse");
  };
  EXPECT_TRUE(gentle_of(scene("two-electrodes.toml"), Actuator::electrostatic).empty());
  const SceneFile limited = gold_pzt({"driver.piezo.max_slew=5 V/us"});
  EXPECT_TRUE(gentle_of(limited, Actuator::pzt).empty());
  EXPECT_FALSE(gentle_of(limited, Actuator::both).empty()) << "the electrode has none";
}

// A scene or an option may request steeper edges.
TEST(GentleEdges, AreWhereSearchesOfAPiezoBeginUnlessTheyBeginSteeper) {
  const auto begin = [](const SceneFile& file, Actuator actuator, const std::vector<StartingWaveforms>& starts) {
    return begins_gently(with_gentle_edges(search_settings(file, Target::bounce, actuator, "pulse", {}), actuator, "pulse"),
                         starts);
  };
  EXPECT_TRUE(begin(gold_pzt(), Actuator::pzt, {}));
  EXPECT_TRUE(begin(gold_pzt(), Actuator::both, {}));
  EXPECT_FALSE(begin(gold_pzt(), Actuator::electrostatic, {}));
  const auto pulse = [](double edge) { return Pulse{.levels = {0.5, -0.5, 0}, .times = {12e-6, 24e-6}, .edge = edge}; };
  SceneFile own = gold_pzt();
  own.set_waveform("piezo", pulse(2e-6));
  EXPECT_TRUE(begin(own, Actuator::pzt, {}));
  own.set_waveform("piezo", pulse(0.1e-6));
  EXPECT_FALSE(begin(own, Actuator::pzt, {}));
  EXPECT_TRUE(begin(gold_pzt(), Actuator::pzt, {{.name = "gentle", .waveforms = {{"piezo", pulse(2e-6)}}}}));
  EXPECT_FALSE(begin(gold_pzt(), Actuator::pzt, {{.name = "steep", .waveforms = {{"piezo", pulse(0.1e-6)}}}}));
}

// The oracle is the same search of scenes with more modes, and the impact velocities of its closings.
TEST(WorstOfModes, IsTheHighestOfTheCostsOfEveryBeam) {
  const SceneFile file = landed_with_four_modes();
  const SearchSetting plain = search_setting(file, Target::bounce, Actuator::pzt, "bspline:16", {});
  const SearchSetting worst = by_the_worst_of_modes(plain);
  ASSERT_EQ(worst.richer.size(), 3U);
  const std::vector<Signal> signals = plain.given.signals();
  const auto with_speed = [&](const SearchSetting& setting) {
    ClosingOptions run = setting.run_of(signals);
    const Trajectory closing = simulate_closing(setting.given.model, signals, run);
    double fastest = 0;
    for (const Touch& touch : closing.touches) fastest = std::max(fastest, touch.impact_velocity);
    return setting.price(signals).target + 0.04 * fastest / setting.scale.step.largest_impact_velocity;
  };
  const double own = with_speed(plain);
  double expected = own;
  for (const int modes : {6, 8, 10}) {
    SearchSetting alone = plain;
    Device device = plain.given.scene.device;
    device.structure.modes = modes;
    alone.given.model = Switch(device, quadrature_of_richer(plain.given.quadrature, device));
    if (const auto closed = closed_equilibrium(alone.given.model, hold_levels(plain.baseline_scene.signals())))
      alone.run.closed_potential = closed->potential;
    expected = std::max(expected, with_speed(alone));
  }
  EXPECT_NEAR(worst.price(signals).target, expected, 1e-9);
  EXPECT_GT(expected, 1.05 * own);
  EXPECT_TRUE(plain.price(signals).bounce_free);
  EXPECT_FALSE(worst.price(signals).bounce_free);
  const auto x = plain.space.parameters(plain.given.drives.waveforms());
  ASSERT_TRUE(x);
  EXPECT_NEAR(worst.cost_at(*x).target, expected, 1e-9);
  EXPECT_FALSE(worst.gradient_refusal(Target::bounce).empty());
}

TEST(Confirmation, IsByTheIntegratorByRicherBeamsAndByGasLawsWhoseLimitsHold_slow) {
  const auto names = [](const SceneFile& file) {
    std::vector<std::string> all;
    for (const CheckingRun& run : run_checks(prepare_and_choose(file, true))) all.push_back(run.name);
    return all;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(names(gold({"simulate.duration=60 us"})),
            (Names{"tolerance 1e-9", "modes 6", "modes 8", "modes 10", "gas veijola", "gas gallis-torczynski"}));
  const SceneFile narrow =
      gold({"simulate.duration=60 us", "gas.model=veijola", "gap.contact=2.9 um"});  // a Knudsen number of 0.11
  EXPECT_EQ(names(narrow), (Names{"tolerance 1e-9", "modes 6", "modes 8", "modes 10", "gas gallis-torczynski"}));
  SceneFile many = gold({"simulate.duration=60 us", "structure.modes=17"});
  many.erase("gas");
  EXPECT_EQ(names(many), (Names{"tolerance 1e-9", "modes 19"}));
  EXPECT_EQ(names(scene("two-electrodes.toml")).front(), "tolerance 1e-9");
}

// The landing is within 1.2 times the least time in which drives with edges as gentle bring every mode to rest, 23.8 us: it has
// to suit four beams, with some twenty parameters. Eleven searches ended in 25.5 to 26.8 us. The results depend hardly on the
// seed, but on rounding: so lengths differ here by a few parts in a billion as well.
constexpr double late = 1.2;

double least_time_at_rest(const SceneFile& file) {
  const std::string families(default_families(Shaped::piezo));
  const std::vector<SearchSetting> steep = search_settings(file, Target::bounce, Actuator::pzt, families, {});
  const PreparedScene gentle = with_gentle_edges(steep, Actuator::pzt, families).at(0).within_limits();
  const LeastTime rest = least_time(gentle, {.actuator = Actuator::pzt, .at_rest = true});
  EXPECT_EQ(rest.status, Status::done) << rest.message;
  return rest.time;
}

// By the first command of README.md a search for the nominal design lands as softly with six, eight and ten modes as with four.
// Tested for three seeds and lengths.
TEST(WorstOfModes, LandsThePiezoSwitchWithAnyNumberOfModes_slow) {
  const double latest = late * least_time_at_rest(gold_pzt());
  for (const auto& [seed, length] : {std::pair(1U, "250 um"), {2U, "250.000001 um"}, {3U, "250.000003 um"}}) {
    const SceneFile file = gold_pzt({std::string("structure.length=") + length});
    OptimizeOptions options = usual_options(file, Target::bounce, Actuator::pzt);
    options.seed = seed;
    options.jobs = 2;
    const OptimizeResult r = optimize(file, options);
    ASSERT_TRUE(r.best);
    EXPECT_TRUE(r.confirmed);
    EXPECT_GT(r.evaluations_of_modes, 0);
    EXPECT_LE(r.best->metrics.permanent_contact_time, latest) << length;
    EXPECT_LE(r.best->metrics.impact_velocity, 10e-3) << length;
    for (const CheckingRun& run : r.checks) {
      if (run.varied == Varied::gas) continue;
      EXPECT_EQ(run.metrics.bounce_count, 0) << length << ", " << run.name;
      EXPECT_LE(run.metrics.impact_velocity, 10e-3) << length << ", " << run.name;
      EXPECT_LE(run.metrics.permanent_contact_time, latest) << length << ", " << run.name;
    }
  }
}

// A search with steep edges of the piezo lands with the scene's modes, but not with more of them: it continues with gentle
// edges.
TEST(WorstOfModes, GoesOnWhereALandingBelongsToTheModesOfItsScene) {
  const OptimizeResult free =
      optimize(landed_with_four_modes(), {.actuator = Actuator::pzt, .family = "bspline:16", .max_evaluations = 100, .jobs = 2});
  ASSERT_TRUE(free.best);
  EXPECT_TRUE(free.goal_met);
  EXPECT_GT(free.evaluations_of_modes, 50) << "half the budget with gentle edges, then the worst of beams";
  EXPECT_EQ(free.best_scene->drives.at("piezo").limits.value().max_slew, std::numeric_limits<double>::infinity())
      << "the driver's own";
  EXPECT_EQ(free.confirmed, std::ranges::all_of(free.checks, [](const CheckingRun& run) {
              return run.varied == Varied::gas || run.metrics.bounce_count == 0;
            }));
}

}  // namespace
}  // namespace softland
