#include "reports/side_view.h"

#include <fmt/format.h>

#include "document/escape.h"
#include "document/quantity.h"

namespace softland::internal {
namespace {

std::string spring(double left, double right, double y) {
  std::string path = fmt::format("M{:.1f} {:.1f}", left, y);
  constexpr int turns = 6;
  for (int i = 1; i < 2 * turns; ++i)
    path += fmt::format(" L{:.1f} {:.1f}", left + (right - left) * i / (2 * turns), y + (i % 2 == 0 ? -6 : 6));
  return fmt::format("<path d=\"{} L{:.1f} {:.1f}\" class=\"measure\"/>\n", path, right, y);
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

}  // namespace softland::internal
