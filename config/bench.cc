#include "config/bench.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/csv.h"
#include "base/read_file.h"
#include "base/require.h"
#include "base/shortened.h"
#include "base/split.h"
#include "base/trimmed.h"
#include "config/drives.h"
#include "config/scene_file_impl.h"
#include "config/schema.h"

namespace softland {
namespace {

using internal::hint;
using internal::inline_text;

constexpr std::size_t most_rows = 100'000;
constexpr std::array of_threshold{"threshold", "hysteresis", "closed", "merge"};
constexpr std::array of_file{"column", "time_column", "interval", "skip", "time_unit", "decimal", "shift", "unit"};

// Reads one [[measurement]] of a file of measurements.
class MeasurementReader {
 public:
  MeasurementReader(const toml::table& table, const std::string& file, const std::filesystem::path& directory)
      : table_(table), file_(file), directory_(directory) {}
  /// Takes the keys of a contact measurement from a command-line option; messages name `option` instead of a file.
  MeasurementReader(const toml::table& table, const std::string& option)
      : table_(table), file_(option), directory_(option), is_option_(true) {}

  [[nodiscard]] BenchMeasurement read() {
    check_keys();
    BenchMeasurement m{.quantity = text("quantity"), .place = place_of(table_)};
    const BenchQuantity& kind = kind_of(m.quantity);
    if (has("drive")) m.drive = text("drive");
    if (has("device")) m.device = text("device");
    if (has("mode")) m.mode = whole("mode", 1, 64);
    refuse_where(has("mode") && kind.name != "frequency", "mode", "applies to a frequency only");
    refuse_where(has("edges") && kind.name != of_contact, "edges", "applies to a contact record only");
    check_trace_keys(kind);
    read_drive(kind, m);
    if (has("value") == has("file")) fail(fmt::format("needs either 'value' or 'file' with the {}", noun(kind.dimension)));
    if (has("value")) {
      refuse_where(kind.is_over_time, "value", fmt::format("a {} is given over time: name a file with its rows", kind.name));
      for (const Quantity& one : quantities("value", kind.dimension)) {
        refuse_where(kind.is_positive && !(one.value > 0), "value", fmt::format("a {} must be above 0", kind.name));
        m.values.push_back(one.value);
      }
    } else {
      read_rows(kind, m);
    }
    if (has("until")) cut(kind, m);
    if (has("level")) m.levels.assign(m.values.size(), quantities("level", dimension::voltage).front().value);
    read_errors(kind, m);
    return m;
  }

 private:
  void check_keys() const {
    static const std::vector<std::string_view> known = [] {
      std::vector<std::string_view> all{"quantity", "drive", "level", "waveform", "value",    "file",
                                        "error",    "mode",  "edges", "device",   "per_volt", "until"};
      all.insert(all.end(), of_threshold.begin(), of_threshold.end());
      all.insert(all.end(), of_file.begin(), of_file.end());
      return all;
    }();
    for (const auto& [key, node] : table_) {
      if (std::find(known.begin(), known.end(), key.str()) == known.end())
        refuse(std::string(key.str()), "unknown key" + hint(key.str(), known));
    }
  }
  void check_trace_keys(const BenchQuantity& kind) const {
    for (const char* key : of_file)
      refuse_where(has(key) && !(kind.is_over_time && has("file")), key, "applies to a file of values over time only");
    for (const char* key : of_threshold)
      refuse_where(has(key) && kind.name != of_contact, key, "applies to a contact record only");
    refuse_where(has("per_volt") && (!kind.is_over_time || kind.name == of_contact), "per_volt",
                 "is of a position or velocity only");
    refuse_where(has("per_volt") && has("unit"), "per_volt", "must not be given together with unit");
  }
  [[nodiscard]] const BenchQuantity& kind_of(const std::string& name) const {
    std::vector<std::string_view> known;
    for (const BenchQuantity& one : bench_quantities()) {
      if (one.name == name) return one;
      known.push_back(one.name);
    }
    refuse("quantity", "unknown quantity" + hint(name, known));
  }
  void read_drive(const BenchQuantity& kind, BenchMeasurement& m) {
    refuse_where(has("level") && !kind.has_level, "level", fmt::format("must not be given for a {}", kind.name));
    refuse_where(has("waveform") && !kind.has_waveform, "waveform", fmt::format("must not be given for a {}", kind.name));
    refuse_where(has("waveform") && has("level"), "waveform", "must not be given together with level");
    if (!has("waveform")) return;
    const std::string name = text("waveform");
    refuse_where(name.empty() || name.find('\0') != std::string::npos, "waveform", "must be \"scene\" or the name of a file");
    m.waveform = name == "scene" ? name : (directory_ / name).string();
  }

  struct Column {
    std::string name;  // name of the column in the header of the file of measured rows
    double unit = 1;   // size of the column's unit [SI unit]
  };
  // Returns the column whose name is `stem` and a unit of the dimension `due`: "closing_time_us" or "capacitance [fF]" for the
  // stems "closing_time" and "capacitance". Returns none if the header has no column of this form.
  [[nodiscard]] std::optional<Column> column_of(const std::vector<std::string>& header, std::string_view stem,
                                                const Dimension& due) const {
    for (const std::string& name : header) {
      if (!name.starts_with(stem)) continue;
      std::string unit = name.substr(stem.size());
      if (unit.empty() && due == dimension::none) return Column{.name = name};
      if (unit.starts_with(" [") && unit.ends_with("]")) {
        unit = unit.substr(2, unit.size() - 3);
      } else if (unit.starts_with("_")) {
        unit = unit == "_m_s" ? "m/s" : unit.substr(1);
      } else {
        continue;
      }
      try {
        const Quantity one = parse_quantity("1 " + unit);
        if (one.dimension == due) return Column{.name = name, .unit = one.value};
      } catch (const InvalidInput&) {
        continue;
      }
    }
    return std::nullopt;
  }
  [[nodiscard]] static std::vector<std::string> header_of(std::string_view content) {
    while (!content.empty()) {
      const std::size_t end = std::min(content.find('\n'), content.size());
      std::string line(content.substr(0, end));
      content.remove_prefix(std::min(end + 1, content.size()));
      if (line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
      std::vector<std::string> names = split(line, ',');
      for (std::string& name : names) name = std::string(trimmed(name));
      if (!names.front().starts_with('#') && !(names.size() == 1 && names.front().empty())) return names;
    }
    return {};
  }
  struct OwnColumns {
    Column value;
    std::optional<Column> beside;
  };
  void read_rows(const BenchQuantity& kind, BenchMeasurement& m) {
    const std::string name = text("file");
    refuse_where(name.empty() || name.find('\0') != std::string::npos, "file", "must be the name of a file");
    const std::string path = (directory_ / name).string();
    try {
      const bool says_how =
          std::ranges::any_of(of_file, [&](const char* key) { return has(key); }) || has("threshold") || has("per_volt");
      const std::string content = read_file(path);
      const std::optional<OwnColumns> own = says_how ? std::nullopt : own_columns(kind, header_of(content));
      if (own) {
        read_own(kind, *own, path, content, m);
      } else if (!kind.is_over_time || is_own(header_of(content))) {
        throw InvalidInput(fmt::format("{}: its header must have columns such as {}", path, expected_columns(kind)));
      } else {
        read_foreign(kind, path, m);
      }
    } catch (const InvalidInput& error) {
      if (std::string_view(error.what()).find("measurement.") != std::string_view::npos)
        throw;  // the message already names a key of the measurement; refuse() would add a second one
      refuse("file", error.what());
    }
  }
  [[nodiscard]] static std::string expected_columns(const BenchQuantity& kind) {
    const std::string value = kind.name == of_contact ? "contact" : fmt::format("{}_{}", kind.name, unit_symbol(kind.dimension));
    return kind.is_over_time ? fmt::format("time_s and {}", value)
           : kind.has_level  ? fmt::format("voltage_V and {}", value)
                             : value;
  }
  // Returns true if a header has a column such as "position_m", named as softland names the column of any quantity. The file is
  // then not read as an instrument's file; if the measurement needs other columns, an error names them.
  [[nodiscard]] bool is_own(const std::vector<std::string>& header) const {
    return std::ranges::any_of(bench_quantities(), [&](const BenchQuantity& one) {
      return column_of(header, one.name, one.name == of_contact ? dimension::none : one.dimension).has_value();
    });
  }
  [[nodiscard]] std::optional<OwnColumns> own_columns(const BenchQuantity& kind, const std::vector<std::string>& header) const {
    const std::optional<Column> value = column_of(header, kind.name, kind.name == of_contact ? dimension::none : kind.dimension);
    std::optional<Column> beside;
    if (kind.is_over_time) {
      beside = column_of(header, "time", dimension::time);
    } else if (kind.has_level && !has("level") && !has("waveform")) {
      beside = column_of(header, "level", dimension::voltage);
      if (!beside) beside = column_of(header, "voltage", dimension::voltage);
    }
    if (!value || (kind.is_over_time && !beside)) return {};
    return OwnColumns{.value = *value, .beside = beside};
  }
  void read_own(const BenchQuantity& kind, const OwnColumns& own, const std::string& path, const std::string& content,
                BenchMeasurement& m) const {
    std::vector<std::string> columns{own.value.name};
    if (own.beside) columns.push_back(own.beside->name);
    read_csv(content, path, columns, expected_columns(kind), [&](std::span<const double> row, const CsvPlace& at) {
      require(m.values.size() < most_rows, [&] { return fmt::format("{}: more than {} rows", at(), most_rows); });
      require(!kind.is_positive || row[0] > 0, [&] { return fmt::format("{}: a {} must be above 0", at(), kind.name); });
      m.values.push_back(row[0] * own.value.unit);
      if (!own.beside) return;
      std::vector<double>& other = kind.is_over_time ? m.times : m.levels;
      const double next = row[1] * own.beside->unit;
      require(!kind.is_over_time || (next >= 0 && (other.empty() || next > other.back())),
              [&] { return fmt::format("{}: times must rise from 0 s on", at()); });
      other.push_back(next);
    });
    if (kind.name == of_contact) find_edges(m);
  }

 public:
  [[nodiscard]] ContactTraceKeys contact_keys() const {
    const std::string closed = has("closed") ? text("closed") : "above";
    refuse_where(closed != "above" && closed != "below", "closed", "must be \"above\" or \"below\"");
    ContactTraceKeys keys{.file = keys_of_file(), .shift = time_shift(), .contact = {}};
    keys.contact = {.threshold = has("threshold") ? quantity("threshold", {dimension::voltage}).value
                                                  : std::numeric_limits<double>::quiet_NaN(),
                    .hysteresis = not_negative("hysteresis", dimension::voltage),
                    .is_closed_below = closed == "below",
                    .merge = not_negative("merge", dimension::time)};
    if (has("unit")) keys.file.unit = text("unit");
    return keys;
  }
  void check_names() const { check_keys(); }

 private:
  [[nodiscard]] double not_negative(const std::string& key, const Dimension& due) const {
    if (!has(key)) return 0;
    const double value = quantity(key, {due}).value;
    refuse_where(!(value >= 0), key, "must be at least 0");
    return value;
  }
  void read_place(const std::string& key, std::string& name, int& number) const {
    if (!has(key)) return;
    if (table_.get(key)->is_integer()) {
      number = whole(key, 1, 1'000'000);
    } else {
      name = text(key);
      refuse_where(name.empty(), key, "must be the name or the number of a column");
    }
  }
  [[nodiscard]] ReadKeys keys_of_file() const {
    ReadKeys keys;
    read_place("column", keys.column, keys.column_number);
    read_place("time_column", keys.time_column, keys.time_column_number);
    if (has("interval")) {
      keys.uneven = text("interval") == internal::file_keys::uneven;
      if (!keys.uneven) keys.interval = quantity("interval", {dimension::time}).value;
      refuse_where(keys.interval && !(*keys.interval > 0), "interval", "must be above 0 s");
    }
    if (has("skip")) keys.skip = whole("skip", 0, 1'000'000);
    if (has("time_unit")) keys.time_unit = text("time_unit");
    if (has("decimal")) {
      const std::string sign = text("decimal");
      refuse_where(sign != "." && sign != ",", "decimal", "must be \".\" or \",\"");
      keys.decimal = sign.front();
    }
    return keys;
  }
  [[nodiscard]] TimeShift time_shift() const {
    if (!has("shift")) return {};
    if (text("shift") == internal::file_keys::first) return {.first_is_zero = true};
    return {.shift = quantity("shift", {dimension::time}).value};
  }
  void read_foreign(const BenchQuantity& kind, const std::string& path, BenchMeasurement& m) const {
    if (kind.name == of_contact) {
      const std::vector<LevelEdge> edges = contact_edges(path, contact_keys());
      const auto due = static_cast<std::size_t>(has("edges") ? whole("edges", 1, 3) : 1);
      refuse_where(edges.size() < due, "file",
                   fmt::format("its voltage has {} edges from t = 0 on, but at least {} are needed", edges.size(), due));
      for (std::size_t k = 0; k < due; ++k) m.values.push_back(edges[k].time);
      return;
    }
    const ReadKeys keys = keys_of_file();
    const Recording recording = read_recording(path, keys);
    Trace trace = trace_of(recording, keys, std::string(kind.name), true);
    shift_times(trace, time_shift());
    const double unit = unit_of_trace(kind, channel_of(recording, keys, std::string(kind.name)));
    for (std::size_t k = 0; k < trace.times.size(); ++k) {
      if (trace.times[k] < 0) continue;  // skip rows before t = 0, the begin of the drive waveforms
      require(m.values.size() < most_rows, [&] { return fmt::format("{}: more than {} rows from t = 0 on", path, most_rows); });
      require(m.times.empty() || trace.times[k] > m.times.back(),
              [&] { return fmt::format("{}: times must rise from row to row", path); });
      m.times.push_back(trace.times[k]);
      m.values.push_back(unit * trace.values[k]);
    }
    require(!m.values.empty(), [&] { return fmt::format("{}: all rows are before t = 0; give shift to move them", path); });
  }
  // Returns the factor that converts the recorded values of the channel (trace_of()) to the SI unit of the quantity. It is the
  // key per_volt, or else the size of the unit that the key `unit` or the file names.
  [[nodiscard]] double unit_of_trace(const BenchQuantity& kind, const Channel& channel) const {
    if (has("per_volt")) {
      refuse_where(!channel.is_voltage && !channel.unit.empty(), "per_volt",
                   fmt::format("the file is in {}, not in volts", channel.unit));
      return quantity("per_volt", {kind.dimension}).value;
    }
    const std::string unit = has("unit") ? text("unit") : channel.unit;
    if (unit.empty()) fail("the file names no unit: give unit = \"...\", or per_volt = \"...\" for a file in volts");
    Quantity one;
    try {
      one = parse_quantity("1 " + unit);
    } catch (const InvalidInput& error) {
      refuse(has("unit") ? "unit" : "file", error.what());
    }
    if (one.dimension != kind.dimension)
      refuse(has("unit") ? "unit" : "file",
             fmt::format("the {} is in {}: expected {}; per_volt = \"...\" gives the size of one volt", kind.name, unit,
                         describe(kind.dimension)));
    return one.value * (has("unit") ? channel.per_si : 1);
  }

  // Removes the rows of a measured position or velocity after the time of the key `until`.
  void cut(const BenchQuantity& kind, BenchMeasurement& m) const {
    refuse_where(kind.name == of_contact || !kind.is_over_time, "until", "is of a position or velocity only");
    const double end = quantity("until", {dimension::time}).value;
    refuse_where(!(end >= m.times.front()), "until", "must not be before the first row");
    const auto rows = static_cast<std::size_t>(std::ranges::upper_bound(m.times, end) - m.times.begin());
    m.times.resize(rows);
    m.values.resize(rows);
    m.has_end = true;
  }

  // Replaces the rows of contact states (0 open, 1 closed) by the times of the first closings and openings; the key `edges`
  // gives their number. Each time is halfway between two rows of different state.
  void find_edges(BenchMeasurement& m) const {
    const int edges = has("edges") ? whole("edges", 1, 3) : 1;
    std::vector<double> found;
    bool closed = false;
    for (std::size_t i = 0; i < m.values.size() && found.size() < static_cast<std::size_t>(edges); ++i) {
      const bool now = m.values[i] > 0.5;
      if (now == closed) continue;
      found.push_back(i == 0 ? m.times[0] : (m.times[i - 1] + m.times[i]) / 2);
      closed = now;
    }
    refuse_where(found.size() < static_cast<std::size_t>(edges), "file",
                 fmt::format("its contact column has {} edges from open (0) to closed (1) and back, but at least {} are needed",
                             found.size(), edges));
    m.values = std::move(found);
    m.times.clear();
  }

  void read_errors(const BenchQuantity& kind, BenchMeasurement& m) const {
    if (!has("error")) fail("missing key 'error': one standard deviation of the measurement, absolute or in %");
    const Quantity error = quantity("error", {kind.dimension, dimension::none});
    refuse_where(!(error.value > 0), "error", "must be above 0");
    for (const double value : m.values) {
      m.errors.push_back(error.dimension == dimension::none ? error.value * std::abs(value) : error.value);
      refuse_where(!(m.errors.back() > 0), "error", "is a percentage of a value that is 0: give it in a unit");
    }
  }

  [[nodiscard]] bool has(std::string_view key) const { return table_.contains(key); }
  [[nodiscard]] std::string place_of(const toml::node& node) const {
    return is_option_ ? file_ : fmt::format("{}:{}", file_, node.source().begin.line);
  }
  [[noreturn]] void fail(std::string_view rule) const {
    throw InvalidInput(fmt::format("{}: {}{}", place_of(table_), is_option_ ? "" : "[[measurement]]: ", rule));
  }
  [[noreturn]] void refuse(const std::string& key, std::string_view rule) const {
    const toml::node& node = *table_.get(key);
    throw InvalidInput(fmt::format("{}: {}{} = {}: {}", place_of(node), is_option_ ? "" : "measurement.", shortened(key),
                                   shortened(inline_text(node)), rule));
  }
  void refuse_where(bool wrong, const std::string& key, std::string_view rule) const {
    if (wrong) refuse(key, rule);
  }
  [[nodiscard]] std::string text(const std::string& key) const {
    if (!has(key)) fail(fmt::format("missing key '{}'", key));
    const auto* text = table_.get(key)->as_string();
    if (text == nullptr) refuse(key, "expected text in quotes");
    return text->get();
  }
  [[nodiscard]] int whole(const std::string& key, int least, int most) const {
    const auto* number = table_.get(key)->as_integer();
    if (number == nullptr || number->get() < least || number->get() > most)
      refuse(key, fmt::format("must be a whole number from {} to {}", least, most));
    return static_cast<int>(number->get());
  }
  [[nodiscard]] Quantity quantity_in(const std::string& key, const toml::node& node, const std::vector<Dimension>& due) const {
    const auto* text = node.as_string();
    if (text == nullptr)
      refuse(key, fmt::format("expected {} in quotes, such as \"{}\"", noun(due.front()), example(due.front())));
    Quantity one;
    try {
      one = parse_quantity(text->get());
    } catch (const InvalidInput& error) {
      refuse(key, error.what());
    }
    if (std::find(due.begin(), due.end(), one.dimension) == due.end())
      refuse(key, fmt::format("expected {}, got {}", describe(due.front()), describe(one.dimension)));
    return one;
  }
  [[nodiscard]] Quantity quantity(const std::string& key, const std::vector<Dimension>& due) const {
    return quantity_in(key, *table_.get(key), due);
  }
  [[nodiscard]] std::vector<Quantity> quantities(const std::string& key, const Dimension& due) const {
    const toml::array* list = table_.get(key)->as_array();
    if (list == nullptr) return {quantity(key, {due})};
    std::vector<Quantity> all;
    for (const toml::node& node : *list) all.push_back(quantity_in(key, node, {due}));
    refuse_where(all.empty(), key, "must not be empty");
    return all;
  }

  const toml::table& table_;
  const std::string file_;
  const std::filesystem::path directory_;
  bool is_option_ = false;
};

std::vector<std::string> changes_of(const toml::node& node, const std::string& name, const std::string& device) {
  const auto refuse = [&](std::string_view rule) {
    throw InvalidInput(fmt::format("{}:{}: [device.{}]: {}", name, node.source().begin.line, shortened(device), rule));
  };
  const toml::table* table = node.as_table();
  const toml::array* list =
      table != nullptr && table->size() == 1 && table->contains("set") ? table->get("set")->as_array() : nullptr;
  if (list == nullptr) refuse("expected the one key set = [\"gap.electrode=3.4 um\"]");
  std::vector<std::string> all;
  for (const toml::node& one : *list) {
    if (!one.is_string()) refuse("set: expected texts such as \"gap.electrode=3.4 um\"");
    all.push_back(one.as_string()->get());
  }
  return all;
}

}  // namespace

ContactTraceKeys contact_trace_keys(const std::vector<std::string>& assignments) {
  std::string written = "[contact]\n";
  for (const std::string& assignment : assignments) {
    const std::size_t sign = assignment.find('=');
    require(sign != std::string::npos && sign > 0,
            [&] { return fmt::format("--contact {}: must be KEY=VALUE, such as \"threshold=1.5 V\"", shortened(assignment)); });
    const std::string value = assignment.substr(sign + 1);
    const bool is_number = !value.empty() && std::ranges::all_of(value, [](char c) { return c >= '0' && c <= '9'; });
    const bool is_quoted = value.starts_with('"') || value.starts_with('\'');
    written += is_number || is_quoted ? assignment + "\n" : fmt::format("{} = '{}'\n", assignment.substr(0, sign), value);
  }
  const toml::table root = internal::parse_toml(written, "--contact");
  const MeasurementReader reader(*root.get("contact")->as_table(), "--contact");
  reader.check_names();
  return reader.contact_keys();
}

Bench load_bench(const std::filesystem::path& path) { return parse_bench(read_file(path), path.string(), path.parent_path()); }

Bench parse_bench(std::string_view text, const std::string& name, const std::filesystem::path& directory) {
  const toml::table root = internal::parse_toml(text, name);
  Bench bench{.name = name, .measurements = {}, .changes = {}};
  for (const auto& [key, node] : root) {
    if (key.str() == "measurement") {
      const toml::array* all = node.as_array();
      require(all != nullptr && all->is_homogeneous<toml::table>(), [&] {
        return fmt::format("{}:{}: measurement: expected sections [[measurement]]", name, node.source().begin.line);
      });
      for (const toml::node& one : *all) bench.measurements.push_back(MeasurementReader(*one.as_table(), name, directory).read());
    } else if (key.str() == "device" && node.is_table()) {
      for (const auto& [device, changes] : *node.as_table())
        bench.changes.emplace(device.str(), changes_of(changes, name, std::string(device.str())));
    } else {
      throw InvalidInput(fmt::format("{}:{}: {}: unknown key{}", name, node.source().begin.line, shortened(key.str()),
                                     hint(key.str(), {"measurement", "device"})));
    }
  }
  require(!bench.measurements.empty(), [&] { return fmt::format("{}: must have at least one [[measurement]]", name); });
  for (const auto& [device, changes] : bench.changes) {
    const bool is_measured = std::ranges::any_of(bench.measurements, [&](const auto& m) { return m.device == device; });
    require(is_measured, [&] {
      return fmt::format(
          "{}: [device.{}]: no measurement belongs to this device; remove the section or give a measurement this device", name,
          shortened(device));
    });
  }
  return bench;
}

}  // namespace softland
