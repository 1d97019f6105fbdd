#include "config/condition.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <vector>

#include "base/require.h"
#include "config/quantity_argument.h"
#include "config/schema.h"
#include "config/units.h"

namespace softland {
namespace {

struct Sign {
  std::string_view text;
  Comparison comparison;
};
// Comparison signs of a condition, in the order in which the parser tries them: "<=" must precede "<".
constexpr auto signs = std::to_array<Sign>({{"<=", Comparison::at_most},
                                            {">=", Comparison::at_least},
                                            {"==", Comparison::equal},
                                            {"<", Comparison::below},
                                            {">", Comparison::above},
                                            {"=", Comparison::equal}});

std::string_view unquoted(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\"'"), end = text.find_last_not_of(" \t\"'");
  return begin == std::string_view::npos ? std::string_view() : text.substr(begin, end - begin + 1);
}

double number_after(std::string_view text, std::string_view what, double least, double most, bool most_open) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_number = !text.empty() && error == std::errc() && end == text.data() + text.size();
  require(is_number && value >= least && (most_open ? value < most : value <= most), [&] {
    return !std::isfinite(most) ? fmt::format("{} must be a number from {} on", what, least)
           : most_open          ? fmt::format("{} must be at least {} and less than {}", what, least, most)
                                : fmt::format("{} must be from {} to {}", what, least, most);
  });
  return value;
}

}  // namespace

double Condition::violation(double value) const {
  if (!std::isfinite(value)) return std::numeric_limits<double>::infinity();
  const double scale = limit == 0 ? 1 : std::abs(limit);
  switch (comparison) {
    case Comparison::below:
    case Comparison::at_most:
      return (value - limit) / scale;
    case Comparison::equal:
      return std::abs(value - limit) / scale;
    case Comparison::at_least:
    case Comparison::above:
      break;
  }
  return (limit - value) / scale;
}

bool Condition::holds(double value) const {
  const bool is_strict = comparison == Comparison::below || comparison == Comparison::above;
  const double by = violation(value);
  return is_strict ? by < 0 : by <= 0;
}

Condition parse_condition(std::string_view text, std::span<const Figure> figures) {
  const std::string_view all = unquoted(text);
  const std::size_t at = all.find_first_of("<>=");
  require(at != std::string_view::npos,
          [&] { return fmt::format("'{}' must be a condition: a figure, then <, <=, ==, >= or >, then a value", all); });
  const auto sign = std::find_if(signs.begin(), signs.end(), [&](const Sign& s) { return all.substr(at).starts_with(s.text); });
  const std::string_view name = unquoted(all.substr(0, at)), value = unquoted(all.substr(at + sign->text.size()));

  std::vector<std::string_view> names;
  for (const Figure& f : figures) names.push_back(f.quantity());
  std::size_t k = 0;
  while (k < figures.size() && name != names[k] && name != figures[k].key &&
         (figures[k].symbol.empty() || name != figures[k].symbol))
    ++k;
  require(k < figures.size(), [&] { return fmt::format("unknown figure of merit '{}'{}", name, internal::hint(name, names)); });
  constexpr std::string_view step_unit = "step";
  if (value.ends_with(step_unit)) {
    const std::string_view number = unquoted(value.substr(0, value.size() - step_unit.size()));
    Quantity times;
    try {
      times = parse_quantity(number);
    } catch (const InvalidInput& error) {
      throw InvalidInput(fmt::format("{} in '{}'", error.what(), all));
    }
    require(times.dimension == dimension::none && times.value > 0,
            [&] { return fmt::format("'{}' in '{}' must be a factor above 0 on the figure of the plain step", number, all); });
    return {
        .figure = figures[k], .comparison = sign->comparison, .limit = times.value, .text = std::string(all), .of_step = true};
  }
  const Dimension due = figures[k].unit.empty() ? dimension::none : parse_quantity("1 " + std::string(figures[k].unit)).dimension;
  Quantity limit;
  try {
    limit = quantity_with_unit(value, due);
  } catch (const InvalidInput& error) {
    throw InvalidInput(fmt::format("{} in '{}'", error.what(), all));
  }
  require(limit.dimension == due, [&] { return fmt::format("{} in '{}' must be {}", names[k], all, describe(due)); });
  require(limit.value != 0 || figures[k].unit.empty(),
          [&] { return fmt::format("the limit of {} in '{}' must not be 0: give a small value with its unit", names[k], all); });
  return {.figure = figures[k], .comparison = sign->comparison, .limit = limit.value, .text = std::string(all)};
}

Condition beside_step(Condition condition, double of_step) {
  if (!condition.of_step) return condition;
  require(std::isfinite(of_step) && of_step != 0,
          [&] { return fmt::format("'{}': the plain step does not have this figure: give a limit in units", condition.text); });
  condition.limit *= of_step;
  condition.of_step = false;
  return condition;
}

RobustMeasure parse_robust_measure(std::string_view text, std::span<const Figure> figures) {
  const auto after = [&](std::string_view head) { return text.substr(head.size()); };
  constexpr double infinite = std::numeric_limits<double>::infinity();
  RobustMeasure measure{.risk = {}, .yield = {}, .text = std::string(text)};
  if (text == "worst") {
    measure.risk = {.kind = RiskKind::worst, .parameter = 0};
  } else if (text == "cvar") {
    measure.text = "cvar:0.9";
  } else if (text.starts_with("cvar:")) {
    measure.risk = {.kind = RiskKind::cvar, .parameter = number_after(after("cvar:"), "the level of cvar", 0, 1, true)};
  } else if (text.starts_with("quantile:")) {
    measure.risk = {.kind = RiskKind::quantile,
                    .parameter = number_after(after("quantile:"), "the level of quantile", 0, 1, false)};
  } else if (text.starts_with("mean+") && text.ends_with("sigma")) {
    std::string_view factor = after("mean+");
    factor.remove_suffix(std::string_view("sigma").size());
    measure.risk = {.kind = RiskKind::mean_sigma, .parameter = number_after(factor, "the factor of sigma", 0, infinite, true)};
  } else if (text == "yield") {
    measure.yield = parse_condition("bounce_count == 0", figures);
  } else if (text.starts_with("yield:")) {
    measure.yield = parse_condition(after("yield:"), figures);
  } else {
    throw InvalidInput(
        fmt::format("unknown statistic '{}': choose one of cvar:0.9, quantile:0.95, mean+2sigma, worst, "
                    "yield and yield:\"bounce_count == 0\"",
                    text));
  }
  return measure;
}

}  // namespace softland
