// The data that ensemble_closings.cc passes to the simulation of closings in SIMD lanes, as plain numbers. This simulation is
// compiled once for each set of vector instructions. Its code must contain no inline function that the linker could use for the
// rest of the program, since not every processor can run it.
#pragma once

#include <cstddef>

#include "model/trajectory.h"

namespace softland {
enum class Vectors;  // defined in model/ensemble/ensemble_closings.h
}

namespace softland::simd {

inline constexpr int most_modes = 8, most_points = 48, most_drives = 6, most_segments = most_points;
inline constexpr int most_contacts = 4;
inline constexpr int usual_modes = 4;  ///< largest number of modes for UsualLaws (lane_laws.h)
/// Largest number of parameters of a gas or contact law: of all members of the law, which have the type of its parameters.
inline constexpr int most_parameters = 8;

enum class LaneFringing { none, linear, meijs_fokkema };
enum class LaneDispersion { none, van_der_waals, casimir, smaller };

/// Quadrature points from `begin` up to `end` that are over the same electrode, or all over none.
struct Segment {
  int begin = 0, end = 0;
  int electrode = -1;  ///< number of the electrode; -1 without an electrode
  LaneFringing fringing = LaneFringing::none;
  bool far = false;  ///< true for an electrode on the far side
  int stretch = 0;   ///< index of the PointStretch that contains these points; only for UsualLaws
  [[nodiscard]] bool operator==(const Segment&) const = default;
};

/// Range of quadrature points, from `begin` up to `end`, in which the beam has one width and thickness.
struct PointStretch {
  int begin = 0, end = 0;
  [[nodiscard]] bool operator==(const PointStretch&) const = default;
};

/// The kind of one contact, equal for all switches that are simulated together in SIMD lanes.
struct LaneContactKind {
  int law = -1;  ///< index of the law without damping and memory in InvertibleContactLaw
  bool damped = false;
  bool remembers = false;  ///< true when loading and unloading of the contact have different stiffness
  bool near = true;        ///< true for a contact on the side of the electrode; false for a back stop
  bool connects = true;    ///< true when the contact is part of the electrical connection of several contacts
  [[nodiscard]] bool operator==(const LaneContactKind&) const = default;
};

/// The structure of the switches (kinds of laws, numbers of parts), equal for all switches that are simulated together in SIMD
/// lanes.
struct LaneLayout {
  /// True when UsualLaws computes the forces; the segments then follow each other along the beam. Otherwise each segment is an
  /// electrode pad, and pads may share points.
  bool usual = true;
  int modes = 0, points = 0, segments = 0, electrodes = 0, drives = 0;
  bool piezo = false, stretching = false;
  LaneFringing fringing = LaneFringing::none;  ///< fringing law of all electrodes; only for UsualLaws
  int film = -1;                               ///< index of the gas law in GasLaw; -1 without gas
  bool far_film = false;
  LaneDispersion dispersion = LaneDispersion::none;
  int contacts = 1;
  LaneContactKind contact[most_contacts];
  bool needs_all = true;       ///< true when the connection is closed while all of its contacts are closed; false: while any is
  bool measures_work = false;  ///< true when the work of the drives is computed; not with UsualLaws
  Segment segment[most_segments];
  int stretches = 1;  ///< number of elements of `stretch`; one per quadrature point where the width changes linearly
  PointStretch stretch[most_points];
  [[nodiscard]] bool operator==(const LaneLayout&) const = default;
};

/// One contact of one switch in a SIMD lane, as plain numbers.
struct LaneContactNumbers {
  double plane = 0;                  // distance of the contact from its plane at rest [m]
  double shape[most_modes] = {};     // mode shapes at the contact, positive towards its plane [kg^(-1/2)]
  double law[most_parameters] = {};  // parameters of the law without damping and memory
  double damping = 0;                // damping constant of the contact [s/m]
  // Stiffness of a law with memory while loading and while unloading [N/m].
  double loading_stiffness = 0, unloading_stiffness = 0;
  double negligible_depth = 0;  // distance from the contact plane at which a step counts as ending on the plane [m]
};

/// One switch in a SIMD lane, as plain numbers. Entries of modes that the switch does not have are 0.
struct LaneSwitch {
  int modes = 0;
  double open = 0, floor = 0;     // largest gap at rest; gap below which a run fails [m]
  double omega[most_modes] = {};  // angular frequencies of the modes [rad/s]
  // Piezo force per volt [N kg^(-1/2) / V] and damping [1/s] of each mode.
  double piezo[most_modes] = {}, friction[most_modes] = {};
  double shape[most_points][most_modes] = {}, weight[most_points] = {};  // mode shapes [kg^(-1/2)] and quadrature weights [m]
  double rest_gap[most_points] = {};                                     // gap to the electrode at rest [m]
  // Absolute tolerances of modal coordinates in flight and in contact.
  double flying[most_modes] = {}, touching[most_modes] = {};
  double speed[most_modes] = {};                                // absolute tolerances of the modal velocities
  double width[most_points] = {}, thickness[most_points] = {};  // size of the beam in each PointStretch [m]
  double film[most_points][most_parameters] = {};               // parameters of the gas law in each PointStretch
  // Sum of the gaps on the near and the far side of the beam [m], from which the far gap follows; for each electrode on the far
  // side, and for a gas film there.
  double electrode_gaps[most_drives] = {}, film_gaps = 0;
  // Gap on the far side below which a run fails [m], for each electrode there and for the gas film.
  double electrode_floor[most_drives] = {}, film_floor = 0;
  double most_gap = 0;  // gap on the near side above which a far gap is too small [m]
  // Dispersion force: Hamaker constant [J], equilibrium distance [m], gap from which on the Casimir law replaces that of van
  // der Waals [m].
  double hamaker_constant = 0, equilibrium_distance = 0, crossover = 0;
  double tension = 0;  // stiffness of mid-plane stretching [N/m]
  // Integrals of the products of mode slopes, for mid-plane stretching [1/(kg m)].
  double slopes[most_modes][most_modes] = {};
  LaneContactNumbers contact[most_contacts];
};

/// Receives the touches (intervals in contact) and rebounds of a closing in a SIMD lane.
class LaneObserver {
 public:
  /// Receives a touch of a contact when it has ended: begin and end [s], impact velocity [m/s], largest interference [m]; for a
  /// damped contact also the largest force [N].
  virtual void touch(int contact, double begin, double end, double speed, double depth, double force) = 0;
  /// Receives a closing of the connection of several contacts: time [s], speed of the contact that closes it [m/s].
  virtual void closes(double time, double speed) = 0;
  /// Receives an opening of the connection of several contacts: time [s].
  virtual void opens(double time) = 0;
  /// Receives a rebound of the contact, or of the connection of several contacts: begin [s], end [s], height [m].
  virtual void rebound(double begin, double end, double height) = 0;

 protected:
  LaneObserver() = default;
  ~LaneObserver() = default;
  LaneObserver(const LaneObserver&) = default;
  LaneObserver& operator=(const LaneObserver&) = default;
};

/// A piece of a drive's voltage signal, as waveforms/pieces.h, but with a cubic polynomial and exponentials as its only terms:
///   value + slope s + square s^2 + cube s^3 + sum over tails of tail exp(-decay s)
///     + [amplitude + amplitude_slope s] sin(angular_frequency t + phase),  s = t - begin
struct LanePiece {
  static constexpr int most_tails = 2;
  double begin = 0;  // time at which the piece begins [s]
  // Coefficients of the voltage's cubic polynomial [V], [V/s], [V/s^2], [V/s^3].
  double value = 0, slope = 0, square = 0, cube = 0;
  double tail[most_tails] = {}, decay[most_tails] = {};  // exponentials: initial value [V] and decay rate [1/s]
  // sine: amplitude [V], its rate [V/s], frequency [rad/s], phase [rad].
  double amplitude = 0, amplitude_slope = 0, angular_frequency = 0, phase = 0;
  double longest_step = 0;  // longest integration step that resolves the piece [s]
  // True when the piece continues the previous one with equal voltage and slope, so that an integration step may cross its
  // beginning.
  bool joins = false;
};

struct LaneClosing {
  const LaneSwitch* numbers = nullptr;
  double start[most_modes] = {};              // modal coordinates at t = 0
  double final[most_modes] = {};              // modal coordinates at the end of the run
  double work = 0;                            // work of the drives on the modes, if LaneLayout::measures_work [J]
  const LanePiece* pieces[most_drives] = {};  // voltage pieces of each drive
  int piece_count[most_drives] = {};
  double gain[most_drives] = {};  // factor on the voltages of each drive
  double duration = 0, after_contact = 0, no_end_before = 0, no_contact_before = 0;
  // Interference at which each contact's static force is EnsembleClosing::steady_force [m]; infinite if that is not given.
  double steady_depth[most_contacts] = {};
  LaneObserver* observer = nullptr;
  bool followed = false;
  double end = 0;
  /// Outcome of each contact, without its least force. This follows from the least interference after the first maximum of the
  /// force [m], which is NaN without a touch.
  ForceOutcome force[most_contacts] = {};
  double least_depth[most_contacts] = {};
};

using LaneRunner = void (*)(const LaneLayout& layout, LaneClosing* closings, std::size_t count);
void run_avx2(const LaneLayout& layout, LaneClosing* closings, std::size_t count);
void run_avx512(const LaneLayout& layout, LaneClosing* closings, std::size_t count);
/// Returns the function that simulates closings with these vector instructions; null when this build does not have them.
[[nodiscard]] LaneRunner lane_runner(Vectors vectors);

}  // namespace softland::simd
