#include "reports/pull_in_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/require.h"
#include "document/chart.h"
#include "document/csv_cell.h"
#include "document/quantity.h"
#include "document/svg.h"
#include "document/text.h"
#include "model/pull_in.h"
#include "reports/closing_record.h"
#include "reports/study_members.h"
#include "studies/closing/closed_state.h"
#include "studies/devices/stable_approach.h"

namespace softland {

using internal::quantity;
using nlohmann::json;

namespace {

// JSON keys of the static voltages by number of modes.
constexpr std::array by_modes_rows{std::pair("static_V", &VoltagesByModes::static_pull_in),
                                   std::pair("release_V", &VoltagesByModes::release),
                                   std::pair("pulled_through_V", &VoltagesByModes::pulled_through)};

// Writes pull-in, release and collapse voltages by the number of modes; JSON is null if they were not computed.
json voltages_by_modes_json(const std::optional<VoltagesByModes>& found) {
  json all;
  for (const auto& [key, voltage] : by_modes_rows) {
    if (found && !(*found.*voltage).values.empty()) all[key] = internal::by_modes_json(*found.*voltage);
  }
  return all;
}

std::optional<VoltagesByModes> read_voltages_by_modes(const json& from) {
  if (!from.is_object()) return std::nullopt;
  VoltagesByModes all;
  for (const auto& [key, voltage] : by_modes_rows)
    all.*voltage = internal::read_by_modes(internal::value_at(from, key)).value_or(ByModes{});
  return all;
}

std::string dynamic_kind(const PreparedScene& p, std::size_t k, double statically, double dynamically) {
  if (!std::isfinite(dynamically)) return {};
  if (!(dynamically >= (1 - dynamic_pull_in_precision) * statically)) return "overshoot";
  std::vector<double> levels = bias_of(p.scene, k);
  levels[k] = statically;
  return leaves_at_rest(p.model, bias_of(p.scene, k), levels) ? "unstable_rest" : "overdamped";
}

std::string_view branch_name(const SweepPoint& p) { return p.is_up ? "up" : "down"; }

// Returns the points of the rising or the falling half of a voltage sweep as columns in rising order of the voltage.
internal::CurveTable branch_of(std::vector<SweepPoint> points, bool is_up) {
  std::erase_if(points, [&](const SweepPoint& p) { return p.is_up != is_up || p.state == SweepState::none; });
  std::stable_sort(points.begin(), points.end(), [](const SweepPoint& a, const SweepPoint& b) { return a.voltage < b.voltage; });
  internal::CurveTable columns{{"voltage", {}}, {"deflection", {}}, {"capacitance", {}}};
  for (const SweepPoint& p : points) {
    columns["voltage"].push_back(p.voltage);
    columns["deflection"].push_back(p.deflection);
    columns["capacitance"].push_back(p.capacitance);
  }
  return columns;
}

internal::Chart sweep_chart(const std::string& column, const std::string& title, const std::string& unit, double low, double high,
                            bool goes_down) {
  internal::Chart chart{.id = column,
                        .title = title,
                        .x_column = "voltage",
                        .x_label = "voltage",
                        .x_unit = "V",
                        .y_label = column,
                        .y_unit = unit,
                        .x_home = {low, high},
                        .x_whole = {low, high}};
  chart.series = {{.table = "up", .column = column, .label = "up"}};
  if (goes_down) chart.series.push_back({.table = "down", .column = column, .label = "down", .role = internal::Role::baseline});
  return chart;
}

// Returns the voltage at which the beam collapses onto the electrode in a sweep, after which no law describes how the beam
// comes off; NaN without a collapse.
double collapse_of(const PullInsRecord& record) {
  const auto first = std::ranges::find_if(record.sweep, [](const SweepPoint& p) { return p.state == SweepState::none; });
  if (first == record.sweep.end()) return Metrics::unset;
  if (first == record.sweep.begin()) return first->voltage;
  const SweepPoint& before = *std::prev(first);
  const PullInRecord& known = record.electrodes.at(record.swept).volts;
  const double exact = before.state == SweepState::closed ? known.pulled_through : known.static_pull_in;
  return before.voltage < exact && exact <= first->voltage ? exact : first->voltage;
}

std::string collapse_prose(const PullInsRecord& record) {
  const double collapse = collapse_of(record);
  return std::isfinite(collapse) ? fmt::format("In the sweep the beam collapses onto electrode {} at {} and stays there",
                                               record.swept, volts(collapse))
                                 : std::string();
}

// Describes the kind of static pull-in (how the stable equilibrium ends); empty without pull-in.
std::string kind_prose(const std::string& kind) {
  if (kind.empty()) return {};
  return kind == to_string(StaticKind::fold) ? " (fold of the static branch)" : " (the contact point reaches the contact first)";
}

std::string shift_clause(const std::optional<VoltagesByModes>& found, ByModes VoltagesByModes::*voltage) {
  const std::string shift = found ? shift_prose(*found.*voltage) : std::string();
  return shift.empty() ? shift : "; more modes change it by " + shift;
}

// Returns true if the scene has contacts. The face of a dielectric is also a contact if the key `landing` gives its contact
// law.
bool makes_contact(const json& scene) {
  const json electrodes = scene.value("electrode", json::object());
  return scene.contains("contact") || std::ranges::any_of(electrodes, [](const json& electrode) {
           return electrode.value("dielectric", json::object()).contains("landing");
         });
}

std::string electrode_prose(const std::string& name, const ElectrodeRecord& electrode, bool is_far, bool has_contact) {
  constexpr int digits = 4;
  std::string text = fmt::format("electrode {}\n", name);
  if (is_far) return text + "  on the far side: pulls away from the contact\n";
  if (const std::string bias = bias_prose(electrode); !bias.empty()) text += fmt::format("  under            {}\n", bias);
  if (electrode.status == Status::no_contact)
    return text + "  pulls away from the contact where the switch rests: no pull-in voltage\n";
  const PullInRecord& found = electrode.volts;
  text +=
      electrode.status == Status::collapsed_at_rest
          ? fmt::format("  {}\n", no_open_state)
          : fmt::format("  static pull-in   {}{}{}\n  pull-in position {}\n  dynamic pull-in  {}\n", volts(found.static_pull_in),
                        kind_prose(found.static_kind), shift_clause(found.by_modes, &VoltagesByModes::static_pull_in),
                        std::isfinite(found.deflection) ? quantity(found.deflection, "m", digits) : "none",
                        electrode.status == Status::interrupted ? std::string("not known: the search for it was interrupted")
                                                                : dynamic_prose(found));
  const std::string of_charge =
      std::isfinite(found.neutral) ? fmt::format("  charge           {}\n", charge_prose(found)) : std::string();
  if (!has_contact) return text + of_charge;
  text += fmt::format("  release          {}{}\n", volts(found.release), shift_clause(found.by_modes, &VoltagesByModes::release));
  if (const std::string words = brief_contact_prose(found); !words.empty()) text += fmt::format("                   {}\n", words);
  if (std::isfinite(found.pulled_through))
    text += fmt::format("  collapse         {}: from there on a closed switch collapses onto the electrode{}\n",
                        volts(found.pulled_through), shift_clause(found.by_modes, &VoltagesByModes::pulled_through));
  return text + of_charge;
}

}  // namespace

void members(internal::Archive& a, PullInRecord& found) {
  a("static_V", found.static_pull_in, "static pull-in voltage");
  a("static_kind", internal::OrNull{found.static_kind}, "how the stable equilibrium ends: `fold` or `contact`");
  a("deflection_m", found.deflection, "deflection of the contact point at the static voltage");
  a("dynamic_V", found.dynamic_pull_in, "dynamic pull-in voltage");
  a("dynamic_kind", internal::OrNull{found.dynamic_kind},
    "`overshoot`; `overdamped`: equals the static voltage; `unstable_rest`: no step moves the switch");
  a("release_V", found.release, "release voltage");
  a("pulled_through_V", found.pulled_through, "voltage at which the closed structure collapses onto the electrode");
  if (a.has(std::isfinite(found.neutral))) a("neutral_V", found.neutral, "voltage without a field, for a charged dielectric");
  a.custom("by_modes", found.by_modes, voltages_by_modes_json, read_voltages_by_modes,
           internal::Like<std::map<std::string, std::map<std::string, double>>>{
               "each voltage by number of modes, `converged`: extrapolated; null for a plate and a table of modes"});
}

void members(internal::Archive& a, StablePathRecord& path) {
  std::vector<std::string> drives{path.drive};
  if (a.reads()) drives.clear();
  a("drives", drives, "drive that moves the switch to its contact");
  if (!drives.empty()) path.drive = drives.front();
  a("reaches_V", path.reaches, "level at which the nominal design touches");
  a("limit_V", path.limit, "limit of the voltage source");
  a("share_of_devices", internal::OrNull{path.share},
    "share of the devices of [spread] that reach the contact by this drive alone");
}

void members(internal::Archive& a, ElectrodeRecord& electrode) {
  a("status", electrode.status, "outcome for the electrode");
  a("pull_in", electrode.volts, "its pull-in voltages");
  if (a.has(!electrode.bias.empty())) a("bias_V", electrode.bias, "constant voltages of the other drives, if not 0");
  if (a.has(!electrode.bias_factor.empty())) a("bias_factor", electrode.bias_factor, "factor of a dispersion force, if not 1");
}

void members(internal::Archive& a, SweepPoint& point) {
  a("voltage_V", point.voltage, "voltage of the swept electrode");
  a("deflection_m", point.deflection, "deflection of the contact point");
  a("capacitance_F", point.capacitance, "capacitance of the electrode");
  a.custom(
      "branch", point.is_up, [&](bool) { return branch_name(point); }, [](const json& name) { return name == "up"; },
      internal::Like<std::string>{"`up` while the voltage rises, then `down`"});
  a.custom(
      "status", point.state, [](SweepState state) { return to_string(state); },
      [](const json& name) {
        return name == to_string(SweepState::open)     ? SweepState::open
               : name == to_string(SweepState::closed) ? SweepState::closed
                                                       : SweepState::none;
      },
      internal::Like<std::string>{"state of the switch: `open`, `closed` or `collapsed_onto_electrode`"});
}

void members(internal::Archive& a, PullInsRecord& record) {
  a("electrodes", record.electrodes, "each electrode by its name");
  // In JSON, the pull-in members of a single electrode are repeated at the top level.
  if (!a.reads() && record.electrodes.size() == 1) members(a, record.electrodes.begin()->second);
  std::map<std::string, PullInRecord> voltages;
  for (const auto& [name, one] : record.electrodes) voltages[name] = one.volts;
  if (record.electrodes.size() != 1) a.derived("pull_in", voltages, "voltages of several electrodes, by name");
  members(a, record.origin);
  a("status", record.status, "`done`, `interrupted`, or that of the first electrode that should pull in and does not");
  a("stable_path", internal::OrNull{record.stable_path}, "path of stable equilibria to the contact");
  if (a.has(!record.swept.empty())) {
    a("swept", record.swept, "swept electrode, with `--sweep`");
    a("sweep", record.sweep, "points of the sweep");
  }
  if (a.has(!record.left_out.empty())) a("left_out", record.left_out, "what an interruption left out");
}

ElectrodeRecord record_of(const PreparedScene& p, std::size_t k, const ElectrodePullIn& known) {
  const std::vector<double> bias = bias_of(p.scene, k);
  const auto& [s, d] = known;
  const ClosedRange closed = closed_range(p.model, k, bias);
  ElectrodeRecord found{.status = s.status == Status::done ? d.status : s.status,
                        .volts = {.static_pull_in = s.voltage,
                                  .dynamic_pull_in = d.voltage,
                                  .release = closed.release,
                                  .pulled_through = closed.pulled_through,
                                  .static_kind = std::string(std::isfinite(s.voltage) ? to_string(s.kind) : ""),
                                  .deflection = s.deflection,
                                  .neutral = p.model.neutral_voltage(k) != 0 ? p.model.neutral_voltage(k) : Metrics::unset,
                                  .dynamic_kind = dynamic_kind(p, k, s.voltage, d.voltage)}};
  // After an interruption, leave out the voltages with further numbers of modes, which were not computed.
  const bool was_found = d.status != Status::interrupted;
  if (const ModeLadder ladder(p); was_found && ladder.exists() && std::isfinite(s.voltage))
    found.volts.by_modes = voltages_by_modes(ladder, p.scene, k, closed.pulled_through);
  const std::vector<std::string> names = p.drive_names();
  for (std::size_t other = 0; other < names.size(); ++other) {
    if (bias[other] == 0) continue;
    if (names[other] == dispersion_drive)
      found.bias_factor[names[other]] = 1 + bias[other];
    else
      found.bias[names[other]] = bias[other];
  }
  return found;
}

std::string volts(double value) {
  constexpr int digits = 5;
  return std::isfinite(value) ? quantity(value, "V", digits) : "none";
}

std::string bias_prose(const ElectrodeRecord& electrode) {
  std::vector<std::string> drives;
  for (const auto& [name, level] : electrode.bias) drives.push_back(fmt::format("{} {}", name, volts(level)));
  for (const auto& [name, factor] : electrode.bias_factor)
    drives.push_back(fmt::format("{} factor {}", name, internal::plain_number(factor, 5)));
  return fmt::format("{}", fmt::join(drives, ", "));
}

std::string dynamic_prose(const PullInRecord& found) {
  return volts(found.dynamic_pull_in) +
         (found.dynamic_kind == "unstable_rest"
              ? " (equal to the static one: no lower step moves the beam, and from there on its rest position is unstable)"
          : found.dynamic_kind == "overdamped" ? " (overdamped: equals the static one)"
                                               : "");
}

std::string brief_contact_prose(const PullInRecord& found) {
  const std::string low = volts(found.dynamic_pull_in), high = volts(found.release);
  // Voltages that differ by less than the digits shown leave no such step.
  if (!(found.dynamic_pull_in < found.release) || low == high) return {};
  return fmt::format("a step to between {} and {}, below the release voltage, touches and does not stay closed", low, high);
}

bool sticks_by_charge(const PullInRecord& found) {
  return std::isfinite(found.neutral) && std::abs(found.neutral) >= found.release - found.neutral;
}

std::string charge_prose(const PullInRecord& found) {
  if (!std::isfinite(found.neutral)) return {};
  const auto mirrored = [&](double value) { return volts(2 * found.neutral - value); };
  std::string words = fmt::format("leaves no field at {}", volts(found.neutral));
  if (std::isfinite(found.static_pull_in))
    words += fmt::format("; the other polarity pulls in at {}", mirrored(found.static_pull_in));
  if (std::isfinite(found.release))
    words += fmt::format("{} releases at {}", std::isfinite(found.static_pull_in) ? " and" : "; the other polarity",
                         mirrored(found.release));
  if (sticks_by_charge(found)) words += "; a closed switch stays closed at 0 V";
  return words;
}

std::optional<StablePathRecord> stable_path_of(const PreparedScene& p, const Progress& progress) {
  constexpr std::uint64_t devices = 256, seed = 1;
  if (!p.model.has_contact()) return std::nullopt;
  std::optional<StableApproach> found;
  if (p.model.has_piezo()) found = stable_approach(p, Actuator::pzt);
  if (!found && has_pulling_electrode(p.scene.device)) found = stable_approach(p, Actuator::electrostatic);
  if (!found) return std::nullopt;
  StablePathRecord path{.drive = found->drive, .reaches = found->reaches, .limit = found->limit};
  if (!p.scene.spread.empty()) path.share = share_with_path(p, *found, devices, seed, 1, progress);
  return path;
}

std::string words_of(const std::optional<StablePathRecord>& path) {
  if (!path) return "no drive alone reaches the contact through stable equilibria within its limits";
  std::string words =
      fmt::format("the {} alone reaches the contact at {} through stable equilibria",
                  path->drive == piezo_drive ? "piezo" : "electrode " + path->drive, quantity(path->reaches, "V", 4));
  if (path->share)
    words += fmt::format("; {} of the devices do so within {}", internal::share_text(*path->share),
                         internal::given_quantity(path->limit, "V"));
  return words;
}

json json_of(const PullInsRecord& record) { return internal::record_json(record); }

PullInsRecord read_pull_ins(const json& from) {
  PullInsRecord record = internal::whole_record<PullInsRecord>(from);
  require(record.sweep.empty() || record.electrodes.contains(record.swept), "\"swept\" must be one of the electrodes");
  return record;
}

std::string text_of(const PullInsRecord& record) {
  const bool has_contact = makes_contact(record.origin.scene);
  const std::vector<DrawnScene::Electrode> all = read_drawn_scene(record.origin.scene).electrodes;
  std::string text;
  for (const auto& [name, electrode] : record.electrodes) {
    const bool is_far = std::ranges::any_of(all, [&](const auto& one) { return one.name == name && one.far_side; });
    text += electrode_prose(name, electrode, is_far, has_contact);
  }
  const bool is_known = std::ranges::find(record.left_out, stable_path_left_out) == record.left_out.end();
  if (has_contact && is_known) text += wrapped("Stable path: " + words_of(record.stable_path) + ".") + "\n";
  if (const std::string words = collapse_prose(record); !words.empty()) text += wrapped(words + ".") + "\n";
  return text;
}

std::string sweep_csv(const std::vector<SweepPoint>& points) {
  std::string text = "voltage_V,deflection_m,capacitance_F,branch,status\n";
  for (const SweepPoint& p : points)
    text += fmt::format("{},{},{},{},{}\n", p.voltage, internal::csv_cell(p.deflection), internal::csv_cell(p.capacitance),
                        branch_name(p), to_string(p.state));
  return text;
}

std::string sweep_svg(const PullInsRecord& record) {
  const std::vector<SweepPoint>& points = record.sweep;
  const ElectrodeRecord& electrode = record.electrodes.at(record.swept);
  const auto& [pull_in, release] = std::pair(electrode.volts.static_pull_in, electrode.volts.release);
  const bool goes_down = std::ranges::any_of(points, [](const SweepPoint& p) { return !p.is_up && p.state != SweepState::none; });
  std::string of = fmt::format("Electrode {}, swept up{}", record.swept, goes_down ? " and down" : "");
  if (const std::string others = bias_prose(electrode); !others.empty()) of += ", with " + others;
  const auto [least, most] = std::minmax_element(points.begin(), points.end(),
                                                 [](const SweepPoint& a, const SweepPoint& b) { return a.voltage < b.voltage; });
  internal::Picture picture{.tables = {{"up", branch_of(points, true)}, {"down", branch_of(points, false)}}, .charts = {}};
  for (const auto& [column, title, unit] : {std::array{"deflection", "Deflection of the contact point", "m"},
                                            std::array{"capacitance", "Capacitance of the electrode", "F"}})
    picture.charts.push_back(sweep_chart(column, title, unit, least->voltage, most->voltage, goes_down));
  if (pull_in <= most->voltage)
    picture.charts.front().marks.push_back({pull_in, electrode.volts.deflection, internal::Role::best, "pull-in"});
  std::string words = std::isfinite(pull_in) ? fmt::format("Pull-in at {}, deflected by {}", quantity(pull_in, "V", 4),
                                                           quantity(electrode.volts.deflection, "m", 4))
                                             : std::string("No pull-in voltage");
  if (std::isfinite(release) && goes_down) words += fmt::format("; release at {}", quantity(release, "V", 4));
  if (const std::string collapse = collapse_prose(record); !collapse.empty()) words += ". " + collapse;
  return svg_page(of, words + ".", picture, 1);
}

}  // namespace softland
