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

/// An error of the source of a drive.
enum class DriveError {
  gain,    ///< gain of the source, nominally 1
  offset,  ///< offset from t = 0 on [V]
  delay,   ///< delay of the whole waveform [s]
  jitter,  ///< random delay of every single edge [s]
};

struct VariedDrive {
  std::string name;
  DriveError error;
};

/// A number of a scene that varies from device to device.
struct VariedKey {
  std::string path;            ///< path of the key: "structure.thickness", "driver.main.gain"
  std::size_t element = 0;     ///< element of a list that varies, counted from 1; 0 for a key without a list
  std::string unit;            ///< SI unit
  double nominal = 0;          ///< value of the key in the scene
  Dimension measured_in = {};  ///< dimension of the varied values, one of those that the key may have
  double weight = 1;           ///< weight of an amount that is added to the value
  /// Returns the number in a scene that the key sets. Null if the key does not set a single number; the scene must then be read
  /// again with the new value.
  std::function<double&(Scene&)> member;
  /// Error of the source of a drive, if the varied number is such an error; Scene has no member for it.
  std::optional<VariedDrive> drive;
  /// Returns the reason why a device cannot have this value; empty where the value is valid.
  std::function<std::string(double)> refusal;

  /// Returns for example "electrode.main.span[2]".
  [[nodiscard]] std::string name() const { return element == 0 ? path : path + "[" + std::to_string(element) + "]"; }
};

/// A quantity that varies from device to device, with the keys whose values it sets.
struct SpreadVariable {
  std::string name;  ///< name of its entry in [spread]
  std::vector<VariedKey> keys;
  bool is_factor = true;  ///< true: multiplies the values of the scene; false, unless is_added: replaces the value of its one key
  bool is_added = false;  ///< true: is added to the values of the scene, multiplied by the weights of the keys
  Distribution distribution;
  /// True for jitter, which has a random value for every edge of every device. The value of the variable for a device is then a
  /// number in (0, 1) that seeds the random numbers of its edges.
  bool is_drawn_per_edge = false;

  /// Returns the value of the variable in the nominal design [SI unit, or factor].
  [[nodiscard]] double nominal() const { return is_factor ? 1 : is_added ? 0 : keys.front().nominal; }
};

struct DeviceSpread {
  std::vector<SpreadVariable> variables;  ///< varied quantities, by name
  Eigen::MatrixXd correlation;            ///< correlation matrix of the normal variables of the copula, variables x variables
  std::optional<GaussianCopula> copula;   ///< copula of the variables; none where all are independent

  [[nodiscard]] bool empty() const { return variables.empty(); }
  /// True when errors of drives are among the variables.
  [[nodiscard]] bool varies_drives() const;
  /// Removes a variable and its correlations.
  void leave_out(std::size_t variable);
  /// Gives the variables this correlation. Throws as GaussianCopula does.
  void correlate(const Eigen::MatrixXd& matrix);
  /// Turns a point of the open unit cube into values of the variables [SI unit, factor, or for jitter a number in (0, 1)], in
  /// place.
  void to_values(std::span<double> u) const;
  /// Returns the value of a key if its variable has the value `x` [SI unit].
  [[nodiscard]] static double value(const SpreadVariable& variable, const VariedKey& key, double x) {
    if (variable.is_added) return key.nominal + key.weight * x;
    return variable.is_factor ? key.nominal * x : x;
  }
  /// Returns the delay of an edge [s] if its variable has the value `x`; edges are numbered over all drives.
  [[nodiscard]] static double jitter(const SpreadVariable& variable, double x, std::uint64_t edge);
};

namespace internal {

inline constexpr std::string_view correlation_key = "correlation";

}  // namespace internal
}  // namespace softland
