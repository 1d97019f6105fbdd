#include "studies/search/joint_rest_to_rest_starts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "studies/search/searched_shapes.h"
#include "studies/search/searched_trains.h"
#include "studies/search/swing.h"

namespace softland {
namespace {

// Shares of their voltage ranges that drives other than the pulling electrode use in a starting waveform.
constexpr std::array shares = {0.15, 0.4, 1.0};
constexpr double edge_of_period = 0.005;  // shortest edge of a waveform, in periods of the first mode
constexpr double longest = 3;             // longest swing (pull, then release) to the contact, in periods of the first mode

struct Levels {
  double pulling = 0, releasing = 0;  // voltages that pull, then release, in the two parts of a swing to the contact [V]
};

Levels levels_of(const DriveSearch& s, const PreparedScene& given, double share) {
  if (s.brakes) return {.pulling = internal::inside(s, 0), .releasing = share * s.limits.max_voltage};
  if (s.drive != piezo_drive) return {.pulling = s.limits.max_voltage, .releasing = internal::inside(s, 0)};
  const bool high_lifts = internal::lifting_voltage(given, 1) > 0;
  const double up = s.hold + share * (s.limits.max_voltage - s.hold), down = s.hold + share * (s.limits.min_voltage - s.hold);
  return high_lifts ? Levels{.pulling = down, .releasing = up} : Levels{.pulling = up, .releasing = down};
}

}  // namespace

std::vector<DriveWaveforms> joint_rest_to_rest_starts(const PreparedScene& given, const SearchSpace& space) {
  const std::vector<DriveSearch>& drives = space.drives();
  const bool is_one_electrode = drives.size() == 1 && drives.front().drive != piezo_drive;
  if (is_one_electrode || given.model.film_states() > 0 || !given.rest()) return {};
  const std::vector<std::string> names = given.drive_names();
  const double period = internal::first_period(given);
  std::vector<DriveWaveforms> all;
  for (const double share : shares) {
    std::vector<double> pulling = hold_levels(given.signals()), releasing = pulling;
    std::map<std::string, Levels> levels;
    for (const DriveSearch& s : drives) {
      const Levels own = levels.emplace(s.drive, levels_of(s, given, share)).first->second;
      const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), s.drive) - names.begin());
      pulling[at] = own.pulling;
      releasing[at] = own.releasing;
    }
    const std::optional<Swing> swing = quickest_swing(given.model, pulling, releasing, longest * period, given.values_before());
    if (!swing) continue;
    for (const double push : internal::pushes) {
      DriveWaveforms landing;
      for (const DriveSearch& s : drives) {
        const Levels own = levels.at(s.drive);
        const double pushing = s.drive == piezo_drive || s.brakes ? s.hold : own.pulling;
        landing.emplace(s.drive, internal::pulse_of(s, std::array{own.pulling, own.releasing, pushing},
                                                    std::array{swing->driven_time, swing->releasing_time, push * s.first_touch},
                                                    edge_of_period * period));
      }
      all.push_back(std::move(landing));
    }
  }
  return all;
}

}  // namespace softland
