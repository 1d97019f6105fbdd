#include "reports/fit_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "base/require.h"
#include "document/quantity.h"
#include "reports/study_members.h"

namespace softland {
namespace {

using internal::plain_number;
using internal::quantity;
using nlohmann::json;

constexpr double unlikely = 3;  // the report lists measurements whose residual exceeds this number of standard errors

std::string label_of(const FittedUnknown& u) { return u.device.empty() ? u.name : fmt::format("{} of {}", u.name, u.device); }

// Formats the value of an unknown or a measurement with its unit; a mass is in grams.
std::string in_unit(double value, const std::string& unit, int digits = 3) {
  return unit == "kg" ? quantity(1e3 * value, "g", digits) : quantity(value, unit, digits);
}

// Formats the fitted value of an unknown; a factor is shown as the change of the value in the scene.
std::string fitted_value_text(const FittedUnknown& u, double value, double error) {
  if (!std::isfinite(value)) return "—";
  if (u.unit.empty()) return internal::relative_change(value - 1);
  if (u.unit == "kg") return internal::quantity_within(1e3 * value, 1e3 * error, "g", 6);
  return internal::quantity_within(value, error, u.unit, 6);
}

std::string nominal_text(const FittedUnknown& u) {
  if (u.unit.empty()) return "—";
  return u.unit == "kg" ? internal::given_quantity(1e3 * u.nominal, "g") : internal::given_quantity(u.nominal, u.unit);
}

std::string fitted_error_text(const FittedUnknown& u) {
  // Least standard error of an unknown of the fit, in its scale (its standard deviation in [spread], or a tenth of its value in
  // the scene), for which the report says "not known" instead of a number.
  constexpr double nothing = 100;
  if (!(u.standard_error < nothing * u.scale)) return "not known";
  if (u.unit.empty()) return plain_number(100 * u.standard_error, 2) + "\u00a0%";
  const std::string share =
      u.value != 0 ? fmt::format(" ({}\u00a0%)", plain_number(100 * std::abs(u.standard_error / u.value), 2)) : "";
  return in_unit(u.standard_error, u.unit, 2) + share;
}

std::string fitted_interval_text(const FittedUnknown& u) {
  if (!std::isfinite(u.low)) return "—";
  return fmt::format("{} to {}", fitted_value_text(u, u.low, u.standard_error), fitted_value_text(u, u.high, u.standard_error));
}

std::string fitted_prior_text(const FittedUnknown& u) {
  if (!std::isfinite(u.prior_mean)) return "none";
  if (u.unit.empty()) return fmt::format("±\u00a0{}\u00a0%", plain_number(100 * u.prior_deviation, 2));
  return fmt::format("±\u00a0{}", in_unit(u.prior_deviation, u.unit, 2));
}

std::string what_text(const FitResidual& r) {
  std::string text(row_of(r.what).words);
  if (r.level) text += " at " + quantity(*r.level, "V", 4);
  if (r.time) text += " at " + quantity(*r.time, "s", 4);
  if (!r.device.empty()) text += " of " + r.device;
  return text;
}

// Describes a change of several unknowns that the data do not detect: "+1 % of a with −2.1 % of b".
std::string direction_prose(const Fit& fit, const WeakDirection& weak) {
  std::vector<std::string> words;
  for (const std::size_t i : weak.unknowns) {
    const FittedUnknown& u = fit.unknowns[i];
    const double change = weak.direction[static_cast<Eigen::Index>(i)] * u.scale, size = std::abs(change);
    const std::string shown =
        u.nominal != 0 ? plain_number(100 * size / std::abs(u.nominal), 2) + "\u00a0%" : in_unit(size, u.unit, 2);
    words.push_back(fmt::format("{}{} of {}", change < 0 ? "−" : "+", shown, u.name));
  }
  return fmt::format("{}", fmt::join(words, " with "));
}

std::string weak_prose(const Fit& fit, const WeakDirection& weak) {
  const std::string seen = plain_number(weak.seen, 2), direction = direction_prose(fit, weak);
  const char* const data = fit.devices.size() > 1 ? "all data of a device" : "all data";
  std::vector<std::string> names;
  for (const std::size_t i : weak.unknowns) names.push_back(fit.unknowns[i].name);
  if (names.size() == 1)
    return fmt::format("The data tell less about {} than its prior: {} changes {} together by {} sigma.", names.front(),
                       direction, data, seen);
  return fmt::format("The data cannot separate {}: {} together change {} by {} sigma.", fmt::join(names, " and "), direction,
                     data, seen);
}

std::size_t freedom(const Fit& fit) {
  return fit.residuals.size() > fit.unknowns.size() ? fit.residuals.size() - fit.unknowns.size() : 0;
}

std::vector<std::string> fit_prose(const Fit& fit) {
  std::vector<std::string> all;
  if (!fit.found) {
    all.emplace_back(
        "At no start do all simulated devices have the measured figures: one may stay open at a voltage at which the device "
        "closed. Check that the scene describes the device, and the quantity and the unit of every measurement.");
    return all;
  }
  const auto free = static_cast<double>(freedom(fit));
  // Largest excess of chi squared over its expectation at which a fit describes its data, in standard deviations of chi
  // squared.
  constexpr double beyond = 4;
  if (free > 0 && fit.chi_squared() > free + beyond * std::sqrt(2 * free))
    all.push_back(fmt::format(
        "The device does not match the model within the errors of the data: chi squared of {} residuals is {}, and {} is "
        "expected. The intervals are then too narrow. An effect is missing in the scene, or the stated errors are too small.",
        fit.residuals.size(), plain_number(fit.chi_squared(), 3), freedom(fit)));
  for (const FittedTrace& trace : fit.traces) {
    if (trace.until < trace.recorded)
      all.push_back(
          fmt::format("The {} is used up to {} of {}: the scene does not describe the rest, or the rest is too sensitive to the "
                      "device. The key `until` of the measurement sets another end.",
                      row_of(trace.what).words, quantity(trace.until, "s", 3), quantity(trace.recorded, "s", 3)));
  }
  std::vector<std::string> outliers;
  for (const FitResidual& r : fit.residuals) {
    if (std::abs(r.normalized()) > unlikely)
      outliers.push_back(fmt::format("{} ({} sigma)", what_text(r), plain_number(r.normalized(), 2)));
  }
  constexpr std::size_t most = 6;
  if (!outliers.empty()) {
    const std::string rest = outliers.size() > most ? fmt::format(" and {} more", outliers.size() - most) : "";
    outliers.resize(std::min(most, outliers.size()));
    all.push_back(fmt::format("Residuals above {} sigma: {}{}.{}", unlikely, fmt::join(outliers, ", "), rest,
                              fit.loss == Loss::none ? "" : " The robust loss gives them less weight."));
  }
  for (const WeakDirection& weak : fit.estimate.weak) all.push_back(weak_prose(fit, weak));
  if (!fit.next.empty() && fit.next.front().reduction > 0.01) {
    const NextMeasurement& best = fit.next.front();
    all.push_back(fmt::format("The best next measurement is the {}, measured to ±{}, which reduces the standard errors by {}.",
                              best.name, quantity(best.error, row_of(best.what).unit, 2), internal::percent(best.reduction)));
  }
  all.push_back(fit.starts == 1
                    ? "There was one search, from the values of the scene."
                    : fmt::format("{} of {} searches converged, to {}.", fit.converged, fit.starts,
                                  fit.minima == 1 ? "the same minimum" : fmt::format("{} distinct minima", fit.minima)));
  return all;
}

FitRecord::Matrix rows_of(const Eigen::MatrixXd& matrix) {
  FitRecord::Matrix rows;
  for (const auto& row : matrix.rowwise()) rows.emplace_back(row.begin(), row.end());
  return rows;
}

std::string fit_headline(const FitRecord& fit) {
  if (!fit.is_found()) return "No device like the scene has all the measured figures.";
  const auto n = static_cast<double>(fit.residuals.size());
  if (!fit.doubts.empty())
    return fmt::format(
        "Do not trust this fit: {}. Check the quantity and the unit of every measurement, and that the scene describes the "
        "device.",
        fmt::join(fit.doubts, "; "));
  return fmt::format("The RMS residual of the fitted scene is {} sigma ({} before the fit).",
                     plain_number(std::sqrt(fit.chi_squared / n), 3), plain_number(std::sqrt(fit.chi_squared_before / n), 3));
}

ReportSection values_section(const FitRecord& fit) {
  ReportTable table{.head = {"Unknown", "Scene", "Fitted", "± 1 σ", "95 %", "Prior"}, .rows = {}};
  for (const FittedUnknown& u : fit.unknowns)
    table.rows.push_back({label_of(u),
                          nominal_text(u),
                          {fitted_value_text(u, u.value, u.standard_error), "own"},
                          fitted_error_text(u),
                          fitted_interval_text(u),
                          fitted_prior_text(u)});
  ReportSection section{.id = "values", .heading = "Fitted quantities", .parts = {}};
  if (fit.is_found()) section.parts.emplace_back(std::move(table));
  for (const std::string& sentence : fit.words) section.parts.emplace_back(Paragraph{.text = sentence, .is_note = true});
  return section;
}

ReportTable correlation_table(const FitRecord& fit) {
  ReportTable table{.head = {""}, .rows = {}};
  for (const FittedUnknown& u : fit.unknowns) table.head.emplace_back(label_of(u));
  for (std::size_t i = 0; i < fit.unknowns.size(); ++i) {
    TableRow& row = table.rows.emplace_back(TableRow{label_of(fit.unknowns[i])});
    for (std::size_t j = 0; j < fit.unknowns.size(); ++j)
      row.emplace_back(internal::with_true_minus(fmt::format("{:.3f}", fit.correlation[i][j])));
  }
  return table;
}

ReportTable next_table(const FitRecord& fit) {
  constexpr std::size_t most = 8;
  ReportTable table{.head = {"Measurement", "Measured to", "Reduction of the standard errors"}, .rows = {}};
  for (const NextMeasurement& one : fit.next) {
    if (table.rows.size() == most) break;
    table.rows.push_back(
        {one.name, "±" + quantity(one.error, row_of(one.what).unit, 2), {internal::percent(one.reduction), "own"}});
  }
  return table;
}

ReportSection data_section(const FitRecord& fit) {
  constexpr std::size_t most = 60;
  ReportTable table{.head = {"Measured", "Value", "Error", "Scene", "Fitted", "Residual (sigma)"}, .rows = {}};
  for (const FitResidual& r : fit.residuals) {
    if (table.rows.size() == most) break;
    const std::string_view unit = row_of(r.what).unit;
    table.rows.push_back({what_text(r),
                          quantity(r.measured, unit, 5),
                          quantity(r.error, unit, 2),
                          quantity(r.before, unit, 5),
                          {quantity(r.after, unit, 5), "own"},
                          internal::with_true_minus(fmt::format("{:.2f}", r.normalized()))});
  }
  ReportSection section{.id = "data",
                        .heading = "Measurements, and the scene before and after the fit",
                        .parts = {std::move(table)},
                        .shown = ShownIn::page};
  if (fit.residuals.size() > most)
    section.parts.emplace_back(
        Paragraph{.text = fmt::format("The first {} of {} measurements are shown; fit.json has all.", most, fit.residuals.size()),
                  .is_note = true});
  return section;
}

void add_residual_chart(const FitRecord& fit, internal::Picture& drawn) {
  internal::CurveTable& table = drawn.tables["residuals"];
  double largest = unlikely;
  for (std::size_t i = 0; i < fit.residuals.size(); ++i) {
    table["number"].push_back(static_cast<double>(i + 1));
    table["after"].push_back(fit.residuals[i].normalized());
    largest = std::max(largest, std::abs(fit.residuals[i].normalized()));
  }
  internal::Chart chart{.id = "residuals",
                        .title = "Residuals of the fitted scene",
                        .caption =
                            "Fitted minus measured value, in standard errors of the measurement (sigma). If the scene describes "
                            "the device, 95 % of the residuals are between −2 and 2.",
                        .x_column = "number",
                        .x_label = "Number of the measurement",
                        .x_unit = "",
                        .y_label = "Residual",
                        .y_unit = "",
                        .zero_line = true,
                        .height = 240};
  chart.x_home = chart.x_whole = {0, static_cast<double>(fit.residuals.size()) + 1};
  chart.y_home = {-1.1 * largest, 1.1 * largest};
  chart.series.push_back({.table = "residuals", .column = "after", .label = "", .role = internal::Role::measured});
  drawn.charts.push_back(std::move(chart));
}

// Draws measurements against the voltage level or the time, with the predictions of the scene before and after the fit.
void add_courses(const FitRecord& fit, internal::Picture& drawn) {
  constexpr std::size_t most = 12;
  std::map<std::tuple<std::string, Measurable, bool>, std::vector<const FitResidual*>> groups;
  for (const FitResidual& r : fit.residuals) {
    if (r.level || r.time) groups[{r.device, r.what, r.time.has_value()}].push_back(&r);
  }
  for (auto& [key, rows] : groups) {
    const auto& [device, what, is_over_time] = key;
    const auto place = [over_time = is_over_time](const FitResidual* r) { return over_time ? *r->time : *r->level; };
    std::ranges::stable_sort(rows, {}, place);
    if (place(rows.front()) == place(rows.back()) || drawn.charts.size() == most) continue;
    const MeasurableRow& row = row_of(what);
    const std::string name = fmt::format("course-{}", drawn.charts.size());
    internal::CurveTable& table = drawn.tables[name];
    for (const FitResidual* r : rows) {
      table["x"].push_back(place(r));
      table["measured"].push_back(r->measured);
      table["before"].push_back(r->before);
      table["after"].push_back(r->after);
    }
    std::string title(row.words);
    title.front() = static_cast<char>(title.front() - 'a' + 'A');
    internal::Chart chart{.id = name,
                          .title = device.empty() ? title : fmt::format("{} of {}", title, device),
                          .caption = "",
                          .x_column = "x",
                          .x_label = is_over_time ? "Time" : "Level",
                          .x_unit = is_over_time ? "s" : "V",
                          .y_label = title,
                          .y_unit = std::string(row.unit),
                          .height = 260};
    constexpr double margin = 0.04;
    const auto widened = [](double low, double high) {
      const double more = margin * (high - low);
      return std::array{low - more, high + more};
    };
    chart.x_home = chart.x_whole = widened(table["x"].front(), table["x"].back());
    double low = rows.front()->measured, high = low;
    for (const char* column : {"measured", "before", "after"}) {
      for (const double value : table[column]) {
        if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
      }
    }
    if (high > low) chart.y_home = widened(low, high);
    chart.series = {{.table = name, .column = "before", .label = "before the fit", .role = internal::Role::baseline},
                    {.table = name, .column = "after", .label = "fitted", .role = internal::Role::best},
                    {.table = name, .column = "measured", .label = "measured", .role = internal::Role::measured}};
    drawn.charts.push_back(std::move(chart));
  }
}

std::vector<KeyNumber> keys_of(const FitRecord& fit) {
  const auto n = static_cast<double>(fit.residuals.size());
  return {{.name = "RMS residual",
           .value = fmt::format("{} sigma", plain_number(std::sqrt(fit.chi_squared / n), 3)),
           .change = fmt::format("before the fit: {}", plain_number(std::sqrt(fit.chi_squared_before / n), 3))},
          {.name = "Unknowns",
           .value = fmt::format("{}", fit.unknowns.size()),
           .change = fmt::format("from {} data", fit.residuals.size())},
          {.name = "Minima",
           .value = fmt::format("{}", fit.minima),
           .change = fmt::format("of {} searches that converged", fit.converged)}};
}

}  // namespace

namespace internal {

/// The mean and the standard deviation of an unknown of the fit, as given before the measurements.
struct Prior {
  double mean = Metrics::unset, deviation = Metrics::unset;
};
void members(Archive& a, Prior& prior) {
  a("mean", prior.mean, "mean of the prior");
  a("standard_deviation", prior.deviation, "standard deviation of the prior");
}

}  // namespace internal

void members(internal::Archive& a, FittedUnknown& u) {
  a("key", u.name, "entry of [spread], or key of the scene");
  a("unit", u.unit, "its unit; empty for a factor");
  a("nominal", u.nominal, "value in the given scene");
  a("value", u.value, "fitted value");
  a("standard_error", u.standard_error, "its standard error");
  a.pair("interval95", u.low, u.high, "95 % interval of the value");
  a("scale", u.scale, "change of the value when the scaled unknown changes by 1");
  std::optional<internal::Prior> prior;
  if (std::isfinite(u.prior_mean)) prior = {u.prior_mean, u.prior_deviation};
  a("prior", internal::OrNull{prior}, "knowledge before the fit");
  if (prior) u.prior_mean = prior->mean, u.prior_deviation = prior->deviation;
  if (a.has(!u.device.empty())) a("device", u.device, "device to which the unknown belongs, if there are several");
}

void members(internal::Archive& a, NextMeasurement& next) {
  a("quantity", internal::Chosen{next.what, measurables}, "measured quantity");
  a("name", next.name, "the measurement in words");
  a("level_V", internal::OrNull{next.level}, "voltage at which it is made");
  a("error", next.error, "assumed standard deviation of its error [SI unit]");
  a("reduction", next.reduction, "relative decrease of all standard errors");
}

void members(internal::Archive& a, FitResidual& r) {
  a("measurement", r.measurement, "number of the measurement in the bench file");
  a("quantity", internal::Chosen{r.what, measurables}, "measured quantity");
  a("drive", r.drive, "drive of the measurement");
  a.derived("unit", std::string(row_of(r.what).unit), "unit of the values");
  a("measured", r.measured, "measured value");
  a("error", r.error, "its error");
  a("before", r.before, "value in the given scene");
  a("after", r.after, "value in the fitted scene");
  a.derived("normalized", r.normalized(), "difference after the fit, divided by the error");
  if (a.has(!r.device.empty())) a("device", r.device, "device of the measurement, if there are several");
  a("level_V", r.level, "voltage of the measurement");
  a("time_s", r.time, "time of the row of a curve");
}

void members(internal::Archive& a, FittedTrace& trace) {
  a("measurement", trace.measurement, "number of the measurement in the bench file");
  a("quantity", internal::Chosen{trace.what, measurables}, "measured quantity");
  a("until_s", trace.until, "time of the last row that the fit uses");
  a("recorded_s", trace.recorded, "time of the last recorded row");
}

void members(internal::Archive& a, FitRecord::Population::Variable& variable) {
  a("key", variable.key, "entry of [spread]");
  a("mean", variable.mean, "mean over the devices");
  a("standard_deviation", variable.deviation, "standard deviation over the devices");
}

void members(internal::Archive& a, FitRecord::Population& population) {
  a("variables", population.variables, "quantities that differ between devices");
  a("correlation", population.correlation, "their correlation");
}

void members(internal::Archive& a, FitRecord& fit) {
  members(a, fit.origin);
  a("status", fit.status, "`done`, `not_believed` or `numerical_failure`");
  a("doubts", fit.doubts, "reasons to doubt the fit, in words");
  a("title", fit.title, "title of the scene");
  a("unknowns", fit.unknowns, "fitted quantities");
  a("correlation", fit.correlation, "correlation of the unknowns");
  a("indistinguishable", fit.indistinguishable, "groups of unknowns that the data cannot tell apart");
  a("next_measurement", fit.next, "measurements that would help most");
  a("minima", fit.minima, "number of minima that were found");
  a("starts", fit.starts, "number of starts");
  a("converged", fit.converged, "number of starts that converged");
  a("residuals", fit.residuals, "measurements beside the model");
  a("traces", fit.traces, "curves of which the fit uses a part");
  a("chi_squared", fit.chi_squared, "chi squared after the fit");
  a("chi_squared_before", fit.chi_squared_before, "chi squared of the given scene");
  a("words", fit.words, "the fit in words");
  a("spread_assumed", fit.spread_assumed, "whether the scene has no [spread] and the usual one was assumed");
  a("loss", internal::Chosen{fit.loss, losses}, "loss of the residuals");
  a("seed", fit.seed, "seed of the starts");
  a("tolerance", fit.tolerance, "relative tolerance of the integrator");
  a("population", fit.population, "statistics of several fitted devices");
}

FitRecord record_of(const Fit& fit, const std::string& command) {
  FitRecord record{.origin = whole_origin_of("fit", fit.scene, command),
                   .status = !fit.found           ? std::string(to_string(Status::numerical_failure))
                             : fit.doubts.empty() ? "done"
                                                  : "not_believed",
                   .doubts = fit.doubts,
                   .title = fit.scene.scene.title,
                   .unknowns = fit.unknowns,
                   .correlation = rows_of(fit.estimate.correlation),
                   .indistinguishable = {},
                   .next = fit.next,
                   .minima = fit.minima,
                   .starts = fit.starts,
                   .converged = fit.converged,
                   .residuals = fit.residuals,
                   .traces = fit.traces,
                   .words = fit_prose(fit),
                   .spread_assumed = fit.spread_assumed,
                   .loss = fit.loss,
                   .seed = fit.seed,
                   .tolerance = fit.scene.tolerance,
                   .population = {}};
  if (fit.found) record.chi_squared = fit.chi_squared(), record.chi_squared_before = fit.chi_squared_before();
  for (const WeakDirection& weak : fit.estimate.weak) {
    std::vector<std::string>& names = record.indistinguishable.emplace_back();
    for (const std::size_t i : weak.unknowns) names.push_back(fit.unknowns[i].name);
  }
  if (const auto& found = fit.population) {
    FitRecord::Population& population = record.population.emplace();
    population.correlation = rows_of(found->correlation);
    for (std::size_t i = 0; i < found->names.size(); ++i)
      population.variables.push_back({found->names[i], found->mean[i], found->deviation[i]});
  }
  return record;
}

json json_of(const FitRecord& record) { return internal::record_json(record); }

FitRecord read_fit(const json& from) {
  FitRecord record = internal::whole_record<FitRecord>(from);
  require(std::ranges::all_of(record.correlation, [&](const auto& row) { return row.size() == record.correlation.size(); }),
          "\"correlation\" must have as many columns as rows");
  return record;
}

Document document_of(const FitRecord& fit) {
  Document document{.title = fit.title,
                    .origin = "fit",
                    .headline = fit_headline(fit),
                    .sections = {values_section(fit)},
                    .made = made_again(fit.origin, fit.seed, fit.tolerance)};
  constexpr std::size_t most = 12;  // largest number of unknowns for which the page has a table of their correlations
  if (fit.unknowns.size() >= 2 && fit.correlation.size() == fit.unknowns.size() && fit.unknowns.size() <= most)
    document.sections.push_back({.id = "correlation",
                                 .heading = "Correlations of the errors",
                                 .parts = {correlation_table(fit)},
                                 .shown = ShownIn::page});
  if (!fit.next.empty())
    document.sections.push_back(
        {.id = "next",
         .heading = "What to measure next",
         .parts = {next_table(fit), Paragraph{.text = "The reduction is that of the RMS of all standard errors, each relative to "
                                                      "its prior, if the measurement is added on every device.",
                                              .is_note = true}},
         .shown = ShownIn::page});
  if (fit.is_found()) {
    document.keys = keys_of(fit);
    document.draw = [&fit] {
      internal::Picture drawn;
      add_residual_chart(fit, drawn);
      add_courses(fit, drawn);
      return drawn;
    };
  }
  document.sections.push_back(
      {.id = "courses", .heading = "Residuals", .parts = {internal::all_charts()}, .shown = ShownIn::page});
  document.sections.push_back(data_section(fit));
  return document;
}

}  // namespace softland
