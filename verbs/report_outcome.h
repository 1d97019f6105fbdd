// Reports (reports/report_files.h) as the outcome of a verb.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "reports/report_files.h"
#include "reports/result_document.h"
#include "reports/result_json.h"
#include "reports/result_reader.h"
#include "verbs/study.h"

namespace softland::verbs {

template <class Report>
[[nodiscard]] std::vector<Outcome::File> files_of_report(const std::shared_ptr<const Report>& report) {
  std::vector<Outcome::File> files;
  for (ReportFile<Report>& file : softland::files_of(*report))
    files.push_back({file.name, [report, text = std::move(file.text)] { return text(*report); }, file.name});
  return files;
}

[[nodiscard]] inline Outcome result_shown(const std::shared_ptr<const Result>& result) {
  return {.json = summary_json(result_json(*result)),
          .text = terminal_text(result_document(*result)),
          .files = files_of_report(result)};
}

/// The result of simulate or optimize from its JSON; that of --json has no curves, which all of its files show.
[[nodiscard]] inline Outcome result_shown_again(const nlohmann::json& json) {
  require_reportable(json);
  Outcome outcome = result_shown(std::make_shared<const Result>(read_result(json)));
  if (!json.contains("curves")) outcome.files.clear();
  return outcome;
}

}  // namespace softland::verbs
