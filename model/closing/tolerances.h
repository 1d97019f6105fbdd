// Absolute tolerances of the coordinates that are integrated in a closing.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/switch.h"

namespace softland {

/// Absolute tolerances of the integrator. The error of a mode's coordinate counts by the deflection of the contact point in
/// this mode, the error of its velocity by this deflection times the mode's frequency. The tolerance is relative to the contact
/// gap in flight, to the penetration in contact.
struct Tolerances {
  std::vector<double> in_flight, touching;  ///< absolute tolerances of modal coordinates, velocities and film pressures

  /// Derives the absolute tolerances of all states from a relative tolerance.
  Tolerances(const Switch& model, double relative) {
    // The absolute tolerances are the relative tolerance times one of two lengths, for flight and for contact. Later touches
    // magnify errors of the flight, so the length of the flight is shorter than the contact gap. With these lengths a tolerance
    // of 1e-6 gives first contact time, impact velocity and highest rebound of the reference closing to four digits. Measured:
    // a tenfold change of the contact's length changes the error of the highest rebound by less than a tenth of itself; with
    // the length of the flight the error grows in proportion.
    constexpr double flight_fraction = 1.0 / 30;  // length for flight, as a share of the contact gap
    // Length for contact: this multiple of the static interference that bends the beam by the contact gap.
    constexpr double penetrations_in_contact = 1;
    const double gap = model.contact_gap();
    const auto n = static_cast<std::size_t>(model.modes());
    const Eigen::VectorXd &omega = model.basis().angular_frequencies(), &shape = model.basis().contact_shape();
    const double largest = shape.cwiseAbs().maxCoeff();
    const auto of_length = [&](double length) {
      std::vector<double> absolute(2 * n + model.film_states(), model.film_states() > 0 ? relative * model.film_scale() : 0);
      for (std::size_t i = 0; i < n; ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        // A mode that hardly moves the contact point still moves other parts of the beam. Its tolerance is that of a mode that
        // moves the contact point by a tenth of the largest motion.
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
