#include "reports/motion_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "document/axis.h"
#include "document/chart.h"
#include "document/chart_json.h"
#include "document/escape.h"
#include "document/quantity.h"
#include "reports/closing_captions.h"
#include "reports/device_picture.h"

namespace softland::internal {
namespace {

using nlohmann::json;

constexpr double travel = 130;  // distance from the electrode to the highest position of the beam [px]
// Right end of the moving part; left end and width of the enlarged picture of the contact beside it [px].
constexpr double right_end = 520, detail_left = 650, detail_wide = 150;
constexpr double figure_width = 820;
constexpr double detail_top = 6, contact_wide = 12;

// A run with a recorded motion, and the role that sets the style of its lines.
struct ShownRun {
  const char* role;
  std::string label;
  const CurveRecord& curve;
  [[nodiscard]] const ShownMotion& motion() const { return *curve.motion; }
};

bool are_numbers(const std::vector<double>& all, std::size_t count) {
  constexpr double most = 1e3;
  return all.size() == count && std::ranges::all_of(all, [](double one) { return std::abs(one) < most; });
}

bool rises(const std::vector<double>& all) { return std::ranges::is_sorted(all) && all.back() > all.front(); }

// Returns true if all columns of a motion have the right length; a damaged file may have shorter columns.
bool is_sound(const ShownMotion& m) {
  const auto all = [](const std::vector<std::vector<double>>& columns, std::size_t rows) {
    return std::ranges::all_of(columns, [&](const auto& column) { return are_numbers(column, rows); });
  };
  return m.time.size() >= 2 && m.places.size() >= 2 && are_numbers(m.time, m.time.size()) && rises(m.time) &&
         are_numbers(m.places, m.places.size()) && rises(m.places) && m.places.front() == 0 &&
         are_numbers(m.rest, m.places.size()) && !m.shapes.empty() && m.amplitudes.size() == m.shapes.size() &&
         all(m.amplitudes, m.time.size()) && all(m.shapes, m.places.size()) &&
         std::ranges::all_of(
             m.contacts, [&](const auto& c) { return c.at >= 0 && c.at <= 1.001 * m.places.back() && c.gap > 0 && c.gap < 1; }) &&
         std::ranges::all_of(m.electrodes, [](const auto& pad) { return std::abs(pad.gap) < 1; });
}

std::vector<ShownRun> shown_runs(const ClosingRecord& result) {
  std::vector<ShownRun> runs;
  const auto add = [&](const char* role, std::string label, const CurveRecord& curve) {
    if (curve.motion && is_sound(*curve.motion)) runs.push_back({role, std::move(label), curve});
  };
  add("best", best_label(result), result.best.curve);
  add("baseline", baseline_label(), result.baseline().curve);
  return runs;
}

std::size_t place_of(const ShownMotion& m, double at) {
  const auto nearest = std::ranges::min_element(m.places, {}, [&](double x) { return std::abs(x - at); });
  return static_cast<std::size_t>(nearest - m.places.begin());
}

// Returns the height of the lower face of the beam at one of the recorded places and instants [m].
double height(const ShownMotion& m, std::size_t row, std::size_t place) {
  double sum = m.rest[place];
  for (std::size_t i = 0; i < m.shapes.size(); ++i) sum -= m.amplitudes[i][row] * m.shapes[i][place];
  return sum;
}

std::size_t row_of(const ShownMotion& m, double time) {
  const auto next = std::ranges::lower_bound(m.time, time);
  return next == m.time.end() ? m.time.size() - 1 : static_cast<std::size_t>(next - m.time.begin());
}

// Returns the largest round length up to `most` for the scale bar of a picture [m].
double round_length(double most) {
  const double power = std::pow(10, std::floor(std::log10(most)));
  return power * (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1);
}

std::string scale_bar(double x, double bottom, double per_metre, double most) {
  const double length = round_length(most / per_metre), top = bottom - length * per_metre;
  return drawn_line(x, top, x, bottom, "measure") + drawn_line(x - 4, top, x + 4, top, "measure") +
         drawn_line(x - 4, bottom, x + 4, bottom, "measure") +
         drawn_words(x + 8, (top + bottom) / 2 + 4, "start", given_quantity(length, "m"));
}

// Maps places on the switch to pixels.
class MotionView {
 public:
  MotionView(const ClosingRecord& result, const std::vector<ShownRun>& runs) : runs_(runs), motion_(runs.front().motion()) {
    const double length = motion_.places.back();
    double highest = 0;
    for (const ShownRun& run : runs) {
      for (std::size_t row = 0; row < run.motion().time.size(); ++row) {
        for (std::size_t place = 0; place < run.motion().places.size(); ++place)
          highest = std::max(highest, height(run.motion(), row, place));
      }
    }
    for (const ShownMotion::Pad& pad : motion_.electrodes) far_ = std::max(far_, pad.far_side ? pad.gap : 0);
    for (const ShownMotion::Contact& c : motion_.contacts) far_ = std::max(far_, c.far_side ? c.gap : 0);
    const double gap = result.scene.electrode_gap;
    per_metre_ = travel / (gap + std::max(highest, far_));

    const bool plate = result.scene.structure == SideOfStructure::on_springs;
    const bool held = std::ranges::all_of(motion_.shapes, [](const auto& shape) { return std::abs(shape.back()) < 1e-9; });
    view_ = {.plate = plate,
             .both_ends = held && !plate,
             .length = length,
             .top = std::max(highest, far_) * per_metre_ + (far_ > 0 ? 44 : 14),
             .right = right_end,
             .gap = gap * per_metre_,
             .per_metre = per_metre_};
    scene_.structure = result.scene.structure;
    scene_.length = length;
    for (const ShownMotion::Pad& pad : motion_.electrodes)
      scene_.electrodes.push_back({.name = pad.electrode,
                                   .span = std::array{pad.begin, pad.end},
                                   .far_side = pad.far_side,
                                   .gap = pad.far_side ? pad.gap : Metrics::unset});
    if (result.scene.piezo) layer_ = shares_of(result.scene.piezo->span, length);
    set_detail();
  }

  [[nodiscard]] double exaggeration() const { return per_metre_ * motion_.places.back() / (right_end - SideView::left); }
  [[nodiscard]] bool has_detail() const { return detail_per_metre_ > 0; }
  [[nodiscard]] double bottom() const { return view_.floor + SideView::electrode; }
  /// Returns the y coordinate of the lowest text of the picture [px].
  [[nodiscard]] double end() const {
    const auto near = std::ranges::count_if(motion_.contacts, [](const auto& c) { return !c.far_side; });
    return bottom() + 14 + (motion_.contacts.size() > 1 ? 14 * static_cast<double>(near) : 0);
  }

  /// Draws the parts of the switch that do not move.
  [[nodiscard]] std::string surroundings() const {
    std::string out = drawn_supports(view_) + drawn_electrodes(scene_, view_);
    double names = bottom() + 28;  // baseline of the text line below the names of electrodes
    for (std::size_t k = 0; k < motion_.contacts.size(); ++k) {
      const ShownMotion::Contact& c = motion_.contacts[k];
      out += drawn_contact(k);
      if (motion_.contacts.size() == 1) continue;
      out += drawn_words(x_of(c), c.far_side ? ceiling() - 5 : names, "middle", c.name);
      if (!c.far_side) names += 14;
    }
    out += scale_bar(right_end + (view_.plate || view_.both_ends ? 62 : 22), bottom(), per_metre_, 0.5 * view_.gap);
    if (!has_detail()) return out;
    const double centre = detail_left + detail_wide / 2;
    out += drawn_rectangle(detail_left, detail_top, detail_wide, bottom() - detail_top, "frame");
    out += drawn_rectangle(centre - 24, detail_plane_, 48, bottom() - detail_plane_, "contact");
    out += drawn_line(detail_left, detail_plane_, detail_left + detail_wide, detail_plane_, "guide");
    out += scale_bar(detail_left + 10, detail_plane_, detail_per_metre_, 0.35 * detail_plane_);
    return out + drawn_words(centre, bottom() + 14, "middle", "at the contact, enlarged");
  }

  /// Returns the outline of the moving part at an instant as the data of an SVG path.
  [[nodiscard]] std::string shape(const ShownMotion& m, std::size_t row) const {
    std::string lower, upper;
    for (std::size_t k = 0; k < m.places.size(); ++k) {
      const double x = view_.x_at(m.places[k] / view_.length), y = view_.bottom - per_metre_ * height(m, row, k);
      lower += fmt::format("{}{:.1f} {:.1f}", k == 0 ? "M" : "L", x, y);
      upper = fmt::format("L{:.1f} {:.1f}", x, y - SideView::thick) + upper;
    }
    return lower + upper + "Z";
  }

  /// Draws the beam above the first contact of the scene at an instant, in the enlarged picture beside the switch; empty if the
  /// beam is outside that picture.
  [[nodiscard]] std::string detail(const ShownMotion& m, std::size_t row, const std::string& style) const {
    if (!has_detail()) return {};
    const ShownMotion::Contact& c = m.contacts.front();
    const std::size_t place = place_of(m, c.at);
    const double y = detail_plane_ - detail_per_metre_ * (c.gap + height(m, row, place) - m.rest[place]) - SideView::thick;
    if (y < detail_top) return {};
    return fmt::format("<path d=\"M{} {:.1f}h{}v{}h-{}Z\" class=\"{}\"/>\n", detail_left, y, detail_wide, SideView::thick,
                       detail_wide, style);
  }

  /// Returns the constants of the picture that the script needs to draw the runs.
  [[nodiscard]] json json_of() const {
    json all{{"bottom", view_.bottom}, {"perMetre", per_metre_}, {"thick", SideView::thick}, {"contacts", json::array()}};
    for (std::size_t k = 0; k < motion_.contacts.size(); ++k)
      all["contacts"].push_back(
          {{"name", motion_.contacts[k].name}, {"gap", motion_.contacts[k].gap}, {"far", motion_.contacts[k].far_side}});
    if (layer_) all["layer"] = {{"from", view_.x_at((*layer_)[0])}, {"to", view_.x_at((*layer_)[1])}, {"thick", SideView::layer}};
    if (has_detail())
      all["detail"] = {{"plane", detail_plane_}, {"perMetre", detail_per_metre_}, {"left", detail_left}, {"wide", detail_wide}};
    return all;
  }
  [[nodiscard]] std::vector<double> x_of(const ShownMotion& m) const {
    std::vector<double> all;
    for (const double place : m.places) all.push_back(std::round(100 * view_.x_at(place / view_.length)) / 100);
    return all;
  }

 private:
  [[nodiscard]] double ceiling() const { return view_.top - far_ * per_metre_ - 20; }
  // Returns the x coordinate of a contact. The single contact of a plate is drawn in the middle: all places of a plate move
  // alike.
  [[nodiscard]] double x_of(const ShownMotion::Contact& c) const {
    return view_.x_at(view_.plate && motion_.contacts.size() == 1 ? 0.5 : c.at / view_.length);
  }
  [[nodiscard]] std::string drawn_contact(std::size_t k) const {
    const ShownMotion::Contact& c = motion_.contacts[k];
    const double rest = motion_.rest[place_of(motion_, c.at)], left = std::min(x_of(c), view_.right - contact_wide / 2);
    const double plane = view_.bottom - per_metre_ * (c.far_side ? rest + c.gap : rest - c.gap);
    const double top = c.far_side ? ceiling() : plane, end = c.far_side ? plane - SideView::thick : bottom();
    return fmt::format("<g data-contact=\"{}\">", k) +
           drawn_rectangle(left - contact_wide / 2, top, contact_wide, std::max(0.0, end - top), "contact") + "</g>\n";
  }

  // Chooses the scale of the enlarged picture of the first contact of the scene: the highest rebound fills the picture.
  void set_detail() {
    if (motion_.contacts.empty()) return;
    double highest = 0.01 * motion_.contacts.front().gap;
    for (const ShownRun& run : runs_) {
      for (const Rebound& rebound : run.curve.rebounds) highest = std::max(highest, drawable(rebound.height));
    }
    detail_plane_ = 0.75 * bottom();
    detail_per_metre_ = 0.6 * detail_plane_ / highest;
  }

  const std::vector<ShownRun>& runs_;
  const ShownMotion& motion_;
  double far_ = 0;        // largest gap of the electrodes and contacts above the beam [m]
  double per_metre_ = 0;  // scale of lengths in the picture [px/m]
  SideView view_;
  DrawnScene scene_;
  std::optional<std::array<double, 2>> layer_;
  double detail_plane_ = 0, detail_per_metre_ = 0;
};

// Returns the main instants of a run (such as first contact) and their names.
std::vector<std::pair<double, std::string>> labelled_instants(const CurveRecord& curve) {
  std::vector<std::pair<double, std::string>> all{{curve.motion->time.front(), "at the start"}};
  const bool closes = curve.closed && !curve.closed->empty();
  if (closes && curve.closed->front().begin > 0) all.emplace_back(curve.closed->front().begin, "first touch");
  const auto highest = std::ranges::max_element(curve.rebounds, {}, &Rebound::height);
  if (highest != curve.rebounds.end()) all.emplace_back(highest->time_of_height, "highest rebound");
  const double end = curve.motion->time.back();
  if (end > all.back().first)
    all.emplace_back(end, closes && std::isnan(curve.closed->back().end) ? "closed at the end" : "at the end");
  return all;
}

std::string strobe(const MotionView& view, const CurveRecord& curve) {
  std::string shapes, names;
  double x = SideView::left - 40;
  std::size_t k = 0;
  for (const auto& [time, name] : labelled_instants(curve)) {
    const std::string style = fmt::format("instant-{}", ++k);
    const std::size_t row = row_of(*curve.motion, time);
    shapes += fmt::format("<path d=\"{}\" class=\"{}\"/>\n", view.shape(*curve.motion, row), style) +
              view.detail(*curve.motion, row, style);
    const std::string words = fmt::format("{}, {}", name, quantity(time, "s"));
    const double y = view.end() + 20;
    names += fmt::format("<path d=\"M{:.1f} {:.1f}h24v-8h-24Z\" class=\"{}\"/>\n", x, y, style) +
             drawn_words(x + 30, y, "start", words);
    x += 46 + 6.3 * static_cast<double>(words.size());
  }
  return "<g class=\"strobe\">\n" + shapes + names + "</g>\n";
}

// Returns the recorded motion of a run as JSON for the script of the page, in the places and modes of ShownMotion.
json run_json(const ShownRun& run, const MotionView& view) {
  constexpr double fine = 1e-6;
  const ShownMotion& m = run.motion();
  double largest = 0;
  for (const auto& mode : m.amplitudes) {
    for (const double one : mode) largest = std::max(largest, std::abs(one));
  }
  json amplitudes = json::array(), shapes = json::array(), places = json::array();
  for (const auto& mode : m.amplitudes) amplitudes.push_back(packed(mode, fine * largest));
  for (const auto& shape : m.shapes) shapes.push_back(packed(shape, fine));
  for (const ShownMotion::Contact& c : m.contacts) places.push_back(place_of(m, c.at));
  double highest_rest = 0;
  for (const double one : m.rest) highest_rest = std::max(highest_rest, std::abs(one));
  return {{"role", run.role},         {"label", run.label}, {"time", packed(m.time, 1e-7 * m.time.back())},
          {"amplitudes", amplitudes}, {"shapes", shapes},   {"rest", packed(m.rest, fine * highest_rest)},
          {"x", view.x_of(m)},        {"places", places}};
}

// Returns the duration of the highest rebound [s], which sets the slowest speed of the animation; without rebounds, a fiftieth
// of the run.
double slowest_stretch(const std::vector<ShownRun>& runs) {
  const Rebound* highest = nullptr;
  for (const ShownRun& run : runs) {
    for (const Rebound& one : run.curve.rebounds)
      if (one.end > one.begin && (highest == nullptr || one.height > highest->height)) highest = &one;
    if (highest != nullptr) break;
  }
  return highest != nullptr ? highest->end - highest->begin : runs.front().motion().time.back() / 50;
}

}  // namespace

std::string motion_figure(const ClosingRecord& result) {
  const std::vector<ShownRun> runs = shown_runs(result);
  if (runs.empty() || !(result.scene.electrode_gap > 0)) return {};
  const MotionView view(result, runs);
  json data = view.json_of();
  data["bounce"] = slowest_stretch(runs);
  data["runs"] = json::array();
  std::string moving;
  for (auto run = runs.rbegin(); run != runs.rend(); ++run) moving += fmt::format("<g class=\"{}\"></g>\n", run->role);
  for (const ShownRun& run : runs) data["runs"].push_back(run_json(run, view));
  const std::string caption = fmt::format(
      "Side view of the switch, to scale along its length. Heights are exaggerated {} times; the thickness is not to scale.{}",
      plain_number(view.exaggeration(), 2),
      view.has_detail() ? " The picture beside it enlarges the first contact further." : "");
  const std::string of_script = fmt::format("{} The time is that of the slider and of the cursor in the charts.",
                                            runs.size() > 1 ? " The dashed outline is the plain step." : "");
  return fmt::format(
             "<figure id=\"figure-motion\" class=\"motion\"><h3>The moving switch</h3>\n"
             "<div class=\"tools\" hidden><button type=\"button\" data-play>Play</button>"
             "<label>Speed <select></select></label>"
             "<input type=\"range\" min=\"0\" max=\"1000\" value=\"0\" aria-label=\"Time in the charts' view\"></div>\n"
             "<dl class=\"reads\" hidden></dl>\n"
             "<svg class=\"sketch\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"The moving switch from the side\">\n",
             figure_width, view.end() + 28) +
         view.surroundings() + strobe(view, runs.front().curve) + "<g class=\"moving\">\n" + moving + "</g>\n</svg>\n" +
         fmt::format(
             "<figcaption>{}<span class=\"moving\">{}</span></figcaption>\n"
             "<script type=\"application/json\" class=\"motion-data\">{}</script></figure>\n",
             escaped(caption), of_script, script_json(data));
}

}  // namespace softland::internal
