// The parts of a resolved scene that reports show.
#pragma once

#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "objectives/metrics.h"

namespace softland {

/// The limits of the voltage source of an electrode or a piezo; a limit that the scene does not set is NaN.
struct DriveLimits {
  double lowest = Metrics::unset, highest = Metrics::unset;  ///< lowest and highest voltage that the source permits [V]
  double slew = Metrics::unset;                              ///< largest slew rate that the source permits [V/s]
};

/// A kind of structure for a drawing from the side.
enum class SideOfStructure {
  unknown,            ///< a structure of unknown shape
  held_at_one_end,    ///< a beam clamped at one end
  held_at_both_ends,  ///< a beam clamped at both ends
  on_springs,         ///< a rigid plate on springs
};
/// Returns the kind of a structure with this name in scenes.
[[nodiscard]] SideOfStructure side_of_structure(std::string_view kind);

/// The parts of a scene that reports show.
struct DrawnScene {
  /// Begin and end of a part of the beam: distances from the clamped end [m].
  using Span = std::optional<std::array<double, 2>>;
  struct Piezo {
    Span span;
  };
  struct Electrode {
    std::string name;
    Span span;
    bool far_side = false;
    double gap = Metrics::unset;  ///< rest gap of the electrode [m]
  };
  struct Contact {
    std::string name;
    /// Distance of the contact from the clamped end [m]; NaN: tip, or middle of a plate or of a beam with two clamps.
    double at = Metrics::unset;
    double gap = Metrics::unset;  ///< rest gap of the contact [m]
    bool far_side = false;
  };
  struct Waveform {
    std::string family;
    std::vector<double> times;  ///< switching times of the waveform family `pulse` [s]
    /// Duration of an edge (ramp) of the waveform; start and end of the waveform [s].
    double edge = Metrics::unset, start = Metrics::unset, end = Metrics::unset;
  };

  SideOfStructure structure = SideOfStructure::unknown;
  double length = Metrics::unset;  ///< length of the structure [m]
  /// Rest gap of the electrode and rest gap of the contact [m].
  double electrode_gap = Metrics::unset, contact_gap = Metrics::unset;
  double pad_length = Metrics::unset;  ///< length of the contact pad [m]
  std::optional<Piezo> piezo;
  std::vector<Electrode> electrodes;
  std::vector<Contact> contacts;              ///< contacts that have names
  std::map<std::string, Waveform> waveforms;  ///< waveforms by name of the electrode, piezo or dispersion force
  std::map<std::string, DriveLimits> drivers;
  double significant_rebound = MetricsOptions{}.significant_rebound;  ///< least height of a significant rebound [m]
};

/// Reads the JSON of a resolved scene. Every part is optional: a part that is missing, null or of another type is not
/// available.
[[nodiscard]] DrawnScene read_drawn_scene(const nlohmann::json& scene);

}  // namespace softland
