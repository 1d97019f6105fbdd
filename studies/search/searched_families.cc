#include "studies/search/searched_families.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "base/require.h"
#include "model/constants.h"
#include "studies/search/searched_shapes.h"
#include "studies/search/searched_trains.h"
#include "studies/search/swing.h"

namespace softland {
namespace {

using namespace internal;

void add_harmonic(DriveSearch& s, const PreparedScene& p, double t0) {
  const double upper = add_dither_variables(s, p, t0), room = s.variables[0].upper;
  for (const double frequency : {0.15, 0.45}) s.starts.push_back({room / 2, frequency * upper, pi, 0, 1.5 * t0, 0.2});
}

void add_step(DriveSearch& s, const PreparedScene&, double t0) {
  s.variables = {{"rise_time_s", 0, 2.5 * t0}};
  s.starts = {{0.5 * t0}};
}

// Adds the variables of the family knots, a piecewise linear waveform: the voltages at its knots (corners), the total time, and
// the relative durations of the lines between knots.
void add_knots(DriveSearch& s, const PreparedScene& p, double t0) {
  for (std::size_t k = 0; k < s.count; ++k)
    s.variables.push_back({fmt::format("level_{}_V", k + 1), s.limits.min_voltage, s.limits.max_voltage});
  s.variables.push_back({"total_time_s", 0.5 * t0, 10 * t0});
  for (std::size_t k = 0; k < s.count; ++k) s.variables.push_back({fmt::format("part_{}", k + 1), 0.05, 1});
  const auto line = [&](const auto& voltage, double total, double last_part) {
    std::vector<double> x;
    for (std::size_t k = 0; k < s.count; ++k)
      x.push_back(inside(s, voltage(static_cast<double>(k) / static_cast<double>(s.count - 1))));
    x.push_back(total * t0);
    x.insert(x.end(), s.count - 1, 1.0);
    x.push_back(last_part);
    s.starts.push_back(x);
  };
  if (s.drive == piezo_drive) {
    const double gap = p.scene.device.contact_gap();
    line([](double) { return 0; }, 1.5, 1);
    // Starting waveform of a piezo: it pulls towards the contact, then brakes, and returns to its hold level.
    line([&](double part) { return lifting_voltage(p, (part < 0.5 ? -0.4 : 0.3) * gap); }, 2, 1);
  } else {
    line([&](double part) { return (0.7 + 0.2 * part) * s.hold; }, 8, 0.2);   // starting waveform: a slow ramp
    line([&](double part) { return (0.75 + 0.2 * part) * s.hold; }, 3, 0.2);  // starting waveform: a quicker ramp
    // Starting waveform: full pull, then coasting.
    line([&](double part) { return part < 0.55 ? s.hold : 0.5 * s.hold; }, 1.5, 0.1);
    line([&](double part) { return part < 0.75 ? 0.3 * s.hold : 0.6 * s.hold; }, 1.8,
         0.1);  // starting waveform: low voltage, for a switch that other drives close
  }
}

void add_ramp(DriveSearch& s, const PreparedScene& p, double t0) {
  const double period = first_period(p);
  s.variables = {{"level_1_V", s.limits.min_voltage, s.limits.max_voltage},
                 {"level_2_V", s.limits.min_voltage, s.limits.max_voltage},
                 {"duration_s", 0.5 * t0, 10 * t0},
                 {"edge_s", 0.005 * period, 0.5 * period}};
  for (const double duration : {8.0, 3.0}) {
    s.starts.push_back({inside(s, 0.7 * s.hold), inside(s, 0.9 * s.hold), duration * t0, 0.05 * period});
  }
}

Waveform step_at(const DriveSearch& s, std::span<const double> x) {
  return Step{.level = s.hold, .rise_time = std::max(x[0], std::abs(s.hold - s.before) / s.limits.max_slew)};
}

Waveform harmonic_at(const DriveSearch& s, std::span<const double> x) {
  const SlewedDither d = slewed_dither(s, x[0], x[1], std::numeric_limits<double>::infinity(), x[3], x[4], x[5]);
  return Harmonic{.base = s.hold,
                  .rise_time = d.rise_time,
                  .amplitude = d.amplitude,
                  .angular_frequency = x[1],
                  .phase = x[2],
                  .start = d.start,
                  .end = d.start + x[4],
                  .fade = d.fade};
}

// Returns the waveform that goes through the voltages by straight lines of the given durations, which may be 0. A line that
// exceeds the slew limit of the source takes longer.
Waveform broken_line(const DriveSearch& s, std::span<const double> voltages, std::span<const double> durations) {
  Table table{.time = {0}, .voltage = {s.before}};
  for (std::size_t k = 0; k < voltages.size(); ++k) {
    const double rise = std::abs(voltages[k] - table.voltage.back()) / s.limits.max_slew;
    table.time.push_back(table.time.back() + std::max(durations[k], rise));
    table.voltage.push_back(voltages[k]);
  }
  return table;
}

Waveform knots_at(const DriveSearch& s, std::span<const double> x) {
  const std::span<const double> parts = x.subspan(s.count + 1);
  const double all = std::accumulate(parts.begin(), parts.end(), 0.0);
  std::vector<double> voltages(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(s.count)), durations{0};
  voltages.push_back(s.hold);
  for (const double part : parts) durations.push_back(x[s.count] * part / all);
  return broken_line(s, voltages, durations);
}

Waveform ramp_at(const DriveSearch& s, std::span<const double> x) {
  return broken_line(s, std::array{x[0], x[1], s.hold}, std::array{0.0, x[2], x[3]});
}

Parameters of_step(const DriveSearch&, const Waveform& waveform) {
  return std::vector<double>{std::get<Step>(waveform).rise_time};
}

Parameters of_harmonic(const DriveSearch&, const Waveform& waveform) {
  const auto& dither = std::get<Harmonic>(waveform);
  const double duration = dither.end - dither.start;
  return std::vector<double>{dither.amplitude, dither.angular_frequency, dither.phase, dither.start,
                             duration,         dither.fade / duration};
}

// True for a table of `rows` rows that begins with a jump at t = 0, as a searched waveform without a slew limit does.
bool begins_with_jump(const DriveSearch& s, const Table& table, std::size_t rows) {
  return table.time.size() == rows && table.time[1] == 0 && table.voltage[0] == s.before;
}

Parameters of_knots(const DriveSearch& s, const Waveform& waveform) {
  const auto& table = std::get<Table>(waveform);
  if (!begins_with_jump(s, table, s.count + 2)) return std::nullopt;
  std::vector<double> x(table.voltage.begin() + 1, table.voltage.end() - 1), parts;
  for (std::size_t k = 2; k < table.time.size(); ++k) parts.push_back(table.time[k] - table.time[k - 1]);
  const double longest = *std::max_element(parts.begin(), parts.end());
  x.push_back(table.time.back());
  for (const double part : parts) x.push_back(part / longest);
  return x;
}

Parameters of_ramp(const DriveSearch& s, const Waveform& waveform) {
  const auto& table = std::get<Table>(waveform);
  if (!begins_with_jump(s, table, 4)) return std::nullopt;
  return std::vector<double>{table.voltage[1], table.voltage[2], table.time[2], table.time[3] - table.time[2]};
}

constexpr auto families = std::to_array<SearchedFamily>({
    {FamilyOf<Step>::name, FamilyOf<Step>::name, 0, add_step, step_at, of_step},
    {FamilyOf<Pulse>::name,
     FamilyOf<Pulse>::name,
     0,
     add_pulse,
     train_at,
     of_train,
     {.pulses = 2, .longest = {1.6, 1.6, 1.6}, .first_duration = "time_1_s"}},
    {FamilyOf<Harmonic>::name, FamilyOf<Harmonic>::name, 0, add_harmonic, harmonic_at, of_harmonic},
    {"catch", FamilyOf<Pulse>::name, 0, add_catch, train_at, of_train, {.pulses = 3, .longest = {1.6, 1.6, 4}}},
    {"ramp", FamilyOf<Table>::name, 0, add_ramp, ramp_at, of_ramp},
    {"staircase", FamilyOf<Pulse>::name, 4, add_staircase, train_at, of_train, {.longest = {3, 3, 3}, .longest_edge = 1}},
    {"knots", FamilyOf<Table>::name, 6, add_knots, knots_at, of_knots},
    {"coast", FamilyOf<Pulse>::name, 0, add_coast, train_at, of_train, {.pulses = 1, .coasts = true, .longest = {1.6}}},
    {"dual-pulse", FamilyOf<Pulse>::name, 0, add_pulses, train_at, of_train, {.pulses = 2, .coasts = true, .longest = {1.6, 4}}},
    {"pulses", FamilyOf<Pulse>::name, 3, add_pulses, train_at, of_train, {.coasts = true, .longest = {1.6, 4, 4}}},
    {"s-curve", FamilyOf<SCurve>::name, 0, add_s_curve, s_curve_at, of_s_curve},
    {"dither", FamilyOf<Chirp>::name, 0, add_dither, dither_at, of_dither},
    {"chirp", FamilyOf<Chirp>::name, 0, add_chirp, chirp_at, of_chirp},
    {"bspline", FamilyOf<BSpline>::name, 6, add_bspline, bspline_at, of_bspline},
    {"sines", FamilyOf<Sines>::name, 4, add_sines, sines_at, of_sines},
});

constexpr std::size_t fewest = 2, most = 20;  // permitted numbers of levels, knots, pulses or sines of a waveform family

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

std::span<const SearchedFamily> searched_families() { return families; }

bool is_quasi_static(std::string_view family) { return family.substr(0, family.find(':')) == quasi_static_family; }

std::size_t number_of(const std::string& family, std::size_t usual) {
  const std::size_t colon = family.find(':');
  if (colon == std::string::npos) return usual;
  std::size_t count = 0;
  const std::string_view name = std::string_view(family).substr(0, colon), number = std::string_view(family).substr(colon + 1);
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), count);
  require_request(usual > 0 && error == std::errc() && end == number.data() + number.size() && count >= fewest && count <= most,
                  [&] {
                    return usual == 0 ? fmt::format("{} {}: {} has no number", requested("waveform"), family, name)
                                      : fmt::format("{} {}: the number after {} must be from {} to {}", requested("waveform"),
                                                    family, name, fewest, most);
                  });
  return count;
}

void choose_family(DriveSearch& s, const std::string& text) {
  const std::string_view name = std::string_view(text).substr(0, text.find(':'));
  require_request(!is_quasi_static(text), [&] {
    return fmt::format("{} {}: moves all drives at once: it is named alone, or beside others with +", requested("waveform"),
                       text);
  });
  const auto* found =
      std::find_if(families.begin(), families.end(), [&](const SearchedFamily& family) { return family.name == name; });
  require_request(found != families.end(),
                  [&] { return fmt::format("{} {}: must be {}", requested("waveform"), text, listed_searched_families()); });
  s.family = found;
  s.count = number_of(text, found->count);
}

std::string listed_searched_families() {
  std::string text;
  for (const SearchedFamily& family : families) text += fmt::format("{}{}, ", family.name, family.count > 0 ? ":N" : "");
  return text.substr(0, text.size() - 2) + fmt::format(" or {}:N", quasi_static_family);
}

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
