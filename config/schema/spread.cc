#include "config/spread.h"

#include "config/schema/sections.h"
#include "sampling/distribution.h"

namespace softland::internal {
namespace {

/// Returns a key of [spread] whose value is in the unit of the varied key, or a ratio to the value of that key in the scene.
Key of_the_key(std::string_view name, std::string_view about) { return number(name, {}, any, about); }

}  // namespace

Section spread_section() {
  constexpr Range up_to_one{.least = 0, .most = 1, .least_open = true};
  Key values = numbers("values", {}, any, "at least two; values between them, in order, have equal probabilities")
                   .needed()
                   .of({"empirical"})
                   .instead("file");
  return {
      .name = "spread",
      .is_named = true,
      .beside = correlation_key,
      .selector = "distribution",
      .keys = {{.name = "keys", .type = KeyType::texts, .about = "keys that all vary by one factor; absent: the key NAME"},
               numbers("weights", {dimension::none}, any,
                       "one for each of keys, not 0: one amount, times its weight, is added to each key instead of the factor"),
               one_of("distribution", names_of(distribution_kinds),
                      "distribution of the varied value; its mean is the value of the scene for the first three")
                   .needed(),
               number("cov", {dimension::none}, up_to_one,
                      "coefficient of variation: standard deviation divided by the value of the scene")
                   .needed()
                   .of({"normal", "lognormal", "uniform"})
                   .instead("standard_deviation")
                   .instead("half_width"),
               number("standard_deviation", {}, positive, "in the unit of the key, instead of cov")
                   .needed()
                   .of({"normal", "lognormal"})
                   .instead("cov"),
               number("half_width", {}, positive,
                      "half the width of the interval, in the unit of the key or as a percentage of its value")
                   .needed()
                   .of({"uniform"})
                   .instead("cov"),
               of_the_key("low", "smallest value, in the unit of the key or as a percentage of its value, like the next two")
                   .needed()
                   .of({"triangular"}),
               of_the_key("mode", "most probable value; absent: the value of the scene").of({"triangular"}),
               of_the_key("high", "largest value").needed().of({"triangular"}),
               std::move(values),
               words("file", "CSV file of values, relative to the scene").needed().of({"empirical"}).instead("values"),
               words("column", "column of the file").of({"empirical"}),
               words("unit", "unit of the values in the file; absent: ratios to the value of the scene").of({"empirical"}),
               of_the_key("truncate_low", "values below this do not occur; at least 1e-6 of the probability must remain"),
               of_the_key("truncate_high", "values above this do not occur; at least 1e-6 of the probability must remain")},
      .about = "process variation of keys of the scene"};
}

}  // namespace softland::internal
