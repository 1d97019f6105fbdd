// What fleet.cc hands to the code that is compiled for each set of vector instructions: numbers only. That code must leave no
// function behind that the rest of the program could be linked to, since not every processor can run it.
#pragma once

#include <cstddef>

#include "waveforms/pieces.h"

namespace softland::fleet {

inline constexpr int most_modes = 4, most_points = 48, most_drives = 6, most_segments = 2 * most_drives + 1;

enum class LaneFringing { none, linear, meijs_fokkema };

/// Quadrature points from `begin` up to `end` that lie over the same electrode.
struct Segment {
  int begin = 0, end = 0;
  int electrode = -1;  ///< -1: over none
  [[nodiscard]] bool operator==(const Segment&) const = default;
};

/// What the lanes of a run have in common.
struct LaneLayout {
  int points = 0, segments = 0, electrodes = 0;
  bool piezo = false, film = false;
  LaneFringing fringing = LaneFringing::none;
  Segment segment[most_segments];
  [[nodiscard]] bool operator==(const LaneLayout&) const = default;
};

/// One switch as numbers. Modes that it does not have stand still.
struct LaneSwitch {
  int modes = 0;
  double open = 0, plane = 0, floor = 0;                                 // [m]
  double omega[most_modes] = {}, at_contact[most_modes] = {};            // [rad/s], [kg^(-1/2)]
  double piezo[most_modes] = {}, friction[most_modes] = {};              // [N kg^(-1/2) / V], [1/s]
  double shape[most_points][most_modes] = {}, weight[most_points] = {};  // [kg^(-1/2)], [m]
  double flying[most_modes] = {}, touching[most_modes] = {};             // absolute tolerances of coordinates
  double speed[most_modes] = {};                                         // and of velocities
  double width = 0, thickness = 0, viscosity = 0;                        // [m], [m], [Pa s]
  double strength = 0, height = 0;                                       // of the contact law
  double negligible_depth = 0;                                           // [m]
};

/// Where a lane tells what it sees.
class LaneObserver {
 public:
  /// [s], [s], [m/s], [m]
  virtual void touch(double begin, double end, double speed, double depth) = 0;
  virtual void rebound(double begin, double end, double height) = 0;

 protected:
  LaneObserver() = default;
  ~LaneObserver() = default;
  LaneObserver(const LaneObserver&) = default;
  LaneObserver& operator=(const LaneObserver&) = default;
};

struct LaneClosing {
  const LaneSwitch* numbers = nullptr;
  double start[most_modes] = {};                          // modal coordinates at t = 0
  const SignalPieceOf<double>* pieces[most_drives] = {};  // by drive
  const double* longest_step[most_drives] = {};           // that resolves a piece [s]
  int piece_count[most_drives] = {};
  double duration = 0, after_contact = 0, no_end_before = 0, no_contact_before = 0;
  double steady_depth = 0;  // that carries the steady force; infinite: none was asked for [m]
  LaneObserver* observer = nullptr;
  bool followed = false;
  double end = 0;
  double steady_from = 0, least_depth = 0;  // NaN where nothing touched, or it is not steady at the end [s], [m]
};

using LaneRunner = void (*)(const LaneLayout& layout, LaneClosing* closings, std::size_t count);
void run_avx2(const LaneLayout& layout, LaneClosing* closings, std::size_t count);
void run_avx512(const LaneLayout& layout, LaneClosing* closings, std::size_t count);

}  // namespace softland::fleet
