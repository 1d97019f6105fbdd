// The results of `softland fit`, which fits unknown values of a scene to measurements: JSON with SI units, and a document.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "document/document.h"
#include "reports/origin.h"
#include "studies/inverse/fit.h"

namespace softland {

struct FitRecord {
  using Matrix = std::vector<std::vector<double>>;
  struct Population {
    struct Variable {
      std::string key;
      double mean = Metrics::unset, deviation = Metrics::unset;
    };
    std::vector<Variable> variables;
    Matrix correlation;
  };
  Origin origin;
  std::string status;
  std::vector<std::string> doubts;  ///< reasons to doubt the fit, in sentences
  std::string title;
  std::vector<FittedUnknown> unknowns;
  Matrix correlation;
  std::vector<std::vector<std::string>> indistinguishable;  ///< groups of unknowns of the fit that the data cannot tell apart
  std::vector<NextMeasurement> next;
  std::size_t minima = 0, starts = 0, converged = 0;
  std::vector<FitResidual> residuals;
  std::vector<FittedTrace> traces;
  /// Chi squared of the residuals after and before the fit; NaN if the fit failed.
  double chi_squared = Metrics::unset, chi_squared_before = Metrics::unset;
  /// Sentences on the residuals of the fit as a whole, data that contradict each other, indistinguishable unknowns, and several
  /// minima of chi squared.
  std::vector<std::string> words;
  bool spread_assumed = false;
  Loss loss = Loss::huber;
  std::uint64_t seed = 1;
  double tolerance = Metrics::unset;  ///< relative tolerance of the integrator in the simulations of the fit
  std::optional<Population> population;

  [[nodiscard]] bool is_found() const { return status != to_string(Status::numerical_failure); }
};
[[nodiscard]] FitRecord record_of(const Fit& fit, const std::string& command);

/// Names the members of the JSON.
void members(internal::Archive& a, FitRecord& record);
[[nodiscard]] nlohmann::json json_of(const FitRecord& record);
[[nodiscard]] FitRecord read_fit(const nlohmann::json& from);
/// Returns a document with fitted values and their intervals, unknowns that the data cannot tell apart, further data that could
/// tell them apart, and residuals.
[[nodiscard]] Document document_of(const FitRecord& record);

}  // namespace softland
