// Tunes a waveform on one device, one closing after another, from the recorded state of its contact alone. Every closing is
// open loop.
//
// The belief about the device is a set of weighted devices of the scene's [spread] (or the assumed spread,
// config/assumed_spread.h). The devices also differ in gain of the sources, viscosity of the film, stiffness of the contact,
// and the ratio of contact to electrode gap, as far as the scene has these quantities, and in the delay of the record (trigger
// delay). Two steps follow every closing.
//
//   1. The posterior of all records is computed anew: Levenberg-Marquardt on the first contact times from many starts, then
//      rounds of weighted samples with the likelihood of the whole record (belief.h).
//   2. The waveform with the least expected cost over the belief is searched (proposal.h). From the second closing on the hold
//      level of the waveform scales with the device's own unit of volts.
//
// The cost of a closing is
//
//   [B / (B + m) + B / (B + h)] / 2 + 10 B / g + 0.34 max(0, t_i / T_0 - 0.88),  or 3 if the switch does not close
//
// with B highest rebound, t_i first contact, T_0 first contact of the plain step on the nominal device, h significant rebound,
// g contact gap, m = sqrt(h g / 20). For a quasi-static approach a cost of the permanent contact time t_p is added, at most
// 0.02 max(0, t_p / T_p - 1), where T_p is that of the plain step. If a drive can move the switch to its contact through stable
// equilibria, the approach of the recipe with the lower cost is tuned.
//
// No shot exceeds the limits of the voltage sources, or has a level at which more than one in a thousand devices of the belief
// would collapse onto the electrode. The same shot is repeated after two closings without a bounce, if no bounce is expected.
// Its voltages are then multiplied by a factor s that corrects t_i, s <- s [1 - 0.2 (t_i - t_ref) / (dt_i / d ln s)], until the
// device bounces; t_ref is the mean of t_i in the first repetitions. Then all records but the last eight are dropped.
//
// All numbers depend only on scene, options and the pairs of shot and record. A tuner that receives the records of a log again,
// shot by shot, has bit for bit the same state, for any number of jobs.
//
// Source of the task: M. W. Blecke, D. S. Epp, H. Sumali, G. G. Parker, "A simple learning control to eliminate RF-MEMS switch
// bounce", J. Microelectromech. Syst. 18 (2009) 458, who adapt a waveform to the state of the contact. The belief is our own
// method.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/choice.h"
#include "base/progress.h"
#include "config/condition.h"
#include "model/ensemble/ensemble_closings.h"
#include "studies/closing/prepared.h"
#include "studies/inverse/contact_record.h"
#include "studies/inverse/wafer.h"
#include "studies/search/search_space.h"
#include "waveforms/waveform.h"

namespace softland {

/// The kind of motion by which the tuned waveforms close the switch.
enum class Approach {
  fast,          ///< a drive accelerates the beam towards the contact and brakes it before contact
  quasi_static,  ///< a drive moves the beam slowly through stable equilibria
};
inline constexpr auto approaches =
    std::to_array<Named<Approach>>({{Approach::fast, "catch"}, {Approach::quasi_static, "quasi-static"}});
static_assert(is_complete<approaches>());

/// A waveform from which searches of a tuning start, optimised once for a scene.
struct CandidateWaveform {
  Approach approach = Approach::fast;
  std::vector<double> x;  ///< parameters of the candidate's waveform: the variables of TuningSpace
  /// Factors of voltage and time, relative to the nominal device, of the devices for which the waveform was optimised.
  double volts = 1, time = 1;
  double cost = 0;  ///< expected cost of closings over the devices for which the waveform was optimised
};

struct TunerOptions {
  Actuator actuator = Actuator::electrostatic;  ///< actuator whose drives get tuned waveforms
  std::uint64_t seed = 1;
  int jobs = 1;  ///< number of threads; does not change the results
  LaboratoryErrors laboratory = {};
  /// Number of candidate waveforms (recipes) to search, each for devices with another unit of voltage, 1 to 5.
  int most_recipes = 1;
  double effort = 1;  ///< factor on the usual number of evaluations of every search in the tuning
  /// Limit of the first contact time of the tuned waveform (before a time, or by a time at the latest); none for no limit.
  std::optional<Condition> touch = {};
  /// Beliefs about (estimates of) devices of the same wafer that were tuned before. They determine the prior of the device to
  /// tune.
  std::vector<TunedBelief> wafer = {};
  /// Candidate waveforms (recipes) that Tuner::recipes() returned for the same scene and options; if empty, they are searched.
  std::vector<CandidateWaveform> recipes = {};
  Vectors vectors = vectors_in_use();
};

/// Throws InvalidInput for options of a tuning that are out of range.
void check(const TunerOptions& options);

/// The prediction that a belief makes for the contact record of a shot.
struct PredictedRecord {
  double touches = 0;       ///< share of the devices of the belief that reach their contact
  double touch_median = 0;  ///< median over the devices of the time of first contact [s]; NaN if no device reaches contact
  /// 2.5th percentile of the time of first contact, from a normal distribution with measurement errors [s].
  double touch_low = 0;
  /// 97.5th percentile of the time of first contact, from a normal distribution with measurement errors [s].
  double touch_high = 0;
  double bounces = 0;         ///< share of the devices of the belief with an opening that is long enough to be recorded
  double rebound_median = 0;  ///< median over the devices of the highest rebound [m]
  double rebound_high = 0;    ///< 95th percentile over the devices of the highest rebound [m]
};

struct TunerShot {
  int number = 0;                        ///< number of the shot, counted from 1
  std::vector<Waveform> waveforms = {};  ///< commanded waveforms of the shot, in the order of Switch::drives() [V]
  double hold_time = 0;  ///< time for which the last levels are held and the contact is recorded, after the last breakpoint [s]
  double expected_cost = 0;  ///< mean cost of the shot's closing over the devices of the belief
  PredictedRecord predicted = {};
};

/// Name of the delay of contact records behind the drives, as a quantity in a belief.
inline constexpr const char* trigger_delay_name = "trigger delay";

/// A quantity of the tuned device, with its mean and deviation before and after the contact records.
struct BelievedQuantity {
  std::string name;  ///< name of the quantity's entry in [spread], or trigger_delay_name
  std::string unit;  ///< SI unit of the quantity; empty for a factor
  /// Mean and deviation of the quantity before the records: factors of the scene's value, or values in `unit`.
  double prior_mean = 0, prior_deviation = 0;
  double mean = 0, deviation = 0;
};

/// The misfit of the recorded first contact times to the devices of [spread].
struct TouchMisfit {
  /// Least |z|^2 + sum of r^2 over the records (belief.h): the value of the device z that fits the records best.
  double least = 0;
  double bound = 0;         ///< value that |z|^2 + sum of r^2 exceeds for one in a thousand devices of [spread]
  std::size_t records = 0;  ///< number of contact records in the misfit
  [[nodiscard]] bool is_beyond() const { return least > bound; }
};

struct BeliefSummary {
  std::vector<BelievedQuantity> quantities;
  /// Ratio of contact gap to electrode gap, relative to the scene, if all devices of [spread] have the same ratio.
  std::optional<BelievedQuantity> gap_ratio = {};
  double effective_devices = 0;         ///< effective number of devices in the belief: 1 over the sum of the squared weights
  TouchMisfit touch_misfit = {};        ///< misfit of the contact records from which the belief was computed
  std::vector<std::string> correlated;  ///< sentences about quantities of the device that the contact records do not separate
  /// Belief for tuning another device of the wafer, in standard normal coordinates of [spread], and the trigger delay as the
  /// last coordinate.
  TunedBelief coordinates = {};
};

class Tuner {
 public:
  /// Prepares the scene and searches the recipes (candidate waveforms) of its nominal device, which takes seconds in SIMD
  /// lanes. Throws InvalidInput for a scene that cannot be tuned (no contact, no drive to vary, options out of range), for
  /// wafer beliefs about other quantities, and for recipes of other waveform shapes. Throws Interrupted if `progress` asks to
  /// stop.
  Tuner(const SceneFile& file, const TunerOptions& options, const Progress& progress = {});
  ~Tuner();
  Tuner(Tuner&&) noexcept;
  Tuner& operator=(Tuner&&) noexcept;

  /// Returns a tuner of the same scene for the next device, in the state before its first closing.
  [[nodiscard]] Tuner restarted() const;

  /// Returns the scene on which the belief is based, with nominal device, drives and limits.
  [[nodiscard]] const PreparedScene& scene() const;
  /// Returns the recipes (candidate waveforms from which searches start); the recipe of the nominal device comes first.
  [[nodiscard]] const std::vector<CandidateWaveform>& recipes() const;
  [[nodiscard]] Approach approach() const;
  /// Returns the time of first contact under the plain step on the nominal device [s].
  [[nodiscard]] double step_closing_time() const;
  /// Returns the permanent contact time under the plain step on the nominal device [s]; NaN unless the approach is
  /// quasi-static.
  [[nodiscard]] double step_permanent_contact() const;
  /// True if the scene has no [spread] and a spread was assumed.
  [[nodiscard]] bool spread_is_assumed() const;

  /// Returns the next shot, the voltages for the next closing of the device. The shot does not change until learn() adds a
  /// record.
  [[nodiscard]] const TunerShot& next() const;
  /// Adds the record of next() to the belief, and proposes the following shot. After a record with an error the same waveform
  /// is proposed again, under the next number. Throws InvalidInput for an invalid record, and Interrupted if `progress` asks to
  /// stop; the record is then not added.
  void learn(const ContactRecord& record, const Progress& progress = {});

  /// Returns the number of closings whose contact records were added.
  [[nodiscard]] int closings() const;
  [[nodiscard]] BeliefSummary belief() const;
  /// Returns the best shot so far, with its prediction. This is a shot whose waveform did not bounce when last applied, unless
  /// the next waveform is expected to be clearly better. While a shot is repeated, returns the last shot that did not bounce.
  [[nodiscard]] const TunerShot& kept() const;
  /// True if the last closing had the waveform of the best shot so far, kept().
  [[nodiscard]] bool was_kept_last() const;
  /// Proposes the waveform of kept() again if it was applied before: a waveform that closed without a bounce some closings ago
  /// may bounce after a drift of the sources.
  void fire_kept_again();
  /// Returns the number of successive closings without a bounce, up to and including the last closing.
  [[nodiscard]] int bounce_free_in_a_row() const;
  static constexpr int enough_in_a_row = 5;
  [[nodiscard]] bool is_done() const { return bounce_free_in_a_row() >= enough_in_a_row; }
  /// Returns the difference between recorded and predicted time of first contact for each closing, in standard deviations. The
  /// difference is 0 if the belief had too few devices to predict, and if the contact closed or stayed open against the
  /// prediction. Repeated shots are left out until they bounce.
  [[nodiscard]] const std::vector<double>& surprises() const;
  /// Returns the number of closings with a bounce that is too long for an error of the model, and that at most one in twenty
  /// devices of the belief predicted.
  [[nodiscard]] int unexpected_bounces() const;
  /// Returns the reason why the device does not match the model; none if it may match. Reasons are: no device of [spread]
  /// closes at the recorded times, closings bounced although no bounce was predicted, or the ratio of contact gap to electrode
  /// gap is not that of the scene.
  [[nodiscard]] std::optional<std::string> broken_assumption() const;

 private:
  struct Setting;
  struct State;
  Tuner(std::shared_ptr<const Setting> setting, const Progress& progress);

  std::unique_ptr<State> state_;
};

}  // namespace softland
