#include "reports/accuracy_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "reports/chart.h"
#include "reports/escape.h"
#include "reports/findings.h"
#include "reports/json_number.h"
#include "reports/made_with.h"
#include "reports/page.h"
#include "reports/quantity.h"
#include "reports/result_json.h"
#include "reports/svg.h"
#include "reports/text.h"
#include "version.h"

namespace softland {
namespace {

using internal::json_number;
using nlohmann::json;

json errors_json(const FigureErrors& errors) {
  json all = json::object();
  for (std::size_t i = 0; i < errors.size(); ++i) all[std::string(studied_figures[i].key)] = json_number(errors[i]);
  return all;
}

json setting_json(const AccuracyRow& row) {
  return {{"integrator", to_string(row.integrator)},
          {"tolerance", row.tolerance},
          {"points_per_length", row.points_per_length ? json(*row.points_per_length) : json(nullptr)},
          {"modes", row.modes}};
}

json row_json(const AccuracyRow& row) {
  json j = setting_json(row);
  if (!row.missing.empty()) {
    j["missing"] = row.missing;
    return j;
  }
  j["relative_errors"] = errors_json(row.errors);
  j["metrics"] = metrics_json(row.figures);
  j["steps"] = row.work.steps;
  j["rhs_evaluations"] = row.work.rhs_evaluations;
  j["cpu_s"] = json_number(row.seconds);
  j["runs"] = row.runs;
  return j;
}

json rows_json(const std::vector<AccuracyRow>& rows) {
  json all = json::array();
  for (const AccuracyRow& row : rows) all.push_back(row_json(row));
  return all;
}

json spread_json(const Spread& s) {
  return {{"low", json_number(s.low)}, {"median", json_number(s.median)}, {"high", json_number(s.high)}, {"runs", s.runs}};
}

std::string error_cell(double error) { return std::isinf(error) ? "missing" : internal::relative_error(error); }

// Columns of words and numbers: the first to the left, the others to the right.
std::string aligned(const std::vector<std::string>& cells) {
  constexpr std::size_t first = 16, other = 11;
  std::string line = fmt::format("{:<{}}", cells[0], first);
  for (std::size_t i = 1; i < cells.size(); ++i) line += fmt::format("{:>{}}", cells[i], other);
  return line + "\n";
}

std::vector<std::string> head(const std::vector<std::string>& setting) {
  std::vector<std::string> cells = setting;
  for (const Figure& f : studied_figures) cells.emplace_back(f.symbol);
  cells.insert(cells.end(), {"rhs", "time"});
  return cells;
}

std::string line(std::vector<std::string> cells, const AccuracyRow& row) {
  if (!row.missing.empty()) {
    std::string text = aligned(cells);
    text.pop_back();
    return text + "    " + row.missing + "\n";
  }
  for (const double error : row.errors) cells.push_back(error_cell(error));
  cells.push_back(fmt::format("{}", row.work.rhs_evaluations));
  cells.push_back(internal::quantity(row.seconds, "s"));
  return aligned(cells);
}

std::string four_digits(double value, std::string_view unit) { return internal::quantity(value, unit, 4); }

std::string symbols(const AccuracyStudy& study, bool conditioned) {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < studied_figures.size(); ++i) {
    const bool there = std::isfinite(studied_figures[i].value(study.reference.figures));
    if (there && study.conditioned[i] == conditioned) names.push_back(studied_figures[i].symbol);
  }
  if (names.size() < 2) return fmt::format("{}", fmt::join(names, ""));
  const std::string_view last = names.back();
  names.pop_back();
  return fmt::format("{} and {}", fmt::join(names, ", "), last);
}

// "24 points per length"; empty for a plate.
std::string points_text(const AccuracyRow& row) {
  return row.points_per_length ? fmt::format("{:g} points per length", *row.points_per_length) : std::string();
}

std::string setting_text(const AccuracyRow& row) {
  const std::string points = points_text(row);
  return fmt::format("{}, tolerance {}{}{}", to_string(row.integrator), internal::scientific(row.tolerance),
                     points.empty() ? "" : ", ", points);
}

constexpr const char* no_quadrature =
    "A rigid plate has the same gap everywhere: the number of quadrature points does not matter, and none were tried.";

std::string modes_text(const AccuracyRow& row) { return fmt::format("{} mode{}", row.modes, row.modes == 1 ? "" : "s"); }

std::string recommended(const AccuracyStudy& study, const Recommendation& r) {
  if (!r.row) return "nothing that was tried";
  const AccuracyRow& row = study.rows[*r.row];
  return fmt::format("{}: {}", setting_text(row), internal::quantity(row.seconds, "s", 2));
}

std::string restart_text(const AccuracyStudy& study) {
  return study.through.empty()
             ? fmt::format("Nothing was tried without a restart at the contact: {}.", study.why_always_restarted)
             : "No restart: the integrator steps over make and break of contact as over a force that sets in; simulate starts it "
               "anew there.";
}

// One line per wanted accuracy.
std::vector<std::string> recommendations(const AccuracyStudy& study) {
  std::vector<std::string> lines;
  const std::string figures = symbols(study, true);
  if (figures.empty()) return {"No figure is well-conditioned here: no setting can be recommended."};
  for (const Recommendation& r : study.recommendations) {
    lines.push_back(fmt::format("for {} in {}: {}", internal::scientific(r.accuracy), figures, recommended(study, r)));
  }
  return lines;
}

std::optional<double> own_points(const AccuracyStudy& study) { return study.rows.front().points_per_length; }

// The rows with the integrator that simulate takes at the tightest tolerance that ran, one per number of points.
std::vector<const AccuracyRow*> quadrature_rows(const AccuracyStudy& study) {
  std::vector<const AccuracyRow*> rows;
  double tightest = std::numeric_limits<double>::infinity();
  for (const AccuracyRow& row : study.rows) {
    const bool tried = row.missing.empty() && row.integrator == study.reference.integrator;
    if (tried && row.points_per_length == own_points(study)) tightest = std::min(tightest, row.tolerance);
  }
  if (std::isinf(tightest)) tightest = study.rows.front().tolerance;
  for (const AccuracyRow& row : study.rows) {
    if (row.integrator == study.reference.integrator && row.tolerance == tightest) rows.push_back(&row);
  }
  std::sort(rows.begin(), rows.end(), [](auto* a, auto* b) { return a->points_per_length < b->points_per_length; });
  return rows;
}

std::string cloud_table(const AccuracyStudy& study) {
  std::string text = fmt::format("{:<16}{:>14}{:>14}{:>14}{:>8}\n", "cloud", "low", "median", "high", "runs");
  const auto add = [&](const Figure& f, const Spread& s, bool ill) {
    if (s.runs == 0) {
      text += fmt::format("{:<16}{:>14}\n", f.symbol, "none");
      return;
    }
    text += fmt::format("{:<16}{:>14}{:>14}{:>14}{:>8}{}\n", f.symbol, four_digits(s.low, f.unit), four_digits(s.median, f.unit),
                        four_digits(s.high, f.unit), s.runs, ill ? "  ill-conditioned" : "");
  };
  for (std::size_t i = 0; i < studied_figures.size(); ++i) {
    if (study.cloud[i].runs > 0) add(studied_figures[i], study.cloud[i], !study.conditioned[i]);
  }
  add(figure_of(&Metrics::permanent_contact_time), study.permanent_contact_time, false);
  add(figure_of(&Metrics::bounce_count), study.bounce_count, false);
  return text;
}

// ---- pictures
// ---------------------------------------------------------------------------------------------------------------------

using internal::Chart;
using internal::Mark;
using internal::Picture;
using internal::Role;

Chart logarithmic_chart(std::string id, std::string title, std::string x_label, std::string x_unit, int height) {
  Chart chart;
  chart.id = std::move(id);
  chart.title = std::move(title);
  chart.x_column = "x";
  chart.x_label = std::move(x_label);
  chart.x_unit = std::move(x_unit);
  chart.y_label = "Relative error";
  chart.scale = chart.x_scale = internal::Scale::logarithmic;
  chart.height = height;
  return chart;
}

void add_curve(Picture& drawn, Chart& chart, std::string label, Role pen, Points points) {
  std::erase_if(points, [](const auto& p) { return !(p[0] > 0 && p[1] > 0 && std::isfinite(p[1])); });
  if (points.empty()) return;
  std::sort(points.begin(), points.end());
  const std::string name = fmt::format("{}/{}", chart.id, chart.series.size());
  for (const auto& [x, y] : points) {
    drawn.tables[name]["x"].push_back(x);
    drawn.tables[name]["y"].push_back(y);
    chart.marks.push_back({x, y, pen, ""});
  }
  chart.series.push_back({name, "y", std::move(label), pen});
}

void keep(Picture& drawn, Chart chart) {
  if (chart.marks.empty()) return;
  const auto [first, last] =
      std::minmax_element(chart.marks.begin(), chart.marks.end(), [](const Mark& a, const Mark& b) { return a.x < b.x; });
  constexpr double margin = 1.15;
  chart.x_home = chart.x_whole = {first->x / margin, last->x * margin};
  drawn.charts.push_back(std::move(chart));
}

// Error against time, of an integrator at every tolerance.
Points work_precision(const AccuracyStudy& study, const std::vector<AccuracyRow>& rows, Integrator integrator) {
  Points points;
  for (const AccuracyRow& row : rows) {
    if (row.integrator == integrator && row.points_per_length == own_points(study))
      points.push_back({row.seconds, study.worst_error(row)});
  }
  return points;
}

Picture picture(const AccuracyStudy& study) {
  constexpr std::array pens{Role::best, Role::baseline, Role::third, Role::fourth, Role::fifth};
  Picture drawn;
  const Integrator own = study.reference.integrator;
  const std::string time = "Time of one closing", figures = symbols(study, true);

  Chart work = logarithmic_chart("work-precision", "Largest relative error of " + figures, time, "s", 380);
  work.caption =
      "One curve per integrator; the dots of a curve are tolerances, a factor of ten apart. The lower left is where to be.";
  for (std::size_t i = 0; i < all_integrators.size(); ++i) {
    add_curve(drawn, work, std::string(to_string(all_integrators[i])), pens[i % pens.size()],
              work_precision(study, study.rows, all_integrators[i]));
    if (all_integrators[i] != own) continue;
    for (Mark& mark : work.marks) {  // which tolerance is where, said once
      for (const AccuracyRow& row : study.rows) {
        const bool shown = row.integrator == own && row.points_per_length == own_points(study) && row.seconds == mark.x;
        if (shown && mark.role == pens[i % pens.size()]) mark.text = internal::scientific(row.tolerance);
      }
    }
  }
  keep(drawn, std::move(work));

  // The integrator that simulate takes, and the one that loses its history with every restart.
  Chart contact = logarithmic_chart(
      "contact", "Restarted at make and break of contact, or not: largest relative error of " + figures, time, "s", 260);
  contact.caption = restart_text(study);
  std::size_t pen = 0;
  for (const Integrator integrator : {own, Integrator::bdf}) {
    for (const auto* rows : {&study.rows, &study.through}) {
      const char* how = rows == &study.through ? ", not restarted" : "";
      add_curve(drawn, contact, std::string(to_string(integrator)) + how, pens[pen++], work_precision(study, *rows, integrator));
    }
  }
  if (!study.through.empty()) keep(drawn, std::move(contact));

  Chart points = logarithmic_chart("quadrature", fmt::format("Quadrature: {} at its tightest tolerance", to_string(own)),
                                   "Quadrature points per length", "", 260);
  points.caption = "What too few points leave, however tight the tolerance.";
  for (std::size_t i = 0; i < studied_figures.size(); ++i) {
    if (!study.conditioned[i] || !own_points(study)) continue;
    Points errors;
    for (const AccuracyRow* row : quadrature_rows(study)) {
      if (row->missing.empty()) errors.push_back({*row->points_per_length, row->errors[i]});
    }
    add_curve(drawn, points, std::string(studied_figures[i].symbol), pens[i % pens.size()], std::move(errors));
  }
  keep(drawn, std::move(points));
  return drawn;
}

// ---- the page
// ---------------------------------------------------------------------------------------------------------------------

using internal::section;
using internal::symbol_html;
using internal::table_html;
using internal::TableRow;

// Errors and costs of settings; `first` says what a row is.
std::string errors_table(const std::vector<std::string>& first, const std::vector<const AccuracyRow*>& rows,
                         const std::function<std::vector<std::string>(const AccuracyRow&)>& setting) {
  TableRow head(first.begin(), first.end());
  for (const Figure& f : studied_figures) head.emplace_back(symbol_html(f.symbol));
  head.insert(head.end(), {"right-hand sides", "time"});
  std::vector<TableRow> body;
  for (const AccuracyRow* row : rows) {
    const std::vector<std::string> words = setting(*row);
    TableRow& cells = body.emplace_back(words.begin(), words.end());
    if (!row->missing.empty()) {
      cells.emplace_back(internal::escaped(row->missing), "missing", studied_figures.size() + 2);
      continue;
    }
    for (const double error : row->errors) cells.emplace_back(error_cell(error));
    cells.emplace_back(fmt::format("{}", row->work.rhs_evaluations));
    cells.emplace_back(internal::quantity(row->seconds, "s"));
  }
  return table_html(head, body);
}

std::vector<const AccuracyRow*> all_of(const std::vector<AccuracyRow>& rows) {
  std::vector<const AccuracyRow*> all;
  for (const AccuracyRow& row : rows) all.push_back(&row);
  return all;
}

std::string recommendations_html(const AccuracyStudy& study) {
  if (symbols(study, true).empty()) return "<p>" + recommendations(study).front() + "</p>\n";
  const bool has_points = own_points(study).has_value();
  std::vector<TableRow> rows;
  for (const Recommendation& r : study.recommendations) {
    const std::string accuracy = internal::scientific(r.accuracy);
    TableRow cells{accuracy, "nothing that was tried", "", ""};
    if (r.row) {
      const AccuracyRow& row = study.rows[*r.row];
      cells = {accuracy, std::string(to_string(row.integrator)), internal::scientific(row.tolerance),
               internal::quantity(row.seconds, "s", 2)};
    }
    if (has_points) cells.insert(cells.end() - 1, r.row ? fmt::format("{:g}", *study.rows[*r.row].points_per_length) : "");
    rows.push_back(std::move(cells));
  }
  TableRow head{"Accuracy wanted", "Integrator", "Tolerance", "Time of a closing"};
  if (has_points) head.insert(head.end() - 1, "Points per length");
  const std::string ill = symbols(study, false);
  return table_html(head, rows) +
         fmt::format(
             "<p class=\"below\">The quickest setting with which {} are that accurate, there and at every tighter tolerance "
             "tried.{}</p>\n",
             symbols(study, true), ill.empty() ? "" : " Left out, because ill-conditioned here: " + ill + ".");
}

std::string clouds_html(const AccuracyStudy& study) {
  std::vector<TableRow> rows;
  const auto add = [&](const Figure& f, const Spread& s, bool ill) {
    const auto value = [&](double v) { return s.runs > 0 ? four_digits(v, f.unit) : std::string("—"); };
    rows.push_back({symbol_html(f.symbol), value(s.low), value(s.median), value(s.high), fmt::format("{}", s.runs),
                    fmt::format("<span class=\"note\">{}</span>", ill ? "ill-conditioned" : "")});
  };
  for (std::size_t i = 0; i < studied_figures.size(); ++i) {
    if (study.cloud[i].runs > 0) add(studied_figures[i], study.cloud[i], !study.conditioned[i]);
  }
  add(figure_of(&Metrics::permanent_contact_time), study.permanent_contact_time, ill_conditioned(study.permanent_contact_time));
  add(figure_of(&Metrics::bounce_count), study.bounce_count, ill_conditioned(study.bounce_count));
  return table_html({"Figure", "lowest", "median", "highest", "runs", ""}, rows) +
         "<p class=\"below\">Runs whose drives differ by one part in 1e9 to 1e7, which nobody could notice. Permanent contact "
         "time and "
         "bounce count are properties of such a cloud, not of one run.</p>\n";
}

std::string charts_html(const Picture& drawn) {
  std::string out;
  for (const Chart& chart : drawn.charts) out += internal::figure_html(drawn.tables, chart);
  return out;
}

std::string reference_keys(const AccuracyStudy& study) {
  std::string out;
  for (std::size_t i = 0; i < studied_figures.size(); ++i) {
    const Figure& f = studied_figures[i];
    const double value = f.value(study.reference.figures);
    const bool has_index = f.symbol.find('_') != std::string_view::npos;
    out += internal::key_html(std::string(f.name) + (has_index ? ", " + symbol_html(f.symbol) : ""),
                              internal::quantity(value, f.unit, 4),
                              !std::isfinite(value)   ? ""
                              : !study.conditioned[i] ? "ill-conditioned"
                                                      : "known to " + error_cell(study.resolution[i]));
  }
  return out;
}

// What the accuracy takes that is nearest to the one the scene asks for.
std::pair<std::string, std::string> headline(const Prepared& prepared, const AccuracyStudy& study) {
  const std::string figures = symbols(study, true);
  if (figures.empty() || study.recommendations.empty()) return {recommendations(study).front(), ""};
  const double asked = std::log(prepared.scene.simulate.accuracy);
  const auto& r =
      *std::min_element(study.recommendations.begin(), study.recommendations.end(), [&](const auto& a, const auto& b) {
        return std::abs(std::log(a.accuracy) - asked) < std::abs(std::log(b.accuracy) - asked);
      });
  if (!r.row) return {fmt::format("Nothing that was tried has {} within {}.", figures, internal::scientific(r.accuracy)), ""};
  const AccuracyRow& row = study.rows[*r.row];
  return {fmt::format("A closing with {} within {} takes {}", figures, internal::scientific(r.accuracy),
                      internal::quantity(row.seconds, "s", 2)),
          fmt::format(", with {}.", setting_text(row))};
}

}  // namespace

json accuracy_json(const Prepared& prepared, const AccuracyStudy& study, const Provenance& provenance) {
  json j{{"kind", "accuracy"},
         {"status", to_string(study.status)},
         {"scene", resolved(prepared.scene, prepared.voltage_units()).json()},
         {"version", version},
         {"made_with", made_with_json()},
         {"command", provenance.command}};
  if (!study.message.empty()) j["message"] = study.message;
  if (study.rows.empty()) return j;
  j["reference"] = row_json(study.reference);
  j["reference"].erase("relative_errors");
  j["reference"]["resolution"] = errors_json(study.resolution);
  j["rows"] = rows_json(study.rows);
  j["modes"] = rows_json(study.modes);
  j["without_restart_at_contact"] = rows_json(study.through);
  if (!study.why_always_restarted.empty()) j["why_always_restarted"] = study.why_always_restarted;
  for (std::size_t i = 0; i < studied_figures.size(); ++i) {
    json cloud = spread_json(study.cloud[i]);
    cloud["well_conditioned"] = study.conditioned[i];
    j["cloud"][std::string(studied_figures[i].key)] = std::move(cloud);
  }
  const auto key = [](Figure::Member member) { return std::string(figure_of(member).key); };
  j["cloud"][key(&Metrics::permanent_contact_time)] = spread_json(study.permanent_contact_time);
  j["cloud"][key(&Metrics::bounce_count)] = spread_json(study.bounce_count);
  const std::vector<std::string> words = recommendations(study);
  j["recommendations"] = json::array();
  for (std::size_t i = 0; i < study.recommendations.size(); ++i) {
    const Recommendation& r = study.recommendations[i];
    json one{{"accuracy", r.accuracy}, {"words", words[std::min(i, words.size() - 1)]}, {"setting", nullptr}};
    if (r.row) one["setting"] = row_json(study.rows[*r.row]);
    j["recommendations"].push_back(std::move(one));
  }
  return j;
}

std::string accuracy_text(const AccuracyStudy& study) {
  if (study.rows.empty()) {
    return study.status == Status::no_contact
               ? "The switch does not touch within its window: there are no figures to be accurate in.\n"
               : wrapped(fmt::format("There is no reference to compare with: {}",
                                     study.message.empty() ? std::string(to_string(study.status)) : study.message)) +
                     "\n";
  }
  std::vector<std::string> values;
  for (std::size_t i = 0; i < studied_figures.size(); ++i) {
    const double value = studied_figures[i].value(study.reference.figures);
    if (std::isfinite(value)) {
      values.push_back(fmt::format("{} {} ({})", studied_figures[i].symbol, four_digits(value, studied_figures[i].unit),
                                   error_cell(study.resolution[i])));
    }
  }
  std::string text = wrapped(fmt::format("Reference: {}, {}: {}. In brackets what a second reference differs by.",
                                         setting_text(study.reference), modes_text(study.reference), fmt::join(values, ", "))) +
                     "\n\n";
  if (!study.message.empty()) text += wrapped("The reference: " + study.message + ".") + "\n\n";
  text += aligned(head({"integrator", "tolerance"}));
  for (const AccuracyRow& row : study.rows) {
    if (row.points_per_length != own_points(study)) continue;
    text += line({std::string(to_string(row.integrator)), internal::scientific(row.tolerance)}, row);
  }
  if (!study.through.empty()) text += "\n" + aligned(head({"no restart", "tolerance"}));
  for (const AccuracyRow& row : study.through) {
    text += line({std::string(to_string(row.integrator)), internal::scientific(row.tolerance)}, row);
  }
  if (own_points(study)) {
    text += "\n" + aligned(head({"points", "per length"}));
    for (const AccuracyRow* row : quadrature_rows(study)) text += line({"", fmt::format("{:g}", *row->points_per_length)}, *row);
  }
  if (!study.modes.empty()) {
    text += "\n" + aligned(head({"modes", ""}));
    for (const AccuracyRow& row : study.modes) text += line({"", fmt::format("{}", row.modes)}, row);
  }
  text +=
      "\n" +
      wrapped(fmt::format(
          "Relative errors of the delivered figures against the reference; times are medians of processor time. {} {}",
          own_points(study) ? fmt::format("Integrators with {}, points and modes with {}, tolerance {}. What another number of "
                                          "modes changes is no error of the integration.",
                                          points_text(study.rows.front()), to_string(study.reference.integrator),
                                          internal::scientific(quadrature_rows(study).front()->tolerance))
                            : no_quadrature,
          restart_text(study))) +
      "\n\n";
  text += cloud_table(study) + "\n" +
          wrapped(
              "The cloud: runs whose drives differ by one part in 1e9 to 1e7. Permanent contact time and bounce count are "
              "properties of such a cloud, not of one run.") +
          "\n\n";
  const std::string ill = symbols(study, false);
  if (!ill.empty()) text += wrapped(fmt::format("Ill-conditioned here, and left out of what follows: {}.", ill)) + "\n\n";
  for (const std::string& words : recommendations(study)) text += words + "\n";
  return text;
}

std::string accuracy_html(const Prepared& prepared, const AccuracyStudy& study, const Provenance& provenance) {
  const auto integrator = [](const AccuracyRow& row) {
    return std::vector<std::string>{std::string(to_string(row.integrator)), internal::scientific(row.tolerance)};
  };
  std::vector<const AccuracyRow*> own;
  for (const AccuracyRow& row : study.rows) {
    if (row.points_per_length == own_points(study)) own.push_back(&row);
  }
  std::string settings = fmt::format(
      "<p>Relative errors of the delivered figures against the reference: {}, {}. {}Times are medians of processor time.</p>\n",
      setting_text(study.reference), modes_text(study.reference),
      study.message.empty() ? "" : "The reference: " + internal::escaped(study.message) + ". ");
  const std::string points = points_text(study.rows.front());
  settings += fmt::format("<h3>Integrator and tolerance{}{}</h3>\n", points.empty() ? "" : ", with ", points) +
              errors_table({"Integrator", "Tolerance"}, own, integrator);
  settings += "<h3>The same without a restart at make and break of contact</h3>\n";
  settings += study.through.empty()
                  ? "<p>" + restart_text(study) + "</p>\n"
                  : "<details><summary>" + restart_text(study) + "</summary>\n" +
                        errors_table({"Integrator", "Tolerance"}, all_of(study.through), integrator) + "</details>\n";
  const std::vector<const AccuracyRow*> quadrature = quadrature_rows(study);
  const std::string tightest = fmt::format("{} at a tolerance of {}", to_string(study.reference.integrator),
                                           internal::scientific(quadrature.front()->tolerance));
  settings += fmt::format("<h3>Quadrature, with {}</h3>\n", tightest);
  settings += points.empty() ? fmt::format("<p>{}</p>\n", no_quadrature)
                             : errors_table({"Points per length"}, quadrature, [](const AccuracyRow& row) {
                                 return std::vector{fmt::format("{:g}", *row.points_per_length)};
                               });
  if (!study.modes.empty()) {
    settings += fmt::format("<h3>Another number of modes, with {}: another model, not an error</h3>\n", tightest) +
                errors_table({"Modes"}, all_of(study.modes),
                             [](const AccuracyRow& row) { return std::vector{fmt::format("{}", row.modes)}; });
  }
  const Picture drawn = picture(study);
  const auto [main, rest] = headline(prepared, study);
  Result result{.command = provenance.command, .version = std::string(version), .made_with = made_with()};
  result.scene.text = resolved(prepared.scene, prepared.voltage_units()).text();
  return internal::page({.title = prepared.scene.title,
                         .origin = "accuracy",
                         .headline = main,
                         .headline_rest = rest,
                         .keys = reference_keys(study),
                         .body = section("recommendations", "Quickest settings", recommendations_html(study)) +
                                 section("charts", "What accuracy costs", charts_html(drawn)) +
                                 section("settings", "Every setting that was tried", settings) +
                                 section("cloud", "What no setting can tell", clouds_html(study)) + internal::reproduce(result) +
                                 internal::scene(result),
                         .style = internal::chart_style(),
                         .scripts = internal::chart_scripts(drawn)});
}

std::string accuracy_svg(const std::string& title, const AccuracyStudy& study) {
  std::string words = "Dots are tolerances, a factor of ten apart. Quickest within";
  for (const Recommendation& r : study.recommendations)
    words += fmt::format(" {}: {}{}", internal::scientific(r.accuracy), recommended(study, r),
                         &r == &study.recommendations.back() ? "." : ";");
  return svg_page(title.empty() ? "What accuracy costs" : title + ": what accuracy costs", words, picture(study));
}

}  // namespace softland
