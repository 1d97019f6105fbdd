// A table with fewer rows, which a source of a given bandwidth turns into nearly the same voltage.
//
// The rows that stay are rows of the table, with straight lines between them: the voltage stays between its extremes, and
// nothing gets steeper. Take two inputs of T dV/dt + V = input whose difference has the integral E(t) from 0 on: the outputs
// differ by at most 2 max|E| / T (integration by parts of the response). So rows are left out as long as |E| allows it. Noise
// that such a source averages disappears, and edges keep their time.
#pragma once

#include "waveforms/table.h"

namespace softland {

struct Thinned {
  Table table;
  double error = 0;  ///< largest difference of the voltages behind the source [V]
};

/// Returns the thinned table. `time_constant` T > 0 is that of the source [s], `largest_error` that of the voltage behind it
/// [V], >= 0. The first and the last row stay, and both rows of a jump. `table` is valid (signal() takes it).
[[nodiscard]] Thinned thinned(const Table& table, double time_constant, double largest_error);

}  // namespace softland
