// reference_pages PAGE: prints a page of the reference from the tables of the code. PAGE is `keys`, the keys of a scene,
// `figures`, the figures of merit, `targets`, the targets of a search, or `json`, the members of the JSON of verbs.
#include <cxxabi.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/engineering.h"
#include "base/split.h"
#include "config/schema.h"
#include "objectives/cost.h"
#include "objectives/figures.h"
#include "reports/accuracy_report.h"
#include "reports/check_report.h"
#include "reports/closing_record.h"
#include "reports/cycle_report.h"
#include "reports/effects_report.h"
#include "reports/fit_report.h"
#include "reports/limit_report.h"
#include "reports/measurement_report.h"
#include "reports/mode_table_report.h"
#include "reports/origin.h"
#include "reports/pull_in_report.h"
#include "reports/record.h"
#include "reports/release_report.h"
#include "reports/robustness_report.h"
#include "reports/seeds_report.h"
#include "reports/tuning_report.h"

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
void print_links(const std::vector<std::string>& titles, std::string line = "Sections:") {
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

// The JSON of verbs.

using Members = std::vector<JsonMember>;

// Endings of keys with the unit of the value; of two endings that fit, the longer one stands first.
constexpr auto key_endings = std::to_array<std::pair<std::string_view, std::string_view>>({{"_rad2_s2", "rad²/s²"},
                                                                                           {"_rad_s", "rad/s"},
                                                                                           {"_m_s", "m/s"},
                                                                                           {"_V_s", "V/s"},
                                                                                           {"_ohm", "ohm"},
                                                                                           {"_1_s", "1/s"},
                                                                                           {"_Hz", "Hz"},
                                                                                           {"_s", "s"},
                                                                                           {"_m", "m"},
                                                                                           {"_V", "V"},
                                                                                           {"_N", "N"},
                                                                                           {"_J", "J"},
                                                                                           {"_C", "C"},
                                                                                           {"_F", "F"}});

// Returns "waveforms" of "waveforms.NAME", and "rows" of "rows[]".
std::string_view word_of(const JsonMember& member) {
  const std::string_view key = member.key;
  return key.substr(0, key.find_first_of(".["));
}

std::string_view unit_of(const JsonMember& member) {
  const auto found = std::ranges::find_if(key_endings, [&](const auto& one) { return word_of(member).ends_with(one.first); });
  return found == key_endings.end() ? "" : found->second;
}

// A record with a section of its own, because several members are such records.
struct SharedRecord {
  std::string title;
  Members members;
};

// The records of the page, by the name of their C++ type.
struct Records {
  std::map<std::string, int> uses;
  std::map<std::string, std::string> titles;  ///< titles of the sections of shared records
  std::vector<SharedRecord> shared;           ///< shared records in the order of their first use
};

void count_uses(const Members& members, Records& records) {
  for (const JsonMember& member : members) {
    // The members of a record that was seen already are counted once.
    if (member.record.empty() || records.uses[member.record]++ == 0) count_uses(member.members, records);
  }
}

// Returns "Least time" of softland::LeastTime, and "Run of release" of softland::ReleaseRecord::Run.
std::string title_of_type(const std::string& name) {
  int status = 0;
  const std::unique_ptr<char, void (*)(void*)> whole(abi::__cxa_demangle(name.c_str(), nullptr, nullptr, &status), std::free);
  std::vector<std::string> types;
  for (const std::string& part : split(whole.get(), ':')) {
    if (part.empty() || std::islower(static_cast<unsigned char>(part.front())) != 0) continue;  // a namespace
    std::string& own = types.emplace_back();
    for (const char c : part.substr(0, part.find("Json"))) {
      const bool is_upper = std::isupper(static_cast<unsigned char>(c)) != 0;
      if (is_upper && !own.empty()) own += ' ';
      own += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  std::string words = types.back();
  if (types.size() > 1) words += fmt::format(" of {}", types.front().substr(0, types.front().find(" record")));
  words.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(words.front())));
  return words;
}

// Names the shared records.
void name_shared(const Members& members, Records& records) {
  for (const JsonMember& member : members) {
    const bool is_shared = !member.record.empty() && records.uses[member.record] > 1;
    if (is_shared && records.titles.contains(member.record)) continue;
    if (is_shared) {
      const std::string title = title_of_type(member.record);
      records.titles[member.record] = title;
      records.shared.push_back({title, member.members});
    }
    name_shared(member.members, records);
  }
}

void print_members(const Members& members, const std::string& before, const Records& records) {
  constexpr std::size_t most_characters = 140;
  for (const JsonMember& member : members) {
    const std::string path = before + member.key;
    const auto shared = records.titles.find(member.record);
    const bool is_shared = !member.record.empty() && shared != records.titles.end();
    if (member.about.empty() || member.about.size() > most_characters)
      throw std::logic_error(fmt::format("{}: has no meaning of at most {} characters", path, most_characters));
    fmt::print("| {} | {} | {} | {} |\n", code(path), is_shared ? link_to(shared->second) : member.type, unit_of(member),
               cell(member.about));
    if (!is_shared) print_members(member.members, path + ".", records);
  }
}

void print_section(const std::string& title, const std::string& words, const Members& members, const Records& records) {
  fmt::print("\n## {}\n\n{}| member | type | unit | meaning |\n|---|---|---|---|\n", title, words.empty() ? "" : words + "\n\n");
  print_members(members, "", records);
}

// Returns the members that `others` lacks. A record of both has only the members that it has more.
Members besides(const Members& members, const Members& others) {
  Members more;
  for (const JsonMember& member : members) {
    const auto other = std::ranges::find(others, member.key, &JsonMember::key);
    if (other == others.end()) {
      more.push_back(member);
    } else if (Members inside = besides(member.members, other->members); !inside.empty()) {
      for (JsonMember& one : inside) {
        one.key.insert(0, member.key + ".");
        more.push_back(std::move(one));
      }
    }
  }
  return more;
}

// The JSON of these verbs has no list of members in the code. A test compares these with what the verbs print.
const Members& explored_members() {
  static const Members all{
      {.key = "kind", .type = "text", .about = "`exploration`"},
      {.key = "status", .type = "text", .about = "`done` or `interrupted`"},
      {.key = "variables[]",
       .type = "record",
       .about = "varied keys",
       .members = {{.key = "name", .type = "text", .about = "name of the variable"},
                   {.key = "unit", .type = "text", .about = "its unit"},
                   {.key = "column", .type = "text", .about = "its column in the store"}}},
      {.key = "figures.NAME",
       .type = "record",
       .about = "range of each column of figures",
       .members = {{.key = "least", .type = "number", .about = "least value"},
                   {.key = "least_at", .type = "whole number", .about = "its point"},
                   {.key = "most", .type = "number", .about = "largest value"},
                   {.key = "most_at", .type = "whole number", .about = "its point"}}},
      {.key = "by_status.NAME", .type = "whole number", .about = "number of points by outcome"},
      {.key = "plan", .type = "text", .about = "hash of the plan"},
      {.key = "study", .type = "text", .about = "study at each point"},
      {.key = "seed", .type = "whole number", .about = "seed of the points"},
      {.key = "points", .type = "whole number", .about = "number of points"},
      {.key = "planned", .type = "whole number", .about = "number of planned points; with `--pareto` and of `report`"},
      {.key = "shard", .type = "text", .about = "part of the points, as part/parts"},
      {.key = "rows",
       .type = "record",
       .about = "rows of the store",
       .members = {{.key = "known", .type = "whole number", .about = "rows that were there"},
                   {.key = "computed", .type = "whole number", .about = "rows of this run"},
                   {.key = "reused", .type = "whole number", .about = "rows copied from an earlier plan"},
                   {.key = "remaining", .type = "whole number", .about = "points that are left"}}},
      {.key = "work",
       .type = "record",
       .about = "cost of the run",
       .members = {{.key = "wall_s", .type = "number", .about = "elapsed time"},
                   {.key = "store_s", .type = "number", .about = "time that waited for the store"},
                   {.key = "jobs", .type = "whole number", .about = "number of threads"}}},
      {.key = "store", .type = "text", .about = "file of the store"},
      {.key = "termination", .type = "text", .about = "why the search of `--pareto` ended"},
      {.key = "pareto",
       .type = "record",
       .about = "Pareto front of `--pareto`",
       .members = {
           {.key = "aims[]",
            .type = "record",
            .about = "figures of the front",
            .members = {{.key = "figure", .type = "text", .about = "column of the figure"},
                        {.key = "better", .type = "text", .about = "`small` or `large`"}}},
           {.key = "front[]",
            .type = "record",
            .about = "points of the front",
            .members = {{.key = "point", .type = "whole number", .about = "number of the point"},
                        {.key = "values.NAME", .type = "number", .about = "value of each column"}}},
           {.key = "knee", .type = "whole number", .about = "point where the front bends most"},
           {.key = "reference.NAME", .type = "number", .about = "worst value of each figure, from which the hypervolume counts"},
           {.key = "hypervolume", .type = "number", .about = "hypervolume of the front"},
           {.key = "hypervolume_share", .type = "number", .about = "its share of the box from the best to the worst values"}}}};
  return all;
}

const Members& status_members() {
  static const Members all{
      {.key = "stores[]",
       .type = "record",
       .about = "the stores",
       .members = {{.key = "store", .type = "text", .about = "file of the store"},
                   {.key = "plan", .type = "text", .about = "hash of the plan"},
                   {.key = "seed", .type = "whole number", .about = "seed of the plan"},
                   {.key = "shard", .type = "text", .about = "part of the points, as part/parts"},
                   {.key = "points", .type = "whole number", .about = "number of points"},
                   {.key = "done", .type = "whole number", .about = "number of rows"},
                   {.key = "by_status.NAME", .type = "whole number", .about = "number of rows by outcome"},
                   {.key = "rate_1_s", .type = "number", .about = "rows per second of the last run"},
                   {.key = "writer", .type = "text", .about = "process that writes to the store; null: none"},
                   {.key = "sessions[]",
                    .type = "record",
                    .about = "runs that wrote to the store",
                    .members = {{.key = "program", .type = "text", .about = "program"},
                                {.key = "processor", .type = "text", .about = "processor, vector instructions and C library"},
                                {.key = "command", .type = "text", .about = "command line"},
                                {.key = "host", .type = "text", .about = "name of the machine"},
                                {.key = "process", .type = "whole number", .about = "number of the process"},
                                {.key = "began", .type = "text", .about = "begin, in UTC"},
                                {.key = "last", .type = "text", .about = "last row, in UTC"},
                                {.key = "seconds", .type = "number", .about = "duration [s]"},
                                {.key = "rows", .type = "whole number", .about = "number of rows"}}}}},
      {.key = "points", .type = "whole number", .about = "number of points of all stores"},
      {.key = "done", .type = "whole number", .about = "number of rows of all stores"}};
  return all;
}

const Members& recording_members() {
  static const Members all{{.key = "format", .type = "text", .about = "format of the file"},
                           {.key = "time",
                            .type = "record",
                            .about = "times of the file",
                            .members = {{.key = "first_s", .type = "number", .about = "first time"},
                                        {.key = "last_s", .type = "number", .about = "last time"},
                                        {.key = "interval_s",
                                         .type = "number",
                                         .about = "time between samples, as stated or the mean; null without times"},
                                        {.key = "repeated", .type = "whole number", .about = "number of repeated times"}}},
                           {.key = "channels[]",
                            .type = "record",
                            .about = "channels of the file",
                            .members = {{.key = "name", .type = "text", .about = "name of the channel"},
                                        {.key = "unit", .type = "text", .about = "its unit in the file"},
                                        {.key = "samples", .type = "whole number", .about = "number of samples"},
                                        {.key = "first", .type = "number", .about = "first sample [unit of the channel]"},
                                        {.key = "last", .type = "number", .about = "last sample"},
                                        {.key = "minimum", .type = "number", .about = "smallest sample"},
                                        {.key = "maximum", .type = "number", .about = "largest sample"}}},
                           {.key = "left_out", .type = "list of texts", .about = "data that were not read"},
                           {.key = "notes", .type = "list of texts", .about = "assumptions about the file"}};
  return all;
}

// The members that the JSON of a closing has beside those of ClosingRecord.
const Members& closing_extras() {
  static const Members all{{.key = "collapse_time_s", .type = "number", .about = "time at which the beam touched the electrode"},
                           {.key = "static_deflection_m", .type = "number", .about = "that of `metrics`"},
                           {.key = "capacitance_F", .type = "number", .about = "that of `metrics`"}};
  return all;
}

const Members& search_extras() {
  static const Members all{{.key = "confirmed", .type = "true or false", .about = "whether the repeated simulations agree"},
                           {.key = "worst",
                            .type = "record",
                            .about = "repeated simulation that disagrees most",
                            .members = {{.key = "name", .type = "text", .about = "what differs in it"},
                                        {.key = "figure", .type = "text", .about = "key of the figure that disagrees"},
                                        {.key = "value", .type = "number", .about = "value of this figure"}}}};
  return all;
}

// Returns the members of a record, and further ones.
template <class Record>
Members listed_with(const Record& record, const Members& more) {
  Members all = internal::listed(record);
  internal::add_members(all, more);
  return all;
}

struct JsonSection {
  std::string title, words;
  Members members;
};

void print_json() {
  ClosingRecord closing_record, search_record;
  for (ClosingRecord* const one : {&closing_record, &search_record}) one->best.figures.emplace(), one->certificate.emplace();
  search_record.search.emplace().devices.emplace();
  AccuracyRecord accuracy;
  accuracy.found.rows.emplace_back();
  EffectsRecord effects;
  effects.found.list.push_back({.section = "gas", .in_scene = true});
  LimitRecord limit;
  limit.landed.emplace();
  const Members origin = internal::listed<Origin>(), closing = listed_with(closing_record, closing_extras());
  const auto of_verb = [&](const Members& members) { return besides(members, origin); };
  const std::vector<JsonSection> sections{
      {"Every verb",
       "The JSON of `read` and `status` lacks these members. [Commands](../commands.md#the-same-result-again) explains `made_with`.",
       origin},
      {"simulate", "The JSON of `--json` lacks `best`, `curves` and `scene_toml`.", of_verb(closing)},
      {"optimize", "These members come beside those of [simulate](#simulate). The JSON of `--json` lacks `curves` and `search`.",
       besides(of_verb(listed_with(search_record, search_extras())), closing)},
      {"optimize --seeds", "This is the JSON of interrupted searches.", of_verb(internal::listed<SeedsRecord>())},
      {"check", "", of_verb(internal::listed<CheckRecord>())},
      {"pull-in", "The members of a single electrode are repeated at the top.",
       of_verb(listed_with(PullInsRecord{}, internal::listed(PullInsRecord{.electrodes = {{"main", {}}}})))},
      {"modes", "With `--from` the JSON has the members of the file.",
       of_verb(listed_with(ModesRecord{}, internal::listed(ModesRecord{.file = ModesRecord::File{}})))},
      {"effects", "", of_verb(internal::listed(effects))},
      {"accuracy", "", of_verb(internal::listed(accuracy))},
      {"limit", "", of_verb(internal::listed(limit))},
      {"release", "", of_verb(internal::listed<ReleaseRecord>())},
      {"cycle", "", of_verb(internal::listed<CycleRecord>())},
      {"robustness", "", of_verb(internal::listed<RobustnessRecord>())},
      {"calibrate", "", of_verb(internal::listed<MeasurementsRecord>())},
      {"fit", "", of_verb(internal::listed<FitRecord>())},
      {"tune", "", of_verb(internal::listed<TuningReport>())},
      {"explore", "The file exploration.json of `report` has a part of these members.", explored_members()},
      {"status", "", status_members()},
      {"read", "", recording_members()}};
  Records records;
  for (const JsonSection& section : sections) count_uses(section.members, records);
  for (const JsonSection& section : sections) name_shared(section.members, records);
  fmt::print(
      "# Members of the JSON\n\n"
      "*For everyone who reads a JSON of softland with a program: which members are there, and what do they mean?*\n\n"
      "This page is made from the lists of members by which softland writes and reads JSON. [Files of a search](../outputs.md) says\n"
      "which files hold it.\n\n"
      "- `best.cost` is the member `cost` of the record `best`. `rows[]` is each record of a list, and `drives.NAME` that of any name.\n"
      "- `FIGURE` is the key of a [figure of merit](figures.md). Counts are whole numbers, and `settled` is true or false.\n"
      "- The unit stands at the end of the key. A number or record that is not known is null.\n"
      "- A member that makes no sense for a run is absent.\n"
      "- A type with a link is a record that several members are. It has a table below those of the verbs.\n\n");
  std::vector<std::string> titles;
  for (const JsonSection& section : sections) titles.push_back(section.title);
  print_links(titles, "Verbs:");
  for (const JsonSection& section : sections) print_section(section.title, section.words, section.members, records);
  for (const SharedRecord& one : records.shared) print_section(one.title, "", one.members, records);
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
  } else if (page == "json") {
    softland::print_json();
  } else {
    std::fputs("usage: reference_pages keys|figures|targets|json\n", stderr);
    return 2;
  }
  return 0;
}
