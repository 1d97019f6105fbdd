// How drives do on devices that differ as [spread] says.
#include "studies/devices/robustness.h"

#include <fmt/format.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/exit_status.h"
#include "apps/output.h"
#include "apps/progress.h"
#include "apps/scenes.h"
#include "apps/values.h"
#include "apps/verbs/verbs.h"
#include "base/engineering.h"
#include "base/require.h"
#include "config/assumed_spread.h"
#include "config/calibration_words.h"
#include "reports/report_files.h"
#include "reports/robustness_report.h"
#include "studies/closing/auto_settings.h"
#include "studies/devices/box_and_chaos.h"

namespace softland::apps {
namespace {

// The scene of the worst device of the box.
std::string box_file(std::string_view key) { return fmt::format("box-{}.toml", figure_of(key).symbol); }

struct RobustnessRequest {
  std::vector<std::string> results;  ///< whose drives are judged as well
  std::string points = "sobol";
  std::string calibration;             ///< what is measured on every device; empty: what the scene says
  bool box_and_chaos = false;          ///< ranges over a box, and polynomial chaos, beside the sample
  std::optional<std::string> samples;  ///< default: 2000
  std::optional<std::string> seed;     ///< default: 1
  std::optional<std::string> jobs;     ///< default: one per core
};

int robustness_verb(const Common& c, const RobustnessRequest& request) {
  RobustnessOptions options{.jobs = job_count(request.jobs)};
  options.samples = sample_count(request.samples, options.samples, 1, SamplePoints::largest_size);
  options.seed = seed_of(request.seed, options.seed);
  options.points = point_set(request.points);

  SceneFile file = load_scene_or_result(c);
  const bool spread_assumed = assume_spread(file);
  set_calibration(file, request.calibration);
  options.worth_of_measuring = true;
  std::optional<WatchedWork> work(std::in_place, c.quiet, c.stop);
  const PreparedScene nominal = prepare_and_choose(file, true, work->watch());
  const Calibration& calibration = nominal.scene.calibration;
  std::vector<NamedDrive> drives{{.name = c.scene, .waveforms = nominal.drives.waveforms(), .calibration = calibration}};
  for (const std::string& result : request.results) {
    const PreparedScene other = prepare(scene_of_result(result), false, work->watch());
    const std::string elsewhere = begins_elsewhere(other.drives.waveforms(), other.drives.before(), nominal);
    require(elsewhere.empty(), [&] { return result + ": " + elsewhere; });
    drives.push_back({.name = result, .waveforms = other.drives.waveforms(), .calibration = calibration});
  }
  std::vector<std::string> files(robustness_files.begin(), robustness_files.end());
  constexpr std::size_t most_worst = 3;
  for (std::size_t i = 1; i <= most_worst; ++i) files.push_back(fmt::format("worst-{}.toml", i));
  for (const std::string_view key : explained_figures) files.push_back(box_file(key));
  std::optional<ResultFolder> folder = claim_places(c, files);

  const Robustness found = robustness(nominal, drives, options, work->watch());
  RobustnessReport report{
      .nominal = nominal, .found = found, .options = options, .command = c.command, .spread_assumed = spread_assumed};
  add_details(report, request.box_and_chaos, work->watch());
  const nlohmann::json j = robustness_json(report);
  std::string text = terminal_text(robustness_document(report));
  work.reset();
  if (folder) {
    write_files(*folder, report);
    const DriveRobustness& last = found.drives.back();
    for (std::size_t i = 0; i < most_worst && i < last.worst.size(); ++i)
      folder->write(fmt::format("worst-{}.toml", i + 1), scene_of_device(nominal, last, last.worst[i], options).text());
    std::vector<std::string> left{"robustness.html", "robustness.json", "devices.csv",
                                  "worst-*.toml (the worst devices of the last drive, for `softland simulate`)"};
    if (report.box_and_chaos && !report.box_and_chaos->ranges.empty()) {
      for (const FigureRange& range : report.box_and_chaos->ranges) {
        if (!range.most.values.empty())
          folder->write(box_file(range.key), scene_of_device(nominal, last, range.most, options).text());
      }
      left.emplace_back("box-*.toml (those of the box)");
    }
    text += left_in(folder->destination(report.interrupted), left);
    folder->publish(report.interrupted);
  }
  print_json_or(c, j, text);
  return report.interrupted ? exit_interrupted : report.unheld.empty() ? exit_done : exit_no_success;
}

}  // namespace

void add_robustness(Verb& verb) {
  const auto request = std::make_shared<RobustnessRequest>();
  verb.with_scene_or_result();
  verb.more("RESULT", request->results, "more of them, whose drives are judged on the devices of the first");
  verb.with_set("change one key of the first: --set spread.gaps.cov=\"1 %\"");
  verb.with_quiet();
  verb.with_json();
  verb.with_samples(request->samples, "devices (default: 2000)");
  verb.with_points(request->points);
  verb.option("--calibrate", request->calibration, "LIST",
              "measured on every device before it is driven, as for optimize; the report says what each measurement is worth");
  verb.flag("--other-ways", request->box_and_chaos,
            fmt::format("beside the sample, for the last drive: the worst and the best device of a box, by search, and "
                        "polynomial chaos; {} closings more",
                        2 * explained_figures.size() * BoxAndChaosOptions{}.closings_per_search));
  verb.with_seed(request->seed, "same devices");
  verb.with_jobs(request->jobs);
  verb.with_out("folder for robustness.html, robustness.json, devices.csv and the worst devices as scenes");
  verb.footer(
      "The plain step to the same hold levels is judged beside every drive. Every device gets the volts of the nominal one,\n"
      "or, where it is calibrated, the same waveform in its own units. Exact derivatives of the nominal device's figures by\n"
      "what varies stand beside the sample; they know nothing of rebounds that come or go.\n"
      "Examples:\n  softland robustness scenes/mem-gold.toml --samples 500\n"
      "  softland robustness scenes/mem-gold.toml --other-ways --out box\n"
      "  softland robustness scenes/mem-gold.toml softland-out --out robust");
  verb.runs([request](const Common& common) { return robustness_verb(common, *request); });
}

}  // namespace softland::apps
