// The report of what a study found, made again, or of an exploration.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
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
#include "base/read_file.h"
#include "base/require.h"
#include "reports/exploration_report.h"
#include "reports/explored.h"
#include "reports/report_files.h"
#include "reports/result_document.h"
#include "reports/result_reader.h"
#include "reports/text.h"
#include "store/study_store.h"
#include "verbs/study.h"

namespace softland::apps {
namespace {

struct ReportRequest {
  std::string result;
  std::string pareto;  ///< of an exploration: the figures of its front
  std::string map;     ///< of an exploration: the picture's figure, and over which two variables
};

// The column that an option names.
std::size_t column_named(const ExplorationReport& report, const std::string& name, bool is_variable) {
  std::string there;
  for (std::size_t c = 0; c < report.columns.size(); ++c) {
    const ExploredColumn& column = report.columns[c];
    if (column.is_variable != is_variable) continue;
    if (goes_by(column, name)) return c;
    there += (there.empty() ? "" : ", ") + (is_variable ? column.name : column.key);
  }
  throw InvalidInput(fmt::format("--map {}: is no {} of this exploration: {}", name, is_variable ? "variable" : "figure", there));
}

// The picture that --map asks for, FIGURE or FIGURE:ACROSS:UP.
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
  require(axes.size() >= 2, [&] { return fmt::format("--map {}: the points lie on no grid of two variables or more", words); });
  return exploration_map_svg(report, axes[0], axes[1], figure);
}

int report_exploration(const Common& given, const ReportRequest& request) {
  const std::filesystem::path path = request.result;
  const StudyReader store(path);
  std::optional<WatchedWork> work(std::in_place, given.quiet, given.stop);
  ExplorationReport report = explored(store, request.pareto);
  std::vector<std::string> files{"report.html", "exploration.json"};
  std::string map;
  if (!request.map.empty()) {
    map = map_of(report, request.map);
    files.emplace_back("map.svg");
  }
  add_front_waveforms(report, store, work->watch());
  work.reset();
  Common c = given;
  if (c.out.empty()) c.out = (path.parent_path() / path.stem()).string() + "-report";
  ResultFolder folder = *claim_places(c, files);
  const Document document = exploration_document(report);
  folder.write("report.html", page_html(document));
  folder.write("exploration.json", json_text(exploration_json(report), 2) + "\n");
  if (!map.empty()) folder.write("map.svg", map);
  folder.publish(false);
  print(terminal_text(document) + left_in(c.out, files));
  return exit_done;
}

// The JSON of a folder: the result of simulate or optimize, or what a study left there.
std::filesystem::path record_in(const std::filesystem::path& folder) {
  std::vector<std::string> names{"result.json"};
  for (const verbs::Study& study : verbs::all_studies()) {
    std::ranges::copy_if(study.files, std::back_inserter(names), [](const auto& name) { return name.ends_with(".json"); });
  }
  for (const std::string& name : names) {
    std::error_code ignored;
    if (std::filesystem::exists(folder / name, ignored)) return folder / name;
  }
  throw InvalidInput(fmt::format("{}: holds no result: none of {}", folder.string(), fmt::join(names, ", ")));
}

// Writes those files that --out has, and says what was found.
int leave(Common c, const std::filesystem::path& record, std::vector<verbs::Outcome::File> all, const std::string& text) {
  std::erase_if(all, [](const auto& file) { return file.name.ends_with(".json"); });
  std::vector<std::string> files;
  for (const auto& file : all) files.push_back(file.name);
  if (files.empty()) return print(text), exit_done;
  if (c.out.empty()) c.out = record.has_parent_path() ? record.parent_path().string() : ".";
  ResultFolder folder = *claim_places(c, files);
  for (const verbs::Outcome::File& file : all) folder.write(file.name, file.text());
  folder.publish(false);
  print(text + left_in(c.out, files));
  return exit_done;
}

int report_verb(const Common& given, const ReportRequest& request) {
  if (is_store(request.result)) return report_exploration(given, request);
  require(request.pareto.empty() && request.map.empty(),
          [&] { return fmt::format("{}: --pareto and --map are for the store of an exploration", request.result); });
  const std::filesystem::path path =
      is_folder(request.result) ? record_in(request.result) : std::filesystem::path(request.result);
  const nlohmann::json j = parse_record(read_file(path), path.string());
  const auto study = std::ranges::find(verbs::all_studies(), j["kind"], [](const verbs::Study& one) { return one.name; });
  if (study != verbs::all_studies().end() && study->shown_again) {
    require_version(j, path.string());
    const verbs::Outcome found = [&] {
      try {
        return study->shown_again(j);
      } catch (const InvalidInput& error) {
        throw InvalidInput(fmt::format("{}: {}", path.string(), error.what()));
      }
    }();
    return leave(given, path, found.files, found.text + found.last);
  }
  require_reportable(j, path.string());
  const Result r = read_result(j);
  std::vector<verbs::Outcome::File> files;
  for (const ReportFile<Result>& file : files_of(r)) files.push_back({file.name, [&r, text = file.text] { return text(r); }});
  return leave(given, path, files, terminal_text(result_document(r)));
}

}  // namespace

void add_report(Verb& verb) {
  const auto request = std::make_shared<ReportRequest>();
  verb.positional("RESULT", request->result, "folder that --out named, or the JSON of any study; or the store of an exploration");
  verb.with_out("folder to write them to (default: beside the result; STORE-report for a store)");
  verb.with_quiet();
  verb.option("--pareto", request->pareto, "FIGURES",
              "of a store: mark the points that no other one beats in all of these figures, \"initial_contact_time,"
              "impact_velocity\"; max:FIGURE is to be large");
  verb.option("--map", request->map, "FIGURE",
              "of a store: also map.svg, the figure over the first two variables of a grid, or over those of FIGURE:ACROSS:UP");
  verb.footer(
      "Examples:\n  softland report softland-out\n"
      "  softland report map.sqlite --map impact_velocity --pareto initial_contact_time,impact_velocity");
  verb.runs([request](const Common& common) { return report_verb(common, *request); });
}

}  // namespace softland::apps
