// Verb `accuracy`: errors of the figures against the time of a closing.
#include "studies/closing/accuracy.h"

#include <algorithm>
#include <memory>

#include "reports/accuracy_report.h"
#include "reports/result_json.h"
#include "verbs/study.h"

namespace softland::verbs {
namespace {

struct AccuracyRequest : Usual {
  static constexpr auto name = "accuracy",
                        about = "what accuracy costs in time: errors of the figures for every integrator and setting",
                        python = "accuracy", leaves = "folder for report.html, accuracy.svg and accuracy.json",
                        remarks =
                            "Combinations that take more than 2 s per closing are cut, and listed as such.\n"
                            "Example:\n  softland accuracy scenes/mem-gold.toml --set simulate.duration=\"100 us\" --out "
                            "accuracy";
  static std::vector<std::string> files() { return {"report.html", "accuracy.svg", "accuracy.json"}; }
};

template <class Archive>
void options(Archive&, AccuracyRequest&) {}

Outcome run(const Setting& setting, const AccuracyRequest&) {
  const auto scene = setting.prepared(false);
  const auto tell = [&](std::size_t done, std::size_t of) {
    setting.watch.tell("settings", static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(1, of)));
  };
  const auto found =
      std::make_shared<const AccuracyStudy>(study_accuracy(*scene, {.on_progress = tell, .stop = setting.watch.stop}));
  const Provenance provenance{.command = setting.command};
  const auto document = std::make_shared<const Document>(accuracy_document(*scene, *found, provenance));
  Outcome outcome{
      .json = accuracy_json(*scene, *found, provenance), .text = terminal_text(*document), .ending = ending_of(found->status)};
  if (found->rows.empty()) return outcome;
  outcome.files = {{"report.html", [document] { return page_html(*document); }, "report.html"},
                   {"accuracy.svg", [scene, found] { return accuracy_svg(scene->scene.title, *found); }, "accuracy.svg"},
                   {"accuracy.json", [json = outcome.json] { return json_text(json, 2); }, "accuracy.json"}};
  return outcome;
}

}  // namespace

Study accuracy_study() { return study_of<AccuracyRequest>(); }

}  // namespace softland::verbs
