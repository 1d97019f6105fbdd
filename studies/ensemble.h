// Devices as they come from manufacturing: the switches of a scene's [spread], each a function of its number.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/watch.h"
#include "objectives/metrics.h"
#include "sampling/points.h"
#include "studies/prepared.h"

namespace softland {

/// One device of an ensemble.
struct SampledDevice {
  std::vector<double> values;   ///< of the varying quantities, in the order of the spread [SI unit, or factor]
  std::optional<Switch> model;  ///< none where no such device can be described
  std::string refusal;          ///< why
};

class Ensemble {
 public:
  /// Devices 0 to size - 1 of this scene, which keep the volts that its waveforms have on the nominal device. Keeps a reference
  /// to `nominal`. Throws InvalidInput where the scene has no [spread], and what SamplePoints throws.
  Ensemble(const Prepared& nominal, std::uint64_t size, std::uint64_t seed = 1, PointSet points = PointSet::sobol);

  [[nodiscard]] const Prepared& nominal() const { return *nominal_; }
  [[nodiscard]] std::uint64_t size() const { return points_.size(); }
  /// Of the varying quantities of device k.
  [[nodiscard]] std::vector<double> values(std::uint64_t k) const;
  /// Whether a key may vary that other members of a scene follow, so that each is read anew.
  [[nodiscard]] bool reads_anew() const { return reads_anew_; }
  /// The scene of that device alone, in volts and without [spread]: what `simulate` runs to the same figures.
  [[nodiscard]] SceneFile scene(const std::vector<double>& values) const;

 private:
  const Prepared* nominal_;
  SamplePoints points_;
  SceneFile resolved_;       // of the nominal device
  bool reads_anew_ = false;  // a key may vary that other members follow
};

/// Builds devices one after the other. Several threads have one each; a device is the same whatever was built before it.
class DeviceBuilder {
 public:
  /// Keeps a reference to `ensemble`.
  explicit DeviceBuilder(const Ensemble& ensemble) : ensemble_(&ensemble), scratch_(ensemble.nominal().scene) {}
  [[nodiscard]] SampledDevice device(std::uint64_t k) { return device(ensemble_->values(k)); }
  /// The device with these values of the varying quantities.
  [[nodiscard]] SampledDevice device(std::vector<double> values);

 private:
  void describe(SampledDevice& device);

  const Ensemble* ensemble_;
  Scene scratch_;  // whose varying numbers are those of the device built last
};

/// How the closing of one device ended.
struct DeviceOutcome {
  Metrics metrics;
  double largest_impact_velocity = Metrics::unset;  ///< of all touches [m/s]
  std::string failure = {};                         ///< why it has no figures: refused as a device, or not to be simulated

  /// Whether it closed and its closing could be followed to the end of the window.
  [[nodiscard]] bool closed() const { return failure.empty() && std::isfinite(metrics.major_bounce_height); }
};

struct EnsembleRun {
  double duration = 0;      ///< window [s]
  double tolerance = 1e-5;  ///< of the integrator: 95 % quantiles of B_H then move by less than 0.4 %
  int jobs = 1;             ///< threads; does not change the outcomes
};

/// The closings of all devices under these drives [V], those of the nominal device. Asked to stop, the outcomes are those of the
/// first devices.
[[nodiscard]] std::vector<DeviceOutcome> close_all(const Ensemble& ensemble, const std::vector<Signal>& drives,
                                                   const EnsembleRun& run, const Watch& watch = {});

}  // namespace softland
