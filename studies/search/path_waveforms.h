// Waveforms from a solution of the optimal control problem of first contact: until first contact alone, or followed by a pull
// that keeps the switch closed.
#pragma once

#include <vector>

#include "studies/search/first_touch_problem.h"
#include "studies/search/least_time.h"

namespace softland {

/// The waveform after first contact (catch): full pull from `begin` to `end`, then the hold levels.
struct Catch {
  double begin = 0, end = 0;  ///< begin and end of the full pull, as times after first contact [s]
};

/// Returns the controls of a motion until first contact as tables of voltage [V] over time [s], by drive.
[[nodiscard]] DriveWaveforms tables_of(const FirstTouchProblem& flight, const ControlledCourse& course);
/// Returns the waveforms of the least-time solution `found`, followed by a pull after first contact (catch), and then by the
/// hold levels of the waveforms `held`; drives that `held` lacks end at 0 V.
[[nodiscard]] DriveWaveforms with_catch(const FirstTouchProblem& flight, const LeastTime& found, const Catch& pulled,
                                        const DriveWaveforms& held);
/// Returns the signals of all drives: those of `searched`, for other drives those of `plain`, else those of the scene.
[[nodiscard]] std::vector<Signal> applied(const PreparedScene& prepared, DriveWaveforms searched, const DriveWaveforms& plain);

}  // namespace softland
