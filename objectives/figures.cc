#include "objectives/figures.h"

#include <cmath>

#include "objectives/figure_values.h"

namespace softland {

std::string Figure::label() const {
  return also.empty() ? std::string(name) : std::string(name) + " (" + std::string(also) + ")";
}

double Figure::value(const Metrics& metrics) const {
  if (const auto* const number = std::get_if<double Metrics::*>(&member)) return metrics.**number;
  // Counts and flags cannot be NaN for "not known", so another figure tells whether they are known. A count or flag of the
  // motion after first contact is known when the height of the highest rebound is.
  if (asked == &AskedFigures::opening && is_count())
    return std::isfinite(metrics.opening_time) ? metrics.*std::get<int Metrics::*>(member) : Metrics::unset;
  const bool followed = std::isfinite(metrics.major_bounce_height) &&
                        (asked != &AskedFigures::electrical || std::isfinite(metrics.electrical_contact));
  if (const auto* const count = std::get_if<int Metrics::*>(&member)) return followed ? metrics.**count : Metrics::unset;
  const bool touched = std::isfinite(metrics.initial_contact_time);
  const bool yes = metrics.*std::get<bool Metrics::*>(member);
  const bool is_open = metrics.status == Status::open;  // a switch that stays open does not settle in contact
  return is_open || (touched && !followed) ? Metrics::unset : yes ? 1 : 0;
}

double Figure::counted(const Metrics& metrics, const MetricsOptions& options) const {
  const double own = value(metrics);
  const double steady = options.steady_force * metrics.hold_force;
  if (member == Member(&Metrics::least_force_after_touch) && own < steady) return steady;
  return member == Member(&Metrics::major_bounce_height) && own < options.significant_rebound ? options.significant_rebound : own;
}

std::vector<Figure> asked_among(std::span<const Figure> figures, const AskedFigures& asked) {
  std::vector<Figure> all(figures.begin(), figures.end());
  std::erase_if(all, [&](const Figure& figure) { return !figure.is_asked(asked); });
  return all;
}

FigureValues::FigureValues(const Metrics& metrics) {
  asked = metrics.asked;
  for (const Figure& figure : figure_table) (*this)[figure] = figure.value(metrics);
}

double relative_change(double value, double reference, double least) {
  return (value - reference) / std::max(std::abs(reference), least);
}

double relative_difference(double value, double reference, double least) {
  if (value == reference || (std::isnan(value) && std::isnan(reference))) return 0;
  const double change = std::abs(relative_change(value, reference, least));
  return std::isnan(change) ? std::numeric_limits<double>::infinity() : change;
}

}  // namespace softland
