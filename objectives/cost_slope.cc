#include "objectives/cost_slope.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "model/contact/contact_law.h"

namespace softland {
namespace {

using Eigen::VectorXd;

void add(FigureSlope& to, const FigureSlope& from, double factor = 1) {
  for (FigureSlope::Weights w : from.weights) {
    w.by_q *= factor;
    w.by_v *= factor;
    w.by_shift *= factor;
    to.weights.push_back(std::move(w));
  }
  for (FigureSlope::Moved m : from.moved) {
    m.rate *= factor;
    to.moved.push_back(m);
  }
  if (from.by_device.size() == 0) return;
  if (to.by_device.size() == 0) to.by_device = VectorXd::Zero(from.by_device.size());
  to.by_device += factor * from.by_device;
}

// Finds touches and rebounds in the linearized motion of the contact point, as MetricsObserver does in the simulated motion,
// and collects the derivatives of the figures that they determine.
class SlopeFinder {
 public:
  SlopeFinder(const Switch& model, std::span<const Signal> signals, const LinearizedClosing& motion,
              const MetricsOptions& options)
      : model_(model),
        signals_(signals),
        motion_(motion),
        options_(options),
        shape_(model.basis().contact_shape()),
        plane_(model.contact_gap()),
        zero_(VectorXd::Zero(model.modes())),
        work_(model.workspace()) {}

  CostSlopes find() {
    if (!model_.has_contact() || model_.has_damped_contact() || model_.has_spread_contact())
      slopes_.why_none[&Metrics::peak_contact_force] =
          "a damped contact, or one along the pad, does not press hardest at its deepest point";
    if (model_.has_spread_contact())
      slopes_.why_none[&Metrics::impact_energy] = "a contact along the pad stores energy over its whole length";
    auto passage = motion_.passages().begin();
    for (std::size_t i = 0; i < motion_.arcs().size(); ++i) {
      consider(i);
      bool begins_to_touch = false;
      for (; passage != motion_.passages().end() && passage->arcs <= i + 1; ++passage)
        begins_to_touch = (passage->arcs == i + 1 && cross(i, passage->change)) || begins_to_touch;
      measure_landing(i, begins_to_touch);
    }
    if (touches_ > 0 && touching_) end_touch();
    if (touches_ > 0 && !touching_) {
      end_rebound(motion_.arcs().size() - 1, false);
      slopes_.ends_above = true;
    }
    return std::move(slopes_);
  }

 private:
  using Arc = LinearizedClosing::Arc;

  [[nodiscard]] const Arc& arc(std::size_t i) const { return motion_.arcs()[i]; }
  // Returns the derivatives of a figure by the device parameters that change the switch: of(slopes, j) for parameter j. Empty
  // when there is no such parameter.
  template <class Of>
  [[nodiscard]] VectorXd by_device(Of&& of) const {
    if (motion_.by_device() == nullptr) return {};
    VectorXd all(static_cast<Eigen::Index>(motion_.by_device()->moving().size()));
    for (Eigen::Index j = 0; j < all.size(); ++j) all[j] = of(*motion_.by_device(), static_cast<std::size_t>(j));
    return all;
  }
  // Returns `factor` times the derivative of the contact point's interference (position beyond the contact plane) [m], at the
  // fixed time at which arc i of the motion ends.
  [[nodiscard]] FigureSlope position(std::size_t i, double factor) const {
    return {.weights = {{.arc = i, .by_q = factor * shape_, .by_v = zero_}},
            .moved = {},
            .by_device =
                by_device([&](const SwitchSlopes& s, std::size_t j) { return factor * s.interference(j, arc(i).q.data()); })};
  }
  // Returns the derivative of the speed [m/s] at which the contact point crosses the contact plane at the end of arc i of the
  // motion, including the effect of the shifted crossing time.
  [[nodiscard]] FigureSlope crossing_speed(std::size_t i) const {
    FigureSlope slope = position(i, -shape_.dot(arc(i).accelerations) / shape_.dot(arc(i).v));
    slope.weights[0].by_v = shape_;
    slope.by_device += by_device([&](const SwitchSlopes& s, std::size_t j) { return s.velocity(j, arc(i).v.data()); });
    return slope;
  }
  // Returns the derivative of the time [s] at which the contact point crosses the position that it has at the end of arc i of
  // the motion.
  [[nodiscard]] FigureSlope crossing_time(std::size_t i) const { return position(i, -1 / shape_.dot(arc(i).v)); }

  // Compares the contact point's position at the end of arc i with the extreme so far: the smallest distance before the first
  // touch, the depth of the current touch, or the height of the current rebound.
  void consider(std::size_t i) {
    const double at = shape_.dot(arc(i).q);
    if (touches_ == 0) {
      if (plane_ - at < closest_) {
        closest_ = plane_ - at;
        slopes_.of[&Metrics::closest] = position(i, -1);
      }
    } else if (touching_) {
      if (at - plane_ > (1 + 1e-9) * depth_ && (arc(i).turns || i + 1 == motion_.arcs().size()))
        update_plastic_depth(i, at - plane_);
    } else if (plane_ - at > height_) {
      height_ = plane_ - at;
      height_slope_ = position(i, -1);
    }
  }

  void update_plastic_depth(std::size_t i, double depth) {
    depth_ = depth;
    const ContactState& law = arc(i).contact;
    if (!law.active || model_.has_spread_contact()) return;
    const double step = 1e-5 * depth;
    force_ = contact_force(model_.contact(), depth, law, 0);
    const auto slope_of = [&](auto&& of) {
      const double by_depth = (of(model_.contact(), depth + step) - of(model_.contact(), depth - step)) / (2 * step);
      FigureSlope found = position(i, by_depth);
      if (law.unloading) found.weights[0].by_shift = -by_depth;
      found.by_device += by_device([&](const SwitchSlopes& s, std::size_t j) {
        return s.of_contact(j, [&](const ContactLaw& other) { return of(other, depth); });
      });
      return found;
    };
    energy_slope_ = slope_of([&](const ContactLaw& of, double d) { return stored_energy(of, d, law); });
    force_slope_ = slope_of([&](const ContactLaw& of, double d) { return contact_force(of, d, law, 0); });
  }

  // Updates the derivatives when the contact point crosses the contact plane at the end of arc i, where the contact law
  // changes. Returns true when contact begins there.
  bool cross(std::size_t i, const PhaseChange& change) {
    using Kind = PhaseChange::Kind;
    if (change.kind == Kind::turn || change.level != plane_) return false;
    const Arc& at = arc(i);
    const double speed = shape_.dot(at.v);
    if (first_speed_ > 0) slopes_.grazing = std::min(slopes_.grazing, std::abs(speed) / first_speed_);
    if (change.kind == Kind::leaves || (speed < 0 && touching_)) {
      end_touch();
      if (change.kind != Kind::leaves) add(slopes_.of[&Metrics::separated], crossing_time(i), -1);
      return false;
    }
    if (!(speed > 0) || touching_) return false;
    if (touches_ == 0) {
      first_speed_ = speed;
      slopes_.of[&Metrics::impact_velocity] = crossing_speed(i);
      slopes_.of[&Metrics::initial_contact_time] = slopes_.of[&Metrics::last_rebound_end] = crossing_time(i);
    } else {
      end_rebound(i, true);
    }
    ++touches_;
    touching_ = true;
    depth_ = force_ = 0;
    if (speed > fastest_) {
      fastest_ = speed;
      slopes_.of[&Metrics::largest_impact_velocity] = crossing_speed(i);
    }
    if (change.kind == Kind::impact || change.kind == Kind::rests) {
      FigureSlope energy = position(i, -at.v.dot(at.accelerations) / speed);
      energy.weights[0].by_v = at.v;
      add(slopes_.of[&Metrics::impact_energy], energy);
      if (change.kind == Kind::impact) {
        touching_ = false;
        height_ = 0;
        add(slopes_.of[&Metrics::separated], crossing_time(i), -1);
      }
    }
    return true;
  }

  void end_touch() {
    add(slopes_.of[&Metrics::impact_energy], energy_slope_);
    if (force_ > largest_force_) {
      largest_force_ = force_;
      slopes_.of[&Metrics::peak_contact_force] = force_slope_;
    }
    energy_slope_ = force_slope_ = {};
    touching_ = false;
    height_ = 0;
    height_slope_ = {};
  }

  void end_rebound(std::size_t i, bool touches) {
    if (touches) add(slopes_.of[&Metrics::separated], crossing_time(i));
    if (height_ > highest_) {
      highest_ = height_;
      slopes_.of[&Metrics::major_bounce_height] = height_slope_;
    }
    if (height_ > options_.significant_rebound && touches) slopes_.of[&Metrics::last_rebound_end] = crossing_time(i);
  }

  [[nodiscard]] bool holds(const std::vector<std::size_t>& pieces) const {
    for (std::size_t k = 0; k < signals_.size(); ++k) {
      if (pieces[k] + 1 < signals_[k].pieces().size()) return false;
    }
    return true;
  }

  // Computes the derivative of landing_excess, the energy above the closed equilibrium, at first contact or when the drives
  // reach their hold levels, whichever is later.
  void measure_landing(std::size_t i, bool begins_to_touch) {
    if (measured_ || touches_ == 0) return;
    const Arc& at = arc(i);
    const bool reaches_hold = i + 1 < motion_.arcs().size() && !holds(motion_.pieces(at)) && holds(motion_.pieces(arc(i + 1)));
    if (!reaches_hold && !(begins_to_touch && holds(motion_.pieces(at)))) return;
    measured_ = true;
    const std::vector<std::size_t>& pieces = motion_.pieces(reaches_hold ? arc(i + 1) : at);
    std::vector<double> volts;
    for (std::size_t k = 0; k < signals_.size(); ++k) volts.push_back(signals_[k].pieces()[pieces[k]].voltage(at.end));
    VectorXd forces(model_.modes());
    const ContactState law = begins_to_touch ? ContactState(true) : at.contact;
    model_.accelerations(at.q.data(), zero_.data(), volts, law, work_, forces.data());
    FigureSlope::Weights weights{.arc = i, .by_q = -forces, .by_v = at.v};
    const double rate = weights.by_q.dot(at.v) + weights.by_v.dot(at.accelerations);
    if (reaches_hold) {
      std::size_t k = 0;
      while (motion_.pieces(at)[k] == pieces[k]) ++k;
      slopes_.of[&Metrics::landing_excess].moved.push_back({.drive = k, .piece = pieces[k], .rate = rate});
    } else {
      weights.by_q -= rate / shape_.dot(at.v) * shape_;
    }
    slopes_.of[&Metrics::landing_excess].weights.push_back(std::move(weights));
  }

  const Switch& model_;
  std::span<const Signal> signals_;
  const LinearizedClosing& motion_;
  const MetricsOptions& options_;
  const VectorXd& shape_;
  double plane_;  // position of the contact plane [m]
  VectorXd zero_;
  Switch::Workspace work_;
  CostSlopes slopes_;
  long touches_ = 0;
  bool touching_ = false, measured_ = false;
  double first_speed_ = 0, fastest_ = 0;  // impact velocity of the first touch, and largest of all touches [m/s]
  // Smallest distance to the contact plane before the first touch [m].
  double closest_ = std::numeric_limits<double>::infinity();
  // Largest depth [m] of the current touch so far, and contact force there [N]; largest force of all touches [N].
  double depth_ = 0, force_ = 0, largest_force_ = 0;
  double height_ = 0, highest_ = 0;  // height of the current rebound and of the highest rebound [m]
  FigureSlope energy_slope_, force_slope_, height_slope_;
};

}  // namespace

CostSlopes cost_slopes(const Switch& model, std::span<const Signal> signals, const LinearizedClosing& motion,
                       const MetricsOptions& options) {
  return SlopeFinder(model, signals, motion, options).find();
}

std::optional<FigureSlope> cost_slope(const Aim& aim, const Metrics& figures, const CostScale& scale,
                                      const MetricsOptions& options, const CostSlopes& slopes) {
  const bool has_slope = std::ranges::all_of(aim.parts(), [&](const Aim::Part& part) {
    if (part.own) return false;
    const TargetRow& row = row_of(targets, part.target);
    return row.no_gradient.empty() && slopes.why_none[row.figure].empty();
  });
  if (!has_slope || !std::isfinite(cost(aim, figures, scale, options))) return std::nullopt;
  struct CostTerm {
    double Metrics::*figure;
    double scale;
  };
  const Metrics& step = scale.step;
  const CostTerm parts[] = {{&Metrics::closest, scale.contact_gap},
                            {&Metrics::initial_contact_time, step.initial_contact_time},
                            {&Metrics::largest_impact_velocity, step.largest_impact_velocity},
                            {&Metrics::major_bounce_height, options.significant_rebound},
                            {&Metrics::separated, scale.score_window},
                            {&Metrics::last_rebound_end, step.initial_contact_time},
                            {&Metrics::impact_energy, step.impact_energy},
                            {&Metrics::landing_excess, step.landing_excess},
                            {&Metrics::peak_contact_force, step.peak_contact_force}};
  FigureSlope sum;  // summed in the order of `parts`: another order changes the last bits
  for (const CostTerm& part : parts) {
    const double value = figures.*part.figure;
    if (!std::isfinite(value)) continue;
    // Compute the derivative of the cost by this figure as a central difference. The cost is a closed-form function of the
    // figures, so the difference is accurate to about 1e-10.
    const double size = std::abs(value) > 0 ? std::abs(value) : part.scale;
    if (!(size > 0) || !std::isfinite(size)) continue;
    const double h = 1e-6 * size;
    Metrics above = figures, below = figures;
    above.*part.figure = value + h;
    below.*part.figure = value > 0 ? value - h : value;
    const double rate =
        (cost(aim, above, scale, options) - cost(aim, below, scale, options)) / (above.*part.figure - below.*part.figure);
    if (rate != 0 && std::isfinite(rate)) add(sum, slopes.of[part.figure], rate);
  }
  return sum;
}

}  // namespace softland
