// How manufactured devices differ from the drawing: which numbers of a scene vary, how they are distributed, and how they depend
// on each other.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sampling/copula.h"
#include "sampling/distribution.h"

namespace softland {

struct Scene;

/// A number of a scene that varies from device to device.
struct VariedKey {
  std::string path;    ///< "structure.thickness"
  std::string unit;    ///< SI unit
  double nominal = 0;  ///< the scene's value
  /// The member of a scene with the same sections. Null where the key sets no member by itself: then the scene has to be read
  /// anew with this value.
  std::function<double&(Scene&)> member;
  /// Why a device cannot have this value; empty where it can.
  std::function<std::string(double)> refusal;
};

/// A quantity that varies, with the keys that follow it.
struct SpreadVariable {
  std::string name;  ///< of its entry in [spread]
  std::vector<VariedKey> keys;
  bool is_factor = true;  ///< it multiplies the scene's values; else it is the value of its one key
  Distribution distribution;
};

struct DeviceSpread {
  std::vector<SpreadVariable> variables;  ///< by name
  Eigen::MatrixXd correlation;            ///< of the underlying normals, variables x variables
  std::optional<GaussianCopula> copula;   ///< none where all are independent

  [[nodiscard]] bool empty() const { return variables.empty(); }
  /// Turns a point of the open unit cube into values of the variables [SI unit, or factor], in place.
  void to_values(std::span<double> u) const;
  /// The value of a key where its variable has the value `x` [SI unit].
  [[nodiscard]] static double value(const SpreadVariable& variable, const VariedKey& key, double x) {
    return variable.is_factor ? key.nominal * x : x;
  }
};

namespace internal {

inline constexpr std::string_view correlation_key = "correlation";

}  // namespace internal
}  // namespace softland
