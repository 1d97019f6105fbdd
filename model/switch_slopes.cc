#include "model/switch_slopes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/require.h"
#include "model/contact/contact_law.h"

namespace softland {

SwitchSlopes::SwitchSlopes(const Switch& model, std::vector<std::optional<Neighbours>> neighbours)
    : model_(model), parameters_(neighbours.size()) {
  const auto is_alike = [&](const Switch& other) {
    return other.modes() == model.modes() && other.drives() == model.drives() && other.has_contact() == model.has_contact() &&
           (!model.has_contact() || other.contact().index() == model.contact().index());
  };
  for (std::size_t k = 0; k < neighbours.size(); ++k) {
    if (!neighbours[k]) continue;
    require(is_alike(neighbours[k]->above) && is_alike(neighbours[k]->below),
            "a switch on either side of a parameter must have the same modes, drives and contact law");
    require(neighbours[k]->distance != 0, "the switches on either side of a parameter must differ by more than 0");
    moving_.push_back(k);
    above_.push_back(neighbours[k]->above.workspace());
    below_.push_back(neighbours[k]->below.workspace());
    neighbours_.push_back(std::move(*neighbours[k]));
  }
  deflection_ = model.basis().contact_shape().cwiseQuotient(model.basis().angular_frequencies().cwiseAbs2());
  deflection_ /= model.basis().contact_shape().dot(deflection_);
}

double SwitchSlopes::interference(std::size_t j, const double* q) const {
  const auto of = [&](const Switch& s) { return s.contact_deflection(q) - s.contact_gap(); };
  return (of(neighbours_[j].above) - of(neighbours_[j].below)) / neighbours_[j].distance;
}

double SwitchSlopes::velocity(std::size_t j, const double* v) const {
  return (neighbours_[j].above.contact_deflection(v) - neighbours_[j].below.contact_deflection(v)) / neighbours_[j].distance;
}

double SwitchSlopes::edge(std::size_t j, double interference) const {
  if (interference < 0) return of_contact(j, [](const ContactLaw& law) { return -contact_reach(law); });
  const std::vector<double> kinks = contact_kinks(model_.contact());
  const auto distance = [&](double kink) { return std::abs(kink - interference); };
  const auto nearest =
      std::min_element(kinks.begin(), kinks.end(), [&](double a, double b) { return distance(a) < distance(b); });
  if (nearest == kinks.end() || !(distance(*nearest) < interference)) return 0;
  const auto number = static_cast<std::size_t>(nearest - kinks.begin());
  return of_contact(j, [&](const ContactLaw& law) { return contact_kinks(law).at(number); });
}

void SwitchSlopes::accelerations(std::size_t j, const double* q, const double* v, std::span<const double> volts,
                                 const ContactState& contact, const Eigen::Ref<const Eigen::MatrixXd>& by_q,
                                 Eigen::Ref<Eigen::VectorXd> result) {
  const auto n = static_cast<Eigen::Index>(model_.modes());
  const Neighbours& near = neighbours_[j];
  if (!contact.active && !near.acts_in_flight) {
    result.setZero();
    return;
  }
  const double wanted = model_.contact_deflection(q) - model_.contact_gap();
  // Returns how far to move along deflection_ [m] so that a neighbouring switch has the interference of `model_` at q.
  const auto along = [&](const Switch& s) {
    if (!contact.active) return 0.0;
    return (wanted + s.contact_gap() - s.contact_deflection(q)) / s.contact_deflection(deflection_.data());
  };
  using Modal = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_modes, 1>;
  const Eigen::Map<const Modal> here(q, n);
  Modal above(n), below(n);
  const auto find = [&](const Switch& s, double share, Switch::Workspace& work, Modal& found) {
    const Modal at = here + share * deflection_;
    s.accelerations(at.data(), v, volts, contact, work, found.data());
  };
  const double up = along(near.above), down = along(near.below);
  find(near.above, up, above_[j], above);
  find(near.below, down, below_[j], below);
  result = (above - below) / near.distance;
  if (contact.active) result.noalias() -= by_q * ((up - down) / near.distance * deflection_);
}

}  // namespace softland
