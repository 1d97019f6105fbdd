#include "config/plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <span>
#include <utility>

#include "base/csv.h"
#include "base/printable.h"
#include "base/random.h"
#include "base/read_file.h"
#include "base/require.h"
#include "base/shortened.h"
#include "base/split.h"
#include "base/trimmed.h"
#include "config/scene_file_impl.h"
#include "config/section_reader.h"

namespace softland {
namespace {

using internal::Key;
using internal::KeyType;
using internal::SectionReader;

constexpr std::string_view plan_section = "plan";
constexpr std::uint64_t most_values = 10'000'000;  // largest number of values of one variable, or rows of a list
constexpr std::uint64_t most_searched = 10'000'000;

std::vector<std::string> split_trimmed(std::string_view text, char at) {
  std::vector<std::string> parts = split(text, at);
  for (std::string& part : parts) part = std::string(trimmed(part));
  return parts;
}

/// Reads a whole number that consists of digits only; none for any other text.
std::optional<std::uint64_t> whole_number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Reads a quantity as parse_quantity() does, but also without the space before the unit, as typed in a shell.
Quantity plan_quantity(std::string_view given) {
  const std::string_view text = trimmed(given);
  double ignored = 0;
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* end = std::from_chars(begin, text.data() + text.size(), ignored).ptr;
  const auto length = static_cast<std::size_t>(end - text.data());
  if (end == begin || length >= text.size() || text[length] == ' ') return parse_quantity(text);
  return parse_quantity(fmt::format("{} {}", text.substr(0, length), text.substr(length)));
}

/// Returns the value rounded to 15 significant digits.
double in_few_digits(double value) {
  const std::string text = fmt::format("{:.15g}", value);
  double rounded = value;
  std::from_chars(text.data(), text.data() + text.size(), rounded);
  return rounded;
}

/// Returns the value of a variable at the share `t` of its range, 0 to 1.
double between(const PlanVariable& variable, double t) {
  const double low = variable.low, high = variable.high;
  if (t == 0) return low;
  if (t == 1) return high;
  return in_few_digits(variable.is_logarithmic ? low * std::pow(high / low, t) : std::lerp(low, high, t));
}

/// Returns a value as canonical text in the unit of its variable.
std::string value_text(const PlanVariable& variable, double value) {
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
    std::optional<Quantity> base = {};  ///< its value in the scene
  };

  /// Finds the keys of an entry by its name. Throws InvalidInput with the rule only.
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

/// Reads one entry of a plan to a variable.
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

  /// Reads the values A,B,C: words of a choice, or numbers.
  PlanVariable of_list(const std::vector<std::string>& texts) && {
    const KeyType type = keys_.front().schema->type;
    if (type == KeyType::choice || type == KeyType::flag) {
      for (const std::string& text : texts) take_word(text, type);
    } else {
      for (const Quantity& one : read(texts)) variable_.values.push_back(one.value);
    }
    return finish();
  }

  /// Reads a range LOW:HIGH:N of a grid or, if `is_sample`, LOW:HIGH of a box. The suffix :log selects equal ratios.
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
    require(parts.size() == due, is_sample ? "must be KEY=LOW:HIGH or KEY=LOW:HIGH:log where points are sampled"
                                           : "must be KEY=LOW:HIGH:N, KEY=LOW:HIGH:N:log or KEY=A,B,C");
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

  /// Checks that equal steps from one whole number to another give whole numbers: the number of steps must divide the range.
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

  /// Reads quantities of one of the dimensions that the key may have. If the key has a unit, plain numbers and percentages are
  /// factors on its value.
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
    // A position on the beam may be a length in the scene; a percentage is then a factor on that length.
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

/// Puts the place of an entry in front of messages about it.
template <class Read>
auto at_place(const PlanRequest& request, std::string_view key, std::size_t number, Read&& read) {
  try {
    return read();
  } catch (const InvalidInput& error) {
    throw InvalidInput(fmt::format("{}: {}", request.place(key, number), printable_line(error.what())));
  }
}

/// Splits "KEY=...".
std::pair<std::string, std::string> name_and_values(const std::string& entry) {
  const std::size_t equals = entry.find('=');
  require(equals != std::string::npos && equals > 0,
          "must be KEY=LOW:HIGH:N, KEY=LOW:HIGH:N:log or KEY=A,B,C, or KEY*KEY=VALUES with the values of one factor");
  std::string name;
  for (const std::string& key : split_trimmed(std::string_view(entry).substr(0, equals), '*'))
    name += (name.empty() ? "" : "*") + key;
  return {name, entry.substr(equals + 1)};
}

}  // namespace

std::string PlanVariable::unit() const { return unit_symbol(dimension); }

Plan::Plan(const PlanRequest& request)
    : base_(canonical(request.scene, "scene")),
      study_(request.study),
      options_(request.options),
      seed_(request.seed),
      pareto_(request.pareto) {
  if (!request.columns.empty()) {
    require(request.sample.empty() && request.vary.empty(),
            [&] { return fmt::format("{}: gives all points: nothing else may vary or be sampled", request.place("list", 0)); });
    read_rows(request);
  } else {
    if (!request.sample.empty()) at_place(request, "sample", 0, [&] { read_sample(request); });
    at_place(request, is_search_ ? "sample" : "pareto", 0, [&] {
      require(is_search_ == !pareto_.empty(),
              "a search for a Pareto front needs both its figures (pareto) and its number of points (sample nsga2:N)");
    });
    read_variables(request);
  }
  std::set<std::string> seen;
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    for (const PlanKey& key : variables_[i].keys) {
      require(seen.insert(fmt::format("{}[{}]", key.path, key.element)).second, [&] {
        return fmt::format("{}: {} varies already", request.place(request.columns.empty() ? "vary" : "list", i), key.path);
      });
    }
  }
  count_points();
  text_ = canonical_text();
}

void Plan::read_sample(const PlanRequest& request) {
  const std::vector<std::string> parts = split_trimmed(request.sample, ':');
  const bool is_latin = parts.front() == "lhs";
  is_search_ = parts.front() == "nsga2";
  const Named<PointSet>* kind = find_named(point_sets, is_latin ? "latin_hypercube" : is_search_ ? "sobol" : parts.front());
  require(kind != nullptr && parts.size() == 2, "must be sobol:N, lhs:N or, for a Pareto front, nsga2:N with N points");
  const auto count = whole_number(parts[1]);
  require(count && *count >= 1 && *count <= SamplePoints::largest_size, [&] {
    return fmt::format("'{}' must be a whole number of points from 1 to {}", shortened(parts[1]), SamplePoints::largest_size);
  });
  sample_ = kind->value;
  points_ = *count;
}

void Plan::read_variables(const PlanRequest& request) {
  const KeyFinder finder(base_);
  for (std::size_t i = 0; i < request.vary.size(); ++i) {
    at_place(request, "vary", i, [&] {
      const auto [name, values] = name_and_values(request.vary[i]);
      EntryReader reader(finder, name);
      std::vector<std::string> range = split_trimmed(values, ':');
      if (range.size() > 1) {
        variables_.push_back(std::move(reader).of_range(std::move(range), sample_.has_value()));
      } else {
        require(!sample_, "must be KEY=LOW:HIGH where points are sampled");
        variables_.push_back(std::move(reader).of_list(split_trimmed(values, ',')));
      }
    });
  }
  require(!variables_.empty() || !sample_,
          [&] { return fmt::format("{}: there is nothing to sample: give --vary KEY=LOW:HIGH", request.place("sample", 0)); });
}

void Plan::read_rows(const PlanRequest& request) {
  const KeyFinder finder(base_);
  std::vector<double> scale;
  at_place(request, "list", 0, [&] {
    for (const std::string& column : request.columns) {
      // The name is "structure.length [um]"; unlike the bracket of a unit, that of a list element follows without a blank.
      const std::size_t bracket = column.find(" [");
      const std::string name(trimmed(std::string_view(column).substr(0, bracket)));
      std::string unit;
      if (bracket != std::string::npos) {
        require(column.ends_with(']'), [&] { return fmt::format("'{}' must be KEY or KEY [UNIT]", shortened(column)); });
        unit = column.substr(bracket + 2, column.size() - bracket - 3);
      }
      variables_.push_back(EntryReader(finder, name).of_list({"1 " + unit}));
      require(variables_.back().words.empty(), [&] { return fmt::format("{} must be a number", name); });
      scale.push_back(variables_.back().values.front());
      variables_.back().values.clear();
    }
  });
  for (const std::vector<double>& row : request.rows) {
    std::vector<double> values;
    for (std::size_t i = 0; i < row.size(); ++i) {
      // Numbers are scaled in decimal, so that 245 [um] becomes the double nearest to 245e-6.
      values.push_back(scale[i] == 1 ? row[i] : in_few_digits(row[i] * scale[i]));
      require(!variables_[i].is_whole || values.back() == std::round(values.back()), [&] {
        return fmt::format("{}: {} = {} must be a whole number", request.place("list", 0), variables_[i].name, values.back());
      });
    }
    rows_.push_back(std::move(values));
  }
  require(!rows_.empty(), [&] { return fmt::format("{}: must have at least one row of points", request.place("list", 0)); });
}

void Plan::count_points() {
  if (!rows_.empty()) {
    points_ = rows_.size();
  } else if (is_search_) {
    require(points_ <= most_searched, [&] { return fmt::format("a search must have at most {} points", most_searched); });
  } else if (sample_) {
    sampled_.emplace(*sample_, variables_.size(), seed_, Stream::plan, points_);
  } else {
    for (const PlanVariable& variable : variables_) {
      require(points_ <= most_points / variable.values.size(),
              [&] { return fmt::format("the plan must have at most {} points", most_points); });
      points_ *= variable.values.size();
    }
  }
}

std::vector<double> Plan::values_in_box(std::vector<double> place) const {
  for (std::size_t i = 0; i < place.size(); ++i) {
    const PlanVariable& v = variables_[i];
    place[i] = v.is_whole ? std::min(v.high, std::floor(v.low + place[i] * (v.high - v.low + 1))) : between(v, place[i]);
  }
  return place;
}

std::vector<double> Plan::values(std::uint64_t k) const {
  require(k < points_, [&] { return fmt::format("point {} must be below {}: points are counted from 0", k, points_); });
  require(!is_search_, "the points of a search for a Pareto front are not known before they are computed");
  if (!rows_.empty()) return rows_[k];
  std::vector<double> values(variables_.size());
  if (sampled_) {
    sampled_->point(k, values);
    return values_in_box(std::move(values));
  }
  for (std::size_t i = values.size(); i-- > 0;) {
    const std::vector<double>& all = variables_[i].values;
    values[i] = all[k % all.size()];
    k /= all.size();
  }
  return values;
}

SceneFile Plan::scene(const std::vector<double>& values) const {
  SceneFile file = base_;
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    const PlanVariable& variable = variables_[i];
    for (const PlanKey& key : variable.keys) {
      if (!variable.words.empty()) {
        const std::string& word = variable.words.at(static_cast<std::size_t>(values[i]) - 1);
        const bool is_flag = word == "true" || word == "false";
        file.assign(key.path, is_flag ? SceneValue(word == "true") : SceneValue(word));
      } else if (variable.is_whole && !variable.is_factor) {
        file.assign(key.path, static_cast<int>(values[i]));
      } else if (variable.is_factor) {
        file.assign(key.path, {.value = key.base.value * values[i], .dimension = key.base.dimension}, key.element);
      } else {
        file.assign(key.path, {.value = values[i], .dimension = variable.dimension}, key.element);
      }
    }
  }
  return file;
}

std::string Plan::canonical_text() const {
  const auto list = [](const auto& all, auto&& text) {
    std::string joined;
    for (const auto& one : all) joined += (joined.empty() ? "" : ", ") + text(one);
    return "[" + joined + "]";
  };
  std::string text = fmt::format("[{}]\nstudy = {}\n", plan_section, internal::toml_string(study_));
  std::vector<std::string> others;
  for (const auto& [name, value] : options_) {
    if (std::ranges::find(plan_options, name) != std::end(plan_options))
      text += fmt::format("{} = {}\n", name, internal::toml_string(value));
    else
      others.push_back(internal::toml_string(name + "=" + value));
  }
  if (!others.empty()) text += fmt::format("options = {}\n", list(others, [](const std::string& one) { return one; }));
  text += fmt::format("seed = \"{}\"\n", seed_);
  if (sample_)
    text += fmt::format("sample = \"{}:{}\"\n",
                        is_search_                              ? "nsga2"
                        : *sample_ == PointSet::latin_hypercube ? "lhs"
                                                                : name_of(point_sets, *sample_),
                        points_);
  if (is_search_) text += fmt::format("pareto = {}\n", internal::toml_string(pareto_));
  if (!rows_.empty()) {
    text += fmt::format("columns = {}\nrows = {}\n",
                        list(variables_,
                             [](const PlanVariable& v) {
                               return internal::toml_string(v.unit().empty() ? v.name : fmt::format("{} [{}]", v.name, v.unit()));
                             }),
                        list(rows_, [&](const std::vector<double>& row) {
                          return list(row, [](double value) { return internal::inline_text(toml::value<double>(value)); });
                        }));
  } else {
    text += fmt::format("vary = {}\n", list(variables_, [&](const PlanVariable& v) {
                          const std::string log = v.is_logarithmic ? ":log" : "";
                          const std::string factor = v.is_factor && v.keys.size() == 1 ? " %" : "";
                          const auto number = [&](double value) {
                            return factor.empty() ? value_text(v, value) : percent_text(value);
                          };
                          if (sample_)
                            return internal::toml_string(fmt::format("{}={}:{}{}", v.name, number(v.low), number(v.high), log));
                          std::vector<std::string> values;
                          for (const double value : v.values) values.push_back(number(value));
                          return internal::toml_string(fmt::format("{}={}", v.name, fmt::join(values, ",")));
                        }));
  }
  return text + fmt::format("scene_text = {}\n", internal::toml_string(base_.text()));
}

bool is_plan(const SceneFile& file) { return file.impl().find({std::string(plan_section)}) != nullptr; }

void read_list(PlanRequest& request, const std::string& path) {
  const std::string content = read_file(path);
  std::string_view rest = content;
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (rest.starts_with(byte_order_mark)) rest.remove_prefix(byte_order_mark.size());
  std::string_view header;
  while (!rest.empty() && (header.empty() || header.starts_with('#'))) {
    const std::size_t end = rest.find('\n');
    header = trimmed(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  request.columns = split_trimmed(header, ',');
  read_csv(content, path, request.columns, "keys of the scene with their units, \"structure.length [um]\"",
           [&](std::span<const double> row, const CsvPlace& place) {
             require(request.rows.size() < most_values,
                     [&] { return fmt::format("{}: more than {} rows", place(), most_values); });
             request.rows.emplace_back(row.begin(), row.end());
           });
}

namespace {

/// Reads the keys of [plan].
class PlanReader {
 public:
  explicit PlanReader(const SceneFile& file) : file_(file.impl()) {
    const toml::node* section = file_.find({std::string(plan_section)});
    if (!section->is_table()) file_.fail(std::string(plan_section), "expected a section [plan]");
    for (const auto& [name, node] : file_.root) {
      if (name.str() != plan_section)
        file_.fail(internal::join_path("", name.str()),
                   "a plan file must hold the section [plan] only; the scene is a separate file");
    }
    std::vector<std::string_view> known{"scene", "scene_text", "set",  "study", "vary",   "sample",
                                        "list",  "columns",    "rows", "seed",  "pareto", "options"};
    known.insert(known.end(), std::begin(plan_options), std::end(plan_options));
    for (const auto& [name, node] : *section->as_table()) {
      if (std::find(known.begin(), known.end(), name.str()) == known.end())
        fail(name.str(), "unknown key" + internal::hint(name.str(), known));
    }
  }

  [[nodiscard]] const toml::node* find(std::string_view key) const {
    return file_.find({std::string(plan_section), std::string(key)});
  }
  [[noreturn]] void fail(std::string_view key, std::string_view rule) const { file_.fail(path(key), rule); }
  [[nodiscard]] static std::string path(std::string_view key) { return internal::join_path(std::string(plan_section), key); }

  /// Returns the value of a key as text; numbers and flags as they are written.
  [[nodiscard]] std::optional<std::string> text(std::string_view key) const {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    if (const auto* word = node->as_string()) return word->get();
    if (!node->is_number() && !node->is_boolean()) fail(key, "expected a text or a number");
    return internal::inline_text(*node);
  }
  [[nodiscard]] std::vector<std::string> texts(std::string_view key) const {
    std::vector<std::string> all;
    const toml::node* node = find(key);
    if (node == nullptr) return all;
    if (node->is_string()) return {node->as_string()->get()};
    if (!node->is_array()) fail(key, "expected a list of texts");
    for (const toml::node& one : *node->as_array()) {
      if (!one.is_string()) fail(key, fmt::format("value {}: expected a text in quotes", all.size() + 1));
      all.push_back(one.as_string()->get());
    }
    return all;
  }
  [[nodiscard]] std::vector<std::vector<double>> rows(std::size_t columns) const {
    std::vector<std::vector<double>> all;
    const toml::node* node = find("rows");
    if (node == nullptr) return all;
    if (!node->is_array()) fail("rows", "expected a list of rows");
    for (const toml::node& row : *node->as_array()) {
      std::vector<double> values;
      if (row.is_array()) {
        for (const toml::node& one : *row.as_array())
          values.push_back(one.value<double>().value_or(std::numeric_limits<double>::quiet_NaN()));
      }
      const bool is_row = values.size() == columns && columns > 0 &&
                          std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
      if (!is_row) fail("rows", fmt::format("row {}: expected {} numbers, one for each of 'columns'", all.size() + 1, columns));
      all.push_back(std::move(values));
    }
    return all;
  }
  [[nodiscard]] SceneFile scene() const {
    const std::optional<std::string> name = text("scene"), own = text("scene_text");
    if (name.has_value() == own.has_value())
      file_.fail_section(std::string(plan_section), "needs either 'scene' (the name of a file) or 'scene_text'");
    try {
      SceneFile scene = own ? SceneFile::parse(*own, "scene", file_.directory) : SceneFile::load(file_.directory / *name);
      for (const std::string& assignment : texts("set")) scene.set(assignment);
      return scene;
    } catch (const InvalidInput& error) {
      fail(own ? "scene_text" : "scene", error.what());
    }
  }
  [[nodiscard]] PlanRequest::Place place() const {
    // The places are copied, because the file may not exist any more when a message needs one.
    std::map<std::string, std::string, std::less<>> places;
    for (const auto& [key, node] : *find_section()) {
      const std::string at = path(key.str());
      places[std::string(key.str())] = fmt::format("{}: {}", file_.origin(at).text, file_.written(at));
    }
    return [places, entries = texts("vary"), name = file_.name](std::string_view key, std::size_t number) {
      std::string_view written = key == "list" && !places.contains("list") ? std::string_view("columns") : key;
      const auto found = places.find(written);
      if (found == places.end()) return name;
      if (key != "vary" || number >= entries.size()) return found->second;
      return fmt::format("{}: value {}, {}", found->second, number + 1, shortened(entries[number]));
    };
  }

 private:
  [[nodiscard]] const toml::table* find_section() const { return file_.find({std::string(plan_section)})->as_table(); }
  const SceneFile::Impl& file_;
};

}  // namespace

void add_options(PlanRequest& request, const std::vector<std::string>& told) {
  for (std::size_t k = 0; k < told.size(); ++k) {
    const std::size_t equals = told[k].find('=');
    require(equals != std::string::npos && equals > 0, [&] {
      return fmt::format("{}: must be NAME=VALUE, such as \"impact-velocity=1 mm/s\"", request.place("options", k));
    });
    request.options[told[k].substr(0, equals)] = told[k].substr(equals + 1);
  }
}

PlanRequest read_plan(const SceneFile& file) {
  require(is_plan(file), [&] { return fmt::format("{}: has no section [plan]", file.name()); });
  const PlanReader in(file);
  PlanRequest request{.scene = in.scene()};
  request.place = in.place();
  request.vary = in.texts("vary");
  request.sample = in.text("sample").value_or("");
  request.pareto = in.text("pareto").value_or("");
  request.study = in.text("study").value_or(request.study);
  for (const std::string_view option : plan_options) {
    if (const std::optional<std::string> value = in.text(option)) request.options[std::string(option)] = *value;
  }
  add_options(request, in.texts("options"));
  if (const std::optional<std::string> seed = in.text("seed")) {
    const auto number = whole_number(*seed);
    if (!number) in.fail("seed", "must be a whole number from 0 on");
    request.seed = *number;
  }
  request.columns = in.texts("columns");
  request.rows = in.rows(request.columns.size());
  if (in.find("list") != nullptr) {
    if (!request.columns.empty()) in.fail("list", "must not be given together with 'columns'");
    try {
      read_list(request, (file.impl().directory / in.text("list").value()).string());
    } catch (const InvalidInput& error) {
      in.fail("list", error.what());
    }
  }
  return request;
}

}  // namespace softland
