// Closings of many switches at once, one in each lane of the processor's vector (SIMD) registers: the devices of an ensemble
// have different parameters, but need almost the same operations. Every lane has its own parameters, drives, time step and
// events, and receives the next switch when its closing has ended. The method is that of one closing (integrators/lawson.h,
// model/closing.h), so the figures agree within the tolerance.
//
// In every round all lanes attempt one step: six evaluations of the equations of motion, each for as many switches as there are
// lanes. A lane whose step crosses the contact plane repeats this step up to the crossing in the next round. A lane whose
// drives enter new pieces spends a round on a step of no length, which computes its new accelerations. So no lane waits for
// another, and no lane depends on the others: results have the same bits whatever the order and the number of lanes.
//
// Limits: some laws are not written for lanes (why_not_in_lanes()), the energy balance is not audited, and a closing with a
// numerical problem ends early. simulate_closing() handles all of these closings, one at a time.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/choice.h"
#include "model/switch.h"
#include "model/trajectory.h"
#include "waveforms/signal.h"

namespace softland {

/// The vector (SIMD) instructions with which several closings are simulated at once; `none`: one closing at a time.
enum class Vectors { none, avx2, avx512 };
struct VectorsRow {
  Vectors value;
  std::string_view name;
  int lanes;  ///< number of closings that the instructions simulate at once
};
inline constexpr auto vector_instructions =
    std::to_array<VectorsRow>({{Vectors::none, "none", 1}, {Vectors::avx2, "avx2", 4}, {Vectors::avx512, "avx512", 8}});
static_assert(is_complete<vector_instructions>());

/// Returns true when this processor and this build of softland have these vector instructions.
[[nodiscard]] bool has(Vectors vectors);
/// Returns the widest vector instructions that this processor has, or the narrower ones that the environment variable
/// SOFTLAND_VECTORS requests. Throws InvalidInput when the value is not a name of Vectors, or this processor lacks the
/// instructions.
[[nodiscard]] Vectors vectors_in_use();

/// Receives touches (intervals in contact) and rebounds of a closing that is simulated in one SIMD lane.
class LandingObserver {
 public:
  /// Receives a touch (interval in contact) when the contact has opened; a touch that has not ended at the end of the run has
  /// the end NaN. For several contacts the touch is one of their connection (model/closing/connection.h), and is passed on when
  /// the next touch begins, or at the end of the run.
  virtual void touch(const Touch& touch) = 0;
  /// Receives a separation of the contact after the first touch: begin [s], end [s] and height [m]. The end is NaN for a
  /// separation that has not ended at the end of the run.
  virtual void rebound(double begin, double end, double height) = 0;

 protected:
  LandingObserver() = default;
  ~LandingObserver() = default;
  LandingObserver(const LandingObserver&) = default;
  LandingObserver& operator=(const LandingObserver&) = default;
};

/// A closing to be simulated in a SIMD lane. The members after_contact, no_end_before, no_contact_before (times at which a run
/// ends) and steady_force have the meaning of those of ClosingOptions.
struct EnsembleClosing {
  const Switch* model = nullptr;
  std::span<const Signal> drives;
  std::span<const double> gains = {};  ///< factors on the voltages of the drives; 1 if empty
  double duration = 0;                 ///< length of the simulated time window [s]
  double after_contact = std::numeric_limits<double>::infinity(), no_end_before = 0;
  double no_contact_before = std::numeric_limits<double>::infinity();
  double steady_force = std::numeric_limits<double>::quiet_NaN();  ///< force of a settled contact [N]
  bool measures_drive_energy = false;
  LandingObserver* observer = nullptr;
};

/// The result of a closing in a SIMD lane. When `followed` is false, the closing was not simulated to its end: simulate it with
/// simulate_closing(). EnsembleClosing::observer may have received touches and rebounds up to the failure.
struct EnsembleEnd {
  bool followed = false;
  double time = 0;  ///< time at which the simulation ended [s]
  ForceOutcome force = {};
  double drive_energy = std::numeric_limits<double>::quiet_NaN();  ///< energy from the sources; NaN if not computed [J]
  FirstTouch first_touch = {};  ///< first touch of any contact of the connection, for several contacts
};

/// Returns the reason why closings of this switch cannot be simulated several at once in SIMD lanes; empty when they can.
[[nodiscard]] std::string why_not_in_lanes(const Switch& model);

/// Simulates all closings in SIMD lanes and returns their results in order; `tolerance` as in ClosingOptions. Closings that are
/// not simulated have EnsembleEnd::followed = false: all closings with Vectors::none, closings that SIMD lanes do not support,
/// and closings whose switch differs from the first switch in its LaneLayout.
[[nodiscard]] std::vector<EnsembleEnd> close_in_lanes(std::span<const EnsembleClosing> closings, double tolerance,
                                                      Vectors vectors);

}  // namespace softland
