#include "config/section_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/engineering.h"
#include "base/require.h"
#include "config/scene.h"

namespace softland::internal {
namespace {

/// Returns for messages what value a key needs, for example `a length such as "2 um"`.
std::string wanted(const Key& key) {
  switch (key.type) {
    case KeyType::text:
      return "a text in quotes";
    case KeyType::texts:
      return "a list of texts";
    case KeyType::flag:
      return "true or false";
    case KeyType::integer:
      if (key.any_word) return "a name in quotes or a whole number";
      return std::accumulate(key.words.begin(), key.words.end(), std::string("a whole number"),
                             [](const std::string& all, std::string_view word) { return all + " or " + toml_string(word); });
    case KeyType::choice:
      return fmt::format("one of {}", fmt::join(key.choices, ", "));
    case KeyType::table:
      return std::accumulate(key.words.begin(), key.words.end(), fmt::format("keys in braces such as {}", key.like),
                             [](const std::string& all, std::string_view word) { return all + " or " + toml_string(word); });
    case KeyType::tables:
      return fmt::format("a list such as {}", key.like);
    case KeyType::quantity:
    case KeyType::quantities:
      break;
  }
  if (key.dimensions.empty()) return "a quantity with its unit";
  if (key.is_bare_number()) {
    return key.type == KeyType::quantities ? "a list such as [0.02, 0.02]" : "a plain number such as 0.02";
  }
  std::vector<std::string> examples;
  for (const Dimension& dimension : key.dimensions) examples.push_back(toml_string(key.example_of(dimension)));
  if (key.type == KeyType::quantities && !key.may_be_one)
    return fmt::format("a list such as [{}, {}]", examples.front(),
                       key.words.empty() ? examples.front() : toml_string(key.words.front()));
  for (const std::string_view word : key.words) examples.push_back(toml_string(word));
  return fmt::format("{} such as {}", noun(key.dimensions.front()), fmt::join(examples, " or "));
}

std::string expected(const Key& key) { return fmt::format(" (expected {})", wanted(key)); }

Quantity parse_number(const Key& key, const toml::node& node) {
  Quantity quantity;
  bool has_unit = false;
  if (const auto* text = node.as_string()) {
    try {
      quantity = parse_quantity(text->get());
    } catch (const InvalidInput& error) {
      throw InvalidInput(error.what() + expected(key));
    }
    has_unit = quantity.dimension != dimension::none || text->get().find('%') != std::string::npos;
  } else if (node.is_number()) {
    quantity.value = node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
  } else {
    const bool is_advised = node.is_array() && !key.if_list.empty();
    throw InvalidInput("not a number with a unit" + expected(key) + (is_advised ? fmt::format("; {}", key.if_list) : ""));
  }
  const bool may_be_bare = key.is_bare_number() || (!key.dimensions.empty() && key.dimensions.front() == dimension::none);
  if (!has_unit && !may_be_bare) throw InvalidInput("no unit" + expected(key));
  const auto& allowed = key.dimensions;
  if (!allowed.empty() && std::find(allowed.begin(), allowed.end(), quantity.dimension) == allowed.end()) {
    throw InvalidInput(fmt::format("expected {}, got {}", describe(allowed.front()), describe(quantity.dimension)));
  }
  const Range range = key.range_of(quantity.dimension);
  if (!range.contains(quantity.value)) {
    const std::string rule = range.rule(unit_symbol(quantity.dimension));
    throw InvalidInput(key.beyond.empty() ? rule : fmt::format("{}; {}", rule, key.beyond));
  }
  return quantity;
}

Quantity parse_element(const Key& key, const toml::node& node) {
  const auto* text = node.as_string();
  const bool is_tip = text && text->get() == tip && std::ranges::find(key.words, tip) != key.words.end();
  return is_tip ? Quantity{.value = 1} : parse_number(key, node);
}

std::vector<Quantity> parse_list(const Key& key, const toml::array& array) {
  std::vector<Quantity> values;
  const auto in_list = [](std::size_t number, const auto& parse) {
    try {
      return parse();
    } catch (const InvalidInput& error) {
      throw InvalidInput(fmt::format("value {}: {}", number, error.what()));
    }
  };
  if (key.is_nested && !array.empty() && array.front().is_array()) {
    for (std::size_t k = 0; k < array.size(); ++k) {
      in_list(k + 1, [&] {
        const toml::array* inner = array[k].as_array();
        if (inner == nullptr) throw InvalidInput("a list of lists must hold lists only");
        if (inner->empty() && key.count == 0) throw InvalidInput(fmt::format("is empty (expected {})", wanted(key)));
        std::ranges::copy(parse_list(key, *inner), std::back_inserter(values));
      });
    }
    return values;
  }
  for (const auto& element : array) values.push_back(in_list(values.size() + 1, [&] { return parse_element(key, element); }));
  if (key.count != 0 && values.size() != key.count)
    throw InvalidInput(fmt::format("needs {} values, got {} (expected {})", key.count, values.size(), wanted(key)));
  return values;
}

// Returns a position on the beam from a length or a percentage of the beam's length.
Place place_of(const Quantity& quantity) {
  return quantity.dimension == dimension::none ? Place::share(quantity.value) : Place(quantity.value);
}

std::string parse_choice(const Key& key, const std::string& text) {
  if (std::find(key.choices.begin(), key.choices.end(), text) == key.choices.end()) {
    throw InvalidInput("unknown value" + hint(text, key.choices));
  }
  return text;
}

}  // namespace

SectionReader::SectionReader(const SceneFile::Impl& file, std::string_view section, std::string_view name)
    : file_(file), section_(*find_section(section, name)), path_(section) {
  std::vector<std::string> parts;
  if (!section.empty()) parts.emplace_back(section);
  if (!name.empty()) {
    parts.emplace_back(name);
    path_ = join_path(path_, name);
  }
  if (const toml::node* node = file.find(parts)) {
    table_ = node->as_table();
    if (!table_) file_.fail(path_, fmt::format("expected a section [{}]", path_));
  }
  if (!table_) {
    if (section_.required) throw InvalidInput(fmt::format("{}: section [{}] is missing", file.name, path_));
    if (!section_.always_in_force) return;
  }
  read();
}

SectionReader::SectionReader(const SceneFile::Impl& file, const Section& part, std::string path, const toml::table& table)
    : file_(file), section_(part), path_(std::move(path)), table_(&table) {
  read();
}

void SectionReader::read() {
  check_keys();
  read_selector();
  for (const Key& key : section_.keys) {
    if (key.belongs_to(choice_)) read_key(key);
  }
}

void SectionReader::check_keys() const {
  if (!table_ || path_.empty()) return;  // the top level of a scene also holds the sections, which are not keys
  std::vector<std::string_view> known;
  for (const Key& key : section_.keys) {
    if (std::find(known.begin(), known.end(), key.name) == known.end()) known.push_back(key.name);
  }
  for (const auto& [key, node] : *table_) {
    if (section_.find(key.str())) continue;
    const auto fits = [&](const Advice& one) { return key.str().find(one.word) != std::string_view::npos; };
    const auto advice = std::ranges::find_if(section_.advice, fits);
    file_.fail(path(key.str()), advice != section_.advice.end() ? fmt::format("unknown key; {}", advice->text)
                                                                : "unknown key" + hint(key.str(), known));
  }
}

void SectionReader::read_selector() {
  if (section_.selector.empty() || !table_) return;
  read_key(*section_.find(section_.selector));
  choice_ = text(section_.selector);
  for (const auto& [name, node] : *table_) {
    const Key& key = *section_.find(name.str(), choice_);
    if (key.belongs_to(choice_)) continue;
    std::vector<std::string> owners;
    for (const std::string_view owner : key.only_for) owners.push_back(toml_string(owner));
    file_.fail(path(name.str()),
               fmt::format("belongs to {} = {}, not to {}", section_.selector, fmt::join(owners, " or "), toml_string(choice_)));
  }
}

bool SectionReader::is_replaced(const Key& key) const {
  return std::any_of(key.instead_of.begin(), key.instead_of.end(), [&](std::string_view other) {
    const Key* alternative = section_.find(other, choice_);
    return alternative->belongs_to(choice_) && is_given(other);
  });
}

void SectionReader::read_key(const Key& key) {
  if (is_given(key.name)) {
    for (const std::string_view other : key.instead_of) {
      if (is_given(other))
        file_.fail(path(key.name), fmt::format("must not be given together with {}: give one of them", written(other)));
    }
    try {
      values_[key.name] = parse(key, *table_->get(key.name));
    } catch (const InvalidInput& error) {
      file_.fail(path(key.name), error.what());
    }
    return;
  }
  if (is_replaced(key)) return;
  if (key.required && (key.unless.empty() || !is_given(key.unless))) {
    std::string others;
    for (const std::string_view other : key.instead_of) {
      if (section_.find(other, choice_)->belongs_to(choice_)) others += fmt::format(" or '{}'", other);
    }
    const std::string value = others.empty() ? fmt::format(" ({})", wanted(key)) : std::string();
    file_.fail_section(path_, fmt::format("missing key '{}'{}{}{}", key.name, others, value, file_.replaced_in(path_)));
  }
  if (!key.fallback.empty()) values_[key.name] = parse(key, *parse_value(key.fallback).get(value_key));
}

SectionReader::Value SectionReader::parse(const Key& key, const toml::node& node) {
  const auto* text = node.as_string();
  switch (key.type) {
    case KeyType::text:
      if (text) return text->get();
      break;
    case KeyType::texts:
      if (const auto* array = node.as_array()) {
        std::vector<std::string> all;
        for (const auto& element : *array) {
          const auto* one = element.as_string();
          if (!one) throw InvalidInput(fmt::format("value {}: expected a text in quotes", all.size() + 1));
          all.push_back(one->get());
        }
        return all;
      }
      if (text && std::ranges::find(key.words, text->get()) != key.words.end()) return std::vector{text->get()};
      break;
    case KeyType::choice:
      if (text) return parse_choice(key, text->get());
      break;
    case KeyType::flag:
      if (const auto* flag = node.as_boolean()) return flag->get();
      break;
    case KeyType::integer:
      if (const auto* integer = node.as_integer()) {
        if (!key.range.contains(static_cast<double>(integer->get()))) throw InvalidInput(key.range.rule(""));
        return integer->get();
      }
      if (text && key.any_word) return text->get();
      if (text && std::find(key.words.begin(), key.words.end(), text->get()) != key.words.end()) return text->get();
      break;
    case KeyType::quantity:
      if (text && std::find(key.words.begin(), key.words.end(), text->get()) != key.words.end()) return text->get();
      return std::vector{parse_number(key, node)};
    case KeyType::quantities:
      if (const auto* array = node.as_array()) return parse_list(key, *array);
      if (key.may_be_one) return std::vector{parse_number(key, node)};
      break;
    case KeyType::table:
      if (text && std::ranges::find(key.words, text->get()) != key.words.end()) return text->get();
      if (node.is_table()) return Tables{};
      break;
    case KeyType::tables:
      if (const auto* array = node.as_array();
          array && !array->empty() && std::ranges::all_of(*array, [](const toml::node& one) { return one.is_table(); }))
        return Tables{};
      break;
  }
  throw InvalidInput(fmt::format("expected {}", wanted(key)));
}

std::vector<SectionReader> SectionReader::parts(std::string_view key) const {
  std::vector<SectionReader> all;
  const auto found = values_.find(key);
  if (found == values_.end() || !std::holds_alternative<Tables>(found->second)) return all;
  const Section& part = *find(key)->part();
  const toml::node& node = *table_->get(key);
  if (const toml::table* const table = node.as_table()) {
    all.push_back(SectionReader(file_, part, path(key), *table));
  } else {
    for (const toml::node& one : *node.as_array())
      all.push_back(SectionReader(file_, part, fmt::format("{}[{}]", path(key), all.size() + 1), *one.as_table()));
  }
  return all;
}

std::optional<std::pair<SectionReader, std::size_t>> SectionReader::holder(std::span<const std::string> path,
                                                                           std::size_t entry) const {
  if (path.size() <= 1) return std::pair{*this, entry};
  const auto [name, number] = without_element(path.front());
  const Key* const key = find(name);
  if (key == nullptr || key->part == nullptr || (key->type == KeyType::tables) != number.has_value()) return std::nullopt;
  const std::vector<SectionReader> all = parts(key->name);
  const std::size_t index = number.value_or(1);
  if (index < 1 || index > all.size()) return std::nullopt;
  return all[index - 1].holder(path.subspan(1), number ? index - 1 : entry);
}

double SectionReader::number(std::string_view key) const {
  return values_.contains(key) ? quantities(key).front().value : std::numeric_limits<double>::quiet_NaN();
}

const std::vector<Quantity>& SectionReader::quantities(std::string_view key) const {
  return std::get<std::vector<Quantity>>(values_.at(key));
}

std::vector<double> SectionReader::numbers(std::string_view key) const {
  std::vector<double> values;
  for (const Quantity& quantity : quantities(key)) values.push_back(quantity.value);
  return values;
}

int SectionReader::integer(std::string_view key) const { return static_cast<int>(std::get<std::int64_t>(values_.at(key))); }
bool SectionReader::is_word(std::string_view key) const {
  const auto found = values_.find(key);
  return found != values_.end() && std::holds_alternative<std::string>(found->second);
}
bool SectionReader::is_nested(std::string_view key) const {
  const toml::array* list = is_given(key) ? table_->get(key)->as_array() : nullptr;
  return list != nullptr && !list->empty() && list->front().is_array();
}
const std::vector<std::string>& SectionReader::texts(std::string_view key) const {
  return std::get<std::vector<std::string>>(values_.at(key));
}
bool SectionReader::flag(std::string_view key) const { return std::get<bool>(values_.at(key)); }
const std::string& SectionReader::text(std::string_view key) const { return std::get<std::string>(values_.at(key)); }

std::vector<std::string_view> SectionReader::keys_in_pull_in_units() const {
  std::vector<std::string_view> keys;
  for (const auto& [key, value] : values_) {
    const auto* numbers = std::get_if<std::vector<Quantity>>(&value);
    if (numbers && std::any_of(numbers->begin(), numbers->end(), [](const Quantity& quantity) {
          return quantity.dimension == dimension::static_pull_in || quantity.dimension == dimension::dynamic_pull_in;
        })) {
      keys.push_back(key);
    }
  }
  return keys;
}

toml::table SectionReader::with_defaults() const {
  toml::table table;
  for (const auto& [key, value] : values_) {
    const auto insert = [&, name = key](const auto& node) { table.insert(name, node); };
    if (is_given(key)) {
      table_->get(key)->visit(insert);
    } else {
      parse_value(section_.find(key, choice_)->fallback).get(value_key)->visit(insert);
    }
  }
  return table;
}

toml::table SectionReader::in_si_units() const {
  toml::table table;
  for (const auto& [name, value] : values_) {
    const Key& key = *find(name);
    const auto insert = [&, k = name](const auto& node) { table.insert(k, node); };
    if (const auto* numbers = std::get_if<std::vector<Quantity>>(&value)) {
      if (key.type == KeyType::quantity) {
        insert_quantity(key, numbers->front(), insert);
        continue;
      }
      toml::array array, inner;
      const bool nested = is_nested(name);
      for (const Quantity& one : *numbers) {
        insert_quantity(key, one, [&](const auto& node) { (nested ? inner : array).push_back(node); });
        if (!nested || inner.size() < key.count) continue;
        array.push_back(std::move(inner));
        inner = {};
      }
      insert(array);
    } else if (const auto* texts = std::get_if<std::vector<std::string>>(&value)) {
      toml::array array;
      for (const std::string& one : *texts) array.push_back(one);
      insert(array);
    } else if (std::holds_alternative<Tables>(value)) {
      toml::array array;
      for (const SectionReader& part : parts(name)) {
        toml::table one = part.in_si_units();
        one.is_inline(true);
        array.push_back(std::move(one));
      }
      if (key.type == KeyType::tables) {
        insert(array);
      } else {
        insert(*array.front().as_table());
      }
    } else if (const auto* text = std::get_if<std::string>(&value)) {
      insert(*text);
    } else if (const auto* flag = std::get_if<bool>(&value)) {
      insert(*flag);
    } else {
      insert(std::get<std::int64_t>(value));
    }
  }
  return table;
}

void SectionReader::set_members(Scene& scene, std::size_t entry) const {
  for (const auto& [name, value] : values_) {
    const Bound& bound = find(name)->bound;
    if (const Key& key = *find(name); key.part != nullptr && !is_word(name)) {
      std::size_t number = 0;
      for (const SectionReader& part : parts(name)) {
        const std::size_t own = key.type == KeyType::tables ? number++ : entry;
        part.set_members(scene, own);
        if (key.part()->check != nullptr) key.part()->check(scene, part, own);
      }
    } else if (bound.element != nullptr) {
      for (std::size_t k = 0; k < quantities(name).size(); ++k) bound.element(scene, entry, k) = quantities(name)[k].value;
    } else if (bound.place != nullptr) {
      if (is_word(name)) continue;  // "tip" instead of a position means the default of the member, the free end
      for (std::size_t k = 0; k < quantities(name).size(); ++k) bound.place(scene, entry, k) = place_of(quantities(name)[k]);
    } else if (bound.number != nullptr) {
      bound.number(scene, entry) = number(name);
    } else if (bound.flag != nullptr) {
      bound.flag(scene, entry) = flag(name);
    } else if (bound.integer != nullptr) {
      if (!is_word(name)) bound.integer(scene, entry) = integer(name);
    } else if (bound.text != nullptr) {
      bound.text(scene, entry) = text(name);
    } else if (bound.choose != nullptr) {
      bound.choose(scene, entry, text(name));
    }
  }
}

void SectionReader::require_of_structure(std::string_view key, std::string_view needed, const Structure& structure) const {
  // A beam of sections need not give structure.thickness: every section has its own thickness.
  const bool may_lack =
      structure.is_rigid() || (needed == "thickness" && std::isnan(structure.thickness) && !structure.is_built());
  require(!may_lack || SectionReader(file_, "structure").is_given(needed), key,
          fmt::format("needs structure.{} {}", needed, structure.whose()));
}

std::string SectionReader::written_length(const Structure& structure) const {
  return std::visit(
      [&]<class Kind>(const Kind&) -> std::string {
        if constexpr (requires { Kind::length_is; })
          return fmt::format(fmt::runtime(Kind::length_is), engineering(structure.length, "m"));
        return structure.is_built() && file_.find({"structure", "length"}) == nullptr
                   ? fmt::format("its sections are {} long", engineering(structure.length, "m"))
                   : file_.written("structure.length");
      },
      structure.kind);
}

void SectionReader::require_on_beam(std::string_view key, const Structure& beam) const {
  constexpr double rounding = 1e-12;  // relative rounding error of positions that were converted from other units
  const double length = beam.length;
  const std::vector<Quantity>& places = quantities(key);
  for (std::size_t k = 0; k + 1 < places.size(); k += 2) {
    const double begin = place_of(places[k]).on(length), end = place_of(places[k + 1]).on(length);
    require(begin < end, key, "the end must be greater than the begin");
    require(end <= length * (1 + rounding), key, "must end on the beam: " + written_length(beam));
  }
}

}  // namespace softland::internal
