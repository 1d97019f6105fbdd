// Which measurable figures of a device pin its waveform best.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "apps/exit_status.h"
#include "apps/output.h"
#include "apps/progress.h"
#include "apps/scenes.h"
#include "apps/values.h"
#include "apps/verbs/verbs.h"
#include "base/require.h"
#include "base/split.h"
#include "config/assumed_spread.h"
#include "config/units.h"
#include "reports/measurement_report.h"
#include "studies/search/identification.h"

namespace softland::apps {
namespace {

struct CalibrateRequest {
  std::string errors;                  ///< of measurements; empty: none err
  std::string steps;                   ///< whose closing times are measured; empty: the default ones
  std::optional<std::string> samples;  ///< default: 256
  std::optional<std::string> seed;     ///< default: 1
  std::optional<std::string> jobs;     ///< default: one per core
};

// "Vdp:1 %,time:0.5 %"
void read_errors(const std::string& list, IdentificationOptions& options) {
  const std::array<std::pair<std::string_view, double*>, 6> errors{{{"Vdp", &options.pull_in_error},
                                                                    {"Vsp", &options.static_pull_in_error},
                                                                    {"release", &options.release_error},
                                                                    {"frequency", &options.frequency_error},
                                                                    {"piezo", &options.piezo_error},
                                                                    {"time", &options.time_error}}};
  std::set<std::string_view> seen;
  for (const std::string& one : split(list, ',')) {
    const std::size_t colon = one.find(':');
    const auto row = std::find_if(errors.begin(), errors.end(), [&](const auto& e) { return e.first == one.substr(0, colon); });
    constexpr double most = 0.5;
    Quantity q{.value = -1, .dimension = dimension::none};
    try {
      if (row != errors.end() && colon != std::string::npos) q = parse_quantity(one.substr(colon + 1));
    } catch (const InvalidInput& error) {
      throw InvalidInput(fmt::format("--error {}: {}", one, error.what()));
    }
    require(q.dimension == dimension::none && q.value >= 0 && q.value <= most, [&] {
      return fmt::format(
          "--error {}: must be Vdp, Vsp, release, frequency, piezo or time with an error from 0 to 50 %, such as \"Vdp:1 %\"",
          visible(list));
    });
    require(seen.insert(row->first).second,
            [&] { return fmt::format("--error {}: {} stands twice", visible(list), row->first); });
    *row->second = q.value;
  }
}

// "1.1,1.25"
std::vector<double> read_steps(const std::string& list) {
  std::vector<double> steps;
  for (const std::string& one : split(list, ',')) {
    constexpr double most = 10;
    double value = 0;
    const auto [end, error] = std::from_chars(one.data(), one.data() + one.size(), value);
    require(error == std::errc() && end == one.data() + one.size() && value >= 1 && value <= most &&
                (steps.empty() || value > steps.back()),
            [&] {
              return fmt::format("--steps {}: must be rising multiples of Vdp from 1 to {:g}, such as 1.1,1.25,1.5",
                                 visible(list), most);
            });
    steps.push_back(value);
  }
  constexpr std::size_t most_steps = 8;
  require(steps.size() <= most_steps, [&] { return fmt::format("--steps {}: at most {} of them", list, most_steps); });
  return steps;
}

int calibrate_verb(const Common& c, const CalibrateRequest& request) {
  IdentificationOptions options{.jobs = job_count(request.jobs)};
  options.samples = sample_count(request.samples, options.samples, fewest_measured, most_measured);
  options.seed = seed_of(request.seed, options.seed);
  if (!request.errors.empty()) read_errors(request.errors, options);
  if (!request.steps.empty()) options.steps = read_steps(request.steps);
  const SceneFile file = load_scene_or_result(c);
  std::optional<WatchedWork> work(std::in_place, c.quiet, c.stop);
  static_cast<void>(claim_places(c, {}));
  const IdentificationStudy study = identify(file, options, work->watch());
  work.reset();
  print_json_or(c, measurements_json(study, options, c.command), measurements_text(study, options));
  return study.interrupted ? exit_interrupted : exit_done;
}

}  // namespace

void add_calibrate(Verb& verb) {
  const auto request = std::make_shared<CalibrateRequest>();
  verb.with_scene_or_result();
  verb.with_set("change one key: --set spread.gaps.cov=\"1 %\"");
  verb.with_quiet();
  verb.with_json();
  verb.with_samples(request->samples, "devices (default: 256)");
  verb.option("--steps", request->steps, "LIST",
              "steps whose closing times are measured, in multiples of the nominal Vdp (default: 1.1,1.25,1.5)");
  verb.option("--error", request->errors, "LIST",
              "of the measurements, one standard deviation: \"Vdp:1 %,frequency:0.5 %\"; there are Vdp, Vsp, release, frequency, "
              "piezo and time (default: exact)");
  verb.with_seed(request->seed, "same devices");
  verb.with_jobs(request->jobs);
  verb.footer(
      "The scene's drive is the recipe: a landing, not the plain step. Every device is closed with the recipe's voltages and\n"
      "times multiplied by factors told from what is measured: from each figure, and from every pair. Where it drives a piezo, "
      "its\n"
      "voltages have a factor of their own.\n"
      "Example:\n  softland calibrate softland-out --error \"Vdp:0.2 %,frequency:0.1 %\"");
  verb.runs([request](const Common& common) { return calibrate_verb(common, *request); });
}

}  // namespace softland::apps
