// Verb `tune`: tunes a waveform on a real device by repeated closings and measurements of the device.
#include "verbs/tune.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/exit_status.h"
#include "apps/output.h"
#include "apps/progress.h"
#include "apps/scenes.h"
#include "apps/streams.h"
#include "apps/tuning_lab.h"
#include "apps/verbs/verbs.h"
#include "base/require.h"
#include "base/shell_word.h"
#include "config/assumed_spread.h"
#include "config/bench.h"
#include "reports/scene_export.h"
#include "reports/tuning_report.h"
#include "reports/tuning_session.h"
#include "studies/closing/auto_settings.h"
#include "studies/closing/plain_step.h"
#include "studies/inverse/tuner.h"
#include "studies/search/search_setting.h"

namespace softland::apps {
namespace {

constexpr const char* log_file = "closings.jsonl";

using verbs::TuneRequest;

// Writes the options about voltage sources into [driver] of the scene. Throws InvalidRequest, before any search begins, for a
// file format that cannot hold the voltages.
void set_sources(SceneFile& file, const TuneRequest& request, Actuator actuator) {
  const PreparedScene drawn = prepare_and_choose(file, true);
  std::vector<std::string> shaped;
  for (const auto& [drive, waveform] : plain_step(drawn, actuator)) {
    if (drawn.drives.at(drive).limits) shaped.push_back(drive);
  }
  if (request.sampling.amplifier) {
    require(shaped.size() == 1, [&] {
      return fmt::format(
          "--amplifier {}: must not be given when several drives are shaped ({}): set the key amplifier of each [driver.NAME]",
          *request.sampling.amplifier, fmt::join(shaped, ", "));
    });
    file.assign(fmt::format("driver.{}.amplifier", shaped.front()),
                amplification(drawn.drives.at(shaped.front()), request.sampling));
  }
  set_sampling(file, shaped, request.sampling);
  require_shots(request.format.value_or("csv"), prepare_and_choose(file, true), shaped);
}

/// The tuning of a waveform on a real device, and the files that the tuning writes.
class Tuning {
 public:
  Tuning(const Common& common, const SceneFile& file, const TuneRequest& request);

  /// Learns from the closings of the device in the log of an earlier run of this tuning.
  void learn_log();
  /// Closes the device until enough closings in a row are bounce-free, the largest number of closings is reached, or the
  /// laboratory stops.
  TuningEnd run(TuningLab& lab, int closings);
  /// Writes the result files for the current state of the tuning.
  void write(TuningEnd end);
  [[nodiscard]] TuningReport report(TuningEnd end) const { return session_.report(end, common_.command); }
  [[nodiscard]] const ResultFolder& folder() const { return *folder_; }
  [[nodiscard]] const PreparedScene& scene() const { return session_.tuner().scene(); }

 private:
  Common common_;
  TuningSession session_;
  std::optional<ResultFolder> folder_;
};

Tuning::Tuning(const Common& common, const SceneFile& file, const TuneRequest& request)
    : common_(common), session_(request.session(file)) {
  folder_ = reserve_outputs(common, {"best.toml", "best.csv", "tune.json", "tune.html", log_file}, {log_file});
  const std::filesystem::path aside = session_.keep(folder_->path() / log_file, request.resume);
  if (!aside.empty() && !common_.quiet)
    print_note(fmt::format("the closings of an earlier run were moved to {}", aside.string()));
  const ShownWork work(common_.quiet, common_.stop);
  session_.begin(work.progress());
}

void Tuning::learn_log() {
  for (bool learned = true; learned;) {
    const ShownWork work(common_.quiet, common_.stop);
    learned = session_.learn_kept(work.progress());
  }
}

TuningEnd Tuning::run(TuningLab& lab, int closings) {
  for (;;) {
    if (const std::optional<TuningEnd> end = session_.ends(closings)) return *end;
    const SentSignals sent = sent_signals(session_.tuner().scene(), session_.tuner().next().waveforms);
    const std::optional<ContactRecord> record = lab.fire(session_.commanded(), sent);
    if (!record) return TuningEnd::stopped;
    {
      const ShownWork work(common_.quiet, common_.stop);
      session_.learn(*record, work.progress());
    }
    write(TuningEnd::under_way);
    if (!common_.quiet) print_note(closing_prose(report(TuningEnd::under_way)));
    session_.throw_if_failing();
  }
}

void Tuning::write(TuningEnd end) {
  for (const auto& [name, content] : session_.files(end, common_.command)) folder_->write(name, content);
  folder_->publish(false);
}

}  // namespace

int run_tune(const Common& c, const verbs::Arguments& arguments) {
  const TuneRequest request = verbs::tune_request(arguments);
  require(request.by_hand == request.device.empty(), "give either --device COMMAND or --by-hand: it says how shots are fired");
  require(request.contact.empty() || request.by_hand, "--contact requires --by-hand: it says how to read the recorded files");
  std::optional<ContactTraceKeys> contact;
  if (!request.contact.empty()) contact = contact_trace_keys(request.contact);
  const bool says_sources = request.format || request.sampling.rate || request.sampling.bits || request.sampling.amplifier;
  require(request.by_hand || !says_sources,
          "--format, --sample-rate, --bits and --amplifier require --by-hand: they describe its files; a command receives volts");
  SceneFile file = load_scene_or_result(c);
  if (says_sources) set_sources(file, request, request.tuner.actuator);
  Tuning tuning(c, file, request);
  if (tuning.report(TuningEnd::under_way).spread_assumed && !c.quiet) print_note(std::string(assumed_prose));

  TuningEnd end = TuningEnd::interrupted;
  try {
    const std::unique_ptr<TuningLab> lab = request.by_hand ? hand_lab({.folder = tuning.folder().path(),
                                                                       .goes_on = request.resume,
                                                                       .format = request.format.value_or("csv"),
                                                                       .contact = contact},
                                                                      tuning.scene())
                                                           : command_lab(request.device, request.patience);
    tuning.learn_log();
    try {
      end = tuning.run(*lab, request.closings);
      lab->finish();
    } catch (const InvalidInput&) {
      tuning.write(TuningEnd::failed);
      throw;
    }
  } catch (const Interrupted&) {
    end = TuningEnd::interrupted;
  }
  tuning.write(end);
  const TuningReport report = tuning.report(end);
  print_json_or(c, json_of(report),
                terminal_text(tuning_document(report)) +
                    files_written(tuning.folder().path(), {"tune.html", "tune.json", "best.toml", "best.csv", log_file}));
  if (end == TuningEnd::interrupted) return exit_interrupted;
  return report.ended_bounce_free() ? exit_done : exit_no_success;
}

}  // namespace softland::apps
