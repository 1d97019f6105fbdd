// Proposes the next waveform for a device: the waveform with the least expected cost over the devices of a belief (cost:
// tuner.h).
//
// Shapes. The electrode that closes the switch has the waveform family catch of search_space.h: three levels with durations
// that accelerate the beam, let it coast and brake it, then the hold level. Every other varied drive has the family pulse.
// Edges are as short as the families allow. The quasi-static approach uses the waveforms of quasi_static.h.
//
// Recipes are candidate waveforms that are searched once per scene, by CMA-ES on devices whose remaining uncertainty is that
// after one recorded closing. One recipe is for the nominal device. On request there are further recipes for devices whose unit
// of voltage is one or two standard deviations from the nominal one. Scaled by the factors of a device, recipes are starting
// points of the searches for this device, beside the waveforms of earlier shots.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "studies/inverse/belief.h"

namespace softland {

/// The cost of a simulated closing, as the sum of a part for impact and rebounds, and a part for the time of first contact.
struct LandingCost {
  double landing = 0, time = 0;
  [[nodiscard]] double total() const { return landing + time; }
};
[[nodiscard]] LandingCost landing_cost(const PredictedClosing& closing, const TuningScales& scales);
/// Cost of a closing in which the switch does not close.
inline constexpr double not_landed = 3;

/// The waveforms that a tuning may propose, as functions of the variables of its search.
class TuningSpace {
 public:
  /// Makes the waveform shapes for the scene's approach, fast or quasi-static. Keeps a reference to the scene. Throws the
  /// exceptions of SearchSpace.
  explicit TuningSpace(const TuningModel& scene);
  /// Returns the same space of waveforms with a limit `highest` [V] on the closing electrode's levels, within the limits of its
  /// voltage source. The hold level is multiplied by `hold`, and limited as well.
  [[nodiscard]] TuningSpace within(double highest, double hold) const;

  [[nodiscard]] const std::vector<Variable>& variables() const { return variables_; }
  /// True for a waveform variable that hardly affects the closing: duration of the edges, and level and duration of the third
  /// level.
  [[nodiscard]] bool is_coarse(std::size_t k) const { return coarse_[k]; }
  [[nodiscard]] std::vector<std::vector<double>> starts() const;
  /// Returns the waveforms for the variables x, in the order of Switch::drives() [V]. Variables beyond their bounds are
  /// replaced by the bounds.
  [[nodiscard]] std::vector<Waveform> waveforms(std::vector<double> x) const;
  /// Converts waveform variables from the units `from` of a device to the units `to` of another device: scales levels of
  /// electrodes and all times.
  [[nodiscard]] std::vector<double> in_units(std::vector<double> x, const TuningModel::Units& from,
                                             const TuningModel::Units& to) const;
  /// True if the waveforms are within the limits of their voltage sources.
  [[nodiscard]] bool is_allowed(const std::vector<Waveform>& waveforms) const;
  /// Returns the highest level of the closing electrode that its voltage source permits [V]; infinite for a piezo.
  [[nodiscard]] double highest_level() const;
  /// Returns the largest factor by which all voltages of the waveforms may be multiplied within the limits of the voltage
  /// sources and the limit `highest` of within().
  [[nodiscard]] double largest_factor(const std::vector<Waveform>& waveforms) const;

 private:
  void describe();

  const TuningModel* scene_;
  std::vector<DriveSearch> drives_;
  std::optional<QuasiStatic> joint_;  // quasi-static waveforms, which vary all drives together; none for the fast approach
  DriveWaveforms others_;
  std::vector<std::vector<double>> starts_;
  std::vector<Variable> variables_;
  // `coarse_` marks the waveform variables that hardly affect the closing, `of_electrode_` those that scale with the voltage
  // unit of an electrode.
  std::vector<bool> coarse_, of_electrode_;
  double highest_ = std::numeric_limits<double>::infinity();
};

/// Devices that represent the belief, each with a random gain of its voltage sources, which forecast the outcome of the next
/// shot.
class OutcomeForecast {
 public:
  /// Keeps a reference to `scene`, which must outlive this object.
  OutcomeForecast(const TuningModel& scene, const std::vector<Eigen::VectorXd>& points, Draws& draws, const Progress& progress);
  [[nodiscard]] std::size_t size() const { return devices_.size(); }
  /// Returns the mean cost of closings over the first `count` devices, or the mean over the first few of these devices if that
  /// mean is above `give_up`.
  [[nodiscard]] LandingCost expected(const std::vector<Waveform>& waveforms, std::size_t count,
                                     double give_up = std::numeric_limits<double>::infinity()) const;
  [[nodiscard]] PredictedRecord predicted(const std::vector<Waveform>& waveforms) const;
  /// Returns the median over the devices of dt_i / d ln(voltage), where t_i is the first contact time [s]; NaN if no device has
  /// the derivative.
  [[nodiscard]] double touch_slope(const std::vector<Waveform>& waveforms) const;

 private:
  // Simulates the closings of the forecast's devices `begin` to `end` - 1.
  [[nodiscard]] std::vector<PredictedClosing> close(const std::vector<Waveform>& waveforms, std::size_t begin, std::size_t end,
                                                    double gain = 1) const;

  const TuningModel& scene_;
  std::vector<Particle> devices_;
  std::vector<double> gains_;
  Progress progress_;
};

[[nodiscard]] inline TuningModel::Units units_of(const CandidateWaveform& recipe) {
  return {.volts = recipe.volts, .time = recipe.time};
}
/// Returns the recipes (candidate waveforms) in the options. If the options have none, searches recipes for each approach of
/// the scene, and chooses the approach whose recipe has the lower cost. The recipe of the nominal device comes first. Throws
/// InvalidInput for recipes of other waveform shapes, and Interrupted if `progress` asks to stop.
[[nodiscard]] std::vector<CandidateWaveform> recipes_of(TuningModel& scene, const Progress& progress);

struct Proposal {
  std::vector<double> x;
  LandingCost cost;
};
/// Returns the waveform of least expected cost that the searches from these candidates find. Throws Interrupted if `progress`
/// asks to stop.
[[nodiscard]] Proposal propose(const TuningModel& scene, const TuningSpace& space, const OutcomeForecast& forecast,
                               const std::vector<std::vector<double>>& candidates, std::uint64_t seed, const Progress& progress);

}  // namespace softland
