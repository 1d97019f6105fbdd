// The evaluations of a search, kept by an owner that outlives it. A search is a function of its scene and options: run again,
// it asks for the same candidates in the same order. A search that reads some of them from memory therefore ends with the same
// bits as one that was never interrupted, and simulates only the missing ones.
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

/// A candidate, and the devices that it is tried on.
struct EvaluationKey {
  std::size_t family = 0;     ///< its number among those that share the memory: points of different ones may be alike
  std::vector<double> x;      ///< its searched parameters
  std::uint64_t devices = 0;  ///< number of devices of the spread; 0: the nominal device alone
  std::uint64_t seed = 0;     ///< seed of these devices
  /// Cost above which a candidate on some of the devices is not tried on the rest.
  double hopeless = std::numeric_limits<double>::infinity();
};

struct EvaluationValues {
  double cost = std::numeric_limits<double>::infinity();   ///< cost of the search itself; infinite if the waveform is infeasible
  double guide = std::numeric_limits<double>::infinity();  ///< the cost that leads the first stage of a search; see GuidedSearch
  bool lands = false;                                      ///< true for a closing without a significant rebound
  long closings = 1;                                       ///< closings that the evaluation took
};

/// The memory that a search asks, on any thread. Neither function throws: the owner reports what goes wrong with the storage.
class EvaluationMemory {
 public:
  virtual ~EvaluationMemory() = default;
  [[nodiscard]] virtual std::optional<EvaluationValues> recall(const EvaluationKey& key) noexcept = 0;
  virtual void note(const EvaluationKey& key, const EvaluationValues& values) noexcept = 0;
};

/// The parameters of families that share a memory or a log, as columns of a table.
struct FamilyColumns {
  std::vector<std::vector<std::string>> families;  ///< parameter names of each family

  /// Column names, in the order of the rows.
  [[nodiscard]] std::vector<std::string> names() const;
  /// The row of a point of one family: NaN in the columns of the others. Throws InvalidInput if x is not a point of the family.
  [[nodiscard]] std::vector<double> row(std::size_t family, std::span<const double> x) const;
};

/// Waveforms that a search begins with.
struct StartingWaveforms {
  std::string name;                           ///< name for messages: "--start run1/best.toml"
  DriveWaveforms waveforms;                   ///< waveforms by drive [V, s]
  std::map<std::string, double> before = {};  ///< voltages of the drives before t = 0, if not 0 [V]
};

}  // namespace softland
