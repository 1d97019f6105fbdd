#include "studies/search/race.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "base/executor.h"
#include "base/random.h"
#include "optimizers/sobol.h"
#include "studies/devices/robustness.h"
#include "studies/search/device_chain.h"

namespace softland {
namespace {

using Point = std::vector<double>;
constexpr double without_limit = std::numeric_limits<double>::infinity();

struct Rung {
  std::size_t devices;
  long closings;  // closings of each search, for a race of the default length
  double step;    // first step, as a part of the box
};
constexpr std::array rungs{Rung{32, 2000, 0.15}, Rung{64, 6000, 0.08}, Rung{128, 10'000, 0.03}};
constexpr Rung last_again{128, 8000, 0.03};
constexpr std::size_t most_again = 2;
constexpr std::size_t finalists = 3;
constexpr double enough_land = 0.25, many_land = 0.4;  // bounce-free shares that rank, and go on, by the share
constexpr double worth_going_on = 0.01;                // least gain in the bounce-free share
constexpr double population_by_share = 2, longer_where_many_land = 1.7;
constexpr std::size_t scouting_devices = 16;
constexpr std::uint64_t box_points = 32;

// One search of the race in progress.
struct Runner {
  std::size_t family = 0;
  bool by_share = false;
  Point x;
  long closings = 0;
  std::vector<DeviceOutcome> outcomes = {};  // outcomes on the devices of its judging
  double bounce_free = 0, tail = without_limit, share = without_limit;
};

class Race {
 public:
  Race(const std::vector<SearchSetting>& settings, std::size_t first_family, const RobustCost& cost, const RaceAims& aims,
       const RaceOptions& options)
      : settings_(settings), first_family_(first_family), cost_(cost), aims_(aims), options_(options) {}

  RaceResult run(std::vector<Runner> runners, const std::vector<DriveWaveforms>& begun, bool all_rungs) {
    const double length = static_cast<double>(options_.closings) / static_cast<double>(race_closings);
    RaceResult result;
    if (length < least_length_of_race) return result;
    long planned = 0;
    for (const Rung& rung : rungs) planned += rung.closings;
    alone_ = all_rungs;
    const double longer = alone_ || options_.are_a_budget ? length : longer_where_many_land * length;
    planned_ = all_rungs ? length * static_cast<double>(planned) : static_cast<double>(options_.closings);
    planned_ += static_cast<double>(scouting_of(runners, begun));
    begin(runners, begun);
    std::erase_if(runners, [](const Runner& r) { return r.x.empty(); });
    bool many = false;
    for (std::size_t k = 0; k < rungs.size() && !runners.empty() && !over(); ++k) {
      search(runners, rungs[k], many ? longer : length, k);
      many = judge(runners, rungs[std::min(k + 1, rungs.size() - 1)].devices, k == 0 ? enough_land : many_land);
      if (k > 0) add(result, runners);
      if (k == 0 && many) {
        planned_ = static_cast<double>(closings_) + longer / length * (planned_ - static_cast<double>(closings_));
        if (!all_rungs) planned_ += static_cast<double>(most_again * last_again.closings) * longer;
      }
      if (all_rungs) continue;
      runners = k == 0 ? survivors(std::move(runners), many) : best(std::move(runners), many);
      if (options_.on_stage && k + 1 < rungs.size() && !over()) options_.on_stage(racer(leading(runners, many)));
      if (many) continue;
      for (Runner& r : runners) r.by_share = false;
    }
    if (runners.empty() || all_rungs) return finished(std::move(result));
    runners.resize(1);
    for (std::size_t again = 0; many && again < most_again && !over(); ++again) {
      const double before = runners[0].bounce_free;
      search(runners, last_again, longer, rungs.size() + again);
      judge(runners, last_again.devices, many_land);
      add(result, runners);
      if (!(runners[0].bounce_free > before + worth_going_on)) break;
    }
    return finished(std::move(result));
  }

 private:
  [[nodiscard]] bool over() const {
    return (options_.stop != nullptr && *options_.stop) || (options_.out_of_time && options_.out_of_time());
  }
  [[nodiscard]] const SearchSetting& setting(const Runner& r) const { return settings_[r.family]; }
  [[nodiscard]] const RobustAim& aim(const Runner& r) const { return r.by_share ? aims_.share : aims_.tail; }
  [[nodiscard]] std::uint64_t seed_of(std::size_t rung, const Runner& r) const {
    return random_bits(options_.seed, Stream::race, 1000 * rung + 2 * r.family + (r.by_share ? 1 : 0));
  }
  // Identifies the devices and the aim in the memory.
  [[nodiscard]] std::uint64_t identity(const Runner& r) const {
    return random_bits(options_.seed, Stream::race, r.by_share ? 1 : 0);
  }

  void took(long closings) {
    const long all = closings_ += closings;
    if (options_.progress) options_.progress(std::min(1.0, static_cast<double>(all) / planned_));
  }

  // Returns the closings that the starts take.
  [[nodiscard]] std::size_t scouting_of(const std::vector<Runner>& runners, const std::vector<DriveWaveforms>& begun) const {
    std::set<std::size_t> families;
    for (const Runner& r : runners) families.insert(r.family);
    std::size_t starts = 0;
    for (const std::size_t family : families) starts += starts_of(family, begun).size();
    return scouting_devices * starts;
  }

  // Begins every search at the best of many starts, by its measure.
  void begin(std::vector<Runner>& runners, const std::vector<DriveWaveforms>& begun) {
    std::set<std::size_t> families;
    for (const Runner& r : runners) families.insert(r.family);
    for (const std::size_t family : families) {
      const std::vector<Point> starts = starts_of(family, begun);
      std::vector<std::vector<DeviceOutcome>> outcomes(starts.size());
      run_tasks(
          starts.size(), options_.jobs, [&](std::size_t i) { outcomes[i] = closed(family, starts[i], scouting_devices, 1); },
          options_.stop);
      for (Runner& r : runners) {
        if (r.family != family) continue;
        double least = without_limit;
        for (std::size_t i = 0; i < starts.size(); ++i) {
          if (outcomes[i].empty()) continue;
          const double value = cost_.value(outcomes[i], aim(r));
          if (value < least) least = value, r.x = starts[i];
        }
      }
    }
  }

  [[nodiscard]] std::vector<Point> starts_of(std::size_t family, const std::vector<DriveWaveforms>& begun) const {
    const SearchSpace& space = settings_[family].space;
    const std::vector<Variable> variables = space.variables();
    std::vector<Point> all = space.starts();
    if (const auto given = space.parameters(settings_[family].given.drives.waveforms())) all.push_back(*given);
    for (const auto& waveforms : begun) {
      if (space.misfit(waveforms).empty()) all.push_back(space.nearest(waveforms));
    }
    for (Point u : internal::sobol_points(options_.seed, variables.size(), 0, box_points)) {
      for (std::size_t i = 0; i < u.size(); ++i) u[i] = variables[i].lower + u[i] * (variables[i].upper - variables[i].lower);
      all.push_back(std::move(u));
    }
    return all;
  }

  // Returns the outcomes; empty if a driver cannot give the waveform.
  std::vector<DeviceOutcome> closed(std::size_t family, const Point& x, std::size_t devices, int jobs) {
    const SearchSetting& own = settings_[family];
    const DriveWaveforms searched = own.space.waveforms(x);
    if (!own.is_allowed(searched)) return {};
    std::vector<DeviceOutcome> outcomes = cost_.close(own.drives(searched), 0, std::min(devices, cost_.devices()), jobs);
    took(static_cast<long>(outcomes.size()));
    return outcomes;
  }

  void search(std::vector<Runner>& runners, const Rung& rung, double length, std::size_t number) {
    run_tasks(
        runners.size(), options_.jobs,
        [&](std::size_t i) {
          Runner& r = runners[i];
          const StagedCost staged(setting(r), cost_, aim(r), options_.memory, identity(r));
          const std::size_t devices = std::min(rung.devices, cost_.devices());
          const double before = staged.tried(r.x, devices, without_limit, options_.jobs).cost;
          const ChainEnd end = search_chain(staged, setting(r).space.variables(),
                                            {.start = r.x,
                                             .devices = devices,
                                             .closings = static_cast<long>(length * static_cast<double>(rung.closings)),
                                             .step = rung.step,
                                             .population = r.by_share && !alone_ ? population_by_share : 1,
                                             .seed = seed_of(number, r),
                                             .jobs = options_.jobs},
                                            [&](const Point&, double, long closings) {
                                              if (over()) return true;  // the callback may throw from here on
                                              took(closings);
                                              return over();
                                            });
          r.closings += end.closings;
          if (end.cost < before) r.x = end.x;
        },
        options_.stop);
  }

  // Judges every search on so many devices. Returns true if any lands at least `share` of them.
  bool judge(std::vector<Runner>& runners, std::size_t devices, double share) {
    run_tasks(
        runners.size(), options_.jobs,
        [&](std::size_t i) {
          Runner& r = runners[i];
          r.outcomes = closed(r.family, r.x, devices, options_.jobs);
          r.bounce_free =
              static_cast<double>(std::ranges::count_if(r.outcomes, is_bounce_free)) / static_cast<double>(r.outcomes.size());
          r.tail = cost_.value(r.outcomes, aims_.tail);
          r.share = cost_.value(r.outcomes, aims_.share);
        },
        options_.stop);
    return std::ranges::any_of(runners, [&](const Runner& r) { return r.bounce_free >= share; });
  }

  // Returns the best search of every family, and the best of the others by the other criterion.
  static std::vector<Runner> survivors(std::vector<Runner> runners, bool by_share) {
    sort(runners, by_share);
    std::vector<Runner> kept, others;
    std::set<std::size_t> families;
    for (Runner& r : runners) (families.insert(r.family).second ? kept : others).push_back(std::move(r));
    sort(others, !by_share);
    if (!others.empty()) kept.push_back(std::move(others.front()));
    return kept;
  }

  static std::vector<Runner> best(std::vector<Runner> runners, bool by_share) {
    sort(runners, by_share);
    runners.resize(std::min(runners.size(), finalists));
    return runners;
  }

  static void sort(std::vector<Runner>& runners, bool by_share) {
    std::ranges::stable_sort(runners, {}, [by_share](const Runner& r) { return by_share ? r.share : r.tail; });
  }

  [[nodiscard]] Racer racer(const Runner& r) const {
    return {.family = first_family_ + r.family,
            .measure = aim(r).measure.text,
            .x = r.x,
            .waveforms = setting(r).space.waveforms(r.x),
            .closings = r.closings,
            .bounce_free = r.bounce_free,
            .tail = r.tail,
            .share = r.share};
  }

  static const Runner& leading(const std::vector<Runner>& runners, bool by_share) {
    return *std::ranges::min_element(runners, {}, [by_share](const Runner& r) { return by_share ? r.share : r.tail; });
  }

  void add(RaceResult& result, const std::vector<Runner>& runners) const {
    for (const Runner& r : runners) result.racers.push_back(racer(r));
  }

  RaceResult finished(RaceResult result) {
    std::ranges::reverse(result.racers);
    result.closings = closings_;
    return result;
  }

  const std::vector<SearchSetting>& settings_;
  std::size_t first_family_;
  const RobustCost& cost_;
  const RaceAims& aims_;
  const RaceOptions& options_;
  bool alone_ = false;  // a single search, not a race
  std::atomic<long> closings_ = 0;
  double planned_ = 1;
};

}  // namespace

RaceResult race(const std::vector<SearchSetting>& settings, const RobustCost& cost, const RaceAims& aims,
                const RaceOptions& options, const std::vector<DriveWaveforms>& begun) {
  std::vector<Runner> runners;
  for (std::size_t family = 0; family < settings.size(); ++family) {
    for (const bool by_share : {false, true}) runners.push_back({.family = family, .by_share = by_share, .x = {}});
  }
  return Race(settings, 0, cost, aims, options).run(std::move(runners), begun, false);
}

RaceResult race_alone(const SearchSetting& setting, std::size_t family, const RobustCost& cost, const RaceAims& aims,
                      bool by_share, const std::vector<DriveWaveforms>& begun, const RaceOptions& options) {
  const std::vector<SearchSetting> settings{setting};
  return Race(settings, family, cost, aims, options).run({{.by_share = by_share, .x = {}}}, begun, true);
}

}  // namespace softland
