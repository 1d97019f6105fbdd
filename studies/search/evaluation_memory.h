// Interface to a memory of evaluations that outlives a search, such as a database file. A search is a function of its scene and
// options: run again, it evaluates the same candidate waveforms in the same order. If some evaluations come from the memory,
// the result is the same to the last bit, and only the missing candidates are simulated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "waveforms/waveform.h"

namespace softland {

/// The data on which an evaluation depends: the waveform parameters of a candidate, and the devices on which the candidate is
/// simulated.
struct EvaluationKey {
  std::size_t family = 0;     ///< number of the waveform family among those that share the memory
  std::vector<double> x;      ///< searched waveform parameters of the candidate
  std::uint64_t devices = 0;  ///< number of varied devices in the evaluation; 0: the nominal device alone
  /// Number that stands for the random devices, and for the measure of risk and conditions of the search.
  std::uint64_t seed = 0;
  /// A candidate whose cost on the first devices exceeds this value is not simulated on the other devices.
  double hopeless = std::numeric_limits<double>::infinity();
};

struct EvaluationValues {
  /// Cost of the candidate by the target of the search; infinite if the waveform is infeasible.
  double cost = std::numeric_limits<double>::infinity();
  /// Guide cost of the candidate, which the first stage of a search minimises: see GuidedSearch.
  double guide = std::numeric_limits<double>::infinity();
  bool bounce_free = false;  ///< true if the switch closes without a significant rebound
  long closings = 1;         ///< number of simulated closings of the evaluation
};

/// Interface of a memory of a search's evaluations, called from any thread. recall() and note() throw no exception; the class
/// that implements them reports failures of storage.
class EvaluationMemory {
 public:
  virtual ~EvaluationMemory() = default;
  [[nodiscard]] virtual std::optional<EvaluationValues> recall(const EvaluationKey& key) noexcept = 0;
  virtual void note(const EvaluationKey& key, const EvaluationValues& values) noexcept = 0;
};

/// The parameters of several waveform families that share a memory or a log, as columns of one table.
struct FamilyColumns {
  std::vector<std::vector<std::string>> families;  ///< names of the waveform parameters, by waveform family

  /// Returns the names of the columns, in the order of the values in row().
  [[nodiscard]] std::vector<std::string> names() const;
  /// Returns the row of the table for a point of one waveform family: NaN in the columns of other families. Throws InvalidInput
  /// if x is not a point of the family.
  [[nodiscard]] std::vector<double> row(std::size_t family, std::span<const double> x) const;
};

/// Waveforms from which a search begins.
struct StartingWaveforms {
  std::string name;                           ///< name of the starting waveforms for messages: "--start run1/best.toml"
  DriveWaveforms waveforms;                   ///< waveforms by drive: voltage [V] over time [s]
  std::map<std::string, double> before = {};  ///< voltages of the drives before t = 0, if not 0 [V]
};

}  // namespace softland
