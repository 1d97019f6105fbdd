// Absolute tolerances of the coordinates that are integrated in a closing.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/switch.h"

namespace softland {

/// Absolute tolerances of the integrator for modal coordinates, velocities and film pressures. The error of a modal coordinate
/// is measured by the deflection of the contact point that it causes, the error of a velocity by the same deflection times the
/// mode's angular frequency. The tolerance is relative to the contact gap in flight, and to the penetration in contact.
struct Tolerances {
  std::vector<double> in_flight, touching;  ///< absolute tolerances of modal coordinates, velocities and film pressures

  /// Derives the absolute tolerances of all states from a relative tolerance.
  Tolerances(const Switch& model, double relative) {
    // The absolute tolerances are the relative tolerance times a length: one length for flight, one for contact. Later touches
    // magnify errors of the flight, so the length for flight is shorter than the contact gap. With these lengths, a relative
    // tolerance of 1e-6 gives first contact time, impact velocity and highest rebound of the reference closing
    // (scenes/mem-gold.toml) to four digits. Measured sensitivity: the error of the highest rebound is proportional to the
    // length for flight, but changes by less than a tenth when the length for contact changes tenfold.
    constexpr double flight_fraction = 1.0 / 30;  // length for flight, as a share of the contact gap
    // Length for contact, in units of the interference under the static force that bends the beam by the contact gap.
    constexpr double penetrations_in_contact = 1;
    const double gap = model.contact_gap();
    const auto n = static_cast<std::size_t>(model.modes());
    const Eigen::VectorXd &omega = model.basis().angular_frequencies(), &shape = model.basis().contact_shape();
    const double largest = shape.cwiseAbs().maxCoeff();
    const auto of_length = [&](double length) {
      std::vector<double> absolute(2 * n + model.film_states(), model.film_states() > 0 ? relative * model.film_scale() : 0);
      for (std::size_t i = 0; i < n; ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        // A mode that hardly moves the contact point still moves other parts of the beam. For its tolerance it counts as moving
        // the contact point by at least a tenth of the mode with the largest motion there.
        const double amplitude = std::max(std::abs(shape[k]), largest / 10);
        absolute[i] = relative * length / amplitude;
        absolute[n + i] = relative * flight_fraction * gap / amplitude * omega[k];
      }
      return absolute;
    };
    in_flight = of_length(flight_fraction * gap);
    touching = of_length(std::min(flight_fraction * gap, penetrations_in_contact * model.penetration_scale()));
  }
};

}  // namespace softland
