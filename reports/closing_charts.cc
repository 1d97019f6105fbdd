#include "reports/closing_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "document/axis.h"
#include "document/quantity.h"
#include "document/svg.h"
#include "reports/closing_captions.h"
#include "reports/closing_prose.h"

namespace softland::internal {
namespace {

// A simulated run in the results of a closing: the name of the table with its curves, and the role that sets the style of its
// lines.
struct Drawn {
  const char* name;
  Role role;
};
constexpr std::array runs{Drawn{"baseline", Role::baseline}, Drawn{"best", Role::best}};

const RunRecord& run_of(const ClosingRecord& result, const Drawn& drawn) {
  return drawn.role == Role::best ? result.best : result.baseline();
}

/// Returns the curves of a run as a table. Rows whose time is not finite or decreases are left out, and so are columns that are
/// missing or have another length.
CurveTable curve_table(const CurveRecord& curve) {
  std::vector<std::size_t> sound;
  double latest = -std::numeric_limits<double>::infinity();
  for (std::size_t row = 0; row < curve.time.size(); ++row) {
    const double time = drawable(curve.time[row]);
    if (!(time >= latest)) continue;
    sound.push_back(row);
    latest = time;
  }
  CurveTable table;
  if (sound.size() < 2) return table;
  const auto add = [&](const char* name, const std::vector<double>& column) {
    if (column.size() != curve.time.size()) return;
    std::vector<double> values;
    values.reserve(sound.size());
    for (const std::size_t row : sound) values.push_back(drawable(column[row]));
    if (std::any_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }))
      table[name] = std::move(values);
  };
  add("time_s", curve.time);
  add("tip_gap_m", curve.gap);
  add("tip_velocity_m_s", curve.velocity);
  add("contact_force_N", curve.force);
  add("contact_resistance_ohm", curve.resistance);
  return table;
}

/// Extends the waveform of an electrode or piezo for a chart: by the level `rest` before t = 0, and by its last level up to the
/// time `end` [s].
Points whole_waveform(const Points& waveform, double rest, double end) {
  Points points = drawable(waveform);
  if (points.empty()) return points;
  if (points.front()[1] != rest && points.front()[0] <= 0) points.insert(points.begin(), {points.front()[0], rest});
  if (points.back()[0] < end) points.push_back({end, points.back()[1]});
  return points;
}

/// Returns the last time at which the level of a waveform changes; NaN if the level is constant.
double last_move(const Points& points) {
  double time = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (points[i][1] != points[i - 1][1]) time = points[i][0];
  }
  return time;
}

void add_columns(CurveTable& table, const char* x, const char* y, const Points& points) {
  for (const auto& [first, second] : points) {
    table[x].push_back(first);
    table[y].push_back(second);
  }
}

std::vector<Mark> rebound_marks(const ClosingRecord& result) {
  std::vector<Mark> marks;
  for (const Drawn& drawn : runs) {
    std::size_t highest = 0;
    std::vector<Mark> own;
    for (const Rebound& rebound : run_of(result, drawn).curve.rebounds) {
      const Mark mark{drawable(rebound.time_of_height), drawable(rebound.height), drawn.role, ""};
      if (!std::isfinite(mark.x) || !(mark.y > result.scene.significant_rebound)) continue;
      if (own.empty() || mark.y > own[highest].y) highest = own.size();
      own.push_back(mark);
    }
    if (!own.empty()) own[highest].text = quantity(own[highest].y, "m");
    marks.insert(marks.end(), own.begin(), own.end());
  }
  return marks;
}

/// Returns the end of the time range that the enlarged chart shows [s]. The range covers the closing and the changes of the
/// drive voltages under the best waveform, and the highest rebound under the plain step.
double landing_end(const ClosingRecord& result, const CurveTables& tables, double window) {
  double end = std::numeric_limits<double>::quiet_NaN();
  const auto cover = [&](double time) {
    if (time < window) end = std::fmax(end, time);
  };
  cover(figure_of_run(result.best, &Metrics::initial_contact_time));
  for (const auto& [name, table] : tables) {
    if (!name.starts_with("best/")) continue;
    Points points;
    for (std::size_t row = 0; row < table.at("time_s").size(); ++row)
      points.push_back({table.at("time_s")[row], table.at("level")[row]});
    if (last_move(points) < 0.5 * window) cover(last_move(points));
  }
  for (const RunRecord* run : {&result.baseline(), &result.best}) {
    double highest = -1;
    double until = std::numeric_limits<double>::quiet_NaN();
    for (const Rebound& rebound : run->curve.rebounds) {
      if (!(rebound.height > highest)) continue;
      highest = rebound.height;
      until = rebound.end;
    }
    cover(until);
  }
  constexpr double margin = 1.15;
  return end > 0 ? std::min(window, margin * end) : window;
}

/// Returns a column of the curves of a run; empty if the run lacks the column.
const std::vector<double>& column_of(const CurveTables& tables, const char* run, const char* name) {
  static const std::vector<double> none;
  const auto table = tables.find(run);
  if (table == tables.end()) return none;
  const auto column = table->second.find(name);
  return column == table->second.end() ? none : column->second;
}

/// Returns the largest value of a column of the curves in any run, at least 0.
double largest(const CurveTables& tables, const char* name) {
  double value = 0;
  for (const Drawn& drawn : runs) {
    for (const double one : column_of(tables, drawn.name, name)) value = std::fmax(value, one);
  }
  return value;
}

/// Returns the range of gaps around the contact plane that the enlarged chart shows [m]: below the plane, the deepest
/// indentation before `end`; above the plane, the rebounds under the best waveform or twice the indentation. Not set if no run
/// touches.
std::optional<std::array<double, 2>> plane_band(const ClosingRecord& result, const CurveTables& tables, double end) {
  double lowest = 0;
  for (const Drawn& drawn : runs) {
    const std::vector<double>& gaps = column_of(tables, drawn.name, "tip_gap_m");
    for (std::size_t row = 0; row < gaps.size() && tables.at(drawn.name).at("time_s")[row] <= end; ++row)
      lowest = std::fmin(lowest, gaps[row]);
  }
  if (lowest == 0) return std::nullopt;
  constexpr double margin = 1.15, words = 0.1;  // share of the range above the plane that the label of the plane needs below it
  const double height = drawable(figure_of_run(result.best, &Metrics::major_bounce_height));
  const double most = margin * std::fmax(-2 * lowest, height);
  return std::array{std::fmin(margin * lowest, -words * most), most};
}

/// Adds the curves and the drive waveforms of each run as tables to the description of the charts. Returns the names of the
/// electrodes, piezos and the dispersion force that have a waveform.
std::set<std::string> add_time_tables(const ClosingRecord& result, double window, Picture& out) {
  std::set<std::string> drives;
  for (const Drawn& drawn : runs) {
    const RunRecord& run = run_of(result, drawn);
    CurveTable table = curve_table(run.curve);
    if (!table.empty()) out.tables[drawn.name] = std::move(table);
    if (run.curve.closed) out.tables[fmt::format("closed/{}", drawn.name)] = closed_table(*run.curve.closed, window);
    for (const auto& [contact, closed] : run.curve.closed_contacts)
      out.tables[fmt::format("closed/{}/{}", drawn.name, contact)] = closed_table(closed, window);
    for (const auto& [drive, waveform] : run.waveforms) {
      const Points points = whole_waveform(waveform, drive_scale(drive).rest, window);
      if (points.size() < 2) continue;
      add_columns(out.tables[fmt::format("{}/{}", drawn.name, drive)], "time_s", "level", points);
      drives.insert(drive);
    }
  }
  return drives;
}

/// Adds the charts over time to a description of charts, which already has the tables of curves.
class TimeCharts {
 public:
  TimeCharts(const ClosingRecord& result, double window, Picture& out)
      : result_(result), window_(window), landing_(landing_end(result, out.tables, window)), out_(out) {}

  void add_gaps() {
    Chart gap = over_time("gap", "Gap: the whole closing", gap_caption(result_));
    gap.x_home = gap.x_whole;
    gap.y_label = "Gap";
    gap.y_unit = "m";
    gap.zero_line = true;
    gap.zero_label = "contact plane";
    gap.marks = rebound_marks(result_);
    gap.height = 320;
    add_series(gap, "", "tip_gap_m");
    Chart near = gap;
    constexpr double readable = 0.05;  // least labelled height of a rebound, as a share of the largest gap
    for (Mark& mark : gap.marks) {
      if (mark.y < readable * largest(out_.tables, "tip_gap_m")) mark.text.clear();
    }
    keep(std::move(gap));
    add_bars();

    near.id = "landing";
    near.zero_label_left = true;
    near.title = "Gap: the landing, close to the contact plane";
    near.caption = landing_caption(result_);
    near.x_home = {0, landing_};
    near.y_home = plane_band(result_, out_.tables, landing_);
    if (near.y_home) keep(std::move(near));
  }

  /// Adds bars for the times in which the contact is closed; for several contacts, a bar for their electrical connection, and a
  /// bar for each contact.
  void add_bars() {
    Chart bars = over_time("contact", "Contact: closed and open", contact_caption(result_));
    bars.x_home = bars.x_whole;
    bars.is_of_bars = true;
    for (const Drawn& drawn : runs) {
      const CurveRecord& curve = run_of(result_, drawn).curve;
      if (!curve.closed) continue;
      const std::string whose = !result_.search ? "" : drawn.role == Role::best ? best_label(result_) : baseline_label();
      const bool is_alone = curve.closed_contacts.empty();
      const auto add = [&](const std::string& table, const std::string& what) {
        const std::string label = whose.empty() || what.empty() ? whose + what : fmt::format("{}, {}", whose, what);
        bars.series.push_back({table, "closed", label, drawn.role});
      };
      const std::string table = fmt::format("closed/{}", drawn.name);
      add(table, !is_alone ? "connection" : whose.empty() ? "contact" : "");
      for (const auto& [contact, closed] : curve.closed_contacts) add(fmt::format("{}/{}", table, contact), contact);
    }
    bars.height = bar_height * static_cast<int>(bars.series.size());
    keep(std::move(bars));
  }

  void add_drive(const std::string& drive, int index) {
    Chart drawn = over_time(fmt::format("drive-{}", index), fmt::format("Drive: {}", drive), waveform_caption(result_, drive));
    drawn.y_label = drive_scale(drive).name;
    drawn.y_unit = drive_scale(drive).unit;
    drawn.height = 210;
    add_series(drawn, "/" + drive, "level");
    const DriveLimits limits = drive_limits(result_, drive);
    for (const auto& [name, level] :
         {std::pair{"upper limit of the driver", limits.highest}, {"lower limit of the driver", limits.lowest}}) {
      if (!std::isfinite(drawable(level)) || drawable(level) == 0) continue;  // the axis marks 0 V already
      const std::string table = fmt::format("driver/{}/{}", drive, level > limits.lowest ? "most" : "least");
      add_columns(out_.tables[table], "time_s", "level", {{0, level}, {window_, level}});
      drawn.series.push_back({table, "level", name, Role::limit});
    }
    keep(std::move(drawn));
  }

  void add_velocity() {
    Chart velocity = over_time("velocity", "Tip velocity", velocity_caption(result_));
    velocity.y_label = "Velocity";
    velocity.y_unit = "m/s";
    velocity.zero_line = true;
    velocity.height = 230;
    add_series(velocity, "", "tip_velocity_m_s");
    keep(std::move(velocity));
  }

  void add_force() {
    Chart force = over_time("force", "Contact force", force_caption(result_));
    force.y_label = "Force";
    force.y_unit = "N";
    force.height = 230;
    add_series(force, "", "contact_force_N");
    if (largest(out_.tables, "contact_force_N") > 0) keep(std::move(force));
  }

  void add_resistance() {
    Chart resistance = over_time("resistance", "Contact resistance",
                                 "Resistance of the contacts that make the connection. An open connection has no value.");
    resistance.y_label = "Resistance";
    resistance.y_unit = "ohm";
    resistance.scale = AxisScale::logarithmic;
    resistance.height = 230;
    add_series(resistance, "", "contact_resistance_ohm");
    if (!resistance.series.empty()) keep(std::move(resistance));
  }

 private:
  [[nodiscard]] Chart over_time(std::string id, std::string title, std::string caption) const {
    Chart chart;
    chart.id = std::move(id);
    chart.title = std::move(title);
    chart.caption = std::move(caption);
    chart.x_column = "time_s";
    chart.x_label = "Time";
    chart.x_unit = "s";
    chart.x_whole = {0, window_};
    chart.x_home = {0, landing_};
    chart.group = "time";
    return chart;
  }

  void add_series(Chart& chart, const std::string& suffix, const char* column) const {
    for (const Drawn& drawn : runs) {
      const auto table = out_.tables.find(drawn.name + suffix);
      if (table == out_.tables.end() || !table->second.contains(column)) continue;
      const std::string label = drawn.role == Role::best ? best_label(result_) : baseline_label();
      chart.series.push_back({table->first, column, label, drawn.role});
    }
  }

  void keep(Chart chart) {
    if (!chart.series.empty()) out_.charts.push_back(std::move(chart));
  }

  const ClosingRecord& result_;
  double window_, landing_;  // end of the whole time range and of the enlarged time range of the charts [s]
  Picture& out_;
};

void add_time_charts(const ClosingRecord& result, Picture& out) {
  const double window = window_end(result);
  if (!(window > 0)) return;
  const std::set<std::string> drives = add_time_tables(result, window, out);
  TimeCharts charts(result, window, out);
  charts.add_gaps();
  int index = 0;
  for (const std::string& drive : drives) charts.add_drive(drive, index++);
  charts.add_velocity();
  charts.add_force();
  charts.add_resistance();
}

void add_search_chart(const ClosingRecord& result, const SearchRecord& search, Picture& out) {
  Points tried = drawable(search.course.evaluations);
  Points best = drawable(search.course.best_so_far);
  if (tried.empty() && best.empty()) return;
  const std::vector<double> indices = evaluation_indices(search.course);
  for (Points* points : {&tried, &best}) {
    for (auto& [index, value] : *points) index = evaluations_until(indices, index);
  }
  double last = std::max(tried.empty() ? 0.0 : tried.back()[0], best.empty() ? 0.0 : best.back()[0]);
  last = std::fmax(last, drawable(search.evaluations));
  bool positive = true;
  for (const Points* points : {&tried, &best}) {
    positive = positive && std::all_of(points->begin(), points->end(), [](const auto& point) { return point[1] > 0; });
  }
  Chart chart;
  chart.id = "search";
  chart.title = "Convergence";
  chart.caption = search_caption(result, search);
  chart.x_column = "evaluation";
  chart.x_label = "Evaluations";
  chart.x_home = chart.x_whole = {0, std::max(1.0, last)};
  chart.y_label = capitalised(search.course.value_name.empty() ? "cost" : search.course.value_name);
  chart.scale = positive ? AxisScale::logarithmic : AxisScale::linear;
  chart.height = 260;
  if (!tried.empty()) {
    add_columns(out.tables["tried"], "evaluation", "value", tried);
    chart.series.push_back({"tried", "value", "each waveform tried", Role::evaluations});
  }
  if (!best.empty()) {
    Points stairs;  // points of the best cost so far over the evaluations: the cost stays constant until a better one is found
    for (const auto& point : best) {
      if (!stairs.empty()) stairs.push_back({point[0], stairs.back()[1]});
      stairs.push_back(point);
    }
    stairs.push_back({last, stairs.back()[1]});
    add_columns(out.tables["search"], "evaluation", "value", stairs);
    chart.series.push_back({"search", "value", "best so far", Role::best});
  }
  out.charts.push_back(std::move(chart));
}

}  // namespace

CurveTable closed_table(const std::vector<ClosedStretch>& closed, double window) {
  Points points{{0, 0}};
  for (const ClosedStretch& one : closed) {
    const double begin = std::max(points.back()[0], drawable(one.begin)), end = std::isnan(one.end) ? window : drawable(one.end);
    if (!(begin <= end && end <= window)) continue;
    const double level = one.touches > 1 ? 0.5 : 1;
    points.insert(points.end(), {{begin, 0}, {begin, level}, {end, level}});
    if (!std::isnan(one.end)) points.push_back({end, 0});
  }
  if (points.back()[0] < window) points.push_back({window, points.back()[1]});
  CurveTable table;
  add_columns(table, "time_s", "closed", points);
  return table;
}

Picture picture(const ClosingRecord& result) {
  Picture out;
  add_time_charts(result, out);
  if (result.search) add_search_chart(result, *result.search, out);
  return out;
}

}  // namespace softland::internal

namespace softland {

internal::Picture gap_and_drives(const ClosingRecord& result) {
  using namespace internal;
  Picture drawn = picture(result);
  std::erase_if(drawn.charts,
                [](const Chart& chart) { return chart.id != "gap" && chart.id != "landing" && !chart.id.starts_with("drive"); });
  for (Chart& chart : drawn.charts) chart.height = chart.id.starts_with("drive") ? 120 : 220;
  return drawn;
}

std::string svg_gap_chart(const ClosingRecord& result) {
  // The headline of a search over devices is about the devices; the curves are not.
  const std::string whose = result.devices() != nullptr ? "The curves are those of the nominal design." : "";
  const std::string between = result.title.empty() || whose.empty() ? "" : ". ";
  return svg_page(internal::headline(result).whole(), result.title + between + whose, gap_and_drives(result));
}

}  // namespace softland
