#include "waveforms/table.h"

#include "tests/fuzz/targets.h"
#include "waveforms/export.h"

namespace softland::fuzz {

void table(std::string_view input) {
  Table read;
  if (!accepted([&] { read = parse_table(input, "fuzz.csv", "main"); })) return;
  const Signal voltage = signal(read);
  const double end = 2 * read.time.back() + 1;  // [s] a table that ends before the window is written exactly
  static_cast<void>(accepted([&] { static_cast<void>(spice_pwl({{"main", voltage}}, end)); }));
  std::string written;
  if (!accepted([&] { written = csv({{"main", voltage}}, end); })) return;
  const Signal again = signal(parse_table(written, "written.csv", "main"));
  // Both are linear between the rows of `read`; a row that repeats the last voltage is not written.
  for (const double time : read.time) {
    const bool same = again.voltage(time) == voltage.voltage(time) && again.voltage_before(time) == voltage.voltage_before(time);
    check(same, "a table changes when it is written and read again:\n" + written);
  }
}

}  // namespace softland::fuzz
