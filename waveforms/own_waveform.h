// A drive waveform that the user's program defines: a class that returns voltage against time.
//
// Such an own waveform becomes a Signal: between two breakpoints, cubic polynomials approximate the voltage with an error of at
// most own_waveform_accuracy times its largest voltage. An own waveform can be used wherever a signal can: in closings, in
// sources with limits and errors, in simulations of several devices at once, in tables for generators. A scene file cannot
// contain an own waveform.
//
// Between two breakpoints the voltage should have four continuous derivatives; otherwise many cubics are needed. Every kink and
// every jump must be a breakpoint.
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

/// Largest error of the cubics that approximate a user's own waveform, relative to the largest |V| of the waveform.
inline constexpr double own_waveform_accuracy = 1e-7;
/// Largest number of cubics that approximate a user's own waveform.
inline constexpr std::size_t most_own_pieces = 20'000;

/// A parameter of a user's own waveform, and the bounds between which a search varies the parameter.
struct OwnParameter {
  std::string name;  ///< name of the parameter: letters, digits, '_'; by convention the unit is last: "rise_s", "level_V"
  double lower = 0, upper = 0;
  double start = 0;  ///< value at which a search begins, within the bounds
};

/// Base class of waveforms that the user's program defines. All functions are called from several threads at once: they must
/// not change shared data, and must return equal values for equal arguments. Their exceptions pass through to the caller of
/// signal(); a search treats the candidate as infeasible, and OptimizerResult::first_exception keeps the first message.
class OwnWaveform {
 public:
  OwnWaveform() = default;
  OwnWaveform(const OwnWaveform&) = default;
  OwnWaveform& operator=(const OwnWaveform&) = default;
  virtual ~OwnWaveform() = default;

  /// Returns the waveform's name in messages, results and the options of a search. The name must differ from the names of the
  /// built-in waveform families, and not contain '+', ',', ':' and '='.
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// Returns the parameters of the waveform that a search can vary; none by default. The argument `x` of the other functions
  /// has the values of the parameters, in this order.
  [[nodiscard]] virtual std::vector<OwnParameter> parameters() const { return {}; }
  /// Returns the times at which the voltage kinks or jumps [s]: above 0 and increasing. The last time is the end: the voltage
  /// is constant afterwards. A waveform without breakpoints must be constant, and not 0 V. Two breakpoints that differ by
  /// rounding only count as the later one.
  [[nodiscard]] virtual std::vector<double> breakpoints(std::span<const double> x) const = 0;
  /// Returns the voltage [V] at a time [s] between 0 and the end of the waveform; at a jump the voltage after the jump.
  [[nodiscard]] virtual double voltage(double time, std::span<const double> x) const = 0;
};

/// A user's own waveform f with values x of its parameters, and factors on voltages and times: V(t) = volts f(t / time).
struct Own {
  std::shared_ptr<const OwnWaveform> waveform;
  std::vector<double> x = {};
  double volts = 1, time = 1;
};

/// A user's own waveform has no table of parameters for scene files, since no scene file can contain the waveform.
template <>
struct FamilyOf<Own> {
  static constexpr std::string_view name = "own";
  static constexpr std::array<Parameter<Own>, 0> parameters = {};
};

/// Returns a user's own waveform with the parameter values at which a search begins. Throws InvalidInput if `waveform` is null,
/// a parameter has no name, its bounds are not finite, or its start is not between them.
[[nodiscard]] Own own(std::shared_ptr<const OwnWaveform> waveform);
/// Compiles a user's own waveform to a voltage signal. Throws InvalidInput if the waveform is null or has another number of
/// parameters than `own`. Throws InvalidInput also if breakpoints are not in order, or missing although the voltage changes, or
/// if a voltage is not finite or not smooth between two breakpoints. Messages have the name of the waveform.
[[nodiscard]] Signal signal(const Own& own, double before = 0);
/// Returns the phrase "the own waveform 'NAME'" for messages.
[[nodiscard]] std::string described(const Own& own);

}  // namespace softland
