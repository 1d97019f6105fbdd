#include "reports/tuning_session.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/content_key.h"
#include "base/output_lost.h"
#include "base/read_file.h"
#include "base/require.h"
#include "config/scene.h"
#include "reports/record_file.h"
#include "studies/closing/sent_signals.h"
#include "studies/search/search_setting.h"
#include "waveforms/export.h"

namespace softland {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Returns the first unused file name among closings-1.jsonl, closings-2.jsonl, ...
fs::path free_name(const fs::path& file) {
  std::error_code ignored;
  for (int k = 1;; ++k) {
    fs::path name = file.parent_path() / fmt::format("{}-{}{}", file.stem().string(), k, file.extension().string());
    if (!fs::exists(name, ignored)) return name;
  }
}

void require_origin(const json& line, const json& origin, const std::string& place) {
  require(line.contains(origin_key), [&] { return place + ": must be the log of a tuning"; });
  for (const auto& [key, value] : origin.items()) {
    const json known = line[origin_key].value(key, json());
    require(known == value, [&, &key = key, &value = value] {
      return fmt::format("{}: its closings are of another {}: {} instead of {}; name another folder with --out", place, key,
                         known.dump(), value.dump());
    });
  }
}

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

TuningLog::TuningLog(fs::path file, const json& origin, bool resume) : file_(std::move(file)) {
  std::error_code ignored;
  const bool exists = fs::exists(file_, ignored);
  require_request(exists || !resume,
                  [&] { return fmt::format("{}: {}: there is no such file", requested("resume"), file_.string()); });
  std::size_t size = 0;
  if (resume) {
    size = read(origin);
  } else if (exists) {
    kept_aside_ = free_name(file_);
    fs::rename(file_, kept_aside_);
  }
  open(size);
  if (size == 0) write({{origin_key, origin}});
}

TuningLog::~TuningLog() { ::close(descriptor_); }

// Reads all complete lines of the log and returns their number of bytes. An incomplete last line, as after a power cut, is
// ignored.
std::size_t TuningLog::read(const json& origin) {
  const std::string content = read_file(file_);
  const std::size_t size = content.rfind('\n') + 1;  // without a line feed, rfind() returns npos, and npos + 1 is 0
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < size; begin = content.find('\n', begin) + 1) {
    const std::string_view text = std::string_view(content).substr(begin, content.find('\n', begin) - begin);
    const std::string place = fmt::format("{}:{}", file_.string(), ++number);
    try {
      const json line = read_line(text);
      if (number == 1) {
        require_origin(line, origin, place);
        continue;
      }
      if (line.contains("recipes")) {
        recipes_ = read_recipes(line);
        continue;
      }
      require(line.contains("shot") && line.contains("record"), "must have shot and record");
      const CommandedShot shot = read_shot(line["shot"]);
      closings_.push_back(
          {.shot = line["shot"], .record = read_record(line["record"], shot.number, shot.duration()), .line = number});
    } catch (const InvalidInput& error) {
      if (std::string_view(error.what()).starts_with(place)) throw;
      throw InvalidInput(fmt::format("{}: {}", place, error.what()));
    }
  }
  return size;
}

void TuningLog::open(std::size_t size) {
  descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  const bool opened = descriptor_ >= 0 && ::ftruncate(descriptor_, static_cast<off_t>(size)) == 0;
  if (!opened) throw OutputLost(fmt::format("{}: cannot be written: {}", file_.string(), std::generic_category().message(errno)));
}

void TuningLog::write(const json& line) {
  const std::string text = line_text(line);
  std::string_view rest = text;
  const auto lost = [&] {
    return OutputLost(fmt::format("{}: cannot be written: {}", file_.string(), std::generic_category().message(errno)));
  };
  while (!rest.empty()) {
    const ssize_t written = ::write(descriptor_, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw lost();
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  if (::fsync(descriptor_) != 0) throw lost();
}

void TuningLog::append(const std::vector<CandidateWaveform>& recipes) { write(recipes_json(recipes)); }

void TuningLog::append(const CommandedShot& shot, const ContactRecord& record) {
  write({{"shot", shot_json(shot)}, {"record", record_json(shot.number, record)}});
}

std::string TuningLog::place(const Closing& closing) const { return fmt::format("{}:{}", file_.string(), closing.line); }

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
