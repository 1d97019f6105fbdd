// Makes the outcome of a verb from a report (reports/report_files.h).
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "reports/closing_document.h"
#include "reports/closing_record.h"
#include "reports/record_file.h"
#include "reports/report_files.h"
#include "verbs/study.h"

namespace softland::verbs {

template <class Report>
[[nodiscard]] std::vector<Outcome::File> files_of_report(const std::shared_ptr<const Report>& report) {
  std::vector<Outcome::File> files;
  for (ReportFile<Report>& file : softland::files_of(*report))
    files.push_back({file.name, [report, text = std::move(file.text)] { return text(*report); }, file.name});
  return files;
}

[[nodiscard]] inline Outcome closing_shown(const std::shared_ptr<const ClosingRecord>& result) {
  return {
      .json = summary_json(json_of(*result)), .text = terminal_text(closing_document(*result)), .files = files_of_report(result)};
}

/// Makes the outcome of `simulate` or `optimize` again from its JSON. JSON without curves, as --json writes it, gives an
/// outcome without files, because all files need the curves.
[[nodiscard]] inline Outcome closing_shown_again(const nlohmann::json& json) {
  require_reportable(json);
  Outcome outcome = closing_shown(std::make_shared<const ClosingRecord>(read_closing(json)));
  if (!json.contains("curves")) outcome.files.clear();
  return outcome;
}

}  // namespace softland::verbs
