// Verb `robustness`: evaluates waveforms on devices with the process variation of [spread].
#include "studies/devices/robustness.h"

#include <fmt/format.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/assumed_spread.h"
#include "config/calibration_prose.h"
#include "reports/record_file.h"
#include "reports/report_files.h"
#include "reports/robustness_report.h"
#include "studies/closing/auto_settings.h"
#include "studies/closing/open_command.h"
#include "studies/devices/box_and_chaos.h"
#include "verbs/study.h"

namespace softland::verbs {
namespace {

constexpr std::size_t most_worst = 3;

std::string worst_file(std::size_t i) { return fmt::format("worst-{}.toml", i + 1); }
// Returns the name of the file with the scene of the worst device in the box of varied quantities, for a figure of merit.
std::string box_file(std::string_view key) { return fmt::format("box-{}.toml", figure_of(key).symbol); }

Outcome shown(const RobustnessRecord& record) {
  Outcome outcome{.json = json_of(record), .text = terminal_text(document_of(record))};
  outcome.files = {{robustness_files[1], [json = outcome.json] { return json_text(json, 2); }, robustness_files[1]}};
  return outcome;
}

struct RobustnessRequest : Usual {
  static constexpr auto name = "robustness", about = "evaluate drive waveforms under the process variation of [spread]",
                        python = "robustness", scene = varied_scene,
                        leaves = "folder for robustness.html, robustness.json, devices.csv and the worst devices as scenes",
                        changes = "change one key of the first scene, such as --set spread.gaps.cov=\"1 %\"";
  static constexpr auto remarks =
      "The plain step to the same hold voltages is evaluated for comparison. Every device gets the voltages of the nominal\n"
      "design or, with per-device calibration, the waveform scaled by its own measurements. The report adds exact derivatives\n"
      "of the nominal figures by the varied parameters. They do not account for rebounds that appear or vanish.\n"
      "Examples:\n  softland robustness scenes/mem-gold.toml --samples 500\n"
      "  softland robustness scenes/mem-gold.toml --other-ways --out box\n"
      "  softland robustness scenes/mem-gold.toml softland-out --out robust";
  static std::vector<std::string> files() {
    std::vector<std::string> all(robustness_files.begin(), robustness_files.end());
    for (std::size_t i = 0; i < most_worst; ++i) all.push_back(worst_file(i));
    for (const std::string_view key : explained_figures) all.push_back(box_file(key));
    return all;
  }

  // Shows the outcome again without its diagrams, which need the figures of merit of all devices from devices.csv.
  static Outcome shown_again(const nlohmann::json& json) { return shown(read_robustness(json)); }

  RobustnessOptions options{.jobs = one_per_core(), .worth_of_measuring = true, .opens_on_command = true};
  std::vector<std::string> results;  ///< further results whose waveforms are evaluated on the devices
  std::string calibration;           ///< measurements that are made on every device; empty: those of the scene's [calibration]
  /// True: the range of figures of merit over a box of varied quantities, and polynomial chaos, are computed too.
  bool box_and_chaos = false;
};

template <class Archive>
void options(Archive& a, RobustnessRequest& r) {
  a.results("RESULT", r.results, "further results whose waveforms are evaluated on the devices of the first scene");
  samples_option(a, r.options.samples, {.least = 1, .most = SamplePoints::largest_size},
                 "number of simulated devices (default: 2000)");
  a.choice("points", r.options.points, point_sets, "point set of the devices");
  a.text(
      "calibrate", r.calibration, "LIST",
      "per-device calibration, as in optimize: figures measured on every device; the report gives the value of each measurement");
  a.flag("other-ways", r.box_and_chaos,
         fmt::format("add, for the last waveform, the worst and the best device of a box (found by search) "
                     "and polynomial chaos: "
                     "{} more closings",
                     2 * explained_figures.size() * BoxAndChaosOptions{}.closings_per_search));
  seed_option(a, r.options.seed, "the same devices");
  jobs_option(a, r.options.jobs);
}

// The findings on devices and their report; the report keeps references to `nominal` and `found`.
struct Judged {
  std::shared_ptr<const PreparedScene> nominal;
  Robustness found = {};
  std::optional<RobustnessReport> report = {};
};

std::shared_ptr<const PreparedScene> nominal_of(const Setting& setting, const RobustnessRequest& request, bool& spread_assumed) {
  SceneFile file = setting.scene;
  spread_assumed = assume_spread(file);
  set_calibration(file, request.calibration);
  if (!spread_assumed && request.calibration.empty())
    return std::make_shared<const PreparedScene>(closing_of(*setting.prepared(true)));
  return std::make_shared<const PreparedScene>(closing_of(prepare_and_choose(file, true, setting.progress)));
}

std::vector<Outcome::File> files_of(const std::shared_ptr<const Judged>& judged) {
  std::vector<Outcome::File> files;
  const RobustnessReport& report = *judged->report;
  for (ReportFile<RobustnessReport>& one : softland::files_of(report))
    files.push_back({one.name, [judged, text = std::move(one.text)] { return text(*judged->report); }, one.name});
  const auto add = [&]<class WhichDevice>(std::string name, const WhichDevice& device, const char* listed) {
    const auto text = [judged, device] {
      return scene_of_device(*judged->nominal, judged->found.drives.back(), device, judged->report->options).text();
    };
    files.push_back({std::move(name), text, listed});
  };
  const std::vector<std::size_t>& worst = judged->found.drives.back().worst;
  for (std::size_t i = 0; i < std::min(most_worst, worst.size()); ++i)
    add(worst_file(i), worst[i], i == 0 ? "worst-*.toml (the worst devices of the last waveform, for `softland simulate`)" : "");
  if (!report.box_and_chaos) return files;
  const char* listed = "box-*.toml (the worst devices of the box)";
  for (const FigureRange& range : report.box_and_chaos->ranges) {
    if (range.most.values.empty()) continue;
    add(box_file(range.key), range.most, std::exchange(listed, ""));
  }
  return files;
}

Outcome run(const Setting& setting, const RobustnessRequest& request) {
  const auto judged = std::make_shared<Judged>();
  bool spread_assumed = false;
  judged->nominal = nominal_of(setting, request, spread_assumed);
  const PreparedScene& nominal = *judged->nominal;
  const Calibration& calibration = nominal.scene.calibration;
  std::vector<NamedDrive> drives{{.name = setting.name, .waveforms = nominal.drives.waveforms(), .calibration = calibration}};
  for (const std::string& result : request.results)
    drives.push_back({.name = result, .waveforms = setting.waveforms_of(result, nominal), .calibration = calibration});
  judged->found = robustness(nominal, drives, request.options, setting.progress);
  judged->report.emplace(RobustnessReport{.nominal = nominal,
                                          .found = judged->found,
                                          .options = request.options,
                                          .command = setting.command,
                                          .spread_assumed = spread_assumed});
  RobustnessReport& report = *judged->report;
  add_details(report, request.box_and_chaos, setting.progress);
  Outcome outcome = shown(record_of(report));
  outcome.files = files_of(judged);
  outcome.ending = report.interrupted ? Ending::interrupted : report.unheld.empty() ? Ending::done : Ending::no_success;
  return outcome;
}

}  // namespace

Study robustness_study() { return study_of<RobustnessRequest>(); }

}  // namespace softland::verbs
