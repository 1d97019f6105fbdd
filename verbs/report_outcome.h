// The files of a report (reports/report_files.h), as those of a verb.
#pragma once

#include <memory>
#include <utility>
#include <vector>

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

}  // namespace softland::verbs
