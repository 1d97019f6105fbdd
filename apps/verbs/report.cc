// Verb `report`: makes text, pages and plots again from the JSON of a verb, or from the database file of an exploration.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/exit_status.h"
#include "apps/output.h"
#include "apps/progress.h"
#include "apps/scenes.h"
#include "apps/streams.h"
#include "apps/verbs/verbs.h"
#include "base/printable.h"
#include "base/read_file.h"
#include "base/require.h"
#include "base/shortened.h"
#include "document/text.h"
#include "reports/closing_record.h"
#include "reports/exploration_report.h"
#include "reports/record.h"
#include "store/study_store.h"
#include "verbs/study.h"

namespace softland::apps {
namespace {

struct ReportRequest {
  std::string result;
  std::string pareto;  ///< value of the option --pareto: figures of merit to minimise or maximise in an exploration
  std::string map;     ///< value of the option --map: the figure of merit to draw, and the two variables on the axes
};

// Returns the column of the variable or the figure of merit with this name. Throws InvalidInput if the exploration lacks it.
std::size_t column_named(const ExplorationReport& report, const std::string& name, bool is_variable) {
  std::string there;
  for (std::size_t c = 0; c < report.columns.size(); ++c) {
    const ExploredColumn& column = report.columns[c];
    if (column.is_variable != is_variable) continue;
    if (goes_by(column, name)) return c;
    there += (there.empty() ? "" : ", ") + (is_variable ? column.name : column.key);
  }
  throw InvalidInput(
      fmt::format("--map {}: must be a {} of this exploration: {}", name, is_variable ? "variable" : "figure", there));
}

std::string folder_of(const std::filesystem::path& file) { return file.has_parent_path() ? file.parent_path().string() : "."; }

// Draws a figure of merit over two variables as a map, for --map=FIGURE or --map=FIGURE:ACROSS:UP.
std::string map_of(const ExplorationReport& report, const std::string& words) {
  std::vector<std::string> parts{""};
  for (const char letter : words) {
    if (letter == ':')
      parts.emplace_back();
    else
      parts.back() += letter;
  }
  require(parts.size() == 1 || parts.size() == 3,
          [&] { return fmt::format("--map {}: must be FIGURE or FIGURE:ACROSS:UP, with two variables", words); });
  const std::size_t figure = column_named(report, parts[0], false);
  if (parts.size() == 3)
    return exploration_map_svg(report, column_named(report, parts[1], true), column_named(report, parts[2], true), figure);
  const std::vector<std::size_t> axes = grid_variables(report);
  require(axes.size() >= 2, [&] { return fmt::format("--map {}: requires points on a grid of two or more variables", words); });
  return exploration_map_svg(report, axes[0], axes[1], figure);
}

// Reports an exploration. `record` is the JSON of the verb `explore`, which names the database file; empty if the user named
// the database file.
int report_exploration(const Common& given, const ReportRequest& request, const std::filesystem::path& record = {}) {
  const std::filesystem::path path = request.result;
  const StudyReader store(path);
  std::optional<ShownWork> work(std::in_place, given.quiet, given.stop);
  ExplorationReport report = read_exploration(store, request.pareto);
  std::vector<std::string> files{"report.html"};
  if (record.empty()) files.emplace_back("exploration.json");
  std::string map;
  if (!request.map.empty()) {
    map = map_of(report, request.map);
    files.emplace_back("map.svg");
  }
  add_front_waveforms(report, store, work->progress());
  work.reset();
  Common c = given;
  if (c.out.empty()) c.out = record.empty() ? (path.parent_path() / path.stem()).string() + "-report" : folder_of(record);
  ResultFolder folder = *reserve_outputs(c, files);
  const Document document = exploration_document(report);
  folder.write("report.html", page_html(document));
  if (record.empty()) {
    nlohmann::json summary = exploration_json(report);
    summary["store"] = std::filesystem::proximate(path, folder.path()).string();
    folder.write("exploration.json", json_text(summary, 2) + "\n");
  }
  if (!map.empty()) folder.write("map.svg", map);
  folder.publish(false);
  print(terminal_text(document) + files_written(c.out, files));
  return exit_done;
}

// Returns the JSON file that a verb wrote to a folder. Throws InvalidInput if the folder has none.
std::filesystem::path record_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const verbs::Study& study : verbs::all_studies()) {
    std::ranges::copy_if(study.files, std::back_inserter(names), [](const auto& name) { return name.ends_with(".json"); });
  }
  for (const std::string& name : names) {
    std::error_code ignored;
    if (std::filesystem::exists(folder / name, ignored)) return folder / name;
  }
  throw InvalidInput(fmt::format("{}: must hold one of {}; name the folder of --out", folder.string(), fmt::join(names, ", ")));
}

// Writes the files of a report, except JSON, to --out or to the folder of the JSON file `record`, and prints the text of the
// report.
int leave(Common c, const std::filesystem::path& record, std::vector<verbs::Outcome::File> all, const std::string& text) {
  std::erase_if(all, [](const auto& file) { return file.name.ends_with(".json"); });
  std::vector<std::string> files;
  for (const auto& file : all) files.push_back(file.name);
  if (files.empty()) return print(text), exit_done;
  if (c.out.empty()) c.out = folder_of(record);
  ResultFolder folder = *reserve_outputs(c, files);
  for (const verbs::Outcome::File& file : all) folder.write(file.name, file.text());
  folder.publish(false);
  print(text + files_written(c.out, files));
  return exit_done;
}

// Returns the path of the database file that the JSON of an exploration names. A relative path starts from the folder of the
// JSON, or else from the current folder.
std::string store_of(const nlohmann::json& j, const std::filesystem::path& record) {
  const std::filesystem::path named = internal::read_json<std::string>(internal::value_at(j, "store"));
  for (const std::filesystem::path& place : {record.parent_path() / named, named}) {
    if (!named.empty() && is_store(place.string())) return place.string();
  }
  throw InvalidInput(fmt::format("{}: \"store\" must name the store of the exploration, but '{}' is not a store", record.string(),
                                 shortened(printable_line(named.string()))));
}

// Returns the figures of merit that span the Pareto front in the JSON, in the form of the option --pareto.
std::string aims_of(const nlohmann::json& j) {
  std::string aims;
  for (const nlohmann::json& one : internal::value_at(internal::value_at(j, "pareto"), "aims")) {
    aims += (aims.empty() ? "" : ",") + std::string(internal::value_at(one, "better") == "large" ? largest_mark : "") +
            internal::read_json<std::string>(internal::value_at(one, "figure"));
  }
  return aims;
}

std::function<verbs::Outcome(const nlohmann::json&)> reader_of(const std::string& kind) {
  if (kind == "modes") return modes_shown_again;
  const auto study = std::ranges::find(verbs::all_studies(), kind, [](const verbs::Study& one) { return one.name; });
  return study == verbs::all_studies().end() ? nullptr : study->shown_again;
}

int report_verb(const Common& given, const ReportRequest& request) {
  if (is_store(request.result)) return report_exploration(given, request);
  const std::filesystem::path path =
      is_folder(request.result) ? record_in(request.result) : std::filesystem::path(request.result);
  const nlohmann::json j = parse_record(read_file(path), path.string());
  const std::string kind = j["kind"].get<std::string>();
  if (kind == "exploration") {
    require_version(j, path.string());
    const std::string pareto = request.pareto.empty() ? aims_of(j) : request.pareto;
    return report_exploration(given, {.result = store_of(j, path), .pareto = pareto, .map = request.map}, path);
  }
  require(request.pareto.empty() && request.map.empty(),
          [&] { return fmt::format("{}: --pareto and --map require an exploration", request.result); });
  const auto shown_again = reader_of(kind);
  require(shown_again != nullptr, [&] {
    return fmt::format("{}: no report is made for JSON of kind '{}'", path.string(), shortened(printable_line(kind)));
  });
  require_version(j, path.string());
  const verbs::Outcome found = [&] {
    try {
      return shown_again(j);
    } catch (const InvalidInput& error) {
      throw InvalidInput(fmt::format("{}: {}", path.string(), error.what()));
    }
  }();
  return leave(given, path, found.files, found.text + found.last);
}

}  // namespace

void add_report(Verb& verb) {
  const auto request = std::make_shared<ReportRequest>();
  verb.positional("RESULT", request->result,
                  "result folder (the --out of an earlier run), JSON of any verb, or store of an exploration");
  verb.with_out("folder for the files (default: that of the result; STORE-report for a store)");
  verb.with_quiet();
  verb.option("--pareto", request->pareto, "FIGURES",
              "for a store: mark the Pareto front of these figures, such as \"initial_contact_time,impact_velocity\"; "
              "max:FIGURE maximises a figure");
  verb.option("--map", request->map, "FIGURE",
              "for a store: also write map.svg, the figure over the first two variables of a grid, "
              "or over ACROSS and UP of FIGURE:ACROSS:UP");
  verb.footer(
      "Examples:\n  softland report softland-out\n"
      "  softland report map.sqlite --map impact_velocity --pareto initial_contact_time,impact_velocity");
  verb.runs([request](const Common& common) { return report_verb(common, *request); });
}

}  // namespace softland::apps
