#include "studies/devices/instruments.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/require.h"
#include "integrators/quintic.h"
#include "model/constants.h"
#include "model/linearized_closing.h"
#include "model/recorded_motion.h"
#include "model/static_slopes.h"
#include "objectives/cost_slope.h"
#include "objectives/rebounds.h"

namespace softland {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Relative tolerance of the integrator in closings from which finite differences are computed.
constexpr double tolerance_of_readings = 1e-9;

VectorXd single(double value) { return VectorXd::Constant(1, value); }

// Records the times at which the contact of a device closes and opens, in order.
class EdgeRecorder final : public ClosingObserver {
 public:
  explicit EdgeRecorder(double gap) : finder_(gap) {}
  void knot(const TrajectoryPoint& point) override {
    finder_.knot(point, [&](const Rebound& rebound) { add(rebound.begin, rebound.end); });
  }
  [[nodiscard]] VectorXd first(std::size_t count) {
    std::vector<double> all;
    if (finder_.first_touch().happened()) all.push_back(finder_.first_touch().time);
    all.insert(all.end(), edges_.begin(), edges_.end());
    if (const auto& last = finder_.under_way()) all.push_back(last->begin);
    all.resize(count, Metrics::unset);
    return Eigen::Map<const VectorXd>(all.data(), static_cast<Index>(count));
  }

 private:
  void add(double begin, double end) { edges_.insert(edges_.end(), {begin, end}); }
  ReboundFinder finder_;
  std::vector<double> edges_;
};

// Records the motion of a device's contact point at given times.
class PointRecorder final : public ClosingObserver {
 public:
  PointRecorder(std::span<const double> times, bool velocity)
      : times_(times), velocity_(velocity), values_(VectorXd::Constant(static_cast<Index>(times.size()), Metrics::unset)) {}
  void knot(const TrajectoryPoint& point) override {
    if (last_) {
      const TrajectoryPoint &a = *last_, &b = point;
      const Quintic curve(a.time, a.position, a.velocity, a.acceleration, b.time, b.position, b.velocity, b.acceleration);
      for (; next_ < times_.size() && times_[next_] <= b.time; ++next_)
        values_[static_cast<Index>(next_)] = velocity_ ? curve.velocity(times_[next_]) : curve.position(times_[next_]);
    }
    last_ = point;
  }
  [[nodiscard]] const VectorXd& values() const { return values_; }

 private:
  std::span<const double> times_;
  bool velocity_;
  VectorXd values_;
  std::size_t next_ = 0;
  std::optional<TrajectoryPoint> last_;
};

}  // namespace

std::size_t Instrument::size() const {
  switch (what) {
    case Measurable::contact:
      return edges;
    case Measurable::position:
    case Measurable::velocity:
      return times.size();
    default:
      return 1;
  }
}

double read(const Instrument& instrument, const Switch& model, Bias bias, double duration) {
  std::vector<double> values(model.drives(), 0.0);
  values[instrument.drive] = instrument.level;
  switch (instrument.what) {
    case Measurable::pull_in:
      return static_pull_in(model, instrument.drive, bias).voltage;
    case Measurable::release:
      return release_voltage(model, instrument.drive, bias);
    case Measurable::frequency:
      return resonance(model, instrument.mode, values) / (2 * pi);
    case Measurable::capacitance:
      return open_capacitance(model, instrument.drive, values);
    case Measurable::closing_time:
      return closing_time(model, instrument.drive, instrument.level, bias, duration);
    default:
      return Metrics::unset;
  }
}

bool DeviceReader::move_to(const std::vector<double>& values) {
  slopes_.reset();
  model_.reset();
  near_.move_to(values);
  try {
    model_.emplace(near_.device());
  } catch (const InvalidInput&) {
    return false;
  }
  return true;
}

SwitchSlopes& DeviceReader::slopes() {
  if (!slopes_) slopes_.emplace(near_.changes_of_switch(*model_));
  return *slopes_;
}

DeviceReader::Reading DeviceReader::read(const Instrument& instrument, bool with_slopes) {
  switch (instrument.what) {
    case Measurable::pull_in:
    case Measurable::release:
      return static_voltage(instrument, with_slopes);
    case Measurable::frequency:
    case Measurable::capacitance:
      return at_rest(instrument, with_slopes);
    case Measurable::closing_time:
      return touch(instrument, with_slopes);
    default:
      return of_motion(instrument, with_slopes);
  }
}

// Reads a static voltage (pull-in or release) as the commanded voltage; the voltage at the switch is V = gain * commanded +
// offset.
DeviceReader::Reading DeviceReader::static_voltage(const Instrument& instrument, bool with_slopes) {
  const std::size_t k = instrument.drive;
  const std::vector<double> bias = bias_of(nominal_.scene, k);
  const SourceErrors errors = near_.source_errors(k);
  const bool pulls_in = instrument.what == Measurable::pull_in;
  const StaticPullIn pull_in = pulls_in ? static_pull_in(*model_, k, bias) : StaticPullIn{};
  const ReleasePoint release = pulls_in ? ReleasePoint{} : release_point(*model_, k, bias);
  const double volts = pulls_in ? pull_in.voltage : release.voltage, told = (volts - errors.offset) / errors.gain;
  Reading reading{.values = single(told), .slopes = {}};
  if (!with_slopes) return reading;
  SwitchSlopes& by = slopes();
  reading.slopes = MatrixXd::Zero(1, static_cast<Index>(near_.values().size()));
  const std::vector<double> own =
      pulls_in ? static_pull_in_slopes(*model_, by, k, pull_in, bias) : release_slopes(*model_, by, k, release, bias);
  for (std::size_t j = 0; j < own.size(); ++j) reading.slopes(0, static_cast<Index>(by.moving()[j])) = own[j];
  for (std::size_t i = 0; i < near_.values().size(); ++i) {
    const SourceErrors change = near_.source_errors_by(k, i);
    double& slope = reading.slopes(0, static_cast<Index>(i));
    slope = (slope - change.offset - told * change.gain) / errors.gain;
  }
  return reading;
}

std::vector<double> DeviceReader::terminal_values(const Instrument& instrument) const {
  std::vector<double> values(model_->drives(), 0.0);
  const SourceErrors errors = near_.source_errors(instrument.drive);
  values[instrument.drive] = instrument.level == 0 ? 0 : errors.gain * instrument.level + errors.offset;
  return values;
}

DeviceReader::Reading DeviceReader::at_rest(const Instrument& instrument, bool with_slopes) {
  const std::size_t k = instrument.drive;
  const std::vector<double> values = terminal_values(instrument);
  const bool vibrates = instrument.what == Measurable::frequency;
  const double unit = vibrates ? 1 / (2 * pi) : 1;
  const double value = vibrates ? resonance(*model_, instrument.mode, values) : open_capacitance(*model_, k, values);
  Reading reading{.values = single(unit * value), .slopes = {}};
  if (!with_slopes || !std::isfinite(value)) return reading;
  SwitchSlopes& by = slopes();
  reading.slopes = MatrixXd::Zero(1, static_cast<Index>(near_.values().size()));
  const std::vector<double> own =
      vibrates ? resonance_slopes(*model_, by, instrument.mode, values) : open_capacitance_slopes(*model_, by, k, values);
  for (std::size_t j = 0; j < own.size(); ++j) reading.slopes(0, static_cast<Index>(by.moving()[j])) = unit * own[j];
  if (instrument.level == 0) return reading;
  std::optional<double> by_voltage;
  for (std::size_t i = 0; i < near_.values().size(); ++i) {
    const SourceErrors change = near_.source_errors_by(k, i);
    const double volts = instrument.level * change.gain + change.offset;
    if (volts == 0) continue;
    if (!by_voltage)
      by_voltage = vibrates ? resonance_by_voltage(*model_, instrument.mode, k, values)
                            : open_capacitance_by_voltage(*model_, k, k, values);
    reading.slopes(0, static_cast<Index>(i)) += unit * *by_voltage * volts;
  }
  return reading;
}

double DeviceReader::duration() const { return periods_to_close * 2 * pi / nominal_.model.basis().angular_frequencies()[0]; }

std::vector<Waveform> DeviceReader::waveforms_of(const Instrument& instrument) const {
  if (!instrument.waveforms.empty()) return instrument.waveforms;
  std::vector<Waveform> all;
  for (const double standing : bias_of(nominal_.scene, instrument.drive)) all.emplace_back(Step{.level = standing});
  all[instrument.drive] = Step{.level = instrument.level};
  return all;
}

DeviceReader::Reading DeviceReader::touch(const Instrument& instrument, bool with_slopes) {
  if (model_->contacts() > 1) return of_motion(instrument, with_slopes);
  const EnsembleDrive drive{.waveforms = waveforms_of(instrument)};
  near_.drive_by(drive);
  const std::vector<Signal> signals = near_.signals();
  const double window = last_breakpoint(signals) + duration();
  EdgeRecorder edges(model_->contact_gap());
  RecordedMotion tape(edges);
  const Trajectory run =
      observe_closing(*model_, signals, {.duration = window, .tolerance = tolerance_of_readings, .after_contact = 0}, tape);
  Reading reading{.values = edges.first(1), .slopes = {}};
  if (run.status != Status::done) reading.values[0] = Metrics::unset;
  if (!with_slopes || !std::isfinite(reading.values[0])) return reading;
  if (!LinearizedClosing::refusal(*model_).empty()) return of_motion(instrument, true);
  constexpr int refinement = 2;
  LinearizedClosing motion(*model_, signals, tape, refinement, &slopes());
  const CostSlopes figures = cost_slopes(*model_, signals, motion, nominal_.scene.metrics);
  reading.slopes = motion.backward({figures.of[&Metrics::initial_contact_time]}, near_.changes_of_signals());
  return reading;
}

VectorXd DeviceReader::followed(const Instrument& instrument, const Switch& model, const std::vector<Signal>& signals) const {
  const auto size = static_cast<Index>(instrument.size());
  const double window = last_breakpoint(signals) + duration();
  const auto run = [&](double until, double after_contact, ClosingObserver& observer) {
    return observe_closing(model, signals,
                           {.duration = until, .tolerance = tolerance_of_readings, .after_contact = after_contact}, observer)
               .status == Status::done;
  };
  const VectorXd unknown = VectorXd::Constant(size, Metrics::unset);
  if (instrument.what == Measurable::position || instrument.what == Measurable::velocity) {
    PointRecorder points(instrument.times, instrument.what == Measurable::velocity);
    constexpr double beyond = 1.0001;
    return run(beyond * instrument.times.back(), std::numeric_limits<double>::infinity(), points) ? points.values() : unknown;
  }
  if (instrument.size() == 1)
    return single(first_closing(model, signals, {.duration = window, .tolerance = tolerance_of_readings}));
  EdgeRecorder edges(model.contact_gap());
  const double after = 2 * pi / nominal_.model.basis().angular_frequencies()[0];
  return run(window, after, edges) ? edges.first(instrument.size()) : unknown;
}

DeviceReader::Reading DeviceReader::of_motion(const Instrument& instrument, bool with_slopes) {
  const EnsembleDrive drive{.waveforms = waveforms_of(instrument)};
  near_.drive_by(drive);
  Reading reading{.values = followed(instrument, *model_, near_.signals()), .slopes = {}};
  if (!with_slopes || !reading.values.allFinite()) return reading;
  const auto count = static_cast<Index>(near_.values().size());
  reading.slopes = MatrixXd::Constant(reading.values.size(), count, Metrics::unset);
  for (std::size_t i = 0; i < near_.values().size(); ++i) {
    const VectorXd above = followed(instrument, near_.device_beside(i, 1), near_.signals_beside(i, 1));
    const VectorXd below = followed(instrument, near_.device_beside(i, -1), near_.signals_beside(i, -1));
    reading.slopes.col(static_cast<Index>(i)) = (above - below) / (2 * near_.step(i));
  }
  return reading;
}

}  // namespace softland
