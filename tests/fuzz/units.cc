#include "config/units.h"

#include <cmath>

#include "tests/fuzz/targets.h"

namespace softland::fuzz {

void units(std::string_view input) {
  Quantity read;
  if (!accepted([&] { read = parse_quantity(input); })) return;
  const std::string written = quantity_text(read.value, read.dimension);
  check(std::isfinite(read.value), "not finite: " + written);
  check(!describe(read.dimension).empty(), "no description of " + written);
  const Quantity again = parse_quantity(written);
  check(again.dimension == read.dimension, "another dimension: " + written);
  // Zero keeps its sign as well.
  check(again.value == read.value && std::signbit(again.value) == std::signbit(read.value), "another value: " + written);
}

}  // namespace softland::fuzz
