// Verb `simulate`: computes the closing that a scene describes.
#pragma once

#include <memory>

#include "studies/closing/simulate.h"
#include "verbs/study.h"

namespace softland::verbs {

struct SimulateRequest {
  bool errors = true;
  bool certified = false;
  /// Number of threads for the repeated runs by which --certify estimates how reliable the figures are.
  int jobs = one_per_core();
};
/// Reads the options of `simulate` from the arguments. Throws InvalidRequest.
[[nodiscard]] SimulateRequest simulate_request(const Arguments& arguments);

/// A simulated closing, and the scene that describes it.
struct Simulated {
  std::shared_ptr<const PreparedScene> prepared;
  Closing closing;
};
[[nodiscard]] Simulated simulated(std::shared_ptr<const PreparedScene> prepared, const SimulateRequest& request,
                                  const Progress& progress);

}  // namespace softland::verbs
