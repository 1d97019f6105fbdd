// Process variation: how manufactured devices differ from the nominal design. The section [spread] lists the varied numbers of
// a scene, their distributions, and their correlations.
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

/// An error of the voltage source of a drive that varies from device to device.
enum class DriveError {
  gain,    ///< gain of the voltage source, nominally 1
  offset,  ///< voltage that the source adds from t = 0 on [V]
  delay,   ///< delay of the whole waveform of the source [s]
  jitter,  ///< random delay of every single edge of the waveform [s]
};

struct VariedDrive {
  std::string name;
  DriveError error;
};

/// A number of a scene that varies from device to device.
struct VariedKey {
  std::string path;            ///< path of the varied key: "structure.thickness", "driver.main.gain"
  std::size_t element = 0;     ///< number of the list element that varies, from 1; 0 for a key without a list
  std::string unit;            ///< SI unit of the varied key
  double nominal = 0;          ///< value of the varied key in the scene, the nominal design
  Dimension measured_in = {};  ///< dimension in which the key varies, one of those that the key may have
  double weight = 1;           ///< if SpreadVariable::is_added: factor on the amount that is added to the nominal value
  /// Returns the member of a scene that the varied key sets. Null if the key does not set a single number: the scene of a
  /// device must then be read from its text with the device's value.
  std::function<double&(Scene&)> member;
  /// Error of a drive's voltage source, if the varied number is such an error; Scene has no member for it.
  std::optional<VariedDrive> drive;
  /// Returns the reason why a device cannot have this value of the varied key; empty if the value is valid.
  std::function<std::string(double)> refusal;

  /// Returns the name of the varied number, for example "electrode.main.span[2]".
  [[nodiscard]] std::string name() const { return element == 0 ? path : path + "[" + std::to_string(element) + "]"; }
};

/// A quantity that varies from device to device, with the keys whose values it sets.
struct SpreadVariable {
  std::string name;  ///< name of the quantity's entry in [spread]
  std::vector<VariedKey> keys;
  /// true: the variable multiplies the values of its keys; false, unless is_added: the keys take the variable's value.
  bool is_factor = true;
  bool is_added = false;  ///< true: the variable times the weight of each key is added to the key's value
  Distribution distribution;
  /// True for jitter, which has a random value for every edge of every device. The value of the variable for a device is then a
  /// number in (0, 1) that seeds the random numbers of the edges.
  bool is_drawn_per_edge = false;

  /// Returns the value of the varied quantity in the nominal design [SI unit, or factor].
  [[nodiscard]] double nominal() const { return is_factor ? 1 : is_added ? 0 : keys.front().nominal; }
};

struct DeviceSpread {
  std::vector<SpreadVariable> variables;  ///< varied quantities, sorted by name
  Eigen::MatrixXd correlation;            ///< correlation matrix of the copula's normal variables, one row per varied quantity
  std::optional<GaussianCopula> copula;   ///< Gaussian copula of the varied quantities; none where all are independent

  [[nodiscard]] bool empty() const { return variables.empty(); }
  /// Returns true when errors of the drives' voltage sources vary.
  [[nodiscard]] bool varies_drives() const;
  /// Removes a varied quantity and its correlations, so that the quantity no longer varies.
  void leave_out(std::size_t variable);
  /// Sets the correlation matrix of the varied quantities. Throws InvalidParameter as GaussianCopula does.
  void correlate(const Eigen::MatrixXd& matrix);
  /// Turns a point of the open unit cube into values of the varied quantities [SI unit, factor, or for jitter a number in (0,
  /// 1)], in place.
  void to_values(std::span<double> u) const;
  /// Returns the value of a varied key [SI unit] on a device whose value of the variable is `x`.
  [[nodiscard]] static double value(const SpreadVariable& variable, const VariedKey& key, double x) {
    if (variable.is_added) return key.nominal + key.weight * x;
    return variable.is_factor ? key.nominal * x : x;
  }
  /// Returns the random delay [s] of an edge of a waveform on a device whose value of the jitter variable is `x`. `edge`
  /// numbers the edges of all drives.
  [[nodiscard]] static double jitter(const SpreadVariable& variable, double x, std::uint64_t edge);
};

namespace internal {

inline constexpr std::string_view correlation_key = "correlation";

}  // namespace internal
}  // namespace softland
