// Reads fields on nodes that COMSOL exports as text or CSV. Header lines begin with '%'; the last one names the columns, such as
// "w (m) @ freq=27513". Numbers may be complex. In a CSV, the name of a column may contain commas.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>

#include "base/printable.h"
#include "base/shortened.h"
#include "base/trimmed.h"
#include "exchange/cells.h"
#include "exchange/decoding.h"
#include "exchange/layout.h"
#include "exchange/nodal_modes.h"

namespace softland::internal {
namespace {

using Complex = std::complex<double>;
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

std::string shown(std::string_view text) { return printable_line(shortened(text, 60)); }

/// Reads a complex number such as "1.5", "-3E-5-0.004i" or "2i"; returns NaN for a missing value.
std::optional<Complex> complex_number(std::string_view text) {
  if (lower_case(text) == "nan") return Complex(nan_value, nan_value);
  if (!text.ends_with('i')) {
    const std::optional<double> real = plain_decimal(text);
    return real ? std::optional<Complex>(*real) : std::nullopt;
  }
  text.remove_suffix(1);
  std::size_t sign = 0;
  for (std::size_t k = text.size(); k-- > 1 && sign == 0;) {
    if ((text[k] == '+' || text[k] == '-') && text[k - 1] != 'e' && text[k - 1] != 'E') sign = k;
  }
  const std::optional<double> imaginary = plain_decimal(text.substr(sign));
  const std::optional<double> real = sign == 0 ? std::optional(0.0) : plain_decimal(text.substr(0, sign));
  if (!imaginary || !real) return std::nullopt;
  return Complex(*real, *imaginary);
}

/// Returns the size of a unit of length [m]; none for an unknown unit.
std::optional<double> metres(std::string_view unit) {
  static const std::map<std::string_view, double> known{{"m", 1},       {"dm", 0.1},    {"cm", 1e-2},    {"mm", 1e-3},
                                                        {"um", 1e-6},   {"µm", 1e-6},   {"μm", 1e-6},    {"nm", 1e-9},
                                                        {"in", 0.0254}, {"ft", 0.3048}, {"mil", 2.54e-5}};
  const auto found = known.find(unit);
  return found == known.end() ? std::nullopt : std::optional(found->second);
}

/// A column of a displacement, named for example "solid.w (m) @ freq=27513, p=1".
struct Column {
  std::string heading, parameters;
  int component = -1;  ///< component of the displacement: 0, 1 or 2 for u, v or w
  double per_unit = 1;
  double frequency = nan_value;  ///< frequency of the mode [Hz]
};

class ComsolReader {
 public:
  ComsolReader(std::string_view text, const std::string& file) : lines_(text), refusals_(file) {}

  NodalModes read() {
    read_header();
    read_rows();
    make_modes();
    return std::move(made_);
  }

 private:
  [[noreturn]] void fail(const std::string& rule) const { refusals_.fail(lines_.number(), 0, rule); }

  // Returns the text behind a key in a line of the header: "8" for the key Nodes in "Nodes:    8" or "Nodes,8".
  static std::string_view setting(std::string_view line, std::string_view key) {
    if (!line.starts_with(key)) return {};
    line.remove_prefix(key.size());
    if (!line.starts_with(':') && !line.starts_with(',')) return {};
    return trimmed(line.substr(1));
  }

  void read_header() {
    std::string_view columns;
    while (lines_.next()) {
      std::string_view line = lines_.line();
      if (!line.starts_with('%')) break;
      line = trimmed(line.substr(1));
      is_csv_ = is_csv_ || line.starts_with("Model,");
      if (const std::string_view unit = setting(line, "Length unit"); !unit.empty()) {
        made_.length_unit = metres(unit);
        if (!made_.length_unit) fail(fmt::format("the unit of length \"{}\" is not known", shown(unit)));
      } else if (const std::string_view count = setting(line, "Nodes"); !count.empty()) {
        nodes_ = plain_decimal(count);
      }
      columns = line;
      columns_line_ = lines_.number();
    }
    made_.format = is_csv_ ? "COMSOL CSV" : "COMSOL text";
    if (columns.empty() || lines_.line().starts_with('%')) refusals_.fail("the file ends above the numbers");
    made_.needs_length_unit = !made_.length_unit;
    cells_of(lines_.line());
    name_columns(columns, cells_.size());
  }

  void cells_of(std::string_view line) { split_cells(line, is_csv_ ? ',' : ' ', cells_); }

  // Splits the header line into as many column names as a row has numbers. In a CSV, a comma ends a name, except before a
  // further parameter of the solution such as "p=1".
  void name_columns(std::string_view line, std::size_t count) {
    std::vector<std::string> names;
    if (is_csv_) {
      std::vector<std::string_view> pieces;
      split_cells(line, ',', pieces);
      for (const std::string_view piece : pieces) {
        const bool is_parameter = !names.empty() && piece.find('=') != std::string_view::npos &&
                                  piece.find('@') == std::string_view::npos && names.back().find('@') != std::string::npos;
        is_parameter ? names.back() += fmt::format(", {}", piece) : names.emplace_back(piece);
      }
    } else {
      for (std::string_view rest = line; !rest.empty();) {
        const std::size_t end = std::min(rest.find("  "), rest.size());
        names.emplace_back(trimmed(rest.substr(0, end)));
        rest = trimmed(rest.substr(end));
      }
    }
    if (names.size() != count)
      refusals_.fail(columns_line_, 0,
                     fmt::format("the header has {} names of columns, but a row has {} numbers", names.size(), count));
    std::size_t k = 0;
    for (; k < names.size() && is_position(names[k]); ++k) continue;
    if (k == 0)
      refusals_.fail(columns_line_, 0,
                     fmt::format("the first columns must be positions x, y, z, but the first is \"{}\"", shown(names[0])));
    for (; k < names.size(); ++k) columns_.push_back(column(names[k]));
    if (columns_.empty()) refusals_.fail(columns_line_, 0, "there are positions, but no displacements");
  }

  bool is_position(const std::string& name) {
    const std::string lower = lower_case(name);
    const bool is_one = lower == "x" || lower == "y" || lower == "z";
    if (is_one) positions_.push_back(static_cast<std::size_t>(lower[0] - 'x'));
    return is_one;
  }

  Column column(const std::string& heading) {
    Column made{.heading = heading};
    const std::size_t at = heading.find('@');
    std::string_view what = trimmed(std::string_view(heading).substr(0, at));
    if (at != std::string::npos) made.parameters = trimmed(std::string_view(heading).substr(at + 1));
    std::string_view unit;
    if (const std::size_t open = what.rfind('('); open != std::string_view::npos && what.ends_with(')')) {
      unit = what.substr(open + 1, what.size() - open - 2);
      what = trimmed(what.substr(0, open));
    }
    const std::string name = lower_case(what.substr(what.find_last_of('.') + 1));
    for (const auto& [word, component] :
         std::map<std::string, int>{{"u", 0}, {"v", 1}, {"w", 2}, {"ux", 0}, {"uy", 1}, {"uz", 2}}) {
      if (name == word) made.component = component;
    }
    if (lower_case(what).starts_with("displacement field, ")) made.component = component_of(name);
    const std::optional<double> size = unit.empty() ? std::optional(1.0) : metres(unit);
    if (made.component < 0 || !size)
      refusals_.fail(
          columns_line_, 0,
          fmt::format("\"{}\" must be a displacement of an eigenfrequency study: u, v or w in a unit of length", shown(heading)));
    made.per_unit = *size;
    made.frequency = frequency(made.parameters);
    return made;
  }

  static int component_of(std::string_view name) {
    for (const auto& [word, component] :
         std::map<std::string_view, int>{{"x-component", 0}, {"y-component", 1}, {"z-component", 2}}) {
      if (name.ends_with(word)) return component;
    }
    return -1;
  }

  double frequency(std::string_view parameters) const {
    const std::size_t at = parameters.find("freq=");
    if (at == std::string_view::npos || (at > 0 && parameters[at - 1] != ' ' && parameters[at - 1] != ',')) return nan_value;
    std::string_view text = parameters.substr(at + 5);
    text = trimmed(text.substr(0, text.find_first_of(",; ")));
    const std::optional<Complex> value = complex_number(text);
    if (!value || !std::isfinite(value->real()))
      refusals_.fail(columns_line_, 0, fmt::format("the frequency of a mode is \"{}\"; it must be a number in Hz", shown(text)));
    return std::abs(value->real());
  }

  // Reads the rows of numbers. read_header() has already read the first one, the first line that does not begin with '%'.
  void read_rows() {
    values_.resize(columns_.size());
    do {
      if (trimmed(lines_.line()).empty()) continue;
      cells_of(lines_.line());
      if (cells_.size() != positions_.size() + columns_.size())
        fail(fmt::format("the row has {} numbers; it must have {}, one per column", cells_.size(),
                         positions_.size() + columns_.size()));
      Vector3 node{nan_value, nan_value, nan_value};
      for (std::size_t k = 0; k < positions_.size(); ++k) {
        const std::optional<double> place = plain_decimal(cells_[k]);
        if (!place)
          refusals_.fail(lines_.number(), k + 1, fmt::format("the position \"{}\" must be a finite number", shown(cells_[k])));
        node[positions_[k]] = *place;
      }
      add_row(node);
    } while (lines_.next());
    if (lines_.is_unended()) made_.notes.emplace_back("the last line has no end: it may have been cut");
    if (nodes_ && static_cast<double>(made_.nodes.size() + missing_) != *nodes_)
      refusals_.fail(
          fmt::format("the file has {} rows, but states {} nodes: its end is missing", made_.nodes.size() + missing_, *nodes_));
    if (made_.nodes.empty()) refusals_.fail("no node has a value (NaN everywhere): the points lie outside the model");
    if (missing_ > 0)
      made_.left_out.push_back(fmt::format("{} of {} nodes without values (NaN)", missing_, made_.nodes.size() + missing_));
  }

  void add_row(const Vector3& node) {
    std::vector<Complex> row;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const std::string_view cell = cells_[positions_.size() + k];
      const std::optional<Complex> value = complex_number(cell);
      if (!value)
        refusals_.fail(lines_.number(), positions_.size() + k + 1,
                       fmt::format("\"{}\" must be a number, which may be complex", shown(cell)));
      row.push_back(*value);
    }
    const auto empty = std::count_if(row.begin(), row.end(), [](const Complex& v) { return std::isnan(v.real()); });
    if (empty == static_cast<std::ptrdiff_t>(row.size())) {
      ++missing_;
      return;
    }
    if (empty > 0) fail("either all values of a node must be NaN, or none");
    made_.nodes.push_back(node);
    for (std::size_t k = 0; k < row.size(); ++k) values_[k].push_back(row[k] * columns_[k].per_unit);
  }

  // Makes modes from the columns. Columns with equal parameters, such as the frequency, are the displacement components of a
  // mode.
  void make_modes() {
    made_.holds = {false, false, false};
    std::vector<std::string> order;
    std::map<std::string, std::array<const std::vector<Complex>*, 3>> by_parameters;
    std::map<std::string, double> frequencies;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const Column& c = columns_[k];
      if (!by_parameters.contains(c.parameters)) order.push_back(c.parameters);
      const std::vector<Complex>*& place = by_parameters[c.parameters][static_cast<std::size_t>(c.component)];
      if (place != nullptr) refusals_.fail(columns_line_, 0, fmt::format("the column \"{}\" is given twice", shown(c.heading)));
      place = &values_[k];
      frequencies[c.parameters] = c.frequency;
      made_.holds[static_cast<std::size_t>(c.component)] = true;
    }
    for (const std::string& parameters : order) {
      const auto& parts = by_parameters[parameters];
      for (std::size_t d = 0; d < 3; ++d) {
        if (made_.holds[d] && parts[d] == nullptr)
          refusals_.fail(columns_line_, 0,
                         fmt::format("a component that other modes have is missing for \"{}\"", shown(parameters)));
      }
      made_.modes.push_back(
          {.frequency = frequencies[parameters],
           .motion = in_phase(parts, parameters),
           .name = fmt::format("mode {}{}", made_.modes.size() + 1, parameters.empty() ? "" : " (" + shown(parameters) + ")")});
    }
  }

  // Returns the real motion of a complex mode. Its common complex phase is arbitrary, so all displacements are multiplied by
  // that phase factor which leaves the smallest imaginary part.
  std::vector<Vector3> in_phase(const std::array<const std::vector<Complex>*, 3>& parts, const std::string& parameters) {
    constexpr double rounding = 1e-6, most = 0.1;
    Complex squares = 0;
    double whole = 0, outside = 0;
    for (const auto* part : parts) {
      if (part == nullptr) continue;
      for (const Complex& v : *part) squares += v * v, whole += std::norm(v);
    }
    const Complex turn = std::abs(squares) > 0 ? std::polar(1.0, -std::arg(squares) / 2) : 1.0;
    std::vector<Vector3> motion(made_.nodes.size(), no_motion);
    for (std::size_t d = 0; d < 3; ++d) {
      if (parts[d] == nullptr) continue;
      for (std::size_t i = 0; i < motion.size(); ++i) {
        const Complex v = squares.imag() == 0 && squares.real() > 0 ? (*parts[d])[i] : (*parts[d])[i] * turn;
        motion[i][d] = v.real();
        outside += v.imag() * v.imag();
      }
    }
    const double share = whole > 0 ? std::sqrt(outside / whole) : 0;
    if (share > most)
      refusals_.fail(fmt::format("the motion at \"{}\" must have a single phase, as a mode has, but {:.0f} % is out of phase",
                                 shown(parameters), 100 * share));
    if (share > rounding)
      made_.notes.push_back(fmt::format("{1:.2g} % of the complex motion at \"{0}\", which is out of phase, is left out",
                                        shown(parameters), 100 * share));
    return motion;
  }

  Lines lines_;
  Refusals refusals_;
  NodalModes made_;
  bool is_csv_ = false;
  std::size_t columns_line_ = 0, missing_ = 0;
  std::optional<double> nodes_;
  std::vector<std::size_t> positions_;
  std::vector<Column> columns_;
  std::vector<std::vector<Complex>> values_;  // displacements of the mesh nodes, by column of the file and node [m]
  std::vector<std::string_view> cells_;
};

}  // namespace

bool is_comsol(std::string_view text) {
  Lines lines(text.substr(0, 4096));
  while (lines.next() && trimmed(lines.line()).empty()) continue;
  const std::string_view line = lines.line();
  return line.starts_with('%') && trimmed(line.substr(1)).starts_with("Model");
}

NodalModes read_comsol(std::string_view text, const std::string& file) { return ComsolReader(text, file).read(); }

}  // namespace softland::internal
