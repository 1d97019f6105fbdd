#include "reports/check_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/printable.h"
#include "base/shortened.h"
#include "document/escape.h"
#include "document/quantity.h"
#include "document/svg.h"
#include "document/text.h"
#include "model/beam.h"
#include "model/built_beam.h"
#include "reports/pull_in_report.h"
#include "reports/study_members.h"
#include "studies/closing/summits_at_hold.h"

namespace softland {

using nlohmann::json;

namespace {

// Returns pull-in voltages as JSON. A single electrode has no name in JSON; several electrodes are distinguished by name.
json by_electrode(const std::map<std::string, PullInRecord>& all) {
  json of = json::object();
  for (const auto& [name, one] : all) of[name] = internal::record_json(one);
  return all.empty() ? json() : all.size() == 1 ? of.front() : of;
}

std::map<std::string, PullInRecord> read_by_electrode(const json& from) {
  if (!from.is_object()) return {};
  if (from.contains("static_V")) return {{"", internal::read_json<PullInRecord>(from)}};
  return internal::read_json<std::map<std::string, PullInRecord>>(from);
}

using internal::escaped;
using internal::given_quantity;
using Corners = std::vector<std::pair<double, double>>;

constexpr const char *of_beam = "#c9a227", *of_layer = "#7a5cc4", *of_electrode = "#2b6cb0", *of_contact = "#b83232",
                     *of_stop = "#8a8f96", *of_dielectric = "#4fa39a", *ink = "#1b1f24", *pale = "#5f6b76";

std::string polygon(const Corners& corners, const std::string& paint) {
  std::string points;
  for (const auto& [x, y] : corners) points += fmt::format("{:.2f},{:.2f} ", x, y);
  return fmt::format("<polygon points=\"{}\" {}/>\n", points, paint);
}
std::string rectangle(double left, double top, double right, double bottom, const std::string& paint) {
  return polygon({{left, top}, {right, top}, {right, bottom}, {left, bottom}}, paint);
}
std::string filled(const char* colour, double opacity = 1) {
  return fmt::format("fill=\"{}\" fill-opacity=\"{}\" stroke=\"{}\" stroke-width=\"0.6\"", colour, opacity, ink);
}
std::string outlined(const char* colour) { return fmt::format("fill=\"none\" stroke=\"{}\" stroke-dasharray=\"5 3\"", colour); }
std::string label(double x, double y, const std::string& text, const char* colour = pale, const char* anchor = "start") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"12\" fill=\"{}\" text-anchor=\"{}\">{}</text>\n", x, y, colour,
                     anchor, escaped(text));
}

constexpr double most_holes = 4000;  // largest number of holes of the beam that are drawn

class BeamSketch {
 public:
  BeamSketch(const Device& device, double width)
      : d_(device), s_(device.structure), sections_(local_sections(s_)), scale_(width / s_.length) {}

  // Returns the SVG elements of the beam seen from above, beginning at the height `top`, and the lower end of these elements
  // [px].
  std::pair<std::string, double> from_above(double top) const {
    double widest = 0;
    for (const LocalSection& one : sections_) widest = std::max({widest, one.width, one.end_width});
    constexpr double most_height = 260;
    const double across = std::min(scale_, most_height / widest), middle = top + 34 + widest * across / 2;
    std::string out =
        label(0, top,
              fmt::format("from above{}: {} long, up to {} wide",
                          across < scale_ ? fmt::format(", across the beam at {:.2g} of the scale", across / scale_) : "",
                          given_quantity(s_.length, "m", 4), given_quantity(widest, "m", 4)));
    for (const LocalSection& one : sections_) {
      const double a = one.width * across / 2, b = one.end_width * across / 2, from = x(one.begin), to = x(one.end);
      out += polygon({{from, middle - a}, {to, middle - b}, {to, middle + b}, {from, middle + a}}, filled(of_beam, 0.55));
      out += holes(one, across, middle);
    }
    for (const LayerPart& layer : part_of<Beam>(s_).layers) {
      const double half = width_at(s_, layer.begin.on(s_.length)) * across / 2;
      out +=
          rectangle(x(layer.begin.on(s_.length)), middle - half, x(layer.end.on(s_.length)), middle + half, outlined(of_layer));
    }
    if (d_.piezo) {
      const double begin = d_.piezo->begin.on(s_.length), half = width_at(s_, begin) * across / 2;
      out += rectangle(x(begin), middle - half, x(d_.piezo->end.on(s_.length)), middle + half, outlined(of_layer));
      out += label(x(begin) + 4, middle + 4, "piezo", of_layer);
    }
    const double edge = widest * across / 2 + 6;
    out += anchors(middle - edge, middle + edge, middle + edge + 14);
    for (const Electrode& e : d_.electrodes) {
      for (const Stretch& pad : e.pads(s_.length)) {
        out += rectangle(x(pad.begin), middle - edge, x(pad.end), middle + edge, outlined(of_electrode));
        out += label(x(pad.begin) + 4, middle - edge - 3, e.name, of_electrode);
      }
    }
    for (std::size_t c = 0; c < d_.contacts.size(); ++c) out += dots(c, across, middle) + name_of_contact(c, middle + edge + 14);
    return {out, middle + edge + 24};
  }

  std::pair<std::string, double> from_the_side(double top) const {
    double highest = 0;
    for (int k = 0; k <= places; ++k)
      highest = std::max(highest, height(s_.length * k / places, true) + (d_.piezo ? d_.piezo->thickness : 0));
    for (std::size_t c = 0; c < d_.contacts.size(); ++c) {
      if (d_.contacts[c].side == Side::far) highest = std::max(highest, stop_plane(c));
    }
    constexpr double most_height = 220;
    // Scale of heights in the view from the side [px/m]; y coordinate of the plane of the electrode [px].
    const double up = most_height / (highest + d_.gap.electrode), ground = top + 20 + most_height;
    const auto y = [&](double above_electrode) { return ground - above_electrode * up; };
    constexpr double least = 2;  // least drawn thickness of a layer [px]
    double deepest = 0;
    std::string out = label(0, top,
                            fmt::format("from the side, heights enlarged {:.3g} times: {} above the electrode", up / scale_,
                                        given_quantity(d_.gap.electrode, "m", 4)));
    for (const LocalSection& one : sections_) {
      Corners corners;
      band(one.begin, one.end, corners, y, [&](double) { return std::pair{0.0, one.thickness}; });
      out += polygon(corners, filled(of_beam, 0.8));
    }
    // Layers are stacked outwards from the face of the beam: height of the layers drawn so far [px].
    double lifted = 0;
    for (const LayerPart& layer : part_of<Beam>(s_).layers) {
      const double begin = layer.begin.on(s_.length), end = layer.end.on(s_.length);
      if (layer.face == Side::near) continue;
      Corners corners;
      band(begin, end, corners, y, [&](double at) {
        const double on = section_at(s_, at).thickness + lifted;
        return std::pair{on, on + layer.thickness};
      });
      out += polygon(corners, filled(of_layer, 0.8));
      lifted += layer.thickness;
    }
    if (d_.piezo) {
      Corners corners;
      band(d_.piezo->begin.on(s_.length), d_.piezo->end.on(s_.length), corners, y, [&](double at) {
        const double on = section_at(s_, at).thickness + lifted;
        return std::pair{on, on + d_.piezo->thickness};
      });
      out += polygon(corners, filled(of_layer, 0.8));
      const auto [left, upper] = *std::ranges::min_element(corners);
      out += label(left + 4, upper - 4, "piezo", of_layer);
    }
    for (const LayerPart& layer : part_of<Beam>(s_).layers) {
      if (layer.face != Side::near) continue;
      Corners corners;
      band(layer.begin.on(s_.length), layer.end.on(s_.length), corners, y, [&](double) {
        return std::pair{0.0, layer.thickness};
      });
      out += polygon(corners, filled(of_layer, 0.8));
    }
    for (const Electrode& e : d_.electrodes) {
      for (const Stretch& pad : e.pads(s_.length)) {
        if (e.side == Side::far) continue;
        // Drawn thickness of the dielectric on the electrode [px].
        const double metal = e.dielectric ? std::max(least, e.dielectric->thickness * up) : 0;
        out += rectangle(x(pad.begin), ground + metal, x(pad.end), ground + metal + 8, filled(of_electrode));
        if (e.dielectric) out += rectangle(x(pad.begin), ground, x(pad.end), ground + metal, filled(of_dielectric));
        deepest = std::max(deepest, metal);
      }
    }
    out += anchors(y(height(0, true)), ground + 8, ground - 4);
    for (std::size_t c = 0; c < d_.contacts.size(); ++c) {
      if (d_.contacts[c].along_face) continue;  // the face of the dielectric is the contact, so no separate contact is drawn
      const double at = x(d_.contact_position(c)), half = 3;
      if (d_.contacts[c].side == Side::far)
        out += rectangle(at - half, y(stop_plane(c)) - 8, at + half, y(stop_plane(c)), filled(of_stop));
      else
        out += rectangle(at - half, y(height(d_.contact_position(c), false) - d_.contact_gap(c)), at + half, ground,
                         filled(of_contact));
      out += name_of_contact(c, d_.contacts[c].side == Side::far ? y(stop_plane(c)) - 12 : ground + 20);
    }
    return {out, ground + deepest + 24};
  }

 private:
  static constexpr int places = 100;

  [[nodiscard]] double x(double place) const { return place * scale_; }
  /// Draws the anchors at the clamped ends of the beam between the heights `top` and `bottom`, with their name at the height
  /// `words` [px].
  [[nodiscard]] std::string anchors(double top, double bottom, double words) const {
    constexpr double wide = 14;
    std::string out = rectangle(-wide, top, 0, bottom, filled(of_stop)) + label(2, words, "anchor");
    if (s_.has_far_clamp())
      out += rectangle(x(s_.length), top, x(s_.length) + wide, bottom, filled(of_stop)) +
             label(x(s_.length) - 2, words, "anchor", pale, "end");
    return out;
  }
  [[nodiscard]] std::string name_of_contact(std::size_t c, double words) const {
    const Contact& contact = d_.contacts[c];
    if (contact.along_face) return {};
    const double at = x(d_.contact_position(c));
    const bool is_far = contact.side == Side::far;
    return label(at, words, contact.name.empty() ? "contact" : contact.name, is_far ? pale : of_contact,
                 at > x(s_.length) / 2 ? "end" : "start");
  }
  /// Returns the height above the electrode of the plane of contact c, a stop on the far side (above the beam) [m].
  [[nodiscard]] double stop_plane(std::size_t c) const { return height(d_.contact_position(c), true) + d_.contact_gap(c); }
  /// Draws contacts as dots; equal contacts stand side by side across the beam. A contact along a face has no dots.
  [[nodiscard]] std::string dots(std::size_t c, double across, double middle) const {
    const Contact& contact = d_.contacts[c];
    if (contact.along_face) return {};
    constexpr double most = 12;  // largest number of dots drawn for one contact
    const int count = static_cast<int>(std::min(most, contact.count));
    const double at = d_.contact_position(c), apart = width_at(s_, at) * across / count;
    std::string out;
    for (int k = 0; k < count; ++k)
      out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" {}/>\n", x(at), middle + (k - (count - 1) / 2.0) * apart,
                         filled(contact.side == Side::far ? of_stop : of_contact));
    return out;
  }
  // Returns the height of the upper or lower face of the beam above the electrode, without layers [m].
  [[nodiscard]] double height(double at, bool upper) const {
    return d_.gap.electrode + d_.rest_offset(at) + (upper ? section_at(s_, at).thickness : 0);
  }
  // Appends to `corners` the outline [px] of a part of the beam in the view from the side. The part extends from position
  // `begin` to `end` [m]. heights(position) returns its lower and upper end above the lower face of the beam [m].
  template <class ToPixel, class Heights>
  void band(double begin, double end, Corners& corners, ToPixel&& y, Heights&& heights) const {
    const double inside = 1e-9 * s_.length;
    for (int k = 0; k <= 2 * places + 1; ++k) {
      const double share = static_cast<double>(k <= places ? k : 2 * places + 1 - k) / places;
      const double at = begin + (end - begin) * share, look = std::clamp(at, begin + inside, end - inside);
      const auto [low, high] = heights(look);
      corners.emplace_back(x(at), y(d_.gap.electrode + d_.rest_offset(at) + (k <= places ? low : high)));
    }
  }
  [[nodiscard]] std::string holes(const LocalSection& one, double across, double middle) const {
    std::string out;
    if (!one.holes.exist()) return out;
    const double pitch = one.holes.pitch, half = one.holes.size / 2;
    const int along = static_cast<int>((one.end - one.begin) / pitch + 1e-9);
    const double first = one.begin + (one.end - one.begin - (along - 1) * pitch) / 2;
    double drawn = 0;
    for (int i = 0; i < along; ++i) {
      const double at = first + i * pitch;
      const int rows = static_cast<int>(one.width_at(at) / pitch + 1e-9);
      for (int j = 0; j < rows && drawn < most_holes; ++j, ++drawn) {
        const double side = (j - (rows - 1) / 2.0) * pitch;
        out += rectangle(x(at - half), middle + (side - half) * across, x(at + half), middle + (side + half) * across,
                         "fill=\"#fff\"");
      }
    }
    return out;
  }

  const Device& d_;
  const Structure& s_;
  std::vector<LocalSection> sections_;
  double scale_;  // scale along the beam [px/m]
};

}  // namespace

void members(internal::Archive& a, CheckRecord::Line& line) {
  a("name", line.name, "name of the number");
  a("value", line.value, "its value as text");
}

void members(internal::Archive& a, CheckRecord::Rest& rest) {
  a("far_end_rise_m", rest.far_end_rise, "rise of the far end above the straight shape");
  a("far_end_gap_m", rest.far_end_gap, "distance of the far end to the electrode");
  a("contact_rise_m", rest.contact_rise, "rise at the first contact above the straight shape");
  a("contact_gap_m", rest.contact_gap, "distance at the first contact to the contact plane");
  a("least_electrode_gap_m", rest.least_gap, "smallest gap to the electrodes");
}

void members(internal::Archive& a, CheckRecord& record) {
  members(a, record.origin);
  a.derived("status", std::string(to_string(Status::done)), "`done`");
  a("file", record.file, "scene file, as it was given");
  a("title", record.title, "title of the scene");
  a("natural_frequencies_rad_s", record.frequencies, "natural angular frequencies");
  a("rest_shape", record.rest_shape, "shape at rest, if it is not straight");
  a.custom("pull_in", record.pull_in, by_electrode, read_by_electrode,
           internal::OneOrMore<PullInRecord>{"pull-in voltages of the electrode"});
  a("hold_window_V", record.hold_windows, "by electrode, release voltage and voltage of the collapse onto it");
  a("dynamic_precision", record.dynamic_precision, "relative precision of the dynamic voltages");
  a("closed_state", internal::OrNull{record.closed_state}, "closed equilibrium under the hold levels");
  a("stable_path", internal::OrNull{record.stable_path}, "path of stable equilibria to the contact");
  a("duration_s", record.duration, "simulated time");
  a("tolerance", record.tolerance, "relative tolerance of the integrator");
  a("warnings", record.warnings, "warnings");
  a("lines", record.lines, "derived numbers, as `check` prints them");
}

json json_of(const CheckRecord& record) { return internal::record_json(record); }

CheckRecord read_check(const json& from) { return internal::whole_record<CheckRecord>(from); }

std::string text_of(const CheckRecord& record) {
  const std::string title = shortened(printable_line(record.title));
  std::string text = fmt::format("{}: valid{}\n\n", printable_line(record.file), title.empty() ? "" : " (" + title + ")");
  for (const CheckRecord::Line& line : record.lines) text += fmt::format("{:<20} {}\n", line.name, line.value);
  for (const std::string& warning : record.warnings) {
    if (is_few_summits_warning(warning)) continue;  // the line about the contact states this already
    text += "\n" + wrapped("warning: " + warning) + "\n";
  }
  return text;
}

std::string beam_drawing(const std::string& title, const Device& device) {
  return svg_frame(title.empty() ? "The beam as it is built" : title, "The beam at rest, from above and from the side.",
                   [&](double width, double top) {
                     const BeamSketch drawing(device, width);
                     auto [above, middle] = drawing.from_above(top + 12);
                     auto [side, bottom] = drawing.from_the_side(middle + 12);
                     return std::pair{above + side, bottom};
                   });
}

}  // namespace softland
