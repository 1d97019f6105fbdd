#include "verbs/tune.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "config/condition.h"
#include "config/quantity_argument.h"
#include "reports/tuning_report.h"
#include "verbs/study.h"

namespace softland::verbs {
namespace {

struct TuneVerb : Usual, TuneRequest {
  static constexpr auto name = "tune",
                        about =
                            "tune the waveform on a real device, "
                            "using only the measured state of its contact",
                        python = "tuning", returns = "Tuning",
                        leaves = "folder for the report, the final waveform and all closings (default: softland-tune)",
                        place = "softland-tune";
  static std::vector<std::string> files() { return {"tune.html", "tune.json"}; }
  static Outcome shown_again(const nlohmann::json& json);
  static constexpr auto in_python =
      "The tuning is ready for its first shot: it has searched the waveform for the nominal design, "
      "which takes about half a minute.";
  static constexpr auto remarks =
      "Every closing is open loop, and only the times at which the contact is closed are observed. Each record improves the\n"
      "model of the device; the next shot is the waveform that lands this model best. No shot exceeds the limits of\n"
      "[driver.*]. The last shot uses the final waveform; exit status 4: it bounced. docs/tune.md describes how to practise,\n"
      "what a command reads and writes, and a command for instruments.\n"
      "Examples:\n  softland tune scenes/mem-gold.toml --device \"softland device scenes/mem-gold.toml --seed 7\"\n"
      "  softland tune my.toml --device \"python3 examples/scpi_device.py --generator 192.168.1.10 --oscilloscope 192.168.1.11\"\n"
      "  softland tune my.toml --by-hand --closings 12 --out device-17\n"
      "  softland tune my.toml --by-hand --format keysight-arb --sample-rate \"25 MHz\" --bits 14 --amplifier 20\n"
      "  softland tune my.toml --by-hand --contact threshold=\"1.5 V\" --contact closed=below --contact column=CH2\n"
      "  softland tune my.toml --by-hand --resume --out device-17\n"
      "  softland tune my.toml --by-hand --wafer device-17 --wafer device-18 --out device-19";
};

Outcome TuneVerb::shown_again(const nlohmann::json& json) {
  const auto report = std::make_shared<const TuningReport>(read_tuning(json));
  return {.json = json_of(*report),
          .text = terminal_text(tuning_document(*report)),
          .files = {{"tune.html", [report] { return page_html(tuning_document(*report)); }, "tune.html"}}};
}

void read_touch(const std::string& option, const std::string& text, std::optional<Condition>& touch) {
  try {
    touch = parse_condition(text, all_figures);
  } catch (const InvalidInput& error) {
    throw InvalidRequest(fmt::format("{}: {}", option, error.what()));
  }
}

void read_patience(const std::string& option, const std::string& text, std::chrono::milliseconds& patience) {
  constexpr double longest = 1e6;  // longest time that the option --timeout accepts [s]
  const double seconds = quantity_argument(option, text, dimension::time);
  require_request(seconds > 0 && seconds <= longest,
                  [&] { return fmt::format("{} {}: must be above 0 s and at most {} s", option, text, number_text(longest)); });
  patience = std::chrono::milliseconds(std::max<long>(1, std::lround(1000 * seconds)));
}

template <class Archive>
void options(Archive& a, TuneVerb& r) {
  TunerOptions& t = r.tuner;
  a.program().text("device", r.device, "COMMAND",
                   "shell command that fires the shots: it reads one JSON object a line, and answers each by one line");
  a.program().flag(
      "by-hand", r.by_hand,
      "write each waveform to a file, and ask what the oscilloscope recorded; every question lists its answers, such as \"never\" "
      "for a contact that stayed open and \"?\" for an unknown number of openings");
  a.program().text(
      "format", r.format, "NAME",
      "with --by-hand, format of the files: csv (default), spice-pwl, codes, keysight-arb, siglent-csv, tektronix-csv, "
      "rigol-csv or digilent-csv, as in export; a file for a generator holds one drive, such as shot-1-main.arb");
  a.program().text("sample-rate", r.sampling.rate, "RATE",
                   "with --by-hand, sample rate such as \"27 MHz\" (default: that of [driver]); "
                   "the model of the device uses the same samples");
  a.program().text(
      "bits", r.sampling.bits, "N",
      "with --by-hand, round the samples to 2^N voltages between the limits of [driver] (default: the bits of [driver])");
  a.program().text("amplifier", r.sampling.amplifier, "K",
                   "with --by-hand, gain of the amplifier between generator and switch (default: that of [driver]); "
                   "the files hold the voltages at the switch divided by K");
  a.program().repeated(
      "contact", r.contact, "KEY=VALUE",
      "with --by-hand, how the contact is read from the voltage in an oscilloscope file: threshold=\"1.5 V\", closed=below, "
      "hysteresis=\"0.2 V\", merge=\"100 ns\", and others such as column and shift (docs/files.md); may be repeated");
  a.program().whole(
      "closings", r.closings, {.least = 1},
      fmt::format("largest number of closings (default: {}); the tuning ends earlier after {} bounce-free closings in a row",
                  usual_closings, Tuner::enough_in_a_row));
  a.flag("resume", r.resume,
         "continue the tuning in the folder of --out; its closings are not fired again. Scene and options must be as before");
  a.as({.type = "Sequence[str | os.PathLike[str]]", .conversion = "_paths({})"})
      .repeated("wafer", r.wafer, "FOLDER",
                "result folder of a tuning of another device of the same wafer; "
                "what these devices have in common is known before the first closing; may be repeated");
  a.choice("actuator", t.actuator, actuators, "drives that the tuning may shape");
  a.as({.value = "\"\"", .conversion = "_text({})"})
      .parsed("constrain", t.touch, read_touch, "CONDITION",
              "condition on the time of first contact, such as \"initial_contact_time < 33 us\" or, "
              "relative to the plain step on the nominal design, \"initial_contact_time < 1.1 step\"",
              "constrain", "str");
  a.object("errors", "Mapping[str, float | str] | None", "None",
           "standard deviations of the errors of the instruments, by name: edge_error [s], unseen [s], gain_error, shot_error, "
           "and trigger_delay [s] between drives and records; default: see docs/tune.md");
  laboratory_options(a, r.laboratory);
  a.program().quantity(
      "trigger-delay", r.laboratory.trigger_delay, {dimension::time}, "TIME",
      "standard deviation of the delay between drives and records, which is constant but unknown (default: 2 us, "
      "at most 1/48 of the period of the first mode); \"0 s\": records and drives begin together");
  a.whole("recipes", t.most_recipes, {.least = 1},
          fmt::format("number of waveforms searched before the first closing, 1 to 5, "
                      "each for devices of another pull-in voltage (default: {})",
                      TunerOptions{}.most_recipes));
  a.quantity(
      "effort", t.effort, {dimension::none}, "FACTOR",
      "factor on the number of evaluations of every search (default: 1); a smaller factor is faster but lands less reliably");
  a.program().parsed("timeout", r.patience, read_patience, "TIME",
                     "longest time to wait for an answer of the command (default: 60 s)", "timeout", "str");
  seed_option(a, t.seed, "the same waveforms for the same records, whatever --jobs is");
  jobs_option(a, t.jobs);
  a.object(
      "out", "str | os.PathLike[str] | None", "None",
      "folder for closings.jsonl, to which each closing is written before the next is fired, and for the files of the program, "
      "which can continue the tuning");
}

}  // namespace

TuningSession TuneRequest::session(const SceneFile& file) const {
  TunerOptions options = tuner;
  options.laboratory = laboratory.errors(file);
  check(options);
  return {file, std::move(options), wafer};
}

TuneRequest tune_request(const Arguments& arguments) { return read_options<TuneVerb>(arguments); }

Study tune_study() { return described<TuneVerb>(); }

}  // namespace softland::verbs
