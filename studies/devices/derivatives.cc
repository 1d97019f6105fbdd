#include "studies/devices/derivatives.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/require.h"
#include "objectives/cost_slope.h"
#include "studies/devices/nearby_devices.h"
#include "studies/devices/robustness.h"

namespace softland {
namespace {

constexpr double no_derivative = Metrics::unset;
constexpr double usual_tolerance = 1e-8;
// Permitted relative change of a figure's derivatives when the integrator gets a looser tolerance.
constexpr double largest_disagreement = 0.05;
// A derivative counts as 0 if its error, times the standard deviation of the quantity, is below this share of the figure.
constexpr double no_change = 1e-5;

// Returns the scene without jitter. Jitter is random for every edge and so has no derivatives.
PreparedScene without_jitter(const PreparedScene& scene) {
  PreparedScene own = scene;
  std::erase_if(own.scene.spread.variables, [](const SpreadVariable& v) { return v.is_drawn_per_edge; });
  own.scene.spread.copula.reset();
  return own;
}

// Returns the derivatives of switch and drive signals by the varied quantities at the nominal device. Variable::why_none gets
// the reason if a quantity has none.
DeviceChanges changes_near(NearbyDevices& near, const Switch& model, std::vector<Derivatives::Variable*>& variables,
                           const Progress& progress) {
  std::vector<std::string> why_none(variables.size());
  DeviceChanges changes = near.changes(model, why_none, progress);
  for (std::size_t i = 0; i < variables.size(); ++i) {
    if (variables[i]->why_none.empty()) variables[i]->why_none = why_none[i];
  }
  return changes;
}

// Returns the change of a figure by a standard deviation of each varied quantity; 0 without a derivative by that quantity.
Eigen::VectorXd changes_of(const std::vector<double>& by_variable, const std::vector<Derivatives::Variable>& variables) {
  Eigen::VectorXd changes(static_cast<Eigen::Index>(variables.size()));
  for (std::size_t k = 0; k < variables.size(); ++k)
    changes[static_cast<Eigen::Index>(k)] = std::isfinite(by_variable[k]) ? by_variable[k] * variables[k].deviation : 0;
  return changes;
}

std::string why_no_derivative(const Figure& figure, double value, const CostSlopes& slopes, const Metrics& metrics) {
  if (figure.slope == &Metrics::last_rebound_end && !metrics.settled) return "the nominal device has not settled";
  if (!std::isfinite(value)) return "the nominal device does not have it";
  return std::string(slopes.why_none[figure]);
}

// The closing of the nominal device, with the derivatives of its figures.
struct NominalClosing {
  DeviceOutcome outcome;
  CostSlopes slopes;
  // Derivatives of the figures, one row for each of derived_figures; empty if the device does not close.
  Eigen::MatrixXd gradient = {};
};

// Derivatives of the switch and of its drive signals by varied quantities or waveform parameters, from which derivatives of
// figures follow.
struct Changes {
  SwitchSlopes* of_switch = nullptr;  // derivatives of the switch; null if the switch does not depend on the quantities
  const SignalSlopes& of_signals;
};

NominalClosing close_nominal(const PreparedScene& nominal, const std::vector<Signal>& signals, const Changes& by,
                             const DerivativeOptions& options, const Progress& progress) {
  MetricsObserver observer(nominal.model.contact_gap(), nominal.scene.metrics);
  RecordedMotion tape(observer);
  const Trajectory end = observe_closing(
      nominal.model, signals, {.duration = nominal.duration, .tolerance = options.tolerance, .stop = progress.stop}, tape);
  NominalClosing closing{.outcome = {.metrics = observer.metrics(end)}, .slopes = {}};
  if (end.status != Status::done || !closing.outcome.closed()) return closing;
  LinearizedClosing motion(nominal.model, signals, tape, options.refinement, by.of_switch);
  closing.slopes = cost_slopes(nominal.model, signals, motion, nominal.scene.metrics);
  std::vector<FigureSlope> wanted;
  for (const Figure& figure : derived_figures) wanted.push_back(closing.slopes.of[figure.slope]);
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
                   .nominal = v.nominal(),
                   .deviation = v.distribution.standard_deviation(),
                   .why_none = v.is_drawn_per_edge ? "it is random for every edge" : ""});
  }
  return all;
}

// Computes the derivatives of the figures under these drive signals. `by` has the derivatives of switch and signals by some of
// the varied quantities; `places` are the indices of these among all varied quantities.
void derive(Derivatives& found, const PreparedScene& nominal, const std::vector<Signal>& signals, const Changes& by,
            const std::vector<std::size_t>& places, const Eigen::MatrixXd& correlation, const DerivativeOptions& options,
            const Progress& progress) {
  DerivativeOptions own = options;
  if (!(own.tolerance > 0)) own.tolerance = std::min(nominal.tolerance, usual_tolerance);
  const NominalClosing closing = close_nominal(nominal, signals, by, own, progress);
  const NominalClosing judge = close_nominal(nominal, signals, by, looser_than(own), progress);
  if (progress.stopped()) {
    found.why_none = "interrupted";
    return;
  }
  if (closing.gradient.size() == 0 || judge.gradient.size() == 0) {
    found.why_none = "the nominal device does not close";
    return;
  }
  found.grazing = closing.slopes.grazing;
  for (std::size_t f = 0; f < derived_figures.size(); ++f) {
    const Figure& derived = derived_figures[f];
    FigureDerivatives figure{.key = derived.key, .value = closing.outcome.of(derived), .by_variable = {}};
    figure.why_none = why_no_derivative(derived, figure.value, closing.slopes, closing.outcome.metrics);
    if (figure.why_none.empty()) {
      const auto of = [&](const Eigen::MatrixXd& gradient) {
        std::vector<double> all(found.variables.size(), no_derivative);
        for (std::size_t k = 0; k < places.size(); ++k) {
          if (found.variables[places[k]].why_none.empty())
            all[places[k]] = gradient(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(k));
        }
        return all;
      };
      set_derivatives(figure, found.variables, correlation, of(closing.gradient), of(judge.gradient));
    }
    found.figures.push_back(std::move(figure));
  }
}

}  // namespace

bool Derivatives::grazes() const { return grazing < grazing_share; }

Derivatives derivatives(const PreparedScene& scene, const EnsembleDrive& drive, const DerivativeOptions& options,
                        const Progress& progress) {
  require_open_start(scene.scene, "derivatives are those of a closing that begins");
  const DeviceSpread& spread = scene.scene.spread;
  Derivatives found{.variables = variables_of(spread), .figures = {}};
  std::vector<std::size_t> places;  // indices of the varied quantities with one value per device, not one per edge (jitter)
  std::vector<Derivatives::Variable*> variables;
  for (std::size_t i = 0; i < found.variables.size(); ++i) {
    if (spread.variables[i].is_drawn_per_edge) continue;
    places.push_back(i);
    variables.push_back(&found.variables[i]);
  }
  found.why_none = LinearizedClosing::refusal(scene.model);
  if (drive.known.calibration().classes) found.why_none = "devices are sorted into classes, between which their units jump";
  if (places.empty()) found.why_none = "all varied quantities are random for every edge";
  if (!found.why_none.empty()) return found;

  const PreparedScene nominal = without_jitter(scene);
  NearbyDevices near(nominal, drive);
  DeviceChanges by = changes_near(near, nominal.model, variables, progress);
  for (const std::size_t k : by.of_signals.kinks()) variables[k]->why_none = NearbyDevices::other_pieces;
  const std::vector<Signal> signals = near.signals();
  derive(found, nominal, signals, {.of_switch = &by.of_switch, .of_signals = by.of_signals}, places, spread.correlation, options,
         progress);
  return found;
}

Derivatives derivatives_by_waveforms(const PreparedScene& scene, const std::vector<WaveformParameter>& parameters,
                                     const SignalSlopes::SignalsOf& signals, const DerivativeOptions& options,
                                     const Progress& progress) {
  Derivatives found{.figures = {}};
  found.why_none = LinearizedClosing::refusal(scene.model);
  if (!found.why_none.empty()) return found;
  std::vector<std::size_t> places;
  std::vector<double> x, lower, upper;
  for (const WaveformParameter& one : parameters) {
    found.variables.push_back({.name = one.name, .nominal = one.value, .deviation = one.size / 100});
    places.push_back(places.size());
    x.push_back(one.value), lower.push_back(one.value - one.size), upper.push_back(one.value + one.size);
  }
  const SignalSlopes by(signals, x, lower, upper);
  for (const std::size_t k : by.kinks()) found.variables[k].why_none = NearbyDevices::other_pieces;
  const auto count = static_cast<Eigen::Index>(parameters.size());
  derive(found, scene, signals(x), {.of_signals = by}, places, Eigen::MatrixXd::Identity(count, count), options, progress);
  return found;
}

}  // namespace softland
