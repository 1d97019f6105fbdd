// The belief about a device from its records: devices with weights, in the standard normal coordinates z of TunedScene.
//
//   -ln p(z | records) = |z|^2 / 2 + sum over records L(record, closing of the device z under its shot) + const
//
//   first touch  r = (t - t_record) / s,  s^2 = edge_error^2 + (g / 2000 v)^2 + (T_0 / 3400)^2,  L = r^2 / 2, linear beyond 6;
//                v speed of the first touch: g / 2000 stands for the error of the model, and the last term for its times
//   edges        open time u within 0.09, 0.3 and 0.9 T_0 of the first touch,
//                L = 1.2 ln(1 + q^2 / 3),  q = (u - u_record) / (0.0045 T_0 + 0.2 max(u, u_record)): the closing after its first
//                rebounds is chaotic, and no edge of it is matched to another
//   count        if edges are not known: the same for the number of visible openings, (1 + 0.3 max) apart
//   loudness     ln loudness is a + b ln v_max, one a and one b in [0.5, 2] for all records, with an error of 0.3
//
// T_0 is the closing time of the plain step, g the contact gap. The errors that depend on the scene were found to work on
// mem-gold, as shares of its scales.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "studies/inverse/tuned_scene.h"

namespace softland {

/// A shot that was fired, and its record.
struct LearnedShot {
  std::vector<Waveform> waveforms;  ///< commanded waveforms, in the order of Switch::drives() [V]
  ContactRecord record;
};

/// A sequence of random numbers, standard normal or uniform in (0, 1): each is a function of the seed and of its position.
class Draws {
 public:
  Draws(std::uint64_t seed, std::uint64_t first) : seed_(seed), next_(first) {}
  [[nodiscard]] double normal();
  [[nodiscard]] double uniform();
  [[nodiscard]] Eigen::VectorXd normals(Eigen::Index size);

 private:
  std::uint64_t seed_, next_;
};

/// The likelihood of records, by the terms above.
class Likelihood {
 public:
  /// Keeps references.
  Likelihood(const TunedScene& scene, std::span<const LearnedShot> shots) : scene_(scene), shots_(shots) {}
  /// r of the first touch in one shot; +-30 if only one of the two touches, 0 if neither does.
  [[nodiscard]] double touch_residual(const ImaginedClosing& closing, const ContactRecord& record) const;
  /// The log likelihood of all records, for the closings of one device under all shots in their order.
  [[nodiscard]] double of(std::span<const ImaginedClosing> closings) const;
  /// Standard deviation of a recorded first touch at this speed [s].
  [[nodiscard]] double touch_deviation(double speed) const;

 private:
  [[nodiscard]] double of_record(const ImaginedClosing& closing, const ContactRecord& record) const;
  [[nodiscard]] double of_loudness(std::span<const ImaginedClosing> closings) const;

  const TunedScene& scene_;
  std::span<const LearnedShot> shots_;
};

struct Belief {
  std::vector<Eigen::VectorXd> points;  ///< z of the devices
  std::vector<double> weights;          ///< their sum is 1
  Eigen::VectorXd mean, mode;           ///< mean and mode of z
  Eigen::MatrixXd covariance;           ///< covariance of z
  double effective_devices = 0;         ///< 1 / (sum of the squared weights), by the weights of the likelihood itself
  double log_posterior = 0;             ///< log posterior of the mode, without its constant

  /// The prior: draws of the standard normal distribution.
  [[nodiscard]] static Belief prior(Eigen::Index size, Draws& draws);
  /// Draws `count` points in proportion to their weights (systematic resampling, Kitagawa 1996), in random order.
  [[nodiscard]] std::vector<Eigen::VectorXd> resampled(std::size_t count, Draws& draws) const;
};

/// Fits the first touches of these shots alone, from the belief and from devices all over the spread, until one of them is
/// within the bound. One record whose contact stayed open is left out: a wire that comes off once says nothing about the
/// device.
///
/// Closings that are linear in z give touches y that are normal, with the covariance J J^T + I in units of their errors. The
/// least |z|^2 + |r|^2 is then y^T (J J^T + I)^-1 y, chi-square with as many degrees of freedom as records. The deviation of a
/// single peak does not enter: the least is over all peaks. The bound is its quantile by E. B. Wilson & M. M. Hilferty, Proc.
/// Natl. Acad. Sci. 17 (1931) 684. Throws Interrupted.
[[nodiscard]] TouchMisfit touch_misfit(const TunedScene& scene, std::span<const LearnedShot> shots, const Belief& belief,
                                       Draws& draws, const Watch& watch = {});

/// Returns the rise of the least |z|^2 + sum of r^2 if the gaps have the ratio of the scene; 0 if the spread has no such ratio.
/// The rise is chi-square with one degree of freedom on devices of the spread. The search over all peaks ends when the rise is
/// below `enough`. Throws Interrupted.
[[nodiscard]] double gap_ratio_misfit(const TunedScene& scene, std::span<const LearnedShot> shots, const Belief& belief,
                                      double enough, Draws& draws, const Watch& watch = {});

/// Returns the belief after these shots, at least one. Some of the searches begin at `last`. Throws Interrupted.
[[nodiscard]] Belief learned(const TunedScene& scene, std::span<const LearnedShot> shots, const Belief& last, Draws& draws,
                             const Watch& watch = {});

}  // namespace softland
