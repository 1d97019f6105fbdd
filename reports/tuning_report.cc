#include "reports/tuning_report.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/require.h"
#include "reports/study_members.h"
#include "reports/tuning_lines.h"
#include "waveforms/export.h"

namespace softland {
namespace {

using nlohmann::json;

const TuningReport::Closing* recorded(const TuningReport& report, int shot) {
  const auto found = std::find_if(report.closings.begin(), report.closings.end(),
                                  [&](const TuningReport::Closing& one) { return one.shot.number == shot; });
  return found == report.closings.end() ? nullptr : &*found;
}

json normal_json(const NormalBelief& belief) {
  json covariance = json::array();
  for (Eigen::Index k = 0; k < belief.covariance.rows(); ++k)
    covariance.push_back(std::vector<double>(belief.covariance.row(k).begin(), belief.covariance.row(k).end()));
  return {{"mean", std::vector<double>(belief.mean.begin(), belief.mean.end())}, {"covariance", std::move(covariance)}};
}

NormalBelief normal_of(const json& written) {
  const auto mean = written.at("mean").get<std::vector<double>>();
  const auto rows = written.at("covariance").get<std::vector<std::vector<double>>>();
  const auto size = static_cast<Eigen::Index>(mean.size());
  NormalBelief belief{.mean = Eigen::Map<const Eigen::VectorXd>(mean.data(), size), .covariance = Eigen::MatrixXd(size, size)};
  require(rows.size() == mean.size(), "its belief has as many rows as coordinates");
  for (Eigen::Index k = 0; k < size; ++k) {
    const std::vector<double>& row = rows[static_cast<std::size_t>(k)];
    require(row.size() == mean.size(), "its belief has as many columns as coordinates");
    belief.covariance.row(k) = Eigen::Map<const Eigen::RowVectorXd>(row.data(), size);
  }
  return belief;
}

}  // namespace

bool TuningReport::was_bounce_free(int shot) const {
  const Closing* const one = recorded(*this, shot);
  return one != nullptr && is_bounce_free(one->record);
}

bool TuningReport::ever_bounce_free() const {
  return std::any_of(closings.begin(), closings.end(), [](const Closing& one) { return is_bounce_free(one.record); });
}

namespace {

// Returns the last closing of a tuning with a contact record; null if no closing has a record.
template <class Closing>
const Closing* last_record(const std::vector<Closing>& closings) {
  const auto last = std::find_if(closings.rbegin(), closings.rend(), [](const auto& one) { return one.record.error.empty(); });
  return last == closings.rend() ? nullptr : &*last;
}

}  // namespace

bool TuningReport::ended_bounce_free() const {
  const Closing* const last = last_record(closings);
  return last != nullptr && last->shot.number == kept.number && is_bounce_free(last->record);
}

TunerShot kept_shot(const Tuner& tuner, const std::vector<TunedClosing>& closings, TuningEnd end) {
  const TunedClosing* const last = last_record(closings);
  const bool landed = end != TuningEnd::under_way && last != nullptr && is_bounce_free(last->record) && !tuner.was_kept_last();
  return landed ? last->shot : tuner.kept();
}

TuningReport::Shot shot_of(const PreparedScene& scene, const TunerShot& shot) {
  TuningReport::Shot found{
      .number = shot.number, .hold_time = shot.hold_time, .expected_cost = shot.expected_cost, .predicted = shot.predicted};
  const std::vector<std::string> names = scene.drive_names();
  for (std::size_t k = 0; k < names.size() && k < shot.waveforms.size(); ++k) {
    if (names[k] == dispersion_drive) continue;
    const Signal commanded = scene.commanded(k, shot.waveforms[k]);
    for (const auto& [time, voltage] : polyline(commanded, commanded.pieces().back().begin, 1e-4 * commanded.peak(), 0))
      found.waveforms[names[k]].push_back({time, voltage});
  }
  return found;
}

TuningReport tuning_report(const Tuner& tuner, const std::vector<TunedClosing>& closings, const TunerOptions& options,
                           TuningEnd end, const std::string& command) {
  const PreparedScene& scene = tuner.scene();
  TuningReport report{.origin = whole_origin_of("tune", scene, command),
                      .next = shot_of(scene, tuner.next()),
                      .kept = shot_of(scene, kept_shot(tuner, closings, end)),
                      .belief = tuner.belief(),
                      .broken_assumption = tuner.broken_assumption(),
                      .step_closing_time = tuner.step_closing_time(),
                      .approach = tuner.approach(),
                      .step_permanent_contact = tuner.step_permanent_contact(),
                      .bounce_free_in_a_row = tuner.bounce_free_in_a_row(),
                      .spread_assumed = tuner.spread_is_assumed(),
                      .seed = options.seed,
                      .tolerance = scene.tolerance,
                      .end = end};
  for (const TunedClosing& one : closings) report.closings.push_back({.shot = shot_of(scene, one.shot), .record = one.record});
  return report;
}

// The JSON of a ContactRecord, as record_json() writes it.
struct ContactRecordJson {};
void members(internal::Archive& a, ContactRecordJson&) {
  a("shot", 0, "number of the shot");
  a("edges_s", std::vector<std::array<double, 2>>{}, "time of each edge, and 1 (closes) or 0 (opens)");
  a("closing_time_s", 0.0, "first contact time, instead of the edges");
  a("bounce_count", 0, "number of openings, beside the closing time");
  a("loudness", 0.0, "loudness of the closing, if it was measured");
  a("error", std::string(), "why there is no record");
}

// The JSON of a TunedBelief, as belief_json() writes it.
struct NormalBeliefJson {};
void members(internal::Archive& a, NormalBeliefJson&) {
  a("mean", std::vector<double>{}, "mean of each coordinate");
  a("covariance", std::vector<std::vector<double>>{}, "covariance of the coordinates");
}
struct TunedBeliefJson {};
void members(internal::Archive& a, TunedBeliefJson&) {
  a("prior", NormalBeliefJson{}, "before the records");
  a("posterior", NormalBeliefJson{}, "after the records");
}

void members(internal::Archive& a, PredictedRecord& predicted) {
  a("touches", predicted.touches, "share of the believed devices that touch");
  a("touch_median_s", predicted.touch_median, "median of the first contact time");
  a("touch_low_s", predicted.touch_low, "2.5th percentile of the first contact time");
  a("touch_high_s", predicted.touch_high, "97.5th percentile of the first contact time");
  a("bounces", predicted.bounces, "share of the believed devices with a recorded opening");
  a("rebound_median_m", predicted.rebound_median, "median of the highest rebound");
  a("rebound_95_m", predicted.rebound_high, "95th percentile of the highest rebound");
}

void members(internal::Archive& a, TuningReport::Shot& shot) {
  a("shot", shot.number, "number of the shot");
  a("waveforms", shot.waveforms, "waveform of each drive: time [s], voltage [V]");
  a("hold_s", shot.hold_time, "time for which the last levels are held");
  a("expected_cost", shot.expected_cost, "expected cost of the closing");
  a("predicted", shot.predicted, "prediction for the closing");
}

void members(internal::Archive& a, TuningReport::Closing& closing) {
  members(a, closing.shot);
  a.custom(
      "record", closing.record, [&](const ContactRecord& record) { return record_json(closing.shot.number, record); },
      [&](const json& line) { return read_record(line, closing.shot.number); },
      internal::Like<ContactRecordJson>{"record of the contact"});
  a.derived("bounce_free", is_bounce_free(closing.record), "whether the record has no opening");
}

void members(internal::Archive& a, BelievedQuantity& quantity) {
  a("name", quantity.name, "name of the quantity");
  a("unit", quantity.unit, "its unit; empty for a factor");
  a("prior_mean", quantity.prior_mean, "mean before the records");
  a("prior_deviation", quantity.prior_deviation, "standard deviation before the records");
  a("mean", quantity.mean, "mean after the records");
  a("deviation", quantity.deviation, "standard deviation after the records");
}

void members(internal::Archive& a, TouchMisfit& misfit) {
  a("least", misfit.least, "misfit of the device that fits the records best");
  a("bound", misfit.bound, "misfit that one in a thousand devices of [spread] exceeds");
  a("records", misfit.records, "number of records in the misfit");
}

void members(internal::Archive& a, BeliefSummary& belief) {
  a("quantities", belief.quantities, "quantities of the device");
  a("gap_ratio", internal::OrNull{belief.gap_ratio}, "ratio of contact gap to electrode gap, relative to the scene");
  a("effective_devices", belief.effective_devices, "effective number of devices in the belief");
  a("touch_misfit", belief.touch_misfit, "misfit of the first contact times");
  a("correlated", belief.correlated, "quantities that the records do not separate, in words");
  a.custom("coordinates", belief.coordinates, belief_json, read_belief,
           internal::Like<TunedBeliefJson>{"belief for tuning another device, in coordinates of [spread]"});
}

void members(internal::Archive& a, TuningReport& report) {
  members(a, report.origin);
  a("status", internal::Chosen{report.end, tuning_ends}, "how the tuning ended");
  a.derived("title", title_of(report.origin), "title of the scene");
  a("closings", report.closings, "closings so far");
  a("bounce_free_in_a_row", report.bounce_free_in_a_row, "number of bounce-free closings at the end");
  a.object(
      "best",
      [&](auto& best) {
        members(best, report.kept);
        best.derived("bounce_free", report.was_bounce_free(report.kept.number), "whether its closing had no opening");
        best.derived("landed_last", report.ended_bounce_free(), "whether the last closing used it and was bounce-free");
      },
      "shot with the best waveform");
  a("next", report.next, "shot that would come next");
  a("belief", report.belief, "belief about the device");
  a("broken_assumption", internal::OrNull{report.broken_assumption}, "sentence on a device that does not match the model");
  a("approach", internal::Chosen{report.approach, approaches}, "approach to the contact");
  a("step_closing_time_s", report.step_closing_time, "first contact time of the plain step on the nominal device");
  a("step_permanent_contact_time_s", report.step_permanent_contact, "its time to permanent contact; for a quasi-static approach");
  a("spread_assumed", report.spread_assumed, "whether the scene has no [spread] and the usual one was assumed");
  a("seed", report.seed, "seed of the believed devices");
  a("tolerance", report.tolerance, "relative tolerance of the integrator");
  if (a.has(!report.setting.is_null())) a("tuning", report.setting, "settings that a continued tuning must share");
}

json json_of(const TuningReport& report) { return internal::record_json(report); }

TuningReport read_tuning(const json& from) {
  TuningReport report = internal::whole_record<TuningReport>(from);
  for (const TuningReport::Shot* shot : {&report.kept, &report.next}) {
    const bool is_drawn = std::ranges::all_of(shot->waveforms, [&](const auto& one) {
      return !one.second.empty() && report.kept.waveforms.contains(one.first) && report.next.waveforms.contains(one.first);
    });
    require(is_drawn, "\"best\" and \"next\" must have the same drives");
  }
  return report;
}

TunedBelief read_belief(const json& coordinates) {
  try {
    return {.prior = normal_of(coordinates.at("prior")), .posterior = normal_of(coordinates.at("posterior"))};
  } catch (const json::exception&) {
    throw InvalidInput("holds no belief about a device that was tuned");
  }
}

json belief_json(const TunedBelief& belief) {
  return {{"prior", normal_json(belief.prior)}, {"posterior", normal_json(belief.posterior)}};
}

TunedBelief tuned_belief(const json& written) {
  return read_belief(internal::value_at(internal::value_at(written, "belief"), "coordinates"));
}

}  // namespace softland
