// Modes of a structure that another program computed, as a table along its axis, clamped at x = 0 and free or clamped at its
// far end.
//
//   q_i'' = -(f omega_i)^2 q_i + Q_i + ...      y(x) = sum over i of phi_i(x) q_i
//
// q_i is a modal coordinate, y the deflection [m]. phi_i are mass-normalised modes [kg^(-1/2)], given at the positions of the
// table, omega_i their angular frequencies [rad/s], f the ratio of a device's frequencies to those of the table. Between the
// positions phi_i is a cubic spline whose value and slope are 0 at x = 0 (base/clamped_spline.h). Q_i is the modal force of
// mid-plane stretching between two clamps (model/stretching.h), computed with the slopes of the splines and with the axial
// stiffness E A / L that a scene gives; the other modal forces follow. The modes have the interface of BeamModes, so that force
// laws per length act on the structure as on a beam. Without an axial stiffness the model is valid while deflections are small
// compared to the thickness, since the modes are linear. Source: modal superposition, any textbook on structural dynamics, e.g.
// Meirovitch, Fundamentals of Vibrations, 2001, ch. 7.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/clamped_spline.h"
#include "model/stretching.h"
#include "model/structure/kind.h"

namespace softland {

/// A table of vibration modes of a structure: the same table for all devices of a scene.
class ModalTable {
 public:
  /// Creates a table from at least three `positions` [m] that rise from 0, `frequencies` [Hz] that rise, and a mode shape
  /// [kg^(-1/2)] for each frequency. A shape has a value per position, 0 at the first position. `rest_offsets` [m] are heights
  /// of the structure's face at rest, positive towards the near electrode; one per position, or none for a straight structure.
  /// `widths` are linear between positions [m]: one per position, or none for a structure of constant width. A clamped far end
  /// must not move in any mode, and must have no slope in the first mode. Throws InvalidInput with the broken rule.
  ModalTable(std::vector<double> positions, std::vector<double> frequencies, std::vector<std::vector<double>> shapes,
             std::vector<double> rest_offsets = {}, std::vector<double> widths = {}, SplineEnd far_end = SplineEnd::free);

  [[nodiscard]] int count() const { return static_cast<int>(frequencies_.size()); }
  /// Returns the length of the structure, the last position of the table [m].
  [[nodiscard]] double length() const { return positions_.back(); }
  /// Returns the positions of the table along the structure [m].
  [[nodiscard]] const std::vector<double>& positions() const { return positions_; }
  /// Returns the frequencies of the modes in the table [Hz].
  [[nodiscard]] const std::vector<double>& frequencies() const { return frequencies_; }
  /// Returns the mass-normalised mode shapes at the positions of the table [kg^(-1/2)].
  [[nodiscard]] const std::vector<std::vector<double>>& shapes() const { return shapes_; }
  /// Returns the shape of a mode at the position x [m] along the structure [kg^(-1/2)].
  [[nodiscard]] double value(int mode, double x) const { return splines_[static_cast<std::size_t>(mode)].value(x); }
  [[nodiscard]] double slope(int mode, double x) const { return splines_[static_cast<std::size_t>(mode)].slope(x); }
  /// Returns the heights of the structure's face at rest at the positions of the table, positive towards the near electrode
  /// [m].
  [[nodiscard]] const std::vector<double>& rest_offsets() const { return rest_offsets_; }
  [[nodiscard]] const std::vector<double>& widths() const { return widths_; }  ///< widths at the positions of the table [m]
  /// Returns the distance at x [m] of the structure's face at rest from its height at the clamp, positive away from the near
  /// electrode [m]; linear between the positions of the table.
  [[nodiscard]] double rest_offset(double x) const;
  /// Returns the smallest value of rest_offset(x) along the structure [m].
  [[nodiscard]] double lowest_rest_offset() const;
  /// Returns true when no mode moves the last position of the table, so that the far end must be clamped.
  [[nodiscard]] bool is_held_at_both_ends() const;
  [[nodiscard]] bool has_far_clamp() const { return far_end_ == SplineEnd::clamped; }
  /// Returns the integrals of the products of the first modes' slopes, for mid-plane stretching: a matrix, column by column
  /// [1/(kg m)].
  [[nodiscard]] std::vector<double> slope_products(int modes) const;
  [[nodiscard]] bool operator==(const ModalTable& other) const {
    return positions_ == other.positions_ && frequencies_ == other.frequencies_ && shapes_ == other.shapes_ &&
           rest_offsets_ == other.rest_offsets_ && widths_ == other.widths_ && far_end_ == other.far_end_;
  }

 private:
  std::vector<double> positions_, frequencies_;
  std::vector<std::vector<double>> shapes_;
  std::vector<double> rest_offsets_, widths_;
  SplineEnd far_end_;
  std::vector<ClampedSpline> splines_;
};

class TabulatedModes {
 public:
  /// The shapes of the first modes of a table, as functions of x in units of the table's length.
  struct Shapes {
    std::shared_ptr<const ModalTable> table;
    int modes = 0;

    [[nodiscard]] Eigen::VectorXd value(double x) const;
    [[nodiscard]] Eigen::VectorXd slope(double x) const;
    /// Returns (omega_1 / omega)^2: omega_1 is the first angular frequency of the structure, omega the first of the structure
    /// that is also held at x, a share of the length. From all modes of the table, omega is the root of sum phi_i(x)^2 /
    /// (omega_i^2 - omega^2) between the first two frequencies. A table with a single mode cannot move when held at x: the
    /// result is then 1, since a rebound takes no longer than the free period. `near` is not used.
    [[nodiscard]] double pinned_inverse_square(double x, std::optional<double> near = {}) const;
    [[nodiscard]] bool operator==(const Shapes& other) const {
      return modes == other.modes && (table == other.table || (table && other.table && *table == *other.table));
    }
  };

  /// Uses the first `modes` modes of a table, with `frequency_factor` on their frequencies. Throws InvalidInput unless 1 <=
  /// modes <= table->count().
  TabulatedModes(std::shared_ptr<const ModalTable> table, int modes, double frequency_factor);

  /// Angular frequencies of the modes [rad/s].
  [[nodiscard]] const Eigen::VectorXd& angular_frequencies() const { return frequencies_; }
  [[nodiscard]] double length() const { return shapes_.table->length(); }  ///< length of the structure [m]
  [[nodiscard]] static double scale() { return 1; }
  [[nodiscard]] double frequency_scale() const { return frequencies_[0]; }  ///< angular frequency of the first mode [rad/s]
  [[nodiscard]] const Shapes* normalised() const { return &shapes_; }

 private:
  Shapes shapes_;
  Eigen::VectorXd frequencies_;
};

/// The parameters of the kind of structure "modes" in a scene: clamped at x = 0, and free or clamped at its far end.
struct ModalStructure {
  static constexpr std::string_view name = "modes", whose = "beside the modes of a file",
                                    length_is = "the {} of the modes' table",
                                    why_no_layer =
                                        "a layer changes the modes, which a file cannot follow; a layer needs a cantilever",
                                    why_no_skins = "skins change the modes, which a file cannot follow; a surface needs a beam";
  static constexpr std::array usual_spread{UsualSpread{"frequency_factor", "3.5 %", true}};

  std::shared_ptr<const ModalTable> table = {};
  double frequency_factor = 1;         ///< factor on the natural frequencies of the table
  double axial_stiffness = not_given;  ///< axial force per elongation between the clamps, E A / L of a uniform beam [N/m]

  /// Returns the scene-file keys of this kind of structure, except those of the file with the table (config/modal_table.h).
  template <class S>
  static consteval auto fields() {
    constexpr std::string_view follows_no_size = "the modes of a file do not follow it; vary structure.frequency_factor";
    // clang-format off
    return std::to_array<Field<S>>({
        S::damping(),
        {.key = "frequency_factor", .about = "of all natural frequencies, over those of the file; process variation and fit vary it", .in = within<S, ModalStructure, &ModalStructure::frequency_factor>, .range = {.least = 0.01, .most = 100}, .fallback = "1.0"},
        {.key = "axial_stiffness", .unit = "N/m", .about = "between two clamps: force per elongation, E A / L of an even beam; absent: stretching is not simulated, and a warning says so", .in = within<S, ModalStructure, &ModalStructure::axial_stiffness>, .such_as = "12 kN/m"},
        {.key = "width", .unit = "m", .about = "across the axis, the same everywhere; absent: that of the file, which may change along it", .in = reach<S, &S::width>, .why_fixed = follows_no_size},
        {.key = "thickness", .unit = "m", .about = "needed by the fringing laws meijs-fokkema and bao-2001 and by the gas model guo-alexeenko, and by nothing else", .in = reach<S, &S::thickness>, .why_fixed = follows_no_size},
        {.key = "modes", .about = "number of modes kept, at most those of the file; absent: all of the file", .count = reach<S, &S::modes>, .range = {.least = 1, .most = S::most_modes}},
    });
    // clang-format on
  }
  template <class S>
  [[nodiscard]] static S example() {
    return {.length = example_table()->length(),
            .width = 20e-6,
            .thickness = 2e-6,
            .modes = 2,
            .kind = ModalStructure{.table = example_table()}};
  }
  /// Returns a table for tests, with two modes of a beam as heavy as a gold cantilever.
  [[nodiscard]] static std::shared_ptr<const ModalTable> example_table();

  template <class Device, class Known>
  [[nodiscard]] TabulatedModes modes(const Device& device, const Known&) const {
    return {table, device.structure.modes, frequency_factor};
  }
  template <class Device>
  [[nodiscard]] std::string why_invalid(const Device& device) const {
    return why_invalid(device.structure.length, device.structure.modes);
  }
  template <class Device>
  [[nodiscard]] double rest_offset(const Device&, double x) const {
    return table->rest_offset(x);
  }
  template <class Device>
  [[nodiscard]] double lowest_rest_offset(const Device&) const {
    return table->lowest_rest_offset();
  }
  /// Returns the law of mid-plane stretching; empty when the scene gives no axial stiffness.
  template <class S>
  [[nodiscard]] std::optional<MidPlaneStretching> stretching(const TabulatedModes& modes, const S&) const {
    if (std::isnan(axial_stiffness)) return std::nullopt;
    const auto count = static_cast<int>(modes.angular_frequencies().size());
    return MidPlaneStretching{
        .modes = static_cast<std::size_t>(count), .slopes = table->slope_products(count), .stiffness = axial_stiffness / 2};
  }
  [[nodiscard]] std::string why_invalid(double length, int modes) const;
  [[nodiscard]] int most_modes() const;
};

}  // namespace softland
