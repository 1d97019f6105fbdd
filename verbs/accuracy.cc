// Verb `accuracy`: compares the errors of the figures of merit with the computing time of a closing, for several settings of
// the integrator.
#include "studies/closing/accuracy.h"

#include <algorithm>
#include <memory>

#include "reports/accuracy_report.h"
#include "reports/record_file.h"
#include "verbs/study.h"

namespace softland::verbs {
namespace {

Outcome shown(AccuracyRecord found) {
  const auto record = std::make_shared<const AccuracyRecord>(std::move(found));
  Outcome outcome{.json = json_of(*record), .text = terminal_text(document_of(*record))};
  if (record->found.rows.empty()) return outcome;
  outcome.files = {{"report.html", [record] { return page_html(document_of(*record)); }, "report.html"},
                   {"accuracy.svg", [record] { return svg_of(*record); }, "accuracy.svg"},
                   {"accuracy.json", [record] { return json_text(json_of(*record), 2); }, "accuracy.json"}};
  return outcome;
}

struct AccuracyRequest : Usual {
  static constexpr auto
      name = "accuracy",
      about = "compare integrators and their settings: errors of the figures against computing time", python = "accuracy",
      leaves = "folder for report.html, accuracy.svg and accuracy.json",
      remarks =
          "A combination of integrator and setting that takes more than 2 s of processor time per closing is stopped, and listed as such.\n"
          "Example:\n  softland accuracy scenes/mem-gold.toml --set simulate.duration=\"100 us\" --out accuracy";
  static std::vector<std::string> files() { return {"report.html", "accuracy.svg", "accuracy.json"}; }
  static Outcome shown_again(const nlohmann::json& json) { return shown(read_accuracy(json)); }
};

template <class Archive>
void options(Archive&, AccuracyRequest&) {}

Outcome run(const Setting& setting, const AccuracyRequest&) {
  const auto scene = setting.prepared(false);
  const auto tell = [&](std::size_t done, std::size_t of) {
    setting.progress.tell("settings", static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(1, of)));
  };
  const AccuracyStudy found = study_accuracy(*scene, {.on_progress = tell, .stop = setting.progress.stop});
  Outcome outcome = shown({.origin = whole_origin_of("accuracy", *scene, setting.command), .found = found});
  outcome.ending = ending_of(found.status);
  return outcome;
}

}  // namespace

Study accuracy_study() { return study_of<AccuracyRequest>(); }

}  // namespace softland::verbs
