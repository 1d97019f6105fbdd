// Verb `release`: a waveform that opens the closed switch without residual vibration.
#include <memory>
#include <string>
#include <vector>

#include "reports/record_file.h"
#include "reports/release_report.h"
#include "studies/search/opening.h"
#include "verbs/study.h"

namespace softland::verbs {
namespace {

Outcome shown(ReleaseRecord found) {
  const auto record = std::make_shared<const ReleaseRecord>(std::move(found));
  Outcome outcome{.json = without_curves(json_of(*record)), .text = text_of(*record)};
  outcome.files = {{"release.json", [record] { return json_text(json_of(*record), 1) + "\n"; }, "release.json"}};
  if (!record->gaps.empty()) outcome.files.push_back({"release.svg", [record] { return svg_of(*record); }, "release.svg"});
  return outcome;
}

struct ReleaseRequest : Usual {
  static constexpr bool is_explorable = true;
  static constexpr auto name = "release",
                        about = "search the drive waveform that opens the closed switch without leaving it to swing",
                        python = "opening",
                        leaves =
                            "folder for release.json, release.svg, the drives as release.csv and as release.toml, for export";
  static constexpr auto remarks =
      "The switch rests on its contact under the scene's hold levels, and the command to open comes at t = 0. Drives that go\n"
      "to 0 V at once leave the switch swinging about its open position. The search finds two pulses of every drive that stop\n"
      "it there, within the limits of [driver.*].\n"
      "Examples:\n  softland release scenes/mem-gold.toml\n"
      "  softland release scenes/mem-gold-pzt.toml --actuator both --out opened";
  static std::vector<std::string> files() { return {"release.json", "release.svg", "release.csv", "release.toml"}; }
  static Outcome shown_again(const nlohmann::json& json) { return shown(read_release(json)); }

  OpeningOptions options{.band = 0.05, .jobs = one_per_core()};
};

template <class Archive>
void options(Archive& a, ReleaseRequest& r) {
  OpeningOptions& o = r.options;
  a.choice("actuator", o.actuator, actuators, "drives that may brake the opening");
  a.quantity("band", o.band,
             {dimension::none,
              {.least = 0, .most = 1, .least_open = true, .most_open = true},
              "a share of the contact gap above 0 % and below 100 %, such as \"5 %\""},
             "SHARE", "share of the contact gap within which the switch counts as open (default: 5 %)");
  a.whole("budget", o.max_evaluations, {.least = 1}, "evaluations (default: 3000)");
  samples_option(a, o.devices, {.least = 0, .most = SamplePoints::largest_size},
                 "devices of [spread] on which both openings are evaluated (default: 200; 0: none)");
  seed_option(a, o.seed, "same waveform");
  jobs_option(a, o.jobs);
}

Outcome run(const Setting& setting, const ReleaseRequest& request) {
  const auto found = std::make_shared<const OpeningResult>(search_opening(setting.scene, request.options, setting.watch));
  Outcome outcome = shown(record_of(*found, setting.command));
  outcome.files.push_back({"release.csv", [found] { return release_csv(*found); }, "release.csv"});
  outcome.files.push_back({"release.toml", [found] { return found->scene->text(); }, "release.toml"});
  if (!found->interrupted) outcome.next = "\nFor a generator:\n  softland export {}\n";
  outcome.ending = found->interrupted                                            ? Ending::interrupted
                   : found->plain.trajectory.status == Status::numerical_failure ? Ending::numerical_failure
                   : found->better                                               ? Ending::done
                                                                                 : Ending::no_success;
  return outcome;
}

}  // namespace

Study release_study() { return study_of<ReleaseRequest>(); }

}  // namespace softland::verbs
