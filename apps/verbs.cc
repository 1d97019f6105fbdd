#include "apps/verbs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "apps/exit_status.h"
#include "apps/output.h"
#include "apps/progress.h"
#include "apps/search_log.h"
#include "apps/shell_word.h"
#include "apps/streams.h"
#include "base/printable.h"
#include "base/read_file.h"
#include "base/require.h"
#include "base/shortened.h"
#include "config/units.h"
#include "model/constants.h"
#include "reports/accuracy_report.h"
#include "reports/effects_report.h"
#include "reports/measurement_report.h"
#include "reports/quantity.h"
#include "reports/result_maker.h"
#include "reports/result_reader.h"
#include "reports/robustness_report.h"
#include "reports/text.h"
#include "studies/certify.h"
#include "studies/choices.h"
#include "studies/omissions.h"
#include "studies/optimize.h"
#include "studies/robust_optimize.h"
#include "studies/timing.h"
#include "waveforms/export.h"

namespace softland::apps {
namespace {

namespace fs = std::filesystem;
using internal::given_quantity;
using internal::percent;
using internal::plain_number;
using internal::quantity;
using internal::scientific;
using nlohmann::json;

SceneFile load_scene(const Common& c) {
  SceneFile file = SceneFile::load(c.scene);
  for (const std::string& assignment : c.set) file.set(assignment);
  return file;
}

// Voltages of the scene, for generators and simulators of circuits: the factor of the dispersion force is none.
std::map<std::string, Signal> named_signals(const Prepared& p) {
  std::map<std::string, Signal> all;
  const std::vector<std::string> names = p.drive_names();
  const std::vector<Signal> signals = p.signals();
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] != dispersion_drive) all.emplace(names[k], signals[k]);
  }
  return all;
}

// Pull-in of every electrode, without any waveform of the scene.
json pull_in_of(const Prepared& p, std::size_t k, const Watch& watch) {
  const StaticPullIn s = static_pull_in(p.model, k);
  const DynamicPullIn d = dynamic_pull_in(p.model, k, s, watch);
  const auto number = [](double v) { return std::isfinite(v) ? json(v) : json(nullptr); };
  return {{"status", to_string(s.status == Status::done ? d.status : s.status)},
          {"pull_in",
           {{"static_V", number(s.voltage)},
            {"static_kind", to_string(s.kind)},
            {"dynamic_V", number(d.voltage)},
            {"release_V", number(release_voltage(p.model, k))}}}};
}

constexpr int pull_in_digits = 5;

std::string volts(const json& v) { return v.is_number() ? quantity(v.get<double>(), "V", pull_in_digits) : "none"; }

int status_code(Status s) {
  switch (s) {
    case Status::interrupted:
      return exit_interrupted;
    case Status::numerical_failure:
      return exit_numerical_failure;
    case Status::no_contact:
    case Status::collapsed_at_rest:
      return exit_no_success;
    default:
      return exit_done;
  }
}

// The dynamic pull-in voltage; a step that damping lets not overshoot needs no less than the static one.
std::string dynamic_words(const json& pull_in) {
  const json &statically = pull_in["static_V"], &dynamically = pull_in["dynamic_V"];
  const bool overdamped = statically.is_number() && dynamically.is_number() &&
                          dynamically.get<double>() >= (1 - dynamic_pull_in_precision) * statically.get<double>();
  return volts(dynamically) + (overdamped ? " (overdamped: equals the static one)" : "");
}

constexpr const char* no_open_state = "no pull-in voltage: the switch has no open state";

bool collapsed(const json& pull_in) { return pull_in["status"] == to_string(Status::collapsed_at_rest); }

// At which factor the dispersion force closes the switch.
std::string dispersion_words(const Prepared& p, const Watch& watch) {
  const std::size_t k = p.scene.device.electrodes.size();
  const StaticPullIn statically = static_pull_in(p.model, k);
  const auto factor = [](double value) { return plain_number(1 + value, 4); };
  const bool known = std::isfinite(statically.voltage);
  if (!p.model.rest()) {
    return "no open state: " +
           (known ? fmt::format("closes by itself from {} of its nominal strength on", factor(statically.voltage))
                  : std::string("closes by itself"));
  }
  const std::string rest =
      fmt::format("tip at rest {} down; ", quantity(p.model.contact_deflection(p.model.rest()->data()), "m"));
  if (!known) return rest + "no strength was found at which it closes by itself";
  const DynamicPullIn dynamically = dynamic_pull_in(p.model, k, statically, watch);
  const std::string step =
      std::isfinite(dynamically.voltage) ? fmt::format(" or a step to {} (dynamic)", factor(dynamically.voltage)) : "";
  return fmt::format("{}closes by itself at {} (static){} of its nominal strength", rest, factor(statically.voltage), step);
}

// As the shell takes it: an empty value is seen.
std::string shown(const std::string& text) { return text.empty() ? "''" : text; }

template <class Number>
Number whole_number(const char* option, const std::string& text, Number least) {
  Number value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  require(error != std::errc::result_out_of_range,
          fmt::format("{} {}: must be a whole number from {} to {}", option, text, least, std::numeric_limits<Number>::max()));
  require(error == std::errc() && end == text.data() + text.size() && value >= least,
          fmt::format("{} {}: must be a whole number from {} on", option, shown(text), least));
  return value;
}

// Threads, one per core unless the option says how many.
int job_count(const std::optional<std::string>& option) {
  return option ? whole_number("--jobs", *option, 1) : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

// "2500" evaluations or "90 s".
void read_budget(const std::string& text, OptimizeOptions& options) {
  const auto rule = [&](bool ok) {
    require(ok, fmt::format("--budget {}: must be a whole number of evaluations such as 2500, or a time such as \"90 s\"",
                            shown(text)));
  };
  Quantity q;
  try {
    q = parse_quantity(text);
  } catch (const InvalidInput&) {
    rule(false);
  }
  if (q.dimension == dimension::time) {
    rule(q.value > 0);
    options.max_seconds = q.value;
    options.max_evaluations = 1'000'000'000;
  } else {
    rule(q.dimension == dimension::none && q.value >= 1 && q.value <= 1e9 && q.value == std::floor(q.value));
    options.max_evaluations = static_cast<long>(q.value);
  }
}

// Where the shipped scenes are: installed with the program, in the tree it was built from, or in an unpacked tree around it.
fs::path shipped_scene(const std::string& name) {
  std::error_code error;
  const fs::path here = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const fs::path& folder : {here / SOFTLAND_INSTALLED_SCENES, fs::path(SOFTLAND_SCENES)}) {
    if (fs::exists(folder / name, error)) return (folder / name).lexically_normal();
  }
  for (fs::path up = here; up.has_relative_path(); up = up.parent_path()) {
    if (fs::exists(up / "scenes" / name, error)) return up / "scenes" / name;
  }
  throw InvalidInput(fmt::format("scenes/{} was not found beside the program; name a scene file", name));
}

json load_result(const fs::path& path) { return parse_result(read_file(path), path.string()); }

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

// The scene of a result: a folder that --out named, a result.json, or a scene file itself. Of what a folder holds its result.json
// is the newest, whichever verb left it; a search that is not done has only its best.toml.
SceneFile scene_of_result(const std::string& result) {
  fs::path path = result;
  if (is_folder(path)) {
    const auto here = [&](const char* name) {
      std::error_code ignored;
      return fs::exists(fs::path(result) / name, ignored);
    };
    require(here("best.toml") || here("result.json"), fmt::format("{}: holds neither best.toml nor result.json", result));
    path /= here("result.json") ? "result.json" : "best.toml";
  }
  if (path.extension() != ".json") return SceneFile::load(path);
  const json j = load_result(path);
  require(j.contains("scene_toml") && j["scene_toml"].is_string(),
          fmt::format("{}: holds no text of the scene; give the result.json in the folder that --out named", path.string()));
  return SceneFile::parse(j["scene_toml"].get<std::string>(), path.string());
}

// effects = "auto": what leaving effects out has saved.
void log_time_saved(const Prepared& chosen) {
  Prepared whole = chosen;
  whole.scene.device = chosen.effects->described.device;
  whole.model = Switch(whole.scene.device, whole.quadrature);
  const auto seconds = [](const Prepared& p) { return right_hand_side_seconds(p.model, p.signals(), p.duration); };
  const double with = seconds(whole), without = seconds(chosen);
  say(fmt::format("effects = \"auto\": a right-hand side takes {} instead of {}, {} less", quantity(without, "s"),
                  quantity(with, "s"), percent(std::max(0.0, 1 - without / with))));
}

// How a winner does on devices of its scene's spread, beside the plain step, in a sentence; empty where nothing varies, or when
// asked to stop.
std::string on_devices(const Common& c, const Prepared& winner, int jobs, const fs::path& place) {
  if (winner.scene.spread.empty()) return {};
  constexpr std::uint64_t devices = 200;
  try {
    const WatchedWork work(c.quiet, c.stop);
    const Robustness found = robustness(winner, {{.name = "found", .waveforms = winner.drives.waveforms}},
                                        {.samples = devices, .jobs = jobs}, work.watch());
    if (found.interrupted || found.drives.size() < 2) return {};
    const auto at_95_percent = [](const DriveRobustness& drive, std::string_view key) {
      const EnsembleFigure& figure = ensemble_figure(key);
      const EstimatedQuantile& q = drive.figures[static_cast<std::size_t>(&figure - ensemble_figures().data())].quantiles[2];
      return std::isfinite(q.value) ? quantity(q.value, figure.unit) : std::string("no bound (more than 5 % do not close)");
    };
    const auto words = [&](const DriveRobustness& drive) {
      return fmt::format("rebounds up to {} and touches at up to {}", at_95_percent(drive, "major_bounce_height_m"),
                         at_95_percent(drive, "largest_impact_velocity_m_s"));
    };
    const DriveRobustness &step = found.drives[0], &own = found.drives[1];
    return "\n" +
           wrapped(fmt::format(
               "On {} devices that differ as [spread] says, with the same volts: {} land without a rebound, and 95 % have "
               "{} (plain step: {}, {}). More: softland robustness {}",
               devices, percent(own.bounce_free.value), words(own), percent(step.bounce_free.value), words(step),
               shell_word((place / "best.toml").string()))) +
           "\n";
  } catch (const Interrupted&) {
    return {};
  }
}

}  // namespace

int simulate_verb(const Common& c, bool certified, const std::optional<std::string>& jobs_option) {
  const int jobs = job_count(jobs_option);
  const SceneFile file = load_scene(c);
  std::optional<WatchedWork> work(std::in_place, c.quiet, c.stop);
  const Prepared prepared = prepare_and_choose(file, false, work->watch());
  const std::vector<std::string> files{"report.html", "gap.svg", "result.json", "trajectory.csv"};
  std::optional<ResultFolder> folder = claim_places(c, files);
  const Closing closing = certified ? certify(prepared, work->watch(), jobs) : simulate(prepared, true, work->watch());
  work.reset();
  const Result result = result_of(prepared, closing, {.command = c.command});
  const bool interrupted = closing.metrics.status == Status::interrupted;
  std::string left;
  if (folder) {
    write_result(*folder, result);
    left = left_in(folder->destination(interrupted), files);
    folder->publish(interrupted);
  }
  print_result(c, result, left);
  if (!interrupted && prepared.effects && !prepared.effects->choice.left_out.empty() && !c.quiet) log_time_saved(prepared);
  if (!closing.trajectory.message.empty())
    say(fmt::format("{} ({})", closing.trajectory.message, to_string(closing.metrics.status)));
  return status_code(closing.metrics.status);
}

int pull_in_verb(const Common& c) {
  const SceneFile file = load_scene(c);
  std::optional<WatchedWork> work(std::in_place, c.quiet, c.stop);
  const Prepared prepared = prepare_and_choose(file, false, work->watch());
  static_cast<void>(claim_places(c, {}));
  const auto& electrodes = prepared.scene.device.electrodes;
  require(!electrodes.empty(), fmt::format("{}: there is no electrode to pull in", c.scene));
  json all = json::object();
  std::string text;
  bool failed = false, never_open = false;
  for (std::size_t k = 0; k < electrodes.size() && !work->watch().stopped(); ++k) {
    json one = pull_in_of(prepared, k, work->watch());
    const json& p = one["pull_in"];
    if (!pulls_in(prepared.scene.device, k)) {
      text += fmt::format("electrode {}\n  on the far side: pulls away from the contact\n", electrodes[k].name);
      if (electrodes.size() > 1) all[electrodes[k].name] = std::move(one);
      continue;
    }
    text += fmt::format("electrode {}\n", electrodes[k].name);
    text += collapsed(one)
                ? fmt::format("  {}\n", no_open_state)
                : fmt::format("  static pull-in   {} ({})\n  dynamic pull-in  {}\n", volts(p["static_V"]),
                              p["static_kind"].get<std::string>() == "fold" ? "fold of the static branch"
                                                                            : "the contact point reaches the contact first",
                              dynamic_words(p));
    if (prepared.model.has_contact()) text += fmt::format("  release          {}\n", volts(p["release_V"]));
    if (collapsed(one))
      never_open = true;
    else
      failed = failed || one["status"] != "done";
    if (electrodes.size() == 1) {
      all = std::move(one);
    } else {
      all[electrodes[k].name] = std::move(one);
    }
  }
  const bool interrupted = work->watch().stopped();
  work.reset();
  print_json_or(c, all, text);
  return interrupted ? exit_interrupted : failed ? exit_numerical_failure : never_open ? exit_no_success : exit_done;
}

int modes_verb(const Common& c) {
  const SceneFile file = load_scene(c);
  const Prepared prepared = prepare_and_choose(file, false, WatchedWork(c.quiet, c.stop).watch());
  static_cast<void>(claim_places(c, {}));
  json list = json::array();
  constexpr int digits = 6;
  std::string text = "mode  angular frequency    frequency\n";
  for (const double omega : prepared.model.angular_frequencies()) {
    list.push_back(omega);
    text += fmt::format("{:>4}  {:>17}  {:>11}\n", list.size(), quantity(omega, "rad/s", digits),
                        quantity(omega / (2 * pi), "Hz", digits));
  }
  for (const std::string& w : prepared.scene.warnings) text += "\n" + wrapped("warning: " + w) + "\n";
  print_json_or(c, {{"natural_frequencies_rad_s", list}, {"warnings", prepared.scene.warnings}}, text);
  return exit_done;
}

int check_verb(const Common& c) {
  const SceneFile file = load_scene(c);
  std::optional<WatchedWork> work(std::in_place, c.quiet, c.stop);
  const Prepared p = prepare_and_choose(file, true, work->watch());
  const Structure& s = p.scene.device.structure;
  const std::string title = shortened(printable_line(p.scene.title));
  std::string text = fmt::format("{}: valid{}\n\n", printable_line(c.scene), title.empty() ? "" : " (" + title + ")");
  const auto add = [&](const std::string& name, const std::string& value) { text += fmt::format("{:<20} {}\n", name, value); };
  std::vector<std::string> frequencies;
  for (const double omega : p.model.angular_frequencies()) frequencies.push_back(quantity(omega / (2 * pi), "Hz", 4));
  add("natural frequencies", fmt::format("{}", fmt::join(frequencies, ", ")));
  if (p.model.has_contact()) add("in-contact period", quantity(p.model.in_contact_period(), "s", 4));
  for (std::size_t k = 0; k < p.scene.device.electrodes.size(); ++k) {
    if (!pulls_in(p.scene.device, k)) {
      add("electrode " + p.scene.device.electrodes[k].name, "on the far side, pulls away from the contact");
      continue;
    }
    const auto found = pull_in_of(p, k, work->watch());
    const json& v = found["pull_in"];
    add("electrode " + p.scene.device.electrodes[k].name,
        (collapsed(found) ? no_open_state : fmt::format("Vsp {}, Vdp {}", volts(v["static_V"]), dynamic_words(v))) +
            (p.model.has_contact() ? ", release " + volts(v["release_V"]) : ""));
  }
  if (p.scene.device.dispersion) {
    add("dispersion force", dispersion_words(p, work->watch()));
    add("drive dispersion", "hold factor " + plain_number(1 + p.signals()[p.scene.device.electrodes.size()].hold_level(), 5));
  }
  if (p.scene.device.gas && p.scene.device.gas->model != GasModel::linear) {
    const Gas& gas = *p.scene.device.gas;
    const double g = p.scene.device.gap.electrode;
    const double closed = g - p.scene.device.gap.contact, lambda = mean_free_path(gas);
    const double omega = p.model.angular_frequencies()[0];
    add("squeeze number", fmt::format("{} at the rest gap, {} closed (first mode; the film laws hold below about {})",
                                      plain_number(squeeze_number(gas, s.width, g, omega)),
                                      plain_number(squeeze_number(gas, s.width, closed, omega)), plain_number(incompressible)));
    add("Knudsen number", fmt::format("{} at the rest gap, {} closed (mean free path {})", plain_number(lambda / g),
                                      plain_number(lambda / closed), given_quantity(lambda, "m", 3)));
  }
  for (const auto& [name, signal] : named_signals(p)) {
    const auto limits = p.drives.limits.find(name);
    add("drive " + name,
        fmt::format("hold {}, peak {}, {}", given_quantity(signal.hold_level(), "V"), given_quantity(signal.peak(), "V"),
                    limits == p.drives.limits.end()
                        ? "driver without limits"
                        : fmt::format("driver {} to {}", given_quantity(limits->second.min_voltage, "V"),
                                      given_quantity(limits->second.max_voltage, "V"))));
  }
  if (!p.model.has_contact()) add("contact", "none: a run ends at first touch");
  add("window", fmt::format("{}, integrator tolerance {}", given_quantity(p.duration, "s", 4), scientific(p.tolerance)));
  for (const std::string& w : p.scene.warnings) text += "\n" + wrapped("warning: " + w) + "\n";
  work->watch().throw_if_stopped();
  work.reset();
  print(text);
  return exit_done;
}

int effects_verb(const Common& c) {
  const SceneFile file = load_scene(c);
  std::optional<WatchedWork> work(std::in_place, c.quiet, c.stop);
  const Prepared p = prepare_and_choose(file, false, work->watch());
  static_cast<void>(claim_places(c, {}));
  const Effects effects = compare_effects(p, work->watch());
  work.reset();
  print_json_or(c, effects_json(p, effects, {.command = c.command}), effects_text(effects));
  return effects.interrupted ? exit_interrupted : status_code(effects.own("gas").metrics.status);
}

int accuracy_verb(const Common& c) {
  const SceneFile file = load_scene(c);
  const Prepared p = prepare_and_choose(file, false, WatchedWork(c.quiet, c.stop).watch());
  std::optional<ResultFolder> folder = claim_places(c, {"report.html", "accuracy.svg", "accuracy.json"});
  Bar bar(c.quiet);
  AccuracyOptions options{.stop = c.stop};
  std::size_t done = 0, of = 0;
  const auto state = [&](double elapsed) {
    return std::pair(static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(1, of)),
                     fmt::format("{} of {} settings, {:.0f} s", done, of, elapsed));
  };
  options.on_progress = [&](std::size_t now, std::size_t all) {
    done = now;
    of = all;
    bar.show(state);
  };
  const AccuracyStudy study = study_accuracy(p, options);
  bar.close(state);
  const json j = accuracy_json(p, study, {.command = c.command});
  std::string text = accuracy_text(study);
  if (folder && !study.rows.empty()) {
    folder->write("report.html", accuracy_html(p, study, {.command = c.command}));
    folder->write("accuracy.svg", accuracy_svg(p.scene.title, study));
    folder->write("accuracy.json", json_text(j, 2));
    const bool interrupted = study.status == Status::interrupted;
    text += left_in(folder->destination(interrupted), {"report.html", "accuracy.svg", "accuracy.json"});
    folder->publish(interrupted);
  }
  print_json_or(c, j, text);
  return status_code(study.status);
}

namespace {

// "a,b,c"
std::vector<std::string> parts_of(const std::string& list) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
    end = list.find(',', begin);
    parts.push_back(list.substr(begin, end - begin));
  }
  return parts;
}

// "Vdp,frequency:0.5 %", and " in 8 classes" where devices are sorted: puts it in the place of what the scene says.
void calibrate(SceneFile& file, const std::string& given) {
  if (given.empty()) return;
  file.erase("calibration");
  if (given == "none") return;
  constexpr std::string_view before = " in ", after = " classes";
  const std::size_t in = given.ends_with(after) ? given.rfind(before) : std::string::npos;
  for (const std::string& one : parts_of(given.substr(0, in))) {
    const std::size_t colon = one.find(':');
    const std::string name = one.substr(0, colon), error = colon == std::string::npos ? "0 %" : one.substr(colon + 1);
    require(name == measured_pull_in || name == measured_frequency, [&] {
      return fmt::format("--calibrate {}: '{}' is no measurement; there are {} and {}, with an error such as {}:1 %",
                         shown(given), name, measured_pull_in, measured_frequency, measured_pull_in);
    });
    file.set(fmt::format("calibration.{}.error=\"{}\"", name, error));
  }
  if (in == std::string::npos) return;
  const std::size_t number = in + before.size();
  file.set("calibration.classes=" + given.substr(number, given.size() - after.size() - number));
}

constexpr std::array<const char*, 3> robustness_files{"robustness.html", "robustness.json", "devices.csv"};

// What is known of the last drive beside its figures, `other_ways_too` at the cost of further searches; nothing where the work
// was interrupted.
void add_details(RobustnessReport& report, bool other_ways_too, const Watch& watch) {
  if (report.found.interrupted || report.found.devices == 0) return;
  constexpr std::uint64_t devices_per_row = 4, most_rows = 1024;
  const DriveRobustness& last = report.found.drives.back();
  report.sensitivity =
      sensitivity(report.nominal, last, std::clamp<std::uint64_t>(report.options.samples / devices_per_row, 8, most_rows),
                  report.options, watch);
  report.courses = device_courses(report.nominal, last, report.found, report.options);
  if (other_ways_too) report.other_ways = other_ways(report.nominal, last, report.options, {}, watch);
  report.interrupted = watch.stopped();
}

// The scene of the worst device of the box.
std::string box_file(std::string_view key) { return fmt::format("box-{}.toml", ensemble_figure(key).symbol); }

void write_robustness(ResultFolder& folder, const RobustnessReport& report) {
  folder.write("robustness.html", robustness_html(report));
  folder.write("robustness.json", json_text(robustness_json(report), 2));
  folder.write("devices.csv", robustness_csv(report));
}

// What a search is asked for, but for its robustness.
OptimizeOptions read_options(const Common& c, const OptimizeRequest& request) {
  const TargetRow* target = find_named(targets, request.target);
  require(target != nullptr, [&] { return fmt::format("--target {}: must be {}", request.target, listed(targets)); });
  const Named<Actuator>* actuator = find_named(actuators, request.actuator);
  require(actuator != nullptr, [&] { return fmt::format("--actuator {}: must be {}", request.actuator, listed(actuators)); });
  OptimizeOptions options{.target = target->value,
                          .actuator = actuator->value,
                          .family = request.waveform,
                          .optimizer = request.optimizer,
                          .stop = c.stop};
  options.jobs = job_count(request.jobs);
  if (request.seed) options.seed = whole_number<std::uint64_t>("--seed", *request.seed, 0);
  options.max_evaluations = request.robust.empty() ? default_budget(options.target, options.actuator) : default_closings;
  if (request.budget) read_budget(*request.budget, options);
  return options;
}

Common with_defaults(Common c) {
  if (c.scene.empty()) c.scene = shipped_scene("mem-gold-pzt.toml").string();
  if (c.out.empty()) c.out = "softland-out";
  return c;
}

RobustOptions read_robust_options(const OptimizeRequest& request) {
  const std::vector<FigureName> figures = conditioned_figures();
  const auto read = [](const std::string& option, const auto& parse) {
    try {
      return parse();
    } catch (const InvalidInput& error) {
      throw InvalidInput(fmt::format("{}: {}", option, error.what()));
    }
  };
  RobustOptions robust;
  robust.aim.measure = read("--robust " + request.robust, [&] { return parse_robust_measure(request.robust, figures); });
  for (const std::string& text : request.conditions)
    robust.aim.conditions.push_back(read("--constrain", [&] { return parse_criterion(text, figures); }));
  if (request.samples) robust.samples = whole_number<std::uint64_t>("--samples", *request.samples, 8);
  require(robust.samples <= most_searched,
          [&] { return fmt::format("--samples {}: must be at most {}", robust.samples, most_searched); });
  require(request.optimizer == "auto",
          [&] { return fmt::format("--optimizer {}: a robust search has a method of its own", request.optimizer); });
  return robust;
}

// A search on its way: its progress, the folder it fills, its log.
class Searching {
 public:
  Searching(const Common& c, const OptimizeRequest& request, OptimizeOptions& options)
      : preparation_(std::in_place, c.quiet, c.stop),
        progress_(c.quiet, options, request.robust.empty() ? "evaluations" : "closings") {
    options.on_preparation = [this](std::string_view what, double part) {
      if (!preparation_) return;
      preparation_->watch().tell(what, part);
    };
    options.on_start = [this, &c, &request](const std::vector<std::string>& variables) {
      preparation_.emplace(c.quiet, c.stop);
      std::vector<std::string> files{"best.toml",   "best.csv",       "report.html",    "gap.svg",
                                     "result.json", "trajectory.csv", "evaluations.csv"};
      if (!request.robust.empty()) files.insert(files.end(), robustness_files.begin(), robustness_files.end());
      folder_ = claim_places(c, files);
      log_.emplace(*folder_, variables);
      if (c.quiet) return;
      const std::string devices = request.robust.empty() ? "" : fmt::format(", over devices of the spread ({})", request.robust);
      say(fmt::format("{}: searching a {} waveform, actuator {}, target {}{}; results go to {}", c.scene, request.waveform,
                      request.actuator, request.target, devices, c.out));
    };
    options.on_evaluation = [this](const Evaluation& e, const OptimizeProgress& p) {
      log_->evaluated(e);
      progress_.show(p);
    };
    options.on_progress = [this](const OptimizeProgress& p) { progress_.show(p); };
    options.on_improvement = [this](const Evaluation&, const SceneFile& best) { log_->improved(best); };
  }

  // When the search has ended.
  void close() {
    preparation_.reset();
    progress_.close();
    log_->flush();
  }
  [[nodiscard]] ResultFolder& folder() { return *folder_; }
  [[nodiscard]] const SearchLog& log() const { return *log_; }

 private:
  std::optional<WatchedWork> preparation_;
  SearchProgress progress_;
  std::optional<ResultFolder> folder_;
  std::optional<SearchLog> log_;
};

// Writes what a search has found, and names the files it leaves.
std::vector<std::string> write_found(Searching& searching, const OptimizeResult& result, Result& found, const fs::path& place) {
  for (const auto& [index, e] : searching.log().evaluations())
    found.search.evaluations.push_back({static_cast<double>(index), e.value});
  found.reproduce = {found.command, "softland simulate " + shell_word((place / "best.toml").string())};
  std::vector<std::string> left{"report.html", "gap.svg", "result.json"};
  ResultFolder& folder = searching.folder();
  if (result.best_scene) {
    folder.write("best.toml", result.best_scene->scene.file.text());
    folder.write("best.csv", csv(named_signals(*result.best_scene), result.best_scene->duration));
    left.insert(left.end(), {"trajectory.csv", "best.toml (run it with `softland simulate`)", "best.csv"});
  }
  left.emplace_back("evaluations.csv");
  write_result(folder, found);
  return left;
}

int status_of(const OptimizeResult& result) {
  if (result.search.termination == Termination::interrupted) return exit_interrupted;
  return result.best && result.better_than_baseline ? exit_done : exit_no_success;
}

int robust_optimize_verb(const Common& given, const OptimizeRequest& request) {
  const Common c = with_defaults(given);
  OptimizeOptions options = read_options(c, request);
  const RobustOptions robust = read_robust_options(request);
  SceneFile file = load_scene(c);
  calibrate(file, request.calibration);
  Searching searching(c, request, options);
  RobustResult result = robust_optimize(file, options, robust);
  std::optional<RobustnessReport> report;
  if (result.verdict) {
    report.emplace(RobustnessReport{.nominal = *result.found.best_scene,
                                    .found = *result.verdict,
                                    .options = {.samples = robust.verdict, .seed = options.seed, .jobs = options.jobs},
                                    .command = c.command});
    add_details(*report, false, {.stop = c.stop, .progress = options.on_preparation});
    if (report->interrupted) result.found.search.termination = Termination::interrupted;
  }
  searching.close();

  Result found = result_of(result, options, robust, {.command = c.command});
  const bool interrupted = result.found.search.termination == Termination::interrupted;
  const fs::path place = searching.folder().destination(interrupted);
  std::vector<std::string> left = write_found(searching, result.found, found, place);
  std::string text;
  if (report) {
    write_robustness(searching.folder(), *report);
    left.insert(left.end(), robustness_files.begin(), robustness_files.end());
    text = "\n" + robustness_text(*report);
  }
  searching.folder().publish(interrupted);
  print_result(c, found, text + left_in(place, left));
  return status_of(result.found);
}

}  // namespace

int optimize_verb(const Common& given, const OptimizeRequest& request) {
  if (!request.robust.empty()) return robust_optimize_verb(given, request);
  for (const bool is_given : {!request.conditions.empty(), !request.calibration.empty(), request.samples.has_value()})
    require(!is_given,
            "--constrain, --calibrate and --samples are for a search over devices: give --robust too, such as --robust cvar:0.9");
  const Common c = with_defaults(given);
  OptimizeOptions options = read_options(c, request);
  const SceneFile file = load_scene(c);
  Searching searching(c, request, options);
  const OptimizeResult result = optimize(file, options);
  searching.close();

  Result found = result_of(result, options, {.command = c.command});
  const bool interrupted = result.search.termination == Termination::interrupted;
  const fs::path place = searching.folder().destination(interrupted);
  const std::vector<std::string> left = write_found(searching, result, found, place);
  searching.folder().publish(interrupted);
  const bool judged = result.best_scene && !interrupted && c.json != "-";
  print_result(c, found, (judged ? on_devices(c, result.best_scene.value(), options.jobs, place) : "") + left_in(place, left));
  return status_of(result);
}

int robustness_verb(const Common& c, const RobustnessRequest& request) {
  RobustnessOptions options{.jobs = job_count(request.jobs)};
  if (request.samples) options.samples = whole_number<std::uint64_t>("--samples", *request.samples, 1);
  if (request.seed) options.seed = whole_number<std::uint64_t>("--seed", *request.seed, 0);
  const auto* points = find_named(point_sets, request.points);
  require(points != nullptr, [&] { return fmt::format("--points {}: must be {}", request.points, listed(point_sets)); });
  options.points = points->value;
  require(options.samples <= SamplePoints::largest_size,
          [&] { return fmt::format("--samples {}: must be at most {}", options.samples, SamplePoints::largest_size); });

  SceneFile file = scene_of_result(c.scene);
  for (const std::string& assignment : c.set) file.set(assignment);
  calibrate(file, request.calibration);
  options.worth_of_measuring = true;
  std::optional<WatchedWork> work(std::in_place, c.quiet, c.stop);
  const Prepared nominal = prepare_and_choose(file, true, work->watch());
  const Calibration& calibration = nominal.scene.calibration;
  std::vector<NamedDrive> drives{{.name = c.scene, .waveforms = nominal.drives.waveforms, .calibration = calibration}};
  for (const std::string& result : request.results) {
    drives.push_back({.name = result,
                      .waveforms = prepare(scene_of_result(result), false, work->watch()).drives.waveforms,
                      .calibration = calibration});
  }
  std::vector<std::string> files(robustness_files.begin(), robustness_files.end());
  constexpr std::size_t most_worst = 3;
  for (std::size_t i = 1; i <= most_worst; ++i) files.push_back(fmt::format("worst-{}.toml", i));
  for (const std::string_view key : explained_figures) files.push_back(box_file(key));
  std::optional<ResultFolder> folder = claim_places(c, files);

  const Robustness found = robustness(nominal, drives, options, work->watch());
  RobustnessReport report{.nominal = nominal, .found = found, .options = options, .command = c.command};
  add_details(report, request.other_ways, work->watch());
  const json j = robustness_json(report);
  std::string text = robustness_text(report);
  work.reset();
  if (folder) {
    write_robustness(*folder, report);
    const DriveRobustness& last = found.drives.back();
    for (std::size_t i = 0; i < most_worst && i < last.worst.size(); ++i)
      folder->write(fmt::format("worst-{}.toml", i + 1), scene_of_device(nominal, last, last.worst[i], options).text());
    std::vector<std::string> left{"robustness.html", "robustness.json", "devices.csv",
                                  "worst-*.toml (the worst devices of the last drive, for `softland simulate`)"};
    if (report.other_ways && !report.other_ways->ranges.empty()) {
      for (const FigureRange& range : report.other_ways->ranges) {
        if (!range.most.values.empty())
          folder->write(box_file(range.key), scene_of_device(nominal, last, range.most, options).text());
      }
      left.emplace_back("box-*.toml (those of the box)");
    }
    text += left_in(folder->destination(report.interrupted), left);
    folder->publish(report.interrupted);
  }
  print_json_or(c, j, text);
  return report.interrupted ? exit_interrupted : exit_done;
}

namespace {

// "Vdp:1 %,time:0.5 %"
void read_errors(const std::string& list, MeasurementOptions& options) {
  const std::array<std::pair<std::string_view, double*>, 5> errors{{{"Vdp", &options.pull_in_error},
                                                                    {"Vsp", &options.static_pull_in_error},
                                                                    {"release", &options.release_error},
                                                                    {"frequency", &options.frequency_error},
                                                                    {"time", &options.time_error}}};
  for (const std::string& one : parts_of(list)) {
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
          "--error {}: must be Vdp, Vsp, release, frequency or time with an error from 0 to 50 %, such as \"Vdp:1 %\"",
          shown(list));
    });
    *row->second = q.value;
  }
}

// "1.1,1.25"
std::vector<double> read_steps(const std::string& list) {
  std::vector<double> steps;
  for (const std::string& one : parts_of(list)) {
    constexpr double most = 10;
    double value = 0;
    const auto [end, error] = std::from_chars(one.data(), one.data() + one.size(), value);
    require(error == std::errc() && end == one.data() + one.size() && value >= 1 && value <= most &&
                (steps.empty() || value > steps.back()),
            [&] {
              return fmt::format("--steps {}: must be rising multiples of Vdp from 1 to {:g}, such as 1.1,1.25,1.5", shown(list),
                                 most);
            });
    steps.push_back(value);
  }
  constexpr std::size_t most_steps = 8;
  require(steps.size() <= most_steps, [&] { return fmt::format("--steps {}: at most {} of them", list, most_steps); });
  return steps;
}

}  // namespace

int calibrate_verb(const Common& c, const CalibrateRequest& request) {
  MeasurementOptions options{.jobs = job_count(request.jobs)};
  if (request.samples) options.samples = whole_number<std::uint64_t>("--samples", *request.samples, fewest_measured);
  require(options.samples <= most_measured,
          [&] { return fmt::format("--samples {}: must be at most {}", options.samples, most_measured); });
  if (request.seed) options.seed = whole_number<std::uint64_t>("--seed", *request.seed, 0);
  if (!request.errors.empty()) read_errors(request.errors, options);
  if (!request.steps.empty()) options.steps = read_steps(request.steps);
  SceneFile file = scene_of_result(c.scene);
  for (const std::string& assignment : c.set) file.set(assignment);
  std::optional<WatchedWork> work(std::in_place, c.quiet, c.stop);
  static_cast<void>(claim_places(c, {}));
  const MeasurementStudy study = study_measurements(file, options, work->watch());
  work.reset();
  print_json_or(c, measurements_json(study, options, c.command), measurements_text(study, options));
  return study.interrupted ? exit_interrupted : exit_done;
}

int new_verb(const std::string& kind) {
  const std::map<std::string, std::string> scenes{
      {"cantilever", "mem-gold.toml"},           {"cantilever-pzt", "mem-gold-pzt.toml"},
      {"clamped-clamped", "hung-senturia.toml"}, {"plate", "purdue-nickel.toml"},
      {"nem-cantilever", "nem-tin.toml"},        {"nem-casimir", "nem-casimir.toml"},
      {"two-electrodes", "two-electrodes.toml"}};
  const auto found = scenes.find(kind);
  std::vector<std::string> kinds;
  for (const auto& [name, scene] : scenes) kinds.push_back(name);
  require(found != scenes.end(), fmt::format("new {}: must be one of {}", kind, fmt::join(kinds, ", ")));
  print(read_file(shipped_scene(found->second)));
  return exit_done;
}

namespace {

// What was measured on a device.
std::optional<double> measured(const char* option, const std::optional<std::string>& text, const Dimension& due) {
  if (!text) return std::nullopt;
  Quantity q;
  try {
    q = parse_quantity(*text);
  } catch (const InvalidInput& error) {
    throw InvalidInput(fmt::format("{} {}: {}", option, shown(*text), error.what()));
  }
  require(q.dimension == due && q.value > 0, [&] {
    return fmt::format("{} {}: must be {} above 0, such as \"{}\"", option, shown(*text), describe(due), example(due));
  });
  return q.value;
}

}  // namespace

int export_verb(const Common& c, const ExportRequest& request) {
  SceneFile file = scene_of_result(request.result);
  require(request.format == "csv" || request.format == "spice-pwl",
          fmt::format("--format {}: must be csv or spice-pwl", request.format));
  const std::optional<double> pull_in = measured("--device-vdp", request.device_pull_in, dimension::voltage),
                              frequency = measured("--device-frequency", request.device_frequency, dimension::frequency);
  const bool is_own = pull_in || frequency;
  std::optional<WatchedWork> work(std::in_place, c.quiet, c.stop);
  const Prepared p = prepare_and_choose(file, is_own, work->watch());
  std::map<std::string, Signal> signals = named_signals(p);
  if (is_own) {
    const DeviceMeter meter(p, pull_in.has_value());
    const Calibration& calibration = p.scene.calibration;
    require(!calibration.classes || (pull_in.has_value() == calibration.pull_in_error.has_value() &&
                                     frequency.has_value() == calibration.frequency_error.has_value()),
            "--device-vdp, --device-frequency: the scene sorts devices into classes: give what [calibration] measures");
    const KnownUnits known = known_units(p, std::array{calibration}, job_count({}), work->watch()).front();
    const DeviceUnits units =
        known.of({.volts = pull_in ? *pull_in / meter.pull_in() : 1, .time = frequency ? meter.frequency() / *frequency : 1});
    const std::vector<std::string> names = p.drive_names();
    const std::vector<Waveform> waveforms = in_units(p.in_drive_order(p.drives.waveforms), p.scene.device, units);
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (names[k] != dispersion_drive) signals[names[k]] = signal(waveforms[k]);
    }
  }
  work.reset();
  print(request.format == "csv" ? csv(signals, p.duration) : spice_pwl(signals, p.duration));
  return exit_done;
}

int report_verb(const Common& given, const std::string& result) {
  const fs::path path = is_folder(result) ? fs::path(result) / "result.json" : fs::path(result);
  const json j = load_result(path);
  require_reportable(j, path.string());
  Common c = given;
  if (c.out.empty()) c.out = path.has_parent_path() ? path.parent_path().string() : ".";
  const std::vector<std::string> files{"report.html", "gap.svg"};
  ResultFolder folder = *claim_places(c, files);
  const Result r = read_result(j);
  write_report(folder, r);
  folder.publish(false);
  print(text_report(r) + left_in(c.out, files));
  return exit_done;
}

}  // namespace softland::apps
