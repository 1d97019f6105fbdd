// Verb `calibrate`: ranks the quantities that can be measured on a device by how well they predict the waveform that closes the
// device softly.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/require.h"
#include "base/split.h"
#include "config/units.h"
#include "reports/measurement_report.h"
#include "studies/inverse/identification.h"
#include "verbs/study.h"

namespace softland::verbs {
namespace {

// Reads the measurement errors of the option --error, such as "Vdp:1 %,time:0.5 %".
void read_errors(const std::string& option, const std::string& list, IdentificationOptions& options) {
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
      throw InvalidRequest(fmt::format("{} {}: {}", option, one, error.what()));
    }
    require_request(q.dimension == dimension::none && q.value >= 0 && q.value <= most, [&] {
      return fmt::format(
          "{} {}: must be Vdp, Vsp, release, frequency, piezo or time with an error from 0 to 50 %, such as \"Vdp:1 %\"", option,
          visible(list));
    });
    require_request(seen.insert(row->first).second,
                    [&] { return fmt::format("{} {}: {} is given twice; give it once", option, visible(list), row->first); });
    *row->second = q.value;
  }
}

// Reads the voltage steps of --steps under which closing times are measured, as multiples of the dynamic pull-in voltage Vdp:
// "1.1,1.25".
void read_steps(const std::string& option, const std::string& list, std::vector<double>& all) {
  std::vector<double> steps;
  for (const std::string& one : split(list, ',')) {
    constexpr double most = 10;
    double value = 0;
    const auto [end, error] = std::from_chars(one.data(), one.data() + one.size(), value);
    require_request(error == std::errc() && end == one.data() + one.size() && value >= 1 && value <= most &&
                        (steps.empty() || value > steps.back()),
                    [&] {
                      return fmt::format("{} {}: must be increasing multiples of Vdp from 1 to {:g}, such as 1.1,1.25,1.5",
                                         option, visible(list), most);
                    });
    steps.push_back(value);
  }
  constexpr std::size_t most_steps = 8;
  require_request(steps.size() <= most_steps,
                  [&] { return fmt::format("{} {}: must be at most {} steps", option, list, most_steps); });
  all = std::move(steps);
}

Outcome shown(const MeasurementsRecord& record) { return {.json = json_of(record), .text = text_of(record)}; }

struct CalibrateRequest : Usual {
  static constexpr auto name = "calibrate",
                        about = "rank measurable figures of a device by how well they predict its best waveform",
                        python = "calibrate", scene = varied_scene,
                        changes = "change one key of the scene, such as --set spread.gaps.cov=\"1 %\"";
  static constexpr auto remarks =
      "The scene must hold a waveform that lands softly, not the plain step. "
      "For every simulated device, its voltages and times\n"
      "are multiplied by factors that are predicted from each measured figure, and from each pair of figures. The voltages of\n"
      "a piezo have a factor of their own.\n"
      "Example:\n  softland calibrate softland-out --error \"Vdp:0.2 %,frequency:0.1 %\"";

  static Outcome shown_again(const nlohmann::json& json) { return shown(read_measurements(json)); }

  IdentificationOptions options{.jobs = one_per_core()};
};

template <class Archive>
void options(Archive& a, CalibrateRequest& r) {
  samples_option(a, r.options.samples, {.least = fewest_measured, .most = most_measured},
                 "number of simulated devices (default: 256)");
  a.parsed("steps", r.options.steps, read_steps, "LIST",
           "voltage steps whose closing times are measured, as multiples of the nominal dynamic pull-in voltage Vdp (default: "
           "1.1,1.25,1.5)",
           "steps", "Sequence[float]");
  a.parsed("error", r.options, read_errors, "LIST",
           "standard deviation of each measurement, such as \"Vdp:1 %,frequency:0.5 %\", of Vdp, Vsp, release, frequency, "
           "piezo and time (default: exact measurements)",
           "errors", "Mapping[str, float | str] | None");
  seed_option(a, r.options.seed, "the same devices");
  jobs_option(a, r.options.jobs);
}

Outcome run(const Setting& setting, const CalibrateRequest& request) {
  const IdentificationStudy found = identify(setting.scene, request.options, setting.progress);
  Outcome outcome = shown(record_of(found, request.options, setting.command));
  outcome.ending = found.interrupted ? Ending::interrupted : Ending::done;
  return outcome;
}

}  // namespace

Study calibrate_study() { return study_of<CalibrateRequest>(); }

}  // namespace softland::verbs
