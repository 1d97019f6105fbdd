// Tunes a waveform on a device, closing after closing.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/exit_status.h"
#include "apps/laboratory.h"
#include "apps/output.h"
#include "apps/progress.h"
#include "apps/scenes.h"
#include "apps/streams.h"
#include "apps/tuning_lab.h"
#include "apps/values.h"
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
#include "studies/search/search_setting.h"
#include "studies/tuning/tuner.h"

namespace softland::apps {
namespace {

using nlohmann::json;

constexpr const char* log_file = "closings.jsonl";

struct TuneRequest {
  std::string device, actuator = "electrostatic";
  bool by_hand = false, resume = false;
  std::vector<std::string> wafer;     ///< folders of earlier tunings
  std::vector<std::string> contact;   ///< how recorded voltages of the contact are read
  std::optional<std::string> format;  ///< the format of the files of shots
  Sampling sampling;                  ///< how the sources take samples
  std::optional<std::string> touch, closings, recipes, effort, timeout, seed, jobs;
  LaboratoryRequest laboratory;
};

TunerOptions tuner_options(const TuneRequest& request, const SceneFile& file) {
  const auto* const actuator = find_named(actuators, request.actuator);
  require(actuator != nullptr, [&] { return fmt::format("--actuator {}: must be {}", request.actuator, listed(actuators)); });
  TunerOptions options{
      .actuator = actuator->value, .jobs = job_count(request.jobs), .laboratory = laboratory_errors(request.laboratory, file)};
  options.seed = seed_of(request.seed, options.seed);
  if (request.touch) {
    try {
      options.touch = parse_criterion(*request.touch, all_figures);
    } catch (const InvalidInput& error) {
      throw InvalidInput(fmt::format("--constrain: {}", error.what()));
    }
  }
  if (request.recipes) options.most_recipes = whole_number("--recipes", *request.recipes, 1);
  if (request.effort) options.effort = quantity_of("--effort", *request.effort, dimension::none);
  check(options);
  return options;
}

std::chrono::milliseconds patience_of(const std::optional<std::string>& timeout) {
  constexpr double usual = 60, longest = 1e6;  // [s]
  const double seconds = timeout ? quantity_of("--timeout", *timeout, dimension::time) : usual;
  require(seconds > 0 && seconds <= longest,
          [&] { return fmt::format("--timeout {}: must be above 0 s and at most {} s", *timeout, number_text(longest)); });
  return std::chrono::milliseconds(std::max<long>(1, std::lround(1000 * seconds)));
}

// Puts what is said of the sources into [driver], and refuses a format that cannot hold their shots before anything is searched.
void set_sources(SceneFile& file, const TuneRequest& request, Actuator actuator) {
  const PreparedScene drawn = prepare_and_choose(file, true);
  std::vector<std::string> shaped;
  for (const auto& [drive, waveform] : plain_step(drawn, actuator)) {
    if (drawn.drives.at(drive).limits) shaped.push_back(drive);
  }
  if (request.sampling.amplifier) {
    require(shaped.size() == 1, [&] {
      return fmt::format("--amplifier {}: several drives are shaped, {}: give each [driver.NAME] its amplifier",
                         *request.sampling.amplifier, fmt::join(shaped, ", "));
    });
    file.assign(fmt::format("driver.{}.amplifier", shaped.front()),
                amplification(drawn.drives.at(shaped.front()), request.sampling));
  }
  set_sampling(file, shaped, request.sampling);
  require_shots(request.format.value_or("csv"), prepare_and_choose(file, true), shaped);
}

/// A tuning, and the files that tell of it.
class Tuning {
 public:
  Tuning(const Common& common, const SceneFile& file, TunerOptions options, const TuneRequest& request);

  /// Learns what was recorded before.
  void learn_log();
  /// Fires shots until the switch has landed often enough, `closings` are used, or the lab wants no more.
  TuningEnd run(TuningLab& lab, int closings);
  /// The files as they stand.
  void write(TuningEnd end);
  [[nodiscard]] json told_json(TuningEnd end) const { return session_.json(end, {.command = common_.command}); }
  [[nodiscard]] TuningReport report(TuningEnd end) const { return session_.report(end); }
  [[nodiscard]] const ResultFolder& folder() const { return *folder_; }
  [[nodiscard]] const PreparedScene& scene() const { return session_.tuner().scene(); }

 private:
  Common common_;
  TuningSession session_;
  std::optional<ResultFolder> folder_;
};

Tuning::Tuning(const Common& common, const SceneFile& file, TunerOptions options, const TuneRequest& request)
    : common_(common), session_(file, std::move(options), request.wafer) {
  folder_ = claim_places(common, {"best.toml", "best.csv", "tune.json", "tune.html", log_file}, {log_file});
  const std::filesystem::path aside = session_.keep(folder_->path() / log_file, request.resume);
  if (!aside.empty() && !common_.quiet) say(fmt::format("the closings of an earlier run are now in {}", aside.string()));
  const WatchedWork work(common_.quiet, common_.stop);
  session_.begin(work.watch());
}

void Tuning::learn_log() {
  for (bool learned = true; learned;) {
    const WatchedWork work(common_.quiet, common_.stop);
    learned = session_.learn_kept(work.watch());
  }
}

TuningEnd Tuning::run(TuningLab& lab, int closings) {
  for (;;) {
    if (const std::optional<TuningEnd> end = session_.ends(closings)) return *end;
    const SentSignals sent = sent_signals(session_.tuner().scene(), session_.tuner().next().waveforms);
    const std::optional<ContactRecord> record = lab.fire(session_.told(), sent);
    if (!record) return TuningEnd::stopped;
    {
      const WatchedWork work(common_.quiet, common_.stop);
      session_.learn(*record, work.watch());
    }
    write(TuningEnd::under_way);
    if (!common_.quiet) say(closing_words(report(TuningEnd::under_way)));
    session_.throw_if_failing();
  }
}

void Tuning::write(TuningEnd end) {
  for (const auto& [name, content] : session_.files(end, {.command = common_.command})) folder_->write(name, content);
  folder_->publish(false);
}

int tune_verb(const Common& given, const TuneRequest& request) {
  Common c = given;
  if (c.out.empty()) c.out = "softland-tune";
  require(request.by_hand == request.device.empty(),
          "--device COMMAND or --by-hand says where the shots are fired: give one of them");
  const std::chrono::milliseconds patience = patience_of(request.timeout);
  require(request.contact.empty() || request.by_hand, "--contact says how files are read that --by-hand is told of");
  std::optional<ContactTraceKeys> contact;
  if (!request.contact.empty()) contact = contact_trace_keys(request.contact);
  const int closings = request.closings ? whole_number("--closings", *request.closings, 1) : usual_closings;
  const bool says_sources = request.format || request.sampling.rate || request.sampling.bits || request.sampling.amplifier;
  require(request.by_hand || !says_sources,
          "--format, --sample-rate, --bits and --amplifier are of the files that --by-hand writes; a command is told volts");
  SceneFile file = load_scene_or_result(c);
  const TunerOptions options = tuner_options(request, file);
  if (says_sources) set_sources(file, request, options.actuator);
  Tuning tuning(c, file, options, request);
  if (tuning.report(TuningEnd::under_way).spread_assumed && !c.quiet) say(std::string(assumed_words));

  TuningEnd end = TuningEnd::interrupted;
  try {
    const std::unique_ptr<TuningLab> lab = request.by_hand ? hand_lab({.folder = tuning.folder().path(),
                                                                       .goes_on = request.resume,
                                                                       .format = request.format.value_or("csv"),
                                                                       .contact = contact},
                                                                      tuning.scene())
                                                           : command_lab(request.device, patience);
    tuning.learn_log();
    try {
      end = tuning.run(*lab, closings);
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
  print_json_or(c, tuning.told_json(end),
                terminal_text(tuning_document(report, {})) +
                    left_in(tuning.folder().path(), {"tune.html", "tune.json", "best.toml", "best.csv", log_file}));
  if (end == TuningEnd::interrupted) return exit_interrupted;
  return report.lands() ? exit_done : exit_no_success;
}

}  // namespace

void add_tune(Verb& verb) {
  const auto request = std::make_shared<TuneRequest>();
  verb.with_scene(true, true);
  verb.with_json();
  verb.option("--device", request->device, "COMMAND",
              "what fires the shots: the shell runs it, it reads one JSON object a line and answers each by one");
  verb.flag("--by-hand", request->by_hand, "write each waveform to a file, and ask what the oscilloscope showed");
  verb.optional("--format", request->format, "NAME",
                "of these files: csv (default), spice-pwl, codes, keysight-arb, siglent-csv, tektronix-csv, rigol-csv or "
                "digilent-csv, as export writes them; a file for a generator holds one drive, shot-1-main.arb");
  verb.optional(
      "--sample-rate", request->sampling.rate, "RATE",
      "samples at this rate, by hand, instead of what [driver] says: \"27 MHz\"; they are what the belief expects, too");
  verb.optional("--bits", request->sampling.bits, "N",
                "by hand, rounded to 2^N voltages between the limits of [driver], instead of what it says");
  verb.optional(
      "--amplifier", request->sampling.amplifier, "K",
      "by hand, an amplifier between generator and switch, instead of the amplifier of [driver]: volts of the files are "
      "those at the switch over K");
  verb.repeated(
      "--contact", request->contact, "KEY=VALUE",
      "how the voltage of the contact is read from files of an oscilloscope, by hand: threshold=\"1.5 V\", closed=below, "
      "hysteresis=\"0.2 V\", merge=\"100 ns\", and column, shift and the like (docs/files.md); may be repeated");
  verb.optional("--closings", request->closings, "N",
                fmt::format("closings at most (default: {}); it ends before where {} in a row were without a bounce",
                            usual_closings, Tuner::enough_in_a_row));
  verb.flag("--resume", request->resume,
            "go on with the closings in the folder of --out, none of which is fired again; scene and options as before");
  verb.repeated("--wafer", request->wafer, "FOLDER",
                "tuning of another device of the same wafer, in the folder that its --out named: what they all tell of the next "
                "device is known before its first closing; may be repeated");
  verb.option("--actuator", request->actuator, "NAME", "drives that are shaped: " + first_is_default(listed(actuators)));
  verb.optional("--constrain", request->touch, "CONDITION",
                "when the contact is to touch, such as \"initial_contact_time < 33 us\", or beside a plain step on the drawing, "
                "\"initial_contact_time < 1.1 step\"");
  with_laboratory(verb, request->laboratory);
  verb.optional("--trigger-delay", request->laboratory.trigger_delay, "TIME",
                "by how much records may begin later or earlier than the drives, constant but unknown, one standard deviation "
                "(default: 2 us, at most a 48th of that period); \"0 s\": t = 0 of a record is that of the drives");
  verb.optional(
      "--recipes", request->recipes, "N",
      fmt::format("waveforms that are searched before the first closing, each for devices of another pull-in voltage, 1 to 5 "
                  "(default: {})",
                  TunerOptions{}.most_recipes));
  verb.optional("--effort", request->effort, "FACTOR",
                "evaluations of every search, over the usual (default: 1); less of it is sooner, and lands less surely");
  verb.optional("--timeout", request->timeout, "TIME", "how long the command may take for an answer (default: 60 s)");
  verb.with_seed(request->seed, "same records, same proposals, whatever --jobs is");
  verb.with_jobs(request->jobs);
  verb.with_out("folder for the page, the waveform kept and all closings (default: softland-tune)");
  verb.footer(
      "Every closing is open loop, and what is seen of it is when the contact was closed. After each the device is known "
      "better,\n"
      "and the waveform that lands it best is proposed next. No shot leaves the limits of [driver.*]. The last one is of the\n"
      "waveform kept; status 4: it did not land then. docs/tune.md says how to practise, what a command reads and writes, and\n"
      "has one for instruments.\n"
      "Examples:\n  softland tune scenes/mem-gold.toml --device \"softland device scenes/mem-gold.toml --seed 7\"\n"
      "  softland tune my.toml --device \"python3 scpi_device.py --generator 192.168.1.10 --oscilloscope 192.168.1.11\"\n"
      "  softland tune my.toml --by-hand --closings 12 --out device-17\n"
      "  softland tune my.toml --by-hand --format keysight-arb --sample-rate \"25 MHz\" --bits 14 --amplifier 20\n"
      "  softland tune my.toml --by-hand --contact threshold=\"1.5 V\" --contact closed=below --contact column=CH2\n"
      "  softland tune my.toml --by-hand --resume --out device-17\n"
      "  softland tune my.toml --by-hand --wafer device-17 --wafer device-18 --out device-19");
  verb.runs([request](const Common& common) { return tune_verb(common, *request); });
}

}  // namespace softland::apps
