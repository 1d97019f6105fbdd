// The values of a study as a result that reports are made of.
#pragma once

#include <string>
#include <string_view>

#include "reports/closing_record.h"
#include "studies/closing/simulate.h"
#include "studies/search/for_devices.h"
#include "studies/search/robust_optimize.h"

namespace softland {

/// The motion of a run: knots, and points of the interpolant where knots are far apart; of a long run the most_curve_rows of them
/// that draw the same picture, with all extremes, and the most_rebounds highest rebounds.
[[nodiscard]] CurveRecord curve_of(const Trajectory& trajectory, const MetricsOptions& options);
/// Of a course whose rebounds are known. Between the knots of one that is thinned nothing is drawn.
[[nodiscard]] CurveRecord curve_of(const Trajectory& trajectory, const std::vector<Rebound>& rebounds, bool is_thinned,
                                   const MetricsOptions& options);

/// The evaluations of a long search of which most_evaluations draw the same picture.
[[nodiscard]] Points drawn_evaluations(Points all);

/// The result of simulate; `command` is the command line. Curves have the resolution of the integration, up to most_curve_rows.
[[nodiscard]] ClosingRecord record_of(const PreparedScene& prepared, const Closing& closing, const std::string& command);

/// The result of optimize. Equal for equal seeds but for the time that it took and the command line. Of the evaluations it holds
/// those that improved.
[[nodiscard]] ClosingRecord record_of(const OptimizeResult& found, const OptimizeOptions& options, const std::string& command);

/// The result of a robust search.
[[nodiscard]] ClosingRecord record_of(const RobustResult& found, const OptimizeOptions& options, const std::string& command);

/// The result of a search for devices: of the waveform that wins.
[[nodiscard]] ClosingRecord record_of(const ForDevicesResult& found, const OptimizeOptions& options, std::string next_command,
                                      const std::string& command);

}  // namespace softland
