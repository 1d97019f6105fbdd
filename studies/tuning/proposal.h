// Which waveform to try next: the one with the least expected cost over the devices of a belief (tuner.h has the cost).
//
// Shapes: an electrode that closes the switch throws, coasts and catches (family catch of search_space.h: three levels that last
// for a while each, and the hold level), every other shaped drive pulses; edges are as short as that family has them. Where the
// scene's approach is the slow one they are those of quasi_static.h.
//
// Recipes are searched once per scene, by CMA-ES on devices that differ as little as they will once one closing is known: for the
// nominal device, and where that is asked for, for units of volts one and two standard deviations away. In the units of a device
// they are where its searches begin, beside the waveforms that were fired.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "studies/tuning/belief.h"

namespace softland {

/// What a closing costs: that of the landing, and the price of its time.
struct LandingCost {
  double landing = 0, time = 0;
  [[nodiscard]] double total() const { return landing + time; }
};
[[nodiscard]] LandingCost landing_cost(const ImaginedClosing& closing, const TuningScales& scales);
/// Of a closing that does not close.
inline constexpr double not_landed = 3;

/// The waveforms that may be tried, by the numbers that a search varies.
class Shapes {
 public:
  /// Those of the scene's approach; keeps a reference. Throws what SearchSpace throws.
  explicit Shapes(const TunedScene& scene);
  /// The same with levels of the electrode that closes the switch up to `highest` [V], where its driver allows that, and its
  /// hold level times `hold`, at most as high.
  [[nodiscard]] Shapes within(double highest, double hold) const;

  [[nodiscard]] const std::vector<Variable>& variables() const { return variables_; }
  /// Whether a number hardly matters to the landing: level and duration of the last pull.
  [[nodiscard]] bool is_coarse(std::size_t k) const { return coarse_[k]; }
  [[nodiscard]] std::vector<std::vector<double>> starts() const;
  /// In the order of Switch::drives() [V]; numbers beyond the bounds are moved to them.
  [[nodiscard]] std::vector<Waveform> waveforms(std::vector<double> x) const;
  /// The same numbers for a device in whose units the first one's are `from`: levels of electrodes and all times.
  [[nodiscard]] std::vector<double> in_units(std::vector<double> x, const TunedScene::Units& from,
                                             const TunedScene::Units& to) const;
  /// Whether the drivers can give these waveforms.
  [[nodiscard]] bool is_allowed(const std::vector<Waveform>& waveforms) const;
  /// Of the electrode that closes the switch, by its driver [V]; of a piezo infinite.
  [[nodiscard]] double highest_level() const;
  /// By what all volts may be multiplied at most before a driver cannot give them, or the highest level is exceeded.
  [[nodiscard]] double room(const std::vector<Waveform>& waveforms) const;

 private:
  void describe();

  const TunedScene* scene_;
  std::vector<DriveSearch> drives_;
  std::optional<QuasiStatic> joint_;  // moves all of them
  DriveWaveforms others_;
  std::vector<std::vector<double>> starts_;
  std::vector<Variable> variables_;
  std::vector<bool> coarse_, of_electrode_;  // whether a number hardly matters, and whether it goes with an electrode's volts
  double highest_ = std::numeric_limits<double>::infinity();
};

/// Devices of a belief, each with a gain of its own in the shot to come.
class Outlook {
 public:
  /// Keeps a reference to `scene`.
  Outlook(const TunedScene& scene, const std::vector<Eigen::VectorXd>& points, Draws& draws, const Watch& watch);
  [[nodiscard]] std::size_t size() const { return devices_.size(); }
  /// The mean over the first `count` devices; over the first few of them alone where that is above `give_up`.
  [[nodiscard]] LandingCost expected(const std::vector<Waveform>& waveforms, std::size_t count,
                                     double give_up = std::numeric_limits<double>::infinity()) const;
  [[nodiscard]] PredictedRecord predicted(const std::vector<Waveform>& waveforms) const;
  /// The median of dt_i / d ln(volts) [s]; NaN where no device tells it.
  [[nodiscard]] double touch_slope(const std::vector<Waveform>& waveforms) const;

 private:
  // Of the devices from `begin` to `end`.
  [[nodiscard]] std::vector<ImaginedClosing> close(const std::vector<Waveform>& waveforms, std::size_t begin, std::size_t end,
                                                   double gain = 1) const;

  const TunedScene& scene_;
  std::vector<ImaginedDevice> devices_;
  std::vector<double> gains_;
  Watch watch_;
};

[[nodiscard]] inline TunedScene::Units units_of(const Recipe& recipe) { return {.volts = recipe.volts, .time = recipe.time}; }
/// Those of the options, or else the cheaper ones of each approach that the scene has; chooses their approach. That of the
/// nominal device comes first. Throws InvalidInput for recipes of other shapes, Interrupted.
[[nodiscard]] std::vector<Recipe> recipes_of(TunedScene& scene, const Watch& watch);

struct Proposal {
  std::vector<double> x;
  LandingCost cost;
};
/// The best point that is found from these candidates. Throws Interrupted.
[[nodiscard]] Proposal propose(const TunedScene& scene, const Shapes& shapes, const Outlook& outlook,
                               const std::vector<std::vector<double>>& candidates, std::uint64_t seed, const Watch& watch);

}  // namespace softland
