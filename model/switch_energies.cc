#include "model/gas/reynolds_film.h"
#include "model/switch.h"

namespace softland {

double Switch::film_energy(const double* state, Workspace& work) const {
  if (!film_) return 0;
  quadrature_.set_gap(state, work.field);
  return film_->energy(work.field, quadrature_.weights(), state + 2 * modes());
}

double Switch::law_potential(std::size_t drive, const double* q, Workspace& work) const {
  if (drive >= driven_laws_.size()) return 0;
  quadrature_.set_gap(q, work.field);
  return driven_laws_[drive]->potential(work.field, quadrature_.weights());
}

double Switch::capacitance(std::size_t drive, const double* q, Workspace& work) const {
  return drive_kind(drive) == DriveKind::electrode ? -2 * law_potential(drive, q, work) : 0;
}

double Switch::charge(std::size_t drive, double value, const double* q, Workspace& work) const {
  switch (drive_kind(drive)) {
    case DriveKind::electrode:
      return capacitance(drive, q, work) * (value - neutral_voltages_[drive]);
    case DriveKind::dispersion:
      return -law_potential(drive, q, work);
    case DriveKind::piezo:
      break;
  }
  return basis_.piezo_charge(q);
}

double Switch::elastic_energy(const double* q) const {
  const double bending = basis_.bending_energy(q);
  return stretching_ ? bending + stretching_->energy(q) : bending;
}

double Switch::dissipated_power(const double* q, const double* v, Workspace& work, const double* film) const {
  quadrature_.set_field(q, v, work.field);
  return dissipated_power(v, work, film);
}

double Switch::dissipated_power(const double* v, Workspace& work, const double* film) const {
  work.load.setZero();
  for (const auto& law : passive_laws_) law->add_load(work.field, 0, work.load.data());
  const double modal = 2 * device_.structure.damping_ratio * basis_.at(v).cwiseAbs2().dot(basis_.angular_frequencies());
  const double squeezed =
      modal -
      (quadrature_.weights() * work.load.head(quadrature_.points()) * work.field.velocity.head(quadrature_.points())).sum();
  return film != nullptr ? squeezed + film_->dissipated_power(work.field, quadrature_.weights(), film) : squeezed;
}

}  // namespace softland
