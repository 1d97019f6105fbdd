// The variables of a search: the waveform parameters of one or several drives. The bounds and starting points of the variables
// come from the scene (driver limits, natural frequencies, closing time of the plain step).
//
// Times below are in units of T0, the time of first contact under the plain step, and T1, the period of the first mode.
//   step      rise_time in [0, 2.5 T0]
//   pulse     level_1, level_2 within the driver's limits, time_1 and duration_2 (= time_2 - time_1) in [0.05, 1.6] T0, edge in
//             [0.005, 0.1] T1
//   harmonic  amplitude within the limits about the hold level, angular_frequency in [0.2 omega_1, upper], phase in [0, 2 pi],
//             start in [0, T0], duration in [0.1, 2.5] T0, fade in [0, 0.5] of the duration. upper: the second natural frequency
//             for an electrode, the third for the piezo (dither above these has no net effect: Bognash 2019)
//   catch     a pulse of three levels, each with its duration, and an edge; the third level presses the beam on its contact,
//             duration_3 in [0.05, 4] T0
//   ramp      a jump to level_1, a line to level_2 in duration in [0.5, 10] T0, an edge in [0.005, 0.5] T1
//   staircase N levels with durations in [0.05, 3] T0 each, edge in [0.005, 1] T1
//   knots     polyline: a jump to level_1, straight lines to level_2 ... level_N and the hold level, all in total_time in
//             [0.5, 10] T0, of which the lines take shares in proportion to part_1 ... part_N in [0.05, 1]
//   coast     level_1 for duration_1, then no voltage for coast_1, both in [0.05, 1.6] T0, and an edge as of a pulse
//   pulses    N pulses: level_k for duration_k (the first in [0.05, 1.6] T0, the others in [0.05, 4] T0), between them no voltage
//             for coast_k in [0.05, 1.6] T0, and an edge as of a pulse; dual-pulse: two of them
//   s-curve   a smooth rise to level_1, dwell_1 in [0.01, 3] T0 there, a smooth rise to the hold level; edge in [0.01, 3] T0
//   dither    a harmonic that decays: decay_time in [0.05, 5] T0
//   chirp     a harmonic whose frequency at its end is frequency_ratio in [0.25, 4] times that at its start
//   bspline   a cubic B-spline with N levels and two hold levels as control points, with a duration in [0.5, 10] T0
//   sines     the hold level and N sines of 1 ... N half waves, with amplitudes up to the range of the driver, in a duration in
//             [0.5, 4] T0; beyond the driver's limits all amplitudes are reduced by one factor
//   quasi-static   one family that varies all drives together, over devices only: see quasi_static.h
// An electrode on the far side, which brakes, waits before its pulses instead of coasting after them. The hold level is that of
// the scene and never varied. A slew limit lengthens edges, rise times and fades, delays a sine until its base has risen, and
// limits the amplitude of the sine.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "optimizers/problem.h"
#include "studies/closing/actuator.h"
#include "studies/closing/prepared.h"
#include "studies/search/quasi_static.h"
#include "waveforms/waveform.h"

namespace softland {

/// The drives whose waveforms are searched; the defaults of a search depend on this value.
enum class Shaped { electrode, piezo, several };
/// Returns `several` for an electrode with a piezo, and for two electrodes, if the scene has a voltage source [driver] for an
/// electrode on the far side (away from the contact).
[[nodiscard]] Shaped shaped_drives(const SceneFile& scene, Actuator actuator);
/// Returns the default waveform families, which together find a bounce-free waveform for every switch of results/comparison.md.
[[nodiscard]] std::string_view default_families(Shaped drives);
/// Splits a list of waveform families like "knots+dual-pulse+staircase:5+knots:8". Throws InvalidInput if a name is empty or
/// occurs twice.
[[nodiscard]] std::vector<std::string> families_of(const std::string& text);
/// Returns the prefix of a waveform family's parameters: "knots." if there are several families, empty if it is the only one.
[[nodiscard]] std::string prefix_of(const std::string& families, const std::string& family);

struct SearchedFamily;
/// Waveforms from the user's code. A search request lists their names like waveform families.
using OwnWaveforms = std::vector<std::shared_ptr<const OwnWaveform>>;
/// Returns the names of all waveform families, for messages: "step, pulse, ..., sines:N or quasi-static:N".
[[nodiscard]] std::string listed_searched_families();
/// True for the waveform family that varies all drives together: "quasi-static", "quasi-static:2".
[[nodiscard]] bool is_quasi_static(std::string_view family);

/// The searched waveform of one drive: its waveform family, parameters and bounds.
struct DriveSearch {
  std::string drive;
  const SearchedFamily* family = nullptr;  ///< waveform family of the drive; null: `own` is used
  /// Waveform from the user's code that is searched instead of a waveform family.
  std::shared_ptr<const OwnWaveform> own = nullptr;
  /// The number N of a family such as "knots:N": of levels, knots (corners), pulses or sines; 0 for other families.
  std::size_t count = 0;
  double hold = 0;         ///< hold level of the drive [V]
  double before = 0;       ///< voltage of the drive before t = 0 [V]
  bool brakes = false;     ///< true for an electrode on the far side (away from the contact), which brakes the beam
  double first_touch = 0;  ///< time of first contact under the plain step [s]
  DriverLimits limits;
  std::vector<Variable> variables;
  std::vector<std::vector<double>> starts;
  [[nodiscard]] Waveform waveform(std::span<const double> x) const;
  /// Returns the parameters of `waveform`; none if it is not of this waveform family or is outside the bounds, up to rounding.
  [[nodiscard]] std::optional<std::vector<double>> parameters(const Waveform& waveform) const;
  /// Returns the parameters of this waveform family that approximate `waveform` best: least mean square difference of an
  /// electrode's squared voltage, or of the piezo's voltage, until a little after the last breakpoint. The result is exact for
  /// a waveform of this family.
  [[nodiscard]] std::vector<double> nearest(const Waveform& waveform) const;
  /// Returns the reason why a search cannot begin with a waveform, as text: another hold level, or values beyond the limits of
  /// the voltage source. Empty if the search can.
  [[nodiscard]] std::string misfit(const Waveform& waveform) const;
  /// True if a signal of this drive ends on its hold level, up to rounding.
  [[nodiscard]] bool holds(const Signal& signal) const;

 private:
  [[nodiscard]] bool is_within_bounds(const std::vector<double>& x) const;
};

class SearchSpace {
 public:
  /// `family` is the waveform family of all drives ("pulse", "knots:8") or of each drive ("main=step,pzt=pulse"; pulse for the
  /// others), and may name one of `own`. `first_touch` is the time of first contact under the plain step [s]. Throws
  /// InvalidInput if the scene lacks the drive or a piezo limit, if the family cannot be searched, for one of `own` whose
  /// starting waveform does not end on the hold level, and for quasi-static if no drive can move the switch to its contact.
  SearchSpace(const PreparedScene& prepared, Actuator actuator, const std::string& family, double first_touch,
              const OwnWaveforms& own = {});

  [[nodiscard]] const std::vector<DriveSearch>& drives() const { return drives_; }
  /// Returns the searched drive of this name, which must exist.
  [[nodiscard]] const DriveSearch& drive(const std::string& name) const;
  [[nodiscard]] std::vector<Variable> variables() const;
  [[nodiscard]] std::vector<std::vector<double>> starts() const;
  /// Returns the waveforms of the searched drives at the point `x` of the search space.
  [[nodiscard]] DriveWaveforms waveforms(std::span<const double> x) const;
  /// Returns the point of the search space that has the given waveforms, if this point exists: the start for refining an
  /// earlier result.
  [[nodiscard]] std::optional<std::vector<double>> parameters(const DriveWaveforms& waveforms) const;
  /// Returns the point of the search space whose waveforms differ least from the given ones, which may be of another family.
  /// misfit() of the given waveforms must be empty.
  [[nodiscard]] std::vector<double> nearest(const DriveWaveforms& waveforms) const;
  /// Returns the reason why a search cannot begin with the given waveforms, as text; empty if it can.
  [[nodiscard]] std::string misfit(const DriveWaveforms& waveforms) const;
  /// Returns the given waveforms, without those of drives that are not searched.
  [[nodiscard]] DriveWaveforms searched(const DriveWaveforms& waveforms) const;
  /// Returns the quasi-static approach, if the searched family is quasi-static; otherwise null.
  [[nodiscard]] const QuasiStatic* quasi_static() const { return joint_ ? &*joint_ : nullptr; }
  /// Returns the space of the quasi-static approach with bounds about its closed-form waveforms, under which devices carry a
  /// steady contact force from `steady` on [s].
  [[nodiscard]] SearchSpace paced(double steady) const;

 private:
  void add_quasi_static(const PreparedScene& prepared, Actuator actuator, const std::string& family, double first_touch);
  [[nodiscard]] std::vector<double> nearest_of_all(const DriveWaveforms& given) const;

  std::vector<DriveSearch> drives_;
  // The quasi-static approach, a waveform family that varies all drives together; none for other families.
  std::optional<QuasiStatic> joint_;
};

}  // namespace softland
