// What `softland robustness` found: JSON with SI units in the names, one line per device as CSV, and a
// document.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/watch.h"
#include "reports/closing_record.h"
#include "reports/document.h"
#include "reports/origin.h"
#include "studies/devices/box_and_chaos.h"
#include "studies/devices/derivatives.h"
#include "studies/devices/hold_window.h"
#include "studies/devices/robustness.h"

namespace softland {

/// What is reported; `sensitivity`, `derivatives` and `courses` are of the last drive and may be left out.
struct RobustnessReport {
  const PreparedScene& nominal;
  const Robustness& found;
  RobustnessOptions options;
  std::string command;          ///< the command line
  bool spread_assumed = false;  ///< the scene says nothing of how devices differ
  Sensitivity sensitivity = {};
  Derivatives derivatives = {};
  std::vector<DeviceCourse> courses = {};
  std::optional<BoxAndChaos> box_and_chaos = {};  ///< of the last drive as well
  HoldWindows windows = {};                       ///< of hold levels, whatever the drive
  std::string unheld = {};                        ///< why the last drive does not hold the nominal device, hold_warning()
  bool interrupted = found.interrupted;           ///< in the study, or in what was to be known beside it
};

/// What is known of the last drive beside its figures, `other_ways_too` at the cost of further searches; nothing where the work
/// was interrupted.
void add_details(RobustnessReport& report, bool other_ways_too, const Watch& watch);

/// What JSON, text and tables are made of.
struct RobustnessRecord {
  /// A quantity that varies.
  struct Varied {
    std::string name;
    std::vector<std::string> keys;
    std::string distribution, unit;  ///< the unit of its first key
    bool is_factor = true;
    double mean = Metrics::unset, deviation = Metrics::unset;
  };
  struct Device {
    std::size_t number = 0;
    std::map<std::string, double> values;  ///< of what varies [SI unit, or factor]
    std::string status, failure;
    std::map<std::string, double> figures;  ///< by key of device_figures
  };
  struct Drive {
    std::string name;
    std::optional<ClosedState> closed_state;
    Calibration calibration;
    std::vector<KnownUnits::Class> classes;
    std::map<std::string, Points> waveforms;
    Yield closing, collapsed, bounce_free;
    PerFigure<FigureStatistics> figures;
    std::map<std::string, std::size_t> failures;  ///< devices by why they do not close
    std::vector<Device> worst;
  };
  struct Sensitive {
    struct Indices {
      SobolIndex first_order, total;
    };
    std::string_view key;
    std::size_t rows = 0, failed_rows = 0;
    std::map<std::string, Indices> variables;  ///< none where too many rows failed
  };
  struct Derived {
    struct Variable {
      double nominal = Metrics::unset, deviation = Metrics::unset;
      std::string why_none;
    };
    struct Slope {
      double derivative = Metrics::unset;
      double relative = Metrics::unset;  ///< per cent of the figure for one per cent of the quantity; NaN where one of them is 0
      double step = Metrics::unset;      ///< for one standard deviation
    };
    struct Of {
      std::string_view key;
      double nominal = Metrics::unset, deviation = Metrics::unset, error = Metrics::unset;
      std::map<std::string, Slope> by;
      bool agrees = false;  ///< the devices spread as much, as far as that is known
      std::string why_none;
    };
    std::string drive, why_none;
    bool grazes = false;
    double grazing = Metrics::unset;
    std::map<std::string, Variable> variables;
    std::vector<Of> figures;
  };
  struct OtherWays {
    struct InBox {
      double figure = Metrics::unset;
      std::map<std::string, double> values;
      std::string status, failure;
    };
    struct Range {
      std::string_view key;
      InBox least, most;
      Interval of_sample;
    };
    std::string drive, why_none;
    double share = Metrics::unset, half_width = Metrics::unset;
    std::size_t sampled_inside = 0, left_out = 0;
    long closings = 0;
    std::vector<Range> ranges;
    std::vector<FigureChaos> chaos;
  };
  Origin origin;
  bool interrupted = false, spread_assumed = false;
  std::size_t devices = 0;
  std::uint64_t seed = 1;
  PointSet points = PointSet::sobol;
  double duration = Metrics::unset, tolerance = Metrics::unset;  ///< window [s]; of the integrator
  std::vector<std::string> about;                                ///< paragraphs on which devices these are
  std::vector<Varied> spread;
  HoldWindows windows;
  std::vector<Drive> drives, by_knowledge;
  std::vector<Sensitive> sensitivity;
  std::string why_no_sensitivity;
  Derived derivatives;
  std::optional<OtherWays> other_ways;
  std::vector<std::string> warnings;
};
[[nodiscard]] RobustnessRecord record_of(const RobustnessReport& report);
[[nodiscard]] nlohmann::json json_of(const RobustnessRecord& record);
[[nodiscard]] RobustnessRecord read_robustness(const nlohmann::json& from);
/// All but the diagrams: what a terminal shows, and the worst devices.
[[nodiscard]] Document document_of(const RobustnessRecord& record);

/// A line per device: its number, the varying quantities [SI unit, or factor; of jitter the time drawn for the first edge], and
/// for every drive its status and figures; a figure that a device does not have is empty.
[[nodiscard]] std::string robustness_csv(const RobustnessReport& report);

/// Statistics, cumulative distributions and histograms, the closings of typical devices, every figure against every quantity,
/// what measuring is worth, where the spread comes from, derivatives at the nominal device, the other ways, the worst devices,
/// failures.
[[nodiscard]] Document robustness_document(const RobustnessReport& report);

namespace internal {

/// [lower, upper] by electrode [V]; null where no level holds as many devices, or an end where there is none.
[[nodiscard]] nlohmann::json windows_json(const HoldWindows& windows);

}  // namespace internal
}  // namespace softland
