#include "reports/exploration_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

#include "base/choice.h"
#include "base/printable.h"
#include "base/require.h"
#include "base/split.h"
#include "config/plan.h"
#include "document/document.h"
#include "document/escape.h"
#include "document/heat_map.h"
#include "document/json_number.h"
#include "document/page.h"
#include "document/page_files.h"
#include "document/quantity.h"
#include "document/svg.h"
#include "optimizers/pareto.h"
#include "reports/exploration_page.h"
#include "studies/exploration/stored_exploration.h"
#include "version.h"

namespace softland {
namespace {

using internal::columns_of;
using internal::explored_text;
using internal::json_number;
using nlohmann::json;

constexpr std::size_t most_front_rows = 40;  // largest number of rows of the table of the Pareto front

/// Returns the factor by which a figure of merit to minimise or maximise becomes one to minimise: -1 for a figure to maximise,
/// 1 otherwise.
double sign_of(const ExploredAim& aim) { return aim.is_largest ? -1 : 1; }

std::string aim_name(const ExplorationReport& report, const ExploredAim& aim) {
  return report.columns[aim.column].name + (aim.is_largest ? " (large)" : "");
}

std::string counted(std::int64_t count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

struct Outcome {
  std::int64_t points = 0;
  std::map<std::string, std::int64_t> reasons;
};

std::map<std::string, Outcome> outcomes_of(const ExplorationReport& report) {
  std::map<std::string, Outcome> outcomes;
  for (const ExploredPoint& point : report.points) {
    Outcome& outcome = outcomes[point.status];
    ++outcome.points;
    if (!point.reason.empty()) ++outcome.reasons[point.reason];
  }
  return outcomes;
}

std::string with_blanks(std::string words) {
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

/// Returns the names of the variables that take several values: "structure.length and gap.contact".
std::string varying_names(const ExplorationReport& report) {
  std::vector<std::string> names;
  for (const std::size_t c : columns_of(report, true)) {
    const double first = report.points.empty() ? 0 : report.points.front().values[c];
    const bool varies =
        std::any_of(report.points.begin(), report.points.end(), [&](const ExploredPoint& p) { return p.values[c] != first; });
    if (varies) names.push_back(report.columns[c].name);
  }
  if (names.empty()) return "one point";
  const std::string last = names.back();
  names.pop_back();
  return names.empty() ? last : fmt::format("{} and {}", fmt::join(names, ", "), last);
}

std::pair<std::string, std::string> headline_of(const ExplorationReport& report) {
  const auto finished =
      std::count_if(report.points.begin(), report.points.end(), [](const auto& p) { return has_figures(p.status); });
  return {fmt::format("{} over {}", counted(static_cast<std::int64_t>(report.points.size()), "point", "points"),
                      varying_names(report)),
          fmt::format(": {} have figures{}.", finished,
                      report.planned > static_cast<std::int64_t>(report.points.size())
                          ? fmt::format(", {} of the {} planned ones are still to come",
                                        report.planned - static_cast<std::int64_t>(report.points.size()), report.planned)
                          : "")};
}

void add_range_key(std::vector<KeyNumber>& keys, const ExplorationReport& report) {
  const std::size_t c = internal::leading_figure(report);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const ExploredPoint& point : report.points) {
    if (!std::isfinite(point.values[c])) continue;
    low = std::min(low, point.values[c]);
    high = std::max(high, point.values[c]);
  }
  if (!(low <= high)) return;
  keys.push_back({.name = report.columns[c].name + ", smallest",
                  .value = explored_text(report.columns[c], low, 3),
                  .change = "up to " + explored_text(report.columns[c], high, 3)});
}

std::vector<KeyNumber> keys_of(const ExplorationReport& report, const ExploredFront& front) {
  const auto finished =
      std::count_if(report.points.begin(), report.points.end(), [](const auto& p) { return has_figures(p.status); });
  std::vector<KeyNumber> keys{
      {.name = "Points",
       .value = fmt::format("{}", report.points.size()),
       .change = report.planned > 0 ? fmt::format("of {} in the plan", report.planned) : ""},
      {.name = "With figures",
       .value = fmt::format("{}", finished),
       .change = fmt::format("{} have none", static_cast<std::int64_t>(report.points.size()) - finished)}};
  add_range_key(keys, report);
  if (!front.members.empty())
    keys.push_back(
        {.name = "On the Pareto front",
         .value = fmt::format("{}", front.members.size()),
         .change = std::isfinite(front.share) ? fmt::format("hypervolume {} of its box", internal::percent(front.share)) : ""});
  return keys;
}

/// Returns an HTML element that the script of the page fills, with the static picture `still`.
Drawing drawn(const std::string& still = {}) { return drawing_of("<div class=\"part\"></div>\n" + still); }

/// Draws a map as static SVG; empty if the map has more than `most_cells` cells.
std::string still_map(const ExplorationReport& report, const internal::ExploredGrid& grid) {
  constexpr std::size_t most_cells = 14'400;
  const std::size_t figure = internal::leading_figure(report);
  const internal::HeatMap map = internal::heat_map_of(report, grid, grid.variables[0], grid.variables[1], figure);
  if (map.values.size() > most_cells) return {};
  constexpr double width = 960;
  return fmt::format("<svg class=\"still\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"{}\">\n{}</svg>\n", width,
                     internal::heat_map_height(width), internal::escaped(map.label), internal::heat_map_elements(map, width));
}

ReportSection outcome_section(const ExplorationReport& report) {
  constexpr std::size_t most_reasons = 5;
  ReportTable table{.head = {"Status", "Points", {"Reasons", "words"}}, .rows = {}};
  for (const auto& [status, outcome] : outcomes_of(report)) {
    std::vector<std::pair<std::string, std::int64_t>> ranked(outcome.reasons.begin(), outcome.reasons.end());
    std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    std::string reasons;
    for (std::size_t k = 0; k < std::min(most_reasons, ranked.size()); ++k)
      reasons +=
          fmt::format("{}{} ({})", k == 0 ? "" : "; ", internal::shortened(printable_line(ranked[k].first)), ranked[k].second);
    if (ranked.size() > most_reasons) reasons += fmt::format("; {} more", ranked.size() - most_reasons);
    table.rows.push_back({with_blanks(status), fmt::format("{}", outcome.points), {reasons, "missing"}});
  }
  return {.id = "outcomes", .heading = "Status of the points", .parts = {std::move(table)}};
}

std::string front_prose(const ExplorationReport& report, const ExploredFront& front) {
  std::vector<std::string> names;
  for (const ExploredAim& aim : report.aims) names.push_back(aim_name(report, aim));
  std::string words = fmt::format("{}. No other point that settles is better in {} together",
                                  counted(static_cast<std::int64_t>(front.members.size()), "point", "points"), in_words(names));
  if (std::isfinite(front.hypervolume)) {
    std::vector<std::string> reference;
    for (std::size_t i = 0; i < front.reference.size(); ++i)
      reference.push_back(explored_text(report.columns[report.aims[i].column], front.reference[i]));
    words += fmt::format("; hypervolume {} of the box from the best to the worst values ({})", internal::percent(front.share),
                         fmt::join(reference, ", "));
  }
  return words + ".";
}

// Returns a column heading in which a page may break a scene key after its dots.
TableCell column_head(const std::string& name) {
  TableCell cell(name);
  for (const std::string_view part : split(name, '.'))
    cell.html += (cell.html.empty() ? "" : ".<wbr>") + internal::words_html(part);
  return cell;
}

// Returns a table of every `stride`-th point along the Pareto front, with the knee (the best compromise) and the ends of the
// front.
ReportTable front_table(const ExplorationReport& report, const ExploredFront& front, std::size_t stride) {
  std::vector<std::size_t> columns;
  for (const ExploredAim& aim : report.aims) columns.push_back(aim.column);
  for (const std::size_t c : columns_of(report, true)) columns.push_back(c);
  ReportTable table{.head = {"Point"}, .rows = {}};
  for (const std::size_t c : columns) table.head.push_back(column_head(report.columns[c].name));
  for (std::size_t k = 0; k < front.members.size(); ++k) {
    const bool is_knee = front.members[k] == front.knee;
    if (k % stride != 0 && !is_knee && k + 1 < front.members.size()) continue;
    const ExploredPoint& point = report.points[front.members[k]];
    TableRow& row = table.rows.emplace_back(TableRow{fmt::format("{}{}", point.number, is_knee ? " *" : "")});
    for (const std::size_t c : columns) row.emplace_back(explored_text(report.columns[c], point.values[c]), is_knee ? "own" : "");
  }
  return table;
}

ReportSection front_section(const ExplorationReport& report, const ExploredFront& front) {
  ReportSection section{.id = "front", .heading = "Pareto front", .parts = {}};
  if (report.aims.empty()) return section;
  if (front.members.empty()) {
    section.parts = {Paragraph{"No point settles and has all the figures of the Pareto front."}};
    return section;
  }
  const std::size_t stride = (front.members.size() + most_front_rows - 1) / most_front_rows;
  section.parts = {
      Paragraph{"Pareto front: " + front_prose(report, front)},
      drawing_of("<p>To read a point, move over the picture, or focus it and press ← →. Grey dots are the other points, "
                 "also those that do not settle.</p>\n"),
      drawn(),
      front_table(report, front, stride),
      Paragraph{.text = front.knee ? "* is the knee, where the front bends most." : "", .is_note = true},
      Paragraph{.text = stride > 1 ? fmt::format("One in {} points of the front is shown.", stride) : "", .is_note = true}};
  return section;
}

std::string script_of(const internal::ExplorationData& data) {
  return internal::filled(
      internal::page_file("page/exploration.html"),
      {{"data", internal::script_json(data.json)},
       {"js", std::string(internal::page_file("page/words.js")) + std::string(internal::page_file("page/exploration.js"))}});
}

json point_json(const ExplorationReport& report, std::size_t k) {
  json values;
  for (std::size_t c = 0; c < report.columns.size(); ++c) values[report.columns[c].key] = json_number(report.points[k].values[c]);
  return {{"point", report.points[k].number}, {"values", std::move(values)}};
}

constexpr std::size_t most_waveforms = 400;  // largest number of waveforms that are shown for a Pareto front

Plan plan_of(const StudyReader& store) { return Plan(exploration_in(store)); }

}  // namespace

bool has_figures(std::string_view status) { return status == "done" || status == "not_settled"; }

ExploredFront explored_front(const ExplorationReport& report) {
  ExploredFront front;
  if (report.aims.empty()) return front;
  std::vector<Objectives> all;
  std::vector<std::size_t> whose;
  for (std::size_t k = 0; k < report.points.size(); ++k) {
    if (!may_lead(report.points[k].status)) continue;
    Objectives values;
    for (const ExploredAim& aim : report.aims) values.push_back(sign_of(aim) * report.points[k].values[aim.column]);
    if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); })) continue;
    all.push_back(std::move(values));
    whose.push_back(k);
  }
  if (all.empty()) return front;
  std::vector<std::size_t> chosen = pareto_front(all);
  std::stable_sort(chosen.begin(), chosen.end(), [&](std::size_t a, std::size_t b) { return all[a] < all[b]; });
  std::vector<Objectives> values;
  for (const std::size_t k : chosen) {
    values.push_back(all[k]);
    front.members.push_back(whose[k]);
  }
  if (const auto knee = pareto_knee(values)) front.knee = front.members[*knee];
  double box = 1;
  Objectives reference;
  const std::vector<ObjectiveRange> ranges = objective_ranges(all);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    reference.push_back(ranges[i].highest);
    front.reference.push_back(sign_of(report.aims[i]) * ranges[i].highest);
    box *= ranges[i].highest - ranges[i].lowest;
  }
  if (reference.size() > 3) return front;
  front.hypervolume = hypervolume(values, reference);
  front.share = box > 0 ? front.hypervolume / box : Metrics::unset;
  return front;
}

Document exploration_document(const ExplorationReport& report) {
  const ExploredFront front = explored_front(report);
  const std::optional<internal::ExploredGrid> grid = internal::grid_of(report);
  const internal::ExplorationData data = internal::exploration_data(report, grid, front);
  const std::string thinning = data.thinning.empty() ? "" : " " + data.thinning;
  Document document{.title = report.title,
                    .origin = "exploration: " + report.study,
                    .keys = keys_of(report, front),
                    .made = {.version = std::string(version), .command = report.command},
                    .style = std::string(internal::page_file("page/exploration.css")),
                    .scripts = script_of(data)};
  std::tie(document.headline, document.headline_rest) = headline_of(report);
  const auto add = [&](const char* id, const char* heading, const std::string& words, const std::string& still = {}) {
    document.sections.push_back(
        {.id = id, .heading = heading, .parts = {Paragraph{words}, drawn(still)}, .shown = ShownIn::page});
  };
  if (grid)
    add("map", "Map",
        "The figure does not exist in hatched cells, for the reason in the legend. To read a point, move over the map, or focus "
        "it and press ← → ↑ ↓." +
            thinning,
        still_map(report, *grid));
  document.sections.push_back(front_section(report, front));
  add("parallel", "Parallel coordinates",
      "Every line is a point. Drag along an axis to set limits, click it to remove them. With the keys, ← → choose an axis, ↑ ↓ "
      "move its limits, + − widen and narrow them, and Delete removes them. The limits hold for every picture of this page." +
          (grid ? std::string() : thinning));
  add("matrix", "Scatter matrix", "Columns and colour are those chosen above.");
  add("effects", "Effect of each variable",
      "Median of the figure over all points with the same value of the variable; the bands hold 50 and 90\u00a0% of the points.");
  document.sections.push_back(outcome_section(report));
  ReportSection plan{.id = "plan", .heading = "Plan of the exploration", .parts = {}, .shown = ShownIn::page};
  if (!report.plan.empty())
    plan.parts.emplace_back(drawing_of("<details><summary>Plan file</summary>\n<pre><code>" +
                                       internal::escaped(internal::shortened(report.plan)) + "</code></pre></details>\n"));
  if (!report.made_with.empty())
    plan.parts.emplace_back(Paragraph{.text = "Computed by " + report.made_with + ".", .is_note = true});
  document.sections.push_back(std::move(plan));
  return document;
}

json exploration_json(const ExplorationReport& report) {
  json counts = json::object();
  for (const auto& [status, outcome] : outcomes_of(report)) counts[status] = outcome.points;
  json out{{"kind", "exploration"},          {"study", report.study},          {"planned", report.planned},
           {"points", report.points.size()}, {"by_status", std::move(counts)}, {"version", version},
           {"command", report.command}};
  if (report.aims.empty()) return out;
  const ExploredFront front = explored_front(report);
  json aims = json::array(), members = json::array(), reference = json::object();
  for (std::size_t i = 0; i < report.aims.size(); ++i) {
    const std::string& key = report.columns[report.aims[i].column].key;
    aims.push_back({{"figure", key}, {"better", report.aims[i].is_largest ? "large" : "small"}});
    if (i < front.reference.size()) reference[key] = front.reference[i];
  }
  for (const std::size_t k : front.members) members.push_back(point_json(report, k));
  out["pareto"] = {{"aims", std::move(aims)},
                   {"front", std::move(members)},
                   {"knee", front.knee ? json(report.points[*front.knee].number) : json(nullptr)},
                   {"reference", std::move(reference)},
                   {"hypervolume", json_number(front.hypervolume)},
                   {"hypervolume_share", json_number(front.share)}};
  return out;
}

std::vector<std::size_t> grid_variables(const ExplorationReport& report) {
  const std::optional<internal::ExploredGrid> grid = internal::grid_of(report);
  return grid ? grid->variables : std::vector<std::size_t>{};
}

std::string exploration_map_svg(const ExplorationReport& report, std::size_t x, std::size_t y, std::size_t figure) {
  const std::optional<internal::ExploredGrid> grid = internal::grid_of(report);
  require(grid.has_value(), "a map needs points on a grid of at least two variables");
  // Largest number of cells of a drawn map. More cells, of some 30 bytes each, would not be visible and make the file slow to
  // open.
  constexpr std::size_t most_cells = 40'000;
  const internal::HeatMap map = internal::thinned_map(internal::heat_map_of(report, *grid, x, y, figure), most_cells);
  return svg_frame(fmt::format("{} over {} and {}", map.label, report.columns[x].name, report.columns[y].name), report.title,
                   [&](double width, double top) {
                     return std::pair{fmt::format("<g transform=\"translate(0 {:.1f})\">\n{}</g>\n", top,
                                                  internal::heat_map_elements(map, width)),
                                      top + internal::heat_map_height(width)};
                   });
}

ExplorationReport read_exploration(const StudyReader& store, const std::string& pareto) {
  const StoredPlan& stored = store.plan();
  const Plan plan = plan_of(store);
  ExplorationReport report{.title = plan.base().json().value("title", ""), .study = plan.study()};
  report.columns = explored_columns(stored);
  report.planned = stored.shard.size(stored.points);
  store.read([&](const StoredRow& row) {
    report.points.push_back({.number = row.point, .status = row.status, .reason = row.reason, .values = row.values});
    if (row.extra.empty()) return;
    const json extra = json::parse(row.extra, nullptr, false);
    if (!extra.is_object() || !extra.contains("waveforms")) return;
    try {
      extra.at("waveforms").get_to(report.waveforms[row.point]);
    } catch (const json::exception&) {
      report.waveforms.erase(row.point);  // leave out a waveform in the format of another version of the program
    }
  });
  if (!pareto.empty() || plan.is_search()) report.aims = explored_aims(report.columns, pareto.empty() ? plan.pareto() : pareto);
  report.plan = stored.text;
  if (const std::vector<StoredSession> sessions = store.sessions(); !sessions.empty()) {
    report.command = sessions.back().command;
    report.made_with = fmt::format("{} on {}", sessions.back().program, sessions.back().processor);
  }
  return report;
}

void add_front_waveforms(ExplorationReport& report, const StudyReader& store, const Progress& progress) {
  if (report.aims.empty()) return;
  const ExploredFront front = explored_front(report);
  if (front.members.size() > most_waveforms) return;
  const Plan plan = plan_of(store);
  std::optional<Exploration> exploration;
  for (std::size_t i = 0; i < front.members.size(); ++i) {
    const ExploredPoint& point = report.points[front.members[i]];
    if (report.waveforms.contains(point.number)) continue;
    if (!exploration) exploration.emplace(plan, progress);
    progress.tell("waveforms of the front", static_cast<double>(i) / static_cast<double>(front.members.size()));
    const std::vector<double> values(point.values.begin(),
                                     point.values.begin() + static_cast<std::ptrdiff_t>(plan.variables().size()));
    for (auto& [drive, line] : exploration->waveforms(plan.scene(values), progress)) {
      Points& points = report.waveforms[point.number][drive];
      for (const auto& [time, level] : line) points.push_back({time, level});
    }
  }
}

}  // namespace softland
