// A user's own waveform: a class from outside softland, by its voltage against time.
//
// It becomes a Signal like every other waveform: between two of its breakpoints the voltage is followed by cubic polynomials, as
// many as it takes, each within own_waveform_accuracy of the waveform's largest voltage. What runs under a signal then runs under
// it: closings, sources with their limits and errors, devices in lanes, tables for generators. No scene file can hold it.
//
// Smoothness: between two breakpoints the voltage has four continuous derivatives, or the cubics become many. A kink or a jump
// is to be a breakpoint.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "waveforms/parameter.h"
#include "waveforms/signal.h"

namespace softland {

/// By how much the cubics may miss an own waveform, over its largest |V|.
inline constexpr double own_waveform_accuracy = 1e-7;
/// So many cubics at most.
inline constexpr std::size_t most_own_pieces = 20'000;

/// A parameter of an own waveform, and between which bounds a search varies it.
struct OwnParameter {
  std::string name;  ///< letters, digits, '_'; by custom with its unit: "rise_s", "level_V"
  double lower = 0, upper = 0;
  double start = 0;  ///< where a search begins, within the bounds
};

/// To be derived from. All functions are called from several threads at once, and give the same for the same arguments: they
/// must not change what they share. What they throw passes through whoever asked for the signal; in a search the point then
/// counts as infeasible, and OptimizerResult::first_exception tells the first.
class OwnWaveform {
 public:
  OwnWaveform() = default;
  OwnWaveform(const OwnWaveform&) = default;
  OwnWaveform& operator=(const OwnWaveform&) = default;
  virtual ~OwnWaveform() = default;

  /// What messages and results call it; a search names it like a family. Not that of a built-in family, without '+', ',', ':'
  /// and '='.
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// What can be varied; nothing unless it says so. Their values are the `x` of the others, in this order.
  [[nodiscard]] virtual std::vector<OwnParameter> parameters() const { return {}; }
  /// Times at which the voltage kinks or jumps [s]: above 0 and increasing. The last one is the end: from then on the voltage
  /// stays. None: it must be constant, and not 0 V. Of two that differ by rounding only the later one counts.
  [[nodiscard]] virtual std::vector<double> breakpoints(std::span<const double> x) const = 0;
  /// The voltage [V] at a time [s] from 0 to the end; where it jumps, that after the jump.
  [[nodiscard]] virtual double voltage(double time, std::span<const double> x) const = 0;
};

/// An own waveform with these values of its parameters, as one of the waveforms of a drive: V(t) = volts f(t / time).
struct Own {
  std::shared_ptr<const OwnWaveform> waveform;
  std::vector<double> x = {};
  double volts = 1, time = 1;
};

/// It has no table of parameters, since no scene can hold it.
template <>
struct FamilyOf<Own> {
  static constexpr std::string_view name = "own";
  static constexpr std::array<Parameter<Own>, 0> parameters = {};
};

/// With the parameters where a search begins. Throws InvalidInput where it is null, or a parameter has no name, or bounds that
/// are not finite and in order about its start.
[[nodiscard]] Own own(std::shared_ptr<const OwnWaveform> waveform);
/// Throws InvalidInput with the name of the waveform where it is null, has other parameters than these, breakpoints are not in
/// order, there are none and the voltage is not constant, a voltage is not finite, or between two breakpoints it is not smooth.
[[nodiscard]] Signal signal(const Own& own, double before = 0);
/// "the own waveform 'NAME'": how messages name one.
[[nodiscard]] std::string described(const Own& own);

}  // namespace softland
