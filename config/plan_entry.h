// Reads the entries KEY=VALUES of a plan of a design-space exploration (config/plan.h): the keys of the scene that vary, and
// their values or range.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <span>
#include <utility>

#include "base/require.h"
#include "base/shortened.h"
#include "base/split.h"
#include "base/trimmed.h"
#include "config/plan.h"
#include "config/scene_file_impl.h"
#include "config/section_reader.h"

namespace softland::internal {

inline constexpr std::string_view plan_section = "plan";
inline constexpr std::uint64_t most_values = 10'000'000;  // largest number of values of a variable, or of rows of a list

inline std::vector<std::string> split_trimmed(std::string_view text, char at) {
  std::vector<std::string> parts = split(text, at);
  for (std::string& part : parts) part = std::string(trimmed(part));
  return parts;
}

/// Reads a whole number that consists of digits only; none for any other text.
inline std::optional<std::uint64_t> whole_number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Reads a quantity as parse_quantity() does, but also without the space before the unit, as typed in a shell.
inline Quantity plan_quantity(std::string_view given) {
  const std::string_view text = trimmed(given);
  double ignored = 0;
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* end = std::from_chars(begin, text.data() + text.size(), ignored).ptr;
  const auto length = static_cast<std::size_t>(end - text.data());
  if (end == begin || length >= text.size() || text[length] == ' ') return parse_quantity(text);
  return parse_quantity(fmt::format("{} {}", text.substr(0, length), text.substr(length)));
}

/// Returns the value rounded to 15 significant digits, which removes the rounding errors of a conversion of units.
inline double in_few_digits(double value) {
  const std::string text = fmt::format("{:.15g}", value);
  double rounded = value;
  std::from_chars(text.data(), text.data() + text.size(), rounded);
  return rounded;
}

/// Returns the value of a variable at the share `t` of its range: `low` for 0, `high` for 1.
inline double between(const PlanVariable& variable, double t) {
  const double low = variable.low, high = variable.high;
  if (t == 0) return low;
  if (t == 1) return high;
  return in_few_digits(variable.is_logarithmic ? low * std::pow(high / low, t) : std::lerp(low, high, t));
}

/// Returns a value of a variable as the scene writes it: a word, or a number with its SI unit that reads back to the same bits.
inline std::string value_text(const PlanVariable& variable, double value) {
  return variable.words.empty() ? quantity_text(value, variable.dimension)
                                : variable.words.at(static_cast<std::size_t>(value) - 1);
}

/// Finds the keys of a scene that an entry of a plan names.
class KeyFinder {
 public:
  explicit KeyFinder(const SceneFile& base) : file_(base.impl()) {}

  struct Found {
    PlanKey key;
    const Key* schema = nullptr;
    std::optional<Quantity> base = {};  ///< value of the key in the scene
  };

  /// Finds the key of the scene that `name` names, such as "electrode.main.span[2]". Throws InvalidInput; the caller adds the
  /// place of the plan's entry to the message.
  [[nodiscard]] Found find(const std::string& name) const {
    Found found{.key = {.path = name}};
    if (const std::size_t bracket = name.rfind('['); bracket != std::string::npos && name.ends_with(']')) {
      const auto element = whole_number(std::string_view(name).substr(bracket + 1, name.size() - bracket - 2));
      require(element && *element >= 1,
              [&] { return fmt::format("'{}' must name an element of a list, such as span[2]", name); });
      found.key = {.path = name.substr(0, bracket), .element = *element};
    }
    const std::vector<std::string> parts = internal::split_path(found.key.path);
    const std::string entry = parts.size() > 1 ? parts[1] : std::string();
    const internal::Section* section = internal::find_section(parts.front(), entry);
    require(section != nullptr, [&] {
      std::vector<std::string_view> known;
      for (const internal::Section& one : internal::schema()) known.push_back(one.name);
      return fmt::format("'{}': unknown section{}", shortened(name), internal::hint(parts.front(), known));
    });
    const bool named = file_.is_named(*section);
    const std::size_t depth = named ? 3 : 2;
    const auto is_no_key = [&] {
      return fmt::format("'{}' must name a key of the section, in the form {}.{}KEY", shortened(name), parts.front(),
                         named ? "NAME." : "");
    };
    require(parts.size() == depth || (parts.size() > depth && internal::find_key(parts) != nullptr), is_no_key);
    require(section->always_in_force || file_.find({parts.begin(), parts.end() - 1}) != nullptr,
            [&] { return fmt::format("'{}': the scene does not have this section; --set adds one", shortened(name)); });
    const SectionReader whole(file_, parts.front(), named ? std::string_view(entry) : std::string_view());
    const auto holder = whole.holder(std::span(parts).subspan(depth - 1));
    require(holder.has_value(), is_no_key);
    const SectionReader& in = holder->first;
    found.schema = in.find(parts.back());
    require(found.schema != nullptr, [&] {
      std::vector<std::string_view> known;
      for (const Key& one : in.keys()) known.push_back(one.name);
      return fmt::format("'{}': unknown key{}", shortened(name), internal::hint(parts.back(), known));
    });
    const bool is_choice = parts.size() == depth && !section->selector.empty() && parts.back() != section->selector;
    require(!is_choice || found.schema->belongs_to(in.text(section->selector)),
            [&] { return fmt::format("{} does not belong to {}", found.key.path, in.written(section->selector)); });
    look_at(in, found);
    return found;
  }

 private:
  static void look_at(const SectionReader& in, Found& found) {
    const Key& key = *found.schema;
    const bool is_one = key.may_be_one && found.key.element == 0 && in.has_value(key.name) && in.quantities(key.name).size() == 1;
    const bool is_list = key.type == KeyType::quantities && !is_one && (!key.may_be_one || in.is_list(key.name));
    require(key.type != KeyType::text && key.type != KeyType::texts,
            [&] { return fmt::format("{} is a text and cannot vary", found.key.path); });
    require(key.part == nullptr, [&] { return fmt::format("{} is a table: name one of its keys", found.key.path); });
    require(is_list || found.key.element == 0, [&] { return fmt::format("{} must be a list", found.key.path); });
    if (is_list) {
      const std::size_t size = in.has_value(key.name) ? in.quantities(key.name).size() : 0;
      require(found.key.element >= 1 && found.key.element <= size, [&] {
        return fmt::format("{} is a list of {}: name one element, such as {}[1]", found.key.path, size, found.key.path);
      });
      require(!in.is_nested(key.name),
              [&] { return fmt::format("{} holds several pads, of which none can vary alone", found.key.path); });
      found.base = in.quantities(key.name)[found.key.element - 1];
    } else if ((key.type == KeyType::quantity || key.may_be_one) && in.has_value(key.name) && !in.is_word(key.name)) {
      found.base = in.quantities(key.name).front();
    }
  }

  const SceneFile::Impl& file_;
};

/// Reads one entry KEY=VALUES of a plan into a variable; `name` is the text before "=".
class EntryReader {
 public:
  EntryReader(const KeyFinder& finder, const std::string& name) {
    variable_.name = name;
    for (const std::string& key : split_trimmed(name, '*')) keys_.push_back(finder.find(key));
    std::set<std::string> names;
    for (const std::string& key : split_trimmed(name, '*'))
      require(names.insert(key).second, [&] { return fmt::format("names {} twice", key); });
    const KeyType type = keys_.front().schema->type;
    if (type == KeyType::choice || type == KeyType::flag)
      require(keys_.size() == 1, [&] { return fmt::format("{} must be a number, because a factor multiplies it", name); });
    variable_.is_whole = type == KeyType::integer;
  }

  /// Reads the values A,B,C of an entry of a plan: numbers, or words for a key whose value is a word, true or false.
  PlanVariable of_list(const std::vector<std::string>& texts) && {
    const KeyType type = keys_.front().schema->type;
    if (type == KeyType::choice || type == KeyType::flag) {
      for (const std::string& text : texts) take_word(text, type);
    } else {
      for (const Quantity& one : read(texts)) variable_.values.push_back(one.value);
    }
    return finish();
  }

  /// Reads the range of an entry of a plan: LOW:HIGH:N for N values on a grid or, if `is_sample`, LOW:HIGH for a variable that
  /// a point set samples. The suffix :log selects equal ratios instead of equal steps.
  PlanVariable of_range(std::vector<std::string> parts, bool is_sample) && {
    const KeyType type = keys_.front().schema->type;
    require(type != KeyType::choice && type != KeyType::flag, [&] {
      return fmt::format("{} must be a number to have a range: list its values instead, as in A,B,C", variable_.name);
    });
    if (parts.back() == "log") {
      variable_.is_logarithmic = true;
      parts.pop_back();
    }
    const std::size_t due = is_sample ? 2 : 3;
    require(parts.size() == due,
            is_sample
                ? "must be KEY=LOW:HIGH or KEY=LOW:HIGH:log where points are sampled"
                : "must be KEY=LOW:HIGH:N, KEY=LOW:HIGH:N:log or KEY=A,B,C; KEY=LOW:HIGH requires a sample, such as sobol:64");
    const std::vector<Quantity> ends = read({parts[0], parts[1]});
    variable_.low = ends[0].value;
    variable_.high = ends[1].value;
    if (variable_.is_logarithmic) {
      require(variable_.low * variable_.high > 0, "equal ratios (log) require two ends other than 0, of the same sign");
      require(!variable_.is_whole, "a whole number must vary in equal steps: omit log");
    }
    if (!is_sample) fill(parts[2]);
    return finish();
  }

 private:
  void take_word(const std::string& text, KeyType type) {
    const Key& key = *keys_.front().schema;
    const std::vector<std::string_view> known =
        type == KeyType::flag ? std::vector<std::string_view>{"true", "false"} : key.choices;
    require(std::find(known.begin(), known.end(), text) != known.end(),
            [&] { return fmt::format("'{}': unknown value{}", shortened(text), internal::hint(text, known)); });
    variable_.words.push_back(text);
    variable_.values.push_back(static_cast<double>(variable_.words.size()));
  }

  void fill(const std::string& count_text) {
    const auto count = whole_number(count_text);
    require(count && *count >= 1 && *count <= most_values, [&] {
      return fmt::format("'{}' must be a whole number of values from 1 to {}", shortened(count_text), most_values);
    });
    require(*count > 1 || variable_.low == variable_.high, "one value cannot be at both ends: give two or more");
    for (std::uint64_t i = 0; i < *count; ++i)
      variable_.values.push_back(*count == 1 ? variable_.low
                                             : between(variable_, static_cast<double>(i) / static_cast<double>(*count - 1)));
    if (variable_.is_whole) require_whole(*count);
  }

  /// Checks that the `count` evenly spaced values of a whole-number variable are whole: count - 1 must divide the range.
  void require_whole(std::uint64_t count) const {
    if (count == 1) return;
    const auto way = static_cast<std::uint64_t>(std::abs(variable_.high - variable_.low));
    if (way % (count - 1) == 0 && way > 0) return;
    std::vector<std::uint64_t> counts;
    for (std::uint64_t steps = 1; steps <= std::min(way, most_values - 1) && counts.size() < 12; ++steps) {
      if (way % steps == 0) counts.push_back(steps + 1);
    }
    throw InvalidInput(counts.empty() ? std::string("the range holds fewer whole numbers: give a smaller number of values")
                                      : fmt::format("{} values in equal steps from {} to {} are not whole numbers; "
                                                    "{} values are",
                                                    count, variable_.low, variable_.high, fmt::join(counts, ", ")));
  }

  /// Reads quantities of one of the dimensions that the varied key may have. If the key has a unit, plain numbers and
  /// percentages are factors on the value that the key has in the scene.
  std::vector<Quantity> read(const std::vector<std::string>& texts) {
    std::vector<Quantity> all;
    bool is_percent = false;
    for (const std::string& text : texts) {
      try {
        all.push_back(plan_quantity(text));
      } catch (const InvalidInput& error) {
        throw InvalidInput(fmt::format("'{}': {}{}", shortened(text), error.what(), expected()));
      }
      is_percent = is_percent || text.find('%') != std::string::npos;
      require(all.back().dimension == all.front().dimension, [&] {
        return fmt::format("'{}' is {}, but '{}' is {}", shortened(texts.front()), describe(all.front().dimension),
                           shortened(text), describe(all.back().dimension));
      });
      if (variable_.is_whole)
        require(all.back().value == std::round(all.back().value),
                [&] { return fmt::format("'{}' must be a whole number", shortened(text)); });
    }
    const Dimension given = all.front().dimension;
    const std::vector<Dimension>& allowed = keys_.front().schema->dimensions;
    const std::optional<Quantity>& base = keys_.front().base;
    // If the scene gives a position on the beam as a length, a percentage in the plan is a factor on this length. If the scene
    // gives a percentage of the beam's length, so does the plan.
    const bool is_of_value = keys_.front().schema->bound.place != nullptr && given == dimension::none && is_percent && base &&
                             base->dimension != dimension::none;
    const bool fits = variable_.is_whole
                          ? given == dimension::none
                          : allowed.empty() || (!is_of_value && std::ranges::find(allowed, given) != allowed.end());
    variable_.dimension = given;
    variable_.is_factor = keys_.size() > 1 || (!fits && given == dimension::none && is_percent);
    if (variable_.is_factor) {
      require(given == dimension::none, [&] {
        return fmt::format("several keys vary by one factor: '{}' must be a plain number or a percentage",
                           shortened(texts.front()));
      });
      return all;
    }
    require(fits, [&] {
      const Dimension due = allowed.empty() ? dimension::none : allowed.front();
      return given == dimension::none
                 ? fmt::format("'{}': no unit{}", shortened(texts.front()), expected())
                 : fmt::format("'{}': expected {}, got {}", shortened(texts.front()), describe(due), describe(given));
    });
    return all;
  }

  [[nodiscard]] std::string expected() const {
    const Key& key = *keys_.front().schema;
    const std::vector<Dimension>& allowed = key.dimensions;
    if (allowed.empty() || allowed.front() == dimension::none || example(allowed.front()).empty()) return {};
    return fmt::format(" (expected {} such as {}, or a percentage of the scene's value)", noun(allowed.front()),
                       key.example_of(allowed.front()));
  }

  PlanVariable finish() {
    for (KeyFinder::Found& found : keys_) {
      if (variable_.is_factor) {
        require(found.base && found.base->value != 0, [&] {
          return fmt::format("{} {} in the scene: no factor changes it", found.key.path, found.base ? "is 0" : "has no value");
        });
        found.key.base = *found.base;
      }
      variable_.keys.push_back(std::move(found.key));
    }
    return std::move(variable_);
  }

  PlanVariable variable_;
  std::vector<KeyFinder::Found> keys_;
};

}  // namespace softland::internal
