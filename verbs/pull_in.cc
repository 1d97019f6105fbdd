// Verb `pull-in`: pull-in voltages of every electrode.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/engineering.h"
#include "base/require.h"
#include "config/schema.h"
#include "config/units.h"
#include "reports/pull_in_words.h"
#include "reports/quantity.h"
#include "reports/sweep_report.h"
#include "studies/closing/auto_settings.h"
#include "studies/closing/sweep.h"
#include "studies/exploration/pull_in_memory.h"
#include "studies/search/search_space.h"
#include "verbs/study.h"

namespace softland::verbs {
namespace {

constexpr double most_bias = 1e6;  // [V]

// Of a voltage on the command line.
std::string voltage_rule() {
  return fmt::format("must be {} from {} to {}, such as \"{}\"", describe(dimension::voltage), engineering(-most_bias, "V"),
                     engineering(most_bias, "V"), example(dimension::voltage));
}

// "V1:V2:N"
void read_sweep(const std::string& option, const std::string& text, std::optional<SweepRange>& asked) {
  constexpr int most_points = 100'000;
  const auto refuse = [&](std::string_view rule) { throw InvalidRequest(fmt::format("{} {}: {}", option, visible(text), rule)); };
  const std::size_t first = text.find(':'), second = first == std::string::npos ? first : text.find(':', first + 1);
  if (second == std::string::npos) refuse("not of the form FIRST:LAST:N, such as \"0 V:40 V:81\"");
  const auto voltage = [&](const std::string& part) {
    Quantity given;
    try {
      given = parse_quantity(part);
    } catch (const InvalidInput& error) {
      refuse(error.what());
    }
    if (given.dimension != dimension::voltage || !(std::abs(given.value) <= most_bias)) refuse(voltage_rule());
    return given.value;
  };
  const SweepRange range{.first = voltage(text.substr(0, first)),
                         .last = voltage(text.substr(first + 1, second - first - 1)),
                         .points = whole_number<int>(option, text.substr(second + 1), {.least = 2})};
  if (range.points > most_points) refuse(fmt::format("there may be {} points each way", most_points));
  if (range.first == range.last) refuse("begins where it ends");
  asked = range;
}

// --bias NAME=V: takes the place of what the drive stands at in the scene.
void set_bias(PreparedScene& p, const std::string& assignment) {
  const auto refuse = [&](std::string_view rule) {
    throw InvalidRequest(fmt::format("{} {}: {}", requested("bias"), visible(assignment), rule));
  };
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos) refuse("not of the form NAME=VOLTAGE, such as \"piezo=-1.5 V\"");
  const std::vector<std::string> names = p.drive_names();
  const std::string name = assignment.substr(0, equals);
  const auto drive = std::find(names.begin(), names.end(), name);
  if (drive == names.end()) refuse("no such drive" + internal::hint(name, {names.begin(), names.end()}));
  if (names.size() == 1) refuse("the scene has no other drive: a bias is what the others stand at");
  const bool is_factor = name == dispersion_drive;
  const Dimension& due = is_factor ? dimension::none : dimension::voltage;
  Quantity given;
  try {
    given = parse_quantity(assignment.substr(equals + 1));
  } catch (const InvalidInput& error) {
    refuse(error.what());
  }
  if (given.dimension != due || !(is_factor ? given.value >= 0 : std::abs(given.value) <= most_bias)) {
    refuse(is_factor ? std::string("must be a factor of the dispersion force, 0 or more") : voltage_rule());
  }
  p.scene.standing[static_cast<std::size_t>(drive - names.begin())] = is_factor ? given.value - 1 : given.value;
}

// How static pull-in comes about; empty where there is none.
std::string kind_words(const nlohmann::json& found) {
  if (!found["static_kind"].is_string()) return {};
  return found["static_kind"] == to_string(StaticKind::fold) ? " (fold of the static branch)"
                                                             : " (the contact point reaches the contact first)";
}

std::string shift_clause(const nlohmann::json& found, const char* key) {
  const std::string shift = shift_words(found, key);
  return shift.empty() ? shift : "; more modes move it by " + shift;
}

// What pull_in_of() has found of an electrode, in words.
std::string words_of(const PreparedScene& p, std::size_t k, const nlohmann::json& one) {
  std::string text = fmt::format("electrode {}\n", p.scene.device.electrodes[k].name);
  if (!pulls_in(p.scene.device, k)) return text + "  on the far side: pulls away from the contact\n";
  if (const std::string bias = bias_words(p, k); !bias.empty()) text += fmt::format("  under            {}\n", bias);
  if (one["status"] == to_string(Status::no_contact))
    return text + "  pulls away from the contact where the switch rests: no pull-in voltage\n";
  const nlohmann::json& found = one["pull_in"];
  text += collapsed(one)
              ? fmt::format("  {}\n", no_open_state)
              : fmt::format("  static pull-in   {}{}{}\n  pull-in position {}\n  dynamic pull-in  {}\n", volts(found["static_V"]),
                            kind_words(found), shift_clause(found, "static_V"), deflection_words(found),
                            one["status"] == to_string(Status::interrupted)
                                ? std::string("not known: the search for it was interrupted")
                                : dynamic_words(p, k, found));
  if (p.model.has_contact()) {
    text += fmt::format("  release          {}{}\n", volts(found["release_V"]), shift_clause(found, "release_V"));
    if (found["pulled_through_V"].is_number())
      text += fmt::format("  pulled through   {}: from there on a closed switch goes on to the electrode{}\n",
                          volts(found["pulled_through_V"]), shift_clause(found, "pulled_through_V"));
  }
  return text;
}

// The sweep of the electrode that closes the switch: its files and its points as JSON.
nlohmann::json add_sweep(std::vector<Outcome::File>& files, const PreparedScene& p, const SweepRange& range, const Watch& watch) {
  require_request(has_pulling_electrode(p.scene.device),
                  [] { return requested("sweep") + ": there is no electrode that pulls towards the contact"; });
  const std::size_t drive = searched_drive(p.scene.device);
  const std::vector<double> bias = bias_of(p.scene, drive);
  const std::vector<SweepPoint> points = static_sweep(p.model, drive, bias, range, watch);
  if (points.empty()) return nullptr;  // it was asked to stop before the first one
  std::string of = fmt::format("Electrode {}, swept up and down", p.scene.device.electrodes[drive].name);
  if (const std::string others = bias_words(p, drive); !others.empty()) of += ", under " + others;
  std::string svg = sweep_svg(points, of, static_pull_in(p.model, drive, bias), release_voltage(p.model, drive, bias));
  files = {{"sweep.csv", [points] { return sweep_csv(points); }, "sweep.csv"},
           {"sweep.svg", [svg = std::move(svg)] { return svg; }, "sweep.svg"}};
  return sweep_json(points);
}

// The sentence that names what was not found because the verb was asked to stop.
std::string left_out_words(const std::vector<std::string>& left_out) {
  return wrapped(fmt::format("interrupted: not found yet: {}.", fmt::join(left_out, "; "))) + "\n";
}

struct PullInRequest : Usual {
  static constexpr auto name = "pull-in", about = "static and dynamic pull-in voltage and release voltage of every electrode",
                        python = "pull_in", leaves = "folder for sweep.csv and sweep.svg", leaving = "sweep";
  static constexpr auto remarks =
      "The stable path says whether one drive alone carries the switch to its contact without a jump, and for what share of\n"
      "256 devices of [spread]. With a stable path softland optimize approaches the contact slowly.\n"
      "Examples:\n  softland pull-in scenes/mem-gold.toml --set structure.thickness=\"2.1 um\"\n"
      "  softland pull-in scenes/mem-gold-pzt.toml --bias piezo=\"0.5 V\"\n"
      "  softland pull-in scenes/mem-gold.toml --sweep \"0 V:20 V:201\" --out swept";
  static std::vector<std::string> files() { return {"sweep.csv", "sweep.svg"}; }

  std::vector<std::string> bias;
  std::optional<SweepRange> sweep;
};

template <class Archive>
void options(Archive& a, PullInRequest& r) {
  a.assignments("bias", r.bias, "NAME=VOLTAGE",
                "constant voltage of another drive, in place of its hold level where that is in volts");
  a.parsed("sweep", r.sweep, read_sweep, "FIRST:LAST:N",
           "static deflection and capacitance at N voltages from the first to the last and back, for --out: the closing\n"
           "electrode, open up to its pull-in voltage, closed on the way back down to the release voltage",
           "sweep", "str | None");
}

// The findings of pull_in_of() for every electrode that was looked at.
struct Electrodes {
  std::map<std::string, nlohmann::json> by_name;
  std::string text;
  bool failed = false, none = false;
  std::string status{to_string(Status::done)};  // the status of the first electrode that pulls and has no voltage
};

Electrodes electrodes_of(const PreparedScene& p, const PullInFinder& find_pull_in, const Watch& watch) {
  Electrodes all;
  const auto& electrodes = p.scene.device.electrodes;
  for (std::size_t k = 0; k < electrodes.size() && !watch.stopped(); ++k) {
    nlohmann::json one = pull_in_of(p, k, watch, find_pull_in);
    all.text += words_of(p, k, one);
    if (pulls_in(p.scene.device, k)) {
      const bool has_none = collapsed(one) || one["status"] == to_string(Status::no_contact);
      all.none = all.none || has_none;
      all.failed = all.failed || (!has_none && one["status"] != to_string(Status::done));
      if (all.status == to_string(Status::done)) all.status = one["status"];
    }
    all.by_name[electrodes[k].name] = std::move(one);
  }
  return all;
}

std::vector<std::string> left_out_of(const PreparedScene& p, const Electrodes& all) {
  std::vector<std::string> left_out;
  for (const Electrode& electrode : p.scene.device.electrodes) {
    const auto found = all.by_name.find(electrode.name);
    if (found == all.by_name.end()) {
      left_out.push_back("electrode " + electrode.name);
    } else if (found->second["status"] == to_string(Status::interrupted)) {
      left_out.push_back("dynamic pull-in of electrode " + electrode.name);
    }
  }
  return left_out;
}

Outcome run(const Setting& setting, const PullInRequest& request) {
  const SceneFile& file = setting.scene;
  const Watch& watch = setting.watch;
  PullInMemory remembered;
  const PullInFinder find_pull_in = remembered.finder(file);
  // The voltages come before what a waveform in Vdp needs, so that they are told where the search for more is stopped.
  const Scene scene = read_scene(file);
  const bool leaves_choices = scene.auto_modes || scene.simulate.automatic_effects;
  PreparedScene prepared = leaves_choices ? prepare_and_choose(file, false, watch) : prepare_statics(file);
  for (const std::string& assignment : request.bias) set_bias(prepared, assignment);
  require(!prepared.scene.device.electrodes.empty(), fmt::format("{}: there is no electrode to pull in", setting.name));
  const Electrodes all = electrodes_of(prepared, find_pull_in, watch);
  std::vector<std::string> left_out = left_out_of(prepared, all);
  StablePathFound path;
  try {
    watch.throw_if_stopped();
    if (!leaves_choices) {
      const std::vector<double> standing = prepared.scene.standing;  // with --bias
      prepared = prepare(file, false, watch, find_pull_in);
      prepared.scene.standing = standing;
    }
    path = stable_path_of(prepared, watch);
  } catch (const Interrupted&) {
    path = {};
  }
  if (watch.stopped() && prepared.model.has_contact()) {
    left_out.emplace_back("the stable path");
    path = {};
  }
  Outcome outcome{.text = all.text};
  if (!path.words.empty()) outcome.text += wrapped("Stable path: " + path.words + ".") + "\n";
  nlohmann::json sweep = nullptr;
  if (request.sweep && !watch.stopped()) sweep = add_sweep(outcome.files, prepared, *request.sweep, watch);
  const bool interrupted = watch.stopped();
  if (request.sweep && interrupted)
    left_out.push_back(sweep.is_null() ? "the sweep" : fmt::format("the sweep beyond its first {} points", sweep.size()));
  if (interrupted) outcome.last = left_out_words(left_out);
  outcome.json = pull_in_json(all.by_name, interrupted ? std::string(to_string(Status::interrupted)) : all.status);
  outcome.json["stable_path"] = path.data;
  if (interrupted) outcome.json["status"] = to_string(Status::interrupted), outcome.json["left_out"] = left_out;
  if (request.sweep) outcome.json["sweep"] = std::move(sweep);
  outcome.ending = interrupted  ? Ending::interrupted
                   : all.failed ? Ending::numerical_failure
                   : all.none   ? Ending::no_success
                                : Ending::done;
  return outcome;
}

}  // namespace

Study pull_in_study() { return study_of<PullInRequest>(); }

}  // namespace softland::verbs
