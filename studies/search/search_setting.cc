#include "studies/search/search_setting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <variant>

#include "base/engineering.h"
#include "base/require.h"
#include "model/constants.h"
#include "objectives/cost_slope.h"
#include "objectives/figures.h"
#include "studies/closing/auto_settings.h"
#include "studies/closing/plain_step.h"

namespace softland {
namespace {

constexpr double latest_touch = 2.5;  // latest permitted time of first contact, as a multiple of the plain step's
// A late first contact costs little up to these multiples of its time under the plain step. An electrode can close softly in
// about the time of the step (driven_touch); a piezo only slows the beam (braked_touch).
constexpr double driven_touch = 1.5, braked_touch = 2.0;
constexpr double search_tolerance = 1e-6;  // relative tolerance of the integrator in a search, which gives costs to about 1e-4
constexpr double most_broken = 10;  // upper limit of the counted violation of a condition, relative to the condition's limit
// Weight of the impact velocity in a cost over several numbers of modes. The cost of bounce alone hardly depends on the impact
// velocity, which further modes change most.
constexpr double weight_of_speed = 0.04;
// Cost of bounce from which on a candidate is too bad to be simulated with more modes; the plain step costs about 1.
constexpr double hopeless = 0.25;
constexpr double golden_ratio = 1.618033988749895;

// Returns an estimate of the plain step's figures, the baseline, for a switch that the plain step does not close; an
// overshooting initial pulse may still close it.
Metrics imagined_step(const PreparedScene& given, double period) {
  const double gap = given.scene.device.contact_gap();
  Metrics step;
  step.initial_contact_time = period / 2;
  step.largest_impact_velocity = gap * given.model.basis().angular_frequencies()[0];
  step.major_bounce_height = gap;
  step.impact_energy = step.landing_excess = given.model.bending_energy();
  return step;
}

// Returns the relative excess g of a figure over the limit of a condition, for an optimizer with constraints g <= 0. A small
// margin is added, so that the condition is fulfilled where the optimizer ends at g = 0.
double excess(const Condition& one, const Metrics& metrics) {
  constexpr double margin = 1e-6;
  return std::clamp(one.violation(one.figure.value(metrics)) + margin, -most_broken, most_broken);
}

// Returns the derivative of excess() by the condition's figure.
double excess_rate(const Condition& one, const Metrics& metrics) {
  if (std::abs(excess(one, metrics)) >= most_broken) return 0;
  const double scale = one.limit == 0 ? 1 : std::abs(one.limit);
  return (one.comparison == Comparison::below || one.comparison == Comparison::at_most ? 1 : -1) / scale;
}

// Reduces the limits of an electrode's voltage to the default limit. Returns true if the limits were wider.
bool narrow(DriverLimits& limits, const PullInVoltages& pull_in) {
  const double usual = default_limit(pull_in);
  const DriverLimits before = limits;
  limits.max_voltage = std::min(limits.max_voltage, usual);
  limits.min_voltage = std::max(limits.min_voltage, -usual);
  return limits.max_voltage < before.max_voltage || limits.min_voltage > before.min_voltage;
}

}  // namespace

struct RecordedClosing {
  RecordedClosing(const SearchSetting& setting, std::vector<Signal> under)
      : RecordedClosing(setting, std::move(under), setting.given.model, setting.run.closed_potential) {}
  RecordedClosing(const SearchSetting& setting, std::vector<Signal> under, const Switch& model, double closed_potential)
      : signals(std::move(under)), observer(setting.scale.contact_gap, setting.given.scene.metrics), tape(observer) {
    ClosingOptions run = setting.run_of(signals);
    run.closed_potential = closed_potential;
    metrics = observer.metrics(observe_closing(model, signals, run, tape));
  }
  RecordedClosing(const RecordedClosing&) = delete;
  RecordedClosing& operator=(const RecordedClosing&) = delete;

  std::vector<Signal> signals;
  MetricsObserver observer;
  RecordedMotion tape;
  Metrics metrics;
};

double broken(const std::vector<Condition>& conditions, const Metrics& metrics) {
  double sum = 0;
  for (const Condition& one : conditions) sum += std::clamp(one.violation(one.figure.value(metrics)), 0.0, most_broken);
  return sum;
}

SceneFile with_waveforms(const PreparedScene& prepared, const DriveWaveforms& waveforms) {
  SceneFile file = prepared.resolved();
  for (const auto& [drive, waveform] : waveforms) file.set_waveform(drive, waveform);
  return file;
}

bool can_be_written(const DriveWaveforms& waveforms) {
  return std::ranges::none_of(waveforms, [](const auto& one) { return std::holds_alternative<Own>(one.second); });
}

PreparedScene prepared_with(const PreparedScene& prepared, DriveWaveforms waveforms, const PreparedScene& given) {
  DriveWaveforms own;
  for (auto one = waveforms.begin(); one != waveforms.end();) {
    const auto next = std::next(one);
    if (std::holds_alternative<Own>(one->second)) own.insert(waveforms.extract(one));
    one = next;
  }
  PreparedScene read = read_back(with_waveforms(prepared, waveforms), "best.toml", given);
  for (auto& [drive, waveform] : own) read.drives.at(drive).waveform = std::move(waveform);
  return read;
}

PreparedScene read_back(const SceneFile& file, const std::string& name, const PreparedScene& given) {
  PreparedScene p = choose(prepare(file.again(name)));
  p.scene.warnings = given.scene.warnings;
  // Keep the voltages of the other drives for computing pull-in voltages (`standing`): the text in volts does not show which
  // hold levels depend on pull-in voltages.
  p.scene.standing = given.scene.standing;
  return p;
}

SceneFile SearchSetting::scene(const DriveWaveforms& searched) const { return with_waveforms(baseline_scene, searched); }

std::optional<SceneFile> SearchSetting::scene_at(std::span<const double> x) const {
  const DriveWaveforms searched = space.waveforms(x);
  return can_be_written(searched) ? std::optional(scene(searched)) : std::nullopt;
}

PreparedScene SearchSetting::prepared(const DriveWaveforms& searched) const {
  return prepared_with(baseline_scene, searched, given);
}

std::vector<Waveform> SearchSetting::drives(const DriveWaveforms& searched) const { return baseline_scene.waveforms(searched); }

bool SearchSetting::is_allowed(const DriveWaveforms& searched) const {
  const std::vector<std::string> names = given.drive_names();
  return std::all_of(searched.begin(), searched.end(), [&](const auto& one) {
    const auto k = static_cast<std::size_t>(std::find(names.begin(), names.end(), one.first) - names.begin());
    return keeps_limits(one.first, one.second, given.commanded(k, one.second));
  });
}

std::optional<std::vector<Signal>> SearchSetting::allowed_commands(const DriveWaveforms& searched) const {
  const std::vector<std::string> names = given.drive_names();
  std::vector<Signal> commanded = given.commanded(drives(searched));
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto one = searched.find(names[k]);
    if (one != searched.end() && !keeps_limits(one->first, one->second, commanded[k])) return std::nullopt;
  }
  return commanded;
}

bool SearchSetting::keeps_limits(const std::string& drive, const Waveform& waveform, const Signal& commanded) const {
  if (std::holds_alternative<Own>(waveform) && !space.drive(drive).holds(commanded)) return false;
  return violation(commanded, limits_for(waveform, limits.at(drive))).empty();
}

// The simulation of a candidate waveform lasts beyond the last breakpoint, since a later change of a drive could open the
// switch again.
ClosingOptions SearchSetting::run_of(const std::vector<Signal>& signals) const {
  ClosingOptions own = run;
  own.no_end_before = last_breakpoint(signals) + given.model.basis().in_contact_period();
  own.duration = std::max(run.duration, own.no_end_before);
  return own;
}

SearchCosts SearchSetting::price(const std::vector<Signal>& signals) const {
  return worst_price(RecordedClosing(*this, signals));
}

SearchCosts SearchSetting::worst_price(const RecordedClosing& closing) const {
  SearchCosts worst = price_of(closing);
  if (richer.empty()) return worst;
  const auto with_speed = [this](SearchCosts costs, const RecordedClosing& run) {
    if (target.has_own_cost() || target.from_the_start() != nullptr) return costs;
    costs.target = costs.guide += weight_of_speed * run.metrics.largest_impact_velocity / scale.step.largest_impact_velocity;
    return costs;
  };
  worst = with_speed(worst, closing);
  for (const RicherBeam& beam : richer) {
    if (!(worst.guide < hopeless)) break;
    const RecordedClosing run(*this, closing.signals, beam.model, beam.closed_potential);
    const SearchCosts other = with_speed(price_of(run), run);
    worst.guide = std::max(worst.guide, other.guide);
    worst.target = std::max(worst.target, other.target);
    worst.bounce_free = worst.bounce_free && other.bounce_free;
  }
  return worst;
}

Metrics SearchSetting::with_rest_and_drives(Metrics metrics, const std::vector<Signal>& signals) const {
  metrics.hold_force = baseline.metrics.hold_force;  // figures of the closed switch at rest: no search changes the hold levels
  metrics.capacitance = baseline.metrics.capacitance;
  metrics.resistance = baseline.metrics.resistance;
  set_drive_figures(metrics, given, signals);
  return metrics;
}

SearchCosts SearchSetting::price_of(const RecordedClosing& closing) const {
  const bool needs_all = !conditions.empty() || target.has_own_objective();
  const Metrics figures = needs_all ? with_rest_and_drives(closing.metrics, closing.signals) : closing.metrics;
  const auto by = [&](const Aim& one) { return cost(one, figures, scale, given.scene.metrics); };
  SearchCosts costs{.guide = by(target.has_own_cost() ? Target::bounce : target)};
  costs.target = target.has_own_cost() ? by(target) : costs.guide;
  costs.bounce_free = costs.guide < never_touched && figures.major_bounce_height <= given.scene.metrics.significant_rebound;
  if (conditions.empty()) return costs;
  if (!(costs.guide < never_touched)) {
    costs.apart = {.guide = costs.guide, .target = costs.target, .excess = {}};
    costs.apart->excess.assign(followed_conditions().size(), most_broken);
    return costs;
  }
  costs.apart = {.guide = costs.guide, .target = costs.target, .excess = {}};
  for (const Condition& one : followed_conditions()) costs.apart->excess.push_back(excess(one, figures));
  const double violation = broken(conditions, figures);
  if (!(violation > 0)) return costs;
  // The penalty of violated conditions is below 3, less than the cost of not reaching the contact. For a target whose cost
  // differs from that of bounce, 1 is added, so that every violation costs more than any closing that fulfils the conditions.
  const double penalty = 3 * violation / (1 + violation);
  costs.guide += penalty;
  costs.target += target.has_own_cost() ? 1 + penalty : penalty;
  return costs;
}

SearchCosts SearchSetting::cost_at(std::span<const double> x, EvaluationMemory* memory, LastClosing* last) const {
  std::optional<std::vector<Signal>> commanded = allowed_commands(space.waveforms(x));
  if (!commanded) return {};
  const EvaluationKey key{.family = family, .x = {x.begin(), x.end()}};
  if (memory != nullptr) {
    if (const auto known = memory->recall(key))
      return {.guide = known->guide, .target = known->cost, .bounce_free = known->bounce_free};
  }
  auto closing = std::make_shared<const RecordedClosing>(*this, given.applied(std::move(*commanded)));
  SearchCosts found = worst_price(*closing);
  if (last != nullptr) *last = {.x = key.x, .closing = std::move(closing)};
  found.guide += 0.0, found.target += 0.0;  // turn -0 into 0, since a stored cost may lose the sign
  if (memory != nullptr) memory->note(key, {.cost = found.target, .guide = found.guide, .bounce_free = found.bounce_free});
  return found;
}

std::string SearchSetting::gradient_refusal(const Aim& aim) const {
  if (!richer.empty()) return "the worst of several beams has no gradient";
  if (aim.has_own_objective()) return "an own objective has no gradient";
  for (const DriveSearch& drive : space.drives()) {
    if (drive.own) return fmt::format("{} has no gradient", described({.waveform = drive.own}));
  }
  for (const TargetRow& row : targets) {
    if (aim.is_about(row.value) && !row.no_gradient.empty()) return std::string(row.no_gradient);
  }
  for (const Condition& one : conditions) {
    const bool never_slopes = one.figure.is_count() || one.figure.conditioning == Conditioning::rest;
    if (!never_slopes && (one.comparison == Comparison::equal || one.figure.slope == nullptr))
      return fmt::format("the condition {} has no gradient", one.text);
  }
  return LinearizedClosing::refusal(given.model);
}

std::vector<Condition> SearchSetting::followed_conditions() const {
  std::vector<Condition> followed;
  for (const Condition& one : conditions) {
    if (one.comparison != Comparison::equal && one.figure.slope != nullptr) followed.push_back(one);
  }
  return followed;
}

SignalSlopes SearchSetting::signal_slopes(std::span<const double> x, const std::vector<ParameterGroup>& groups) const {
  std::vector<double> lower, upper;
  for (const Variable& v : space.variables()) lower.push_back(v.lower), upper.push_back(v.upper);
  const auto signals_at = [&](std::span<const double> at) { return given.applied(drives(space.waveforms(at))); };
  return {signals_at, x, lower, upper, groups};
}

std::vector<ParameterGroup> SearchSetting::parameter_groups() const {
  // A point inside the bounds; each parameter is at another share of its range, so that no edges coincide.
  std::vector<double> inside;
  for (const Variable& v : space.variables())
    inside.push_back(std::lerp(v.lower, v.upper, 0.3 + 0.4 * std::fmod(golden_ratio * static_cast<double>(inside.size()), 1.0)));
  return signal_slopes(inside).groups();
}

std::vector<double> SearchSetting::gradient_at(std::span<const double> x, const Aim& aim,
                                               const std::vector<ParameterGroup>& groups, const LastClosing* last) const {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Condition> followed = followed_conditions();
  std::vector<double> gradient((1 + followed.size()) * x.size(), unknown);
  std::shared_ptr<const RecordedClosing> closing;
  if (last != nullptr && last->closing != nullptr && std::equal(x.begin(), x.end(), last->x.begin(), last->x.end())) {
    closing = last->closing;
  } else {
    std::optional<std::vector<Signal>> commanded = allowed_commands(space.waveforms(x));
    if (!commanded) return gradient;
    closing = std::make_shared<const RecordedClosing>(*this, given.applied(std::move(*commanded)));
  }
  LinearizedClosing motion(given.model, closing->signals, closing->tape);
  const CostSlopes slopes = cost_slopes(given.model, closing->signals, motion, given.scene.metrics);
  const auto slope = cost_slope(aim, closing->metrics, scale, given.scene.metrics, slopes);
  if (!slope) return gradient;
  std::vector<FigureSlope> rows{*slope};
  for (const Condition& one : followed) rows.push_back(slopes.of[one.figure.slope]);
  const SignalSlopes by_parameters = signal_slopes(x, groups);
  const Eigen::MatrixXd by_x = motion.backward(rows, by_parameters);
  const Metrics& metrics = closing->metrics;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const double rate = row == 0 ? 1 : excess_rate(followed[row - 1], metrics);
    for (std::size_t k = 0; k < x.size(); ++k)
      gradient[row * x.size() + k] = rate * by_x(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(k));
    for (const std::size_t k : by_parameters.kinks()) gradient[row * x.size() + k] = unknown;
  }
  return gradient;
}

void SearchSetting::check_starts(const std::vector<StartingWaveforms>& starts) const {
  for (const StartingWaveforms& start : starts) {
    std::string reason = initial_state_difference(start.waveforms, start.before, given);
    if (reason.empty()) reason = space.misfit(start.waveforms);
    require_request(reason.empty(), [&] { return fmt::format("{}: {}", start.name, reason); });
  }
}

bool SearchSetting::starts_as_step() const { return same_drives(given.signals(), baseline_scene.signals()); }

PreparedScene SearchSetting::within_limits() const {
  PreparedScene limited = given;
  for (const auto& [drive, own] : limits) limited.drives.at(drive).limits = own;
  return limited;
}

namespace {

void require_asked(const Figure& figure, const AskedFigures& asked, const std::string& request) {
  require_request(figure.is_asked(asked), [&] {
    return fmt::format("{}: the scene has no such figure: it needs {}", request,
                       figure.asked == &AskedFigures::resistance
                           ? "the resistivity of its contacts"
                           : "metrics.closed_force, metrics.closed_resistance or metrics.closed_after");
  });
}

}  // namespace

void require_asked(const Condition& condition, const AskedFigures& asked) {
  require_asked(condition.figure, asked, fmt::format("{} \"{}\"", requested("constrain"), condition.text));
}

SearchSetting search_setting(const SceneFile& file, const Aim& target, Actuator actuator, const std::string& family,
                             const Progress& progress, std::vector<Condition> conditions, const OwnWaveforms& own) {
  for (const Condition& one : conditions)
    require_request(one.figure.conditioning != Conditioning::open, [&] {
      return fmt::format("{} \"{}\": a switch that closes has no such figure", requested("constrain"), one.text);
    });
  PreparedScene given = prepare_and_choose(file, true, progress);
  for (const Condition& one : conditions) require_asked(one, given.scene.metrics.asked);
  for (const Aim::Part& part : target.parts()) {
    if (!part.own)
      require_asked(figure_of(part.target), given.scene.metrics.asked, fmt::format("{} {}", requested("target"), part.name()));
  }
  require_open_start(given.scene, "optimize closes the switch");
  require(given.model.has_contact(), "optimize needs a [contact] section: without contact there is nothing to land on");
  require_request(!(target.is_about(Target::force) && given.model.rigid_contact() != nullptr), [] {
    return requested("target") + " force: an impact on a rigid contact has an impulse, and no force to lower";
  });
  PreparedScene baseline_scene = read_back(with_waveforms(given, plain_step(given, actuator)), "baseline.toml", given);
  Closing baseline = simulate(baseline_scene, true, progress);
  progress.throw_if_stopped();

  std::vector<Condition> beside;
  for (Condition& one : conditions) {
    const double of_step = one.figure.value(baseline.metrics);
    beside.push_back(beside_step(std::move(one), of_step));
  }

  const double period = 2 * pi / given.model.basis().angular_frequencies()[0];
  CostScale scale{.step = {},
                  .score_window = std::max(period, 3 * given.model.basis().in_contact_period()),
                  .contact_gap = given.scene.device.contact_gap(),
                  .free_touch = actuator == Actuator::pzt ? braked_touch : driven_touch,
                  .judges_hardness = !(broken(beside, baseline.metrics) > 0)};
  ClosingOptions run{.duration = given.duration, .tolerance = search_tolerance, .after_contact = scale.score_window};
  const std::vector<Signal> plain = baseline_scene.signals();
  const Hold hold = hold_of(given.model, plain);
  if (hold.closed) run.closed_potential = hold.closed->potential;
  run.steady_force = hold.steady_force(given.scene.metrics);
  Metrics step = metrics(simulate_closing(given.model, plain, run), given.scene.metrics);
  if (target.has_own_objective()) {
    step.hold_force = baseline.metrics.hold_force, step.capacitance = baseline.metrics.capacitance;
    step.resistance = baseline.metrics.resistance;
    set_drive_figures(step, given, plain);
  }
  scale.step = step.touched() && step.is_complete() ? step : imagined_step(given, period);
  const Aim aim = step.touched() && step.is_complete() ? target.in_units_of(step) : target;
  const double baseline_cost = cost(aim, step, scale, given.scene.metrics);
  // Contact must be early enough for a bounce within the simulated time; otherwise a late closing would look bounce-free.
  run.no_contact_before =
      std::min(latest_touch * scale.step.initial_contact_time, given.duration - 2 * given.model.basis().in_contact_period());
  require(run.no_contact_before > 0, [&] {
    return fmt::format("simulate.duration = {} is too short to judge a landing: it needs more than {}",
                       engineering(given.duration, "s", 3), engineering(2 * given.model.basis().in_contact_period(), "s", 3));
  });
  run.duration = std::max(run.duration, run.no_contact_before + scale.score_window);
  SearchSpace space(given, actuator, family, scale.step.initial_contact_time, own);
  std::map<std::string, DriverLimits> limits;
  for (const Drive& drive : given.drives) {
    if (drive.limits) limits.emplace(drive.name, *drive.limits);
  }
  return {.target = aim,
          .conditions = std::move(beside),
          .given = std::move(given),
          .baseline_scene = std::move(baseline_scene),
          .baseline = std::move(baseline),
          .scale = scale,
          .baseline_cost = baseline_cost,
          .run = std::move(run),
          .space = std::move(space),
          .limits = std::move(limits)};
}

std::vector<SearchSetting> search_settings(const SceneFile& file, const Aim& target, Actuator actuator,
                                           const std::string& families, const Progress& progress,
                                           std::vector<Condition> conditions, const OwnWaveforms& own) {
  const std::vector<std::string> names = families_of(families);
  std::vector<SearchSetting> all = {search_setting(file, target, actuator, names.front(), progress, std::move(conditions), own)};
  for (std::size_t k = 1; k < names.size(); ++k) {
    all.push_back(all.front());
    all.back().family = k;
    all.back().space = SearchSpace(all.front().given, actuator, names[k], all.front().scale.step.initial_contact_time, own);
  }
  return all;
}

FamilyColumns searched_columns(const std::vector<SearchSetting>& settings, const std::string& families) {
  const std::vector<std::string> names = families_of(families);
  FamilyColumns all;
  for (std::size_t k = 0; k < settings.size(); ++k) {
    std::vector<std::string>& own = all.families.emplace_back();
    for (const Variable& v : settings[k].space.variables()) own.push_back(prefix_of(families, names[k]) + v.name);
  }
  return all;
}

std::vector<SearchSetting> within_usual_room(const std::vector<SearchSetting>& settings, Actuator actuator,
                                             const std::vector<std::string>& names) {
  std::vector<SearchSetting> all = settings;
  for (std::size_t k = 0; k < all.size(); ++k) {
    SearchSetting& one = all[k];
    const std::map<std::string, PullInVoltages> pull_in = one.given.voltage_units();
    bool is_narrower = false;
    for (const DriveSearch& drive : settings[k].space.drives()) {
      const auto known = pull_in.find(drive.drive);
      if (known != pull_in.end() && narrow(one.limits.at(drive.drive), known->second)) is_narrower = true;
    }
    if (!is_narrower) return {};
    try {
      one.space = SearchSpace(one.within_limits(), actuator, names[k], one.scale.step.initial_contact_time);
    } catch (const InvalidInput&) {  // no settings: the hold level exceeds the default limit
      return {};
    }
  }
  return all;
}

}  // namespace softland
