#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "document/axis.h"
#include "document/chart.h"
#include "document/escape.h"
#include "document/quantity.h"
#include "document/text.h"

namespace softland::internal {
namespace {

// The colours are the palette of Okabe and Ito, which colour-blind readers can tell apart; dashes make the same distinction
// without colour.
constexpr const char* grid = "#e4e7ea";

constexpr double left = 78;
constexpr double right = 18;
constexpr double above = 46;       // height of title and legend [px]
constexpr double below = 46;       // height of tick labels and axis label [px]
constexpr double title_line = 18;  // distance between lines of a title [px]

struct Stroke {
  const char* colour;
  double width;
  const char* dash;  // dash pattern of a curve's line; empty: solid
};

Stroke stroke(Role role) {
  switch (role) {
    case Role::best:
      return {"#0072b2", 2.2, ""};
    case Role::baseline:
      return {"#d55e00", 1.3, "7 2.5"};
    case Role::third:
      return {"#009e73", 1.8, "2.5 2.5"};
    case Role::fourth:
      return {"#cc79a7", 1.8, "10 3 2 3"};
    case Role::fifth:
      return {"#e69f00", 1.8, "5 2 1.5 2 1.5 2"};
    case Role::measured:
      return {ink, 5, ""};
    case Role::limit:
      return {muted, 1.3, "2 3"};
    case Role::device:
      return {"#a8cfe8", 0.4, ""};
    case Role::device_before:
      return {"#f0c4a5", 0.4, ""};
    case Role::evaluations:
      break;
  }
  return {"#8a949e", 3, ""};
}

bool is_one_of_many(Role role) { return role == Role::device || role == Role::device_before; }

/// Returns true if curves of this role are drawn as dots without a line.
bool dots(Role role) { return role == Role::evaluations || role == Role::measured; }

/// Returns the points of a curve to draw: those in the visible x range, and one on either side. Of all points in one column of
/// pixels, only the first, lowest, highest and last are kept.
std::vector<std::array<double, 2>> visible(const Axis& x, const Axis& y, const std::vector<double>& xs,
                                           const std::vector<double>& ys) {
  std::vector<std::array<double, 2>> out;
  std::size_t begin = static_cast<std::size_t>(std::lower_bound(xs.begin(), xs.end(), x.low) - xs.begin());
  std::size_t end = static_cast<std::size_t>(std::upper_bound(xs.begin(), xs.end(), x.high) - xs.begin());
  if (begin > 0) --begin;
  if (end < xs.size()) ++end;
  std::vector<std::array<double, 2>> column;
  const auto flush = [&] {
    if (column.empty()) return;
    const auto [low, high] =
        std::minmax_element(column.begin(), column.end(), [](const auto& a, const auto& b) { return a[1] < b[1]; });
    std::vector<std::size_t> kept{0, static_cast<std::size_t>(low - column.begin()),
                                  static_cast<std::size_t>(high - column.begin()), column.size() - 1};
    std::sort(kept.begin(), kept.end());
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    for (const std::size_t i : kept) out.push_back(column[i]);
    column.clear();
  };
  for (std::size_t row = begin; row < end; ++row) {
    if (!std::isfinite(ys[row]) || (y.scale == AxisScale::logarithmic && !(ys[row] > 0))) continue;
    const std::array<double, 2> point{x.pixel(xs[row]), y.pixel(ys[row])};
    if (!column.empty() && std::floor(point[0]) != std::floor(column.front()[0])) flush();
    column.push_back(point);
  }
  flush();
  return out;
}

std::array<double, 2> range_in_view(const CurveTables& tables, const Chart& chart) {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (const Series& one : chart.series) {
    const CurveTable& table = tables.at(one.table);
    const std::vector<double>& xs = table.at(chart.x_column);
    const std::vector<double>& ys = table.at(one.column);
    for (std::size_t row = 0; row < xs.size(); ++row) {
      if (!std::isfinite(ys[row]) || xs[row] < chart.x_home[0] || xs[row] > chart.x_home[1]) continue;
      if (chart.scale == AxisScale::logarithmic && !(ys[row] > 0)) continue;
      lowest = std::min(lowest, ys[row]);
      highest = std::max(highest, ys[row]);
    }
  }
  if (lowest > highest) return {chart.scale == AxisScale::logarithmic ? 0.1 : 0.0, 1.0};
  if (chart.scale == AxisScale::logarithmic) return {lowest / 1.5, highest * 1.5};
  lowest = std::min(lowest, 0.0);
  highest = std::max(highest, 0.0);
  const double margin = highest > lowest ? 0.06 * (highest - lowest) : 1.0;
  // Room below the zero line for its label, in units of the y axis.
  const double words = chart.zero_label.empty() ? 0 : 0.1 * (highest - lowest) * 240 / chart.height;
  return {lowest - (lowest < 0 || chart.zero_line ? std::max(margin, words) : 0), highest + margin};
}

std::string line(double x1, double y1, double x2, double y2, const char* colour, const char* extra = "") {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"{}/>\n", x1, y1, x2, y2, colour,
                     extra);
}

std::string label(double x, double y, const char* anchor, const char* colour, double size, std::string_view words,
                  const char* extra = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"{}\" font-size=\"{}\"{}>{}</text>\n", x, y,
                     anchor, colour, size, extra, escaped(words));
}

/// Returns the label of a tick: a number with a true minus sign and without negative zero. Powers of ten from 1e4 on, and up to
/// 1e-4, are written as 10⁵.
std::string tick_text(double value) {
  const double exponent = std::log10(std::abs(value));
  if (value > 0 && std::abs(exponent) > 3.5 && std::abs(exponent - std::round(exponent)) < 1e-9) {
    constexpr std::array digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string power = "10";
    for (const char c : fmt::format("{:.0f}", exponent)) power += c == '-' ? "⁻" : digits[static_cast<std::size_t>(c - '0')];
    return power;
  }
  const std::string size = fmt::format("{:.6g}", std::abs(value));
  return size == "0" ? size : with_true_minus((value < 0 ? "-" : "") + size);
}

/// A halo in the colour of the paper keeps curves from running through labels.
constexpr const char* halo = " paint-order=\"stroke\" stroke=\"#fff\" stroke-width=\"4\" stroke-linejoin=\"round\"";

/// Returns the title of an axis with its unit: "Time (µs)", "Gap (nm)" or "cost".
std::string axis_title(const std::string& name, const std::string& unit, const Prefix& prefix) {
  return unit.empty() ? name : fmt::format("{} ({}{})", name, prefix.symbol, unit);
}

/// Breaks the title of a chart into lines that fit on a canvas `width` wide [px].
std::vector<std::string> title_lines(const Chart& chart, double width) {
  constexpr double letter = 9;  // mean width of a letter of a title, in the widest of the usual fonts [px]
  std::istringstream words(wrapped(chart.title, static_cast<std::size_t>(width / letter)));
  std::vector<std::string> lines;
  for (std::string one; std::getline(words, one);) lines.push_back(one);
  return lines;
}

/// Both axes of a chart, in pixels.
struct Axes {
  Axis x, y;
};

Axes axes_of(const CurveTables& tables, const Chart& chart, double width, double top) {
  Axis x;
  x.scale = chart.x_scale;
  x.low = chart.x_home[0];
  x.high = chart.x_home[1];
  x.pixel_low = left;
  x.pixel_high = width - right;
  Axis y;
  y.scale = chart.scale;
  const std::array<double, 2> range =
      chart.is_of_bars ? std::array{0.0, 1.0} : chart.y_home.value_or(range_in_view(tables, chart));
  y.low = range[0];
  y.high = range[1];
  y.pixel_low = top + above + chart.height;
  y.pixel_high = top + above;
  return {x, y};
}

std::string chart_legend(const Chart& chart, double top) {
  std::string out;
  if (chart.is_of_bars) return out;  // a chart of bars has no legend: each bar has its name at its end
  double legend_x = left;
  for (const Series& one : chart.series) {
    if (one.label.empty()) continue;
    const Stroke pen = stroke(one.role);
    if (dots(one.role)) {
      out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.2\" fill=\"{}\"/>\n", legend_x + 13, top + 31, pen.colour);
    } else {
      out += line(legend_x, top + 31, legend_x + 26, top + 31, pen.colour,
                  fmt::format(" stroke-width=\"{}\" stroke-dasharray=\"{}\"", pen.width, *pen.dash ? pen.dash : "none").c_str());
    }
    out += label(legend_x + 33, top + 35, "start", ink, 12.5, one.label);
    legend_x += 33 + 7.2 * static_cast<double>(one.label.size()) + 26;
  }
  return out;
}

/// Draws the grid, the tick labels and the names of the axes of a chart.
std::string chart_scales(const Chart& chart, const Axes& axes) {
  const auto& [x, y] = axes;
  std::string out;
  const Prefix x_prefix = chart.x_unit.empty() ? Prefix{} : prefix_for(std::max(std::abs(x.low), std::abs(x.high)));
  for (const double tick : ticks(x, 8)) {
    const double at_pixel = x.pixel(tick);
    out += line(at_pixel, y.pixel_low, at_pixel, y.pixel_high, grid);
    out += label(at_pixel, y.pixel_low + 17, "middle", muted, 12, tick_text(tick / x_prefix.factor));
  }
  const Prefix y_prefix = chart.y_unit.empty() ? Prefix{} : prefix_for(std::max(std::abs(y.low), std::abs(y.high)) / 1.1);
  for (const double tick : chart.is_of_bars ? std::vector<double>() : ticks(y, std::max(3, chart.height / 45))) {
    const double at_pixel = y.pixel(tick);
    out += line(left, at_pixel, x.pixel_high, at_pixel, grid);
    out += label(left - 8, at_pixel + 4, "end", muted, 12, tick_text(tick / y_prefix.factor));
  }
  out += label((left + x.pixel_high) / 2, y.pixel_low + 36, "middle", muted, 12.5,
               axis_title(chart.x_label, chart.x_unit, x_prefix));
  const double middle = (y.pixel_low + y.pixel_high) / 2;
  out += label(16, middle, "middle", muted, 12.5, axis_title(chart.y_label, chart.y_unit, y_prefix),
               fmt::format(" transform=\"rotate(-90 16 {:.1f})\"", middle).c_str());
  return out;
}

std::string zero_line(const Chart& chart, const Axes& axes) {
  const auto& [x, y] = axes;
  if (!(chart.zero_line && y.low <= 0 && y.high >= 0)) return {};
  std::string out = line(left, y.pixel(0), x.pixel_high, y.pixel(0), ink, " stroke-width=\"1\"");
  const bool at_left = chart.zero_label_left;
  if (!chart.zero_label.empty())
    out += label(at_left ? left + 4 : x.pixel_high - 4, y.pixel(0) + 13, at_left ? "start" : "end", muted, 11.5, chart.zero_label,
                 halo);
  return out;
}

// Writes a curve as an SVG path in few bytes: steps between points in whole tenths of a pixel.
std::string thin_curve(const std::vector<std::array<double, 2>>& points, const Stroke& pen) {
  std::string path;
  std::array<long, 2> last{};
  for (const auto& [px, py] : points) {
    const std::array<long, 2> now{std::lround(10 * px), std::lround(10 * py)};
    const long dx = now[0] - last[0], dy = now[1] - last[1];
    path += fmt::format("{}{}{}{}", path.empty() ? "M" : "l", dx, dy < 0 ? "" : " ", dy);
    last = now;
  }
  return fmt::format("<path transform=\"scale(.1)\" d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{:g}\"/>\n", path,
                     pen.colour, 10 * pen.width);
}

std::string chart_curve(const CurveTable& table, const Chart& chart, const Series& one, const Axes& axes) {
  const Stroke pen = stroke(one.role);
  const auto points = visible(axes.x, axes.y, table.at(chart.x_column), table.at(one.column));
  if (points.empty()) return {};
  std::string path;
  if (dots(one.role)) {
    for (const auto& [px, py] : points) path += fmt::format("M{:.1f} {:.1f}h0", px, py);
    return fmt::format(
        "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"round\" stroke-opacity=\"{}\"/>\n", path,
        pen.colour, pen.width, one.role == Role::measured ? 1 : 0.55);
  }
  if (is_one_of_many(one.role)) return thin_curve(points, pen);
  for (const auto& [px, py] : points)
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : path.size() < 14 ? "L" : " ", px, py);
  return fmt::format(
      "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\" stroke-dasharray=\"{}\"/>\n",
      path, pen.colour, pen.width, *pen.dash ? pen.dash : "none");
}

// Draws a horizontal bar of a chart. A stretch shorter than a pixel is drawn one pixel long; stretches less than a pixel apart
// are drawn as one.
std::string chart_bar(const CurveTable& table, const Chart& chart, std::size_t number, const Axes& axes) {
  const Series& one = chart.series[number];
  const std::vector<double>&xs = table.at(chart.x_column), &ys = table.at(one.column);
  constexpr double pixel = 1;
  std::array<std::string, 2> paths;  // SVG paths of the pale and of the solid stretches of the bar
  std::array<double, 2> ends{-1, -1};
  const double middle = axes.y.pixel_high + bar_height * (static_cast<double>(number) + 0.5);
  for (std::size_t row = 1; row < xs.size(); ++row) {
    if (!(ys[row] > 0 && ys[row] == ys[row - 1]) || xs[row] < axes.x.low || xs[row - 1] > axes.x.high) continue;
    const std::size_t kind = ys[row] < 1 ? 0 : 1;
    const double begin = std::max(axes.x.pixel(xs[row - 1]), ends[kind]), end = axes.x.pixel(xs[row]);
    if (end <= ends[kind]) continue;
    const double until = std::max(end, begin + pixel);
    paths[kind] += fmt::format("M{:.1f} {:.1f}H{:.1f}", begin, middle, until);
    ends[kind] = until;
  }
  std::string out;
  for (const std::size_t kind : {0U, 1U}) {
    if (!paths[kind].empty())
      out += fmt::format("<path d=\"{}\" stroke=\"{}\" stroke-width=\"{}\" stroke-opacity=\"{}\"/>\n", paths[kind],
                         stroke(one.role).colour, bar_height - 8, kind == 0 ? 0.45 : 1);
  }
  return chart.series.size() == 1 ? out : out + label(axes.x.pixel_high - 6, middle + 4, "end", ink, 12, one.label, halo);
}

std::string chart_band(const CurveTables& tables, const Chart& chart, const Band& band, const Axes& axes) {
  const CurveTable& table = tables.at(band.table);
  const std::vector<double>& xs = table.at(chart.x_column);
  auto edge = visible(axes.x, axes.y, xs, table.at(band.high));
  auto back = visible(axes.x, axes.y, xs, table.at(band.low));
  edge.insert(edge.end(), back.rbegin(), back.rend());
  std::string path;
  for (const auto& [px, py] : edge) path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : " ", px, py);
  return fmt::format("<path d=\"{}Z\" fill=\"{}\" fill-opacity=\"0.25\"/>\n", path, stroke(band.role).colour);
}

std::string chart_mark(const Mark& mark, const Axes& axes) {
  const auto& [x, y] = axes;
  if (mark.x < x.low || mark.x > x.high || mark.y < y.low || mark.y > y.high) return {};
  const Stroke pen = stroke(mark.role);
  std::string out =
      fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.4\" fill=\"{}\"/>\n", x.pixel(mark.x), y.pixel(mark.y), pen.colour);
  if (mark.text.empty()) return out;
  out += label(std::clamp(x.pixel(mark.x), left + 26, x.pixel_high - 26), std::max(y.pixel(mark.y) - 6, y.pixel_high + 13),
               "middle", pen.colour, 12.5, mark.text, (std::string(" font-weight=\"600\"") + halo).c_str());
  return out;
}

}  // namespace

double chart_svg_height(const Chart& chart, double width) {
  const std::size_t lines = std::max<std::size_t>(1, title_lines(chart, width).size());
  return above + chart.height + below + title_line * static_cast<double>(lines - 1);
}

std::string chart_svg(const CurveTables& tables, const Chart& chart, double width, double top) {
  std::string out;
  const std::vector<std::string> title = title_lines(chart, width);
  for (std::size_t i = 0; i < title.size(); ++i) {
    if (i > 0) top += title_line;
    out += label(0, top + 15, "start", ink, 15, title[i], " font-weight=\"600\"");
  }
  const Axes axes = axes_of(tables, chart, width, top);
  out += chart_legend(chart, top) + chart_scales(chart, axes) + zero_line(chart, axes);
  out += fmt::format("<clipPath id=\"clip-{}\"><rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{}\"/></clipPath>\n",
                     chart.id, left, axes.y.pixel_high, axes.x.pixel_high - axes.x.pixel_low, chart.height);
  out += fmt::format("<g clip-path=\"url(#clip-{})\">\n", chart.id);
  for (const Band& band : chart.bands) out += chart_band(tables, chart, band, axes);
  for (std::size_t k = 0; k < chart.series.size(); ++k) {
    const Series& one = chart.series[k];
    out +=
        chart.is_of_bars ? chart_bar(tables.at(one.table), chart, k, axes) : chart_curve(tables.at(one.table), chart, one, axes);
  }
  for (const Mark& mark : chart.marks) out += chart_mark(mark, axes);
  return out + "</g>\n";
}

}  // namespace softland::internal
