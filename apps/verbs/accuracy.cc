// What accuracy costs in time.
#include "studies/closing/accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "apps/output.h"
#include "apps/progress.h"
#include "apps/scenes.h"
#include "apps/verbs/verbs.h"
#include "reports/accuracy_report.h"
#include "studies/closing/auto_settings.h"

namespace softland::apps {
namespace {

int accuracy_verb(const Common& c) {
  const SceneFile file = load_scene_or_result(c);
  const PreparedScene p = prepare_and_choose(file, false, WatchedWork(c.quiet, c.stop).watch());
  std::optional<ResultFolder> folder = claim_places(c, {"report.html", "accuracy.svg", "accuracy.json"});
  Bar bar(c.quiet);
  AccuracyOptions options{.stop = c.stop};
  std::size_t done = 0, of = 0;
  const auto state = [&](double elapsed) {
    const double part = static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(1, of));
    const std::string left = done > 0 ? fmt::format(", about {:.0f} s left", elapsed * (1 - part) / part) : "";
    return std::pair(part, fmt::format("{} of {} settings, {:.0f} s{}", done, of, elapsed, left));
  };
  options.on_progress = [&](std::size_t now, std::size_t all) {
    done = now;
    of = all;
    bar.show(state);
  };
  const AccuracyStudy study = study_accuracy(p, options);
  bar.close(state);
  const nlohmann::json j = accuracy_json(p, study, {.command = c.command});
  const Document document = accuracy_document(p, study, {.command = c.command});
  std::string text = terminal_text(document);
  if (folder && !study.rows.empty()) {
    folder->write("report.html", page_html(document));
    folder->write("accuracy.svg", accuracy_svg(p.scene.title, study));
    folder->write("accuracy.json", json_text(j, 2));
    const bool interrupted = study.status == Status::interrupted;
    text += left_in(folder->destination(interrupted), {"report.html", "accuracy.svg", "accuracy.json"});
    folder->publish(interrupted);
  }
  print_json_or(c, j, text);
  return exit_status_of(study.status);
}

}  // namespace

void add_accuracy(Verb& verb) {
  verb.with_scene(true, true);
  verb.with_json();
  verb.with_out("folder for report.html, accuracy.svg and accuracy.json");
  verb.footer(
      "Combinations that take more than 2 s per closing are cut, and listed as such.\n"
      "Example:\n  softland accuracy scenes/mem-gold.toml --set simulate.duration=\"100 us\" --out accuracy");
  verb.runs(accuracy_verb);
}

}  // namespace softland::apps
