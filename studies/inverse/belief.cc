#include "studies/inverse/belief.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "base/decompositions.h"
#include "base/random.h"
#include "studies/inverse/least_squares.h"

namespace softland {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t sampled_devices = 160;

// Returns how long the contact is open within `span` after first contact at the time `touch` [s]. Openings shorter than `least`
// [s] are not counted.
double open_time(double touch, std::span<const ContactOpening> openings, double span, double least) {
  double sum = 0;
  for (const ContactOpening& o : openings) {
    if (o.end - o.begin >= least && o.begin < touch + span) sum += std::min(o.end, touch + span) - o.begin;
  }
  return sum;
}

// Returns a robust term of the log likelihood of a residual q, as in Student's distribution: a record that the model cannot
// describe has little weight.
double gentle(double q) { return -1.2 * std::log1p(q * q / 3); }

}  // namespace

double Draws::normal() { return random_normal(seed_, Stream::tuning, next_++); }
double Draws::uniform() { return random_probability(seed_, Stream::tuning, next_++); }
VectorXd Draws::normals(Eigen::Index size) {
  VectorXd z(size);
  for (double& x : z) x = normal();
  return z;
}

double Likelihood::touch_deviation(double speed) const {
  constexpr double height_share = 1.0 / 2000, time_share = 1.0 / 3400, least_speed = 0.017;
  const TuningScales& s = scene_.scales();
  const double of_height = height_share * s.gap / std::max(least_speed * s.speed(), speed);
  return std::hypot(scene_.options().laboratory.edge_error, of_height, time_share * s.closing_time);
}

double Likelihood::touch_residual(const PredictedClosing& closing, const ContactRecord& record) const {
  constexpr double one_alone = 30;
  const std::optional<double> seen = first_touch(record);
  const bool closes = closing.is_seen_to_close();
  if (!closes || !seen) return closes == seen.has_value() ? 0 : one_alone;
  return (closing.recorded_touch() - *seen) / touch_deviation(closing.seen().speed);
}

double Likelihood::of_record(const PredictedClosing& closing, const ContactRecord& record) const {
  constexpr double linear_from = 6;
  const double r = touch_residual(closing, record);
  double sum = -loss_value(Loss::huber, r, linear_from) / 2;
  if (!closing.is_seen_to_close() || !first_touch(record)) return sum;
  const auto predicted = closing.seen();
  const double unseen = scene_.options().laboratory.unseen;
  if (!record.edges.empty()) {
    constexpr std::array spans{0.09, 0.3, 0.9};
    constexpr double share = 0.2, least = 0.0045;
    const double t0 = scene_.scales().closing_time;
    const std::vector<ContactOpening> seen = openings(record);
    for (const double span : spans) {
      const double own = open_time(predicted.touch, predicted.openings, span * t0, unseen);
      const double recorded = open_time(*first_touch(record), seen, span * t0, 0);
      sum += gentle((own - recorded) / (least * t0 + share * std::max(own, recorded)));
    }
  } else if (record.bounce_count) {
    constexpr double share = 0.3;
    const auto own = static_cast<double>(
        std::ranges::count_if(predicted.openings, [&](const ContactOpening& o) { return o.end - o.begin >= unseen; }));
    const double counted = *record.bounce_count;
    sum += gentle((own - counted) / (1 + share * std::max(own, counted)));
    if ((own > 0) != (counted > 0)) sum += gentle(1);
  }
  return sum;
}

double Likelihood::of_loudness(std::span<const PredictedClosing> closings) const {
  constexpr double error = 0.3, flattest = 0.5, steepest = 2;
  std::vector<double> speeds, sounds;
  for (std::size_t i = 0; i < shots_.size(); ++i) {
    if (!shots_[i].record.loudness || !closings[i].closes() || !(closings[i].fastest > 0)) continue;
    speeds.push_back(std::log(closings[i].fastest));
    sounds.push_back(std::log(*shots_[i].record.loudness));
  }
  if (speeds.size() < 2) return 0;
  const Eigen::Map<const Eigen::ArrayXd> v(speeds.data(), static_cast<Eigen::Index>(speeds.size())),
      s(sounds.data(), static_cast<Eigen::Index>(sounds.size()));
  const Eigen::ArrayXd dv = v - v.mean(), ds = s - s.mean();
  const double squares = dv.square().sum();
  const double slope = squares > 0 ? std::clamp((dv * ds).sum() / squares, flattest, steepest) : flattest;
  return -(ds - slope * dv).square().sum() / (2 * error * error);
}

double Likelihood::of(std::span<const PredictedClosing> closings) const {
  double sum = of_loudness(closings);
  for (std::size_t i = 0; i < shots_.size(); ++i) sum += of_record(closings[i], shots_[i].record);
  return sum;
}

Belief Belief::prior(Eigen::Index size, Draws& draws) {
  Belief belief{.moments = NormalBelief::standard(size), .mode = VectorXd::Zero(size)};
  for (std::size_t k = 0; k < sampled_devices; ++k) belief.points.push_back(draws.normals(size));
  belief.weights.assign(sampled_devices, 1.0 / static_cast<double>(sampled_devices));
  belief.effective_devices = static_cast<double>(sampled_devices);
  return belief;
}

std::vector<VectorXd> Belief::resampled(std::size_t count, Draws& draws) const {
  std::vector<VectorXd> drawn;
  const double first = draws.uniform() / static_cast<double>(count);
  double below = 0;
  std::size_t i = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double at = first + static_cast<double>(k) / static_cast<double>(count);
    while (i + 1 < weights.size() && below + weights[i] < at) below += weights[i++];
    drawn.push_back(points[i]);
  }
  for (std::size_t k = count; k > 1; --k)
    std::swap(drawn[k - 1], drawn[static_cast<std::size_t>(draws.uniform() * static_cast<double>(k))]);
  return drawn;
}

namespace {

// Residuals of the first contact times of one device in all shots (closings), and their derivatives by its coordinates z.
struct LinearTouches {
  VectorXd residuals;
  MatrixXd slopes;
};

class BeliefUpdate {
 public:
  BeliefUpdate(const TuningModel& scene, std::span<const LearnedShot> shots, Draws& draws, const Progress& progress)
      : scene_(scene), shots_(shots), likelihood_(scene, shots), draws_(draws), progress_(progress) {}

  [[nodiscard]] Belief updated_belief(const Belief& last) {
    find_mode(last);
    return sampled();
  }
  /// Fixes the ratio of contact to electrode gap at that of the scene in all later searches.
  void pin_gap_ratio() { pins_ratio_ = true; }
  /// Returns the misfit |z|^2 + sum of r^2 (coordinates z of the device, residuals r of its records) at the end of the search
  /// from `start`.
  [[nodiscard]] double misfit_from(const VectorXd& start) const {
    return misfits(std::vector<VectorXd>{fitted(start).first}).front();
  }
  [[nodiscard]] double misfit_of(const VectorXd& z) const { return misfits(std::vector<VectorXd>{z}).front(); }
  /// Searches from several starts until the misfit |z|^2 + sum of r^2 is at most `enough`. Returns the least misfit of all
  /// searches.
  [[nodiscard]] double least_misfit(const Belief& belief, double enough);

 private:
  // Returns the closings of every device, given by its point z, in every shot, ordered by device.
  [[nodiscard]] std::vector<PredictedClosing> close(std::span<const VectorXd> points) const {
    const std::vector<Particle> devices = scene_.devices(points, progress_);
    std::vector<PredictedShot> all;
    for (const Particle& device : devices) {
      for (const LearnedShot& shot : shots_) all.push_back({.device = &device, .waveforms = &shot.waveforms});
    }
    return scene_.close(all, progress_);
  }
  // Returns the log posterior of every device, given by its point z. A point that occurs several times is simulated once.
  [[nodiscard]] std::vector<double> log_posteriors(std::span<const VectorXd> points) const {
    std::vector<VectorXd> distinct;
    std::vector<std::size_t> places;
    for (const VectorXd& point : points) {
      const auto known = std::ranges::find(distinct, point);
      places.push_back(static_cast<std::size_t>(known - distinct.begin()));
      if (known == distinct.end()) distinct.push_back(point);
    }
    const std::vector<PredictedClosing> closings = close(distinct);
    std::vector<double> all;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const auto own = std::span(closings).subspan(places[k] * shots_.size(), shots_.size());
      all.push_back(likelihood_.of(own) - points[k].squaredNorm() / 2);
    }
    return all;
  }

  void find_mode(const Belief& last);
  void climb_from(const std::vector<VectorXd>& starts, std::size_t most, double enough);
  [[nodiscard]] LinearTouches linear_touches(const VectorXd& z) const;
  [[nodiscard]] std::pair<VectorXd, MatrixXd> fitted(VectorXd z) const;
  [[nodiscard]] std::vector<double> misfits(std::span<const VectorXd> points) const;
  // Returns the residual that fixes the gap ratio at that of the scene: 1 for a deviation by a thousandth of the ratio's
  // standard deviation; 0 if the ratio is free.
  [[nodiscard]] double ratio_residual(const VectorXd& z) const {
    constexpr double stiff = 1000;
    return pins_ratio_ ? stiff * scene_.gap_ratio_coordinate(z).value_or(0) : 0;
  }
  [[nodiscard]] Belief sampled();
  [[nodiscard]] std::vector<VectorXd> fresh(std::size_t count, double width) {
    std::vector<VectorXd> all;
    for (std::size_t k = 0; k < count; ++k) all.push_back(width * draws_.normals(scene_.size()));
    return all;
  }

  const TuningModel& scene_;
  std::span<const LearnedShot> shots_;
  Likelihood likelihood_;
  Draws& draws_;
  const Progress& progress_;
  VectorXd mode_;
  MatrixXd curvature_;
  bool pins_ratio_ = false;
  double best_ = -std::numeric_limits<double>::infinity();
};

// Returns the residuals of first contact times for the device z, and their derivatives by finite differences. Residuals beyond
// 4 grow only logarithmically, so that no single record dominates. All neighbouring devices are simulated together.
LinearTouches BeliefUpdate::linear_touches(const VectorXd& z) const {
  constexpr double apart = 0.01, steepest = 3000;
  const auto touches = static_cast<Eigen::Index>(shots_.size()), m = touches + (pins_ratio_ ? 1 : 0), n = scene_.size();
  const auto compressed = [](double r) {
    constexpr double from = 4;
    return std::abs(r) < from ? r : std::copysign(from * (1 + std::log1p(std::abs(r) / from - 1)), r);
  };
  std::vector<VectorXd> points{z};
  for (Eigen::Index k = 0; k < n; ++k) points.push_back(z + apart * VectorXd::Unit(n, k));
  const std::vector<PredictedClosing> closings = close(points);
  MatrixXd residuals(m, n + 1);  // residuals, one column per device: z and its neighbours
  for (Eigen::Index k = 0; k <= n; ++k) {
    for (Eigen::Index i = 0; i < touches; ++i)
      residuals(i, k) = compressed(likelihood_.touch_residual(closings[static_cast<std::size_t>(k * touches + i)],
                                                              shots_[static_cast<std::size_t>(i)].record));
    if (pins_ratio_) residuals(touches, k) = ratio_residual(points[static_cast<std::size_t>(k)]);
  }
  const VectorXd own = residuals.col(0);
  const MatrixXd slopes = (residuals.rightCols(n).colwise() - own) / apart;
  return {.residuals = own, .slopes = slopes.cwiseMax(-steepest).cwiseMin(steepest)};
}

// Minimises the sum of squares of the residuals of first contact times and of the coordinates z by Levenberg and Marquardt.
// Returns the minimum, and the curvature at the minimum: the inverse covariance of a normal distribution.
std::pair<VectorXd, MatrixXd> BeliefUpdate::fitted(VectorXd z) const {
  constexpr double longest = 1.5, enough = 0.02, hopeless = 1e4;
  constexpr int most_rounds = 14;
  const Eigen::Index n = scene_.size();
  VectorXd best = z;
  LinearTouches at_best{.residuals = {}, .slopes = MatrixXd::Zero(0, n)};
  MatrixXd curvature = MatrixXd::Identity(n, n);
  double least = std::numeric_limits<double>::infinity(), damping = 1e-2;
  for (int round = 0; round < most_rounds && damping < hopeless; ++round) {
    LinearTouches own = linear_touches(z);
    const double sum = z.squaredNorm() + own.residuals.squaredNorm(), gain = least - sum;
    const bool helps = gain > 1e-9;
    if (helps) {
      least = sum, best = z, at_best = std::move(own);
      curvature = at_best.slopes.transpose() * at_best.slopes + MatrixXd::Identity(n, n);
      damping = std::max(1e-6, damping / 5);
    } else {
      damping = std::max(8 * damping, 1e-4);
    }
    if (helps && gain < enough && round > 1) break;
    MatrixXd damped = curvature;
    damped.diagonal() *= 1 + damping;
    VectorXd step = -solve_semidefinite(damped, at_best.slopes.transpose() * at_best.residuals + best);
    if (step.norm() > longest) step *= longest / step.norm();
    z = best + step;
  }
  return {best, curvature};
}

// Searches the device of largest posterior from the `most` likeliest of these starts. Ends early when a search has reached a
// log posterior above `enough`.
void BeliefUpdate::climb_from(const std::vector<VectorXd>& starts, std::size_t most, double enough) {
  const std::vector<double> before = log_posteriors(starts);
  std::vector<std::size_t> order(starts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return before[a] > before[b]; });
  for (std::size_t q = 0; q < std::min(most, order.size()); ++q) {
    const VectorXd& start = starts[order[q]];
    if (q > 0 && start == starts[order[q - 1]]) continue;  // equal starts lead to the same end of the search
    auto [z, curvature] = fitted(start);
    double value = log_posteriors(std::span(&z, 1)).front();
    if (value < before[order[q]]) z = start, value = before[order[q]];
    if (value > best_) best_ = value, mode_ = z, curvature_ = curvature;
    if (best_ > enough) return;
  }
}

void BeliefUpdate::find_mode(const Belief& last) {
  constexpr std::size_t of_last = 48, of_prior = 48, many = 400;
  const auto shots = static_cast<double>(shots_.size());
  std::vector<VectorXd> starts = last.resampled(of_last, draws_);
  starts.push_back(last.mode);
  starts.push_back(last.moments.mean);
  std::ranges::move(fresh(of_prior, 1.2), std::back_inserter(starts));
  climb_from(starts, 3, -6 - 2 * shots);
  if (best_ < -12 - 4 * shots) climb_from(fresh(many, 1.6), 6, -12 - 4 * shots);
}

// Returns the misfit |z|^2 + sum of r^2 (coordinates z, residuals r) of every device z.
std::vector<double> BeliefUpdate::misfits(std::span<const VectorXd> points) const {
  const std::vector<PredictedClosing> closings = close(points);
  std::vector<double> all;
  for (std::size_t k = 0; k < points.size(); ++k) {
    double sum = points[k].squaredNorm() + std::pow(ratio_residual(points[k]), 2);
    for (std::size_t i = 0; i < shots_.size(); ++i) {
      const double r = likelihood_.touch_residual(closings[k * shots_.size() + i], shots_[i].record);
      sum += r * r;
    }
    all.push_back(sum);
  }
  return all;
}

double BeliefUpdate::least_misfit(const Belief& belief, double enough) {
  constexpr std::size_t of_belief = 16, of_prior = 240, most_fits = 10;
  constexpr std::array nearer{0.9, 0.8, 0.7, 0.6, 0.5, 0.4};
  const auto own = [&](const VectorXd& z) { return pins_ratio_ ? scene_.with_gap_ratio_of_scene(z) : z; };
  const VectorXd mode = own(belief.mode);
  double least = misfit_of(mode);
  if (least > enough) least = std::min(least, misfit_from(mode));
  if (least <= enough) return least;
  std::vector<VectorXd> starts = belief.resampled(of_belief, draws_);
  std::ranges::move(fresh(of_prior, 1.6), std::back_inserter(starts));
  for (VectorXd& start : starts) start = own(start);
  const auto rank = [&] {
    const std::vector<double> values = misfits(starts);
    std::vector<std::size_t> order(starts.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](std::size_t i, std::size_t j) { return values[i] < values[j]; });
    least = std::min(least, values[order.front()]);
    std::vector<VectorXd> ranked;
    for (std::size_t q = 0; q < std::min(most_fits, order.size()); ++q) ranked.push_back(starts[order[q]]);
    starts = std::move(ranked);
  };
  rank();
  // A device whose contact stays open has no derivative of the contact time by z, so that no search can leave it. Hence devices
  // between each start and the nominal device are starts as well.
  for (std::size_t q = 0, count = starts.size(); q < count; ++q) {
    for (const double share : nearer) starts.push_back(own(share * starts[q]));
  }
  rank();
  for (std::size_t q = 0; q < starts.size() && least > enough; ++q) {
    if (q > 0 && starts[q] == starts[q - 1]) continue;  // equal starts lead to the same end of the search
    least = std::min(least, misfit_from(starts[q]));
  }
  return least;
}

// Samples the posterior of all contact records by adaptive importance sampling from normal distributions.
Belief BeliefUpdate::sampled() {
  constexpr int most_rounds = 4;
  constexpr double least_share = 0.2, cooler = 0.7, coldest = 1e-3;
  const Eigen::Index n = scene_.size();
  Belief belief{.moments = {.mean = mode_, .covariance = MatrixXd(n, n)}, .mode = mode_, .log_posterior = best_};
  NormalBelief& moments = belief.moments;
  for (Eigen::Index k = 0; k < n; ++k) moments.covariance.col(k) = solve_semidefinite(curvature_, VectorXd::Unit(n, k));
  for (int round = 0; round < most_rounds; ++round) {
    const double wider = round == 0 ? 1.5 : 1.2;
    const MatrixXd factor = cholesky_factor(wider * moments.covariance + 1e-8 * MatrixXd::Identity(n, n));
    belief.points.clear();
    std::vector<double> drawn;
    for (std::size_t k = 0; k < sampled_devices; ++k) {
      const VectorXd e = round == 0 && k == 0 ? VectorXd::Zero(n) : draws_.normals(n);
      belief.points.push_back(moments.mean + factor * e);
      drawn.push_back(-e.squaredNorm() / 2);
    }
    std::vector<double> ratios = log_posteriors(belief.points);
    for (std::size_t k = 0; k < ratios.size(); ++k) ratios[k] -= drawn[k];
    Weights weights = weights_of(ratios);
    belief.effective_devices = weights.effective;
    double power = 1;
    while (weights.effective < least_share * static_cast<double>(sampled_devices) && power > coldest)
      weights = weights_of(ratios, power *= cooler);
    belief.weights = std::move(weights.values);
    moments = moments_of(belief.weights, belief.points);
    if (power == 1) break;
  }
  return belief;
}

}  // namespace

TouchMisfit touch_misfit(const TuningModel& scene, std::span<const LearnedShot> shots, const Belief& belief, Draws& draws,
                         const Progress& progress) {
  // 0.999 quantile of the standard normal distribution, for the misfit that one device in a thousand exceeds.
  constexpr double one_in_a_thousand = 3.0902;
  const auto stayed_open = [](const LearnedShot& shot) { return !first_touch(shot.record).has_value(); };
  std::vector<LearnedShot> counted(shots.begin(), shots.end());
  if (std::ranges::count_if(counted, stayed_open) == 1) std::erase_if(counted, stayed_open);
  TouchMisfit misfit{.records = counted.size()};
  if (counted.empty()) return misfit;
  const double m = static_cast<double>(counted.size()), ninth = 2 / (9 * m);
  misfit.bound = m * std::pow(1 - ninth + one_in_a_thousand * std::sqrt(ninth), 3);
  misfit.least = BeliefUpdate(scene, counted, draws, progress).least_misfit(belief, misfit.bound);
  return misfit;
}

double gap_ratio_misfit(const TuningModel& scene, std::span<const LearnedShot> shots, const Belief& belief, double enough,
                        Draws& draws, const Progress& progress) {
  if (!scene.gap_ratio_coordinate(belief.mode)) return 0;
  BeliefUpdate update(scene, shots, draws, progress);
  const double least = std::min(update.misfit_of(belief.mode), update.misfit_from(belief.mode));
  update.pin_gap_ratio();
  return update.least_misfit(belief, least + enough) - least;
}

Belief updated_belief(const TuningModel& scene, std::span<const LearnedShot> shots, const Belief& last, Draws& draws,
                      const Progress& progress) {
  return BeliefUpdate(scene, shots, draws, progress).updated_belief(last);
}

}  // namespace softland
