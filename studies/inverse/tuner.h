// Tunes a waveform on one device, closing after closing, from the state of its contact alone. Every closing is open loop.
//
// The state of knowledge about the device is a belief: weighted devices of the scene's spread (or the assumed one,
// config/assumed_spread.h). They also differ in gain of the sources, viscosity of the film, stiffness of the contact, and the
// ratio of contact to electrode gap. The time by which their records begin late differs too, if a scene has such a thing. Two
// steps follow every closing.
//
//   1. the belief is learned anew from all records: Levenberg-Marquardt on the touch times from many starts, then rounds of
//      weighted samples with the likelihood of the whole record (belief.h);
//   2. the waveform with the least expected cost over the belief is searched (proposal.h), its hold level in the device's own
//      unit of volts from the second closing on.
//
// The cost of a closing has these symbols: B highest rebound, t_i first touch, T_0 that of the plain step on the nominal
// device, h significant rebound, g contact gap, m = sqrt(h g / 20):
//
//   [B / (B + m) + B / (B + h)] / 2 + 10 B / g + 0.34 max(0, t_i / T_0 - 0.88)       3 if it does not close
//
// A quasi-static approach pays for its permanent contact time t_p, beside that of the plain step, T_p: at most 0.02 max(0, t_p
// / T_p - 1). If a drive can carry the switch to its contact, the approach of the cheaper recipe is tuned.
// A quasi-static approach pays at most 0.02 max(0, t_p / T_p - 1) for its permanent contact time t_p, beside that of the plain
// step, T_p. If a drive can carry the switch to its contact, the approach of the cheaper recipe is tuned.
//
// No shot leaves the limits of the drivers, or has a level at which more than one in a thousand devices of the belief would
// collapse onto the electrode. After two closings without a bounce, with none expected, the same shot is repeated. Its volts
// then follow the touch time, s <- s [1 - 0.2 (t_i - t_ref) / (dt_i / d ln s)], until it bounces. Then all records but the last
// eight are forgotten.
//
// All numbers depend on scene, options and the pairs of shot and record alone. A tuner that learns a log again, shot by shot,
// reaches the same state, to the bit, whatever the number of jobs.
//
// Source for the task: M. W. Blecke, D. S. Epp, H. Sumali, G. G. Parker, "A simple learning control to eliminate RF-MEMS switch
// bounce", J. Microelectromech. Syst. 18 (2009) 458, who learn a waveform from the state of the contact. The belief is our own
// method.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/choice.h"
#include "base/watch.h"
#include "config/criterion.h"
#include "model/ensemble/fleet.h"
#include "studies/closing/prepared.h"
#include "studies/inverse/contact_record.h"
#include "studies/inverse/wafer.h"
#include "studies/search/search_space.h"
#include "waveforms/waveform.h"

namespace softland {

/// How the tuned waveforms close the switch: by which family of search_space.h.
enum class Approach {
  fast,          ///< a drive throws it to its contact and catches it there
  quasi_static,  ///< a drive carries it slowly through stable equilibria
};
inline constexpr auto approaches =
    std::to_array<Named<Approach>>({{Approach::fast, "catch"}, {Approach::quasi_static, "quasi-static"}});
static_assert(is_complete<approaches>());

/// A waveform that proposals begin from, searched once for a scene.
struct Recipe {
  Approach approach = Approach::fast;
  std::vector<double> x;       ///< numbers of its shape
  double volts = 1, time = 1;  ///< units of the devices that it was searched for, over those of the nominal one
  double cost = 0;             ///< expected cost over these devices
};

struct TunerOptions {
  Actuator actuator = Actuator::electrostatic;  ///< actuator whose drives are shaped
  std::uint64_t seed = 1;
  int jobs = 1;  ///< threads; does not change the results
  LaboratoryErrors laboratory = {};
  int most_recipes = 1;  ///< number of units of volts for which recipes are searched, 1 to 5
  double effort = 1;     ///< evaluations of every search, over the usual
  /// A condition on the first touch, which must come before or by its limit; none: no bound.
  std::optional<Criterion> touch = {};
  /// Devices of the same wafer that were tuned before: the prior of this one.
  std::vector<TunedBelief> wafer = {};
  /// Result of Tuner::recipes() for this scene and these options; empty: recipes are searched.
  std::vector<Recipe> recipes = {};
  Vectors vectors = vectors_in_use();
};

/// Throws InvalidInput for options out of range.
void check(const TunerOptions& options);

/// The belief's prediction of a shot.
struct PredictedRecord {
  double touches = 0;         ///< share of the devices that touch
  double touch_median = 0;    ///< first touch [s]; NaN if none touches
  double touch_low = 0;       ///< early first touch, at the 2.5 % of normal ones, errors included [s]
  double touch_high = 0;      ///< late first touch, at their 97.5 % [s]
  double bounces = 0;         ///< share of the devices with a visible opening
  double rebound_median = 0;  ///< highest rebound [m]
  double rebound_high = 0;    ///< its 95th percentile [m]
};

struct TunerShot {
  int number = 0;                        ///< counted from 1
  std::vector<Waveform> waveforms = {};  ///< commanded waveforms, in the order of Switch::drives() [V]
  double hold_time = 0;                  ///< time to hold and record the last levels after the last breakpoint [s]
  double expected_cost = 0;              ///< mean over the belief, see above
  PredictedRecord predicted = {};
};

/// The time by which records begin late, if it is above 0 [s].
inline constexpr const char* trigger_delay_name = "trigger delay";

/// A quantity of the device, and the belief about it.
struct BelievedQuantity {
  std::string name;                            ///< the name of its entry in the spread, or trigger_delay_name
  std::string unit;                            ///< SI unit; empty for a factor
  double prior_mean = 0, prior_deviation = 0;  ///< factors of the scene's value, or in the unit
  double mean = 0, deviation = 0;
};

/// The difference of recorded first touches from those of all devices of the spread.
struct TouchMisfit {
  double least = 0;         ///< |z|^2 + the sum of r^2 over the records (belief.h), for the device z that fits them best
  double bound = 0;         ///< one device of the spread in a thousand has a larger `least`
  std::size_t records = 0;  ///< number of records that count
  [[nodiscard]] bool is_beyond() const { return least > bound; }
};

struct BeliefSummary {
  std::vector<BelievedQuantity> quantities;
  /// Contact gap over electrode gap, over that of the scene, if the devices of the spread have that of the scene.
  std::optional<BelievedQuantity> gap_ratio = {};
  double effective_devices = 0;         ///< effective number of weighted samples: 1 over the sum of the squares of the weights
  TouchMisfit touch_misfit = {};        ///< misfit of the records that are learned from
  std::vector<std::string> correlated;  ///< sentences about quantities that the records do not separate
  /// Belief for tuning another device of the wafer, in standard normal coordinates of the spread; the last one is the delay.
  TunedBelief coordinates = {};
};

class Tuner {
 public:
  /// Makes the scene ready and searches the recipes of its nominal device: seconds in lanes. Throws InvalidInput for a scene
  /// that cannot be tuned (no contact, no drive to shape, options out of range), for a wafer of other quantities and for
  /// recipes of other shapes. Throws Interrupted if `watch` asks to stop.
  Tuner(const SceneFile& file, const TunerOptions& options, const Watch& watch = {});
  ~Tuner();
  Tuner(Tuner&&) noexcept;
  Tuner& operator=(Tuner&&) noexcept;

  /// Returns a tuner of the same scene before its first closing, for the next device.
  [[nodiscard]] Tuner restarted() const;

  /// The scene that the belief is about: nominal device, drives and limits.
  [[nodiscard]] const PreparedScene& scene() const;
  /// The recipes; that of the nominal device comes first.
  [[nodiscard]] const std::vector<Recipe>& recipes() const;
  [[nodiscard]] Approach approach() const;
  /// The first touch of the plain step on the nominal device [s].
  [[nodiscard]] double step_closing_time() const;
  /// Permanent contact time of the plain step on the nominal device; NaN unless the approach is quasi-static [s].
  [[nodiscard]] double step_permanent_contact() const;
  /// True if the scene has no [spread] and one was assumed.
  [[nodiscard]] bool spread_is_assumed() const;

  /// The next shot to fire; the same until a record is learned.
  [[nodiscard]] const TunerShot& next() const;
  /// Learns the record of next(), and proposes the shot after it. A record with an error is not a closing: the same waveform is
  /// proposed again, under the next number. Throws InvalidInput for an invalid record, Interrupted if `watch` asks to stop:
  /// nothing is learned then.
  void learn(const ContactRecord& record, const Watch& watch = {});

  /// Number of closings that were learned.
  [[nodiscard]] int closings() const;
  [[nodiscard]] BeliefSummary belief() const;
  /// The best known waveform, with its prediction: one that did not bounce when it was fired last, unless the next one is
  /// expected to be clearly better. While a shot is repeated it is the last one that did not bounce.
  [[nodiscard]] const TunerShot& kept() const;
  /// True if the last closing was that of the waveform kept.
  [[nodiscard]] bool was_kept_last() const;
  /// Proposes the waveform kept if it was fired before. A waveform that landed some closings ago may not land under drifting
  /// sources.
  void fire_kept_again();
  /// Number of closings without a bounce up to the last one, in a row.
  [[nodiscard]] int bounce_free_in_a_row() const;
  static constexpr int enough_in_a_row = 5;
  [[nodiscard]] bool is_done() const { return bounce_free_in_a_row() >= enough_in_a_row; }
  /// Differences of the recorded first touch of each closing from the prediction, in standard deviations. 0 if the belief had
  /// too few devices to predict, or the contact closed or stayed open against the prediction. Repeated shots are left out as
  /// long as they do not bounce.
  [[nodiscard]] const std::vector<double>& surprises() const;
  /// Number of closings that bounced for longer than an error of the model explains, while at most one in twenty devices of the
  /// belief did before the record was seen.
  [[nodiscard]] int unexpected_bounces() const;
  /// Says why the device does not match the scene; none if it may match. No device of the spread touches as recorded, or
  /// records bounced against the prediction, or the gaps have another ratio than in the scene.
  [[nodiscard]] std::optional<std::string> broken_assumption() const;

 private:
  struct Setting;
  struct State;
  Tuner(std::shared_ptr<const Setting> setting, const Watch& watch);

  std::unique_ptr<State> state_;
};

}  // namespace softland
