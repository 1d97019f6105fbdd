#include "studies/closing/prepared.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/engineering.h"
#include "model/closing.h"
#include "model/constants.h"
#include "model/contact/face.h"
#include "model/timoshenko.h"
#include "studies/closing/open_command.h"

namespace softland {

std::vector<Waveform> PreparedScene::in_drive_order(const DriveWaveforms& waveforms) const {
  std::vector<Waveform> result;
  for (const std::string& name : drive_names()) {
    const auto found = waveforms.find(name);
    result.push_back(found == waveforms.end() ? Waveform(Step{.level = 0}) : found->second);
  }
  return result;
}

std::vector<Waveform> PreparedScene::waveforms(const DriveWaveforms& instead) const {
  std::vector<Waveform> all;
  for (const Drive& drive : drives) {
    const auto other = instead.find(drive.name);
    all.push_back(other != instead.end() ? other->second : drive.waveform.value_or(Step{.level = 0}));
  }
  return all;
}

std::vector<double> PreparedScene::values_before() const {
  std::vector<double> values;
  for (const Drive& drive : drives) values.push_back(drive.value_before());
  return values;
}

Signal PreparedScene::commanded(std::size_t k, const Waveform& waveform) const { return signal(waveform, values_before()[k]); }

std::vector<Signal> PreparedScene::commanded(const std::vector<Waveform>& waveforms) const {
  const std::vector<double> before = values_before();
  std::vector<Signal> signals;
  for (std::size_t k = 0; k < before.size(); ++k) signals.push_back(signal(waveforms[k], before[k]));
  return signals;
}

std::vector<Signal> PreparedScene::signals() const {
  std::vector<Signal> all = applied(waveforms());
  if (std::isfinite(held_from))
    std::ranges::transform(all, all.begin(), [&](const Signal& s) { return softland::held_from(s, held_from); });
  return all;
}

Signal PreparedScene::commanded_samples(std::size_t k, const Signal& commanded) const {
  return softland::commanded_samples(commanded, drives[k].source, limits(k), duration);
}

Signal PreparedScene::applied(std::size_t k, const Signal& commanded, const SourceErrors& errors) const {
  const DriverModel& own = drives[k].source;
  if (own.is_ideal()) return errors.are_none() ? commanded : with_errors(commanded, errors);
  return softland::applied(commanded, own, limits(k), duration, errors);
}

std::vector<Signal> PreparedScene::applied(std::vector<Signal> commanded) const {
  for (std::size_t k = 0; k < commanded.size(); ++k) commanded[k] = applied(k, commanded[k]);
  return commanded;
}

std::map<std::string, PullInVoltages> PreparedScene::voltage_units() const {
  std::map<std::string, PullInVoltages> units = pull_in_of_limits;
  for (const auto& [name, p] : pull_in) {
    units[name] = {.static_pull_in = p.statically.voltage, .dynamic_pull_in = p.dynamically.voltage};
  }
  return units;
}

std::string initial_state_difference(const DriveWaveforms& waveforms, const std::map<std::string, double>& before,
                                     const PreparedScene& scene) {
  for (const auto& [drive, waveform] : waveforms) {
    const auto found = before.find(drive);
    const Drive* const here = scene.drives.find(drive);
    const double own = found == before.end() ? 0 : found->second, due = here != nullptr ? here->value_before() : 0;
    if (own != due)
      return fmt::format("the drive '{}' stands at {} before its waveform, and at {} in the scene: both must be the same", drive,
                         engineering(own, "V"), engineering(due, "V"));
  }
  return {};
}

namespace {

std::optional<Eigen::VectorXd> equilibrium_before(const PreparedScene& scene, StartState state) {
  if (state == StartState::open) return scene.rest();
  std::optional<ClosedEquilibrium> closed = closed_equilibrium(scene.model, scene.values_before());
  return keeps_closed(scene.model, closed) ? std::optional(std::move(closed->q)) : std::nullopt;
}

}  // namespace

std::optional<Eigen::VectorXd> PreparedScene::start_equilibrium() const { return equilibrium_before(*this, start()); }

std::string other_start_hint(const PreparedScene& scene) {
  const std::string key = before_state_path(scene);
  return scene.start() == StartState::open ? fmt::format("; {} = \"closed\" begins there", key)
                                           : fmt::format("; without {} = \"closed\" a run begins there", key);
}

std::string start_prose(const PreparedScene& scene) {
  const auto stands = [](const Drive& drive) { return drive.value_before() != 0; };
  if (!scene.scene.begins_closed && std::ranges::none_of(scene.drives, stands)) return {};
  constexpr int digits = 5;
  const auto place = [&](const Eigen::VectorXd& q) {
    return fmt::format("its contact point at {}", engineering(scene.model.contact_deflection(q.data()), "m", digits));
  };
  const bool is_closed = scene.start() == StartState::closed;
  const char *own = is_closed ? "closed" : "open", *other = is_closed ? "open" : "closed";
  if (const auto found = scene.start_equilibrium()) return fmt::format("{}, {}", own, place(*found));
  const auto there = equilibrium_before(scene, is_closed ? StartState::open : StartState::closed);
  return fmt::format("none: there is no stable {} state at the voltages before t = 0{}", own,
                     there ? fmt::format(", but a stable {} one, {}{}", other, place(*there), other_start_hint(scene)) : "");
}

void require_open_start(const Scene& scene, std::string_view study) {
  if (!scene.begins_closed) return;
  for (const std::string& drive : drive_names(scene.device)) {
    const std::string path = "waveform." + drive + ".before_state";
    if (scene.file.written(path) == "closed")
      scene.file.refuse(path,
                        fmt::format("{} from the open state; simulate, check, export and explore take a closed start", study));
  }
}

std::string before_state_path(const PreparedScene& scene) {
  const Drive* named = nullptr;
  for (const Drive& drive : scene.drives) {
    const bool says_so = drive.begins_closed || drive.before;
    if (says_so || (named == nullptr && drive.waveform)) named = &drive;
    if (says_so) break;
  }
  return fmt::format("waveform.{}.before_state", named != nullptr ? named->name : "NAME");
}

// Returns the loosest tolerance of the integrator with which the figures of random scenes have the relative `accuracy`
// (results/accuracy.md).
double tolerance_for(double accuracy, bool stiff) { return std::clamp(accuracy / 10, 1e-12, stiff ? 1e-4 : 1e-3); }

namespace {

constexpr double longest_window = 1e3;  // longest simulated time [s], equal to the upper limit of simulate.duration

/// Returns the number of periods of a waveform's sine within the simulated time `window` [s].
double periods_of(const Waveform& waveform, double window) {
  const auto lasts = [&](const auto& sine) { return std::min(sine.end, window) - sine.start; };
  if (const auto* sine = std::get_if<Harmonic>(&waveform))
    return sine->amplitude == 0 ? 0 : sine->angular_frequency / (2 * pi) * lasts(*sine);
  if (const auto* chirp = std::get_if<Chirp>(&waveform))
    return chirp->amplitude == 0 ? 0
                                 : chirp->angular_frequency * std::max(1.0, chirp->frequency_ratio) / (2 * pi) * lasts(*chirp);
  return 0;
}

/// Returns the default simulated time (window) of a scene that closes [s]. It is six periods of the first mode, or four times
/// the time of first contact under steps to the hold levels if this is longer, as in a thick gas. A damped switch moves slowly
/// just above pull-in, so first contact is awaited for up to 60 periods; for up to 6000 if no open equilibrium exists.
double default_window(const Switch& model, const std::vector<Signal>& signals) {
  constexpr double periods = 6, closings = 4, loose = 1e-4;
  constexpr long most_steps = 100'000;
  const double usual = periods * 2 * pi / model.basis().angular_frequencies()[0];
  if (!(usual <= longest_window)) return usual;
  std::vector<Signal> steps;
  for (const Signal& signal : signals) steps.push_back(Signal::constant(signal.hold_level(), signal.before()));
  const double longest = model.open_equilibrium(hold_levels(steps)) ? 10 : 1000;
  const double closing = first_closing(model, steps, {.duration = longest * usual, .tolerance = loose, .max_steps = most_steps});
  return std::isfinite(closing) ? std::max(usual, closings * closing) : usual;
}

/// Returns the default simulated time (window) of a scene that opens a closed switch from `begin` on [s]. It ends two periods
/// of the first mode after the switch is at rest in its open state, but at least six and at most sixty periods after `begin`.
double default_window_of_opening(const Switch& model, const std::vector<Signal>& signals, StartState start, double begin) {
  constexpr double periods = 6, longest = 10, loose = 1e-4, settled = 0.02, margin = 2;
  constexpr long most_steps = 100'000;
  const double period = 2 * pi / model.basis().angular_frequencies()[0], usual = periods * period;
  const std::optional<Eigen::VectorXd> open = model.open_equilibrium(hold_levels(signals));
  if (!open || !(begin + usual <= longest_window)) return begin + usual;
  const Trajectory opening = simulate_closing(
      model, signals, {.duration = begin + longest * usual, .tolerance = loose, .max_steps = most_steps, .start = start});
  const double position = model.contact_deflection(open->data());
  double furthest = 0, since = begin;
  for (const TrajectoryPoint& p : opening.points)
    if (p.time >= begin) furthest = std::max(furthest, std::abs(p.position - position));
  for (const TrajectoryPoint& p : opening.points) {
    if (p.time >= begin && !(std::abs(p.position - position) <= settled * furthest)) since = p.time;
  }
  return std::clamp(since + margin * period, begin + usual, begin + longest * usual);
}

/// Returns the drive signals of the scene without the effects of sampling and filters in the voltage sources.
std::vector<Signal> without_sources(const PreparedScene& p) {
  std::vector<Signal> signals = p.commanded(p.waveforms());
  for (std::size_t k = 0; k < signals.size(); ++k) {
    if (!p.drives[k].errors.are_none()) signals[k] = with_errors(signals[k], p.drives[k].errors);
  }
  return signals;
}

/// Returns the default simulated time (window) of a scene [s].
double default_window(const PreparedScene& p) {
  const std::vector<Signal> signals = without_sources(p);
  if (p.start() == StartState::closed) return default_window_of_opening(p.model, signals, StartState::closed, 0);
  const double asked = p.scene.simulate.open_at;
  if (std::isfinite(asked)) return default_window_of_opening(p.model, signals, StartState::open, asked);
  if (const std::optional<OpenCommand> command = open_command(p.model, signals, StartState::open))
    return default_window_of_opening(p.model, signals, StartState::open, command->time);
  return default_window(p.model, signals);
}

void check_open_at(const PreparedScene& p) {
  const double asked = p.scene.simulate.open_at;
  if (!std::isfinite(asked)) return;
  const SceneFile& file = p.scene.file;
  if (!p.model.has_contact()) file.refuse("simulate.open_at", "needs a [contact] section: without one nothing opens");
  if (!(asked < p.duration))
    file.refuse("simulate.open_at", fmt::format("must lie in the window, which ends at {}", engineering(p.duration, "s")));
}

/// Throws InvalidInput for a simulated time above longest_window, and for waveforms with more than 1e5 sine periods in this
/// time.
void check_window(const PreparedScene& p) {
  const SceneFile& file = p.scene.file;
  if (!(p.duration <= longest_window)) {
    file.refuse("structure.kind",
                fmt::format("the window, where simulate.duration is absent six periods of the first mode or more, is {} "
                            "and must be at most {}: the structure is too soft or too heavy",
                            engineering(p.duration, "s"), engineering(longest_window, "s")));
  }
  constexpr double most_periods = 1e5;
  for (const auto& [name, waveform] : p.drives.waveforms()) {
    const double periods = periods_of(waveform, p.duration);
    if (!(periods > most_periods)) continue;
    const std::string section = "waveform." + name + ".";
    const bool in_hertz = file.written(section + "frequency").has_value();
    file.refuse(section + (in_hertz ? "frequency" : "angular_frequency"),
                fmt::format("makes {} periods in the window of {}, and at most {} are allowed", engineering(periods, "", 3),
                            engineering(p.duration, "s"), engineering(most_periods, "")));
  }
}

/// Sets the load of every voltage source: the capacitance of its electrode in the open switch.
void load_sources(PreparedScene& p) {
  const Switch& model = p.model;
  std::vector<double> open(static_cast<std::size_t>(model.modes()), 0.0);
  if (const auto rest = p.rest()) std::copy_n(rest->data(), open.size(), open.begin());
  Switch::Workspace work = model.workspace();
  for (std::size_t k = 0; k < p.drives.size(); ++k) {
    if (p.drives[k].source.source_resistance) p.drives[k].source.load = model.capacitance(k, open.data(), work);
  }
}

/// Throws InvalidInput for a dielectric whose face is so soft that the electric field pulls the beam through the face.
void check_landing(const PreparedScene& p) {
  const Landing* landing = p.scene.device.landing();
  if (landing == nullptr || landing->is_wall()) return;
  for (std::size_t k = 0; k < p.scene.device.electrodes.size(); ++k) {
    const Electrode& e = p.scene.device.electrodes[k];
    if (!e.dielectric) continue;
    const std::optional<DriverLimits>& limits = p.drives[k].limits;
    const double neutral = e.dielectric->neutral_voltage();
    const double most = limits ? std::max(std::abs(limits->min_voltage - neutral), std::abs(limits->max_voltage - neutral))
                               : std::abs(p.drives[k].hold_level() - neutral);
    const double depth = e.dielectric->depth() + landing->begin();
    std::string key = "stiffness", unit = "Pa/m";
    double own = landing->stiffness, least = least_face_stiffness(most, depth);
    if (const std::optional<UniformAsperities>& rough = landing->asperities) {
      const UniformAsperityContact per_area = uniform_contact(rough->summits, rough->height, {.width = 1, .length = 1});
      key = "asperity_density", unit = "1/m^2";
      own = rough->summits.density;
      // Least density of the summits at which the face withstands the electric field: the voltage that it withstands grows with
      // the root of the contact pressure, which is proportional to the density.
      least = own * std::pow(most / most_face_voltage(per_area, depth), 2);
    }
    if (own > least) continue;
    p.scene.file.refuse(
        "electrode." + e.name + ".dielectric.landing." + key,
        fmt::format("must be greater than {}, below which {} pulls the beam through the face{}", engineering(least, unit, 3),
                    engineering(most, "V", 4), limits ? ", the limit of driver." + e.name : ", its hold level"));
  }
}

/// Returns the value as text with three digits, rounded towards 0.
std::string rounded_down(double value, std::string_view unit) {
  const double digit = std::pow(10, std::floor(std::log10(value)) - 2);
  constexpr double rounding = 1e-12;
  return engineering(std::floor(value / digit * (1 + rounding)) * digit, unit, 3);
}

/// Throws InvalidInput for voltage sources that take more samples than a run may have.
void check_sources(const PreparedScene& p) {
  constexpr double most_samples = 1e5;
  for (const Drive& drive : p.drives) {
    const std::optional<double>& rate = drive.source.sample_rate;
    if (!rate || *rate * p.duration <= most_samples) continue;
    p.scene.file.refuse(
        "driver." + drive.name + ".sample_rate",
        fmt::format("takes {} samples in the window of {}, and at most {} are allowed: give at most {}, a simulate.duration of "
                    "at most {}, "
                    "or no sample_rate",
                    engineering(*rate * p.duration, "", 3), engineering(p.duration, "s"), engineering(most_samples, ""),
                    rounded_down(most_samples / p.duration, "Hz"), rounded_down(most_samples / *rate, "s")));
  }
}

}  // namespace

std::vector<double> bias_of(const Scene& scene, std::size_t drive) {
  std::vector<double> bias = scene.standing;
  bias[drive] = 0;
  return bias;
}

namespace {

// Returns, for a message on an electrode, the levels of the other drives that are not at 0 V: ", under piezo at 0.3 V".
std::string under_bias(const PreparedScene& p, std::size_t electrode) {
  const std::vector<double> bias = bias_of(p.scene, electrode);
  const std::vector<std::string> names = p.drive_names();
  std::string words;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (bias[k] == 0) continue;
    constexpr int digits = 5;
    words += words.empty() ? ", under " : " and ";
    words += names[k] == dispersion_drive
                 ? fmt::format("dispersion force at a factor of {}", engineering(1 + bias[k], "", digits))
                 : fmt::format("{} at {}", names[k], engineering(bias[k], "V", digits));
  }
  return words;
}

}  // namespace

ElectrodePullIn electrode_pull_in(const Switch& model, std::size_t electrode, Bias bias, const Progress& progress) {
  ElectrodePullIn found{.statically = static_pull_in(model, electrode, bias)};
  found.dynamically = dynamic_pull_in(model, electrode, found.statically, bias, progress);
  return found;
}

namespace {

// Computes the pull-in voltages with the other drives at 0 V, as units of an electrode's voltage limits, if the switch has no
// open state under the levels of the other drives. A limit belongs to the source, at any level of the other drives; a waveform
// in these units would be undefined. False if the limits do not need the voltages, or if none exist.
bool take_limits_at_rest(PreparedScene& p, std::size_t electrode, const PullInFinder& find_pull_in, const Progress& progress) {
  const std::vector<std::string> names = p.drive_names();
  if (std::ranges::find(p.scene.limits_in_pull_in, names[electrode]) == p.scene.limits_in_pull_in.end()) return false;
  std::vector<double> bias = bias_of(p.scene, electrode);
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] != dispersion_drive) bias[k] = 0;
  }
  const ElectrodePullIn found = find_pull_in(p.model, electrode, bias, progress);
  if (found.dynamically.status != Status::done) return false;
  p.pull_in_of_limits[names[electrode]] = {.static_pull_in = found.statically.voltage,
                                           .dynamic_pull_in = found.dynamically.voltage};
  p.scene.warnings.push_back(
      fmt::format("[driver.{}]: Vsp and Vdp of its limits, {} and {}, are those with the other drives at 0 V: there are none{}",
                  names[electrode], engineering(found.statically.voltage, "V", 5), engineering(found.dynamically.voltage, "V", 5),
                  under_bias(p, electrode)));
  return true;
}

}  // namespace

PreparedScene prepare_statics(const SceneFile& file) {
  Scene scene = read_scene(file);
  const double accuracy = scene.simulate.tolerance > 0 ? SimulateOptions{}.accuracy : scene.simulate.accuracy;
  ResolvedSwitch resolved = resolved_switch(scene.device, accuracy);
  return {.scene = std::move(scene),
          .model = std::move(resolved.model),
          .pull_in = {},
          .drives = {},
          .quadrature = resolved.quadrature,
          .quadrature_accuracy = accuracy};
}

PreparedScene prepare(const SceneFile& file, bool default_limits, const Progress& progress, const PullInFinder& find_pull_in) {
  const Scene scene = read_scene(file);
  const double accuracy = scene.simulate.tolerance > 0 ? SimulateOptions{}.accuracy : scene.simulate.accuracy;
  ResolvedSwitch resolved = resolved_switch(scene.device, accuracy);
  PreparedScene p{
      .scene = scene, .model = std::move(resolved.model), .quadrature = resolved.quadrature, .quadrature_accuracy = accuracy};
  if (resolved.error > accuracy) {
    p.scene.warnings.push_back(
        fmt::format("the loads at touch are integrated along the structure to {} only, not to accuracy {}: more quadrature "
                    "points do not help",
                    engineering(resolved.error, "", 1), engineering(accuracy, "")));
  }
  if (std::string warning = slenderness_warning(scene.device.structure); !warning.empty()) {
    p.scene.warnings.push_back(std::move(warning));
  }
  for (std::size_t k = 0; k < scene.device.electrodes.size(); ++k) {
    const std::string& name = scene.device.electrodes[k].name;
    const bool needed = std::find(scene.need_pull_in.begin(), scene.need_pull_in.end(), name) != scene.need_pull_in.end();
    if (!needed && !default_limits) continue;
    const ElectrodePullIn found = find_pull_in(p.model, k, bias_of(scene, k), progress);
    progress.throw_if_stopped();
    const bool ok = found.dynamically.status == Status::done;
    if (needed && !ok && !take_limits_at_rest(p, k, find_pull_in, progress)) {
      const bool is_closed = found.statically.status == Status::collapsed_at_rest && scene.device.is_charged();
      file.refuse("electrode." + name + ".span",
                  "its pull-in voltage is needed for the unit Vsp or Vdp, but none could be found" + under_bias(p, k) +
                      (is_closed ? ": the charge on a dielectric leaves no open state" : ""));
    }
    if (ok) p.pull_in.emplace(name, found);
  }
  p.drives = scene.drives(p.voltage_units());
  load_sources(p);
  p.duration = scene.simulate.duration > 0 ? scene.simulate.duration : default_window(p);
  check_open_at(p);
  check_window(p);
  check_sources(p);
  check_landing(p);
  p.tolerance =
      scene.simulate.tolerance > 0 ? scene.simulate.tolerance : tolerance_for(scene.simulate.accuracy, p.model.film_states() > 0);
  return p;
}

}  // namespace softland
