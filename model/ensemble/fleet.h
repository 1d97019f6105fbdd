// Closings of many switches at once, one to a lane of the machine's vector registers: the devices of an ensemble differ in their
// numbers, hardly in what they do. Every lane has its own parameters, drives, time step and events, and is given the next switch
// when it is done. The method is that of one closing (integrators/lawson.h, model/closing.h), so the figures are the same but for
// what the tolerance leaves open.
//
// All lanes make one attempt at a step in every round: six right-hand sides for as many switches as there are lanes. A lane whose
// step crosses the contact plane repeats it up to the crossing in the next round; one whose drives enter new pieces spends a
// round at a step of no length, which gives it the accelerations it goes on with. So no lane waits for another, and what happens
// in one does not depend on the company it keeps: outcomes are the same bits whatever the order and the number of lanes.
//
// Some laws are not written for lanes (why_not_in_lanes()), energies are not audited, and a lane that gets into trouble gives up:
// all of these are for simulate_closing(), one at a time.
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

/// The vector instructions that closings run with; `none`: one closing at a time.
enum class Vectors { none, avx2, avx512 };
struct VectorsRow {
  Vectors value;
  std::string_view name;
  int lanes;  ///< closings at once
};
inline constexpr auto vector_instructions =
    std::to_array<VectorsRow>({{Vectors::none, "none", 1}, {Vectors::avx2, "avx2", 4}, {Vectors::avx512, "avx512", 8}});
static_assert(is_complete<vector_instructions>());

/// Whether this processor, and this build, have them.
[[nodiscard]] bool has(Vectors vectors);
/// The widest that this processor has, or the narrower ones that the environment variable SOFTLAND_VECTORS asks for. Throws
/// InvalidInput where that names none, or some that this processor does not have.
[[nodiscard]] Vectors vectors_in_use();

/// Who receives the landing of one lane.
class LandingObserver {
 public:
  /// A touch that is over, or at the end of the run the one that holds, whose end is NaN. Of several contacts it is one of the
  /// connection that they make (model/closing/connection.h), and is told when the next one begins, or at the end.
  virtual void touch(const Touch& touch) = 0;
  /// A separation after the first touch that is over, or under way at the end of the run: its end is NaN then [s], [s], [m].
  virtual void rebound(double begin, double end, double height) = 0;

 protected:
  LandingObserver() = default;
  ~LandingObserver() = default;
  LandingObserver(const LandingObserver&) = default;
  LandingObserver& operator=(const LandingObserver&) = default;
};

/// A closing to be followed; limits as in ClosingOptions.
struct FleetClosing {
  const Switch* model = nullptr;
  std::span<const Signal> drives;
  std::span<const double> gains = {};  ///< of these drives; none: 1
  double duration = 0;                 ///< [s]
  double after_contact = std::numeric_limits<double>::infinity(), no_end_before = 0;
  double no_contact_before = std::numeric_limits<double>::infinity();
  double steady_force = std::numeric_limits<double>::quiet_NaN();  ///< [N]
  bool measures_drive_energy = false;
  LandingObserver* observer = nullptr;
};

/// What became of it. One that was not followed to its end has to be run by simulate_closing(); its observer has then been told a
/// part of it.
struct FleetEnd {
  bool followed = false;
  double time = 0;  ///< [s]
  /// As in Trajectory [s], [N]
  double steady_force_time = std::numeric_limits<double>::quiet_NaN(),
         least_force_after_touch = std::numeric_limits<double>::quiet_NaN();
  double drive_energy = std::numeric_limits<double>::quiet_NaN();  ///< EnergyBalance::source_work and Trajectory::layer_energy,
                                                                   ///< where it is measured [J]
  /// Of several contacts, as in Trajectory [s], [m/s]
  double first_touch = std::numeric_limits<double>::quiet_NaN(), first_touch_velocity = std::numeric_limits<double>::quiet_NaN();
};

/// Why closings of this switch are not followed in lanes; empty where they are.
[[nodiscard]] std::string why_not_in_lanes(const Switch& model);

/// All of them, in order; `tolerance` as in ClosingOptions. `vectors`: none follows nothing. Switches whose quadrature points or
/// drives are others than those of the first one are not followed.
[[nodiscard]] std::vector<FleetEnd> close_in_lanes(std::span<const FleetClosing> closings, double tolerance, Vectors vectors);

}  // namespace softland
