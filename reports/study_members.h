// Lists the members of the results of several verbs, with their names in JSON: see reports/record.h.
#pragma once

#include <string>
#include <variant>

#include "objectives/figure_values.h"
#include "reports/closing_members.h"
#include "reports/origin.h"
#include "reports/record.h"
#include "sampling/interval.h"
#include "studies/closing/effect_ablation.h"
#include "studies/devices/robustness.h"

namespace softland {

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
