// Synthetic explorations, whose figures are formulas.
#pragma once

#include "reports/exploration_report.h"

namespace softland::test {

/// Returns a grid of columns x rows points over length and contact gap. The impact velocity is smooth and the number of rebounds
/// jumps. The lower left corner does not touch, and the upper right one is impossible.
[[nodiscard]] ExplorationReport sample_grid(std::size_t columns, std::size_t rows);

/// Returns random points in a box of five variables. Closing time against impact velocity has a front with a knee, whose points
/// have a waveform.
[[nodiscard]] ExplorationReport sample_cloud(std::size_t points);

}  // namespace softland::test
