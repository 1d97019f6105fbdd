// Verb `cycle`: closes and opens a switch at a given rate, and finds the highest possible rate.
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "config/aim.h"
#include "reports/cycle_report.h"
#include "reports/record_file.h"
#include "studies/closing/auto_settings.h"
#include "studies/closing/open_command.h"
#include "studies/devices/cycling.h"
#include "verbs/study.h"

namespace softland::verbs {
namespace {

Outcome shown(CycleRecord found) {
  const auto record = std::make_shared<const CycleRecord>(std::move(found));
  Outcome outcome{.json = without_curves(json_of(*record)), .text = terminal_text(document_of(*record))};
  outcome.files = {{"cycle.json", [record] { return json_text(json_of(*record), 1) + "\n"; }, "cycle.json"}};
  if (record->curves.empty()) return outcome;
  outcome.files.push_back({"report.html", [record] { return page_html(document_of(*record)); }, "report.html"});
  outcome.files.push_back({"cycle.svg", [record] { return svg_of(*record); }, "cycle.svg"});
  return outcome;
}

struct CycleRequest : Usual {
  static constexpr auto name = "cycle",
                        about = "simulate repeated closing and opening at a rate, and find the largest steady rate",
                        python = "cycle",
                        leaves = "folder for report.html, cycle.json and cycle.svg, and with --search best.toml and best.csv";
  static constexpr auto remarks =
      "A cycle is the closing waveform of the scene, followed at time duty / rate by the command to open: "
      "all drives go to 0 V.\n"
      "A RESULT that begins closed, such as that of release, gives the opening waveform; any other RESULT gives the closing\n"
      "waveform. A scene whose waveform opens the switch on command gives both. Plain switching is simulated for comparison.\n"
      "A rate is steady if all cycles close and open, with impact velocity and highest rebound within 5 % of the first cycle.\n"
      "With --search, both waveforms are found for one rate, at which every cycle begins with the residual vibration of the\n"
      "previous cycle. best.toml then holds one cycle of both waveforms.\n"
      "Examples:\n  softland cycle scenes/mem-gold.toml\n"
      "  softland cycle optimized opened --rate \"2 kHz\" --duty \"40 %\" --out cycled\n"
      "  softland cycle scenes/mem-gold.toml --rate \"2 kHz\" --search --out cycled";
  static std::vector<std::string> files() { return {"report.html", "cycle.json", "cycle.svg", "best.toml", "best.csv"}; }
  static Outcome shown_again(const nlohmann::json& json) { return shown(read_cycles(json)); }

  CyclingOptions options{.jobs = one_per_core()};
  std::vector<std::string> results;  ///< further scenes or results that have the closing or the opening waveform
  bool searches = false;             ///< true: closing and opening waveform are searched for the cycle rate
  std::string target = "bounce", waveform = {};
  Actuator actuator = Actuator::electrostatic;
  long budget = CycleSearchOptions{}.max_evaluations;
};

template <class Archive>
void options(Archive& a, CycleRequest& r) {
  CyclingOptions& o = r.options;
  a.results("RESULT", r.results, "further scene or result that gives the closing or the opening waveform");
  a.quantity("rate", o.rate, {dimension::frequency, positive, "a rate above 0 Hz such as \"1 kHz\""}, "RATE",
             "cycles per second to simulate and report (default: the largest steady rate)");
  a.quantity("duty", o.duty,
             {dimension::none,
              {.least = 0, .most = 1, .least_open = true, .most_open = true},
              "a share of a cycle above 0 % and below 100 %, such as \"40 %\""},
             "SHARE", "share of a cycle before the command to open (default: 50 %)");
  a.unless("no-scan", o.scans, "omit the search for the largest steady rate and simulate the cycles at --rate only");
  a.whole("cycles", o.cycles, {.least = 2, .most = 1000}, "number of cycles at every rate (default: 10)");
  a.flag("search", r.searches, "search the closing and the opening waveform for --rate together, as optimize --cycle RATE does");
  a.text("target", r.target, "NAME",
         "quantity that --search minimises in the worst cycle, a name as in optimize (default: bounce)");
  a.choice("actuator", r.actuator, actuators, "drives that --search may shape");
  a.text("waveform", r.waveform, "NAME",
         "waveform family that --search uses for the closing, a name as in optimize (default: as in optimize)");
  a.whole("budget", r.budget, {.least = 30},
          "number of evaluations of --search: a third each for the closing, the opening, and both together (default: 3000)");
  samples_option(a, o.devices, {.least = 0, .most = SamplePoints::largest_size},
                 "number of devices varied by [spread] whose largest steady rates are found too (default: 50; 0: none)");
  seed_option(a, o.seed, "the same devices");
  jobs_option(a, o.jobs);
}

// Reads waveforms of a cycle from a scene: the opening waveform if the scene begins closed, both waveforms if it opens on
// command, else the closing waveform.
void take(CycleWaveforms& waveforms, const PreparedScene& scene) {
  std::vector<Signal> commanded = scene.commanded(scene.waveforms());
  if (scene.start() == StartState::closed) {
    waveforms.opening = std::move(commanded);
  } else if (const auto command = open_command(scene, commanded)) {
    waveforms.closing = command->held;
    waveforms.opening.clear();
    for (const Signal& s : commanded) waveforms.opening.push_back(part_from(s, command->time, s.voltage_before(command->time)));
  } else {
    waveforms.closing = std::move(commanded);
  }
}

Outcome searched(const Setting& setting, const CycleRequest& request) {
  require_request(request.options.rate.has_value(), [] { return requested("search") + " requires " + requested("rate"); });
  require_request(request.results.empty(), [] { return requested("search") + " finds both waveforms: omit RESULT"; });
  const CyclingOptions usual;
  require_request(request.options.scans && request.options.devices == usual.devices, [] {
    return fmt::format("{}, {}: must not be given with a search, which simulates the nominal design at one rate",
                       requested("no-scan"), requested("samples"));
  });
  const CycleSearchOptions options{.rate = *request.options.rate,
                                   .duty = request.options.duty,
                                   .target = parse_aim(request.target),
                                   .actuator = request.actuator,
                                   .family = request.waveform,
                                   .max_evaluations = request.budget,
                                   .cycles = request.options.cycles,
                                   .seed = request.options.seed,
                                   .jobs = request.options.jobs};
  const auto found = std::make_shared<const CycleSearchResult>(search_cycle(setting.scene, options, setting.progress));
  Outcome outcome = shown(record_of(*found, options, setting.command));
  outcome.files.push_back({"best.csv", [found] { return cycle_csv(*found); }, "best.csv"});
  outcome.files.push_back({"best.toml", [found] { return found->scene.text(); }, "best.toml"});
  if (!found->interrupted) outcome.next = "\nFor a generator:\n  softland export {}\n";
  outcome.ending = found->interrupted ? Ending::interrupted : found->is_better() ? Ending::done : Ending::no_success;
  return outcome;
}

// Returns true if the request has an option that applies only to a search.
bool is_about_search(const CycleRequest& r) {
  const CycleRequest usual;
  return r.target != usual.target || r.actuator != usual.actuator || !r.waveform.empty() || r.budget != usual.budget;
}

Outcome run(const Setting& setting, const CycleRequest& request) {
  if (request.searches) return searched(setting, request);
  require_request(!is_about_search(request), [] {
    return fmt::format("{}, {}, {}, {}: must be given together with {}", requested("target"), requested("actuator"),
                       requested("waveform"), requested("budget"), requested("search"));
  });
  require_request(request.options.scans || request.options.rate,
                  [] { return requested("no-scan") + " needs " + requested("rate"); });
  const auto given = setting.prepared(false);
  CycleWaveforms waveforms{.name = setting.name, .closing = {}, .opening = {}};
  take(waveforms, *given);
  for (const std::string& result : request.results) {
    const PreparedScene other = prepare(setting.load(result), false, {.stop = setting.progress.stop});
    require(other.drive_names() == given->drive_names(),
            [&] { return result + ": must have the same drives as " + setting.name; });
    take(waveforms, other);
    waveforms.name += " and " + result;
  }
  complete(waveforms, *given);
  const Cycling found = cycling(*given, waveforms, request.options, setting.progress);
  Outcome outcome = shown(record_of(*given, found, setting.command));
  outcome.ending = found.interrupted ? Ending::interrupted : found.rate > 0 ? Ending::done : Ending::no_success;
  return outcome;
}

}  // namespace

Study cycle_study() { return study_of<CycleRequest>(); }

}  // namespace softland::verbs
