// The findings of `softland robustness`: JSON with SI units in the names, one line per device as CSV, and a document.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/progress.h"
#include "document/document.h"
#include "reports/closing_record.h"
#include "reports/origin.h"
#include "studies/devices/box_and_chaos.h"
#include "studies/devices/derivatives.h"
#include "studies/devices/hold_window.h"
#include "studies/devices/robustness.h"

namespace softland {

/// The input of a report; `sensitivity`, `derivatives` and `courses` are of the last drive and may be left out.
struct RobustnessReport {
  const PreparedScene& nominal;
  const Robustness& found;
  RobustnessOptions options;
  std::string command;          ///< command line
  bool spread_assumed = false;  ///< true when the scene gives no process variation
  Sensitivity sensitivity = {};
  Derivatives derivatives = {};
  std::vector<DeviceCourse> courses = {};
  std::optional<BoxAndChaos> box_and_chaos = {};  ///< worst cases and polynomial chaos, also of the last drive
  HoldWindows windows = {};                       ///< windows of hold levels, whatever the drive
  std::string unheld = {};                        ///< reason why the last drive does not hold the nominal device, hold_warning()
  bool interrupted = found.interrupted;           ///< true when the study, or the work on the details, was interrupted
};

/// Adds the details of the last drive beside its figures, with `other_ways_too` at the cost of further searches; it adds
/// nothing where the work was interrupted.
void add_details(RobustnessReport& report, bool other_ways_too, const Progress& progress);

/// JSON, text and tables are made from this record.
struct RobustnessRecord {
  /// A quantity that varies.
  struct Varied {
    std::string name;
    std::vector<std::string> keys;
    std::string distribution, unit;  ///< distribution; unit of its first key
    bool is_factor = true;
    double mean = Metrics::unset, deviation = Metrics::unset;
  };
  struct Device {
    std::size_t number = 0;
    std::map<std::string, double> values;  ///< values of the varying quantities [SI unit, or factor]
    std::string status, failure;
    std::map<std::string, double> figures;  ///< figures by key of device_figures
  };
  struct Drive {
    std::string name;
    std::optional<ClosedState> closed_state;
    Calibration calibration;
    std::vector<MeasuredUnits::Class> classes;
    std::map<std::string, Points> waveforms;
    Yield closing, collapsed, bounce_free;
    PerFigure<FigureStatistics> figures;
    std::map<std::string, std::size_t> failures;  ///< number of devices by the reason why they do not close
    std::vector<Device> worst;
  };
  struct Sensitive {
    struct Indices {
      SobolIndex first_order, total;
    };
    std::string_view key;
    std::size_t rows = 0, failed_rows = 0;
    std::map<std::string, Indices> variables;  ///< indices by variable; none where too many rows failed
  };
  struct Derived {
    struct Variable {
      double nominal = Metrics::unset, deviation = Metrics::unset;
      std::string why_none;
    };
    struct Slope {
      double derivative = Metrics::unset;
      double relative = Metrics::unset;  ///< per cent of the figure for one per cent of the quantity; NaN where one of them is 0
      double step = Metrics::unset;      ///< change of the figure for one standard deviation
    };
    struct Of {
      std::string_view key;
      double nominal = Metrics::unset, deviation = Metrics::unset, error = Metrics::unset;
      std::map<std::string, Slope> by;
      bool agrees = false;  ///< true where the devices spread as much, as far as that is known
      std::string why_none;
    };
    std::string drive, why_none;
    bool grazes = false;
    double grazing = Metrics::unset;
    std::map<std::string, Variable> variables;
    std::vector<Of> figures;
  };
  struct BoxAndChaosRecord {
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
  double duration = Metrics::unset, tolerance = Metrics::unset;  ///< window [s]; tolerance of the integrator
  std::vector<std::string> about;                                ///< paragraphs that describe the devices
  std::vector<Varied> spread;
  HoldWindows windows;
  std::vector<Drive> drives, by_knowledge;
  std::vector<Sensitive> sensitivity;
  std::string why_no_sensitivity;
  Derived derivatives;
  std::optional<BoxAndChaosRecord> box_and_chaos;
  std::vector<std::string> warnings;
};
[[nodiscard]] RobustnessRecord record_of(const RobustnessReport& report);
[[nodiscard]] nlohmann::json json_of(const RobustnessRecord& record);
[[nodiscard]] RobustnessRecord read_robustness(const nlohmann::json& from);
/// Shows all but the diagrams: the text for a terminal, and the worst devices.
[[nodiscard]] Document document_of(const RobustnessRecord& record);

/// Writes a line per device: its number, the varying quantities, and for every drive its status and figures. A quantity is in
/// its SI unit or a factor; jitter is the time drawn for the first edge. A figure that a device does not have is empty.
[[nodiscard]] std::string robustness_csv(const RobustnessReport& report);

/// Shows statistics, cumulative distributions and histograms, the closings of typical devices, every figure against every
/// quantity. It also shows the value of measurements, the sources of the variation, derivatives at the nominal design, worst
/// cases, polynomial chaos, the worst devices, and failures.
[[nodiscard]] Document robustness_document(const RobustnessReport& report);

namespace internal {

/// Returns [lower, upper] by electrode [V]; null where no level holds as many devices, and for an end that does not exist.
[[nodiscard]] nlohmann::json windows_json(const HoldWindows& windows);

}  // namespace internal
}  // namespace softland
