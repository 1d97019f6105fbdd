#include "studies/derivatives.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "base/require.h"
#include "objectives/cost_slope.h"
#include "studies/robustness.h"

namespace softland {
namespace {

constexpr double no_derivative = Metrics::unset;
constexpr double usual_tolerance = 1e-8;
constexpr double largest_disagreement = 0.05;  // what derivatives may differ by from those of a looser run
constexpr double no_change = 1e-5;  // of a figure: a derivative that is off by this for a standard deviation is as good as 0
constexpr const char* other_pieces = "the waveforms have other pieces on either side of its nominal value";

// The edges of every device are drawn anew: the nominal one has none of it.
Prepared without_jitter(const Prepared& scene) {
  Prepared own = scene;
  std::erase_if(own.scene.spread.variables, [](const SpreadVariable& v) { return v.is_drawn_per_edge; });
  own.scene.spread.copula.reset();
  return own;
}

// The devices beside the nominal one, and what they are driven with.
class Surroundings {
 public:
  // Keeps references.
  Surroundings(const Prepared& nominal, const EnsembleDrive& drive)
      : nominal_(nominal),
        drive_(drive),
        known_(drive.known.without_errors()),
        ensemble_(nominal, 1),
        builder_(ensemble_),
        drives_(nominal) {
    const Calibration& calibration = known_.calibration();
    constexpr double precision = 1e-11;  // of pull-in voltages, whose differences are taken
    if (!calibration.is_empty()) meter_.emplace(nominal, Gauges::of(calibration), precision);
    for (const SpreadVariable& v : variables()) {
      values_.push_back(v.is_factor ? 1 : v.keys.front().nominal);
      steps_.push_back(values_.back() != 0 ? SwitchSlopes::step * std::abs(values_.back())
                                           : SwitchSlopes::step * v.distribution.standard_deviation());
    }
  }

  [[nodiscard]] const std::vector<SpreadVariable>& variables() const { return nominal_.scene.spread.variables; }
  [[nodiscard]] const std::vector<double>& values() const { return values_; }
  [[nodiscard]] double step(std::size_t i) const { return steps_[i]; }
  [[nodiscard]] bool changes_switch(std::size_t i) const {
    const std::vector<VariedKey>& keys = variables()[i].keys;
    return std::any_of(keys.begin(), keys.end(), [](const VariedKey& key) { return !key.drive; });
  }

  // The two devices beside the nominal one. Throws InvalidInput where one of them cannot be described.
  [[nodiscard]] SwitchSlopes::Neighbours neighbours(std::size_t i) {
    Switch above = device(i, 1), below = device(i, -1);
    SwitchOptions finer = nominal_.quadrature;
    // A panel that has a point more than on the other side would look like a change of the device.
    while (above.points() != below.points()) {
      constexpr double little = 1.01;
      finer.points_per_length *= little;
      above = Switch(above.device(), finer, &nominal_.model);
      below = Switch(below.device(), finer, &nominal_.model);
    }
    const std::vector<VariedKey>& keys = variables()[i].keys;
    const auto is_of_contact = [](const VariedKey& key) {
      return key.drive || key.path == "gap.contact" || key.path.starts_with("contact.");
    };
    return {.above = std::move(above),
            .below = std::move(below),
            .distance = 2 * step(i),
            .acts_in_flight = !std::all_of(keys.begin(), keys.end(), is_of_contact)};
  }

  // The signals of the device with these values.
  [[nodiscard]] std::vector<Signal> signals(std::span<const double> values) {
    const std::vector<double> own(values.begin(), values.end());
    DeviceUnits units;
    if (meter_) {
      const SampledDevice sampled = builder_.device(own);
      require(sampled.model.has_value(), sampled.refusal);
      units = known_.of(meter_->exact(*sampled.model), 0, 0);
      require(units.are_known(), not_measured);
    }
    return drives_.differ(units) ? drives_.signals(drive_.waveforms, units, own) : nominal_.driven(drive_.waveforms);
  }
  [[nodiscard]] std::vector<Signal> signals() { return signals(values_); }
  // Whether a quantity changes what a device is driven with.
  [[nodiscard]] bool changes_signals(std::size_t i) const {
    const std::vector<VariedKey>& keys = variables()[i].keys;
    return meter_ || std::any_of(keys.begin(), keys.end(), [](const VariedKey& key) { return key.drive.has_value(); });
  }
  // A step of a waveform that comes, goes or begins the clock on one side is no small change.
  [[nodiscard]] bool keeps_pieces(std::size_t i) {
    const auto pieces = [&](double side) {
      std::vector<std::size_t> counts;
      for (const Signal& signal : signals(beside(i, side))) counts.push_back(signal.pieces().size());
      return counts;
    };
    return pieces(-1) == pieces(0) && pieces(0) == pieces(1);
  }

 private:
  [[nodiscard]] std::vector<double> beside(std::size_t i, double side) const {
    std::vector<double> values = values_;
    values[i] += side * steps_[i];
    return values;
  }
  [[nodiscard]] Switch device(std::size_t i, double side) {
    SampledDevice sampled = builder_.device(beside(i, side));
    require(sampled.model.has_value(), sampled.refusal);
    return std::move(*sampled.model);
  }

  const Prepared& nominal_;
  const EnsembleDrive& drive_;
  KnownUnits known_;
  Ensemble ensemble_;
  DeviceBuilder builder_;
  DeviceDrives drives_;
  std::optional<DeviceMeter> meter_;
  std::vector<double> values_, steps_;
};

// What the varying quantities do to the switch and to its drives, where they do it smoothly.
struct Changes {
  SwitchSlopes of_switch;
  SignalSlopes of_signals;
};

Changes changes_near(Surroundings& near, const Switch& model, std::vector<Derivatives::Variable*>& variables,
                     const Watch& watch) {
  std::vector<std::optional<SwitchSlopes::Neighbours>> neighbours(variables.size());
  std::vector<double> lower = near.values(), upper = lower;
  for (std::size_t i = 0; i < variables.size() && !watch.stopped(); ++i) {
    watch.tell("derivatives", static_cast<double>(i) / static_cast<double>(variables.size()));
    std::string& why_none = variables[i]->why_none;
    try {
      if (near.changes_switch(i)) neighbours[i] = near.neighbours(i);
      if (!near.changes_signals(i)) continue;
      if (near.keeps_pieces(i)) {
        lower[i] -= near.step(i) / SignalSlopes::share_of_range;
        upper[i] += near.step(i) / SignalSlopes::share_of_range;
      } else {
        why_none = other_pieces;
      }
    } catch (const InvalidInput& error) {
      why_none = fmt::format("there is no device beside the nominal one: {}", error.what());
    }
    if (!why_none.empty()) neighbours[i].reset();
  }
  return {.of_switch = SwitchSlopes(model, std::move(neighbours)),
          .of_signals = SignalSlopes([&](std::span<const double> x) { return near.signals(x); }, near.values(), lower, upper)};
}

// The figure's change for a standard deviation of each quantity; 0 where it has no derivative.
Eigen::VectorXd changes_of(const std::vector<double>& by_variable, const std::vector<Derivatives::Variable>& variables) {
  Eigen::VectorXd changes(static_cast<Eigen::Index>(variables.size()));
  for (std::size_t k = 0; k < variables.size(); ++k)
    changes[static_cast<Eigen::Index>(k)] = std::isfinite(by_variable[k]) ? by_variable[k] * variables[k].deviation : 0;
  return changes;
}

std::string why_no_derivative(const FigureWithSlope& figure, double value, const CostSlopes& slopes, const Metrics& metrics) {
  if (figure.slope == &CostSlopes::last_rebound_end && !metrics.settled) return "the nominal device has not settled";
  if (!std::isfinite(value)) return "the nominal device does not have it";
  if (figure.slope == &CostSlopes::peak_force && !slopes.has_peak_force)
    return "a damped contact, or one along the pad, does not press hardest at its deepest point";
  if (figure.slope == &CostSlopes::impact_energy && !slopes.has_impact_energy)
    return "a contact along the pad stores its energy all along it";
  return {};
}

// The closing of the nominal device with everything that its derivatives need.
struct NominalClosing {
  DeviceOutcome outcome;
  CostSlopes slopes;
  Eigen::MatrixXd gradient = {};  // a row to each of figures_with_slopes; empty where the device does not close
};

NominalClosing close_nominal(const Prepared& nominal, const std::vector<Signal>& signals, Changes& by,
                             const DerivativeOptions& options, const Watch& watch) {
  MetricsObserver observer(nominal.model.device().gap.contact, nominal.scene.metrics);
  MotionTape tape(observer);
  const Trajectory end = observe_closing(
      nominal.model, signals, {.duration = nominal.duration, .tolerance = options.tolerance, .stop = watch.stop}, tape);
  NominalClosing closing{
      .outcome = {.metrics = observer.metrics(end), .largest_impact_velocity = observer.largest_impact_velocity()}, .slopes = {}};
  if (end.status != Status::done || !closing.outcome.closed()) return closing;
  LinearizedClosing motion(nominal.model, signals, tape, options.refinement, &by.of_switch);
  closing.slopes = cost_slopes(nominal.model, signals, motion, nominal.scene.metrics);
  std::vector<FigureSlope> wanted;
  for (const FigureWithSlope& figure : figures_with_slopes) wanted.push_back(closing.slopes.*figure.slope);
  closing.gradient = motion.backward(wanted, by.of_signals);
  return closing;
}

DerivativeOptions looser_than(const DerivativeOptions& options) {
  return {.tolerance = 10 * options.tolerance, .refinement = (options.refinement + 1) / 2};
}

void set_derivatives(FigureDerivatives& figure, const std::vector<Derivatives::Variable>& variables,
                     const Eigen::MatrixXd& correlation, std::vector<double> by_variable, const std::vector<double>& judge) {
  const Eigen::VectorXd changes = changes_of(by_variable, variables);
  const double off = (changes - changes_of(judge, variables)).cwiseAbs().maxCoeff(), size = changes.cwiseAbs().maxCoeff();
  figure.error = off > 0 ? off / size : 0;
  if (!(figure.error <= largest_disagreement || off <= no_change * std::abs(figure.value))) {
    figure.why_none = "ill-conditioned: its derivatives change with the tolerance of the closing, as after many rebounds";
    return;
  }
  figure.by_variable = std::move(by_variable);
  figure.deviation = std::sqrt(std::max(0.0, changes.dot(correlation * changes)));
}

std::vector<Derivatives::Variable> variables_of(const DeviceSpread& spread) {
  std::vector<Derivatives::Variable> all;
  for (const SpreadVariable& v : spread.variables) {
    all.push_back({.name = v.name,
                   .nominal = v.is_factor ? 1 : v.keys.front().nominal,
                   .deviation = v.distribution.standard_deviation(),
                   .why_none = v.is_drawn_per_edge ? "it is drawn anew for every edge" : ""});
  }
  return all;
}

}  // namespace

bool Derivatives::grazes() const { return grazing < grazing_share; }

Derivatives derivatives(const Prepared& scene, const EnsembleDrive& drive, const DerivativeOptions& options, const Watch& watch) {
  const DeviceSpread& spread = scene.scene.spread;
  Derivatives found{.variables = variables_of(spread), .figures = {}};
  std::vector<std::size_t> places;  // of what is not drawn for every edge
  std::vector<Derivatives::Variable*> variables;
  for (std::size_t i = 0; i < found.variables.size(); ++i) {
    if (spread.variables[i].is_drawn_per_edge) continue;
    places.push_back(i);
    variables.push_back(&found.variables[i]);
  }
  found.why_none = LinearizedClosing::refusal(scene.model);
  if (drive.known.calibration().classes) found.why_none = "devices are sorted into classes, and jump from one to the next";
  if (places.empty()) found.why_none = "all that varies is drawn anew for every edge";
  if (!found.why_none.empty()) return found;

  const Prepared nominal = without_jitter(scene);
  Surroundings near(nominal, drive);
  Changes by = changes_near(near, nominal.model, variables, watch);
  for (const std::size_t k : by.of_signals.kinks()) variables[k]->why_none = other_pieces;
  const std::vector<Signal> signals = near.signals();
  DerivativeOptions own = options;
  if (!(own.tolerance > 0)) own.tolerance = std::min(nominal.tolerance, usual_tolerance);
  const NominalClosing closing = close_nominal(nominal, signals, by, own, watch);
  const NominalClosing judge = close_nominal(nominal, signals, by, looser_than(own), watch);
  if (watch.stopped()) {
    found.why_none = "interrupted";
    return found;
  }
  if (closing.gradient.size() == 0 || judge.gradient.size() == 0) {
    found.why_none = "the nominal device does not close";
    return found;
  }
  found.grazing = closing.slopes.grazing;
  for (std::size_t f = 0; f < figures_with_slopes.size(); ++f) {
    const FigureWithSlope& derived = figures_with_slopes[f];
    FigureDerivatives figure{.key = derived.key, .value = ensemble_figure(derived.key).value(closing.outcome), .by_variable = {}};
    figure.why_none = why_no_derivative(derived, figure.value, closing.slopes, closing.outcome.metrics);
    if (figure.why_none.empty()) {
      const auto of = [&](const Eigen::MatrixXd& gradient) {
        std::vector<double> all(found.variables.size(), no_derivative);
        for (std::size_t k = 0; k < places.size(); ++k) {
          if (variables[k]->why_none.empty())
            all[places[k]] = gradient(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(k));
        }
        return all;
      };
      set_derivatives(figure, found.variables, spread.correlation, of(closing.gradient), of(judge.gradient));
    }
    found.figures.push_back(std::move(figure));
  }
  return found;
}

}  // namespace softland
