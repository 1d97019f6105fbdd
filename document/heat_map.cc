#include "document/heat_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "document/axis.h"
#include "document/escape.h"
#include "document/quantity.h"

namespace softland::internal {
namespace {

constexpr double map_left = 84;
constexpr double map_right = 128;  // width to the right of the map, for the colour scale [px]
constexpr double map_above = 14;
constexpr double map_below = 84;    // height below the map, for tick labels, axis label and legend of hatches [px]
constexpr int steps_of_scale = 32;  // number of distinct colours of the map's colour scale

std::vector<double> finite(const std::vector<double>& values) {
  std::vector<double> out;
  std::copy_if(values.begin(), values.end(), std::back_inserter(out), [](double v) { return std::isfinite(v); });
  return out;
}

/// Replaces an infinite value by the largest finite number of the same sign.
double within(double value) {
  constexpr double largest = std::numeric_limits<double>::max();
  return std::clamp(value, -largest, largest);
}

/// Assembles the contour lines of one level from segments. Each segment crosses a square whose corners are four cell centres,
/// from one edge of the square to another. An edge is identified by the cell where it begins and its direction, right or up.
class Contour {
 public:
  Contour(const std::vector<double>& values, std::size_t columns, double level)
      : values_(values), columns_(columns), level_(level) {
    const std::size_t rows = columns == 0 ? 0 : values.size() / columns;
    for (std::size_t j = 0; j + 1 < rows; ++j) {
      for (std::size_t i = 0; i + 1 < columns; ++i) cross(i, j);
    }
  }

  std::vector<ContourLine> lines() {
    std::vector<ContourLine> all;
    // An edge with only one segment is an end of an open line. All lines that remain after the open ones are closed.
    for (const bool open : {true, false}) {
      for (auto& [edge, next] : joined_) {
        if (next.empty() || (open && next.size() != 1)) continue;
        all.push_back(followed(edge));
      }
    }
    return all;
  }

 private:
  using Edge = std::size_t;
  [[nodiscard]] Edge rightwards(std::size_t i, std::size_t j) const { return 2 * (j * columns_ + i); }
  [[nodiscard]] Edge upwards(std::size_t i, std::size_t j) const { return rightwards(i, j) + 1; }
  [[nodiscard]] double at(std::size_t i, std::size_t j) const { return values_[j * columns_ + i]; }

  void join(Edge a, Edge b) {
    joined_[a].push_back(b);
    joined_[b].push_back(a);
  }

  void cross(std::size_t i, std::size_t j) {
    const std::array corners{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
    if (!std::all_of(corners.begin(), corners.end(), [](double v) { return std::isfinite(v); })) return;
    const std::array edges{rightwards(i, j), upwards(i + 1, j), rightwards(i, j + 1), upwards(i, j)};
    std::vector<Edge> crossed;
    for (std::size_t k = 0; k < 4; ++k) {
      if ((corners[k] > level_) != (corners[(k + 1) % 4] > level_)) crossed.push_back(edges[k]);
    }
    if (crossed.size() == 2) join(crossed[0], crossed[1]);
    if (crossed.size() != 4) return;
    // At a saddle, two segments cross all four edges of the square. The mean of the four corners decides which edges they join.
    const bool middle = std::midpoint(std::midpoint(corners[0], corners[1]), std::midpoint(corners[2], corners[3])) > level_;
    const bool turned = middle == (corners[0] > level_);
    join(crossed[0], crossed[turned ? 1 : 3]);
    join(crossed[2], crossed[turned ? 3 : 1]);
  }

  [[nodiscard]] std::array<double, 2> place(Edge edge) const {
    const std::size_t cell = edge / 2, i = cell % columns_, j = cell / columns_;
    const bool up = edge % 2 == 1;
    const double a = at(i, j), b = up ? at(i, j + 1) : at(i + 1, j);
    const double part = part_between(a, b, level_);
    return {static_cast<double>(i) + (up ? 0 : part), static_cast<double>(j) + (up ? part : 0)};
  }

  ContourLine followed(Edge edge) {
    ContourLine line{place(edge)};
    while (!joined_[edge].empty()) {
      const Edge next = joined_[edge].back();
      joined_[edge].pop_back();
      std::vector<Edge>& back = joined_[next];
      back.erase(std::find(back.begin(), back.end(), edge));
      edge = next;
      line.push_back(place(edge));
    }
    return line;
  }

  const std::vector<double>& values_;
  std::size_t columns_;
  double level_;
  std::map<Edge, std::vector<Edge>> joined_;
};

/// Maps the values of an axis to pixels. The cell of a value ends half-way to the neighbouring values.
class Cells {
 public:
  Cells(const HeatMapAxis& axis, double from, double to) : values_(axis.values) {
    const std::size_t n = values_.size();
    const bool positive = values_.front() > 0;
    // The axis is logarithmic if its values have equal ratios.
    const auto log_ratio = [&](std::size_t k) { return std::log(values_[k]) - std::log(values_[0]); };
    const double ratio = n > 2 && positive ? log_ratio(n - 1) / static_cast<double>(n - 1) : 0;
    const double first = n > 2 && positive ? log_ratio(1) : 1;
    const bool logarithmic = n > 2 && positive && values_[n - 1] / values_[0] > 3 && std::abs(first - ratio) < 0.01 * ratio;
    axis_ = {.scale = logarithmic ? AxisScale::logarithmic : AxisScale::linear,
             .low = 0,
             .high = 1,
             .pixel_low = from,
             .pixel_high = to};
    const auto between = [&](double a, double b) { return logarithmic ? std::sqrt(a) * std::sqrt(b) : std::midpoint(a, b); };
    const auto beyond = [&](double inner, double end) {
      return within(logarithmic ? end * (std::sqrt(end) / std::sqrt(inner)) : end + (end / 2 - inner / 2));
    };
    const double alone = values_[0] == 0 ? 1 : std::abs(values_[0]) / 2;
    edges_.push_back(n > 1 ? beyond(values_[1], values_[0]) : within(values_[0] - alone));
    for (std::size_t k = 1; k < n; ++k) edges_.push_back(between(values_[k - 1], values_[k]));
    edges_.push_back(n > 1 ? beyond(values_[n - 2], values_[n - 1]) : within(values_[0] + alone));
    axis_.low = edges_.front();
    axis_.high = edges_.back();
  }

  [[nodiscard]] double edge(std::size_t k) const { return axis_.pixel(edges_[k]); }
  /// Returns the pixel coordinate of position k, interpolated between centres of cells; the centre of cell i is at k = i.
  [[nodiscard]] double place(double k) const {
    const auto lower = std::min(static_cast<std::size_t>(k), values_.size() - 1);
    const auto upper = std::min(lower + 1, values_.size() - 1);
    return std::lerp(axis_.pixel(values_[lower]), axis_.pixel(values_[upper]), k - static_cast<double>(lower));
  }
  [[nodiscard]] const Axis& axis() const { return axis_; }

 private:
  const std::vector<double>& values_;
  std::vector<double> edges_;
  Axis axis_;
};

Prefix prefix_of(const std::string& unit, double largest) { return takes_prefix(unit) ? prefix_for(largest) : Prefix{}; }

std::string axis_label(const std::string& label, const std::string& unit, const Prefix& prefix) {
  return escaped(label) + (unit.empty() ? "" : fmt::format(" ({}{})", prefix.symbol, escaped(unit)));
}

/// Returns one SVG path for each class of cells, a colour or a hatch. Neighbouring cells of one class in a row make one
/// rectangle of the path.
std::map<std::size_t, std::string> rectangles(const std::vector<std::size_t>& classes, const Cells& x, const Cells& y,
                                              std::size_t columns) {
  std::map<std::size_t, std::string> paths;
  for (std::size_t j = 0; j < classes.size() / columns; ++j) {
    const double top = y.edge(j + 1), height = y.edge(j) - top;
    for (std::size_t begin = 0; begin < columns;) {
      std::size_t end = begin;
      while (end < columns && classes[j * columns + end] == classes[j * columns + begin]) ++end;
      const double width = x.edge(end) - x.edge(begin);
      paths[classes[j * columns + begin]] +=
          fmt::format("M{:.1f} {:.1f}h{:.1f}v{:.1f}h{:.1f}z", x.edge(begin), top, width, height, -width);
      begin = end;
    }
  }
  return paths;
}

/// Returns the SVG hatch pattern of cells without a value. Each reason for a missing value has its own hatch.
std::string mark_pattern(std::size_t reason) {
  constexpr std::array shapes{"M-1 7L7 -1M-1 1L1 -1M5 7L7 5", "M-1 -1L7 7M-1 5L1 7M5 -1L7 1", "M0 3H6", "M3 0V6"};
  return fmt::format(
      "<pattern id=\"reason-{0}\" width=\"6\" height=\"6\" patternUnits=\"userSpaceOnUse\"><rect width=\"6\" height=\"6\" "
      "fill=\"#f1f3f4\"/><path d=\"{1}\" stroke=\"#8a949e\" stroke-width=\"1\"/></pattern>\n",
      reason, shapes[reason % shapes.size()]);
}

std::string cells(const HeatMap& map, const Cells& x, const Cells& y, const ColourRange& range) {
  const std::size_t columns = map.x.values.size();
  std::vector<std::size_t> classes;
  for (std::size_t k = 0; k < map.values.size(); ++k) {
    const double part = part_between(range.low, range.high, map.values[k]);
    classes.push_back(std::isfinite(map.values[k])
                          ? static_cast<std::size_t>(std::clamp(part * steps_of_scale, 0.0, steps_of_scale - 1.0))
                          : steps_of_scale + map.missing[k]);
  }
  std::string out;
  for (const auto& [which, path] : rectangles(classes, x, y, columns)) {
    const std::string fill = which < steps_of_scale ? scale_colour((static_cast<double>(which) + 0.5) / steps_of_scale)
                                                    : fmt::format("url(#reason-{})", which - steps_of_scale);
    // A stroke in the colour of the cells hides the thin gap that renderers leave between rows.
    const std::string stroke = which < steps_of_scale ? fmt::format(" stroke=\"{}\" stroke-width=\"0.4\"", fill) : "";
    out += fmt::format("<path d=\"{}\" fill=\"{}\"{}/>\n", path, fill, stroke);
  }
  return out;
}

std::string contours(const HeatMap& map, const Cells& x, const Cells& y, const ColourRange& range, const Prefix& prefix) {
  const std::size_t columns = map.x.values.size();
  if (is_ragged(map.values, columns)) return {};
  std::string paths, words;
  std::vector<std::array<double, 2>> labels;
  for (const double level : contour_levels(map.values, 9)) {
    if (level <= range.low || level >= range.high) continue;
    for (const ContourLine& line : contour_lines(map.values, columns, level)) {
      // Shorter contour lines, by their number of points, are not drawn, or are drawn without a label.
      constexpr std::size_t shortest = 4, labelled = 14;
      if (line.size() < shortest) continue;
      for (std::size_t k = 0; k < line.size(); ++k)
        paths += fmt::format("{}{:.1f} {:.1f}", k == 0 ? "M" : "L", x.place(line[k][0]), y.place(line[k][1]));
      const std::array<double, 2> middle{x.place(line[line.size() / 2][0]), y.place(line[line.size() / 2][1])};
      const bool crowded = std::any_of(labels.begin(), labels.end(), [&](const std::array<double, 2>& other) {
        return std::abs(other[0] - middle[0]) < 56 && std::abs(other[1] - middle[1]) < 18;
      });
      if (line.size() < labelled || crowded) continue;
      labels.push_back(middle);
      words += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n", middle[0], middle[1] + 4,
                           plain_number(level / prefix.factor, 4));
    }
  }
  return fmt::format(
      "<path d=\"{0}\" fill=\"none\" stroke=\"#fff\" stroke-width=\"2.2\" stroke-opacity=\"0.55\"/>\n<path "
      "d=\"{0}\" fill=\"none\" stroke=\"{1}\" stroke-width=\"0.9\"/>\n<g font-size=\"12\" fill=\"{1}\" "
      "stroke=\"#fff\" stroke-width=\"3\" stroke-linejoin=\"round\" paint-order=\"stroke\">\n{2}</g>\n",
      paths, ink, words);
}

std::string frame(const HeatMap& map, const Cells& x, const Cells& y, double width, double height) {
  const Prefix x_prefix = prefix_of(map.x.unit, map.x.values.back());
  const Prefix y_prefix = prefix_of(map.y.unit, map.y.values.back());
  std::string out =
      fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" stroke=\"{}\"/>\n", map_left,
                  map_above, width - map_left - map_right, height - map_above - map_below, muted);
  const auto text = [&](double at_x, double at_y, std::string_view anchor, const std::string& words, std::string_view more = "") {
    out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", at_x, at_y, anchor, more, words);
  };
  const double bottom = height - map_below;
  for (const double tick : ticks(x.axis(), 8))
    text(x.axis().pixel(tick), bottom + 17, "middle", plain_number(tick / x_prefix.factor, 5));
  for (const double tick : ticks(y.axis(), 8))
    text(map_left - 8, y.axis().pixel(tick) + 4, "end", plain_number(tick / y_prefix.factor, 5));
  text((map_left + width - map_right) / 2, bottom + 38, "middle", axis_label(map.x.label, map.x.unit, x_prefix));
  const double middle = (map_above + bottom) / 2;
  text(20, middle, "middle", axis_label(map.y.label, map.y.unit, y_prefix),
       fmt::format(" transform=\"rotate(-90 20 {:.1f})\"", middle));
  return out;
}

std::string legend(const HeatMap& map, const ColourRange& range, const Prefix& prefix, double width, double height) {
  const double x = width - map_right + 22, bottom = height - map_below, tall = (bottom - map_above) / steps_of_scale;
  std::string out;
  for (int k = 0; k < steps_of_scale; ++k) {
    out += fmt::format("<rect x=\"{:.1f}\" y=\"{:.2f}\" width=\"16\" height=\"{:.2f}\" fill=\"{}\"/>\n", x,
                       bottom - (k + 1) * tall, tall + 0.4, scale_colour((k + 0.5) / steps_of_scale));
  }
  const Axis axis{.scale = AxisScale::linear, .low = range.low, .high = range.high, .pixel_low = bottom, .pixel_high = map_above};
  for (const double tick : ticks(axis, 8))
    out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x + 22, axis.pixel(tick) + 4,
                       plain_number(tick / prefix.factor, 5));
  if (!map.unit.empty())
    out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}{}</text>\n", x, bottom + 32, prefix.symbol, escaped(map.unit));
  if (range.cut_above) out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">and above</text>\n", x, map_above - 3);
  if (range.cut_below) out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">and below</text>\n", x, bottom + 14);
  std::set<std::size_t> marked;
  for (std::size_t k = 0; k < map.values.size(); ++k) {
    if (!std::isfinite(map.values[k])) marked.insert(map.missing[k]);
  }
  double at = map_left;
  for (const std::size_t reason : marked) {
    out += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"22\" height=\"13\" fill=\"url(#reason-{})\" stroke=\"{}\" "
        "stroke-width=\"0.6\"/><text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
        at, bottom + 54, reason, muted, at + 30, bottom + 65, escaped(map.reasons[reason]));
    at += 56 + 7.2 * static_cast<double>(map.reasons[reason].size());
  }
  return out;
}

}  // namespace

HeatMap thinned_map(HeatMap map, std::size_t most_cells) {
  std::size_t x_stride = 1, y_stride = 1;
  const auto kept = [](const HeatMapAxis& axis, std::size_t stride) { return (axis.values.size() + stride - 1) / stride; };
  while (kept(map.x, x_stride) * kept(map.y, y_stride) > most_cells)
    ++(kept(map.x, x_stride) > kept(map.y, y_stride) ? x_stride : y_stride);
  if (x_stride == 1 && y_stride == 1) return map;
  const std::size_t columns = map.x.values.size();
  std::vector<double> values;
  std::vector<std::size_t> missing;
  for (std::size_t j = 0; j < map.y.values.size(); j += y_stride) {
    for (std::size_t i = 0; i < columns; i += x_stride) {
      values.push_back(map.values[j * columns + i]);
      missing.push_back(map.missing[j * columns + i]);
    }
  }
  map.values = std::move(values);
  map.missing = std::move(missing);
  for (auto [axis, stride] : {std::pair{&map.x, x_stride}, std::pair{&map.y, y_stride}}) {
    if (stride == 1) continue;
    const std::vector<double> all = std::exchange(axis->values, {});
    for (std::size_t k = 0; k < all.size(); k += stride) axis->values.push_back(all[k]);
    axis->label += fmt::format(", one in {} of {} values", stride, all.size());
  }
  return map;
}

std::vector<ContourLine> contour_lines(const std::vector<double>& values, std::size_t columns, double level) {
  return Contour(values, columns, level).lines();
}

std::vector<double> contour_levels(const std::vector<double>& values, int wanted) {
  const ColourRange range = colour_range(values);
  std::vector<double> levels = ticks({.scale = AxisScale::linear, .low = range.low, .high = range.high}, wanted);
  std::erase_if(levels, [&](double level) { return level <= range.low || level >= range.high; });
  return levels;
}

bool is_ragged(const std::vector<double>& values, std::size_t columns) {
  // Largest mean difference of smooth values from the mean of their neighbours, as a share of the colour range. For random
  // values it is about a third.
  constexpr double smooth = 0.1;
  const ColourRange range = colour_range(values);
  double sum = 0;
  long pairs = 0;
  const auto compare = [&](double a, double b) {
    if (!std::isfinite(a) || !std::isfinite(b)) return;
    sum += std::min(1.0, std::abs(part_between(range.low, range.high, a) - part_between(range.low, range.high, b)));
    ++pairs;
  };
  // Compare a value with the mean of its two neighbours, so that a steady change along a row or a column counts as smooth.
  const std::size_t rows = columns == 0 ? 0 : values.size() / columns;
  for (std::size_t j = 0; j < rows; ++j) {
    for (std::size_t i = 0; i < columns; ++i) {
      const std::size_t k = j * columns + i;
      if (i > 0 && i + 1 < columns) compare(values[k], std::midpoint(values[k - 1], values[k + 1]));
      if (j > 0 && j + 1 < rows) compare(values[k], std::midpoint(values[k - columns], values[k + columns]));
    }
  }
  return pairs > 0 && sum > smooth * static_cast<double>(pairs);
}

ColourRange colour_range(const std::vector<double>& values) {
  std::vector<double> known = finite(values);
  if (known.empty()) return {};
  std::sort(known.begin(), known.end());
  const std::size_t cut = known.size() / 50;
  const double all = known.back() - known.front(), inner = known[known.size() - 1 - cut] - known[cut];
  constexpr double stretched = 3;
  if (all > stretched * inner && inner > 0)
    return {known[cut], known[known.size() - 1 - cut], known[cut] > known.front(), known[known.size() - 1 - cut] < known.back()};
  if (all > 0) return {known.front(), known.back()};
  const double half = known.front() == 0 ? 1 : 0.05 * std::abs(known.front());
  return {within(known.front() - half), within(known.front() + half)};
}

std::string scale_colour(double part) {
  struct Colour {
    double red, green, blue;
  };
  constexpr std::array<Colour, 9> anchors{{{68, 1, 84},
                                           {71, 45, 123},
                                           {59, 82, 139},
                                           {44, 114, 142},
                                           {33, 145, 140},
                                           {40, 174, 128},
                                           {94, 201, 98},
                                           {173, 220, 48},
                                           {253, 231, 37}}};
  const double at = std::clamp(part, 0.0, 1.0) * (anchors.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(at), anchors.size() - 2);
  const double t = at - static_cast<double>(k);
  const auto mixed = [&](double a, double b) { return static_cast<int>(std::lround(std::lerp(a, b, t))); };
  return fmt::format("#{:02x}{:02x}{:02x}", mixed(anchors[k].red, anchors[k + 1].red),
                     mixed(anchors[k].green, anchors[k + 1].green), mixed(anchors[k].blue, anchors[k + 1].blue));
}

double heat_map_height(double width) { return 0.62 * width; }

std::string heat_map_elements(const HeatMap& map, double width) {
  const double height = heat_map_height(width);
  const Cells x(map.x, map_left, width - map_right), y(map.y, height - map_below, map_above);
  const ColourRange range = colour_range(map.values);
  const Prefix prefix = prefix_of(map.unit, std::max(std::abs(range.low), std::abs(range.high)));
  std::string patterns;
  for (std::size_t reason = 0; reason < map.reasons.size(); ++reason) patterns += mark_pattern(reason);
  return fmt::format("<defs>\n{}</defs>\n", patterns) + cells(map, x, y, range) + contours(map, x, y, range, prefix) +
         fmt::format("<g font-size=\"12.5\" fill=\"{}\">\n", ink) + frame(map, x, y, width, height) +
         legend(map, range, prefix, width, height) + "</g>\n";
}

}  // namespace softland::internal
