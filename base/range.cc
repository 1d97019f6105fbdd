#include "base/range.h"

#include <fmt/format.h>

#include "base/engineering.h"

namespace softland {

std::string Range::rule(std::string_view unit) const {
  return fmt::format("must be in {}{}, {}{}", least_open ? '(' : '[', engineering(least, unit), engineering(most, unit),
                     most_open ? ')' : ']');
}

}  // namespace softland
