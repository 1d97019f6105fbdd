#include "reports/mode_table_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "base/clamped_spline.h"
#include "base/printable.h"
#include "document/chart.h"
#include "document/document.h"
#include "document/quantity.h"
#include "document/svg.h"
#include "reports/study_members.h"

namespace softland {
namespace {

using internal::quantity;

constexpr int table_digits = 6;

/// Returns the column of the mode table that holds a mode of the finite-element file; none for a mode that is not bending,
/// which the table leaves out.
std::optional<std::size_t> taken_column(const ModeTable& table, const ModeFound& found) {
  if (found.kind != ModeKind::bending) return std::nullopt;
  const auto at = std::find(table.frequencies.begin(), table.frequencies.end(), found.frequency);
  return static_cast<std::size_t>(at - table.frequencies.begin());
}

/// Returns the modes of a mesh; for a mode table without a mesh, a mode per frequency in the table.
std::vector<ModeFound> modes_of(const ModeTable& table) {
  if (!table.found.empty()) return table.found;
  std::vector<ModeFound> all;
  for (const double frequency : table.frequencies)
    all.push_back({.number = static_cast<int>(all.size() + 1), .frequency = frequency, .share = 1});
  return all;
}

double largest_of(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

internal::Chart chart_of(const ModeTable& table, const ModeFound& found, const std::string& id) {
  internal::Chart chart;
  chart.id = id;
  chart.x_column = "x";
  chart.x_label = "From the clamp";
  chart.x_unit = "m";
  chart.height = 170;
  chart.zero_line = true;
  chart.x_home = chart.x_whole = {0, table.positions.back()};
  chart.title = quantity(found.frequency, "Hz", table_digits);
  return chart;
}

void draw_taken(internal::Picture& drawn, const ModeTable& table, const ModeFound& found, std::size_t column) {
  constexpr int points = 400;
  constexpr std::size_t most_dots = 30;
  const std::string id = fmt::format("mode-{}", found.number), places = id + "-places";
  const std::vector<double>& shape = table.shapes[column];
  const ClampedSpline spline(table.positions, shape, table.far_end);
  // Choose a power of 1000 as the unit of the mode shape, so that its largest value has one to three digits before the point.
  const int exponent = 3 * static_cast<int>(std::floor(std::log10(largest_of(shape)) / 3));
  const double unit = std::pow(10.0, exponent);
  for (int k = 0; k <= points; ++k) {
    const double x = table.positions.back() * k / points;
    drawn.tables[id]["x"].push_back(x);
    drawn.tables[id]["y"].push_back(spline.value(x) / unit);
  }
  // Draw a dot at every `step`-th position only, so that the line of the mode shape remains visible.
  const std::size_t step = 1 + table.positions.size() / most_dots;
  for (std::size_t i = 0; i < table.positions.size(); i += step) {
    drawn.tables[places]["x"].push_back(table.positions[i]);
    drawn.tables[places]["y"].push_back(shape[i] / unit);
  }
  internal::Chart chart = chart_of(table, found, id);
  chart.title = fmt::format("mode_{}: {}", column + 1, chart.title);
  chart.y_label = exponent == 0 ? std::string("Mode (1/√kg)") : fmt::format("Mode (1e{}/√kg)", exponent);
  chart.y_unit = "";
  chart.series.push_back({.table = id, .column = "y", .label = "as simulated", .role = internal::Role::best});
  chart.series.push_back({.table = places, .column = "y", .label = "in the file", .role = internal::Role::measured});
  drawn.charts.push_back(std::move(chart));
}

void draw_left_out(internal::Picture& drawn, const ModeTable& table, const ModeFound& found) {
  const std::string id = fmt::format("mode-{}", found.number);
  const double most =
      std::max({largest_of(found.along), largest_of(found.across), largest_of(found.axial), largest_of(found.twist)});
  internal::Chart chart = chart_of(table, found, id);
  chart.title += fmt::format(", left out: {}", found.name());
  chart.y_label = "Motion";
  chart.y_unit = "";
  drawn.tables[id]["x"] = table.places;
  const auto draw = [&](const std::vector<double>& values, const char* name, internal::Role role) {
    std::vector<double>& drawn_values = drawn.tables[id][name];
    for (const double value : values) drawn_values.push_back(most > 0 ? value / most : 0);
    chart.series.push_back({.table = id, .column = name, .label = name, .role = role});
  };
  draw(found.along, "along", internal::Role::best);
  draw(found.across, "across", internal::Role::third);
  draw(found.twist, "twist", internal::Role::fourth);
  if (found.kind == ModeKind::axial) draw(found.axial, "axial", internal::Role::fifth);
  drawn.charts.push_back(std::move(chart));
}

}  // namespace

ModesRecord record_of(const ModeTable& table, const std::string& command) {
  ModesRecord::File file{.summary = summary(table),
                         .format = table.format,
                         .nodes = table.nodes,
                         .length = table.positions.back(),
                         .modes = {},
                         .left_out = table.left_out,
                         .notes = table.notes};
  for (const ModeFound& found : modes_of(table)) {
    const std::optional<std::size_t> column = taken_column(table, found);
    file.modes.push_back({.number = found.number,
                          .frequency = found.frequency,
                          .share = found.share,
                          .kind = found.name(),
                          .taken_as = column ? fmt::format("mode_{}", *column + 1) : ""});
  }
  ModesRecord record{.origin = origin_of("modes", command), .frequencies = {}};
  for (const double frequency : table.frequencies) record.frequencies.push_back(2 * std::numbers::pi * frequency);
  record.file = std::move(file);
  return record;
}

void members(internal::Archive& a, ModesRecord::Mode& mode) {
  a("number", mode.number, "number of the mode in the file");
  a("frequency_Hz", mode.frequency, "its frequency");
  a("kind", mode.kind, "kind of the motion, such as bending");
  a("share", mode.share, "share of this kind in the squared motion of all nodes");
  a("taken_as", internal::OrNull{mode.taken_as}, "column in the table of modes; null: left out");
}

void members(internal::Archive& a, ModesRecord::File& file) {
  a("summary", file.summary, "the file in one line");
  a("format", file.format, "format of the file");
  a("nodes", file.nodes, "number of nodes; 0 for a table of modes");
  a("length_m", file.length, "length of the beam");
  a("modes", file.modes, "modes of the file");
  a("left_out", file.left_out, "data that were not read");
  a("notes", file.notes, "assumptions");
}

// In JSON, the members of ModesRecord::file are at the top level.
void members(internal::Archive& a, ModesRecord& record) {
  members(a, record.origin);
  a("natural_frequencies_rad_s", record.frequencies, "natural angular frequencies");
  if (a.reads()) {
    if (internal::value_at(a.from(), "format").is_string()) record.file = ModesRecord::File{};
  }
  if (record.file)
    members(a, *record.file);
  else
    a("warnings", record.warnings, "warnings of the scene");
}

nlohmann::json json_of(const ModesRecord& record) { return internal::record_json(record); }

ModesRecord read_modes(const nlohmann::json& from) { return internal::whole_record<ModesRecord>(from); }

std::string text_of(const ModesRecord& record) {
  ReportSection modes{.id = "modes", .heading = "Modes", .parts = {}};
  if (!record.file) {
    ReportTable table{.head = {"mode", "angular frequency", "frequency"}, .rows = {}};
    for (const double omega : record.frequencies)
      table.rows.push_back({std::to_string(table.rows.size() + 1), quantity(omega, "rad/s", table_digits),
                            quantity(omega / (2 * std::numbers::pi), "Hz", table_digits)});
    modes.parts.emplace_back(std::move(table));
    return terminal_text({.sections = {std::move(modes)}, .warnings = record.warnings});
  }
  ReportTable table{.head = {"mode", "frequency", {"used as", "words"}, {"kind", "words"}}, .rows = {}};
  for (const ModesRecord::Mode& mode : record.file->modes) {
    const bool has_share = record.file->nodes > 0 && mode.kind != ModeFound{.kind = ModeKind::unused}.name();
    table.rows.push_back({fmt::format("{}", mode.number), quantity(mode.frequency, "Hz", table_digits),
                          mode.taken_as.empty() ? std::string("left out") : mode.taken_as,
                          mode.kind + (has_share ? fmt::format(", {:.3g} % of the motion", 100 * mode.share) : "")});
  }
  modes.parts.emplace_back(std::move(table));
  return terminal_text({.headline = record.file->summary, .sections = {std::move(modes)}});
}

std::string mode_table_csv(const ModeTable& table) {
  std::string text = "x_m,width_m,rest_offset_m";
  for (std::size_t k = 0; k < table.shapes.size(); ++k) text += fmt::format(",mode_{}", k + 1);
  text += "\nfrequency_Hz,,";
  for (const double frequency : table.frequencies) text += fmt::format(",{}", frequency);
  text += "\n";
  for (std::size_t i = 0; i < table.positions.size(); ++i) {
    text += fmt::format("{},{},{}", table.positions[i],
                        std::isnan(table.widths[i]) ? std::string() : fmt::format("{}", table.widths[i]), table.rest_offsets[i]);
    for (const std::vector<double>& shape : table.shapes) text += fmt::format(",{}", shape[i]);
    text += "\n";
  }
  return text;
}

std::string mode_table_svg(const ModeTable& table) {
  constexpr std::size_t charts_per_row = 2;
  internal::Picture drawn;
  for (const ModeFound& found : modes_of(table)) {
    if (const std::optional<std::size_t> column = taken_column(table, found)) {
      draw_taken(drawn, table, found, *column);
    } else if (found.kind != ModeKind::unused) {
      draw_left_out(drawn, table, found);
    }
  }
  return svg_page(printable_line(table.file), summary(table), drawn, charts_per_row);
}

}  // namespace softland
