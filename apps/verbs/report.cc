// The report of a result, made again, or of an exploration.
#include <fmt/format.h>

#include <filesystem>
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
#include "base/require.h"
#include "reports/exploration_report.h"
#include "reports/explored.h"
#include "reports/report_files.h"
#include "reports/result_document.h"
#include "reports/result_reader.h"
#include "reports/text.h"
#include "store/study_store.h"

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

int report_verb(const Common& given, const ReportRequest& request) {
  if (is_store(request.result)) return report_exploration(given, request);
  const std::string& result = request.result;
  require(request.pareto.empty() && request.map.empty(),
          [&] { return fmt::format("{}: --pareto and --map are for the store of an exploration", result); });
  const std::filesystem::path path =
      is_folder(result) ? std::filesystem::path(result) / "result.json" : std::filesystem::path(result);
  const nlohmann::json j = load_result(path);
  require_reportable(j, path.string());
  Common c = given;
  if (c.out.empty()) c.out = path.has_parent_path() ? path.parent_path().string() : ".";
  const Result r = read_result(j);
  std::vector<ReportFile<Result>> pictures = files_of(r);
  std::erase_if(pictures, [](const auto& file) { return !file.name.ends_with(".html") && !file.name.ends_with(".svg"); });
  std::vector<std::string> files;
  for (const auto& file : pictures) files.push_back(file.name);
  ResultFolder folder = *claim_places(c, files);
  for (const auto& file : pictures) folder.write(file.name, file.text(r));
  folder.publish(false);
  print(terminal_text(result_document(r)) + left_in(c.out, files));
  return exit_done;
}

}  // namespace

void add_report(Verb& verb) {
  const auto request = std::make_shared<ReportRequest>();
  verb.positional("RESULT", request->result, "folder that --out named, or its result.json; or the store of an exploration");
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
