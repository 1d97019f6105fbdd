#include "reports/cycle_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "document/axis.h"
#include "document/chart.h"
#include "document/document.h"
#include "document/downsample.h"
#include "document/page.h"
#include "document/quantity.h"
#include "document/svg.h"
#include "reports/closing_charts.h"
#include "reports/device_picture.h"
#include "reports/study_members.h"
#include "sampling/statistics.h"
#include "waveforms/export.h"

namespace softland {
namespace {

using internal::quantity;
using internal::share_text;
using nlohmann::json;

constexpr std::size_t most_of_course = 4000;  // largest number of points in a drawn curve of the gap over the cycles
// Largest error of the piecewise linear waveforms in the report, as a share of the peak voltage.
constexpr double line_tolerance = 1e-4;
constexpr std::size_t shown_cycles = 3;  // number of first cycles in the table of the report, which also has the last cycle
constexpr std::size_t most_drawn_cycles = 200;

CycleRecord::Devices devices_of(const CycledDrive& drive, double rate) {
  const std::vector<double>& rates = drive.of_devices;
  const auto steady = std::ranges::count_if(rates, [&](double own) { return own >= rate; });
  return {.count = rates.size(),
          .at_5 = sample_quantile(rates, 0.05),
          .at_50 = sample_quantile(rates, 0.5),
          .at_95 = sample_quantile(rates, 0.95),
          .steady = static_cast<double>(steady) / static_cast<double>(rates.size())};
}

// Returns the waveforms of electrodes and piezos in one cycle, without the factor of the dispersion force.
std::map<std::string, Points> waveforms_of(const PreparedScene& given, const CycledDrive& drive, const CycleTimes& times) {
  std::map<std::string, Points> all;
  CycleTimes once = times;
  once.cycles = 1;
  const std::vector<Signal> signals = cycled(drive.waveforms, once);
  const std::vector<std::string> names = given.drive_names();
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] == dispersion_drive) continue;
    const double size = std::max(signals[k].peak(), 1e-9);
    for (const auto& [time, voltage] : polyline(signals[k], once.period, line_tolerance * size, 0))
      all[names[k]].push_back({time, voltage});
  }
  return all;
}

CycleRecord::Course course_of(const Cycles& cycles) {
  std::vector<double> time, gap;
  for (const auto& [t, g] : cycles.gap) time.push_back(t), gap.push_back(g);
  CycleRecord::Course course;
  for (const std::size_t row : internal::downsampled({&gap}, most_of_course)) {
    course.time.push_back(time[row]);
    course.gap.push_back(gap[row]);
  }
  course.closed = closed_stretches(cycles.touches);
  return course;
}

const CycleRecord::Drive& found_of(const CycleRecord& r) { return r.drives.back(); }

std::string rate_prose(double rate) { return std::isfinite(rate) ? quantity(rate, "Hz") : std::string("none"); }

// Returns the largest value of a figure of merit in the cycles that the report shows.
double hardest(const CycleRecord::Drive& drive, double Metrics::*figure) {
  double most = 0;
  for (const CycleRecord::Cycle& cycle : drive.cycles) most = std::fmax(most, cycle.metrics.*figure);
  return most;
}

// Describes what the switch does in the cycles of a drive that the report shows: "does not open in every cycle".
std::string outcome_of(const CycleRecord::Drive& drive) {
  if (drive.cycles.empty()) return "could not be simulated";
  // A switch that stays closed does not touch in the next cycle either: the first cycle that fails gives the reason.
  const auto fails = [](const auto& c) { return !c.metrics.touched() || !std::isfinite(c.metrics.opening_time); };
  if (const auto first = std::ranges::find_if(drive.cycles, fails); first != drive.cycles.end())
    return fmt::format("does not {} in every cycle", first->metrics.touched() ? "open" : "close");
  const double height = hardest(drive, &Metrics::major_bounce_height);
  return fmt::format("has impact velocities of up to {} and {}",
                     quantity(hardest(drive, &Metrics::largest_impact_velocity), "m/s"),
                     height > 0 ? "rebounds by up to " + quantity(height, "m") : std::string("does not rebound"));
}

std::string finding(const CycleRecord& r) {
  if (r.drives.empty()) return "No rate was tried.";
  const CycleRecord::Drive &plain = r.drives.front(), &found = found_of(r);
  if (found.steady_rates.empty() && found.other_rates.empty()) {
    if (!std::isfinite(r.rate)) return "The switch does not close and return to rest, so no rate can be scanned.";
    if (r.drives.size() == 1)
      return fmt::format("At {} the switch {} with plain steps.", quantity(r.rate, "Hz"), outcome_of(plain));
    return fmt::format("At {} the switch {} with these waveforms; with plain steps it {}.", quantity(r.rate, "Hz"),
                       outcome_of(found), outcome_of(plain));
  }
  const auto at = [](double rate) {
    return std::isfinite(rate) ? "at rates of up to " + quantity(rate, "Hz") : std::string("at no rate of the scan");
  };
  if (r.drives.size() == 1) return fmt::format("With plain steps every cycle closes like the first one {}.", at(plain.largest));
  const bool is_slower = std::isfinite(plain.largest) && !(found.largest >= plain.largest);
  return fmt::format("With these waveforms every cycle closes like the first one {}; with plain steps, {}.{}", at(found.largest),
                     at(plain.largest), is_slower ? " The waveforms lower the rate of cycling." : "");
}

std::string name_words(const CycleRecord& r, const CycleRecord::Drive& drive) {
  return &drive == &r.drives.front() ? "plain" : "waveforms";
}

ReportTable rates_table(const CycleRecord& r) {
  ReportTable table{.head = {""}, .rows = {{"largest steady rate"}, {"steady again at"}}};
  const bool has_devices = std::ranges::any_of(r.drives, [](const CycleRecord::Drive& d) { return d.devices.has_value(); });
  if (has_devices)
    table.rows.insert(table.rows.end(),
                      {{"largest steady rate of 95 % of the devices"}, {"largest steady rate of half of the devices"}});
  const bool has_rate = has_devices && std::isfinite(r.rate);
  if (has_rate) table.rows.push_back({fmt::format("devices steady at {}", quantity(r.rate, "Hz"))});
  for (const CycleRecord::Drive& d : r.drives) {
    table.head.push_back(name_words(r, d));
    std::string windows;
    for (const auto& [low, high] : d.windows)
      windows += (windows.empty() ? "" : ", ") +
                 (low == high ? quantity(low, "Hz") : quantity(low, "Hz") + " to " + quantity(high, "Hz"));
    table.rows[0].push_back(rate_prose(d.largest));
    table.rows[1].push_back(windows.empty() ? "—" : windows);
    if (!has_devices) continue;
    table.rows[2].push_back(d.devices ? rate_prose(d.devices->at_5) : "—");
    table.rows[3].push_back(d.devices ? rate_prose(d.devices->at_50) : "—");
    if (has_rate) table.rows[4].push_back(d.devices ? share_text(d.devices->steady) : "—");
  }
  return table;
}

ReportTable cycles_table(const CycleRecord::Drive& drive, const std::string& name) {
  struct Row {
    const char* name;
    Figure::Member member;
  };
  const std::array rows{Row{"first contact", &Metrics::initial_contact_time},
                        Row{"largest impact velocity", &Metrics::largest_impact_velocity},
                        Row{"rebounds", &Metrics::bounce_count},
                        Row{"highest rebound", &Metrics::major_bounce_height},
                        Row{"opening time", &Metrics::opening_time},
                        Row{"bounces on opening", &Metrics::release_bounces},
                        Row{"smallest gap after opening", &Metrics::least_gap_open},
                        Row{"time in contact", &Metrics::closed_time},
                        Row{"impact energy", &Metrics::impact_energy},
                        Row{"contact pressure over hardness", &Metrics::pressure},
                        Row{"charge at make", &Metrics::make_charge},
                        Row{"charge at break", &Metrics::break_charge},
                        Row{"drive energy", &Metrics::drive_energy}};
  ReportTable table{.head = {name + ", cycle"}, .rows = {}};
  std::vector<std::size_t> shown;
  for (std::size_t n = 0; n < drive.cycles.size(); ++n) {
    if (n < shown_cycles || n + 1 == drive.cycles.size()) shown.push_back(n);
  }
  for (const std::size_t n : shown) table.head.push_back(std::to_string(n + 1));
  for (const Row& row : rows) {
    const Figure& figure = figure_of(row.member);
    if (!figure.is_asked(drive.cycles.front().metrics.asked)) continue;
    TableRow cells{row.name};
    for (const std::size_t n : shown) {
      const double value = figure.value(drive.cycles[n].metrics);
      cells.push_back(!std::isfinite(value) ? "—"
                      : figure.is_count()   ? fmt::format("{:.0f}", value)
                                            : quantity(value, figure.unit));
    }
    table.rows.push_back(std::move(cells));
  }
  TableRow on_times{"time electrically closed"};
  for (const std::size_t n : shown) on_times.push_back(quantity(drive.cycles[n].on_time, "s"));
  table.rows.push_back(std::move(on_times));
  return table;
}

}  // namespace

void members(internal::Archive& a, CycleRecord::Devices& d) {
  a("count", d.count, "number of devices");
  a("largest_rate_5_Hz", d.at_5, "5th percentile of the largest rate with steady cycles");
  a("largest_rate_50_Hz", d.at_50, "median of that rate");
  a("largest_rate_95_Hz", d.at_95, "95th percentile of that rate");
  a("steady_at_rate", d.steady, "share of devices with steady cycles at `rate_Hz`");
}

void members(internal::Archive& a, CycleRecord::Cycle& cycle) {
  members(a, cycle.metrics);
  a(key_of(&Metrics::largest_impact_velocity), cycle.metrics.largest_impact_velocity,
    "largest impact velocity of all touches of the cycle");
  a("on_time_s", cycle.on_time, "time in which the switch is electrically closed");
}

void members(internal::Archive& a, CycleRecord::Drive& d) {
  a("name", d.name, "pair of a closing and an opening waveform");
  a("largest_rate_Hz", d.largest, "largest rate with steady cycles");
  a("windows_Hz", d.windows, "ranges of higher rates with steady cycles");
  a("steady_rates_Hz", d.steady_rates, "simulated rates with steady cycles");
  a("other_rates_Hz", d.other_rates, "simulated rates without");
  a("devices", internal::OrNull{d.devices}, "rates under process variation");
  a("status", d.status, "outcome of the run at `rate_Hz`");
  a("message", d.message, "why the run is not done");
  a("cycles", d.cycles, "figures of each cycle");
  a("waveforms", d.waveforms, "waveform of one cycle by drive: time [s], level [V]");
}

void members(internal::Archive& a, CycleRecord::Course& course) {
  a("time_s", course.time, "time since the start of the run");
  a("tip_gap_m", course.gap, "gap of the contact");
  a.custom("closed", course.closed, internal::closed_json, internal::read_closed,
           internal::Like<std::vector<std::array<double, 3>>>{
               "times in which the contact is closed: begin [s], end [s] (null: to the end of the run), touches"});
}

void members(internal::Archive& a, CycleRecord::Search& search) {
  a("target", search.target, "target of the search");
  a("family", search.family, "waveform family of the closing waveform");
  a("evaluations", search.evaluations, "number of evaluations");
  a("cost", search.cost, "cost of the found pair");
  a("plain_cost", search.plain_cost, "cost of the plain steps");
  a("parameters", search.parameters, "parameters of the found waveforms");
}

void members(internal::Archive& a, CycleRecord& r) {
  members(a, r.origin);
  a("status", r.status, "`done` or `interrupted`");
  a("rate_Hz", r.rate, "cycle rate");
  a("duty", r.duty, "share of the cycle in which the switch is commanded closed");
  a("cycles", r.cycles, "number of simulated cycles");
  a("seed", r.seed, "seed of devices and search");
  a("contact_gap_m", r.contact_gap, "rest gap of the contact");
  a("drives", r.drives, "results by pair of waveforms, the plain steps first");
  if (a.has(r.search.has_value())) a("search", r.search, "search of the waveforms, if they were not given");
  a("warnings", r.warnings, "warnings of the scene");
  if (a.has(!r.curves.empty())) a("curves", r.curves, "gap over time by pair of waveforms, in files only");
}

CycleRecord record_of(const PreparedScene& given, const Cycling& cycling, const std::string& command) {
  CycleRecord record{.origin = whole_origin_of("cycle", given, command),
                     .status = cycling.interrupted ? "interrupted" : "done",
                     .rate = cycling.rate,
                     .duty = cycling.options.duty,
                     .cycles = cycling.options.cycles,
                     .seed = cycling.options.seed,
                     .contact_gap = given.model.contact_gap(),
                     .drives = {},
                     .warnings = given.scene.warnings,
                     .curves = {}};
  for (const CycledDrive& drive : cycling.drives) {
    CycleRecord::Drive& own = record.drives.emplace_back();
    own.name = drive.waveforms.name;
    own.largest = drive.scan.largest;
    for (const auto& [low, high] : drive.scan.windows) own.windows.push_back({low, high});
    for (const RateScan::Rate& one : drive.scan.rates) (one.is_steady ? own.steady_rates : own.other_rates).push_back(one.rate);
    if (!drive.of_devices.empty()) own.devices = devices_of(drive, cycling.rate);
    if (!drive.cycles) continue;
    own.status = to_string(drive.cycles->status);
    own.message = drive.cycles->message;
    for (const CycleFigures& one : drive.cycles->cycles) own.cycles.push_back({.metrics = one.metrics, .on_time = one.on_time});
    own.waveforms = waveforms_of(given, drive, drive.cycles->times);
    record.curves[own.name] = course_of(*drive.cycles);
  }
  return record;
}

CycleRecord record_of(const CycleSearchResult& found, const CycleSearchOptions& options, const std::string& command) {
  CycleRecord record = record_of(found.given, found.cycling, command);
  record.search = {.target = options.target.text(),
                   .family = found.family,
                   .evaluations = static_cast<std::uint64_t>(found.evaluations),
                   .cost = found.cost,
                   .plain_cost = found.plain_cost,
                   .parameters = found.parameters};
  return record;
}

std::string cycle_csv(const CycleSearchResult& found) {
  CycleTimes once = found.cycling.drives.back().cycles->times;
  once.cycles = 1;
  const std::vector<Signal> signals = cycled(found.cycling.drives.back().waveforms, once);
  const std::vector<std::string> names = found.given.drive_names();
  std::map<std::string, Signal> driven;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] != dispersion_drive) driven.emplace(names[k], signals[k]);
  }
  return csv(driven, once.period);
}

json json_of(const CycleRecord& record) { return internal::record_json(record); }

CycleRecord read_cycles(const json& from) { return internal::whole_record<CycleRecord>(from); }

namespace {

internal::Role role_of(const CycleRecord& r, const CycleRecord::Drive& d) {
  return &d == &r.drives.front() ? internal::Role::baseline : internal::Role::best;
}

// Returns charts over the time of the cycles. The charts share their zoom and at first show the first cycles.
internal::Picture picture_of(const CycleRecord& r) {
  using internal::Chart;
  const double period = 1 / r.rate, first = period * static_cast<double>(std::min<std::uint64_t>(r.cycles, shown_cycles));
  const std::size_t cycles = std::min<std::uint64_t>(r.cycles, most_drawn_cycles);
  const double end = period * static_cast<double>(cycles);
  internal::Picture drawn;
  const auto chart = [&](const std::string& id, const std::string& title, const char* y_label, const char* unit, int height) {
    Chart one = internal::chart_over_time(id, title, y_label, unit, first, height);
    one.x_whole = {0, end};
    one.group = "time";
    return one;
  };
  Chart gap = chart("gap", "Gap", "Gap", "m", 320), bars = chart("contact", "Contact: closed and open", "", "", 0);
  gap.caption = "Distance of the contact point from the contact plane (positive: open).";
  gap.zero_line = true;
  gap.zero_label = "contact plane";
  bars.caption = "The bars are filled while the contact point touches.";
  bars.is_of_bars = true;
  std::map<std::string, Chart> drives;
  for (const CycleRecord::Drive& d : r.drives) {
    const auto found = r.curves.find(d.name);
    if (found == r.curves.end()) continue;
    const CycleRecord::Course& course = found->second;
    const std::string name = name_words(r, d);
    drawn.tables[name] = {{"time_s", course.time}, {"tip_gap_m", course.gap}};
    gap.series.push_back({name, "tip_gap_m", name, role_of(r, d)});
    if (course.closed) {
      drawn.tables["closed/" + name] = internal::closed_table(*course.closed, end);
      bars.series.push_back({"closed/" + name, "closed", name, role_of(r, d)});
    }
    for (const auto& [drive, points] : d.waveforms) {
      const std::string table = name + "/" + drive;
      for (std::size_t n = 0; n < cycles; ++n) {
        for (const auto& [time, voltage] : points) {
          drawn.tables[table]["time_s"].push_back(time + static_cast<double>(n) * period);
          drawn.tables[table]["level"].push_back(voltage);
        }
      }
      const std::string id = fmt::format("drive-{}", drives.size());
      const auto one = drives.try_emplace(drive, chart(id, "Drive: " + drive, "Voltage", "V", 210)).first;
      one->second.series.push_back({table, "level", name, role_of(r, d)});
    }
  }
  bars.height = internal::bar_height * static_cast<int>(bars.series.size());
  drawn.charts.push_back(std::move(gap));
  if (!bars.series.empty()) drawn.charts.push_back(std::move(bars));
  for (auto& [drive, one] : drives) drawn.charts.push_back(std::move(one));
  return drawn;
}

std::string cycle_charts(const internal::Picture& drawn) {
  std::string charts =
      "<div class=\"tools\" hidden><span role=\"group\" aria-label=\"Time shown\">"
      "<button type=\"button\" data-view=\"home\" aria-pressed=\"true\">First cycles</button>"
      "<button type=\"button\" data-view=\"whole\" aria-pressed=\"false\">All cycles</button></span>"
      "<span class=\"hint\">Drag to zoom, double-click to go back. With a chart focused: ← → read, + − zoom, 0 "
      "back.</span></div>\n";
  for (const internal::Chart& chart : drawn.charts) charts += internal::figure_html(drawn.tables, chart);
  return charts;
}

// Draws a row for each pair of a closing and an opening waveform, with the simulated cycle rates: a dot where all cycles are
// alike (steady), a ring for other rates.
std::string drawn_rates(const CycleRecord& r) {
  constexpr double left = 110, right = 780, row = 26;
  internal::Axis axis{.scale = internal::AxisScale::logarithmic, .low = 1e300, .high = 0, .pixel_low = left, .pixel_high = right};
  for (const CycleRecord::Drive& d : r.drives) {
    for (const std::vector<double>* rates : {&d.steady_rates, &d.other_rates}) {
      for (const double rate : *rates) axis.low = std::fmin(axis.low, rate / 1.1), axis.high = std::fmax(axis.high, 1.1 * rate);
    }
  }
  if (!(axis.low > 0 && axis.low < axis.high)) return {};
  std::string out;
  double y = 16;
  for (const CycleRecord::Drive& d : r.drives) {
    out += internal::drawn_line(left, y, right, y, "guide") + internal::drawn_words(0, y + 4, "start", name_words(r, d));
    const auto add = [&](const std::vector<double>& rates, const char* style) {
      for (const double rate : rates)
        out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" class=\"{}\"/>\n", axis.pixel(rate), y, style);
    };
    add(d.steady_rates, "steady");
    add(d.other_rates, "unsteady");
    y += row;
  }
  for (const double rate : {1.1 * axis.low, std::sqrt(axis.low * axis.high), axis.high / 1.1})
    out += internal::drawn_words(axis.pixel(rate), y + 4, "middle", quantity(rate, "Hz"));
  return fmt::format(
      "<svg class=\"sketch\" viewBox=\"0 0 820 {:.0f}\" role=\"img\" aria-label=\"The rates that were "
      "tried\">\n{}</svg>\n<p class=\"below\">The rates that were tried: a dot is steady, a ring is not.</p>\n",
      y + 12, out);
}

std::vector<KeyNumber> keys_of(const CycleRecord& r) {
  std::vector<KeyNumber> keys;
  if (r.drives.empty()) return keys;
  const CycleRecord::Drive &plain = r.drives.front(), &found = found_of(r);
  const auto add = [&](const char* name, const std::string& before, const std::string& value) {
    keys.push_back({.name = name, .value = value, .before = r.drives.size() > 1 ? before : ""});
  };
  if (!found.steady_rates.empty() || !found.other_rates.empty())
    add("Largest steady rate", rate_prose(plain.largest), rate_prose(found.largest));
  const auto largest = [](const CycleRecord::Drive& drive, double Metrics::*member, std::string_view unit) {
    double most = Metrics::unset;
    for (const CycleRecord::Cycle& cycle : drive.cycles) most = std::fmax(most, cycle.metrics.*member);
    return quantity(most, unit);
  };
  if (found.cycles.empty()) return keys;
  keys.push_back({.name = "Rate of the cycles", .value = quantity(r.rate, "Hz")});
  add("Largest impact velocity", largest(plain, &Metrics::largest_impact_velocity, "m/s"),
      largest(found, &Metrics::largest_impact_velocity, "m/s"));
  add("Highest rebound", largest(plain, &Metrics::major_bounce_height, "m"), largest(found, &Metrics::major_bounce_height, "m"));
  return keys;
}

}  // namespace

Document document_of(const CycleRecord& r) {
  Document document{.title = title_of(r.origin),
                    .origin = r.origin.kind,
                    .headline = finding(r),
                    .doubt = r.status == "interrupted" ? "Interrupted: what follows is the part that was computed." : "",
                    .keys = keys_of(r),
                    .sections = {},
                    .warnings = r.warnings,
                    .made = made_again(r.origin, r.seed)};
  if (r.search && std::isfinite(r.search->cost)) {
    document.headline_rest = fmt::format(
        " The worst of the first cycles has a cost of {:.4f} (plain steps {:.4f}), after {} evaluations of waveform pairs "
        "(target {}, closing waveform of the family {}).",
        r.search->cost, r.search->plain_cost, r.search->evaluations, r.search->target, r.search->family);
  }
  if (!r.curves.empty()) {
    document.draw = [&r] { return picture_of(r); };
    document.sections.push_back({.id = "charts", .heading = "The cycles", .parts = {Drawing{cycle_charts}}});
  }
  ReportSection rates{.id = "rates", .heading = "Rates", .parts = {rates_table(r)}};
  rates.parts.emplace_back(Paragraph{
      .text = fmt::format(
          "A rate is steady if {} cycles close and open, with an impact velocity and a rebound within 5 % of those of the first "
          "cycle. All rates up to the largest steady rate are steady, in steps of 5 %, at a duty cycle of {}\u00a0%.",
          r.cycles, internal::plain_number(100 * r.duty, 3)),
      .is_note = true});
  rates.parts.emplace_back(Drawing{[&r](const internal::Picture&) { return drawn_rates(r); }});
  const bool has_scan =
      std::ranges::any_of(r.drives, [](const auto& d) { return !d.steady_rates.empty() || !d.other_rates.empty(); });
  if (has_scan) document.sections.push_back(std::move(rates));
  for (const CycleRecord::Drive& drive : r.drives) {
    if (drive.cycles.empty()) continue;
    document.sections.push_back({.id = "cycles-" + name_words(r, drive),
                                 .heading = fmt::format("Cycles at {}, {}", quantity(r.rate, "Hz"), name_words(r, drive)),
                                 .parts = {cycles_table(drive, name_words(r, drive))}});
    if (drive.message && !drive.message->empty()) document.sections.back().parts.emplace_back(Paragraph{*drive.message});
  }
  return document;
}

std::string svg_of(const CycleRecord& r) { return svg_page(finding(r), title_of(r.origin), picture_of(r), 1); }

}  // namespace softland
