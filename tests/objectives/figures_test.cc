// The table of figures: it has every figure once, with a meaning, and reads each from its own member.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <string_view>
#include <utility>

#include "objectives/cost.h"
#include "objectives/figure_values.h"

namespace softland {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Returns metrics in which every figure has a different value.
Metrics distinct_metrics() {
  Metrics m;
  double next = 1;
  for (const Figure& figure : figure_table) {
    if (const auto* const number = std::get_if<double Metrics::*>(&figure.member)) m.** number = next++;
  }
  m.bounce_count = m.electrical_bounces = m.release_bounces = 17;
  m.settled = true;
  return m;
}

struct Anything {
  template <class T>
  operator T() const;  // NOLINT(google-explicit-constructor): every member can be made of it
};
template <class T, std::size_t... i>
consteval bool is_made_of(std::index_sequence<i...>) {
  return requires { T{(static_cast<void>(i), Anything())...}; };
}
/// Returns the number of members of an aggregate; its base counts as one.
template <class T, std::size_t n = 1>
consteval std::size_t members() {
  if constexpr (is_made_of<T>(std::make_index_sequence<n + 1>())) {
    return members<T, n + 1>();
  } else {
    return n;
  }
}

TEST(Figures, AreTheMembersOfMetricsEachOnce) {
  std::set<std::string_view> keys, names, symbols;
  for (const Figure& figure : figure_table) {
    EXPECT_TRUE(keys.insert(figure.key).second) << figure.key;
    EXPECT_TRUE(names.insert(figure.name).second) << figure.name;
    EXPECT_TRUE(symbols.insert(figure.symbol).second) << figure.symbol;
    EXPECT_EQ(&figure_of(figure.member), &figure) << figure.key << ": another row has the same member";
  }
  // Status, AskedFigures, the end of the run and whether it reopened are no figures of merit.
  constexpr std::size_t others = 4, base = 1;
  EXPECT_EQ(figure_table.size() + others, members<Metrics>() - base + members<ForceOutcome>());
  EXPECT_EQ(figure_table.size() - all_figures.size(), 5U) << "figures of searches alone";
}

TEST(Figures, AreReadFromTheirOwnMember) {
  const Metrics m = distinct_metrics();
  double next = 1;
  const FigureValues values(m);
  for (const Figure& figure : figure_table) {
    const double expected = figure.is_count() ? 17 : figure.is_yes_or_no() ? 1 : next++;
    EXPECT_EQ(figure.value(m), expected) << figure.key;
    EXPECT_EQ(values[figure], expected) << figure.key;
    EXPECT_EQ(values[figure.member], expected) << figure.key;
  }
}

TEST(Figures, AreNotKnownOfARunThatDidNothing) {
  const FigureValues values((Metrics()));
  for (const Figure& figure : all_figures) {
    EXPECT_EQ(std::isnan(values[figure]), !figure.is_yes_or_no()) << figure.key;
  }
  EXPECT_EQ(values[&Metrics::settled], 0) << "open, and nothing else";
  Metrics meant;
  meant.status = Status::open;
  EXPECT_TRUE(std::isnan(FigureValues(meant)[&Metrics::settled])) << "open as its drives ask it to";
  Metrics stopped;
  stopped.initial_contact_time = 1e-6;
  EXPECT_TRUE(std::isnan(FigureValues(stopped)[&Metrics::settled])) << "stopped after the touch";
  EXPECT_TRUE(std::isnan(FigureValues(stopped)[&Metrics::bounce_count]));
}

TEST(Figures, AreWrittenOneByOne) {
  FigureValues errors;
  for (const Figure& figure : all_figures) EXPECT_TRUE(std::isnan(errors[figure])) << figure.key;
  for (const Figure& written : all_figures) {
    FigureValues one;
    one[written] = 3;
    for (const Figure& figure : all_figures) EXPECT_EQ(one[figure] == 3, figure.key == written.key) << figure.key;
  }
}

// "_m_s" for "m/s".
TEST(Figures, HaveKeysThatEndWithTheUnit) {
  for (const Figure& figure : all_figures) {
    std::string key(figure.quantity());
    if (!figure.unit.empty()) key += "_" + std::string(figure.unit);
    std::replace(key.begin(), key.end(), '/', '_');
    EXPECT_EQ(key, figure.key);
    const bool is_ratio = figure.key.find("_over_") != std::string_view::npos;
    EXPECT_EQ(figure.unit.empty(), figure.is_count() || figure.is_yes_or_no() || is_ratio) << figure.key;
  }
  EXPECT_EQ(figure_of(&Metrics::impact_velocity).quantity(), "impact_velocity");
}

TEST(Figures, HaveTheirErrorsFromThoseWhoCanTell) {
  const auto keys = [](const auto& chosen) {
    std::string all;
    for (const Figure& figure : all_figures) {
      if (chosen(figure)) all += std::string(figure.symbol) + ", ";
    }
    return all;
  };
  EXPECT_EQ(keys([](const Figure& f) { return f.error_is_from_two_runs(); }),
            "t_i, B_H, t_1, v_i, peak force, impact energy, p/H, charge at make, charge at break, t_F, least force, t_e, static "
            "deflection, overshoot, open settling time, opening time, highest bounce on opening, open and at rest, overshoot on "
            "opening, least gap, time in touch, impact on the "
            "back "
            "stop, "
            "drive energy, ");
  EXPECT_EQ(keys([](const Figure& f) { return f.has_error() && !f.error_is_from_two_runs(); }),
            "t_p, t_b, N_B, hold force, contact resistance, t_c, N_e, capacitance, bounces on opening, ");
  EXPECT_EQ(keys([](const Figure& f) { return !f.has_error(); }), "command to open, peak voltage, peak slew, settled, ");
}

TEST(Figures, OfTargetsAreLowerWhereTheyAreBetter) {
  for (const TargetRow& row : targets) EXPECT_EQ(figure_of(row.value).better, Better::lower) << row.name;
  EXPECT_EQ(figure_of(Target::settling).symbol, "t_p");
  EXPECT_EQ(figure_of(Target::count).symbol, "N_B");
  EXPECT_EQ(figure_of(Target::steady).symbol, "t_F");
}

TEST(Figures, CountALowReboundAsOneThatJustCounts) {
  const MetricsOptions from_2_nm{.significant_rebound = 2e-9};
  const Figure& height = figure_of(&Metrics::major_bounce_height);
  Metrics m;
  EXPECT_TRUE(std::isnan(height.counted(m, from_2_nm)));
  m.major_bounce_height = 1e-9;
  EXPECT_EQ(height.counted(m, from_2_nm), 2e-9);
  m.major_bounce_height = 3e-9;
  EXPECT_EQ(height.counted(m, from_2_nm), 3e-9);
  m.initial_contact_time = 1e-9;
  EXPECT_EQ(figure_of(&Metrics::initial_contact_time).counted(m, from_2_nm), 1e-9) << "a time is no height";
}

TEST(Figures, CountAForceThatIsNotSteadyAsOneThatJustIs) {
  const MetricsOptions options{.steady_force = 0.2};
  const Figure& least = figure_of(&Metrics::least_force_after_touch);
  Metrics m;
  m.least_force_after_touch = 1e-9;
  EXPECT_EQ(least.counted(m, options), 1e-9) << "what holds it is not known";
  m.hold_force = 10e-9;
  EXPECT_EQ(least.counted(m, options), 2e-9);
  m.least_force_after_touch = 3e-9;
  EXPECT_EQ(least.counted(m, options), 3e-9);
}

TEST(RelativeDifference, IsASizeAndAChangeHasASign) {
  EXPECT_EQ(relative_change(1, 4), -0.75);
  EXPECT_EQ(relative_change(-1, -4), 0.75) << "relative to the size of the reference";
  EXPECT_EQ(relative_difference(1, 4), 0.75);
  EXPECT_EQ(relative_difference(5, 4), 0.25);
}

TEST(RelativeDifference, OfWhatIsZeroOrMissing) {
  EXPECT_EQ(relative_difference(0, 0), 0);
  EXPECT_EQ(relative_difference(1, 0), infinity);
  EXPECT_EQ(relative_difference(Metrics::unset, Metrics::unset), 0) << "neither is known";
  EXPECT_EQ(relative_difference(Metrics::unset, 1), infinity);
  EXPECT_EQ(relative_difference(1, Metrics::unset), infinity);
  EXPECT_EQ(relative_difference(infinity, infinity), 0);
  EXPECT_EQ(relative_difference(1, infinity), infinity);
  EXPECT_TRUE(std::isnan(relative_change(Metrics::unset, 1)));
  EXPECT_TRUE(std::isnan(relative_change(1, Metrics::unset)));
  EXPECT_TRUE(std::isnan(relative_change(0, 0)));
}

TEST(RelativeDifference, OfWhatIsSmallIsRelativeToTheLeastSize) {
  EXPECT_EQ(relative_difference(1, 0, 4), 0.25);
  EXPECT_EQ(relative_difference(3, 2, 4), 0.25);
  EXPECT_EQ(relative_difference(9, 8, 4), 0.125);
  EXPECT_EQ(relative_difference(-1, -2, 4), 0.25);
}

TEST(Figures, HaveAMeaningEach) {
  std::set<std::string_view> meanings;
  for (const Figure& figure : figure_table) {
    EXPECT_FALSE(figure.about.empty()) << figure.key;
    EXPECT_TRUE(meanings.insert(figure.about).second) << figure.key << ": another row has the same meaning";
  }
}

}  // namespace
}  // namespace softland
