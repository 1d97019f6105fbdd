// The next waveform to try: the one with the least expected cost over the devices of a belief (tuner.h has the cost).
//
// Shapes: an electrode that closes the switch throws, coasts and catches. It uses the family catch of search_space.h: three
// levels with durations, and the hold level. Every other shaped drive pulses. Edges are as short as that family has them. The
// quasi-static approach uses the shapes of quasi_static.h.
//
// Recipes are searched once per scene, by CMA-ES on devices with as little variation as one known closing leaves. They are for
// the nominal device, and on request for units of volts one and two standard deviations away. In the units of a device they are
// starts of its searches, beside the waveforms that were fired.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "studies/inverse/belief.h"

namespace softland {

/// The cost of a closing: that of the landing, and the price of its time.
struct LandingCost {
  double landing = 0, time = 0;
  [[nodiscard]] double total() const { return landing + time; }
};
[[nodiscard]] LandingCost landing_cost(const ImaginedClosing& closing, const TuningScales& scales);
/// Cost of a switch that does not close.
inline constexpr double not_landed = 3;

/// The waveforms that may be tried, as functions of the numbers that a search varies.
class Shapes {
 public:
  /// Makes the shapes of the scene's approach; keeps a reference. Throws what SearchSpace throws.
  explicit Shapes(const TunedScene& scene);
  /// The same with levels of the closing electrode up to `highest` [V], within the limits of its driver, and its hold level
  /// times `hold`, at most as high.
  [[nodiscard]] Shapes within(double highest, double hold) const;

  [[nodiscard]] const std::vector<Variable>& variables() const { return variables_; }
  /// True for a number that hardly matters to the landing: level and duration of the last pull.
  [[nodiscard]] bool is_coarse(std::size_t k) const { return coarse_[k]; }
  [[nodiscard]] std::vector<std::vector<double>> starts() const;
  /// Waveforms in the order of Switch::drives() [V]; numbers beyond the bounds are moved to them.
  [[nodiscard]] std::vector<Waveform> waveforms(std::vector<double> x) const;
  /// The same numbers in the units `to` of another device, from the units `from`: levels of electrodes and all times are
  /// scaled.
  [[nodiscard]] std::vector<double> in_units(std::vector<double> x, const TunedScene::Units& from,
                                             const TunedScene::Units& to) const;
  /// True if the drivers can give these waveforms.
  [[nodiscard]] bool is_allowed(const std::vector<Waveform>& waveforms) const;
  /// The highest level of the closing electrode, by its driver [V]; infinite for a piezo.
  [[nodiscard]] double highest_level() const;
  /// The largest factor of all volts that the drivers and the highest level allow.
  [[nodiscard]] double room(const std::vector<Waveform>& waveforms) const;

 private:
  void describe();

  const TunedScene* scene_;
  std::vector<DriveSearch> drives_;
  std::optional<QuasiStatic> joint_;  // moves all drives
  DriveWaveforms others_;
  std::vector<std::vector<double>> starts_;
  std::vector<Variable> variables_;
  std::vector<bool> coarse_, of_electrode_;  // numbers that hardly matter, and numbers that scale with an electrode's volts
  double highest_ = std::numeric_limits<double>::infinity();
};

/// Devices of a belief, each with a gain of its own in the next shot.
class Outlook {
 public:
  /// Keeps a reference to `scene`.
  Outlook(const TunedScene& scene, const std::vector<Eigen::VectorXd>& points, Draws& draws, const Watch& watch);
  [[nodiscard]] std::size_t size() const { return devices_.size(); }
  /// The mean over the first `count` devices; over the first few of them alone if that is above `give_up`.
  [[nodiscard]] LandingCost expected(const std::vector<Waveform>& waveforms, std::size_t count,
                                     double give_up = std::numeric_limits<double>::infinity()) const;
  [[nodiscard]] PredictedRecord predicted(const std::vector<Waveform>& waveforms) const;
  /// The median of dt_i / d ln(volts) [s]; NaN if no device gives it.
  [[nodiscard]] double touch_slope(const std::vector<Waveform>& waveforms) const;

 private:
  // Closes the devices from `begin` to `end`.
  [[nodiscard]] std::vector<ImaginedClosing> close(const std::vector<Waveform>& waveforms, std::size_t begin, std::size_t end,
                                                   double gain = 1) const;

  const TunedScene& scene_;
  std::vector<ImaginedDevice> devices_;
  std::vector<double> gains_;
  Watch watch_;
};

[[nodiscard]] inline TunedScene::Units units_of(const Recipe& recipe) { return {.volts = recipe.volts, .time = recipe.time}; }
/// Returns the recipes of the options, or else the cheaper ones of the scene's approaches, and chooses their approach. The
/// recipe of the nominal device comes first. Throws InvalidInput for recipes of other shapes, Interrupted.
[[nodiscard]] std::vector<Recipe> recipes_of(TunedScene& scene, const Watch& watch);

struct Proposal {
  std::vector<double> x;
  LandingCost cost;
};
/// Returns the best point that is found from these candidates. Throws Interrupted.
[[nodiscard]] Proposal propose(const TunedScene& scene, const Shapes& shapes, const Outlook& outlook,
                               const std::vector<std::vector<double>>& candidates, std::uint64_t seed, const Watch& watch);

}  // namespace softland
