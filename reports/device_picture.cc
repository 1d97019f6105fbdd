#include "reports/device_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "document/axis.h"
#include "document/escape.h"
#include "document/quantity.h"
#include "reports/closing_prose.h"

namespace softland::internal {
namespace {

std::string spring(double left, double right, double y) {
  std::string path = fmt::format("M{:.1f} {:.1f}", left, y);
  constexpr int turns = 6;
  for (int i = 1; i < 2 * turns; ++i)
    path += fmt::format(" L{:.1f} {:.1f}", left + (right - left) * i / (2 * turns), y + (i % 2 == 0 ? -6 : 6));
  return fmt::format("<path d=\"{} L{:.1f} {:.1f}\" class=\"measure\"/>\n", path, right, y);
}

constexpr double width = 740;  // width of the drawing of a rigid plate, with the labels to its right [px]

/// Draws a dimension line between two heights, with its label to the right.
std::string height_measure(double x, double top, double bottom, const std::string& text) {
  return drawn_line(x, top, x, bottom, "measure") + drawn_line(x - 4, top, x + 4, top, "measure") +
         drawn_line(x - 4, bottom, x + 4, bottom, "measure") + drawn_words(x + 8, (top + bottom) / 2 + 4, "start", text);
}

// Searched parameters of a waveform, with the places on the time axis at which a drawing of the waveform names them.
struct Described {
  struct Place {
    std::string name;
    double from, to;  // begin and end of the time span that the parameter sets [s]
  };
  std::vector<Place> spans;
  // Names of the voltage levels, each with the time at which its label stands [s].
  std::vector<std::pair<std::string, double>> levels;
};

/// Returns the parameters to label in the waveform of an electrode or piezo, which is constant from the time `moves` [s] on.
/// Empty for a waveform family whose parameters have no place on the time axis, and for unknown times.
Described described_parameters(const ClosingRecord& result, const std::string& drive, double moves) {
  const auto parameter = [&](const std::string& name) {
    const auto found = result.search->parameters.find(drive + "." + name);
    return found == result.search->parameters.end() ? Metrics::unset : found->second;
  };
  const auto found = result.scene.waveforms.find(drive);
  const DrawnScene::Waveform scene = found == result.scene.waveforms.end() ? DrawnScene::Waveform{} : found->second;
  Described d;
  if (scene.family == "pulse" && scene.times.size() == 2 && std::isfinite(parameter("level_1_V"))) {
    const double first = scene.times[0], second = scene.times[1];
    d.spans = {{"edge", 0, scene.edge}, {"time_1", 0, first}, {"duration_2", first, second}};
    d.levels = {{"level_1", (scene.edge + first) / 2}, {"level_2", (first + scene.edge + second) / 2}};
  } else if (scene.family == "harmonic" && std::isfinite(parameter("start_s"))) {
    d.spans = {{"start", 0, scene.start}, {"duration", scene.start, scene.end}};
    d.levels = {{"amplitude, angular_frequency, phase", (scene.start + scene.end) / 2}};
  } else if (std::isfinite(parameter("rise_time_s"))) {
    d.spans = {{"rise_time", 0, moves}};
  }
  const bool known = std::all_of(d.spans.begin(), d.spans.end(),
                                 [](const Described::Place& one) { return std::isfinite(one.from) && std::isfinite(one.to); });
  return known ? d : Described{};
}

/// Draws the beam or plate, its supports, and its piezo layer.
std::string drawn_beam(const DrawnScene& scene, const SideView& view) {
  constexpr double left = SideView::left, thick = SideView::thick, layer = SideView::layer;
  const double top = view.top, right = view.right;
  std::string out = drawn_supports(view);
  out += drawn_rectangle(left, top, right - left, thick, "beam");
  out += drawn_words((left + right) / 2, top + 11, "middle", view.plate ? "plate" : "beam");
  if (!view.plate && scene.length > 0) {
    const double above = top - (scene.piezo ? 22 : 12);
    out += drawn_line(left, above, right, above, "measure") + drawn_line(left, above - 4, left, above + 4, "measure") +
           drawn_line(right, above - 4, right, above + 4, "measure") +
           drawn_words((left + right) / 2, above - 6, "middle", "length " + given_quantity(scene.length, "m"));
  }
  if (scene.piezo) {
    const auto [begin, end] = shares_of(scene.piezo->span, view.length);
    out += drawn_rectangle(view.x_at(begin), top - layer, view.x_at(end) - view.x_at(begin), layer, "piezo") +
           drawn_words(view.x_at(end) + 6, top - 2, "start", "piezo layer");
  }
  return out;
}

double plane_of(const SideView& view, const DrawnScene& scene, double gap) {
  return view.bottom + view.gap * std::min(1.0, gap / scene.electrode_gap);
}

/// Draws the contacts and their gaps. A contact with a name is drawn at its position, a contact on the side away from the
/// electrodes above the beam.
std::string drawn_contacts(const DrawnScene& scene, const SideView& view) {
  constexpr double wide = 12, foot = SideView::electrode;
  const double usual = view.plate || view.both_ends ? 0.5 : 1;
  std::string out;
  double below = view.floor + foot + 14, above = view.top - view.far - foot - 5;
  for (const DrawnScene::Contact& one : scene.contacts) {
    if (!(one.gap > 0)) continue;
    const double share = std::isfinite(one.at) ? std::clamp(one.at / view.length, 0.0, 1.0) : usual;
    const double x = std::min(view.x_at(share) - wide / 2, view.right - wide);
    const std::string text = one.name + ", gap " + given_quantity(one.gap, "m");
    if (one.far_side) {
      const double plane = view.top - std::min(0.75, one.gap / scene.electrode_gap) * view.gap;
      const double ceiling = view.top - view.far - foot;
      out += drawn_rectangle(x, ceiling, wide, plane - ceiling, "contact") + drawn_words(x + wide / 2, above, "middle", text);
      above -= 14;
    } else {
      const double plane = plane_of(view, scene, one.gap);
      out += drawn_rectangle(x, plane, wide, view.floor + foot - plane, "contact") +
             drawn_line(x + wide / 2, view.floor + foot, x + wide / 2, below + 4, "guide") +
             drawn_words(x + wide / 2, below + 16, "middle", text);
      below += 14;
    }
  }
  return out;
}

}  // namespace

std::string drawn_rectangle(double left, double top, double wide, double high, const char* what) {
  return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" class=\"{}\"/>\n", left, top, wide, high,
                     what);
}

std::string drawn_line(double x1, double y1, double x2, double y2, const char* what) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" class=\"{}\"/>\n", x1, y1, x2, y2, what);
}

std::string drawn_words(double x, double y, const char* anchor, const std::string& text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, escaped(text));
}

std::array<double, 2> shares_of(const DrawnScene::Span& span, double length) {
  if (!span) return {0, 1};
  const std::array<double, 2> share{(*span)[0] / length, (*span)[1] / length};
  return share[0] >= 0 && share[1] <= 1.000001 && share[0] < share[1] ? share : std::array<double, 2>{0, 1};
}

std::string drawn_supports(const SideView& view) {
  const double left = SideView::left, right = view.right, thick = SideView::thick, top = view.top;
  if (view.plate)
    return spring(left - 40, left, top + thick / 2) + spring(right, right + 40, top + thick / 2) +
           drawn_rectangle(left - 50, top - 14, 10, thick + 28, "anchor") +
           drawn_rectangle(right + 40, top - 14, 10, thick + 28, "anchor");
  std::string out = drawn_rectangle(left - 40, top - 8, 40, view.floor - top + 18, "anchor");
  if (view.both_ends) out += drawn_rectangle(right, top - 8, 40, view.floor - top + 18, "anchor");
  return out;
}

std::string drawn_electrodes(const DrawnScene& scene, const SideView& view) {
  constexpr double left = SideView::left, electrode = SideView::electrode;
  const double floor = view.floor;
  std::string out;
  for (const DrawnScene::Electrode& one : scene.electrodes) {
    const auto [begin, end] = shares_of(one.span, view.length);
    const double far = view.per_metre > 0 && one.gap > 0 ? one.gap * view.per_metre : view.far;
    const double y = one.far_side ? view.top - far - electrode : floor;
    out += drawn_rectangle(view.x_at(begin), y, view.x_at(end) - view.x_at(begin), electrode, "electrode");
    const std::string note = one.far_side && one.gap > 0 ? ", gap " + given_quantity(one.gap, "m") : "";
    out += drawn_words((view.x_at(begin) + view.x_at(end)) / 2, one.far_side ? y - 5 : floor + electrode + 14, "middle",
                       "electrode " + one.name + note);
  }
  if (scene.electrodes.empty()) {
    out += drawn_rectangle(left, floor, view.right - left, electrode, "electrode") +
           drawn_words((left + view.right) / 2, floor + electrode + 14, "middle", "ground");
  }
  return out;
}

std::string device_picture(const DrawnScene& scene) {
  const bool plate = scene.structure == SideOfStructure::on_springs;
  const bool both_ends = scene.structure == SideOfStructure::held_at_both_ends;
  if (scene.structure == SideOfStructure::unknown || !(scene.electrode_gap > 0) ||
      !(scene.contact_gap > 0 || !scene.contacts.empty()))
    return {};
  const double length = scene.length > 0 ? scene.length : 1;

  constexpr double electrode = SideView::electrode;
  const auto is_far = [](const auto& one) { return one.far_side; };
  const bool far_side = std::ranges::any_of(scene.electrodes, is_far) || std::ranges::any_of(scene.contacts, is_far);
  const SideView view{.plate = plate, .both_ends = both_ends, .length = length, .top = far_side ? 86.0 : 46.0};
  const double right = view.right, bottom = view.bottom, floor = view.floor;

  std::string out = drawn_beam(scene, view) + drawn_electrodes(scene, view) + drawn_contacts(scene, view);
  const double measure = both_ends || plate ? right + 64 : right + 16;
  if (scene.contacts.empty()) {
    // The contact is drawn at the centre of its pad at the tip; for a plate or a beam with two clamps, in the middle.
    const double pad = scene.pad_length;
    const double contact_at = plate || both_ends ? 0.5 : 1 - (pad > 0 ? std::min(1.0, pad / length) / 2 : 0);
    const double plane = plane_of(view, scene, scene.contact_gap);
    constexpr double contact_wide = 16;
    const double contact_left =
        std::min(view.x_at(contact_at) - contact_wide / 2, plate || both_ends ? right : right - contact_wide);
    out += drawn_rectangle(contact_left, plane, contact_wide, floor + electrode - plane, "contact");
    out += drawn_line(contact_left + contact_wide, plane, measure + 6, plane, "guide") +
           drawn_line(right, bottom, measure + 6, bottom, "guide");
    out += height_measure(measure, bottom, plane, "to the contact " + given_quantity(scene.contact_gap, "m"));
  }
  out += drawn_words(measure + 8, floor + electrode, "start", "to the electrode " + given_quantity(scene.electrode_gap, "m"));
  const auto near_contacts = std::ranges::count_if(scene.contacts, [](const auto& one) { return !one.far_side; });
  const double height = floor + electrode + 26 + 14 * static_cast<double>(near_contacts);
  return fmt::format(
      "<svg class=\"sketch\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"The switch from the side\">\n{}</svg>\n",
      width, height, out);
}

std::string parameter_drawing(const ClosingRecord& result, const std::string& drive) {
  const Points points = drawable(waveform(result.best, drive));
  double lowest = 0, highest = 0, moves = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto [time, level] = points[i];
    if (i > 0 && level != points[i - 1][1]) moves = std::max(moves, time);
    lowest = std::min(lowest, level);
    highest = std::max(highest, level);
  }
  if (points.size() < 2 || !(moves > 0) || !(highest > lowest)) return {};

  const auto [spans, levels] = described_parameters(result, drive, moves);
  if (spans.empty()) return {};

  constexpr double left = 40, right = 600, top = 34, bottom = 150, row = 22;
  const double end = 1.2 * moves;
  const auto x = [&](double time) { return left + std::clamp(time / end, 0.0, 1.0) * (right - left); };
  const auto y = [&](double level) { return bottom - (level - lowest) / (highest - lowest) * (bottom - top); };
  std::string path;
  for (const auto& [time, level] : points) path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : " L", x(time), y(level));
  std::string out = drawn_line(left, y(0), right, y(0), "guide") + drawn_words(left - 6, y(0) + 4, "end", "0");
  double below = bottom + row;
  for (const auto& [name, from, to] : spans) {
    for (const double time : {from, to}) out += drawn_line(x(time), top, x(time), below + 4, "guide");
    out += drawn_line(x(from), below, x(to), below, "measure") + drawn_line(x(from), below - 4, x(from), below + 4, "measure") +
           drawn_line(x(to), below - 4, x(to), below + 4, "measure") + drawn_words(x(to) + 8, below + 4, "start", name);
    below += row;
  }
  out += fmt::format("<path d=\"{}\" class=\"wave\"/>\n", path);
  for (const auto& [name, time] : levels) {
    double level = points.back()[1];
    for (std::size_t i = 1; i < points.size(); ++i) {
      if (points[i - 1][0] <= time && time <= points[i][0]) level = points[i - 1][1];
    }
    out += drawn_words(x(time), (levels.size() == 1 ? top : y(level)) - 7, "middle", name);
  }
  return fmt::format(
      "<svg class=\"sketch\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"What the parameters of {} "
      "are\">\n{}</svg>\n",
      width, below, escaped(drive), out);
}

}  // namespace softland::internal
