#include "studies/search/bang_bang.h"

#include <cmath>

#include "base/gauss.h"

namespace softland {
namespace {

/// Returns the time [s] of the motion of `mass` between rest at the position `rest` and the position `to`; `fallen(x)` is the
/// kinetic energy at x. Near `rest` the speed is proportional to the root of the distance, so that the integrand is smooth in u
/// with x = rest + (to - rest) u^2.
double time_from_rest(const std::function<double(double)>& fallen, double mass, double rest, double to) {
  static const GaussRule rule = gauss_rule(40);
  const double way = to - rest;
  double time = 0;
  for (std::size_t i = 0; i < rule.points.size(); ++i) {
    const double u = 0.5 * (1 + rule.points[i]);
    const double speed = std::sqrt(2 * fallen(rest + way * u * u) / mass);
    time += 0.5 * rule.weights[i] * 2 * std::abs(way) * u / speed;
  }
  return time;
}

}  // namespace

std::optional<double> switching_position(const Potential& driven, const Potential& coasting, double from, double contact) {
  const double at_start = driven(from), at_contact = coasting(contact);
  // Kinetic energy at the contact if the drive jumps from its pulling to its coasting value at the position x; negative if the
  // switch does not reach the contact.
  const auto left = [&](double x) { return at_start - driven(x) - (at_contact - coasting(x)); };
  if (!(left(from) < 0) || !(left(contact) > 0)) return std::nullopt;
  double low = from, high = contact;
  for (int i = 0; i < 200 && std::nextafter(low, high) < high; ++i) {
    const double middle = low + 0.5 * (high - low);
    (left(middle) < 0 ? low : high) = middle;
  }
  return high;
}

std::optional<BangBang> bang_bang(const Potential& driven, const Potential& coasting, double mass, double from, double contact) {
  const std::optional<double> at = switching_position(driven, coasting, from, contact);
  if (!at) return std::nullopt;
  const double at_start = driven(from), at_contact = coasting(contact);
  const BangBang found{.switching_position = *at,
                       .driven_time = time_from_rest([&](double x) { return at_start - driven(x); }, mass, from, *at),
                       .coasting_time = time_from_rest([&](double x) { return at_contact - coasting(x); }, mass, contact, *at)};
  // The times are not finite if a potential barrier between `from` and `contact` stops the switch.
  if (!std::isfinite(found.driven_time) || !std::isfinite(found.coasting_time)) return std::nullopt;
  return found;
}

std::optional<BangBang> bang_bang(const Switch& model, const std::vector<double>& driven, const std::vector<double>& coasting,
                                  std::span<const double> before) {
  const auto n = static_cast<std::size_t>(model.modes());
  const double shape = model.basis().contact_shape()[0];
  const double contact = model.contact_gap();
  Switch::Workspace work = model.workspace();
  const auto potential = [&](const std::vector<double>& values) {
    return [&, values](double x) {
      std::vector<double> q(n, 0.0);
      q[0] = x / shape;
      return model.potential(q.data(), values, false, work);
    };
  };
  const std::optional<Eigen::VectorXd> rest = model.open_equilibrium(before);
  const double from = rest ? model.contact_deflection(rest->data()) : 0;
  return bang_bang(potential(driven), potential(coasting), 1 / (shape * shape), from, contact);
}

}  // namespace softland
