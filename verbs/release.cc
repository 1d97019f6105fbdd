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
  static constexpr auto
      name = "release",
      about = "search a drive waveform that opens the closed switch without residual vibration", python = "opening",
      leaves = "folder for release.json, release.svg, and the waveforms as release.csv and as release.toml (for export)";
  static constexpr auto remarks =
      "The switch is closed at the hold voltages of the scene, and the command to open comes at t = 0. "
      "If all drives go to 0 V\n"
      "at once, the switch vibrates about its open position. The search finds two pulses of every drive that bring it to rest\n"
      "there, within the limits of [driver.*]. They are recommended if the switch settles at least 5 % earlier, or vibrates at\n"
      "least 5 % less if it does not settle; otherwise the exit status is 4.\n"
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
             "SHARE", "the switch counts as open within this share of the contact gap about its rest position (default: 5 %)");
  a.whole("budget", o.max_evaluations, {.least = 1}, "number of evaluations (default: 3000)");
  samples_option(
      a, o.devices, {.least = 0, .most = SamplePoints::largest_size},
      "number of devices varied by [spread] on which the abrupt and the found opening are simulated (default: 200; 0: none)");
  seed_option(a, o.seed, "the same waveform");
  jobs_option(a, o.jobs);
}

Outcome run(const Setting& setting, const ReleaseRequest& request) {
  const auto found = std::make_shared<const OpeningResult>(search_opening(setting.scene, request.options, setting.progress));
  Outcome outcome = shown(record_of(*found, setting.command));
  outcome.files.push_back({"release.csv", [found] { return release_csv(*found); }, "release.csv"});
  outcome.files.push_back({"release.toml", [found] { return found->scene->text(); }, "release.toml"});
  if (!found->interrupted && found->better) outcome.next = "\nFor a generator:\n  softland export {}\n";
  outcome.ending = found->interrupted                                            ? Ending::interrupted
                   : found->plain.trajectory.status == Status::numerical_failure ? Ending::numerical_failure
                   : found->better                                               ? Ending::done
                                                                                 : Ending::no_success;
  return outcome;
}

}  // namespace

Study release_study() { return study_of<ReleaseRequest>(); }

}  // namespace softland::verbs
