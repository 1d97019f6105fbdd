// Every number that a scene can have, at the ends of its range and beyond. The list of keys is the schema itself.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/engineering.h"
#include "base/require.h"
#include "config/section_reader.h"

namespace softland::internal {
namespace {

using testing::HasSubstr;

bool is_numeric(const Key& key) {
  return key.type == KeyType::quantity || key.type == KeyType::quantities || key.type == KeyType::integer;
}

std::string some_value(const Key& key) {
  switch (key.type) {
    case KeyType::text:
      return "'text'";
    case KeyType::texts:
      return "['text']";
    case KeyType::flag:
      return "true";
    case KeyType::integer:
      return "1";
    case KeyType::choice:
      return fmt::format("'{}'", key.choices.front());
    case KeyType::table:
    case KeyType::tables:
      return std::string(key.like);
    case KeyType::quantity:
    case KeyType::quantities:
      break;
  }
  const std::string one = key.dimensions.empty()                      ? std::string("'1 %'")
                          : key.dimensions.front() == dimension::none ? std::string("0.01")
                                                                      : fmt::format("'{}'", example(key.dimensions.front()));
  if (key.type == KeyType::quantity) return one;
  return fmt::format("[{}]", fmt::join(std::vector<std::string>(std::max<std::size_t>(1, key.count), one), ", "));
}

/// A section with this value of `key` and with the other keys that it needs.
struct Example {
  Example(const Section& section, const Key& key, const std::string& choice) : section_(section), key_(key) {
    entry_ = !section.is_named ? "" : section.entry.empty() ? "some" : std::string(section.entry);
    head_ = section.is_named ? fmt::format("[{}.{}]\n", section.name, entry_) : fmt::format("[{}]\n", section.name);
    if (!section.selector.empty()) head_ += fmt::format("{} = '{}'\n", section.selector, choice);
    std::vector<std::string_view> given{key.name};
    for (const Key& other : section.keys) {
      const auto excludes = [&](std::string_view name) { return std::find(given.begin(), given.end(), name) != given.end(); };
      if (!other.required || !other.belongs_to(choice) || other.name == section.selector || excludes(other.name)) continue;
      if (std::any_of(other.instead_of.begin(), other.instead_of.end(), excludes)) continue;
      head_ += fmt::format("{} = {}\n", other.name, some_value(other));
      given.push_back(other.name);
    }
    path_ = join_path(section.is_named ? fmt::format("{}.{}", section.name, entry_) : std::string(section.name), key.name);
  }

  /// Returns the reader's message for this value in TOML; empty if it is accepted.
  [[nodiscard]] std::string answer(const std::string& value) const {
    const SceneFile file = SceneFile::parse(fmt::format("{}{} = {}\n", head_, key_.name, value), "x.toml");
    try {
      const SectionReader reader(file.impl(), section_.name, entry_);
      return {};
    } catch (const InvalidInput& error) {
      return error.what();
    }
  }
  /// Returns the value of the number in the SI unit of `dimension`, as a list if the key needs one.
  [[nodiscard]] std::string text(double value, const Dimension& dimension) const {
    const bool bare = key_.type == KeyType::integer || key_.is_bare_number();
    std::string one = key_.type == KeyType::integer ? fmt::format("{:.0f}", value)
                      : bare                        ? fmt::format("{:.17g}", value)
                                                    : fmt::format("'{}'", quantity_text(value, dimension));
    if (bare && key_.type != KeyType::integer && one.find_first_of(".en") == std::string::npos) one += ".0";
    if (dimension == dimension::none && !bare) one = fmt::format("'{:.17g} %'", 100 * value);
    if (key_.type != KeyType::quantities) return one;
    return fmt::format("[{}]", fmt::join(std::vector<std::string>(std::max<std::size_t>(1, key_.count), one), ", "));
  }
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  const Section& section_;
  const Key& key_;
  std::string entry_, head_, path_;
};

/// Calls `check` with every number of the schema, in every dimension that it may have.
template <class Check>
void with_every_number(const Check& check) {
  for (const Section& section : schema()) {
    for (const Key& key : section.keys) {
      if (!is_numeric(key)) continue;
      std::string choice;
      if (!key.only_for.empty()) {
        choice = key.only_for.front();
      } else if (!section.selector.empty()) {
        choice = section.find(section.selector)->choices.front();
      }
      const Example example(section, key, choice);
      SCOPED_TRACE(fmt::format("{} of {}", example.path(), choice));
      const std::vector<Dimension> any{dimension::length};
      for (const Dimension& dimension : key.type == KeyType::integer ? std::vector<Dimension>{dimension::none}
                                        : key.dimensions.empty()     ? any
                                                                     : key.dimensions) {
        check(key, dimension, example);
      }
    }
  }
}

double beyond(double end, double towards) {
  return std::abs(end) < 1e-12 ? std::copysign(1e-9, towards) : end + std::copysign(1e-6 * std::abs(end), towards);
}

TEST(Ranges, EveryNumberHasTwoEnds) {
  int numbers = 0;
  with_every_number([&](const Key& key, const Dimension& dimension, const Example&) {
    const Range range = key.range_of(dimension);
    EXPECT_TRUE(std::isfinite(range.least) && std::isfinite(range.most) && range.least < range.most);
    ++numbers;
  });
  EXPECT_GT(numbers, 100);
}

TEST(Ranges, NumbersAtTheEndsAreTakenAndThoseBeyondRefusedWithTheWholeRule) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  with_every_number([&](const Key& key, const Dimension& dimension, const Example& example) {
    const Range range = key.range_of(dimension);
    const double step = key.type == KeyType::integer ? 1 : 0;
    const std::string unit = unit_symbol(dimension);
    const auto expect = [&](double value, bool taken) {
      const std::string text = example.text(value, dimension), answer = example.answer(text);
      if (taken) {
        EXPECT_EQ(answer, "") << text;
        return;
      }
      EXPECT_THAT(answer, HasSubstr("x.toml:")) << text;
      EXPECT_THAT(answer, HasSubstr(example.path() + " = ")) << text;
      EXPECT_THAT(answer, HasSubstr(engineering(range.least, unit))) << text;
      EXPECT_THAT(answer, HasSubstr(engineering(range.most, unit))) << text;
      EXPECT_THAT(answer, HasSubstr("must be in ")) << text;
    };
    expect(range.least, !range.least_open);
    expect(range.most, !range.most_open);
    expect(step != 0 ? range.least - step : beyond(range.least, -1), false);
    expect(step != 0 ? range.most + step : beyond(range.most, 1), false);
    if (key.type == KeyType::integer) return;
    expect(1e300, false);
    expect(-1e300, false);
    if (range.least > 0) {
      expect(0.0, false);
      expect(std::numeric_limits<double>::denorm_min(), false);
    }
    if (key.is_bare_number()) {
      for (const double value : {infinity, -infinity, std::nan("")}) expect(value, false);
    }
  });
}

TEST(Ranges, WhatIsNoSuchNumberIsRefusedWithWhatIsExpected) {
  with_every_number([](const Key& key, const Dimension&, const Example& example) {
    for (const std::string& value :
         std::vector<std::string>{"true", "{}", "2020-01-01", "'nan m'", "'inf'", "''", "'1 furlong'", "[[]]", "'1 m^9 A^9'"}) {
      if (key.any_word && value.starts_with('\'')) continue;  // a name
      if (value == "'1 m^9 A^9'" && key.dimensions.empty() && key.type != KeyType::integer)
        continue;  // another key decides the dimension
      const std::string answer = example.answer(value);
      EXPECT_THAT(answer, HasSubstr("x.toml:")) << value;
      EXPECT_THAT(answer, HasSubstr(example.path() + " = ")) << value;
      EXPECT_THAT(answer, HasSubstr("expected ")) << value;
    }
  });
}

TEST(Ranges, TheManualHoldsTheExtentOfEveryKind) {
  std::ifstream stream(std::string(SOFTLAND_SOURCE_DIR) + "/docs/reference/keys.md");
  const std::string manual{std::istreambuf_iterator<char>(stream), {}};
  with_every_number([&](const Key& key, const Dimension& dimension, const Example&) {
    if (key.type == KeyType::integer || dimension == dimension::none) return;
    const Key positive{.name = "any", .dimensions = {dimension}, .range = {.least = 0, .least_open = true}};
    const std::string unit = unit_symbol(dimension);
    const Range range = positive.range_of(dimension);
    const std::string_view kind = noun(dimension).substr(noun(dimension).find(' ') + 1);
    EXPECT_THAT(manual,
                HasSubstr(fmt::format("| {} | {} | {} |", kind, engineering(range.least, unit), engineering(range.most, unit))));
  });
}

}  // namespace
}  // namespace softland::internal
