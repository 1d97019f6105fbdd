#include "studies/search/robust_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "base/executor.h"
#include "base/require.h"
#include "config/assumed_spread.h"
#include "sampling/statistics.h"
#include "studies/search/family_search.h"
#include "studies/search/robust_cost.h"
#include "studies/search/search_budget.h"
#include "studies/search/search_setting.h"
#include "studies/search/verification.h"

namespace softland {
namespace {

constexpr std::uint64_t devices_of_choice = 512, least_of_verdict = 500;
constexpr std::size_t most_of_tournament = 3;  // largest number of candidates taken from a tournament by each of its two costs
// Latest permitted first contact, as a multiple of that under the plain step (95th percentiles). The second multiple is for
// waveforms under which half the devices or more are bounce-free.
constexpr double most_times = 5, most_times_of_landings = 7;
constexpr double margin = 0.98;      // upper limit of a chosen waveform's figures, as a share of those under the plain step
constexpr double more_open = 0.005;  // permitted excess of the share of devices that stay open over that under the plain step
constexpr std::uint64_t which_searched = 0, which_chosen = 1;
constexpr double least_of_tournament = 0.4,
                 end_of_tournament = 0.75;  // lower and upper bound of the time for all searches, as shares of a time budget
// `slow_families`: waveform families added to the search if a drive can move the switch to its contact through stable equilibria.
constexpr std::string_view quasi_static_short = "quasi-static:2", slow_families = "+quasi-static+quasi-static:2";
constexpr std::string_view usual_prefix = "usual_limit.";
constexpr double alike = 1.05;  // candidates with a cost of up to this multiple of the least count as equally good
// The quickest candidate with a cost of up to this multiple of the least is chosen, if no drive can move the switch to its
// contact through stable equilibria.
constexpr double little_more = 1.25;
// Number of devices for computing the share that can close through stable equilibria.
constexpr std::uint64_t path_devices = 512;
// Paces of the quasi-static approach: permitted time until a steady contact, as a multiple of that under the plain step. A
// third pace of 1 is searched, too.
constexpr double fast = 0.49, slow = 1.96;
constexpr double usual_closings_at_pace = 30'000;  // closings of a search at one pace; fewer if waveforms are long

bool closes(const DeviceOutcome& o) { return o.closed(); }

// True for a condition with an upper limit on a time, such as that of first contact.
bool is_about_time(const Condition& one) {
  const bool is_upper = one.comparison == Comparison::below || one.comparison == Comparison::at_most;
  return is_upper && one.figure.unit == "s" && one.limit > 0;
}

// Returns the settings of the families to search, and the names of the families joined by +. Default families that the scene's
// limits do not permit are left out.
std::pair<std::vector<SearchSetting>, std::string> settings_of_tournament(const SceneFile& file, const OptimizeOptions& options,
                                                                          const RobustSearchOptions& devices,
                                                                          const Progress& progress) {
  const bool chosen = !devices.families.empty();
  const std::string wanted =
      chosen ? devices.families : std::string(tournament_families) + std::string(devices.is_of_before ? "" : slow_families);
  const std::vector<std::string> names = families_of(wanted);
  if (chosen) return {search_settings(file, options.target, options.actuator, wanted, progress), wanted};
  std::vector<SearchSetting> settings{search_setting(file, options.target, options.actuator, names.front(), progress)};
  std::string kept = names.front();
  for (std::size_t k = 1; k < names.size(); ++k) {
    if (is_quasi_static(names[k]) && options.actuator == Actuator::pzt && !devices.hold_step_is_chosen) continue;
    try {
      SearchSpace space(settings.front().given, options.actuator, names[k], settings.front().scale.step.initial_contact_time);
      settings.push_back(settings.front());
      settings.back().family = settings.size() - 1;
      settings.back().space = std::move(space);
      kept += "+" + names[k];
    } catch (const InvalidInput&) {
      continue;
    }
  }
  return {std::move(settings), kept};
}

bool same_candidate(const ChosenFrom& a, const ChosenFrom& b) {
  return a.family == b.family && a.parameters == b.parameters && !a.parameters.empty();
}

}  // namespace

double quantile(const std::vector<DeviceOutcome>& outcomes, std::string_view key, double probability) {
  std::vector<double> values;
  for (const DeviceOutcome& o : outcomes) values.push_back(o.of(figure_of(key)));
  return sample_quantile(values, probability);
}
double quantile_95(const std::vector<DeviceOutcome>& outcomes, std::string_view key) { return quantile(outcomes, key, 0.95); }

void share_budget(OptimizeOptions& options, RobustSearchOptions& devices) {
  constexpr long share_of_nominal = 5;  // the search on the nominal device gets a fifth of the budget
  const long all = options.max_evaluations;
  options.max_evaluations = std::max(1L, all / share_of_nominal);
  devices.closings = all - options.max_evaluations;
  devices.are_a_budget = true;
}

bool has_better_yield(const DevicesRow& a, const DevicesRow& b) {
  if (std::max(a.judged.bounce_free.value, b.judged.bounce_free.value) >= half_is_bounce_free)
    return a.judged.bounce_free.value > b.judged.bounce_free.value;
  return quantile_95(a.judged.outcomes, judged_figures[0]) < quantile_95(b.judged.outcomes, judged_figures[0]);
}

double share_of(const std::vector<DeviceOutcome>& outcomes, bool (*holds)(const DeviceOutcome&)) {
  return static_cast<double>(std::ranges::count_if(outcomes, holds)) / static_cast<double>(outcomes.size());
}

RobustSearch::Bounds::Bounds(const std::vector<DeviceOutcome>& step)
    : first_touch(quantile_95(step, key_of(&Metrics::initial_contact_time))), open(1 - share_of(step, closes)) {
  for (const std::string_view key : judged_figures) figures.push_back(quantile_95(step, key));
}

bool RobustSearch::Bounds::keeps(const std::vector<DeviceOutcome>& own, double significant, bool in_time) const {
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const double value = quantile_95(own, judged_figures[i]);
    if (judged_figures[i] == key_of(&Metrics::major_bounce_height) && value <= significant) continue;
    if (value > margin * figures[i]) return false;
  }
  if (1 - share_of(own, closes) > open + more_open) return false;
  const double times = share_of(own, is_bounce_free) >= half_is_bounce_free ? most_times_of_landings : most_times;
  return !in_time || !std::isfinite(first_touch) ||
         quantile_95(own, key_of(&Metrics::initial_contact_time)) <= times * first_touch;
}

RobustSearch::RobustSearch(const SceneFile& file, const OptimizeOptions& options, const RobustSearchOptions& devices,
                           std::function<void(std::string_view what, double part)> tell)
    : options_(options),
      devices_(devices),
      progress_{.stop = options.stop, .report = std::move(tell)},
      budget_({.seconds = options.max_seconds, .stop = options.stop}) {
  SceneFile varied = file;
  spread_assumed_ = assume_spread(varied);
  auto [settings, families] = settings_of_tournament(varied, options, devices, progress_);
  const std::vector<SearchSetting> gentle = with_gentle_edges(settings, options.actuator, families);
  settings_ = begins_gently(gentle, options.starts) ? gentle : std::move(settings);
  names_ = families_of(families);
  // Count the waveform families of the tournament: they come first in names_ and settings_, before the quasi-static families,
  // which search_paces() searches.
  while (tournament_families_ < names_.size() && !is_quasi_static(names_[tournament_families_])) ++tournament_families_;
  if (tournament_families_ < names_.size()) approach_ = settings_[tournament_families_].space.quasi_static()->approach();
  if (!devices_.is_of_before) usual_room_ = within_usual_room(tournament_settings(), options_.actuator, names_);
  known_ = measured_units(first().given, std::array{first().given.scene.calibration}, options.jobs, progress_).front();
  fit_budget();
}

// Sets the number of closings of the tournament, and of fresh devices for the final evaluation. If closings are slow, both are
// reduced, but not below a tournament that is meaningful and the devices that 95th percentiles need.
void RobustSearch::fit_budget() {
  tournament_length_ = devices_.closings;
  verdict_ = devices_.verdict;
  if (!devices_.counts_work) return;
  const double usual = usual_work(shaped_drives(first().given.scene.file, options_.actuator));
  const bool in_lanes = why_not_in_lanes(first().given.model).empty();
  const double work = closing_work(first()).counted * (in_lanes ? 1 : usual_lanes);
  const auto shortest = static_cast<long>(std::ceil(least_length_of_tournament * static_cast<double>(tournament_closings)));
  tournament_length_ = std::min(devices_.closings, std::max(within_work(devices_.closings, work, usual), shortest));
  if (!devices_.verdict_is_asked) {
    const double share = static_cast<double>(tournament_length_) / static_cast<double>(devices_.closings);
    verdict_ = std::max(std::min(devices_.verdict, least_of_verdict),
                        static_cast<std::uint64_t>(share * static_cast<double>(devices_.verdict)));
  }
}

SearchEstimate RobustSearch::estimate(SearchEstimate nominal) const {
  // Work of the final evaluation per fresh device, in closings of a search.
  constexpr double rows = 20;
  const double one = device_share * (approach_ ? slow_approach : 1) * nominal.closing;
  const double searches = usual_room_.empty() || devices_.are_a_budget ? 1.5 : 2.25;
  const double closings = searches * static_cast<double>(tournament_length_) + rows * static_cast<double>(verdict_);
  nominal.closings = tournament_length_;
  nominal.has_fewer = nominal.has_fewer || tournament_length_ < devices_.closings;
  nominal.seconds = std::min(nominal.seconds + closings * one, options_.max_seconds * options_.jobs);
  return nominal;
}

FamilyColumns RobustSearch::columns() const {
  std::string families;
  for (const std::string& name : names_) families += (families.empty() ? "" : "+") + name;
  FamilyColumns all = searched_columns(settings_, families);
  // Append the parameters of the first tournament, which uses the default voltage limits; their names get a prefix.
  for (std::size_t k = 0; k < usual_room_.size(); ++k) {
    all.families.push_back(all.families[k]);
    for (std::string& name : all.families.back()) name.insert(0, usual_prefix);
  }
  for (std::vector<std::string>& own : all.families) {
    for (std::string& name : own) name.insert(0, tournament_prefix);
  }
  return all;
}

void RobustSearch::run(std::size_t before, std::function<void()> looked, double reserved) {
  for (std::size_t k = 0; k < settings_.size(); ++k) settings_[k].family = before + k;
  for (std::size_t k = 0; k < usual_room_.size(); ++k) usual_room_[k].family = before + settings_.size() + k;
  looked_ = std::move(looked);
  run_family_tournament(reserved);
  choose();
  if (!budget_.given_up() && known_->calibration().is_empty()) measure_ahead();
}

void RobustSearch::run_family_tournament(double reserved) {
  progress_.tell("building devices", 0);
  cost_.emplace(first(), tail_aim_,
                own_devices(first(), *known_, tournament_devices, options_.seed, which_searched, options_.jobs, progress_));
  others_.emplace(first(), tail_aim_,
                  own_devices(first(), *known_, devices_of_choice, options_.seed, which_chosen, options_.jobs, progress_));
  const double begun = budget_.elapsed();
  const std::vector<DeviceOutcome> step = closed(*cost_, {});
  reserve_for_verdict((budget_.elapsed() - begun) / static_cast<double>(step.size()), reserved);
  FreeTime free;
  if (!devices_.is_of_before) {
    std::vector<DeviceOutcome> all = cost_->close_by_step(options_.jobs);
    step_on_others_ = others_->close_by_step(options_.jobs);
    all.insert(all.end(), step_on_others_.begin(), step_on_others_.end());
    free = free_time(all);
    budget_.took(static_cast<long>(all.size()));
  }
  make_aims(step, free);
  bounds_.emplace(closed(*others_, {}));
  progress_.tell("searching for the devices", 0);
  search_paces();
  if (tournament_families_ > 0) run_tournaments();
  progress_.throw_if_stopped();
}

std::vector<SearchSetting> RobustSearch::tournament_settings() const {
  return {settings_.begin(), settings_.begin() + static_cast<std::ptrdiff_t>(tournament_families_)};
}

// Runs the tournament of waveform families. If the scene's voltage limits are wider than the default ones, a first tournament
// runs within the default limits, and the second one begins with its best waveform.
void RobustSearch::run_tournaments() {
  const std::vector<SearchSetting> settings = tournament_settings();
  TournamentOptions own = tournament_options();
  if (!approach_) own.on_stage = [this](const Contender& leader) { look(leader); };
  std::vector<DriveWaveforms> begun;
  if (!usual_room_.empty()) {
    TournamentOptions first = own;
    SearchBudget half(*before_verdict_, before_verdict_->left(), before_verdict_->seconds_left() / 2);
    own.closings /= 2;
    const bool has_room_for_both =
        static_cast<double>(own.closings) >= least_length_of_tournament * static_cast<double>(tournament_closings);
    if (has_room_for_both && devices_.are_a_budget) first.closings /= 2;
    tournament_in_usual_room_ = family_tournament(usual_room_, *cost_, aims_, has_room_for_both ? half : *before_verdict_, first);
    if (!tournament_in_usual_room_.contenders.empty()) begun.push_back(tournament_in_usual_room_.contenders.front().waveforms);
  }
  tournament_result_ = family_tournament(settings, *cost_, aims_, *before_verdict_, own, begun);
}

std::vector<Pace> RobustSearch::paces_of_search() const {
  // Use the waveform family with the short input shaper (two impulses), if it is searched, for a pace with a short permitted
  // time.
  const auto of = [this](double times) {
    constexpr double short_below = 0.75;
    const bool is_short = times < short_below && names_.back() == quasi_static_short;
    return Pace{.of_step = times, .family = is_short ? settings_.size() - 1 : tournament_families_};
  };
  double allowed = std::numeric_limits<double>::infinity();
  for (const Condition& one : conditions_) {
    if (is_about_time(one)) allowed = std::min(allowed, one.limit);
  }
  if (std::isfinite(allowed) && free_.until > 0) return {of(allowed / free_.until)};
  return {of(1), of(fast), of(slow)};
}

// Searches the quasi-static approach at each pace (permitted time until a steady contact), in parallel.
void RobustSearch::search_paces() {
  if (tournament_families_ == settings_.size()) return;
  share_with_path_ = softland::share_with_path(first().given, *approach_, path_devices, options_.seed, options_.jobs, progress_);
  const std::vector<Pace> paces = paces_of_search();
  RobustAim aim = tail_aim_;
  aim.free = free_;
  std::vector<std::optional<Contender>> found(paces.size());
  TournamentOptions options = tournament_options();
  const double planned = static_cast<double>(paces.size()) * usual_closings_at_pace * static_cast<double>(options.closings) /
                         static_cast<double>(tournament_closings);
  SearchBudget budget(*before_verdict_, std::lround(planned));
  options.progress = [&](double) { progress_.tell("searching a quasi-static approach", budget.share_taken()); };
  run_tasks(
      paces.size(), options_.jobs,
      [&](std::size_t i) {
        TournamentOptions own = options;
        if (i == 0) own.on_stage = [this](const Contender& leader) { look(leader); };
        found[i] = search_at_pace(settings_[paces[i].family], paces[i], *cost_, aim, budget, own);
      },
      options_.stop);
  progress_.throw_if_stopped();
  for (std::optional<Contender>& one : found) {
    if (one) paced_.push_back(*std::move(one));
  }
}

void RobustSearch::make_aims(const std::vector<DeviceOutcome>& step, const FreeTime& free) {
  conditions_ = beside_step(devices_.conditions, step);
  at_most_step_ = at_most_step(step, first().given.scene.metrics.significant_rebound);
  const double step_time = quantile_95(step, key_of(&Metrics::initial_contact_time));
  const std::span<const Figure> figures = device_figures;
  tail_aim_ = {.measure = parse_robust_measure("cvar:0.9", figures), .conditions = conditions_};
  // If a condition of the user limits a time, the search does not minimise the time until contact in addition.
  free_ = free;
  tail_aim_.free = free;
  if (std::ranges::any_of(conditions_, is_about_time)) tail_aim_.free.until = std::numeric_limits<double>::infinity();
  aims_ = {.tail = tail_aim_,
           .share = {.measure = parse_robust_measure("yield", figures), .conditions = conditions_, .free = tail_aim_.free}};
  if (!std::isfinite(step_time) || says_when_to_close()) return;
  const auto bound = [&](double times) {
    return parse_condition(fmt::format("initial_contact_time < {:.17g} s", times * step_time), figures);
  };
  aims_.tail.conditions.push_back(bound(most_times));
  aims_.share.conditions.push_back(bound(most_times_of_landings));
}

// True if a condition of the user limits the time of first contact; the search then adds no limit of its own.
bool RobustSearch::says_when_to_close() const {
  return std::ranges::any_of(
      conditions_, [](const Condition& one) { return one.figure.member == Figure::Member(&Metrics::initial_contact_time); });
}

// Limits the time of the searches so that the final evaluation, whose closings take `closing` [s] each, fits into the time
// budget. The limit is between the shares least_of_tournament and end_of_tournament of the time budget, less `reserved` [s] for
// other work.
void RobustSearch::reserve_for_verdict(double closing, double reserved) {
  // Work per fresh device, in closings of a search: long closings, calibrated closings, closings for the Pareto front.
  constexpr double rows = 20;
  const double verdict = rows * static_cast<double>(verdict_) * closing, all = options_.max_seconds;
  const double end = std::clamp(all - verdict, least_of_tournament * all, end_of_tournament * all) - reserved;
  before_verdict_.emplace(budget_, budget_.left(), end - budget_.elapsed());
}

TournamentOptions RobustSearch::tournament_options() {
  return {.closings = tournament_length_,
          .are_a_budget = devices_.are_a_budget,
          .seed = options_.seed,
          .jobs = options_.jobs,
          .memory = options_.memory,
          .progress = [this](double part) { progress_.tell("searching for the devices", part); }};
}

std::vector<DeviceOutcome> RobustSearch::closed(const RobustCost& cost, const DriveWaveforms& waveforms) {
  budget_.took(static_cast<long>(cost.devices()));
  return cost.close(first().drives(waveforms), 0, cost.devices(), options_.jobs);
}

DriveWaveforms RobustSearch::all_drives(DriveWaveforms searched) const {
  searched.merge(first().baseline_scene.drives.waveforms());
  return searched;
}

ChosenFrom RobustSearch::candidate_of(const Contender& contender) const {
  ChosenFrom c{.measure = contender.measure,
               .family = names_[contender.family],
               .waveforms = contender.waveforms,
               .parameters = {},
               .variables = settings_[contender.family].space.variables(),
               .closings = contender.closings};
  for (std::size_t i = 0; i < contender.x.size(); ++i) c.parameters[c.variables[i].name] = contender.x[i];
  return c;
}

// Adds the best candidates of a tournament by each of its two costs to `pool`, from which the best waveform is chosen later.
void RobustSearch::take(std::vector<ChosenFrom>& pool, TournamentResult& found, bool is_in_usual_room) const {
  for (const bool by_share : {false, true}) {
    std::ranges::stable_sort(found.contenders, {}, [&](const Contender& r) { return by_share ? r.share : r.tail; });
    for (std::size_t i = 0; i < std::min(most_of_tournament, found.contenders.size()); ++i) {
      ChosenFrom one = candidate_of(found.contenders[i]);
      one.is_in_usual_room = is_in_usual_room;
      if (std::ranges::none_of(pool, [&](const ChosenFrom& other) { return same_candidate(one, other); }))
        pool.push_back(std::move(one));
    }
  }
}

// Evaluates the best candidate waveforms of all tournaments and paces on `others_`, devices that the searches have not used.
void RobustSearch::choose() {
  progress_.tell("choosing on other devices", 0);
  std::vector<ChosenFrom> pool;
  for (const Contender& one : paced_) pool.push_back(candidate_of(one));
  take(pool, tournament_in_usual_room_, true);
  take(pool, tournament_result_, false);
  for (ChosenFrom& one : pool) place(std::move(one));
}

// Evaluates the best candidate waveform of a running search on `others_`, devices that the search has not used. Reports the
// candidate if it is the best so far and no worse than the plain step.
void RobustSearch::look(const Contender& contender) {
  if (budget_.given_up() || devices_.is_of_before || progress_.stopped()) return;
  std::vector<DeviceOutcome> outcomes = on_others(contender.waveforms);
  Placed placed = judged(candidate_of(contender), outcomes);
  looked_at_.push_back(placed);
  if (!leader_ || placed.is_before(*leader_)) {
    leader_ = std::move(placed);
    if (leader() != nullptr && devices_.on_leading) {
      devices_.on_leading({.family = leader_->candidate.family,
                           .of_step = step_on_others_,
                           .own = std::move(outcomes),
                           .waited_for = free_.figure,
                           .scene = with_waveforms(first().baseline_scene, contender.waveforms)});
    }
  }
  if (looked_) std::exchange(looked_, {})();
}

const ChosenFrom* RobustSearch::leader() const {
  return leader_ && leader_->candidate.is_good_enough ? &leader_->candidate : nullptr;
}

void RobustSearch::place(ChosenFrom one) {
  progress_.throw_if_stopped();
  const auto known = std::ranges::find_if(looked_at_, [&](const Placed& other) { return same_candidate(one, other.candidate); });
  if (known == looked_at_.end()) {
    placed_.push_back(judged(one, on_others(one.waveforms)));
    return;
  }
  Placed again = *known;
  again.candidate.measure = one.measure;
  again.candidate.is_in_usual_room = one.is_in_usual_room;
  again.candidate.closings = one.closings;
  placed_.push_back(std::move(again));
}

std::vector<DeviceOutcome> RobustSearch::on_others(const DriveWaveforms& waveforms) {
  budget_.took(static_cast<long>(others_->devices()));
  return others_->close_until(first().drives(waveforms), free_.until, options_.jobs);
}

// Computes the figures and the rank of a candidate waveform from its outcomes on `others_`, devices that the searches have not
// used.
RobustSearch::Placed RobustSearch::judged(ChosenFrom one, const std::vector<DeviceOutcome>& outcomes) const {
  RobustAim aim = aims_.tail;
  if (approach_) aim.conditions = conditions_;  // no limit on the time of first contact, which is late in a slow approach
  one.bounce_free = share_of(outcomes, is_bounce_free);
  one.tail = others_->value(outcomes, aim);
  one.measured = others_->measured(outcomes, aim);
  one.first_touch = quantile_95(outcomes, key_of(&Metrics::initial_contact_time));
  one.impact_speed = quantile_95(outcomes, key_of(&Metrics::largest_impact_velocity));
  one.median_touch = quantile(outcomes, key_of(&Metrics::initial_contact_time), 0.5);
  one.waited = waited(outcomes, free_.figure);
  const bool lands = one.bounce_free >= half_is_bounce_free && !approach_;
  const double rank = lands ? -one.bounce_free : one.tail, significant = first().given.scene.metrics.significant_rebound;
  const bool in_time = !approach_ && !says_when_to_close();
  one.is_good_enough = bounds_->keeps(outcomes, significant, in_time) && hold(conditions_, outcomes);
  return {std::move(one), lands, rank};
}

bool RobustSearch::Placed::is_before(const Placed& other) const {
  if (candidate.is_good_enough != other.candidate.is_good_enough) return candidate.is_good_enough;
  if (half_is_bounce_free != other.half_is_bounce_free) return half_is_bounce_free;
  return rank < other.rank;
}

// Moves the candidate with the earliest first contact to the front, among candidates that cost at most little_more times the
// least. If a tournament ran within the default voltage limits, the chosen candidate may cost at most as much as the one that
// the same rule chooses from that tournament.
void RobustSearch::prefer_sooner(std::vector<Placed>& sorted) {
  const auto soonest = [&](double most, bool in_usual_room) {
    double least = std::numeric_limits<double>::infinity();
    auto found = sorted.end();
    for (auto one = sorted.begin(); one != sorted.end(); ++one) {
      const ChosenFrom& c = one->candidate;
      if (!c.is_good_enough || (in_usual_room && !c.is_in_usual_room)) continue;
      least = std::min(least, one->rank);
      if (!(one->rank <= std::min(most, little_more * least))) continue;
      if (found == sorted.end() || c.median_touch < found->candidate.median_touch) found = one;
    }
    return found;
  };
  const auto usual = soonest(std::numeric_limits<double>::infinity(), true);
  const double most = usual == sorted.end() ? std::numeric_limits<double>::infinity() : usual->rank;
  const auto first = soonest(most, false);
  std::rotate(sorted.begin(), first, first + 1);
}

std::vector<ChosenFrom> RobustSearch::placed() const {
  std::vector<Placed> sorted = placed_;
  std::ranges::stable_sort(sorted, [](const Placed& a, const Placed& b) { return a.is_before(b); });
  // Prefer an earlier contact: without stable equilibria up to the contact, the switch accelerates from the pull-in point on,
  // so that slower waveforms are hardly softer.
  if (!approach_ && free_.until > 0 && !sorted.empty() && sorted.front().candidate.is_good_enough &&
      !sorted.front().half_is_bounce_free)
    prefer_sooner(sorted);
  // The cost of slow approaches is mostly due to the few devices without stable equilibria up to the contact. Prefer the lowest
  // 95th percentile of impact velocity among similar costs.
  if (approach_ && !sorted.empty() && sorted.front().candidate.is_good_enough) {
    auto softest = sorted.begin();
    for (auto one = sorted.begin(); one != sorted.end(); ++one) {
      const bool is_alike = one->candidate.is_good_enough && one->rank <= alike * sorted.front().rank;
      if (is_alike && one->candidate.impact_speed < softest->candidate.impact_speed) softest = one;
    }
    std::rotate(sorted.begin(), softest, softest + 1);
  }
  std::vector<ChosenFrom> all;
  for (Placed& one : sorted) all.push_back(std::move(one.candidate));
  return all;
}

}  // namespace softland
