// How manufactured devices differ from the drawing: which numbers of a scene vary, how they are distributed, and how they depend
// on each other.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/units.h"
#include "sampling/copula.h"
#include "sampling/distribution.h"

namespace softland {

struct Scene;

/// An error of the source of a drive.
enum class DriveError {
  gain,    ///< factor of its volts, nominally 1
  offset,  ///< [V] from t = 0 on
  delay,   ///< [s] of the whole waveform
  jitter,  ///< [s] of every edge on its own
};

struct VariedDrive {
  std::string name;
  DriveError error;
};

/// A number of a scene that varies from device to device.
struct VariedKey {
  std::string path;            ///< "structure.thickness", "driver.main.gain"
  std::size_t element = 0;     ///< of a list, counted from 1; 0: it is none
  std::string unit;            ///< SI unit
  double nominal = 0;          ///< the scene's value
  Dimension measured_in = {};  ///< among the dimensions that the key may have
  double weight = 1;           ///< of an amount that is added to the value
  /// The member of a scene with the same sections. Null where the key sets no member by itself: then the scene has to be read
  /// anew with this value.
  std::function<double&(Scene&)> member;
  /// Of an error of a drive, which is no key of the scene and has no member.
  std::optional<VariedDrive> drive;
  /// Why a device cannot have this value; empty where it can.
  std::function<std::string(double)> refusal;

  /// "electrode.main.span[2]"
  [[nodiscard]] std::string name() const { return element == 0 ? path : path + "[" + std::to_string(element) + "]"; }
};

/// A quantity that varies, with the keys that follow it.
struct SpreadVariable {
  std::string name;  ///< of its entry in [spread]
  std::vector<VariedKey> keys;
  bool is_factor = true;  ///< it multiplies the scene's values; else it is the value of its one key, or
  bool is_added = false;  ///< is added to the scene's values, times the weights of the keys
  Distribution distribution;
  /// Of jitter: the distribution is that of every edge of every device. What a device has is a number in (0, 1), from which the
  /// generator draws for its edges.
  bool is_drawn_per_edge = false;

  /// What the scene itself has [SI unit, or factor].
  [[nodiscard]] double nominal() const { return is_factor ? 1 : is_added ? 0 : keys.front().nominal; }
};

struct DeviceSpread {
  std::vector<SpreadVariable> variables;  ///< by name
  Eigen::MatrixXd correlation;            ///< of the underlying normals, variables x variables
  std::optional<GaussianCopula> copula;   ///< none where all are independent

  [[nodiscard]] bool empty() const { return variables.empty(); }
  /// Whether there are errors of drives among what varies.
  [[nodiscard]] bool varies_drives() const;
  /// Takes a variable out, with its correlations.
  void leave_out(std::size_t variable);
  /// Gives the variables this correlation. Throws as GaussianCopula does.
  void correlate(const Eigen::MatrixXd& matrix);
  /// Turns a point of the open unit cube into values of the variables [SI unit, factor, or for jitter a number in (0, 1)], in
  /// place.
  void to_values(std::span<double> u) const;
  /// The value of a key where its variable has the value `x` [SI unit].
  [[nodiscard]] static double value(const SpreadVariable& variable, const VariedKey& key, double x) {
    if (variable.is_added) return key.nominal + key.weight * x;
    return variable.is_factor ? key.nominal * x : x;
  }
  /// The time by which an edge is late [s], where the value of its variable is `x`; edges are numbered over all drives.
  [[nodiscard]] static double jitter(const SpreadVariable& variable, double x, std::uint64_t edge);
};

namespace internal {

inline constexpr std::string_view correlation_key = "correlation";

}  // namespace internal
}  // namespace softland
