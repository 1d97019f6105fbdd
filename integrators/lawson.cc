#include "integrators/lawson.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/engineering.h"
#include "integrators/dormand_prince.h"

namespace softland {
namespace {

using Pair = DormandPrince;

}  // namespace

Lawson::Lawson(const OdeSystem& system)
    : system_(system),
      modes_(system.frequencies.size()),
      rest_(system.size - 2 * modes_),
      omega_(padded_to_lanes(system.frequencies, 1)),
      y_(system.size),
      trial_(system.size),
      rates_(modes_ + rest_),
      next_rates_(modes_ + rest_),
      weight_(system.size) {
  if (modes_ > 0) fastest_ = *std::max_element(system.frequencies.begin(), system.frequencies.end());
  for (Modal* m : {&inverse_, &q_, &v_, &a_, &q_weight_, &v_weight_}) m->resize(omega_.size());
  std::transform(omega_.begin(), omega_.end(), inverse_.begin(), [](double omega) { return 1 / omega; });
  for (Stage& k : k_) {
    for (Modal* m : {&k.q, &k.v, &k.cosine, &k.sine, &k.slack}) m->resize(omega_.size());
    k.rest.resize(rest_);
  }
}

bool Lawson::restart(double t, const double* y, const double* rates, const std::vector<double>& absolute, double first_step,
                     double max_step) {
  t_ = t;
  std::copy_n(y, y_.size(), y_.begin());
  std::copy_n(rates, rates_.size(), rates_.begin());
  std::transform(absolute.begin(), absolute.end(), weight_.begin(), [](double a) { return 1 / a; });
  std::copy_n(weight_.begin(), modes_, q_weight_.begin());
  std::copy_n(weight_.begin() + static_cast<std::ptrdiff_t>(modes_), modes_, v_weight_.begin());
  h_ = first_step;
  max_step_ = modes_ > 0 ? std::min(max_step, largest_phase / fastest_) : max_step;
  last_error_ = 0;
  first_ = true;
  return true;
}

void Lawson::turn_to_nodes(double h) {
  if (h == turned_) return;
  turned_ = h;
  constexpr std::size_t last = stages - 1;
  for (std::size_t b = 0; b < omega_.size(); b += lanes) {
    const Lane phase = h * lane(omega_, b);
    for (std::size_t s = 1; s < stages; ++s) {
      if (s == last) {  // the last two stages are both at the end of the step, so copy the values
        for (const auto member : {&Stage::cosine, &Stage::sine, &Stage::slack})
          lane(k_[s].*member, b) = lane(k_[s - 1].*member, b);
        continue;
      }
      const Turn turned = turn(Pair::nodes[s] * phase);
      lane(k_[s].cosine, b) = turned.cosine;
      lane(k_[s].sine, b) = turned.sine;
      lane(k_[s].slack, b) = turned.slack * lane(inverse_, b) * lane(inverse_, b);
    }
  }
}

template <std::size_t S>
void Lawson::evaluate(double t, double h) {
  Stage& stage = k_[S];
  std::array<double, S> factor;
  for (std::size_t j = 0; j < S; ++j) factor[j] = h * Pair::tableau[S][j];
  for (std::size_t b = 0; b < omega_.size(); b += lanes) {
    Lane kq = Lane::Zero(), kv = lane(v_, b);
    for (std::size_t j = 1; j < S; ++j) {
      kq += factor[j] * lane(k_[j].q, b);
      kv += factor[j] * lane(k_[j].v, b);
    }
    const Lane omega = lane(omega_, b), inverse = lane(inverse_, b), a = lane(a_, b);
    const Lane cosine = lane(stage.cosine, b), sine = lane(stage.sine, b);
    const Lane by_speed = sine * inverse;
    const Lane q = (lane(q_, b) + a * lane(stage.slack, b) + kq * cosine) + kv * by_speed;
    const Lane v = (a * by_speed - kq * (sine * omega)) + kv * cosine;
    store_lane(q, trial_.data(), b, modes_);
    store_lane(v, trial_.data() + modes_, b, modes_);
  }
  for (std::size_t i = 0; i < rest_; ++i) {
    double sum = y_[2 * modes_ + i];
    for (std::size_t j = 0; j < S; ++j) sum += factor[j] * k_[j].rest[i];
    trial_[2 * modes_ + i] = sum;
  }
  system_.rates(t, trial_.data(), next_rates_.data());
  for (std::size_t b = 0; b < omega_.size(); b += lanes) {
    const Lane omega = lane(omega_, b);
    const Lane moved = omega * omega * (load_lane(trial_.data(), b, modes_) - lane(q_, b)) - lane(a_, b);
    const Lane excess = moved + load_lane(next_rates_.data(), b, modes_);
    lane(stage.q, b) = excess * (lane(stage.sine, b) * -lane(inverse_, b));
    lane(stage.v, b) = excess * lane(stage.cosine, b);
  }
  std::copy_n(next_rates_.begin() + static_cast<std::ptrdiff_t>(modes_), rest_, stage.rest.begin());
}

double Lawson::squared_error(double h) const {
  Lane squares = Lane::Zero();
  for (std::size_t b = 0; b < omega_.size(); b += lanes) {
    Lane q = Lane::Zero(), v = Lane::Zero();
    for (std::size_t j = 1; j < stages; ++j) {
      q += Pair::difference[j] * lane(k_[j].q, b);
      v += Pair::difference[j] * lane(k_[j].v, b);
    }
    q *= lane(q_weight_, b);
    v *= lane(v_weight_, b);
    squares += q * q + v * v;
  }
  double sum = squares.sum();
  for (std::size_t i = 0; i < rest_; ++i) {
    double estimate = 0;
    for (std::size_t j = 0; j < stages; ++j) estimate += Pair::difference[j] * k_[j].rest[i];
    estimate *= weight_[2 * modes_ + i];
    sum += estimate * estimate;
  }
  return h * h * sum / static_cast<double>(y_.size());
}

double Lawson::stiffness() const {
  constexpr std::size_t last = stages - 1;
  Lane slopes = Lane::Zero(), states = Lane::Zero();
  for (std::size_t b = 0; b < omega_.size(); b += lanes) {
    const Lane q_weight = lane(q_weight_, b), v_weight = lane(v_weight_, b);
    Lane q = Lane::Zero(), v = Lane::Zero();
    for (std::size_t j = 1; j < last; ++j) {
      const double weight = Pair::tableau[last][j] - Pair::tableau[last - 1][j];
      q += weight * lane(k_[j].q, b);
      v += weight * lane(k_[j].v, b);
    }
    states += (q * q_weight).square() + (v * v_weight).square();
    q = lane(k_[last].q, b) - lane(k_[last - 1].q, b);
    v = lane(k_[last].v, b) - lane(k_[last - 1].v, b);
    slopes += (q * q_weight).square() + (v * v_weight).square();
  }
  return std::sqrt(slopes.sum() / std::max(states.sum(), std::numeric_limits<double>::min()));
}

bool Lawson::step(double t_stop) {
  double most = first_ ? Pair::first_growth : Pair::most_growth;
  for (std::size_t b = 0; b < omega_.size(); b += lanes) {
    lane(q_, b) = load_lane(y_.data(), b, modes_);
    lane(v_, b) = load_lane(y_.data() + modes_, b, modes_);
    lane(a_, b) = load_lane(rates_.data(), b, modes_);
  }
  std::copy_n(rates_.begin() + static_cast<std::ptrdiff_t>(modes_), rest_, k_[0].rest.begin());
  while (true) {
    double h = std::min(h_, max_step_);
    const bool stops = t_ + h >= t_stop;
    if (stops) h = t_stop - t_;
    if (!(t_ + h > t_)) {
      message_ = fmt::format("the tolerance cannot be met by any step length at t = {}", engineering(t_, "s", 4));
      return false;
    }
    const double end = stops ? t_stop : t_ + h;
    turn_to_nodes(h);
    evaluate<1>(t_ + Pair::nodes[1] * h, h);
    evaluate<2>(t_ + Pair::nodes[2] * h, h);
    evaluate<3>(t_ + Pair::nodes[3] * h, h);
    evaluate<4>(t_ + Pair::nodes[4] * h, h);
    evaluate<5>(end, h);
    evaluate<6>(end, h);
    const double e2 = squared_error(h);
    if (!std::isfinite(e2)) {
      h_ = Pair::not_finite * h;
      most = 1;
      continue;
    }
    // Single precision is enough for a step length.
    const float log_error = std::log2(static_cast<float>(std::clamp(e2, 1e-36, 1e36))) / 2;
    const double growth =
        Pair::safety * static_cast<double>(std::exp2(Pair::integral * last_error_ - Pair::proportional * log_error));
    if (e2 <= 1) {
      t_ = end;
      y_.swap(trial_);
      rates_.swap(next_rates_);
      last_error_ = std::max(log_error, Pair::least_error);
      // If the step was shortened to end at t_stop, this next step length is too short, but the caller restarts at t_stop.
      h_ = h * std::clamp(growth, Pair::least_growth, most);
      first_ = false;
      return true;
    }
    h_ = h * std::clamp(growth, Pair::least_growth, 0.9);
    most = 1;
  }
}

}  // namespace softland
