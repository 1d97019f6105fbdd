// Drawings for explanation: the switch of a result from the side, and a found waveform with its parameters. The animation and
// the report on a cycle draw a switch with the same parts. The colours come from the CSS of the page.
#pragma once

#include <array>
#include <string>

#include "reports/closing_record.h"

namespace softland::internal {

[[nodiscard]] std::string drawn_rectangle(double left, double top, double wide, double high, const char* what);
[[nodiscard]] std::string drawn_line(double x1, double y1, double x2, double y2, const char* what);
[[nodiscard]] std::string drawn_words(double x, double y, const char* anchor, const std::string& text);

/// Returns begin and end of a span as shares of the length; 0 and 1 if no span is given.
[[nodiscard]] std::array<double, 2> shares_of(const DrawnScene::Span& span, double length);

/// Coordinates of the parts of a switch in a drawing from the side [px].
struct SideView {
  static constexpr double left = 60, thick = 14, electrode = 10, layer = 7;
  bool plate, both_ends;
  double length, top, right = 440, gap = 60, bottom = top + thick, floor = bottom + gap;
  double far = 0.75 * gap;  ///< distance from the upper face of the beam to the parts above it [px]
  /// Scale of heights in the drawing [px/m]; 0: heights are not to scale, and the parts above the beam are at the distance
  /// `far`.
  double per_metre = 0;

  [[nodiscard]] double x_at(double share) const { return left + share * (right - left); }
};

[[nodiscard]] std::string drawn_supports(const SideView& view);
[[nodiscard]] std::string drawn_electrodes(const DrawnScene& scene, const SideView& view);

/// Draws the switch at rest as an <svg> element: anchor, beam or plate, piezo layer, electrodes, contact, and the gaps. The
/// length is to scale, heights are exaggerated. Empty if the scene does not describe the switch. The colours come from the CSS
/// of the page.
[[nodiscard]] std::string device_picture(const DrawnScene& scene);

/// Draws the waveform of an electrode or piezo from t = 0 to the hold level, with the name of each searched parameter at the
/// times where it acts. Empty without searched parameters.
[[nodiscard]] std::string parameter_drawing(const ClosingRecord& result, const std::string& drive);

}  // namespace softland::internal
