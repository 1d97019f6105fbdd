#include "reports/tuning_lines.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <vector>

#include "base/require.h"
#include "base/shortened.h"
#include "waveforms/export.h"

namespace softland {
namespace {

using nlohmann::json;

std::string shown(const json& value) { return shortened(value.dump(-1, ' ', false, json::error_handler_t::replace)); }

// Throws InvalidInput about a key of a JSON line, with its value, unless the rule holds.
void require_value(bool holds, std::string_view key, const json& value, std::string_view rule) {
  require(holds, [&] { return fmt::format("{} = {}: {}", key, shown(value), rule); });
}

// Throws InvalidInput for an unknown key: a contact record with a misspelt key would otherwise mean a contact that stayed open.
void require_known(const json& object, const std::string& path, std::initializer_list<std::string_view> known) {
  for (const auto& [key, value] : object.items()) {
    require(std::find(known.begin(), known.end(), key) != known.end(), [&key = key, &path, &known] {
      return fmt::format("{}{}: unknown key; choose one of {}", path, shortened(key), fmt::join(known, ", "));
    });
  }
}

const json& needed(const json& object, std::string_view key, const std::string& path = {}) {
  const auto found = object.find(key);
  require(found != object.end(), [&] { return fmt::format("{}{}: is missing", path, key); });
  return *found;
}

double finite_number(const json& value, std::string_view key, std::string_view rule) {
  const double number = value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
  require_value(std::isfinite(number), key, value, rule);
  return number;
}

std::vector<double> numbers(const json& value, const std::string& key) {
  require_value(value.is_array() && !value.empty(), key, value, "must be a list of numbers");
  std::vector<double> all;
  all.reserve(value.size());
  for (const json& one : value) all.push_back(finite_number(one, key, "must be a number"));
  return all;
}

Table read_drive(const json& value, const std::string& path) {
  require_value(value.is_object(), path, value, R"(must be {"time_s":[...],"V":[...]})");
  require_known(value, path + ".", {"time_s", "V", "amplifier"});
  Table table{.time = numbers(needed(value, "time_s", path + "."), path + ".time_s"),
              .voltage = numbers(needed(value, "V", path + "."), path + ".V")};
  require(table.time.size() == table.voltage.size(), [&] {
    return fmt::format("{}: time_s has {} numbers and V has {}: must be as many", path, table.time.size(), table.voltage.size());
  });
  require(table.time.front() == 0 && std::is_sorted(table.time.begin(), table.time.end()),
          [&] { return fmt::format("{}.time_s: must begin at 0 and never decrease", path); });
  return table;
}

std::vector<ContactEdge> read_edges(const json& value) {
  constexpr std::string_view rule = "must be a list of [time, 1 where the contact closes or 0 where it opens]";
  require_value(value.is_array(), "edges_s", value, rule);
  std::vector<ContactEdge> edges;
  for (const json& one : value) {
    require_value(one.is_array() && one.size() == 2 && (one[1] == 0 || one[1] == 1), "edges_s", one, rule);
    edges.push_back({.time = finite_number(one[0], "edges_s", "must be a time"), .closed = one[1] == 1});
  }
  return edges;
}

void read_count(const json& line, ContactRecord& record) {
  const auto count = line.find("bounce_count");
  if (count == line.end()) return;
  require_value(count->is_number_integer() && *count >= 0 && *count <= std::numeric_limits<int>::max(), "bounce_count", *count,
                "must be a whole number from 0 on");
  record.bounce_count = count->get<int>();
}

}  // namespace

double CommandedShot::last_row() const {
  double last = 0;
  for (const auto& [name, table] : drives) last = std::max(last, table.time.back());
  return last;
}

std::vector<Waveform> CommandedShot::waveforms(const PreparedScene& nominal) const {
  std::vector<std::string> names = nominal.drive_names();
  std::erase(names, std::string(dispersion_drive));
  DriveWaveforms all;
  for (const auto& [name, table] : drives) {
    require(std::find(names.begin(), names.end(), name) != names.end(), [&, &name = name] {
      return fmt::format("drives.{}: unknown drive; choose one of {}", shortened(name), fmt::join(names, ", "));
    });
    all.emplace(name, table);
  }
  if (const Drive* const force = nominal.drives.find(dispersion_drive); force != nullptr && force->waveform)
    all.emplace(force->name, *force->waveform);
  return nominal.in_drive_order(all);
}

CommandedShot commanded_shot(int number, double hold_time, const SentSignals& sent) {
  constexpr double tolerance = 1e-4;  // largest error of a waveform given as rows, as a share of its peak voltage
  CommandedShot shot{.number = number, .hold_time = hold_time, .drives = {}, .amplifiers = sent.amplifiers};
  for (const auto& [name, signal] : sent.signals) {
    Table& table = shot.drives[name];
    for (const auto& [time, voltage] : polyline(signal, signal.pieces().back().begin, tolerance * signal.peak(), 0)) {
      table.time.push_back(time);
      table.voltage.push_back(voltage);
    }
  }
  return shot;
}

json read_line(std::string_view line) {
  require(line.size() <= longest_line,
          [&] { return fmt::format("is {} bytes long: a line may have {}", line.size(), longest_line); });
  static constexpr int deepest = 8;
  const auto watch_depth = [](int around, json::parse_event_t event, const json&) {
    const bool opens = event == json::parse_event_t::object_start || event == json::parse_event_t::array_start;
    require(!opens || around < deepest, [] { return fmt::format("is nested more than {} deep", deepest); });
    return true;
  };
  json object = json::parse(line, watch_depth, false);
  require(object.is_object(), [&] { return fmt::format("must be a JSON object: {}", shortened(line)); });
  return object;
}

bool is_end(const json& line) { return line.value("done", json()) == true; }

int shot_number(const json& line) {
  const json& value = needed(line, "shot");
  require_value(value.is_number_integer() && value >= 1 && value <= std::numeric_limits<int>::max(), "shot", value,
                "must be a whole number from 1 on");
  return value.get<int>();
}

CommandedShot read_shot(const json& line) {
  require_known(line, "", {"shot", "hold_s", "drives"});
  CommandedShot shot{.number = shot_number(line),
                     .hold_time = finite_number(needed(line, "hold_s"), "hold_s", "must be a time in seconds"),
                     .drives = {}};
  require_value(shot.hold_time > 0, "hold_s", line["hold_s"], "must be above 0");
  const json& drives = needed(line, "drives");
  require_value(drives.is_object() && !drives.empty(), "drives", drives, R"(must be {"NAME":{"time_s":[...],"V":[...]}})");
  for (const auto& [name, drive] : drives.items()) {
    const std::string path = "drives." + shortened(name);
    shot.drives[name] = read_drive(drive, path);
    if (const auto amplifier = drive.find("amplifier"); amplifier != drive.end()) {
      const double factor = finite_number(*amplifier, path + ".amplifier", "must be a number");
      require_value(factor > 0, path + ".amplifier", *amplifier, "must be above 0");
      shot.amplifiers[name] = factor;
    }
  }
  return shot;
}

ContactRecord read_record(const json& line, int shot, double duration) {
  require_known(line, "", {"shot", "edges_s", "closing_time_s", "bounce_count", "loudness", "error"});
  const int number = shot_number(line);
  require(number == shot, [&] { return fmt::format("shot = {}: must be {}, the shot that was asked for", number, shot); });
  ContactRecord record;
  if (const auto error = line.find("error"); error != line.end()) {
    require_value(error->is_string() && !error->get_ref<const std::string&>().empty(), "error", *error, "must be a text");
    record.error = error->get<std::string>();
    return record;
  }
  const auto edges = line.find("edges_s"), time = line.find("closing_time_s");
  require(edges != line.end() || time != line.end(), "must have edges_s, closing_time_s or error");
  require(edges == line.end() || time == line.end(), "must have edges_s or closing_time_s, not both");
  require(edges == line.end() || !line.contains("bounce_count"), "bounce_count: belongs to closing_time_s; edges tell it");
  if (edges != line.end()) record.edges = read_edges(*edges);
  if (time != line.end() && !time->is_null())
    record.closing_time = finite_number(*time, "closing_time_s", "must be a time in seconds, or null");
  read_count(line, record);
  if (const auto loudness = line.find("loudness"); loudness != line.end())
    record.loudness = finite_number(*loudness, "loudness", "must be a number");
  const std::string fault = record_fault(record, duration);
  require(fault.empty(), fault);
  return record;
}

json shot_json(const CommandedShot& shot) {
  json drives = json::object();
  for (const auto& [name, table] : shot.drives) drives[name] = {{"time_s", table.time}, {"V", table.voltage}};
  for (const auto& [name, amplifier] : shot.amplifiers) drives[name]["amplifier"] = amplifier;
  return {{"shot", shot.number}, {"hold_s", shot.hold_time}, {"drives", std::move(drives)}};
}

json record_json(int shot, const ContactRecord& record) {
  json line{{"shot", shot}};
  if (!record.error.empty()) {
    line["error"] = record.error;
    return line;
  }
  if (record.closing_time) {
    line["closing_time_s"] = *record.closing_time;
    if (record.bounce_count) line["bounce_count"] = *record.bounce_count;
  } else {
    json& edges = line["edges_s"] = json::array();
    for (const ContactEdge& edge : record.edges) edges.push_back({edge.time, edge.closed ? 1 : 0});
  }
  if (record.loudness) line["loudness"] = *record.loudness;
  return line;
}

json recipes_json(const std::vector<CandidateWaveform>& recipes) {
  json all = json::array();
  for (const CandidateWaveform& recipe : recipes)
    all.push_back({{"approach", name_of(approaches, recipe.approach)},
                   {"x", recipe.x},
                   {"volts", recipe.volts},
                   {"time", recipe.time},
                   {"cost", recipe.cost}});
  return {{"recipes", std::move(all)}};
}

std::vector<CandidateWaveform> read_recipes(const json& line) {
  const json& value = needed(line, "recipes");
  require_value(value.is_array() && !value.empty(), "recipes", value, "must be a list of recipes");
  std::vector<CandidateWaveform> all;
  for (const json& one : value) {
    require_value(one.is_object(), "recipes", one, R"(must be {"x":[...],"volts":1,"time":1,"cost":0})");
    require_known(one, "recipes.", {"approach", "x", "volts", "time", "cost"});
    const auto number = [&](const char* key) { return finite_number(needed(one, key, "recipes."), key, "must be a number"); };
    const json told = one.contains("approach") ? one["approach"] : json(name_of(approaches, Approach::fast));
    const auto* approach = told.is_string() ? find_named(approaches, told.get_ref<const std::string&>()) : nullptr;
    require_value(approach != nullptr, "recipes.approach", told, R"(must be "catch" or "quasi-static")");
    all.push_back({.approach = approach->value,
                   .x = numbers(needed(one, "x", "recipes."), "recipes.x"),
                   .volts = number("volts"),
                   .time = number("time"),
                   .cost = number("cost")});
  }
  return all;
}

json end_json() { return {{"done", true}}; }

std::string line_text(const json& line) { return line.dump(-1, ' ', false, json::error_handler_t::replace) + "\n"; }

}  // namespace softland
