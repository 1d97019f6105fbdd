// Removes rows of a voltage table such that a source of a given bandwidth applies nearly the same voltage.
//
// Straight lines connect the rows that are kept, so the voltage stays between its extremes and no slope increases. Let E(t) be
// the integral from 0 on of the difference of two inputs of the source's filter T dV/dt + V = input. The outputs then differ by
// at most 2 max|E| / T (integration by parts of the response). Rows are removed as long as this bound is within the permitted
// error. Noise that the source averages out disappears, and edges keep their times.
#pragma once

#include "waveforms/table.h"

namespace softland {

struct Thinned {
  Table table;
  double error = 0;  ///< bound of the change of the applied voltage [V]
};

/// Returns the thinned voltage table. `time_constant` T > 0 is that of the source [s]; `largest_error` >= 0 is the largest
/// permitted change of the applied voltage [V]. The first and the last row are kept, and both rows of a jump. `table` must be
/// valid.
[[nodiscard]] Thinned thinned(const Table& table, double time_constant, double largest_error);

}  // namespace softland
