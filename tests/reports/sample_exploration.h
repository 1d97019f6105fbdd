// Explorations whose figures are formulas.
#pragma once

#include "reports/exploration_report.h"

namespace softland::test {

/// A grid of columns x rows points over length and contact gap. The impact speed is smooth, the number of rebounds jumps, the
/// lower left corner does not touch and the upper right one cannot be.
[[nodiscard]] ExplorationReport sample_grid(std::size_t columns, std::size_t rows);

/// Points drawn in a box of five variables; closing time against impact speed has a front with a knee, whose points have a
/// waveform.
[[nodiscard]] ExplorationReport sample_cloud(std::size_t points);

}  // namespace softland::test
