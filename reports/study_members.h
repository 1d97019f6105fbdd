// Lists the members that records of several verbs share, with their names in JSON and their meaning: see reports/record.h.
#pragma once

#include <string>
#include <variant>

#include "objectives/figure_values.h"
#include "reports/closing_record.h"
#include "reports/origin.h"
#include "reports/record.h"
#include "sampling/interval.h"
#include "studies/closing/effect_ablation.h"
#include "studies/devices/robustness.h"

namespace softland {

namespace internal {

inline constexpr FigureGroup every_figure{[](const Figure&) { return true; }, "every figure of one run"};
inline constexpr FigureGroup figure_of_no_drive{[](const Figure& figure) { return figure.conditioning != Conditioning::drives; },
                                                "every figure of one run, except those of the drives"};
/// The figures of which each of several contacts has its own value.
inline constexpr FigureGroup figure_of_contact{
    [](const Figure& figure) {
      if (figure.key == key_of(&Metrics::drive_energy)) return false;
      const bool is_at_rest = figure.conditioning == Conditioning::rest || figure.conditioning == Conditioning::open;
      return figure_of_no_drive.has(figure) &&
             (!is_at_rest || figure.key == key_of(&Metrics::hold_force) || figure.asked != nullptr);
    },
    "figures of one contact"};
inline constexpr FigureGroup figure_of_number{[](const Figure& figure) { return !figure.is_yes_or_no(); },
                                              "error of the figure, in its unit"};

// Lists status and figures of a run: in JSON, the status is a member of the object that holds the figures.
inline constexpr const char *figures_about = "figures of the run", *status_about = "outcome of the run";
inline void figures_and_status(Archive& a, FigureValues& figures, std::string& status, const FigureGroup& group) {
  a.object(
      "metrics",
      [&](auto& metrics) {
        metrics.figures(figures, group);
        metrics("status", status, status_about);
      },
      figures_about);
}
inline void figures_and_status(Archive& a, std::optional<FigureValues>& figures, std::string& status, const FigureGroup& group) {
  a.object(
      "metrics",
      [&](auto& metrics) {
        if (metrics.reads() || !figures) figures.emplace();
        metrics.figures(*figures, group);
        metrics("status", status, status_about);
      },
      figures_about);
}
inline void figure_errors(Archive& a, FigureValues& errors) {
  a.object(
      "errors", [&](auto& inside) { inside.figures(errors, figure_of_number); }, "errors of the figures");
}

[[nodiscard]] nlohmann::json closed_json(const std::optional<std::vector<ClosedStretch>>& closed);
[[nodiscard]] std::optional<std::vector<ClosedStretch>> read_closed(const nlohmann::json& rows);
[[nodiscard]] inline std::string integrator_name(Integrator integrator) { return std::string(to_string(integrator)); }
[[nodiscard]] Integrator read_integrator(const nlohmann::json& name);

}  // namespace internal

void members(internal::Archive& a, ClosedState& state);
void members(internal::Archive& a, Spread& spread);

/// Lists status and figures of merit of a run as members for JSON, except figures of the drive waveforms themselves, such as
/// the peak voltage.
inline void members(internal::Archive& a, Metrics& metrics) {
  FigureValues values(metrics);
  a.figures(values, internal::figure_of_no_drive);
  a("status", metrics.status, "outcome of the run");
  if (!a.reads()) return;
  metrics.asked = values.asked;
  for (const Figure& figure : all_figures) {
    const double value = values[figure];
    std::visit(
        [&]<class T>(T Metrics::*member) {
          if (std::is_same_v<T, double> || std::isfinite(value)) metrics.*member = static_cast<T>(value);
        },
        figure.member);
  }
}

inline void members(internal::Archive& a, NamedNumber& number) {
  a("name", number.name, "name of the number");
  a("unit", number.unit, "its unit");
  a("value", number.value, "its value");
}

inline void members(internal::Archive& a, Yield& yield) {
  a("devices", yield.devices, "number of devices");
  a("share", yield.value, "share of all devices");
  a.pair("interval", yield.interval.low, yield.interval.high, "95 % confidence interval of the share");
}

inline void members(internal::Archive& a, EstimatedQuantile& quantile) {
  a("value", internal::OrInfinite{quantile.value}, "the quantile");
  a.pair("interval", quantile.interval.low, quantile.interval.high, "95 % confidence interval of the quantile");
}

}  // namespace softland
