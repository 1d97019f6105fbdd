#include "config/spread.h"

#include "config/schema/sections.h"
#include "sampling/distribution.h"

namespace softland::internal {
namespace {

/// Returns a number in the unit of the key, or a ratio to the scene's value.
Key of_the_key(std::string_view name, std::string_view about) { return number(name, {}, any, about); }

}  // namespace

Section spread_section() {
  constexpr Range up_to_one{.least = 0, .most = 1, .least_open = true};
  Key values = numbers("values", {}, any, "at least two").needed().of({"empirical"}).instead("file");
  return {.name = "spread",
          .is_named = true,
          .beside = correlation_key,
          .selector = "distribution",
          .keys = {{.name = "keys", .type = KeyType::texts, .about = "all varied by one factor; absent: the one key NAME"},
                   numbers("weights", {dimension::none}, any, "of the keys: one amount, times these, is added to all of them"),
                   one_of("distribution", names_of(distribution_kinds), "of what varies; its mean is the scene's value").needed(),
                   number("cov", {dimension::none}, up_to_one, "standard deviation over the scene's value")
                       .needed()
                       .of({"normal", "lognormal", "uniform"})
                       .instead("standard_deviation")
                       .instead("half_width"),
                   number("standard_deviation", {}, positive, "in the unit of the key")
                       .needed()
                       .of({"normal", "lognormal"})
                       .instead("cov"),
                   number("half_width", {}, positive, "in the unit of the key, or a percentage of its value")
                       .needed()
                       .of({"uniform"})
                       .instead("cov"),
                   of_the_key("low", "least value").needed().of({"triangular"}),
                   of_the_key("mode", "most probable value; absent: the scene's").of({"triangular"}),
                   of_the_key("high", "largest value").needed().of({"triangular"}),
                   std::move(values),
                   words("file", "CSV, relative to the scene").needed().of({"empirical"}).instead("values"),
                   words("column", "of that file").of({"empirical"}),
                   words("unit", "of its values; absent: they are ratios to the scene's value").of({"empirical"}),
                   of_the_key("truncate_low", "what is below does not occur"),
                   of_the_key("truncate_high", "what is above does not occur")},
          .about = "manufacturing spread of scene keys"};
}

}  // namespace softland::internal
