#include "reports/measurement_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/assumed_spread.h"
#include "document/document.h"
#include "document/quantity.h"
#include "reports/robustness_prose.h"
#include "reports/study_members.h"
#include "sampling/statistics.h"

namespace softland {
namespace {

using internal::percent;
using internal::quantile_text;
using internal::quantity;
using internal::yield_text;
using nlohmann::json;

std::vector<double> known(const MeasurableFigure& figure) {
  std::vector<double> values;
  std::copy_if(figure.values.begin(), figure.values.end(), std::back_inserter(values), [](double v) { return std::isfinite(v); });
  return values;
}

// Returns the standard deviation of a measurable quantity divided by its mean, over the devices that have the quantity.
double variation(const MeasurableFigure& figure) {
  const std::vector<double> values = known(figure);
  return values.size() < 2 ? Metrics::unset : sample_standard_deviation(values) / sample_mean(values);
}

TableRow row(const MeasurementsRecord::Row& row, bool drives_piezo) {
  const Prediction& p = row.found;
  const auto miss = [](double value) {
    return std::isfinite(value) ? internal::plain_number(100 * value, 2) + " %" : std::string("—");
  };
  TableRow cells{p.name, miss(p.volts_miss), miss(p.time_miss)};
  if (drives_piezo) cells.emplace_back(miss(p.piezo_miss));
  cells.emplace_back(p.is_judged ? yield_text(p.bounce_free) : "—");
  if (p.is_judged) cells.insert(cells.end(), {quantile_text(p.impact_speed, "m/s"), quantile_text(p.rebound_height, "m")});
  return cells;
}

ReportTable predictions_table(const char* name, const std::vector<MeasurementsRecord::Row>& predictions, bool drives_piezo) {
  ReportTable table{.head = {name, "voltage error", "time error"}, .rows = {}};
  if (drives_piezo) table.head.emplace_back("piezo error");
  table.head.insert(table.head.end(), {"bounce-free", "v_max, 95th percentile", "B_H, 95th percentile"});
  for (const MeasurementsRecord::Row& p : predictions) table.rows.push_back(row(p, drives_piezo));
  return table;
}

ReportTable figures_table(const MeasurementsRecord& record) {
  ReportTable table{.head = {"Measured figure", "nominal", "variation", "measurement error", "devices"}, .rows = {}};
  for (const MeasurementsRecord::Figure& f : record.figures)
    table.rows.push_back({f.name, quantity(f.nominal, f.unit), percent(f.variation), f.error > 0 ? percent(f.error) : "exact",
                          std::to_string(f.devices)});
  return table;
}

}  // namespace

void members(internal::Archive& a, MeasurementsRecord::Figure& figure) {
  a("name", figure.name, "name of the figure");
  a("unit", figure.unit, "its unit");
  a("nominal", figure.nominal, "value of the nominal design");
  a("variation", figure.variation, "standard deviation over the devices divided by the mean");
  a("error", figure.error, "relative error of its measurement");
  a("devices", figure.devices, "number of devices that have it");
}

void members(internal::Archive& a, MeasurementsRecord::Row& row) {
  Prediction& p = row.found;
  a("name", p.name, "what is measured, in words");
  a("measured", row.measured, "names of the measured figures");
  a("volts_miss", p.volts_miss, "RMS error of the logarithm of the factor of voltage");
  a("time_miss", p.time_miss, "RMS error of the logarithm of the factor of time");
  a("volts_unexplained", p.volts_unexplained, "share of the variance of the factor of voltage that stays");
  a("time_unexplained", p.time_unexplained, "share of the variance of the factor of time that stays");
  a("piezo_miss", p.piezo_miss, "RMS error of the logarithm of the factor of piezo voltage");
  a("piezo_unexplained", p.piezo_unexplained, "share of the variance of the factor of piezo voltage that stays");
  if (a.reads()) p.is_judged = internal::value_at(a.from(), "bounce_free").is_object();
  if (!a.has(p.is_judged)) return;
  a("score_95", p.score, "95th percentile of the cost of `bounce`");
  a("bounce_free", p.bounce_free, "bounce-free devices");
  a("largest_impact_velocity_95_m_s", p.impact_speed, "95th percentile of the largest impact velocity");
  a("major_bounce_height_95_m", p.rebound_height, "95th percentile of the highest rebound");
}

void members(internal::Archive& a, MeasurementsRecord& record) {
  members(a, record.origin);
  a("status", internal::Stopped{record.interrupted}, "`done` or `interrupted`");
  a("devices", record.devices, "number of devices");
  a("seed", record.seed, "seed of the devices");
  a("spread_assumed", record.spread_assumed, "whether the scene has no [spread] and the usual one was assumed");
  a("drives_piezo", record.drives_piezo, "whether the waveform drives a piezo");
  a("figures", record.figures, "figures that may be measured");
  a("references", record.references,
    "for comparison: no measurement, Vdp and period, all figures, and the best factors of each device");
  a("predictions", record.predictions, "measurements, the best first");
}

MeasurementsRecord record_of(const IdentificationStudy& study, const IdentificationOptions& options, const std::string& command) {
  MeasurementsRecord record{.origin = origin_of("calibrate", command),
                            .seed = options.seed,
                            .devices = study.devices,
                            .interrupted = study.interrupted,
                            .spread_assumed = study.spread_assumed,
                            .drives_piezo = study.drives_piezo};
  for (const MeasurableFigure& f : study.figures)
    record.figures.push_back({f.name, f.unit, f.nominal, variation(f), f.error, known(f).size()});
  const auto rows = [&](const std::vector<Prediction>& predictions) {
    std::vector<MeasurementsRecord::Row> all;
    for (const Prediction& p : predictions) {
      all.push_back({p, {}});
      for (const std::size_t f : p.figures) all.back().measured.push_back(study.figures[f].name);
    }
    return all;
  };
  record.references = rows(study.references), record.predictions = rows(study.predictions);
  return record;
}

json json_of(const MeasurementsRecord& record) { return internal::record_json(record); }

MeasurementsRecord read_measurements(const json& from) { return internal::whole_record<MeasurementsRecord>(from); }

std::string text_of(const MeasurementsRecord& study, std::size_t most) {
  using Row = MeasurementsRecord::Row;
  // Returns true if a pair of measured quantities predicts better than either quantity of the pair alone.
  const auto is_better_than_its_figures = [&](const Row& p) {
    return std::ranges::all_of(p.measured, [&](const std::string& figure) {
      return std::ranges::all_of(study.predictions, [&](const Row& single) {
        return single.measured != std::vector{figure} || !single.found.is_judged || p.found.score < single.found.score;
      });
    });
  };
  std::vector<Row> shown;
  for (const Row& p : study.predictions) {
    if (shown.size() < most && (!p.found.is_judged || p.measured.size() < 2 || is_better_than_its_figures(p))) shown.push_back(p);
  }
  const std::size_t left_out = study.predictions.size() - shown.size();
  const std::string others =
      left_out > 0 ? fmt::format(" Pairs that do no better than one of their figures are left out: {}.", left_out) : "";
  return terminal_text(
      {.headline = fmt::format(
           "{}{} devices under process variation. The waveform of the scene is scaled for each device by a factor of voltage and "
           "one of time. The best factors of each device were searched. They were then predicted from the measurements, by a fit "
           "to the other half of the devices, and the devices closed with the predicted factors.",
           study.spread_assumed ? std::string(assumed_prose) + " " : "", study.devices),
       .doubt = study.interrupted ? "Interrupted: not all measurements are judged." : "",
       .sections = {
           {.id = "measured",
            .heading = "Value of the measurements",
            .parts = {
                figures_table(study), predictions_table("Measured (best first)", shown, study.drives_piezo),
                predictions_table("For comparison", study.references, study.drives_piezo),
                Paragraph{"For comparison: with `nothing`, all devices have the waveform of the scene; `all of them` are all "
                          "figures of the first table; in `own units`, voltages scale with Vdp and times with the period of "
                          "the first mode, as in softland export --measured."},
                Paragraph{fmt::format(
                    "The errors of voltage and time are root mean squares against the best factors. In brackets: 95 % "
                    "confidence. The ranking is by the 95th percentile of the score of `bounce`: half the largest impact "
                    "velocity plus half the highest rebound, both relative to the plain step. Seed {}.{}",
                    study.seed, others)}}}}});
}

}  // namespace softland
