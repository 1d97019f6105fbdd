#include "studies/search/paced_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/random.h"
#include "studies/search/device_chain.h"

namespace softland {
namespace {

struct PaceStage {
  std::size_t devices;
  long closings;  // closings, of waveforms that last as long as the plain step bounces
  double step;    // part of the bounds
};
constexpr std::array stages_at_pace{PaceStage{64, 10'000, 0.15}, PaceStage{128, 10'000, 0.1}, PaceStage{256, 10'000, 0.08},
                                    PaceStage{256, 10'000, 0.04}};

constexpr double of_the_time = 0.995;                // share of the time: other devices wait a little longer
constexpr std::uint64_t first_of_paces = 1'000'000;  // offset of the random numbers: beyond those of the race

bool has_pace(const RobustAim& aim) { return aim.free.until > 0 && std::isfinite(aim.free.until); }

// Returns the time that devices may wait at a pace.
double allowed(const Pace& pace, const RobustAim& aim) { return of_the_time * pace.of_step * aim.free.until; }

// Returns the duration of the first waveform over the time that devices may wait unpriced: closings take time in proportion.
double relative_duration(const SearchSetting& setting, const RobustAim& aim) {
  if (!has_pace(aim)) return 1;
  const DriveWaveforms first = setting.space.waveforms(setting.space.starts().front());
  return std::clamp(last_breakpoint(setting.given.told(setting.drives(first))) / aim.free.until, 0.5, 4.0);
}

RobustAim aim_at(const Pace& pace, const RobustAim& aim) {
  RobustAim own = aim;
  if (!has_pace(aim)) return own;
  own.free.until = std::numeric_limits<double>::infinity();
  own.conditions.push_back(
      {.figure = figure_of(aim.free.figure), .comparison = Comparison::at_most, .limit = allowed(pace, aim), .text = ""});
  return own;
}

}  // namespace

std::optional<Racer> search_at_pace(const SearchSetting& given, const Pace& pace, const RobustCost& cost, const RobustAim& aim,
                                    const RaceOptions& options, std::atomic<long>& closings) {
  const RobustAim own = aim_at(pace, aim);
  SearchSetting setting = given;
  if (has_pace(aim)) setting.space = given.space.paced(allowed(pace, aim));
  const std::uint64_t identity =
      random_bits(options.seed, Stream::race, first_of_paces + static_cast<std::uint64_t>(std::lround(16 * pace.of_step)));
  const StagedCost staged(setting, cost, own, options.memory, identity);
  const auto over = [&] { return (options.stop != nullptr && *options.stop) || (options.out_of_time && options.out_of_time()); };
  const double length =
      static_cast<double>(options.closings) / static_cast<double>(race_closings) / relative_duration(setting, aim);
  const std::vector<Variable> variables = setting.space.variables();
  Racer found{.family = pace.family, .measure = own.measure.text, .x = {}, .waveforms = {}};
  double least = std::numeric_limits<double>::infinity();
  for (const std::vector<double>& start : setting.space.starts()) {
    if (over()) break;
    const StagedCost::Tried tried =
        staged.tried(start, std::min(stages_at_pace.front().devices, cost.devices()), least, options.jobs);
    found.closings += tried.closings;
    if (tried.cost < least) least = tried.cost, found.x = start;
  }
  if (found.x.empty()) return std::nullopt;
  for (std::size_t k = 0; k < stages_at_pace.size() && !over(); ++k) {
    const PaceStage& stage = stages_at_pace[k];
    const std::size_t devices = std::min(stage.devices, cost.devices());
    const StagedCost::Tried before = staged.tried(found.x, devices, std::numeric_limits<double>::infinity(), options.jobs);
    const ChainEnd end = search_chain(staged, variables,
                                      {.start = found.x,
                                       .devices = devices,
                                       .closings = std::lround(length * static_cast<double>(stage.closings)),
                                       .step = stage.step,
                                       .seed = random_bits(identity, Stream::race, k),
                                       .jobs = options.jobs},
                                      [&](const std::vector<double>&, double, long taken) {
                                        closings += taken;
                                        if (over()) return true;  // the callback may throw from here on
                                        if (options.progress) options.progress(0);
                                        return over();
                                      });
    found.closings += before.closings + end.closings;
    if (end.cost < before.cost) found.x = end.x;
    if (!options.on_stage || k + 1 == stages_at_pace.size() || over()) continue;
    found.waveforms = setting.space.waveforms(found.x);
    options.on_stage(found);
  }
  found.waveforms = setting.space.waveforms(found.x);
  return found;
}

}  // namespace softland
