// The results of `softland cycle`, which closes and opens a switch many times: JSON with SI units in the names, tables for a
// terminal, a page and a picture.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "document/document.h"
#include "reports/closing_record.h"
#include "reports/origin.h"
#include "studies/devices/cycling.h"
#include "studies/search/cycle_search.h"

namespace softland {

struct CycleRecord {
  /// Results under process variation: the largest rates at which all cycles are alike (steady), and the share of devices whose
  /// cycles are steady at the rate of the report.
  struct Devices {
    std::uint64_t count = 0;
    /// 5th, 50th and 95th percentile over the devices of the largest rate with steady cycles [Hz].
    double at_5 = Metrics::unset, at_50 = Metrics::unset, at_95 = Metrics::unset;
    double steady = Metrics::unset;
  };
  struct Course {
    std::vector<double> time, gap;                     ///< time since the start of the run [s], and gap of the contact [m]
    std::optional<std::vector<ClosedStretch>> closed;  ///< times in which the contact is closed [s]; not set if unknown
  };
  struct Cycle {
    Metrics metrics;                  ///< figures of merit of one cycle: see CycleFigures
    double on_time = Metrics::unset;  ///< time in which the switch is electrically closed in the cycle [s]
  };
  struct Drive {
    std::string name;
    double largest = Metrics::unset;                ///< largest cycle rate at which the cycles are steady [Hz]
    std::vector<std::array<double, 2>> windows;     ///< ranges of rates above `largest` in which cycles are steady again [Hz]
    std::vector<double> steady_rates, other_rates;  ///< simulated cycle rates with steady cycles, and those without [Hz]
    std::optional<Devices> devices;
    std::optional<std::string> status, message;  ///< status and message at the end of the run at the cycle rate of the report
    std::vector<Cycle> cycles;
    std::map<std::string, Points> waveforms;  ///< waveforms of one cycle, by electrode or piezo: time [s] and level [V]
  };
  /// The search that found the waveforms for the cycle rate of the report.
  struct Search {
    std::string target, family;  ///< target figure of merit of the search; waveform family of the closing waveform
    std::uint64_t evaluations = 0;
    double cost = Metrics::unset, plain_cost = Metrics::unset;
    std::map<std::string, double> parameters;
  };
  Origin origin;
  std::string status;
  /// Cycle rate [Hz]; share of the cycle in which the switch is commanded closed [1].
  double rate = Metrics::unset, duty = Metrics::unset;
  std::uint64_t cycles = 0, seed = 1;
  double contact_gap = Metrics::unset;  ///< rest gap of the contact [m]
  std::vector<Drive> drives;            ///< results by pair of a closing and an opening waveform; plain steps come first
  std::optional<Search> search;         ///< search for the waveforms; none if the waveforms were given
  std::vector<std::string> warnings;    ///< warnings of the scene

  std::map<std::string, Course> curves;  ///< gap over time, by the name of the pair of waveforms; --json leaves it out
};
[[nodiscard]] CycleRecord record_of(const PreparedScene& given, const Cycling& cycling, const std::string& command);
[[nodiscard]] CycleRecord record_of(const CycleSearchResult& found, const CycleSearchOptions& options,
                                    const std::string& command);
/// Returns the waveforms that a search found as CSV: see csv() in waveforms/export.h.
[[nodiscard]] std::string cycle_csv(const CycleSearchResult& found);

/// Names the members of the JSON.
void members(internal::Archive& a, CycleRecord& record);
[[nodiscard]] nlohmann::json json_of(const CycleRecord& record);
[[nodiscard]] CycleRecord read_cycles(const nlohmann::json& from);
/// Returns a report with sentences and tables, and charts of the gap if the results have curves. The document keeps a reference
/// to `record`.
[[nodiscard]] Document document_of(const CycleRecord& record);
/// Draws the gap, the closed contact and the drive waveforms over the first cycles; CycleRecord::curves must not be empty.
[[nodiscard]] std::string svg_of(const CycleRecord& record);

}  // namespace softland
