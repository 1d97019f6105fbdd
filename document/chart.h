// Description of a chart, from which two drawings are made: static SVG for print and files, and an interactive chart in a web
// page by the JavaScript library uPlot.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace softland {

/// Points [x, y] of a curve, in order.
using Points = std::vector<std::array<double, 2>>;

}  // namespace softland

namespace softland::internal {

/// Columns of a table of curves by name, all of equal length; Chart::x_column and Series::column name them.
using CurveTable = std::map<std::string, std::vector<double>>;
using CurveTables = std::map<std::string, CurveTable>;

/// The role of a curve determines its colour and line style. In reports on a search for a waveform, `best` is a curve of the
/// found waveform, and `baseline` a curve of the plain voltage step. The role `evaluations` has a dot for each waveform that
/// the search tried, the role `measured` a dot for each measured value. The role `limit` is for a bound, such as a voltage
/// limit. Curves of the roles `device` and `device_before` are thin lines, one for each device of a sample, under the found
/// waveform and under the plain voltage step. The roles `third`, `fourth` and `fifth` are for further curves.
enum class Role { best, baseline, evaluations, third, fourth, fifth, measured, limit, device, device_before };
enum class AxisScale { linear, logarithmic };

struct Series {
  std::string table;
  std::string column;
  std::string label;  ///< name of the curve in the legend; empty: not in the legend
  Role role = Role::best;
};

/// A filled area between two curves, the columns `low` and `high` of a table.
struct Band {
  std::string table, low, high;
  Role role = Role::best;
};

/// A dot at a point of the chart, with `text` beside it; `text` may be empty.
struct Mark {
  double x = 0;
  double y = 0;
  Role role = Role::best;
  std::string text;
};

struct Chart {
  std::string id;  ///< identifier of the chart in a page: letters, digits and dashes only
  std::string title;
  std::string caption;
  std::string x_column;
  std::string x_label;
  std::string x_unit;  ///< unit of the values on the x axis; empty: a number without unit
  std::string y_label;
  std::string y_unit;
  AxisScale scale = AxisScale::linear;    ///< scale of the y axis: linear or logarithmic
  AxisScale x_scale = AxisScale::linear;  ///< scale of the x axis; where it is logarithmic, a curve has a dot at every point
  std::array<double, 2> x_home{0, 1};     ///< range of the x axis that is shown before any zoom
  std::array<double, 2> x_whole{0, 1};    ///< range of the x axis that contains all data
  std::optional<std::array<double, 2>> y_home;  ///< range of the y axis before any zoom; not set: the range of the data in view
  bool zero_line = false;
  std::string zero_label;
  bool zero_label_left = false;  ///< true: zero_label, the label of the line y = 0, is at the left end of the line
  std::string group;             ///< charts of one group share cursor and zoom; empty: alone
  int height = 300;              ///< height of the chart [px]
  std::vector<Series> series;
  std::vector<Mark> marks;
  std::vector<Band> bands = {};  ///< filled areas between two columns, drawn below the curves, and in static pictures only
  /// true: each element of `series` is drawn as a horizontal bar along x, solid where the value is 1, pale where it is between
  /// 0 and 1, and empty where it is 0. The bars are below each other.
  bool is_of_bars = false;
  bool is_of_steps = false;  ///< true: the curves have no dots on a logarithmic x axis; their points are corners of steps
};
inline constexpr int bar_height = 24;  ///< height of one bar [px]

struct Picture {
  CurveTables tables;
  std::vector<Chart> charts;
};

/// Returns a chart whose x axis is the time from 0 to `until` [s]; the caller adds the curves to Chart::series.
[[nodiscard]] Chart chart_over_time(const std::string& id, const std::string& title, const std::string& y_label,
                                    const std::string& y_unit, double until, int height);

/// Draws the chart as SVG elements on a canvas `width` wide, its top left corner at (0, `top`); text and lines carry their own
/// colours. A title that is longer than the canvas is wide has several lines.
[[nodiscard]] std::string chart_svg(const CurveTables& tables, const Chart& chart, double width, double top);
/// Returns the height of the elements of chart_svg() on a canvas `width` wide [px], title and axes included.
[[nodiscard]] double chart_svg_height(const Chart& chart, double width);

}  // namespace softland::internal
