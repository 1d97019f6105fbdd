// What a report shows of the resolved scene that its record holds.
#pragma once

#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "objectives/metrics.h"

namespace softland {

/// What the source of a drive can do; NaN where the scene sets no limit.
struct DriveLimits {
  double lowest = Metrics::unset, highest = Metrics::unset;  ///< [V]
  double slew = Metrics::unset;                              ///< [V/s]
};

/// What a report shows of the scene.
struct DrawnScene {
  using Span = std::optional<std::array<double, 2>>;  ///< from the clamped end [m]
  struct Piezo {
    Span span;
  };
  struct Electrode {
    std::string name;
    Span span;
    bool far_side = false;
    double gap = Metrics::unset;  ///< [m]
  };
  struct Contact {
    std::string name;
    double at = Metrics::unset;   ///< from the clamped end [m]; NaN: at the tip, or in the middle
    double gap = Metrics::unset;  ///< [m]
    bool far_side = false;
  };
  struct Waveform {
    std::string family;
    std::vector<double> times;                                                   ///< [s]
    double edge = Metrics::unset, start = Metrics::unset, end = Metrics::unset;  ///< [s]
  };

  std::string structure;                                                ///< "cantilever"; empty: not known
  double length = Metrics::unset;                                       ///< [m]
  double electrode_gap = Metrics::unset, contact_gap = Metrics::unset;  ///< [m]
  double pad_length = Metrics::unset;                                   ///< [m]
  std::optional<Piezo> piezo;
  std::vector<Electrode> electrodes;
  std::vector<Contact> contacts;              ///< where they have names
  std::map<std::string, Waveform> waveforms;  ///< by drive
  std::map<std::string, DriveLimits> drivers;
  double significant_rebound = MetricsOptions{}.significant_rebound;  ///< [m]
};

/// Every part is optional: what is missing, null or of another type is not available.
[[nodiscard]] DrawnScene read_drawn_scene(const nlohmann::json& scene);

}  // namespace softland
