// reference_pages PAGE: prints a page of the reference from the tables of the code. PAGE is `keys`, the keys of a scene,
// `figures`, the figures of merit, or `targets`, the targets of a search.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/engineering.h"
#include "config/schema.h"
#include "objectives/cost.h"
#include "objectives/figures.h"

namespace softland {
namespace {

using internal::Key;
using internal::KeyType;
using internal::Section;

// Text of a table cell: a bar would end the cell.
std::string cell(std::string_view text) {
  std::string safe;
  for (const char c : text) safe += c == '|' ? std::string("\\|") : std::string(1, c);
  return safe;
}

std::string code(std::string_view text) { return fmt::format("`{}`", text); }

std::string codes(const std::vector<std::string_view>& words) {
  std::vector<std::string> all;
  for (const std::string_view word : words) all.push_back(code(word));
  return fmt::format("{}", fmt::join(all, ", "));
}

// Returns "length" of "a length".
std::string kind(const Dimension& dimension) {
  const std::string_view words = noun(dimension);
  return std::string(words.substr(words.find(' ') + 1));
}

// Returns the range of a key; empty where it has that of its kind.
std::string range_text(const Key& key, const Dimension& dimension) {
  constexpr double open = std::numeric_limits<double>::infinity();
  const Range& own = key.range;
  const std::string unit = unit_symbol(dimension);
  const auto number = [&](double value) { return value == 0 ? "0" : engineering(value, unit); };
  const bool has_least = own.least > -open, has_most = own.most < open;
  if (has_least && has_most)
    return fmt::format(" {} {} to {} {}", own.least_open ? "above" : "from", number(own.least),
                       own.most_open ? "below" : "at most", number(own.most));
  if (has_least) return fmt::format(" {} {}", own.least_open ? ">" : "≥", number(own.least));
  if (has_most) return fmt::format(" {} {}", own.most_open ? "<" : "≤", number(own.most));
  return "";
}

std::string kind_text(const Key& key) {
  const auto of_dimensions = [&] {
    std::vector<std::string> kinds;
    for (const Dimension& one : key.dimensions) {
      kinds.push_back(kind(one) + range_text(key, one));
    }
    return kinds.empty() ? std::string("quantity") : fmt::format("{}", fmt::join(kinds, ", or "));
  };
  std::string text;
  switch (key.type) {
    case KeyType::text:
      text = "text";
      break;
    case KeyType::texts:
      text = "list of texts";
      break;
    case KeyType::flag:
      text = "`true`, `false`";
      break;
    case KeyType::integer:
      text = "integer" + range_text(key, dimension::none);
      break;
    case KeyType::choice:
      text = codes(key.choices);
      break;
    case KeyType::quantity:
      text = of_dimensions();
      break;
    case KeyType::quantities:
      text = fmt::format("list of {}{}", key.count > 0 ? fmt::format("{} × ", key.count) : "", of_dimensions());
      if (key.may_be_one) text += ", or one";
      break;
    case KeyType::table:
      text = "table";
      break;
    case KeyType::tables:
      text = "list of tables";
      break;
  }
  return key.words.empty() ? text : fmt::format("{}, or {}", text, codes(key.words));
}

std::string default_text(const Key& key) {
  std::string text = key.required ? "required" : key.fallback.empty() ? "" : code(key.fallback);
  if (!key.instead_of.empty()) text += fmt::format("{}or {}", text.empty() ? "" : ", ", codes(key.instead_of));
  if (!key.unless.empty()) text += fmt::format(" without {}", code(key.unless));
  return text;
}

void print_table(const std::vector<const Key*>& keys) {
  fmt::print("| key | value | default | meaning |\n|---|---|---|---|\n");
  for (const Key* key : keys)
    fmt::print("| {} | {} | {} | {} |\n", code(key->name), cell(kind_text(*key)), cell(default_text(*key)), cell(key->about));
}

// Prints the keys that every section has, then those of single choices of the selector, each group once.
void print_section(const Section& section, const std::string& title, int depth, const std::string& rule) {
  fmt::print("\n{} {}\n\n", std::string(static_cast<std::size_t>(depth), '#'), title);
  if (!section.about.empty()) fmt::print("Content: {}{}\n\n", section.about, rule);
  std::vector<std::pair<std::vector<std::string_view>, std::vector<const Key*>>> groups{{{}, {}}};
  for (const Key& key : section.keys) {
    auto group = std::ranges::find(groups, key.only_for, &decltype(groups)::value_type::first);
    if (group == groups.end()) group = groups.insert(groups.end(), {key.only_for, {}});
    group->second.push_back(&key);
  }
  for (const auto& [choices, keys] : groups) {
    if (!choices.empty()) fmt::print("\nThese keys exist with {} = {}:\n\n", code(section.selector), codes(choices));
    if (!keys.empty()) print_table(keys);
  }
  if (!section.beside.empty())
    fmt::print("\n[The scene file](../scene.md) explains the key {} of [{}], which stands beside these sections.\n",
               code(section.beside), section.name);
  for (const Key& key : section.keys) {
    if (key.part != nullptr) print_section(*key.part(), fmt::format("{} of {}", code(key.name), title), depth + 1, ".");
  }
}

void collect(const Section& section, std::vector<Dimension>& all) {
  for (const Key& key : section.keys) {
    for (const Dimension& one : key.dimensions)
      if (std::ranges::find(all, one) == all.end()) all.push_back(one);
    if (key.part != nullptr) collect(*key.part(), all);
  }
}

void print_kinds() {
  std::vector<Dimension> all;
  for (const Section& section : internal::schema()) collect(section, all);
  fmt::print(
      "\n## Kinds of quantities\n\nEvery number has a smallest and a largest value. Where a table says \"> 0\" or leaves an end open, "
      "the ends are these.\nA value that may be 0 begins there, and one that may be negative ends at minus the largest.\n\n"
      "| kind | smallest above 0 | largest |\n|---|---|---|\n");
  for (const Dimension& one : all) {
    const Key positive{.name = "any", .dimensions = {one}, .range = {.least = 0, .least_open = true}};
    const Range range = positive.range_of(one);
    fmt::print("| {} | {} | {} |\n", kind(one), engineering(range.least, unit_symbol(one)),
               engineering(range.most, unit_symbol(one)));
  }
}

// Returns the heading of a section, without the marks of a heading.
std::string title_of(const Section& section) {
  if (section.name.empty()) return "Above the first section";
  if (section.is_named) return fmt::format("[{}.{}]", section.name, section.entry.empty() ? "NAME" : section.entry);
  return section.may_be_named ? fmt::format("[{0}] or [{0}.NAME]", section.name) : fmt::format("[{}]", section.name);
}

// Returns a link to a heading of the same page, whose anchor has its letters in lower case and hyphens for blanks.
std::string link_to(std::string_view title) {
  std::string anchor;
  for (const unsigned char c : title) {
    if (c == ' ') anchor += '-';
    if (std::isalnum(c) != 0 || c == '-' || c == '_') anchor += static_cast<char>(std::tolower(c));
  }
  return fmt::format("[{}](#{})", title.starts_with('[') ? code(title) : std::string(title), anchor);
}

// Prints links in lines of at most 130 columns.
void print_links(const std::vector<std::string>& titles) {
  std::string line = "Sections:";
  for (std::size_t i = 0; i < titles.size(); ++i) {
    const std::string link = link_to(titles[i]) + (i + 1 < titles.size() ? "," : ".");
    if (line.size() + 1 + link.size() > 130) {
      fmt::print("{}\n", line);
      line = link;
    } else {
      line += " " + link;
    }
  }
  fmt::print("{}\n", line);
}

void print_keys() {
  fmt::print(
      "# Keys of a scene\n\n"
      "*For everyone who writes a scene: which keys are there, what may they be, and what do they mean?*\n\n"
      "This page is made from the table by which softland reads scenes. A section that is absent is an effect that is not simulated. A\n"
      "quantity is a text with its unit, such as \"2 um\"; [the scene file](../scene.md) says how it is written and which rules join\n"
      "several keys. A default is written as TOML; a key without default may be left out. \"Required\" means within the section.\n");
  std::vector<std::string> titles;
  for (const Section& section : internal::schema()) titles.push_back(title_of(section));
  titles.emplace_back("Kinds of quantities");
  fmt::print("\n");
  print_links(titles);
  for (const Section& section : internal::schema()) {
    const std::string rule = section.required          ? ". The section is required."
                             : section.always_in_force ? ". Its defaults apply without the section."
                                                       : ".";
    print_section(section, title_of(section), 2, rule);
  }
  print_kinds();
}

// Prints the figures for which `chosen` returns true.
template <class Chosen>
void print_figure_table(const Chosen& chosen) {
  fmt::print("\n| figure | symbol | key in JSON | unit | meaning |\n|---|---|---|---|---|\n");
  for (const Figure& figure : figure_table)
    if (chosen(figure))
      fmt::print("| {} | {} | {} | {} | {} |\n", cell(figure.label()), cell(figure.symbol), code(figure.key), figure.unit,
                 cell(figure.about));
}

// Returns how the error of a figure becomes known.
std::string_view error_text(const Figure& figure) {
  if (!figure.has_error()) return "none";
  if (figure.error_is_from_two_runs()) return "two runs";
  return figure.conditioning == Conditioning::rest ? "quadrature" : "range";
}

struct Request {
  bool AskedFigures::*asked;
  std::string_view words;
};
constexpr std::array requests{
    Request{&AskedFigures::resistance, "the contacts that make the connection have a `resistivity`"},
    Request{&AskedFigures::electrical, "the scene has `metrics.closed_force`, `closed_resistance` or `closed_after`"},
    Request{&AskedFigures::pressure, "a contact that makes the connection has asperities and a hardness"},
    Request{&AskedFigures::charge, "the scene has a `[load]`"},
    Request{&AskedFigures::break_charge, "the scene has a `[load]`, and the run opens the switch on command"},
    Request{&AskedFigures::opening, "the run opens the switch on command"},
};

void print_figures() {
  fmt::print(
      "# Figures of merit\n\n"
      "*For everyone who reads a result: what is this figure, what is its unit, and how does its error become known?*\n\n"
      "This page is made from the table of figures by which softland writes results. [Figures of a run](runs.md) has their rules, and\n"
      "[Errors of figures](errors.md) says how far a figure can be trusted. Names follow Bognash 2019. The window is the simulated\n"
      "time span. Every figure is taken at the contact point. A condition such as `t_p < 45 us` names a figure by its symbol, or by\n"
      "its key without the unit.\n\n"
      "## Figures of one run\n");
  print_figure_table([](const Figure& f) { return f.of_results; });
  fmt::print("\n## Figures of varied devices\n\nStudies of process variation have one more figure.\n");
  print_figure_table([](const Figure& f) { return f.of_devices && !f.of_results; });
  fmt::print(
      "\n## Figures on request\n\nResults show these figures only under a condition.\n\n| condition | figures |\n|---|---|\n");
  for (const Request& request : requests) {
    std::vector<std::string_view> names;
    for (const Figure& figure : figure_table)
      if (figure.asked == request.asked) names.push_back(figure.symbol);
    fmt::print("| {} | {} |\n", request.words, fmt::join(names, ", "));
  }
  fmt::print(
      "\n## Errors and derivatives\n\n"
      "- Error \"two runs\": `simulate` estimates it from the difference between two runs of different accuracy.\n"
      "- Error \"range\": the figure may be chaotic. `simulate --certify` gives its range in a cloud of runs.\n"
      "- Error \"quadrature\": the figure is that of an equilibrium. `simulate --certify` gives its error.\n"
      "- Derivatives are exact, by parameters of waveforms and by quantities of the device.\n"
      "- Devices: studies of process variation give quantiles of the figure, and conditions on devices may name it.\n\n"
      "| figure | lower is better | error | derivative | devices |\n|---|---|---|---|---|\n");
  for (const Figure& figure : figure_table) {
    if (!figure.of_results && !figure.of_devices) continue;
    fmt::print("| {} | {} | {} | {} | {} |\n", cell(figure.symbol), figure.better == Better::lower ? "yes" : "",
               figure.of_results ? error_text(figure) : "", figure.slope != nullptr ? "yes" : "", figure.of_devices ? "yes" : "");
  }
  fmt::print(
      "\n## Figures inside costs\n\nResults do not show these figures. They enter costs, and objectives of your own receive them.\n");
  print_figure_table([](const Figure& f) { return !f.of_devices && !f.of_results; });
}

void print_targets() {
  fmt::print(
      "# Targets of a search\n\n"
      "*For everyone who searches: which targets are there, and which figure does each improve?*\n\n"
      "This page is made from the table of targets. `softland optimize --target NAME` chooses one, and `--target \"0.7 bounce + 0.3 "
      "energy\"`\na weighted sum. [Costs](costs.md) says how a target is searched, and which goal it has.\n\n"
      "| target | figure | key in JSON | searched |\n|---|---|---|---|\n");
  for (const TargetRow& row : targets) {
    const Figure& figure = figure_of(row.figure);
    fmt::print("| {} | {} | {} | {} |\n", code(row.name), figure.label(), code(figure.key),
               row.has_own_cost ? "by its own cost, after that of `bounce`" : "by the smooth cost of `bounce` alone");
  }
  fmt::print("\nThese targets have no exact gradients:\n\n");
  for (const TargetRow& row : targets) {
    if (!row.no_gradient.empty()) fmt::print("- {}: {}.\n", code(row.name), row.no_gradient);
  }
}

}  // namespace
}  // namespace softland

int main(int count, char** arguments) {
  const std::string_view page = count == 2 ? arguments[1] : "";
  if (page == "keys") {
    softland::print_keys();
  } else if (page == "figures") {
    softland::print_figures();
  } else if (page == "targets") {
    softland::print_targets();
  } else {
    std::fputs("usage: reference_pages keys|figures|targets\n", stderr);
    return 2;
  }
  return 0;
}
