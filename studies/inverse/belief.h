// The belief about a device, a probability distribution after its records: a set of devices with weights, in the standard
// normal coordinates z of TuningModel. The belief is the posterior of studies/inverse/posterior.h with these terms:
//
//   -ln p(z | records) = |z|^2 / 2 + sum over records L(record, closing of the device z in the same shot) + const
//
// with t, u, v of the simulated closing, and t_record, u_record of the contact record:
//
//   first touch  r = (t - t_record) / s, t time of first contact, s^2 = edge_error^2 + (g / 2000 v)^2 + (T_0 / 3400)^2,
//                v impact velocity: g / 2000 is the error of the model in position, T_0 / 3400 that in time; L = r^2 / 2, but
//                linear in |r| beyond 6
//   edges        u time for which the contact is open within 0.09, 0.3 and 0.9 T_0 after first touch,
//                L = 1.2 ln(1 + q^2 / 3),  q = (u - u_record) / (0.0045 T_0 + 0.2 max(u, u_record)): the closing is chaotic after
//                its first rebounds, so single edges are not compared
//   count        if edges are not known: L as for edges, q the difference of the numbers of openings that are long enough to
//                be recorded, over 1 + 0.3 times the larger number
//   loudness     ln loudness is a + b ln v_max, v_max largest impact velocity, with one a and one b in [0.5, 2] for all
//                records, and an error of 0.3
//
// T_0 is the closing time of the plain step, g the contact gap. The constants were chosen on the scene scenes/mem-gold.toml, as
// shares of these scales.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "studies/inverse/posterior.h"
#include "studies/inverse/tuning_model.h"

namespace softland {

/// A shot (voltages for one closing of the device), and the contact record of its closing.
struct LearnedShot {
  std::vector<Waveform> waveforms;  ///< commanded waveforms of the shot, in the order of Switch::drives() [V]
  ContactRecord record;
};

/// A sequence of random numbers, standard normal or uniform in (0, 1). Each number depends on the seed and on its position
/// alone.
class Draws {
 public:
  Draws(std::uint64_t seed, std::uint64_t first) : seed_(seed), next_(first) {}
  [[nodiscard]] double normal();
  [[nodiscard]] double uniform();
  [[nodiscard]] Eigen::VectorXd normals(Eigen::Index size);

 private:
  std::uint64_t seed_, next_;
};

/// The likelihood of the records of a device, by the terms at the top of belief.h.
class Likelihood {
 public:
  /// Keeps references to `scene` and `shots`, which must outlive this object.
  Likelihood(const TuningModel& scene, std::span<const LearnedShot> shots) : scene_(scene), shots_(shots) {}
  /// Returns the residual r of the first contact in one shot: +-30 if only the record or only the closing has a contact, 0 if
  /// neither has.
  [[nodiscard]] double touch_residual(const PredictedClosing& closing, const ContactRecord& record) const;
  /// Returns the log likelihood of all contact records. `closings` are the closings of one device in all shots, in order.
  [[nodiscard]] double of(std::span<const PredictedClosing> closings) const;
  /// Returns the standard deviation of a recorded time of first contact with this impact velocity [s].
  [[nodiscard]] double touch_deviation(double speed) const;

 private:
  [[nodiscard]] double of_record(const PredictedClosing& closing, const ContactRecord& record) const;
  [[nodiscard]] double of_loudness(std::span<const PredictedClosing> closings) const;

  const TuningModel& scene_;
  std::span<const LearnedShot> shots_;
};

struct Belief {
  std::vector<Eigen::VectorXd> points;  ///< coordinates z of the devices that represent the belief
  std::vector<double> weights;          ///< weights of the devices that represent the belief; their sum is 1
  NormalBelief moments;                 ///< mean and covariance of the coordinates z
  Eigen::VectorXd mode;                 ///< coordinates z of the device with the largest posterior
  /// Effective number of devices, 1 / (sum of the squared weights), for weights by the posterior. If the number is small,
  /// `weights` are more even than the posterior.
  double effective_devices = 0;
  double log_posterior = 0;  ///< log posterior of the device `mode`, without its constant

  /// Returns the prior (the belief about a device before any record): samples of the standard normal distribution.
  [[nodiscard]] static Belief prior(Eigen::Index size, Draws& draws);
  /// Returns `count` devices (coordinates z), sampled in proportion to their weights (systematic resampling, Kitagawa 1996), in
  /// random order.
  [[nodiscard]] std::vector<Eigen::VectorXd> resampled(std::size_t count, Draws& draws) const;
};

/// Fits a device to the times of first contact in these shots alone, starting from the belief and from devices all over
/// [spread], until the misfit of a device is within the bound. If the contact stayed open in exactly one record, this record is
/// left out: a loose wire says nothing about the device.
///
/// If closings are linear in z, the first contact times y are normal, with the covariance J J^T + I in units of their errors.
/// The least |z|^2 + |r|^2 is then y^T (J J^T + I)^-1 y, which is chi-square distributed with as many degrees of freedom as
/// records. The bound is the 0.999 quantile of this distribution by E. B. Wilson & M. M. Hilferty, Proc. Natl. Acad. Sci. 17
/// (1931) 684. The minimum is searched at all peaks of the posterior. Throws Interrupted if `progress` asks to stop.
[[nodiscard]] TouchMisfit touch_misfit(const TuningModel& scene, std::span<const LearnedShot> shots, const Belief& belief,
                                       Draws& draws, const Progress& progress = {});

/// Returns the increase of the least |z|^2 + sum of r^2 if the ratio of contact gap to electrode gap is fixed at that of the
/// scene; 0 if [spread] does not vary this ratio. For devices of [spread] the increase is chi-square distributed with one
/// degree of freedom. The search over all peaks of the posterior ends when the increase is below `enough`. Throws Interrupted
/// if `progress` asks to stop.
[[nodiscard]] double gap_ratio_misfit(const TuningModel& scene, std::span<const LearnedShot> shots, const Belief& belief,
                                      double enough, Draws& draws, const Progress& progress = {});

/// Returns the belief after these shots, at least one. Some of the searches for the new belief start from the belief `last`.
/// Throws Interrupted if `progress` asks to stop.
[[nodiscard]] Belief updated_belief(const TuningModel& scene, std::span<const LearnedShot> shots, const Belief& last,
                                    Draws& draws, const Progress& progress = {});

}  // namespace softland
