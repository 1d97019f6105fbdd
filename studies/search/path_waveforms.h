// Waveforms of a path of optimal control: until first contact, and with the pull after it that keeps the switch closed.
#pragma once

#include <vector>

#include "studies/search/first_touch_problem.h"
#include "studies/search/limit.h"

namespace softland {

/// The waveform after first contact: full pull from `begin` to `end`, then the hold levels.
struct Catch {
  double begin = 0, end = 0;  ///< times after first contact [s]
};

/// Returns the controls until first contact as tables of voltage against time.
[[nodiscard]] DriveWaveforms tables_of(const FirstTouchProblem& flight, const ControlledCourse& course);
/// Returns the waveforms of `found`, then a catch, then the hold levels of the waveforms `held`, or 0 V.
[[nodiscard]] DriveWaveforms with_catch(const FirstTouchProblem& flight, const LeastTime& found, const Catch& pulled,
                                        const DriveWaveforms& held);
/// Returns the signals of all drives: `searched`, for other drives `plain`, else the waveforms of the scene.
[[nodiscard]] std::vector<Signal> applied(const PreparedScene& prepared, DriveWaveforms searched, const DriveWaveforms& plain);

}  // namespace softland
