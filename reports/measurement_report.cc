#include "reports/measurement_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/assumed_spread.h"
#include "reports/document.h"
#include "reports/estimates.h"
#include "reports/json_number.h"
#include "reports/origin.h"
#include "reports/quantity.h"
#include "sampling/statistics.h"

namespace softland {
namespace {

using internal::interval_json;
using internal::json_number;
using internal::percent;
using internal::quantile_text;
using internal::quantity;
using internal::yield_json;
using internal::yield_text;
using nlohmann::json;

std::vector<double> known(const MeasurableFigure& figure) {
  std::vector<double> values;
  std::copy_if(figure.values.begin(), figure.values.end(), std::back_inserter(values), [](double v) { return std::isfinite(v); });
  return values;
}

// Of the devices that have the figure, over its mean.
double variation(const MeasurableFigure& figure) {
  const std::vector<double> values = known(figure);
  return values.size() < 2 ? Metrics::unset : sample_standard_deviation(values) / sample_mean(values);
}

json quantile_json(const EstimatedQuantile& q) {
  return {{"value", json_number(q.value)}, {"interval", interval_json(q.interval)}};
}

TableRow row(const Prediction& p, bool drives_piezo) {
  const auto miss = [](double value) {
    return std::isfinite(value) ? internal::plain_number(100 * value, 2) + " %" : std::string("—");
  };
  TableRow cells{p.name, miss(p.volts_miss), miss(p.time_miss)};
  if (drives_piezo) cells.emplace_back(miss(p.piezo_miss));
  cells.emplace_back(p.is_judged ? yield_text(p.bounce_free) : "—");
  if (p.is_judged) cells.insert(cells.end(), {quantile_text(p.impact_speed, "m/s"), quantile_text(p.rebound_height, "m")});
  return cells;
}

ReportTable predictions_table(const char* name, const std::vector<Prediction>& predictions, bool drives_piezo) {
  ReportTable table{.head = {name, "volts off", "time off"}, .rows = {}};
  if (drives_piezo) table.head.emplace_back("piezo off");
  table.head.insert(table.head.end(), {"without a rebound", "v_max, 95 % below", "B_H, 95 % below"});
  for (const Prediction& p : predictions) table.rows.push_back(row(p, drives_piezo));
  return table;
}

ReportTable figures_table(const IdentificationStudy& study) {
  ReportTable table{.head = {"Figure", "nominal", "varies by", "error", "devices"}, .rows = {}};
  for (const MeasurableFigure& f : study.figures)
    table.rows.push_back({f.name, quantity(f.nominal, f.unit), percent(variation(f)), f.error > 0 ? percent(f.error) : "exact",
                          std::to_string(known(f).size())});
  return table;
}

}  // namespace

json measurements_json(const IdentificationStudy& study, const IdentificationOptions& options, const std::string& command) {
  json figures = json::array();
  for (const MeasurableFigure& f : study.figures) {
    figures.push_back({{"name", f.name},
                       {"unit", f.unit},
                       {"nominal", json_number(f.nominal)},
                       {"variation", json_number(variation(f))},
                       {"error", f.error},
                       {"devices", known(f).size()}});
  }
  const auto rows = [&](const std::vector<Prediction>& predictions) {
    json all = json::array();
    for (const Prediction& p : predictions) {
      json measured = json::array();
      for (const std::size_t f : p.figures) measured.push_back(study.figures[f].name);
      json one{{"name", p.name},
               {"measured", std::move(measured)},
               {"volts_miss", json_number(p.volts_miss)},
               {"time_miss", json_number(p.time_miss)},
               {"volts_unexplained", json_number(p.volts_unexplained)},
               {"time_unexplained", json_number(p.time_unexplained)},
               {"piezo_miss", json_number(p.piezo_miss)},
               {"piezo_unexplained", json_number(p.piezo_unexplained)}};
      if (p.is_judged) {
        one["score_95"] = json_number(p.score);
        one["bounce_free"] = yield_json(p.bounce_free);
        one["largest_impact_velocity_95_m_s"] = quantile_json(p.impact_speed);
        one["major_bounce_height_95_m"] = quantile_json(p.rebound_height);
      }
      all.push_back(std::move(one));
    }
    return all;
  };
  return with_origin({{"kind", "calibrate"},
                      {"status", study.interrupted ? "interrupted" : "done"},
                      {"devices", study.devices},
                      {"seed", options.seed},
                      {"spread_assumed", study.spread_assumed},
                      {"drives_piezo", study.drives_piezo},
                      {"figures", std::move(figures)},
                      {"references", rows(study.references)},
                      {"predictions", rows(study.predictions)}},
                     command);
}

std::string measurements_text(const IdentificationStudy& study, const IdentificationOptions& options, std::size_t most) {
  // Whether a pair is worth its second figure.
  const auto is_better_than_its_figures = [&](const Prediction& p) {
    return std::all_of(p.figures.begin(), p.figures.end(), [&](std::size_t figure) {
      return std::all_of(study.predictions.begin(), study.predictions.end(), [&](const Prediction& single) {
        return single.figures != std::vector{figure} || !single.is_judged || p.score < single.score;
      });
    });
  };
  std::vector<Prediction> shown;
  for (const Prediction& p : study.predictions) {
    if (shown.size() < most && (!p.is_judged || p.figures.size() < 2 || is_better_than_its_figures(p))) shown.push_back(p);
  }
  const std::size_t left_out = study.predictions.size() - shown.size();
  const std::string others =
      left_out > 0 ? fmt::format(" Left out are pairs that do no better than one of their figures: {}.", left_out) : "";
  return terminal_text(
      {.headline =
           fmt::format("{}{} devices of the spread. For each the factors of volts and of time were searched under which the "
                       "recipe lands it most softly; then they were told from what is measured, by a fit to the other "
                       "half of the devices, and the devices closed with what was told.",
                       study.spread_assumed ? std::string(assumed_words) + " " : "", study.devices),
       .doubt = study.interrupted ? "Interrupted: not all is judged." : "",
       .sections = {{.id = "measured",
                     .heading = "What measuring tells",
                     .parts = {figures_table(study), predictions_table("Measured, the best first", shown, study.drives_piezo),
                               predictions_table("To compare with", study.references, study.drives_piezo),
                               Paragraph{fmt::format(
                                   "Volts and times are off the best factors by this root mean square. In brackets: 95 % "
                                   "confidence. Ranked by the 95 % quantile of the score of `bounce`, half the largest "
                                   "touch speed and half the highest rebound over those of the plain step. Seed {}.{}",
                                   options.seed, others)}}}}});
}

}  // namespace softland
