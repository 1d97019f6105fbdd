#include <algorithm>
#include <cmath>

#include "exchange/mode_table.h"
#include "tests/fuzz/targets.h"

namespace softland::fuzz {

// A file of modes, with and without optional keys: an accepted table has shapes of one length, increasing positions and
// frequencies, a clamp, and finite numbers.
void modes(std::string_view input) {
  const ModeKeys along{.axis = "x", .direction = "-z"};
  ModeKeys with_mass = along, with_all = along, normalised = along;
  with_mass.mass = 1e-12;
  with_all.mass = 1e-12, with_all.length_unit = 1e-6, with_all.clamp = -1e-6;
  normalised.mass_normalised = true, normalised.frequencies = {1e3};
  for (const ModeKeys& keys : {ModeKeys{}, along, with_mass, with_all, normalised}) {
    ModeTable table;
    if (!accepted([&] { table = parse_mode_table(input, "fuzz.txt", keys); })) continue;
    const auto rises = [](const std::vector<double>& v) {
      return std::adjacent_find(v.begin(), v.end(), [](double a, double b) { return !(a < b); }) == v.end();
    };
    check(table.positions.size() >= 3 && table.positions.front() == 0 && rises(table.positions),
          "positions do not rise from a clamp");
    check(!table.frequencies.empty() && table.frequencies.front() > 0 && rises(table.frequencies), "frequencies do not rise");
    check(table.shapes.size() == table.frequencies.size(), "there are more or fewer shapes than frequencies");
    for (const std::vector<double>& shape : table.shapes) {
      check(shape.size() == table.positions.size() && shape.front() == 0, "a shape is of another length, or moves at the clamp");
      check(std::all_of(shape.begin(), shape.end(), [](double v) { return std::isfinite(v); }), "a shape is not finite");
    }
    static_cast<void>(summary(table));
  }
}

}  // namespace softland::fuzz
