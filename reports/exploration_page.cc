#include "reports/exploration_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "base/random.h"
#include "base/require.h"
#include "document/json_number.h"
#include "document/quantity.h"
#include "sampling/statistics.h"

namespace softland::internal {
namespace {

constexpr std::size_t most_values = 800'000;  // largest number of stored values on a page; each takes two bytes
constexpr std::size_t most_reasons = 300;     // largest number of different failure reasons on a page
constexpr int steps = 4094;                   // a column's values are rounded to multiples of (largest - smallest) / steps
constexpr std::size_t most_bins = 24;
constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Appends a number below 4096 to the text as two digits of base 64.
void append_letters(std::string& text, std::size_t number) {
  text += letters[number / 64];
  text += letters[number % 64];
}

struct ColumnRange {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  bool all_whole = true;
  bool all_positive = true;
  [[nodiscard]] bool is_known() const { return low <= high; }
};

ColumnRange range_of(const ExplorationReport& report, std::size_t column) {
  ColumnRange range;
  for (const ExploredPoint& point : report.points) {
    const double value = point.values[column];
    if (!std::isfinite(value)) continue;
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
    range.all_whole = range.all_whole && value == std::round(value);
    range.all_positive = range.all_positive && value > 0;
  }
  return range;
}

/// Returns the number of steps from the low end of a column to the step nearest to a value.
std::size_t step_of(double low, double step, double value) {
  const double way = value - low;
  const double count = std::isfinite(way) ? way / step : value / step - low / step;
  return static_cast<std::size_t>(std::lround(std::clamp(count, 0.0, static_cast<double>(steps))));
}

/// Rounds a value to this number of significant digits.
double shortened_to(int digits, double value) {
  const double near = std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr);
  return std::isfinite(near) ? near : value;
}

/// Returns a column of the exploration as JSON: its name, its smallest value, its step, and the values as numbers of steps in
/// base 64. Steps are of equal ratio if the column spans decades.
nlohmann::json column_json(const ExplorationReport& report, std::size_t column, const std::vector<std::size_t>& rows) {
  const ColumnRange range = range_of(report, column);
  constexpr double decades = 100;  // least ratio of the largest value of a column to the smallest for steps of equal ratio
  const bool logarithmic = range.is_known() && range.all_positive && range.high > decades * range.low;
  const auto scaled = [&](double value) { return logarithmic ? std::log(value) : value; };
  const double low = range.is_known() ? scaled(range.low) : 0, high = range.is_known() ? scaled(range.high) : 0;
  const bool counted = range.all_whole && !logarithmic && high - low <= steps;
  const double step = counted ? 1 : std::isfinite(high - low) ? (high - low) / steps : high / steps - low / steps;
  const ExploredColumn& about = report.columns[column];
  nlohmann::json out{{"key", about.key},
                     {"name", about.name},
                     {"unit", about.unit},
                     {"variable", about.is_variable},
                     {"low", low},
                     {"step", step},
                     {"log", logarithmic},
                     {"prefix", takes_prefix(about.unit)},
                     {"known", range.is_known()}};
  if (!range.is_known() || step == 0) return out;  // the column is empty or constant: it needs no steps
  std::string text;
  for (const std::size_t k : rows) {
    const double value = report.points[k].values[column];
    append_letters(text, std::isfinite(value) ? step_of(low, step, scaled(value)) : 4095);
  }
  out["data"] = std::move(text);
  return out;
}

/// One stride per variable: a stride k keeps every k-th value of the variable.
using Strides = std::vector<std::size_t>;

std::size_t kept_values(std::size_t count, std::size_t stride) { return (count + stride - 1) / stride; }

Strides strides_for(const ExploredGrid& grid, std::size_t most_points) {
  Strides strides(grid.variables.size(), 1);
  const auto kept = [&] {
    std::size_t product = 1;
    for (std::size_t d = 0; d < strides.size(); ++d) product *= kept_values(grid.values[d].size(), strides[d]);
    return product;
  };
  while (kept() > most_points) {
    std::size_t longest = 0;
    for (std::size_t d = 1; d < strides.size(); ++d) {
      if (kept_values(grid.values[d].size(), strides[d]) > kept_values(grid.values[longest].size(), strides[longest]))
        longest = d;
    }
    ++strides[longest];
  }
  return strides;
}

/// The points of the exploration to draw, ascending, and the rule by which the points were chosen.
struct Choice {
  std::vector<std::size_t> points;
  Strides strides;
  std::string words;
};

std::string stride_prose(const ExplorationReport& report, const ExploredGrid& grid, const Strides& strides) {
  std::vector<std::string> parts;
  for (std::size_t d = 0; d < strides.size(); ++d) {
    if (strides[d] > 1)
      parts.push_back(fmt::format("one in {} of the {} values of {}", strides[d], grid.values[d].size(),
                                  report.columns[grid.variables[d]].name));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

Choice chosen_points(const ExplorationReport& report, const std::optional<ExploredGrid>& grid, const ExploredFront& front,
                     std::size_t most) {
  Choice choice;
  const std::size_t count = report.points.size();
  std::vector<char> kept(count, 1);
  if (grid) choice.strides = Strides(grid->variables.size(), 1);
  if (count > most) {
    std::string how;
    if (grid) {
      choice.strides = strides_for(*grid, most);
      for (std::size_t k = 0; k < count; ++k) {
        const std::vector<std::size_t> place = grid->place(report.points[k]);
        for (std::size_t d = 0; d < place.size(); ++d)
          kept[k] = static_cast<char>(kept[k] != 0 && place[d] % choice.strides[d] == 0);
      }
      how = stride_prose(report, *grid, choice.strides);
    } else {
      // Points that are no grid, such as a random sample, are thinned at random. Probability with which a point is drawn:
      const double part = static_cast<double>(most) / static_cast<double>(count);
      for (std::size_t k = 0; k < count; ++k)
        kept[k] = static_cast<char>(random_uniform(0, Stream::scene, static_cast<std::uint64_t>(report.points[k].number)) < part);
      how = "chosen at random, each with the same probability";
    }
    for (const std::size_t k : front.members) kept[k] = 1;
    const auto drawn = std::count(kept.begin(), kept.end(), 1);
    const bool has_front = !front.members.empty();
    choice.words = fmt::format("{} of {} points are drawn: {}{}. Counts{} include all points.", drawn, count, how,
                               has_front ? ", and the front" : "", has_front ? ", effects and the front" : " and effects");
  }
  for (std::size_t k = 0; k < count; ++k) {
    if (kept[k] != 0) choice.points.push_back(k);
  }
  return choice;
}

nlohmann::json grid_json(const ExplorationReport& report, const ExploredGrid& grid, const Choice& choice) {
  nlohmann::json out{{"variables", grid.variables}, {"values", nlohmann::json::array()}};
  for (std::size_t d = 0; d < grid.variables.size(); ++d) {
    nlohmann::json values = nlohmann::json::array();
    for (std::size_t k = 0; k < grid.values[d].size(); k += choice.strides[d]) values.push_back(grid.values[d][k]);
    out["values"].push_back(std::move(values));
  }
  // A cell is the position of a point in the thinned grid, counted with the last variable fastest; -1 for a point of the Pareto
  // front that the thinned grid lacks. Cells are written as differences from the cell before, which take few digits.
  nlohmann::json cells = nlohmann::json::array();
  long expected = 0, before = 0;
  bool in_order = true;
  for (const std::size_t k : choice.points) {
    const std::vector<std::size_t> place = grid.place(report.points[k]);
    long cell = 0;
    for (std::size_t d = 0; d < place.size(); ++d) {
      if (cell >= 0 && place[d] % choice.strides[d] == 0)
        cell = cell * static_cast<long>(kept_values(grid.values[d].size(), choice.strides[d])) +
               static_cast<long>(place[d] / choice.strides[d]);
      else
        cell = -1;
    }
    in_order = in_order && cell == expected++;
    cells.push_back(cell - before);
    before = cell;
  }
  if (!in_order) out["cells"] = std::move(cells);
  return out;
}

/// Adds statuses and failure reasons of the drawn points, as indices into lists of texts.
void add_outcomes(nlohmann::json& out, const ExplorationReport& report, const std::vector<std::size_t>& rows) {
  std::map<std::string, std::size_t> statuses, reasons{{"", 0}};
  std::vector<std::string> status_words, reason_words{""};
  std::string status, reason;
  for (const std::size_t k : rows) {
    const ExploredPoint& point = report.points[k];
    const auto [s, is_new] = statuses.emplace(point.status, std::min(status_words.size(), letters.size() - 1));
    if (is_new && status_words.size() < letters.size()) status_words.push_back(point.status);
    status += letters[s->second];
    if (reason_words.size() == most_reasons && !reasons.contains(point.reason)) {
      append_letters(reason, 0);
      continue;
    }
    const auto [r, is_first] = reasons.emplace(point.reason, reason_words.size());
    if (is_first) reason_words.push_back(point.reason);
    append_letters(reason, r->second);
  }
  out["statuses"] = status_words;
  out["status"] = std::move(status);
  if (reason_words.size() > 1) {
    out["reasons"] = reason_words;
    out["reason"] = std::move(reason);
  }
}

nlohmann::json effects_json(const ExplorationReport& report) {
  nlohmann::json out = nlohmann::json::array();
  for (const std::size_t variable : columns_of(report, true)) {
    nlohmann::json figures = nlohmann::json::object();
    for (const std::size_t figure : columns_of(report, false)) {
      const ColumnRange range = range_of(report, figure);
      if (!range.is_known() || range.low == range.high) continue;
      nlohmann::json bins = nlohmann::json::array();
      for (const EffectBin& bin : effect_of(report, variable, figure)) {
        nlohmann::json one = nlohmann::json::array({shortened_to(6, bin.at), bin.points});
        for (const double q : bin.quantiles) one.push_back(json_number(shortened_to(5, q)));
        bins.push_back(std::move(one));
      }
      figures[std::to_string(figure)] = std::move(bins);
    }
    out.push_back({{"variable", variable}, {"figures", std::move(figures)}});
  }
  return out;
}

}  // namespace

std::vector<std::size_t> columns_of(const ExplorationReport& report, bool variables) {
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < report.columns.size(); ++c) {
    if (report.columns[c].is_variable == variables) columns.push_back(c);
  }
  return columns;
}

std::vector<std::size_t> ExploredGrid::place(const ExploredPoint& point) const {
  std::vector<std::size_t> out;
  for (std::size_t d = 0; d < variables.size(); ++d) {
    const auto at = std::lower_bound(values[d].begin(), values[d].end(), point.values[variables[d]]);
    out.push_back(static_cast<std::size_t>(at - values[d].begin()));
  }
  return out;
}

std::optional<ExploredGrid> grid_of(const ExplorationReport& report) {
  ExploredGrid grid;
  std::size_t cells = 1;
  const std::size_t most_cells = 2 * report.points.size();
  for (const std::size_t c : columns_of(report, true)) {
    std::set<double> seen;
    for (const ExploredPoint& point : report.points) {
      if (!std::isfinite(point.values[c])) return std::nullopt;
      seen.insert(point.values[c]);
    }
    if (seen.size() < 2) continue;
    cells *= seen.size();
    if (cells > most_cells) return std::nullopt;
    grid.variables.push_back(c);
    grid.values.emplace_back(seen.begin(), seen.end());
  }
  if (grid.variables.size() < 2) return std::nullopt;
  grid.points.assign(cells, ExploredGrid::nothing);
  for (std::size_t k = 0; k < report.points.size(); ++k) {
    std::size_t cell = 0;
    const std::vector<std::size_t> place = grid.place(report.points[k]);
    for (std::size_t d = 0; d < place.size(); ++d) cell = cell * grid.values[d].size() + place[d];
    if (grid.points[cell] != ExploredGrid::nothing) return std::nullopt;
    grid.points[cell] = k;
  }
  return grid;
}

HeatMap heat_map_of(const ExplorationReport& report, const ExploredGrid& grid, std::size_t x, std::size_t y, std::size_t figure) {
  const auto dimension = [&](std::size_t column) {
    const auto found = std::find(grid.variables.begin(), grid.variables.end(), column);
    require(found != grid.variables.end(), fmt::format("{} does not vary on a grid", report.columns[column].name));
    return static_cast<std::size_t>(found - grid.variables.begin());
  };
  const auto axis = [&](std::size_t column) {
    return HeatMapAxis{report.columns[column].name, report.columns[column].unit, grid.values[dimension(column)]};
  };
  HeatMap map{.x = axis(x),
              .y = axis(y),
              .label = report.columns[figure].name,
              .unit = report.columns[figure].unit,
              .values = {},
              .missing = {},
              .reasons = {"not computed"}};
  std::map<std::string, std::size_t> reasons;
  std::vector<std::size_t> place(grid.variables.size());
  for (std::size_t d = 0; d < place.size(); ++d) place[d] = grid.values[d].size() / 2;
  for (std::size_t j = 0; j < map.y.values.size(); ++j) {
    for (std::size_t i = 0; i < map.x.values.size(); ++i) {
      place[dimension(x)] = i;
      place[dimension(y)] = j;
      std::size_t cell = 0;
      for (std::size_t d = 0; d < place.size(); ++d) cell = cell * grid.values[d].size() + place[d];
      const std::size_t k = grid.points[cell];
      std::size_t reason = 0;
      if (k != ExploredGrid::nothing) {
        const auto [found, is_new] = reasons.emplace(report.points[k].status, map.reasons.size());
        if (is_new) map.reasons.push_back(report.points[k].status);
        reason = found->second;
      }
      map.values.push_back(k == ExploredGrid::nothing ? Metrics::unset : report.points[k].values[figure]);
      map.missing.push_back(reason);
    }
  }
  for (std::string& words : map.reasons) std::replace(words.begin(), words.end(), '_', ' ');
  return map;
}

std::vector<EffectBin> effect_of(const ExplorationReport& report, std::size_t variable, std::size_t figure) {
  std::vector<std::pair<double, double>> pairs;
  for (const ExploredPoint& point : report.points) {
    if (std::isfinite(point.values[variable]) && std::isfinite(point.values[figure]))
      pairs.emplace_back(point.values[variable], point.values[figure]);
  }
  std::sort(pairs.begin(), pairs.end());
  // Ranges [begin, end) of `pairs` with equal values of the variable, which must not be divided between two bins.
  std::vector<std::pair<std::size_t, std::size_t>> groups;
  for (std::size_t begin = 0; begin < pairs.size();) {
    std::size_t end = begin;
    while (end < pairs.size() && pairs[end].first == pairs[begin].first) ++end;
    groups.emplace_back(begin, end);
    begin = end;
  }
  std::vector<EffectBin> bins;
  const std::size_t wanted = std::min(most_bins, groups.size());
  std::size_t group = 0;
  for (std::size_t b = 0; b < wanted; ++b) {
    const std::size_t begin = group < groups.size() ? groups[group].first : pairs.size();
    std::size_t end = begin;
    const std::size_t target = groups.size() <= most_bins ? 0 : (b + 1) * pairs.size() / wanted;
    do {
      if (group == groups.size()) break;
      end = groups[group++].second;
    } while (end < target);
    if (begin == end) break;
    EffectBin& bin = bins.emplace_back(
        EffectBin{.at = std::midpoint(pairs[begin + (end - begin - 1) / 2].first, pairs[begin + (end - begin) / 2].first),
                  .points = end - begin});
    std::vector<double> values;
    for (std::size_t k = begin; k < end; ++k) values.push_back(pairs[k].second);
    std::sort(values.begin(), values.end());
    constexpr std::array levels{0.05, 0.25, 0.5, 0.75, 0.95};
    for (std::size_t q = 0; q < levels.size(); ++q) bin.quantiles[q] = quantile_of_sorted(values, levels[q]);
  }
  return bins;
}

std::string explored_text(const ExploredColumn& column, double value, int digits) {
  if (column.unit.empty()) return plain_number(value, digits);
  return takes_prefix(column.unit) ? quantity(value, column.unit, digits) : plain_number(value, digits) + "\u00a0" + column.unit;
}

std::size_t leading_figure(const ExplorationReport& report) {
  const std::vector<std::size_t> figures = columns_of(report, false);
  require(!figures.empty(), "an exploration without figures cannot be reported");
  const auto varies = [&](std::size_t c) {
    const ColumnRange range = range_of(report, c);
    return range.low < range.high;
  };
  for (const std::size_t c : figures) {
    if (report.columns[c].key == key_of(&Metrics::impact_velocity) && varies(c)) return c;
  }
  const auto first = std::find_if(figures.begin(), figures.end(), varies);
  return first == figures.end() ? figures.front() : *first;
}

ExplorationData exploration_data(const ExplorationReport& report, const std::optional<ExploredGrid>& grid,
                                 const ExploredFront& front) {
  // Number of values that a page stores per point. Status and reason take the space of about two columns, and so do number and
  // coordinates of a point that is in no grid. Every column that varies is added.
  std::size_t stored = grid ? 2 : 4;
  for (std::size_t c = 0; c < report.columns.size(); ++c) {
    const ColumnRange range = range_of(report, c);
    stored += range.is_known() && range.low < range.high ? 1 : 0;
  }
  const Choice choice = chosen_points(report, grid, front, most_values / stored);
  nlohmann::json out{{"columns", nlohmann::json::array()}, {"figure", leading_figure(report)}, {"rows", choice.points.size()}};
  for (std::size_t c = 0; c < report.columns.size(); ++c) out["columns"].push_back(column_json(report, c, choice.points));
  add_outcomes(out, report, choice.points);
  bool numbered = true;
  for (std::size_t row = 0; row < choice.points.size(); ++row)
    numbered = numbered && report.points[choice.points[row]].number == static_cast<std::int64_t>(row);
  if (!numbered) {
    std::int64_t before = 0;
    for (const std::size_t k : choice.points) {
      out["numbers"].push_back(report.points[k].number - before);
      before = report.points[k].number;
    }
  }
  if (grid) out["grid"] = grid_json(report, *grid, choice);
  const auto row_of = [&](std::size_t k) {
    return std::lower_bound(choice.points.begin(), choice.points.end(), k) - choice.points.begin();
  };
  for (const ExploredAim& aim : report.aims) out["aims"].push_back({{"column", aim.column}, {"largest", aim.is_largest}});
  for (const std::size_t k : front.members) out["front"].push_back(row_of(k));
  if (front.knee) out["knee"] = row_of(*front.knee);
  for (const std::size_t k : choice.points) {
    const auto drives = report.waveforms.find(report.points[k].number);
    if (drives == report.waveforms.end()) continue;
    for (const auto& [drive, line] : drives->second) {
      nlohmann::json& shape = out["waveforms"][std::to_string(row_of(k))][drive];
      for (const auto& [time, level] : line) shape.push_back({shortened_to(6, time), shortened_to(5, level)});
    }
  }
  out["effects"] = effects_json(report);
  return {std::move(out), choice.words};
}

}  // namespace softland::internal
