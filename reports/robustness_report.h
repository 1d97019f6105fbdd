// The results of `softland robustness`, which simulates waveforms on devices under process variation: JSON with SI units in the
// names, one line per device as CSV, and a document.
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
#include "objectives/figure_values.h"
#include "reports/closing_record.h"
#include "reports/origin.h"
#include "studies/devices/box_and_chaos.h"
#include "studies/devices/derivatives.h"
#include "studies/devices/hold_window.h"
#include "studies/devices/robustness.h"

namespace softland {

/// The input of a report that compares sets of drive waveforms on the same devices. Three members are for the last of these
/// sets only, and may be empty: `sensitivity`, `derivatives`, and `courses`, the motions of devices at quantiles of the highest
/// rebound.
struct RobustnessReport {
  const PreparedScene& nominal;
  const Robustness& found;
  RobustnessOptions options;
  std::string command;          ///< command line that made the report
  bool spread_assumed = false;  ///< true when the scene gives no process variation, and the usual one is assumed
  Sensitivity sensitivity = {};
  Derivatives derivatives = {};
  std::vector<DeviceCourse> courses = {};
  std::optional<BoxAndChaos> box_and_chaos = {};  ///< worst cases and polynomial chaos, for the last compared set of waveforms
  HoldWindows windows = {};                       ///< hold voltages between which the devices stay closed, by electrode
  /// Warning that the last compared set of waveforms does not keep the nominal switch closed; may be empty.
  std::string unheld = {};
  bool interrupted = found.interrupted;  ///< true when the study or add_details() was interrupted
};

/// Adds results for the last compared set of waveforms: Sobol' indices, derivatives, hold voltages, and motions of typical
/// devices; with `other_ways_too` also worst cases and polynomial chaos, which take further simulations. Adds nothing after an
/// interruption.
void add_details(RobustnessReport& report, bool other_ways_too, const Progress& progress);

/// The results of `softland robustness`, from which JSON, text and tables are made.
struct RobustnessRecord {
  /// A quantity that varies from device to device.
  struct Varied {
    std::string name;
    std::vector<std::string> keys;
    /// Distribution of the quantity in words; unit of the first scene key that the quantity varies.
    std::string distribution, unit;
    bool is_factor = true;
    double mean = Metrics::unset, deviation = Metrics::unset;
  };
  struct Device {
    std::size_t number = 0;
    std::map<std::string, double> values;  ///< values of the varied quantities of a device, by name [SI unit, or factor]
    std::string status, failure;
    std::map<std::string, double> figures;  ///< figures of merit of the closing of a device, by key of device_figures
  };
  struct Drive {
    std::string name;
    std::optional<ClosedState> closed_state;
    Calibration calibration;
    std::vector<MeasuredUnits::Class> classes;
    std::map<std::string, Points> waveforms;
    Yield closing, collapsed, bounce_free;
    PerFigure<FigureStatistics> figures;
    std::map<std::string, std::size_t> failures;  ///< number of devices that do not close, by the reason
    std::vector<Device> worst;
  };
  struct Sensitive {
    struct Indices {
      SobolIndex first_order, total;
    };
    std::string_view key;
    std::size_t rows = 0, failed_rows = 0;
    /// Sobol' indices of a figure of merit by varied quantity; none if too many of the simulations for the indices failed.
    std::map<std::string, Indices> variables;
  };
  struct Derived {
    struct Variable {
      double nominal = Metrics::unset, deviation = Metrics::unset;
      std::string why_none;
    };
    struct Slope {
      double derivative = Metrics::unset;
      /// Relative change of the figure divided by that of the varied quantity; NaN if one of these values is 0.
      double relative = Metrics::unset;
      double step = Metrics::unset;  ///< change of the figure for one standard deviation of the varied quantity
    };
    struct Of {
      std::string_view key;
      double nominal = Metrics::unset, deviation = Metrics::unset, error = Metrics::unset;
      std::map<std::string, Slope> by;
      /// True if the figure of merit varies in the sample as much as the derivatives predict, or if its variation is unknown.
      bool agrees = false;
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
  double duration = Metrics::unset, tolerance = Metrics::unset;  ///< simulated time [s]; relative tolerance of the integrator
  std::vector<std::string> about;                                ///< paragraphs of the report that describe the devices
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
/// Names the members of the JSON.
void members(internal::Archive& a, RobustnessRecord& record);
[[nodiscard]] nlohmann::json json_of(const RobustnessRecord& record);
[[nodiscard]] RobustnessRecord read_robustness(const nlohmann::json& from);
/// Returns the report without diagrams: the text for a terminal, and the worst devices.
[[nodiscard]] Document document_of(const RobustnessRecord& record);

/// Returns CSV with a line per device: its number, the varying quantities, and status and figures of merit under every set of
/// waveforms. A quantity is in SI units, or a factor of the nominal value; jitter is the random time shift of the first edge of
/// the waveform [s]. A figure that a device does not have is empty.
[[nodiscard]] std::string robustness_csv(const RobustnessReport& report);

/// Returns a document with statistics, cumulative distributions and histograms, the closings of typical devices, and every
/// figure of merit against every quantity. The document also has the value of measurements, the sources of the variation,
/// derivatives at the nominal design, worst cases, polynomial chaos, the worst devices, and failures.
[[nodiscard]] Document robustness_document(const RobustnessReport& report);

namespace internal {

/// Returns, by electrode, the lower and upper hold voltage between which 99 % of the devices stay closed [V]. JSON is null if
/// no voltage does this; an upper voltage that does not exist is null.
[[nodiscard]] nlohmann::json windows_json(const HoldWindows& windows);
[[nodiscard]] HoldWindows read_windows(const nlohmann::json& windows);

}  // namespace internal
}  // namespace softland
