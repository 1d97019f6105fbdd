// The quickest single swing of a switch onto its contact: full pull, and from a time on full release, so that the contact point
// turns back as it arrives (a mass on a spring is stopped so: Leus & Elata 2008, J. MEMS 17, 236). All modes and the gas film
// take part. Searches begin with it.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "model/switch.h"

namespace softland {

struct Swing {
  double driven_time = 0, releasing_time = 0;  ///< [s]
  double step = 0;                             ///< time from one state to the next, except to the one at the release [s]
  std::vector<Eigen::VectorXd> states = {};    ///< modal coordinates and their rates, from rest on
};

/// Finds the swing under these values of all drives, from rest under those that they have `before` (none: 0) [V]. Nothing if
/// full pull does not reach the contact within `longest` [s]. Throws InvalidInput for a switch whose gas film is compressible,
/// or which has no open state.
[[nodiscard]] std::optional<Swing> quickest_swing(const Switch& model, const std::vector<double>& pulling,
                                                  const std::vector<double>& releasing, double longest,
                                                  std::span<const double> before = {});

}  // namespace softland
