// What a search has computed of its candidates, kept by somebody who outlives it. A search is a function of its scene and
// options: run again, it asks for the same candidates in the same order, so that one which is answered from memory ends with the
// same bits as one that was never interrupted, and simulates only what is not there.
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

/// A candidate, and on what it is tried.
struct EvaluationKey {
  std::size_t family = 0;     ///< its number among those that share the memory: points of different ones may be alike
  std::vector<double> x;      ///< its searched parameters
  std::uint64_t devices = 0;  ///< of a spread; 0: the nominal device alone
  std::uint64_t seed = 0;     ///< that decides which devices these are
  /// Above this cost on some of the devices it is not tried on the rest.
  double hopeless = std::numeric_limits<double>::infinity();
};

struct EvaluationValues {
  double cost = std::numeric_limits<double>::infinity();  ///< the search's own; infinite where it is infeasible
  double leading =
      std::numeric_limits<double>::infinity();  ///< the cost that leads the first stage of a search; see GuidedSearch
  bool lands = false;                           ///< without a significant rebound
  long closings = 1;                            ///< that it took
};

/// May be asked on any thread. Neither function throws: what goes wrong with the keeping is for its owner to tell.
class EvaluationMemory {
 public:
  virtual ~EvaluationMemory() = default;
  [[nodiscard]] virtual std::optional<EvaluationValues> recall(const EvaluationKey& key) noexcept = 0;
  virtual void note(const EvaluationKey& key, const EvaluationValues& values) noexcept = 0;
};

/// The parameters of families that share a memory or a log, as columns of a table.
struct FamilyColumns {
  std::vector<std::vector<std::string>> families;  ///< of each the names of its parameters

  /// Of all columns.
  [[nodiscard]] std::vector<std::string> names() const;
  /// At a point of one family: NaN in the columns of the others. Throws InvalidInput where x is no point of the family.
  [[nodiscard]] std::vector<double> row(std::size_t family, std::span<const double> x) const;
};

/// Waveforms that a search is to begin with.
struct StartingWaveforms {
  std::string name;                           ///< for messages: "--start run1/best.toml"
  DriveWaveforms waveforms;                   ///< by drive [V, s]
  std::map<std::string, double> before = {};  ///< what the drives stand at before t = 0, where that is not 0 [V]
};

}  // namespace softland
