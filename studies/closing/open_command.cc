#include "studies/closing/open_command.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "studies/closing/hold.h"

namespace softland {
namespace {

constexpr int most_samples = 4000;  // largest number of samples of a curved piece (sine or decay) of a drive signal
constexpr int halvings = 40;
constexpr double decay_end = 40;  // number of time constants after which an exponential decay of a signal has ended

enum class OfJump { before, after };  // side of a jump of a drive's signal

struct Instant {
  double time;  // time at which the levels of the drives are checked [s]
  OfJump side;
};

std::vector<double> levels_at(const std::vector<Signal>& signals, const Instant& at) {
  std::vector<double> levels;
  for (const Signal& s : signals) levels.push_back(at.side == OfJump::before ? s.voltage_before(at.time) : s.voltage(at.time));
  return levels;
}

// Returns the number of parts into which a piece of a signal is divided for sampling: so many that no term of the piece has two
// extrema in one part. Returns 1 for a straight piece.
int parts_of(const Signal& signal, double begin, double end) {
  const double step = signal.resolving_step(begin);
  return std::isfinite(step) ? std::clamp(static_cast<int>(std::ceil((end - begin) / step)), 1, most_samples) : 1;
}

// Returns the instants at which the levels of the drives are checked, in order of time: both sides of every breakpoint, and
// samples between the breakpoints of curved pieces.
std::vector<Instant> checked_instants(const std::vector<Signal>& signals) {
  std::vector<double> stops;
  double end = 0;
  for (const Signal& s : signals) {
    std::ranges::copy(s.breakpoints(), std::back_inserter(stops));
    const SignalPiece& last = s.pieces().back();
    for (const SignalTerm& term : last.terms) end = std::max(end, last.begin + decay_end / term.decay);
  }
  if (std::isfinite(end)) stops.push_back(end);
  std::ranges::sort(stops);
  stops.erase(std::ranges::unique(stops).begin(), stops.end());
  std::vector<Instant> all;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    all.push_back({stops[i], OfJump::before});
    all.push_back({stops[i], OfJump::after});
    if (i + 1 == stops.size()) break;
    int parts = 1;
    for (const Signal& s : signals) parts = std::max(parts, parts_of(s, stops[i], stops[i + 1]));
    for (int k = 1; k < parts; ++k)
      all.push_back({std::lerp(stops[i], stops[i + 1], k / static_cast<double>(parts)), OfJump::after});
  }
  return all;
}

// True if a drive is an electrode that pulls the beam towards the contact.
bool pulls(const Switch& model, std::size_t drive) {
  return model.drive_kind(drive) == DriveKind::electrode && pulls_in(model.device(), drive);
}

// Decides whether given levels of the drives keep a closed switch closed.
class Holding {
 public:
  Holding(const Switch& model, const std::vector<Signal>& signals)
      : model_(model), signals_(signals), last_(hold_levels(signals)), lost_(last_) {}

  [[nodiscard]] bool at(const Instant& instant) {
    std::vector<double> levels = levels_at(signals_, instant);
    if (is_weaker(levels, last_) || is_weaker(levels, lost_)) return false;
    if (hold_under(model_, levels).is_held) return true;
    // Remember levels that do not keep the switch closed: weaker levels need no further search for an equilibrium.
    lost_ = std::move(levels);
    return false;
  }

 private:
  // True if every electrode that pulls towards the contact pulls no more at `levels` than at `than`, and all other drives have
  // equal levels.
  [[nodiscard]] bool is_weaker(const std::vector<double>& levels, const std::vector<double>& than) const {
    for (std::size_t k = 0; k < levels.size(); ++k) {
      if (levels[k] == than[k]) continue;
      if (!pulls(model_, k) || !(model_.strength(k, levels[k]) <= model_.strength(k, than[k]))) return false;
    }
    return true;
  }

  const Switch& model_;
  const std::vector<Signal>& signals_;
  std::vector<double> last_, lost_;
};

// Returns the time at which the fall of an electrode's voltage to its level at `time` begins [s]. Returns `time` if the signal
// jumps at this time or does not fall.
double begin_of_fall(const Switch& model, std::size_t electrode, const Signal& signal, double time) {
  if (signal.voltage_before(time) != signal.voltage(time)) return time;
  const std::vector<SignalPiece>& pieces = signal.pieces();
  std::size_t k = signal.piece_at(time);
  if (pieces[k].begin == time && k > 0) --k;
  for (;; --k) {
    const SignalPiece& piece = pieces[k];
    const auto strength = [&](double t) { return model.strength(electrode, piece.voltage(t)); };
    const double end = time;
    const int parts = parts_of(signal, piece.begin, end);
    for (int i = parts - 1; i >= 0; --i) {
      const double earlier = std::lerp(piece.begin, end, i / static_cast<double>(parts));
      if (!(strength(earlier) > strength(time))) return time;
      time = earlier;
    }
    if (k == 0 || signal.voltage_before(time) != signal.voltage(time)) return time;
  }
}

// Returns the time from which on the drives no longer keep the switch closed [s].
std::optional<double> loses_hold(const Switch& model, const std::vector<Signal>& signals, StartState start) {
  Holding holding(model, signals);
  const std::vector<Instant> all = checked_instants(signals);
  std::optional<std::size_t> held;
  if (start == StartState::closed) {
    for (std::size_t i = 0; i < all.size() && holding.at(all[i]); ++i) held = i;
  } else {
    for (std::size_t i = all.size(); i-- > 1 && !held;) {  // leaves out all[0], before t = 0, when the switch is open
      if (holding.at(all[i])) held = i;
    }
  }
  if (!held || *held + 1 == all.size()) return std::nullopt;
  double last = all[*held].time, lost = all[*held + 1].time;
  for (int i = 0; i < halvings && last < lost; ++i) {
    const double middle = 0.5 * (last + lost);
    (holding.at({middle, OfJump::after}) ? last : lost) = middle;
  }
  return lost;
}

OpenCommand command_at(const std::vector<Signal>& signals, double time) {
  OpenCommand command{.time = time, .held = {}};
  for (const Signal& s : signals) command.held.push_back(held_from(s, time));
  return command;
}

}  // namespace

std::optional<OpenCommand> open_command(const Switch& model, const std::vector<Signal>& signals, StartState start) {
  if (!model.has_contact()) return std::nullopt;
  const std::vector<double> last = hold_levels(signals);
  if (hold_under(model, last).is_held || !model.open_equilibrium(last)) return std::nullopt;
  const std::optional<double> lost = loses_hold(model, signals, start);
  if (!lost) return std::nullopt;
  double time = *lost;
  for (std::size_t k = 0; k < signals.size(); ++k) {
    if (pulls(model, k)) time = std::min(time, begin_of_fall(model, k, signals[k], *lost));
  }
  return command_at(signals, time);
}

std::optional<OpenCommand> open_command(const PreparedScene& prepared, const std::vector<Signal>& signals) {
  const double given = prepared.scene.simulate.open_at;
  return std::isfinite(given) ? command_at(signals, given) : open_command(prepared.model, signals, prepared.start());
}

std::vector<Signal> until_command(const PreparedScene& prepared, std::vector<Signal> signals) {
  if (prepared.start() == StartState::closed) return signals;
  const std::optional<OpenCommand> command = open_command(prepared, signals);
  return command ? command->held : signals;
}

PreparedScene closing_of(const PreparedScene& prepared) {
  if (prepared.start() == StartState::closed) return prepared;
  const std::optional<OpenCommand> command = open_command(prepared, prepared.signals());
  PreparedScene closing = prepared;
  if (!command || command->time == 0) return closing;
  closing.held_from = command->time;
  closing.duration = std::min(closing.duration, command->time);
  return closing;
}

double connection_deflection(const Switch& model, const Eigen::VectorXd& q) {
  if (model.contacts() < 2) return model.contact_deflection(q.data());
  std::vector<double> separations;
  for (std::size_t c = 0; c < model.contacts(); ++c)
    if (model.device().contacts[c].connects) separations.push_back(model.contact_gap(c) - model.contact_deflection(q.data(), c));
  const auto [nearest, furthest] = std::ranges::minmax(separations);
  return model.contact_gap() - (model.device().connection == Connection::all ? furthest : nearest);
}

MetricsOptions with_opening(MetricsOptions options, const Switch& model, const std::vector<Signal>& signals,
                            const std::optional<OpenCommand>& command) {
  if (!command) return options;
  options.opening.time = command->time;
  if (const auto open = model.open_equilibrium(hold_levels(signals)))
    options.opening.open_position = connection_deflection(model, *open);
  return options;
}

}  // namespace softland
