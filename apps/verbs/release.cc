// The waveform that opens a closed switch without leaving it to swing.
#include <fmt/format.h>

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/exit_status.h"
#include "apps/output.h"
#include "apps/progress.h"
#include "apps/scenes.h"
#include "apps/values.h"
#include "apps/verbs/verbs.h"
#include "base/require.h"
#include "base/shell_word.h"
#include "config/units.h"
#include "reports/release_report.h"
#include "sampling/points.h"
#include "studies/search/opening.h"

namespace softland::apps {
namespace {

struct ReleaseRequest {
  std::string actuator = "electrostatic", band = "5 %";
  std::optional<std::string> budget, samples, seed, jobs;
};

double share_of(const std::string& text) {
  const auto rule = [&](bool ok) {
    require(ok, fmt::format("--band {}: must be a share of the contact gap above 0 % and below 100 %, such as \"5 %\"",
                            visible(text)));
  };
  Quantity q;
  try {
    q = parse_quantity(text);
  } catch (const InvalidInput&) {
    rule(false);
  }
  rule(q.dimension == dimension::none && q.value > 0 && q.value < 1);
  return q.value;
}

OpeningOptions options_of(const ReleaseRequest& request) {
  const Named<Actuator>* actuator = find_named(actuators, request.actuator);
  require(actuator != nullptr, [&] { return fmt::format("--actuator {}: must be {}", request.actuator, listed(actuators)); });
  OpeningOptions options{.actuator = actuator->value, .band = share_of(request.band)};
  if (request.budget) options.max_evaluations = whole_number<long>("--budget", *request.budget, 1);
  options.devices = sample_count(request.samples, options.devices, 0, SamplePoints::largest_size);
  options.seed = seed_of(request.seed, options.seed);
  options.jobs = job_count(request.jobs);
  return options;
}

int release_verb(const Common& c, const ReleaseRequest& request) {
  const OpeningOptions options = options_of(request);
  const SceneFile file = load_scene_or_result(c);
  const std::vector<std::string> files{"release.json", "release.svg", "release.csv", "release.toml"};
  std::optional<ResultFolder> folder = claim_places(c, files);
  std::optional<WatchedWork> work(std::in_place, c.quiet, c.stop);
  const OpeningResult found = search_opening(file, options, work->watch());
  work.reset();
  const nlohmann::json data = release_json(found, {.command = c.command});
  std::string text = release_text(found);
  if (folder) {
    folder->write("release.json", json_text(data, 1) + "\n");
    folder->write("release.svg", release_svg(found));
    folder->write("release.csv", release_csv(found));
    folder->write("release.toml", found.scene->text());
    const std::filesystem::path place = folder->destination(found.interrupted);
    text += left_in(place, files);
    if (!found.interrupted)
      text += "\nFor a generator:\n  softland export " + shell_word((place / "release.toml").string()) + "\n";
    folder->publish(found.interrupted);
  }
  print_json_or(c, data, text);
  if (found.interrupted) return exit_interrupted;
  if (found.plain.trajectory.status == Status::numerical_failure) return exit_numerical_failure;
  return found.better ? exit_done : exit_no_success;
}

}  // namespace

void add_release(Verb& verb) {
  const auto request = std::make_shared<ReleaseRequest>();
  verb.with_scene(true, true);
  verb.with_json();
  verb.option("--actuator", request->actuator, "NAME", "drives that may brake: " + first_is_default(listed(actuators)));
  verb.option("--band", request->band, "SHARE",
              "of the contact gap: nearer to its open position the switch counts as open (default: 5 %)");
  verb.optional("--budget", request->budget, "N", "evaluations (default: 3000)");
  verb.optional("--samples", request->samples, "N",
                "devices of [spread] that both openings are judged on (default: 200; 0: none)");
  verb.with_seed(request->seed, "same waveform");
  verb.with_jobs(request->jobs);
  verb.with_out("folder for release.json, release.svg, the drives as release.csv and as release.toml, for export");
  verb.footer(
      "The switch rests on its contact under the scene's hold levels, and opens at t = 0. Dropped to 0 V at once it swings "
      "about\n"
      "its open position; the search finds two pulses of every drive that stop it there, within the limits of [driver.*].\n"
      "Examples:\n  softland release scenes/mem-gold.toml\n"
      "  softland release scenes/mem-gold-pzt.toml --actuator both --out opened");
  verb.runs([request](const Common& common) { return release_verb(common, *request); });
}

}  // namespace softland::apps
