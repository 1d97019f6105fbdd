#include "reports/tuning_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "base/content_key.h"
#include "base/read_file.h"
#include "base/require.h"
#include "config/scene.h"
#include "reports/record_file.h"
#include "reports/tuning_log.h"
#include "studies/closing/sent_signals.h"
#include "studies/search/search_setting.h"
#include "waveforms/export.h"

namespace softland {
namespace {

using Json = nlohmann::json;

// Returns the values that all closings of a tuning's log have in common: those of the scene and of the options.
Json origin_of(const SceneFile& file, const TunerOptions& options) {
  return {{"scene", content_key(canonical(file, "scene").text()).hexadecimal()},
          {"actuator", name_of(actuators, options.actuator)},
          {"seed", options.seed},
          {"recipes", options.most_recipes},
          {"effort", options.effort},
          {"edge_error_s", options.laboratory.edge_error},
          {"unseen_s", options.laboratory.unseen},
          {"gain_error", options.laboratory.gain_error},
          {"shot_error", options.laboratory.shot_error},
          {"trigger_delay_s", options.laboratory.trigger_delay},
          {"capacitance_F", options.laboratory.sees_capacitance() ? Json(options.laboratory.capacitance) : Json()},
          {"constrain", options.touch ? Json(options.touch->text) : Json()}};
}

// Reads the belief about a device (its estimated parameters) from the result folder of a completed tuning.
TunedBelief tuned_in(const std::string& folder, const Json& origin) {
  const std::string path = (std::filesystem::path(folder) / "tune.json").string();
  try {
    const Json written = read_line(read_file(path));
    for (const char* key : {"scene", "actuator", "gain_error", "trigger_delay_s"})
      require(written.value(origin_key, Json::object()).value(key, Json()) == origin.at(key),
              [&] { return fmt::format("is a tuning of another {}", key); });
    return tuned_belief(written);
  } catch (const InvalidInput& error) {
    const std::string_view what = error.what();
    throw InvalidRequest(fmt::format("{} {}: {}", requested("wafer"), folder,
                                     what.starts_with(path) ? std::string(what) : path + ": " + error.what()));
  }
}

}  // namespace

struct TuningSession::State {
  SceneFile file;
  TunerOptions options;
  Json origin = {};
  std::filesystem::path log_file = {};
  std::unique_ptr<TuningLog> log = {};
  std::size_t behind = 0;  // number of closings of the log from which the tuner has learned
  // True while the log file has the contact record of the latest closing, but the tuner has not yet learned from it, as after
  // an interruption.
  bool is_on_record = false;
  std::optional<Tuner> tuner = {};
  std::vector<TunedClosing> closings = {};

  void learn(const ContactRecord& record, const Progress& progress) {
    const TunerShot shot = tuner->next();
    tuner->learn(record, progress);
    closings.push_back({.shot = shot, .record = record});
  }
};

TuningSession::TuningSession(SceneFile file, TunerOptions options, std::span<const std::string> wafer)
    : state_(std::make_unique<State>(State{.file = std::move(file), .options = std::move(options)})) {
  State& s = *state_;
  check(s.options);
  s.origin = origin_of(s.file, s.options);
  Json told = Json::array();
  for (const std::string& folder : wafer) {
    s.options.wafer.push_back(tuned_in(folder, s.origin));
    told.push_back(belief_json(s.options.wafer.back()));
  }
  s.origin["wafer"] = told.empty() ? Json() : Json(content_key(told.dump()).hexadecimal());
}

TuningSession::~TuningSession() = default;
TuningSession::TuningSession(TuningSession&&) noexcept = default;
TuningSession& TuningSession::operator=(TuningSession&&) noexcept = default;

std::filesystem::path TuningSession::keep(const std::filesystem::path& log, bool resume) {
  state_->log = std::make_unique<TuningLog>(log, state_->origin, resume);
  state_->log_file = log;
  state_->options.recipes = state_->log->recipes();
  return state_->log->moved_to();
}

void TuningSession::begin(const Progress& progress) {
  State& s = *state_;
  try {
    s.tuner.emplace(s.file, s.options, progress);
  } catch (const InvalidInput& error) {
    if (s.options.recipes.empty()) throw;
    throw InvalidInput(fmt::format("{}: {}", s.log_file.string(), error.what()));
  }
  if (s.log && s.log->recipes().empty()) s.log->append(s.tuner->recipes());
}

// Check that the tuning proposes the logged shot (voltages of one closing) again, or that the logged shot repeats the best
// waveform. Otherwise the log belongs to another tuning.
bool TuningSession::learn_kept(const Progress& progress) {
  State& s = *state_;
  if (!s.log || s.behind == s.log->closings().size()) return false;
  const TuningLog::Closing& closing = s.log->closings()[s.behind];
  if (shot_json(commanded()) != closing.shot) s.tuner->fire_kept_again();
  require(shot_json(commanded()) == closing.shot, [&] {
    return fmt::format("{}: this program proposes another shot after the closings before it; name another folder with --out",
                       s.log->place(closing));
  });
  s.learn(closing.record, progress);
  ++s.behind;
  return true;
}

const Tuner& TuningSession::tuner() const { return *state_->tuner; }
const std::vector<TunedClosing>& TuningSession::closings() const { return state_->closings; }

CommandedShot TuningSession::commanded() const {
  const TunerShot& shot = tuner().next();
  return commanded_shot(shot.number, shot.hold_time, sent_signals(tuner().scene(), shot.waveforms));
}

void TuningSession::learn(const ContactRecord& record, const Progress& progress) {
  const std::string fault = record_fault(record, commanded().duration());
  require(fault.empty(), fault);
  if (state_->log && !state_->is_on_record) state_->log->append(commanded(), record);
  state_->is_on_record = true;
  state_->learn(record, progress);
  state_->is_on_record = false;
}

std::optional<TuningEnd> TuningSession::ends(int most) {
  Tuner& tuner = *state_->tuner;
  if (tuner.is_done() && tuner.was_kept_last()) return TuningEnd::done;
  if (tuner.closings() >= most) return TuningEnd::closings_used;
  if (tuner.is_done() || tuner.closings() + 1 == most) tuner.fire_kept_again();
  return {};
}

void TuningSession::throw_if_failing() const {
  constexpr std::ptrdiff_t most_failures = 3;  // number of closings in a row without a contact record that end the tuning
  const std::vector<TunedClosing>& all = closings();
  const auto of_log = all.rend() - static_cast<std::ptrdiff_t>(state_->behind);
  const auto failures =
      std::find_if(all.rbegin(), of_log, [](const TunedClosing& one) { return one.record.error.empty(); }) - all.rbegin();
  require(failures < most_failures, [&] {
    return fmt::format("{} shots in a row gave no record; the device said of the last one: {}", failures,
                       all.back().record.error);
  });
}

TuningReport TuningSession::report(TuningEnd end, const std::string& command) const {
  TuningReport report = tuning_report(tuner(), closings(), state_->options, end, command);
  report.setting = state_->origin;
  return report;
}

std::map<std::string, std::string> TuningSession::files(TuningEnd end, const std::string& command) const {
  const TuningReport now = report(end, command);
  const PreparedScene& scene = tuner().scene();
  const TunerShot best = kept_shot(tuner(), closings(), end);
  const SentSignals kept = sent_signals(scene, best.waveforms);
  DriveWaveforms waveforms;
  const std::vector<std::string> names = scene.drive_names();
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (kept.signals.contains(names[k])) waveforms.emplace(names[k], best.waveforms[k]);
  }
  return {{"best.toml", with_waveforms(scene, waveforms).text()},
          {"best.csv", csv(kept.signals, scene.duration, kept.sample_rates)},
          {"tune.json", json_text(json_of(now), 1)},
          {"tune.html", page_html(tuning_document(now))}};
}

}  // namespace softland
