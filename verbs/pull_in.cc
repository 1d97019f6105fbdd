// Verb `pull-in`: finds the pull-in voltages of every electrode.
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
#include "config/quantity_argument.h"
#include "config/schema.h"
#include "config/units.h"
#include "document/text.h"
#include "reports/pull_in_report.h"
#include "studies/closing/auto_settings.h"
#include "studies/closing/sweep.h"
#include "studies/exploration/pull_in_memory.h"
#include "studies/search/search_space.h"
#include "verbs/study.h"

namespace softland::verbs {
namespace {

constexpr double most_bias = 1e6;  // largest voltage that --bias and --sweep accept [V]

// Returns the rule that a message states about a voltage given on the command line.
std::string voltage_rule() {
  return fmt::format("must be {} from {} to {}, such as \"{}\"", describe(dimension::voltage), engineering(-most_bias, "V"),
                     engineering(most_bias, "V"), example(dimension::voltage));
}

// Reads the range of --sweep, FIRST:LAST:N.
void read_sweep(const std::string& option, const std::string& text, std::optional<SweepRange>& asked) {
  constexpr int most_points = 100'000;
  const auto refuse = [&](std::string_view rule) { throw InvalidRequest(fmt::format("{} {}: {}", option, visible(text), rule)); };
  const std::size_t first = text.find(':'), second = first == std::string::npos ? first : text.find(':', first + 1);
  if (second == std::string::npos) refuse("must be of the form FIRST:LAST:N, such as \"0 V:40 V:81\"");
  const auto voltage = [&](const std::string& part) {
    Quantity given;
    try {
      given = quantity_with_unit(part, dimension::voltage);
    } catch (const InvalidInput& error) {
      refuse(error.what());
    }
    if (given.dimension != dimension::voltage || !(std::abs(given.value) <= most_bias)) refuse(voltage_rule());
    return given.value;
  };
  const SweepRange range{.first = voltage(text.substr(0, first)),
                         .last = voltage(text.substr(first + 1, second - first - 1)),
                         .points = whole_number<int>(option, text.substr(second + 1), {.least = 2})};
  if (range.points > most_points) refuse(fmt::format("N must be at most {}", most_points));
  if (range.first == range.last) refuse("FIRST and LAST must differ");
  asked = range;
}

// Sets the bias of a drive, its constant voltage (or factor) while the voltage of an electrode varies, to the value of --bias.
void set_bias(PreparedScene& p, const std::string& assignment) {
  const auto refuse = [&](std::string_view rule) {
    throw InvalidRequest(fmt::format("{} {}: {}", requested("bias"), visible(assignment), rule));
  };
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos) refuse("must be of the form NAME=VOLTAGE, such as \"piezo=-1.5 V\"");
  const std::vector<std::string> names = p.drive_names();
  const std::string name = assignment.substr(0, equals);
  const auto drive = std::find(names.begin(), names.end(), name);
  if (drive == names.end()) refuse("unknown drive" + internal::hint(name, {names.begin(), names.end()}));
  if (names.size() == 1)
    refuse("must not be given for a scene with one drive: the bias is the constant voltage of another drive");
  const bool is_factor = name == dispersion_drive;
  const Dimension& due = is_factor ? dimension::none : dimension::voltage;
  Quantity given;
  try {
    given = quantity_with_unit(assignment.substr(equals + 1), due);
  } catch (const InvalidInput& error) {
    refuse(error.what());
  }
  if (given.dimension != due || !(is_factor ? given.value >= 0 : std::abs(given.value) <= most_bias)) {
    refuse(is_factor ? std::string("must be a factor of the dispersion force, 0 or more") : voltage_rule());
  }
  p.scene.standing[static_cast<std::size_t>(drive - names.begin())] = is_factor ? given.value - 1 : given.value;
}

// Returns a sentence with the results that are missing because the verb was interrupted.
std::string left_out_prose(const std::vector<std::string>& left_out) {
  return wrapped(fmt::format("interrupted before these results were found: {}.", fmt::join(left_out, "; "))) + "\n";
}

Outcome shown(PullInsRecord found) {
  const auto record = std::make_shared<const PullInsRecord>(std::move(found));
  Outcome outcome{.json = json_of(*record), .text = text_of(*record)};
  if (!record->sweep.empty())
    outcome.files = {{"sweep.csv", [record] { return sweep_csv(record->sweep); }, "sweep.csv"},
                     {"sweep.svg", [record] { return sweep_svg(*record); }, "sweep.svg"}};
  if (!record->left_out.empty()) outcome.last = left_out_prose(record->left_out);
  return outcome;
}

struct PullInRequest : Usual {
  static constexpr auto name = "pull-in",
                        about = "compute static pull-in, dynamic pull-in and release voltage of every electrode",
                        python = "pull_in", leaves = "folder for sweep.csv and sweep.svg; requires --sweep", leaving = "sweep";
  static constexpr auto remarks =
      "The stable path says whether one drive alone can carry the switch to its contact through stable equilibria, without a\n"
      "jump, and for what share of 256 devices of [spread]. If so, softland optimize approaches the contact slowly.\n"
      "Examples:\n  softland pull-in scenes/mem-gold.toml --set structure.thickness=\"2.1 um\"\n"
      "  softland pull-in scenes/mem-gold-pzt.toml --bias piezo=\"0.5 V\"\n"
      "  softland pull-in scenes/mem-gold.toml --sweep \"0 V:20 V:201\" --out swept";
  static std::vector<std::string> files() { return {"sweep.csv", "sweep.svg"}; }
  static Outcome shown_again(const nlohmann::json& json) { return shown(read_pull_ins(json)); }

  std::vector<std::string> bias;
  std::optional<SweepRange> sweep;
};

template <class Archive>
void options(Archive& a, PullInRequest& r) {
  a.assignments("bias", r.bias, "NAME=VOLTAGE",
                "constant voltage of another drive (default: its hold voltage in the scene, if that is given in volts)");
  a.parsed("sweep", r.sweep, read_sweep, "FIRST:LAST:N",
           "static deflection and capacitance at N voltages from FIRST to LAST and back, written to --out: the closing\n"
           "electrode on the open branch up to pull-in, and on the closed branch back down to release",
           "sweep", "str | None");
}

// Sweeps the voltage of the electrode that closes the switch, up and down.
void add_sweep(PullInsRecord& record, const PreparedScene& p, const SweepRange& range, const Progress& progress) {
  require_request(has_pulling_electrode(p.scene.device),
                  [] { return requested("sweep") + ": requires an electrode that pulls towards the contact"; });
  const std::size_t drive = searched_drive(p.scene.device);
  record.swept = p.scene.device.electrodes[drive].name;
  record.sweep = static_sweep(p.model, drive, bias_of(p.scene, drive), range, progress);
}

// Returns `done`, or the status of the first electrode that pulls towards the contact and for which no pull-in voltage was
// found. With a single electrode, the status is that of this electrode, wherever it pulls.
Status status_of(const PreparedScene& p, const PullInsRecord& record) {
  if (record.electrodes.size() == 1) return record.electrodes.begin()->second.status;
  const auto& electrodes = p.scene.device.electrodes;
  for (std::size_t k = 0; k < electrodes.size(); ++k) {
    const auto found = record.electrodes.find(electrodes[k].name);
    if (found != record.electrodes.end() && pulls_in(p.scene.device, k) && found->second.status != Status::done)
      return found->second.status;
  }
  return Status::done;
}

Ending worst_ending(const PreparedScene& p, const PullInsRecord& record) {
  Ending ending = Ending::done;
  const auto& electrodes = p.scene.device.electrodes;
  for (std::size_t k = 0; k < electrodes.size(); ++k) {
    if (!pulls_in(p.scene.device, k)) continue;
    const Ending one = verbs::ending_of(record.electrodes.at(electrodes[k].name).status);
    if (ending != Ending::numerical_failure && one != Ending::done) ending = one;
  }
  return ending;
}

void add_electrodes(PullInsRecord& record, const PreparedScene& p, const PullInFinder& find_pull_in, const Progress& progress) {
  const auto& electrodes = p.scene.device.electrodes;
  for (std::size_t k = 0; k < electrodes.size(); ++k) {
    if (progress.stopped()) {
      record.left_out.push_back("electrode " + electrodes[k].name);
      continue;
    }
    const ElectrodeRecord found = record_of(p, k, find_pull_in(p.model, k, bias_of(p.scene, k), progress));
    if (found.status == Status::interrupted) record.left_out.push_back("dynamic pull-in of electrode " + electrodes[k].name);
    record.electrodes.emplace(electrodes[k].name, found);
  }
}

Outcome run(const Setting& setting, const PullInRequest& request) {
  const SceneFile& file = setting.scene;
  const Progress& progress = setting.progress;
  PullInMemory remembered;
  const PullInFinder find_pull_in = remembered.finder(file);
  // Find the pull-in voltages before all other results: a waveform in multiples of the pull-in voltage Vdp needs them, and an
  // interruption then does not lose them.
  const Scene scene = read_scene(file);
  const bool leaves_choices = scene.auto_modes || scene.simulate.automatic_effects;
  PreparedScene prepared = leaves_choices ? prepare_and_choose(file, false, progress) : prepare_statics(file);
  for (const std::string& assignment : request.bias) set_bias(prepared, assignment);
  require(!prepared.scene.device.electrodes.empty(),
          fmt::format("{}: the scene has no electrode; add [electrode.NAME]", setting.name));
  PullInsRecord record;
  add_electrodes(record, prepared, find_pull_in, progress);
  try {
    progress.throw_if_stopped();
    if (!leaves_choices) {
      // Keep the bias, the constant voltages of all other electrodes and piezos while that of one electrode varies: prepare()
      // knows only the scene, not the values of --bias.
      const std::vector<double> standing = prepared.scene.standing;
      prepared = prepare(file, false, progress, find_pull_in);
      prepared.scene.standing = standing;
    }
    record.stable_path = stable_path_of(prepared, progress);
  } catch (const Interrupted&) {
    record.stable_path.reset();
  }
  if (progress.stopped() && prepared.model.has_contact()) {
    record.left_out.emplace_back(stable_path_left_out);
    record.stable_path.reset();
  }
  if (request.sweep && !progress.stopped()) add_sweep(record, prepared, *request.sweep, progress);
  const bool interrupted = progress.stopped();
  if (request.sweep && interrupted)
    record.left_out.push_back(record.sweep.empty() ? "the sweep"
                                                   : fmt::format("the sweep beyond its first {} points", record.sweep.size()));
  record.origin = origin_of("pull-in", setting.command);
  // The resolved scene has all voltages in volts. After an interruption they may not be known yet: record the scene as given.
  record.origin.scene = interrupted ? file.json() : prepared.resolved().json();
  record.status = to_string(interrupted ? Status::interrupted : status_of(prepared, record));
  Outcome outcome = shown(record);
  outcome.ending = interrupted ? Ending::interrupted : worst_ending(prepared, record);
  return outcome;
}

}  // namespace

Study pull_in_study() { return study_of<PullInRequest>(); }

}  // namespace softland::verbs
