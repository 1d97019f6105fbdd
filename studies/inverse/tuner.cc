#include "studies/inverse/tuner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/engineering.h"
#include "base/require.h"
#include "sampling/statistics.h"
#include "studies/inverse/proposal.h"

namespace softland {

void check(const TunerOptions& options) {
  constexpr std::string_view first_touch_key = key_of(&Metrics::initial_contact_time);
  const auto share = [](double x) { return x >= 0 && x < 1; };
  require(options.laboratory.edge_error > 0 && std::isfinite(options.laboratory.edge_error),
          "the error of edges must be above 0 s");
  require(options.laboratory.unseen >= 0 && std::isfinite(options.laboratory.unseen),
          "the shortest opening that is seen must be at least 0 s");
  require(options.laboratory.trigger_delay >= 0 && std::isfinite(options.laboratory.trigger_delay),
          "the trigger delay must be at least 0 s");
  require(share(options.laboratory.gain_error), "the error of the gain must be at least 0 and below 1");
  require(share(options.laboratory.shot_error), "the error from shot to shot must be at least 0 and below 1");
  require(options.jobs >= 1, "jobs must be at least 1");
  require(options.most_recipes >= 1 && options.most_recipes <= 5, "recipes must be 1 to 5");
  require(
      !options.touch || ((options.touch->comparison == Comparison::below || options.touch->comparison == Comparison::at_most) &&
                         options.touch->limit > 0 && options.touch->figure.key == first_touch_key),
      "a condition must limit initial_contact_time from above");
  require(options.effort > 0 && std::isfinite(options.effort), "the effort must be above 0");
}

namespace {

constexpr std::size_t proposal_devices = 32;
constexpr double enough_devices = 8;  // effective number of devices from which on a belief can predict a closing
// Number of standard errors from which on the ratio of contact to electrode gap differs from the scene's.
constexpr double certain = 3.5;
// The belief (estimate of the device) is computed from this many first and last contact records; those between are left out.
constexpr std::size_t first_ones = 4, last_ones = 8;

std::optional<BelievedQuantity> believed_gap_ratio(const TuningModel& scene, const Belief& belief) {
  std::vector<Eigen::VectorXd> ratios;
  for (const Eigen::VectorXd& z : belief.points) {
    const std::optional<double> ratio = scene.gap_ratio(scene.values(z));
    if (!ratio) return {};
    ratios.push_back(Eigen::VectorXd::Constant(1, *ratio));
  }
  const NormalBelief of_ratio = moments_of(belief.weights, ratios);
  return BelievedQuantity{.name = scene.gap_ratio_name(),
                          .unit = {},
                          .prior_mean = 1,
                          .prior_deviation = TuningModel::gap_ratio_deviation,
                          .mean = of_ratio.mean[0],
                          .deviation = of_ratio.deviation(0)};
}

// Returns the index of the first random number for the proposal after `closings` closings: each proposal has 2^20 numbers.
std::uint64_t first_draw(int closings) { return (static_cast<std::uint64_t>(closings) + 1) << 20; }

}  // namespace

// The members of a tuner that do not change with the closings.
struct Tuner::Setting {
  Setting(const SceneFile& file, const TunerOptions& options, const Progress& progress)
      : scene(file, options, progress), recipes(recipes_of(scene, progress)), space(scene) {
    if (!options.wafer.empty()) scene.begin_with(believed_of_wafer(options.wafer, scene.size()).next);
  }

  TuningModel scene;
  std::vector<CandidateWaveform> recipes;
  TuningSpace space;
};

struct Tuner::State {
  struct Fired {
    LearnedShot shot;
    std::vector<double> x;  // parameters of the shot's waveform: the variables of TuningSpace
    TunerShot as_proposed;
    int waveform = 0;  // number of the first shot that had the waveform x
  };
  // A controller that corrects the voltages of a repeated shot (closing) by its first contact time.
  struct TouchController {
    std::vector<Waveform> waveforms;  // waveforms of the repeated shot for the voltage factor s = 1
    int waveform = 0;                 // number of the first shot that had the repeated waveform
    double slope = Metrics::unset, most = 1, s = 1;
    std::vector<double> touches;  // first contact times of the repeated shot, whose mean is the reference [s]
    [[nodiscard]] std::vector<Waveform> controlled_waveforms() const {
      std::vector<Waveform> own = waveforms;
      for (Waveform& waveform : own) waveform = scaled(std::move(waveform), s, 1);
      return own;
    }
    void follow(double touch) {
      constexpr std::size_t of_reference = 8;
      constexpr double share = 0.2, longest = 1e-3;
      if (touches.size() < of_reference) touches.push_back(touch);
      const double due = sample_mean(touches), error = std::clamp((touch - due) / slope, -longest, longest);
      if (std::isfinite(error)) s = std::min(most, s * (1 - share * error));
    }
  };
  struct Knowledge {
    std::vector<Fired> fired;
    int closings = 0, in_a_row = 0;
    std::size_t forgotten = 0;  // number of contact records, from the first on, that the tuning no longer uses
    double hold = 1;            // factor on the nominal hold level of the waveform
    Belief belief;
    std::optional<TouchController> controller;
    std::vector<double> x;  // waveform variables of the next shot
    TunerShot next, kept;
    int next_waveform = 0;          // number of the first shot with the waveform of the next shot; 0 for a new waveform
    std::vector<double> surprises;  // errors of predicted first contact times by closing, in standard deviations
    int unexpected_bounces = 0;     // number of closings that bounced although hardly any device of the belief did
    int unexplained_bounces = 0;    // number of used records with a long bounce that the belief's best device does not show
    // Last ratio of contact to electrode gap estimated from enough devices; none if the scene's ratio explains the records.
    std::optional<BelievedQuantity> gap_ratio = {};
    TouchMisfit misfit = {};  // misfit of the contact records that were used last
  };

  State(std::shared_ptr<const Setting> of_scene, const Progress& progress)
      : setting(std::move(of_scene)), scene(setting->scene), space(setting->space), recipes(setting->recipes) {
    Draws draws(scene.options().seed, first_draw(0));
    now.belief = Belief::prior(scene.size(), draws);
    const OutcomeForecast forecast(scene, now.belief.resampled(proposal_devices, draws), draws, progress);
    const TuningModel::Units units = scene.units(now.belief.moments.mean);
    if (scene.prior()) now.hold = believed_hold(units);
    const TuningSpace limited = space_for(now);
    now.x = limited.in_units(recipes.front().x, {}, {});
    if (scene.prior()) now.x = propose(scene, limited, forecast, recipes_in(units), scene.options().seed, progress).x;
    now.next = shot(1, limited.waveforms(now.x), forecast);
    now.kept = now.next;
  }

  [[nodiscard]] static double believed_hold(const TuningModel::Units& units) {
    constexpr double lowest = 0.85, highest = 1.2;
    return std::clamp(units.volts, lowest, highest);
  }
  [[nodiscard]] std::vector<std::vector<double>> recipes_in(const TuningModel::Units& units) const {
    std::vector<std::vector<double>> all;
    for (const CandidateWaveform& recipe : recipes) all.push_back(space.in_units(recipe.x, units_of(recipe), units));
    return all;
  }
  [[nodiscard]] TuningSpace space_for(const Knowledge& known) const {
    return space.within(scene.safe_level(known.belief.moments), known.hold);
  }
  [[nodiscard]] TunerShot shot(int number, std::vector<Waveform> waveforms, const OutcomeForecast& forecast) const {
    TunerShot shot{.number = number, .waveforms = std::move(waveforms), .hold_time = scene.hold_time()};
    shot.expected_cost = forecast.expected(shot.waveforms, forecast.size()).total();
    shot.predicted = forecast.predicted(shot.waveforms);
    return shot;
  }
  [[nodiscard]] Knowledge updated(Knowledge known, const ContactRecord& record, const Progress& progress) const;
  void propose_next(Knowledge& known, const Progress& progress) const;
  void keep_best(Knowledge& known, const OutcomeForecast& forecast, double expected) const;
  void repeat(Knowledge& known, const OutcomeForecast& forecast) const;
  void fire_kept_again();

  std::shared_ptr<const Setting> setting;
  const TuningModel& scene;
  const TuningSpace& space;
  const std::vector<CandidateWaveform>& recipes;
  Knowledge now;
};

namespace {

// Returns the difference between recorded and predicted time of first contact, in standard deviations; 0 without a prediction.
double surprise(const PredictedRecord& predicted, const ContactRecord& record, double effective_devices) {
  constexpr double both_sides = 1.96;
  const std::optional<double> seen = first_touch(record);
  if (!seen || predicted.touches == 0 || effective_devices < enough_devices) return 0;
  const double edge = *seen < predicted.touch_median ? predicted.touch_low : predicted.touch_high;
  return both_sides * (*seen - predicted.touch_median) / (edge - predicted.touch_median);
}

// True if the contact opened for so long that an error of the model cannot be the reason: a mode that the model lacks causes
// only short openings, with a height of a nanometre.
bool has_long_bounce(const TuningModel& scene, const ContactRecord& record) {
  constexpr double share = 0.04;  // least duration of a long opening, as a share of the closing time of the plain step
  if (record.edges.empty()) return bounce_count(record).value_or(0) > 0;
  const double least = scene.options().laboratory.unseen + share * scene.scales().closing_time;
  return std::ranges::any_of(openings(record), [&](const ContactOpening& one) { return one.end - one.begin >= least; });
}

// Returns the number of contact records with a long bounce that the simulated best device of the belief does not show.
int unexplained_bounces(const TuningModel& scene, std::span<const LearnedShot> shots, const Belief& belief,
                        const Progress& progress) {
  const std::vector<Eigen::VectorXd> best{belief.mode};
  const std::vector<Particle> device = scene.devices(best, progress);
  std::vector<PredictedShot> fired;
  for (const LearnedShot& shot : shots) fired.push_back({.device = device.data(), .waveforms = &shot.waveforms});
  const std::vector<PredictedClosing> closings = scene.close(fired, progress);
  int count = 0;
  for (std::size_t i = 0; i < shots.size(); ++i) {
    const bool bounces = std::ranges::any_of(closings[i].seen().openings, [&](const ContactOpening& one) {
      return one.end - one.begin >= scene.options().laboratory.unseen;
    });
    count += has_long_bounce(scene, shots[i].record) && !bounces;
  }
  return count;
}

// True if the ratio of contact to electrode gap differs from the scene's by several standard errors, and by at least one
// standard deviation of the prior.
bool is_off(const std::optional<BelievedQuantity>& ratio) {
  return ratio && std::abs(ratio->mean - 1) >= std::max(certain * ratio->deviation, ratio->prior_deviation);
}

}  // namespace

Tuner::State::Knowledge Tuner::State::updated(Knowledge known, const ContactRecord& record, const Progress& progress) const {
  const PredictedRecord predicted = known.next.predicted;
  if (known.controller) known.next_waveform = known.controller->waveform;
  known.fired.push_back({.shot = {.waveforms = known.next.waveforms, .record = record},
                         .x = known.x,
                         .as_proposed = known.next,
                         .waveform = known.next_waveform > 0 ? known.next_waveform : known.next.number});
  known.next_waveform = 0;
  ++known.closings;
  const bool quiet = is_bounce_free(record), bounced_long = has_long_bounce(scene, record);
  const bool repeats = known.controller && first_touch(record) && !bounced_long;
  known.in_a_row = quiet ? known.in_a_row + 1 : 0;
  if (!repeats) known.surprises.push_back(surprise(predicted, record, known.belief.effective_devices));
  constexpr double rarely = 0.05;
  if (bounced_long && predicted.bounces <= rarely) ++known.unexpected_bounces;
  if (repeats) {
    if (quiet) known.kept = known.fired.back().as_proposed;
    known.controller->follow(*first_touch(record));
    known.next.waveforms = known.controller->controlled_waveforms();
    known.next.number += 1;
    return known;
  }
  // A repeated shot that bounces or stays open shows a drift of the device: drop the contact records from before the drift.
  if (known.controller) known.forgotten = known.fired.size() - std::min(known.fired.size(), last_ones);
  known.controller.reset();
  propose_next(known, progress);
  return known;
}

void Tuner::State::propose_next(Knowledge& known, const Progress& progress) const {
  constexpr double calm = 0.05;
  constexpr int hold_is_fixed = 2;  // number of closings after which the hold level of the waveform is fixed
  Draws draws(scene.options().seed, first_draw(known.closings));
  std::vector<LearnedShot> shots;
  for (std::size_t k = known.forgotten; k < known.fired.size(); ++k) {
    if (k < known.forgotten + first_ones || k + last_ones >= known.fired.size()) shots.push_back(known.fired[k].shot);
  }
  known.belief = softland::updated_belief(scene, shots, known.belief, draws, progress);
  Draws of_misfit(scene.options().seed, first_draw(known.closings) + (std::uint64_t{1} << 19));
  known.misfit = touch_misfit(scene, shots, known.belief, of_misfit, progress);
  known.unexplained_bounces = unexplained_bounces(scene, shots, known.belief, progress);
  if (known.belief.effective_devices >= enough_devices) {
    known.gap_ratio = believed_gap_ratio(scene, known.belief);
    if (is_off(known.gap_ratio) &&
        gap_ratio_misfit(scene, shots, known.belief, certain * certain, of_misfit, progress) < certain * certain)
      known.gap_ratio.reset();
  }
  const TuningModel::Units units = scene.units(known.belief.moments.mean);
  if (known.closings <= hold_is_fixed) known.hold = believed_hold(units);
  const OutcomeForecast forecast(scene, known.belief.resampled(proposal_devices, draws), draws, progress);
  const TuningSpace limited = space_for(known);
  std::vector<std::vector<double>> candidates{known.x};
  std::ranges::move(recipes_in(units), std::back_inserter(candidates));
  for (const Fired& fired : known.fired) {
    if (std::ranges::find(candidates, fired.x) == candidates.end()) candidates.push_back(fired.x);
  }
  const Proposal proposal =
      propose(scene, limited, forecast, candidates, scene.options().seed + static_cast<std::uint64_t>(known.closings), progress);
  known.x = proposal.x;
  known.next = shot(known.next.number + 1, limited.waveforms(known.x), forecast);
  keep_best(known, forecast, proposal.cost.total());
  if (known.in_a_row >= 2 && proposal.cost.landing < calm) repeat(known, forecast);
}

// Updates the best shot so far: the shot of least expected cost among those whose waveform did not bounce when last applied.
// The next shot becomes the best one if its expected cost is lower by at least `clearly`.
void Tuner::State::keep_best(Knowledge& known, const OutcomeForecast& forecast, double expected) const {
  constexpr double clearly = 0.15;
  known.kept = known.next;
  double least = expected + clearly;
  for (auto one = known.fired.begin(); one != known.fired.end(); ++one) {
    const Fired& fired = *one;
    const bool is_last =
        std::none_of(one + 1, known.fired.end(), [&](const Fired& later) { return later.waveform == fired.waveform; });
    if (!is_last || !is_bounce_free(fired.shot.record)) continue;
    const double cost = forecast.expected(fired.shot.waveforms, forecast.size()).total();
    if (!(cost < least)) continue;
    least = cost;
    known.kept = fired.as_proposed;
    known.kept.expected_cost = cost;
    known.kept.predicted = forecast.predicted(fired.shot.waveforms);
  }
}

void Tuner::State::repeat(Knowledge& known, const OutcomeForecast& forecast) const {
  const auto fired = std::ranges::find(known.fired, known.kept.number, [](const Fired& one) { return one.as_proposed.number; });
  if (fired == known.fired.end()) return;
  known.controller = TouchController{.waveforms = fired->shot.waveforms,
                                     .waveform = fired->waveform,
                                     .slope = forecast.touch_slope(fired->shot.waveforms),
                                     .most = std::max(1.0, space_for(known).largest_factor(fired->shot.waveforms))};
  known.x = fired->x;
  const int number = known.next.number;
  known.next = known.kept;
  known.next.number = number;
}

void Tuner::State::fire_kept_again() {
  const auto fired = std::ranges::find(now.fired, now.kept.number, [](const Fired& one) { return one.as_proposed.number; });
  if (fired == now.fired.end() || now.controller) return;  // the shot `kept` was not applied yet, or is being repeated anyway
  now.x = fired->x;
  now.next_waveform = fired->waveform;
  const int number = now.next.number;
  now.next = now.kept;
  now.next.number = number;
}

Tuner::Tuner(const SceneFile& file, const TunerOptions& options, const Progress& progress) {
  check(options);
  state_ = std::make_unique<State>(std::make_shared<const Setting>(file, options, progress), progress);
}
Tuner::Tuner(std::shared_ptr<const Setting> setting, const Progress& progress)
    : state_(std::make_unique<State>(std::move(setting), progress)) {}
Tuner::~Tuner() = default;
Tuner::Tuner(Tuner&&) noexcept = default;
Tuner& Tuner::operator=(Tuner&&) noexcept = default;

Tuner Tuner::restarted() const { return Tuner(state_->setting, {}); }

const PreparedScene& Tuner::scene() const { return state_->scene.nominal(); }
const std::vector<CandidateWaveform>& Tuner::recipes() const { return state_->recipes; }
Approach Tuner::approach() const { return state_->scene.approach(); }
double Tuner::step_closing_time() const { return state_->scene.scales().closing_time; }
double Tuner::step_permanent_contact() const { return state_->scene.scales().permanent_contact; }
bool Tuner::spread_is_assumed() const { return state_->scene.spread_is_assumed(); }
const TunerShot& Tuner::next() const { return state_->now.next; }
int Tuner::closings() const { return state_->now.closings; }
const TunerShot& Tuner::kept() const { return state_->now.kept; }
void Tuner::fire_kept_again() { state_->fire_kept_again(); }
bool Tuner::was_kept_last() const {
  return !state_->now.fired.empty() && state_->now.fired.back().as_proposed.number == state_->now.kept.number;
}
const std::vector<double>& Tuner::surprises() const { return state_->now.surprises; }
int Tuner::unexpected_bounces() const { return state_->now.unexpected_bounces; }
int Tuner::bounce_free_in_a_row() const { return state_->now.in_a_row; }

void Tuner::learn(const ContactRecord& record, const Progress& progress) {
  const std::string fault = record_fault(record);
  require(fault.empty(), fault);
  if (!record.error.empty()) {
    ++state_->now.next.number;
    return;
  }
  state_->now = state_->updated(state_->now, record, progress);
}

BeliefSummary Tuner::belief() const {
  const TuningModel& scene = state_->scene;
  const Belief& belief = state_->now.belief;
  const std::vector<SpreadVariable>& variables = scene.nominal().scene.spread.variables;
  std::vector<Eigen::VectorXd> values;  // values of each device of the belief: the varied quantities, then the trigger delay
  for (const Eigen::VectorXd& z : belief.points) {
    std::vector<double> own = scene.values(z);
    own.push_back(scene.delay(z));
    values.emplace_back(Eigen::Map<const Eigen::VectorXd>(own.data(), scene.size()));
  }
  const NormalBelief of_values = moments_of(belief.weights, values);
  BeliefSummary summary{.quantities = {}, .effective_devices = belief.effective_devices, .correlated = {}};
  for (std::size_t i = 0; i <= variables.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const bool is_delay = i == variables.size();
    BelievedQuantity one{.name = is_delay ? trigger_delay_name : variables[i].name,
                         .unit = is_delay ? "s" : (variables[i].is_factor ? std::string() : variables[i].keys.front().unit),
                         .prior_mean = is_delay ? 0 : variables[i].distribution.mean(),
                         .prior_deviation = is_delay ? scene.delay_deviation() : variables[i].distribution.standard_deviation(),
                         .mean = of_values.mean[k],
                         .deviation = of_values.deviation(k)};
    summary.quantities.push_back(std::move(one));
  }
  summary.touch_misfit = state_->now.misfit;
  summary.gap_ratio = believed_gap_ratio(scene, belief);
  summary.coordinates = {.prior = scene.in_spread(NormalBelief::standard(scene.size())),
                         .posterior = scene.in_spread(belief.moments)};
  constexpr double alike = 0.9;
  for (std::size_t i = 0; i < summary.quantities.size() && state_->now.closings > 0; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const BelievedQuantity &a = summary.quantities[j], &b = summary.quantities[i];
      const double covariance = of_values.covariance(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i));
      const double correlation = covariance / (a.deviation * b.deviation);
      if (!(std::abs(correlation) > alike)) continue;
      summary.correlated.push_back(
          fmt::format("The records do not separate {} from {} (correlation {:.2f}).", a.name, b.name, correlation));
    }
  }
  return summary;
}

namespace {

// Describes a ratio of contact to electrode gap that differs from the scene's: "The device does not match the model: its
// contact gap is 4.8 % wider ...". All devices of [spread] have the scene's ratio.
std::string gap_ratio_prose(const BelievedQuantity& ratio) {
  constexpr double percent = 100;
  const double change = percent * (ratio.mean - 1);
  return fmt::format(
      "The device does not match the model: relative to the electrode gap its contact gap is {:.1f} % {}, with a standard "
      "error of {:.1f} %. In the model this ratio is the same for all devices.",
      std::abs(change), change > 0 ? "wider" : "narrower", percent * ratio.deviation);
}

}  // namespace

std::optional<std::string> Tuner::broken_assumption() const {
  constexpr int too_many = 3;
  const State::Knowledge& now = state_->now;
  if (now.misfit.is_beyond())
    return fmt::format(
        "The device does not match the model: no device of the spread touches as recorded. The sum of squared residuals of the "
        "best one is {}, and only one device in a thousand exceeds {}.",
        engineering(now.misfit.least, "", 3), engineering(now.misfit.bound, "", 3));
  if (std::min(now.unexpected_bounces, now.unexplained_bounces) >= too_many)
    return fmt::format("The device does not match the model: it bounced in {} closings that were predicted to be bounce-free.",
                       now.unexpected_bounces);
  return is_off(now.gap_ratio) ? std::optional(gap_ratio_prose(*now.gap_ratio)) : std::nullopt;
}

}  // namespace softland
