#include "studies/search/first_touch_problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/decompositions.h"
#include "base/require.h"
#include "model/closing.h"
#include "model/pull_in.h"
#include "studies/closing/plain_step.h"
#include "studies/search/swing.h"

namespace softland {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

}  // namespace

FirstTouchProblem::FirstTouchProblem(const PreparedScene& prepared, Actuator actuator, double peak)
    : model_(prepared.model),
      modes_(prepared.model.modes()),
      gap_(prepared.scene.device.contact_gap()),
      omega_(prepared.model.basis().angular_frequencies()),
      work_(prepared.model.workspace()) {
  require(model_.film_states() == 0, "the least time is not known where the gas film is compressible: gas.model = strip or none");
  require(model_.rest().has_value(), "the least time is not known of a switch without an open state");
  for (const auto& [name, value] : prepared.drives.before())
    require(value == 0,
            fmt::format("the least time is known from rest without drives only: waveform.{}.{} must be absent", name, "before"));
  const VectorXd& at_contact = model_.basis().contact_shape();
  const double least = at_contact.cwiseAbs().maxCoeff() / 10;
  const VectorXd scale = at_contact.cwiseAbs().cwiseMax(least);
  per_q_ = gap_ * scale.cwiseInverse();
  per_v_ = per_q_.cwiseProduct(omega_);
  per_acceleration_ = (per_v_ * omega_[0]).cwiseInverse();
  tip_ = VectorXd::Zero(2 * modes_);
  tip_speed_ = tip_;
  tip_.head(modes_) = at_contact.cwiseQuotient(scale);
  tip_speed_.tail(modes_) = at_contact.cwiseQuotient(scale).cwiseProduct(omega_) / omega_[0];
  start_ = VectorXd::Zero(2 * modes_);
  start_.head(modes_) = model_.rest()->cwiseQuotient(per_q_);

  for (const Waveform& w : prepared.waveforms(plain_step(prepared, actuator))) {
    hold_.push_back(signal(w).hold_level());
    held_.push_back(strength(held_.size(), hold_.back()));
  }
  if (actuator != Actuator::pzt) {
    add_free(prepared, searched_electrode(prepared.scene.device), peak, false);
    for (const std::string& name : braking_electrodes(prepared))
      add_free(prepared, name, std::numeric_limits<double>::infinity(), true);
  }
  if (actuator != Actuator::electrostatic) {
    require_request(prepared.model.has_piezo(),
                    [] { return requested("actuator") + " pzt|both needs a [piezo] section, and the scene has none"; });
    add_free(prepared, std::string(piezo_drive), std::numeric_limits<double>::infinity(), false);
  }
  for (const Free& f : free_) {
    const bool limited = std::isfinite(prepared.drives[f.drive].limits->max_slew);
    require(limited == ramps_,
            "the least time is known only where max_slew is given for all drives that are shaped, or for none");
  }
}

void FirstTouchProblem::add_free(const PreparedScene& prepared, const std::string& name, double peak, bool brakes) {
  const Drive& own = prepared.drives.at(name);
  const std::optional<DriverLimits>& limits = own.limits;
  require(limits.has_value(), fmt::format("the least time needs [driver.{}] with min_voltage and max_voltage", name));
  require(own.source.is_ideal(),
          fmt::format("the least time is not known of a source that samples or filters: driver.{}.sample_rate, bandwidth and "
                      "source_resistance must be absent",
                      name));
  const std::size_t drive = prepared.drives.place(name);
  const double low = limits->min_voltage, high = limits->max_voltage;
  if (free_.empty()) ramps_ = std::isfinite(limits->max_slew);
  Free f{.drive = drive, .name = name, .largest = 0, .sign = 1, .max_slew = limits->max_slew};
  ControlBound bound;
  double pull = 1, release = 0;
  if (model_.drive_kind(drive) == DriveKind::piezo) {
    f.largest = std::max(std::abs(low), std::abs(high));
    bound = {.lower = low / f.largest, .upper = high / f.largest};
    const bool up = model_.basis().piezo_shape().cwiseQuotient(omega_.cwiseAbs2()).dot(model_.basis().contact_shape()) > 0;
    pull = up ? bound.upper : bound.lower;
    release = up ? bound.lower : bound.upper;
  } else {
    // Count the voltages of an electrode from its voltage without pull (neutral voltage). With a slew limit the control is the
    // voltage itself, which counts from 0 V.
    const double neutral = ramps_ ? 0 : model_.neutral_voltage(drive);
    f.sign = std::abs(low - neutral) > std::abs(high - neutral) ? -1 : 1;
    const double most = f.sign > 0 ? std::min(high, peak) - neutral : neutral - std::max(low, -peak);
    require(most > 0, fmt::format("driver.{}: the least time needs a voltage above 0 V", name));
    const double least = std::max(0.0, f.sign > 0 ? low - neutral : neutral - high);
    f.largest = ramps_ ? most : most * most;
    bound = {.lower = ramps_ ? 0 : least * least / f.largest, .upper = 1};
    release = bound.lower;
    if (brakes) std::swap(pull, release);
  }
  if (ramps_) bound.slew = limits->max_slew / f.largest * time_unit();
  const Index n = controls();
  pull_.conservativeResize(n + 1);
  release_.conservativeResize(n + 1);
  pull_[n] = pull;
  release_[n] = release;
  bounds_.push_back(bound);
  free_.push_back(std::move(f));
}

double FirstTouchProblem::strength(std::size_t drive, double value) const {
  return model_.drive_kind(drive) == DriveKind::piezo ? value : model_.strength(drive, value);
}

std::vector<double> FirstTouchProblem::strengths(const VectorXd& c) const {
  std::vector<double> all = held_;
  for (std::size_t k = 0; k < free_.size(); ++k) {
    const double value = c[static_cast<Index>(k)] * free_[k].largest;
    all[free_[k].drive] = ramps_ ? strength(free_[k].drive, free_[k].sign * value) : value;
  }
  return all;
}

// Returns the control of a drive at a voltage: the drive's strength over its largest strength, or, with a slew limit, its
// voltage over its largest voltage. The result may be outside the bounds of the control.
double FirstTouchProblem::control(const Free& f, double volts) const {
  const bool squared = !ramps_ && model_.drive_kind(f.drive) == DriveKind::electrode;
  return (squared ? model_.strength(f.drive, volts) : f.sign * volts) / f.largest;
}

double FirstTouchProblem::strength_slope(const Free& f, double c) const {
  const bool squared = ramps_ && model_.drive_kind(f.drive) == DriveKind::electrode;
  const double per_control = f.sign * f.largest;
  return squared ? model_.strength_slope(f.drive, c * per_control) * per_control : f.largest;
}

ControlledSystem::Rates FirstTouchProblem::rates(const VectorXd& x, const VectorXd& c) {
  const VectorXd q = x.head(modes_).cwiseProduct(per_q_), v = x.tail(modes_).cwiseProduct(per_v_);
  const Switch::FreeMotion motion = model_.free_motion(q.data(), v.data(), strengths(c), work_);
  Rates rates{.value = VectorXd(2 * modes_), .slope = MatrixXd::Zero(2 * modes_, 2 * modes_ + controls())};
  rates.value.head(modes_) = omega_.cwiseProduct(x.tail(modes_)) / omega_[0];
  rates.value.tail(modes_) = per_acceleration_.cwiseProduct(motion.accelerations);
  rates.slope.block(0, modes_, modes_, modes_).diagonal() = omega_ / omega_[0];
  rates.slope.block(modes_, 0, modes_, modes_) = per_acceleration_.asDiagonal() * motion.by_q * per_q_.asDiagonal();
  rates.slope.block(modes_, modes_, modes_, modes_) = per_acceleration_.asDiagonal() * motion.by_v * per_v_.asDiagonal();
  for (std::size_t k = 0; k < free_.size(); ++k) {
    const auto column = static_cast<Index>(k);
    rates.slope.col(2 * modes_ + column).tail(modes_) =
        strength_slope(free_[k], c[column]) *
        per_acceleration_.cwiseProduct(motion.by_strength.col(static_cast<Index>(free_[k].drive)));
  }
  return rates;
}

MatrixXd FirstTouchProblem::curvature(const VectorXd& x, const VectorXd& c, const VectorXd& multipliers) {
  const VectorXd q = x.head(modes_).cwiseProduct(per_q_), v = x.tail(modes_).cwiseProduct(per_v_);
  const VectorXd weights = multipliers.tail(modes_).cwiseProduct(per_acceleration_);
  const std::vector<double> drives = strengths(c);
  const MatrixXd all = model_.free_motion_curvature(q.data(), v.data(), drives, weights.data(), work_);
  const Index n = 2 * modes_;
  MatrixXd result(n + controls(), n + controls());
  VectorXd scale(n);
  scale << per_q_, per_v_;
  result.topLeftCorner(n, n) = scale.asDiagonal() * all.topLeftCorner(n, n) * scale.asDiagonal();
  result.bottomRightCorner(controls(), controls()).setZero();
  for (std::size_t k = 0; k < free_.size(); ++k) {
    const Index column = n + static_cast<Index>(k), drive = n + static_cast<Index>(free_[k].drive);
    result.col(column).head(n) = strength_slope(free_[k], c[static_cast<Index>(k)]) * scale.cwiseProduct(all.col(drive).head(n));
    result.row(column).head(n) = result.col(column).head(n).transpose();
    if (ramps_ && model_.drive_kind(free_[k].drive) == DriveKind::electrode) {
      const Switch::FreeMotion motion = model_.free_motion(q.data(), v.data(), drives, work_);
      result(column, column) =
          2 * free_[k].largest * free_[k].largest * weights.dot(motion.by_strength.col(static_cast<Index>(free_[k].drive)));
    }
  }
  return result;
}

double FirstTouchProblem::max_slew(const std::string& drive) const {
  return std::find_if(free_.begin(), free_.end(), [&](const Free& f) { return f.name == drive; })->max_slew;
}

std::map<std::string, double> FirstTouchProblem::volts(const VectorXd& c) const {
  std::map<std::string, double> all;
  for (std::size_t k = 0; k < free_.size(); ++k) {
    const double value = c[static_cast<Index>(k)] * free_[k].largest;
    const bool squared = !ramps_ && model_.drive_kind(free_[k].drive) == DriveKind::electrode;
    const double acting = free_[k].sign * (squared ? std::sqrt(std::max(value, 0.0)) : value);
    all[free_[k].name] = squared ? model_.neutral_voltage(free_[k].drive) + acting : acting;
  }
  return all;
}

// Returns the hold levels of all drives [V]; the levels of the controlled drives are multiplied by `share_of_free`.
std::vector<double> FirstTouchProblem::held_levels(double share_of_free) const {
  std::vector<double> all = hold_;
  for (const Free& f : free_) all[f.drive] *= share_of_free;
  return all;
}

// Returns the least factor on the controlled drives' hold levels at which a closed equilibrium exists. The factor 1 must keep
// the switch closed.
double FirstTouchProblem::least_closing_share() const {
  constexpr double precision = 1e-9;
  const auto closes = [&](double share) { return keeps_closed(model_, closed_equilibrium(model_, held_levels(share))); };
  if (closes(0)) return 0;
  double low = 0, high = 1;
  while (high - low > precision) {
    const double middle = (low + high) / 2;
    (closes(middle) ? high : low) = middle;
  }
  return high;
}

std::optional<FirstTouchProblem::Landing> FirstTouchProblem::landing() const {
  if (!keeps_closed(model_, closed_equilibrium(model_, hold_))) return std::nullopt;
  const std::vector<double> levels = held_levels(ramps_ ? least_closing_share() : 1);
  const std::optional<ClosedEquilibrium> closed = closed_equilibrium(model_, levels);
  if (!keeps_closed(model_, closed)) return std::nullopt;
  // Treat the contact as rigid: a force on the contact point shifts it from its depth in the elastic contact back to the plane
  // of first contact; the other coordinates follow statically.
  std::vector<double> drives;
  for (std::size_t k = 0; k < levels.size(); ++k) drives.push_back(strength(k, levels[k]));
  Switch::Workspace work = model_.workspace();
  const VectorXd still = VectorXd::Zero(modes_), &shape = model_.basis().contact_shape();
  const Switch::FreeMotion motion = model_.free_motion(closed->q.data(), still.data(), drives, work);
  const VectorXd yields = solve_linear(motion.by_q, shape);
  const double depth = model_.contact_deflection(closed->q.data()) - gap_;
  Landing landing{.state = VectorXd::Zero(2 * modes_), .controls = VectorXd(controls())};
  landing.state.head(modes_) = (closed->q - depth / shape.dot(yields) * yields).cwiseQuotient(per_q_);
  for (std::size_t k = 0; k < free_.size(); ++k)
    landing.controls[static_cast<Index>(k)] = free_[k].sign * levels[free_[k].drive] / free_[k].largest;
  return landing;
}

std::optional<ControlledCourse> FirstTouchProblem::swing(double longest) const {
  const auto values = [&](const VectorXd& c) {
    std::vector<double> all = hold_;
    const std::map<std::string, double> free_volts = volts(c);
    for (const Free& f : free_) all[f.drive] = free_volts.at(f.name);
    return all;
  };
  const std::optional<Swing> best = quickest_swing(model_, values(pull_), values(release_), longest);
  if (!best) return std::nullopt;
  if (best->is_overdamped) {
    std::vector<Signal> signals;
    for (const double level : values(pull_)) signals.push_back(Signal::constant(level, 0));
    return flown(signals, 1, longest);
  }
  ControlledCourse course;
  const auto points = static_cast<double>(best->states.size() - 1);
  const double time = points * best->step;
  course.time = time / time_unit();
  course.knots = {0, std::clamp(best->driven_time / time, 0.01, 0.99), 1};
  course.controls.resize(controls(), 2);
  course.controls << pull_, release_;
  course.states.resize(2 * modes_, static_cast<Index>(best->states.size()));
  for (std::size_t p = 0; p < best->states.size(); ++p) {
    course.points.push_back(static_cast<double>(p) / points);
    course.states.col(static_cast<Index>(p)) << best->states[p].head(modes_).cwiseQuotient(per_q_),
        best->states[p].tail(modes_).cwiseQuotient(per_v_);
  }
  return course;
}

std::optional<ControlledCourse> FirstTouchProblem::flown(std::span<const Signal> signals, int intervals, double longest) const {
  constexpr double tolerance = 1e-6;
  constexpr int looks = 16;  // samples per interval of the controls, over which a signal is averaged
  std::vector<double> times{0};
  std::vector<VectorXd> states{start_};
  ClosingOptions options{.duration = longest, .tolerance = tolerance, .after_contact = 0};
  options.observer = [&](double time, const double* q, const double* v) {
    VectorXd state(2 * modes_);
    state << Eigen::Map<const VectorXd>(q, modes_).cwiseQuotient(per_q_),
        Eigen::Map<const VectorXd>(v, modes_).cwiseQuotient(per_v_);
    if (time > times.back()) times.push_back(time), states.push_back(std::move(state));
    return false;
  };
  const Trajectory run = simulate_closing(model_, signals, options);
  if (run.touches.empty()) return std::nullopt;
  const double end = run.touches.front().begin;
  ControlledCourse course;
  course.time = end / time_unit();
  for (int k = 0; k <= intervals; ++k) course.knots.push_back(static_cast<double>(k) / intervals);
  course.controls.resize(controls(), ramps_ ? intervals + 1 : intervals);
  for (Index column = 0; column < course.controls.cols(); ++column) {
    for (std::size_t k = 0; k < free_.size(); ++k) {
      const auto at = [&](double interval) {
        return control(free_[k], signals[free_[k].drive].voltage(interval / intervals * end));
      };
      double value = 0;
      if (ramps_) value = at(static_cast<double>(column));
      for (int look = 0; look < looks && !ramps_; ++look) value += at(static_cast<double>(column) + (look + 0.5) / looks) / looks;
      course.controls(static_cast<Index>(k), column) = std::clamp(value, bounds_[k].lower, bounds_[k].upper);
    }
  }
  std::size_t points = 0;
  while (points < times.size() && times[points] <= end) ++points;
  course.states.resize(2 * modes_, static_cast<Index>(points));
  for (std::size_t p = 0; p < points; ++p) {
    course.points.push_back(times[p] / end);
    course.states.col(static_cast<Index>(p)) = states[p];
  }
  return course;
}

}  // namespace softland
