// The options of a verb are the members of a struct, the request of the verb. A function template `options(archive, request)`
// names each option once, with its type and its help. The command line and Python call this template with an archive:
// OptionList lists the options, OptionReader reads the texts of the options into the request.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/choice.h"
#include "base/nearest.h"
#include "base/range.h"
#include "base/require.h"
#include "base/shortened.h"
#include "config/units.h"
#include "sampling/points.h"

namespace softland::verbs {

/// The texts that the user gave, by name of the option, in the order given. A flag has one empty text.
using Arguments = std::map<std::string, std::vector<std::string>, std::less<>>;

/// The quantity that an option accepts. The member `rule` completes the sentence "must be ...". Without a range and a rule the
/// quantity must be at least 0.
struct Wanted {
  Dimension dimension;
  Range range = {};
  std::string rule = {};
};

/// An option as the command line and Python declare it.
struct OptionRow {
  enum class Kind {
    text,
    flag,
    repeated,
    further,  ///< any number of arguments after the scene
    object    ///< a Python object, which has no text form
  };
  enum class Door { both, program, python };

  /// Name such as "impact-velocity", word such as "SPEED" for the value; `about` is the help, which begins in lower case.
  std::string name, word, about;
  Kind kind = Kind::text;
  Door door = Door::both;  ///< interfaces (command line, Python) that have the option; a Python object is for Python only
  /// True: the option may have an empty text; false: an empty text is refused before the option is read.
  bool may_be_empty = false;

  // The members from `keyword` on describe the option in Python.
  std::string keyword = {};  ///< name of the option in Python, "impact_velocity"
  std::string type = {};     ///< type of the option in Python, "float | str | None"
  std::string value = {};    ///< default value of the option in Python, "None"
  std::string note = {};     ///< text in front of the help `about` in Python, such as the unit of a number
  /// Python expression that converts the argument of the method to the option's texts, such as "_quantity(impact_velocity,
  /// 'm/s')".
  std::string conversion = {};
  bool is_positional = false;
};

/// The form of an option in Python. Members that are not set are derived from the kind of the option. An option without a
/// default value is required.
struct InPython {
  std::optional<std::string> keyword = {}, type = {}, value = {}, conversion = {};
  bool is_positional = false;
};

/// Returns the Python keyword of an option: "impact_velocity" for "impact-velocity".
[[nodiscard]] std::string keyword_of(std::string_view name);
/// A function that returns an option as the command line or Python spells its name: "--impact-velocity", "impact_velocity".
using Spelling = std::function<std::string(std::string_view)>;
/// Replaces the option names that requested() has marked in a message by their spelling.
[[nodiscard]] std::string spelled(std::string_view marked, const Spelling& spelling);
[[nodiscard]] std::string spelled(const InvalidRequest& error, const Spelling& spelling);
/// The type T of std::optional<T>; any other type itself.
template <class T>
struct Held {
  using type = T;
};
template <class T>
struct Held<std::optional<T>> {
  using type = T;
};

/// An archive (the argument of the function template options()) that lists the options of a verb.
class OptionList {
 public:
  /// Makes the next option an option of the command line only.
  OptionList& program() { return next_.door = OptionRow::Door::program, *this; }
  /// Makes the next option an option of Python only.
  OptionList& python() { return next_.door = OptionRow::Door::python, *this; }
  /// Sets the form of the next option in Python.
  OptionList& as(const InPython& form) { return next_.form = form, *this; }

  template <class T, class Names>
  void choice(const char* name, T& value, const Names& names, const std::string& about) {
    std::string list = listed(names), type;
    for (const std::string_view one : names_of(names)) type += fmt::format("{}\"{}\"", type.empty() ? "" : ", ", one);
    add({.name = name, .word = "NAME", .about = fmt::format("{}: {}", about, list.insert(list.find(','), " (default)"))},
        fmt::format("Literal[{}]", type), fmt::format("\"{}\"", name_of(names, value)), "[{}]");
  }
  template <class T>
  void quantity(const char* name, T&, const Wanted& wanted, const char* word, const std::string& about) {
    const std::string unit = unit_symbol(wanted.dimension);
    add({.name = name,
         .word = word,
         .about = about,
         .may_be_empty = true,
         .note = unit.empty() ? "" : fmt::format("[{}] ", unit)},
        "float | str | None", "None", fmt::format("_quantity({{}}, \"{}\")", unit));
  }
  template <class T>
  void whole(const char* name, T&, Range, const std::string& about, const char* word = "N") {
    add({.name = name, .word = word, .about = about, .may_be_empty = true}, "int | None", "None", "_whole({})");
  }
  void file(const char* name, std::optional<std::string>&, const std::string& about) {
    add({.name = name, .word = "FILE", .about = about}, "str | os.PathLike[str] | None", "None", "_path({})");
  }
  void text(const char* name, const std::string& value, const char* word, const std::string& about) {
    add({.name = name, .word = word, .about = about}, "str", fmt::format("\"{}\"", value), "_text({})");
  }
  /// Adds an option whose value may be empty: the verb checks the value.
  void text(const char* name, const std::optional<std::string>&, const char* word, const std::string& about) {
    add({.name = name, .word = word, .about = about, .may_be_empty = true}, "str | None", "None", "_text({})");
  }
  /// Adds an option whose text the function `parse` reads. Python takes a list for "1.1,1.25" and a mapping for "Vdp:1
  /// %,time:0.5 %".
  template <class T, class Parse>
  void parsed(const char* name, T&, const Parse&, const char* word, const std::string& about, const char* keyword,
              const char* type) {
    const std::string_view kind(type);
    const bool is_mapping = kind.starts_with("Mapping");
    add({.name = name, .word = word, .about = about, .keyword = keyword}, type, kind.ends_with("None") ? "None" : "()",
        is_mapping ? "_pairs({}, \":\")" : "_joined({})");
  }
  /// Adds an option with texts "KEY=VALUE"; Python takes a mapping.
  void assignments(const char* name, std::vector<std::string>&, const char* word, const std::string& about) {
    add({.name = name, .word = word, .about = about, .kind = OptionRow::Kind::repeated}, "Mapping[str, float | str] | None",
        "None", "_assigned({})");
  }
  void repeated(const char* name, std::vector<std::string>&, const char* word, const std::string& about, const char* keyword = "",
                bool is_positional = false) {
    add({.name = name,
         .word = word,
         .about = about,
         .kind = OptionRow::Kind::repeated,
         .keyword = keyword,
         .is_positional = is_positional},
        "Sequence[str]", "()", "list({})");
  }
  /// Adds an option for further results as arguments after the scene; Python takes waveforms by name.
  void results(const char* name, std::vector<std::string>&, const std::string& about) {
    add({.name = name,
         .word = "",
         .about = about,
         .kind = OptionRow::Kind::further,
         .keyword = "waveforms",
         .is_positional = true},
        "Mapping[str, Mapping[str, Waveform]] | None", "None", "list({} or ())");
  }
  /// Adds an option for the file of measurements; Python also takes the measurements themselves.
  void measurements(const char* name, std::string&, const std::string& about) {
    add({.name = name, .word = "FILE", .about = about, .is_positional = true},
        "str | os.PathLike[str] | Sequence[Mapping[str, Any]]", "", "[{}]");
  }
  void flag(const char* name, bool&, const std::string& about) {
    add({.name = name, .word = "", .about = about, .kind = OptionRow::Kind::flag}, "bool", "False", "_flag({})");
  }
  /// Adds an option for a Python function or object, which is passed on unchanged.
  void object(const char* keyword, const char* type, const char* value, const std::string& about) {
    python().add({.name = keyword, .word = "", .about = about, .kind = OptionRow::Kind::object}, type, value, "");
  }
  /// Adds an option for a member that is true unless the flag "no-NAME" is given.
  void unless(const char* name, bool&, const std::string& about) {
    constexpr std::string_view no = "no-";
    add({.name = name,
         .word = "",
         .about = about,
         .kind = OptionRow::Kind::flag,
         .keyword = std::string(name).substr(no.size()),
         .note = "False: "},
        "bool", "True", "_flag(not {})");
  }
  [[nodiscard]] const std::vector<OptionRow>& all() const { return all_; }

 private:
  /// Adds an option; "{}" in the Python expression `told` stands for the keyword of the option.
  void add(OptionRow row, const std::string& type, const std::string& value, const std::string& conversion) {
    const auto [door, form] = std::exchange(next_, {});
    row.door = door;
    row.keyword = form.keyword.value_or(row.keyword.empty() ? keyword_of(row.name) : row.keyword);
    row.type = form.type.value_or(type), row.value = form.value.value_or(value);
    row.conversion = fmt::format(fmt::runtime(form.conversion.value_or(conversion)), row.keyword);
    row.is_positional = row.is_positional || form.is_positional;
    all_.push_back(std::move(row));
  }
  struct Next {
    OptionRow::Door door = OptionRow::Door::both;
    InPython form = {};
  };
  Next next_;
  std::vector<OptionRow> all_;
};

/// Returns the number in the text of an option. Throws InvalidRequest with option, text and rule.
template <class Number>
[[nodiscard]] Number whole_number(const std::string& option, const std::string& text, const Range& range) {
  Number value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  require_request(error != std::errc::result_out_of_range, [&] {
    return fmt::format("{} {}: must be a whole number from {} to {}", option, text, range.least,
                       std::numeric_limits<Number>::max());
  });
  require_request(error == std::errc() && end == text.data() + text.size() && static_cast<double>(value) >= range.least,
                  [&] { return fmt::format("{} {}: must be a whole number from {} on", option, visible(text), range.least); });
  require_request(static_cast<double>(value) <= range.most,
                  [&] { return fmt::format("{} {}: must be at most {:.0f}", option, text, range.most); });
  return value;
}

/// An archive (argument of the function template options()) that reads the user's texts into the members of a request; all
/// other members keep their values. Throws InvalidRequest with option, value and rule.
class OptionReader {
 public:
  explicit OptionReader(const Arguments& arguments) : arguments_(arguments) {}

  OptionReader& program() { return *this; }
  OptionReader& python() { return *this; }
  OptionReader& as(const InPython&) { return *this; }

  template <class T, class Names>
  void choice(const char* name, T& value, const Names& names, const std::string&) {
    const std::string* const text = find(name);
    if (text == nullptr) return;
    const auto* const row = find_named(names, *text);
    require_request(row != nullptr, [&] {
      return fmt::format("{} {}: must be {}{}", requested(name), *text, listed(names), did_you_mean(*text, names_of(names)));
    });
    value = row->value;
  }
  template <class T>
  void quantity(const char* name, T& value, const Wanted& wanted, const char*, const std::string&) {
    if (const std::string* const text = find(name)) value = quantity_of(name, *text, wanted);
  }
  template <class T>
  void whole(const char* name, T& value, Range range, const std::string&, const char* = "N") {
    const std::string* const text = find(name);
    if (text == nullptr) return;
    value = whole_number<typename Held<T>::type>(requested(name), *text, range);
  }
  void file(const char* name, std::optional<std::string>& value, const std::string&) {
    const std::string* const text = find(name);
    if (text == nullptr) return;
    require_request(!text->empty(), [&] { return fmt::format("{}: must not be empty", requested(name)); });
    value = *text;
  }
  template <class Text>
  void text(const char* name, Text& value, const char*, const std::string&) {
    if (const std::string* const text = find(name)) value = *text;
  }
  template <class T, class Parse>
  void parsed(const char* name, T& value, const Parse& parse, const char*, const std::string&, const char*, const char*) {
    if (const std::string* const text = find(name)) parse(requested(name), *text, value);
  }
  void assignments(const char* name, std::vector<std::string>& values, const char*, const std::string&) { all(name, values); }
  void repeated(const char* name, std::vector<std::string>& values, const char*, const std::string&, const char* = "",
                bool = false) {
    all(name, values);
  }
  void results(const char* name, std::vector<std::string>& values, const std::string&) { all(name, values); }
  void measurements(const char* name, std::string& value, const std::string&) {
    const std::string* const text = find(name);
    require_request(text != nullptr && !text->empty(),
                    [&] { return fmt::format("{}: must name the file of measurements, such as bench.toml", requested(name)); });
    value = *text;
  }
  void flag(const char* name, bool& value, const std::string&) { value = value || arguments_.contains(name); }
  void object(const char*, const char*, const char*, const std::string&) {}
  void unless(const char* name, bool& value, const std::string&) { value = value && !arguments_.contains(name); }

 private:
  [[nodiscard]] const std::string* find(const char* name) const {
    const auto at = arguments_.find(name);
    return at == arguments_.end() || at->second.empty() ? nullptr : &at->second.back();
  }
  void all(const char* name, std::vector<std::string>& values) const {
    if (const auto at = arguments_.find(name); at != arguments_.end()) values = at->second;
  }
  [[nodiscard]] double quantity_of(const char* name, const std::string& text, const Wanted& wanted) const;

  const Arguments& arguments_;
};

// Declares the options that several verbs share, by an archive: OptionList or OptionReader.
template <class Archive, class Seed>
void seed_option(Archive& a, Seed& seed, const std::string& same) {
  const std::string about = "random seed, a whole number from 0 on (default: 1); the same seed gives " + same;
  if constexpr (std::is_same_v<Seed, std::optional<std::string>>)  // the request holds the seed as text, empty if not given
    a.text("seed", seed, "N", about);
  else
    a.whole("seed", seed, {.least = 0}, about);
}
template <class Archive>
void jobs_option(Archive& a, int& jobs,
                 const std::string& about = "number of threads (default: one per core); the result does not depend on it") {
  a.whole("jobs", jobs, {.least = 1}, about);
}
template <class Archive>
void samples_option(Archive& a, std::uint64_t& samples, Range range, const std::string& about) {
  a.whole("samples", samples, range, about);
}
/// Returns the default number of threads, one per processor core.
[[nodiscard]] int one_per_core();

}  // namespace softland::verbs
