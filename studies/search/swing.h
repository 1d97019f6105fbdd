// The quickest single swing of a switch onto its contact: full pull, then full release, so that the contact point turns back as
// it arrives (for a mass on a spring: Leus & Elata 2008, J. MEMS 17, 236). The model has all modes and the gas film. Searches
// begin with this swing. A thick film, such as that of a bridge that lands on a dielectric, stops the beam as soon as the pull
// ends. The pull then lasts until the touch.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "model/switch.h"

namespace softland {

struct Swing {
  double driven_time = 0, releasing_time = 0;  ///< durations of full pull and of full release in the swing [s]
  double step = 0;                             ///< time between two states of the swing, except for the state at the release [s]
  /// Modal coordinates and their rates after each time step, from rest on; empty if `is_overdamped`.
  std::vector<Eigen::VectorXd> states = {};
  /// True if the film stops the beam within less than a time step near the contact: there is no release.
  bool is_overdamped = false;
};

/// Finds the swing with the drive values `pulling`, then `releasing`, from rest under the drive values `before` (none: 0) [V].
/// Returns nothing if full pull does not reach the contact within `longest` [s]. Throws InvalidInput for a switch whose gas
/// film is compressible, or which has no open state.
[[nodiscard]] std::optional<Swing> quickest_swing(const Switch& model, const std::vector<double>& pulling,
                                                  const std::vector<double>& releasing, double longest,
                                                  std::span<const double> before = {});

}  // namespace softland
