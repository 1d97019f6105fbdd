#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "base/csv.h"
#include "base/read_file.h"
#include "base/require.h"
#include "base/shortened.h"
#include "base/trimmed.h"
#include "config/plan.h"
#include "config/plan_entry.h"

namespace softland {

using namespace internal;

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

/// Reads the keys of [plan] in a plan file, and checks that the file has no other section.
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
    // The returned function outlives this reader and its file, so it holds copies of the lines (file, line, text) of [plan].
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

void add_options(PlanRequest& request, const std::vector<std::string>& given) {
  for (std::size_t k = 0; k < given.size(); ++k) {
    const std::size_t equals = given[k].find('=');
    require(equals != std::string::npos && equals > 0, [&] {
      return fmt::format("{}: must be NAME=VALUE, such as \"impact-velocity=1 mm/s\"", request.place("options", k));
    });
    request.options[given[k].substr(0, equals)] = given[k].substr(equals + 1);
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
