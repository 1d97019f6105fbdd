#include "verbs/tune.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "config/criterion.h"
#include "config/told_quantity.h"
#include "reports/tuning_report.h"
#include "verbs/study.h"

namespace softland::verbs {
namespace {

struct TuneVerb : Usual, TuneRequest {
  static constexpr auto name = "tune", about = "tune the waveform on a device, by nothing but the state of its contact",
                        python = "tuning", returns = "Tuning",
                        leaves = "folder for the page, the waveform kept and all closings (default: softland-tune)",
                        place = "softland-tune";
  static std::vector<std::string> files() { return {"tune.html", "tune.json"}; }
  static Outcome shown_again(const nlohmann::json& json);
  static constexpr auto in_python =
      "The tuning is ready for its first shot: the waveform for the drawing is searched, which takes half a minute "
      "or so.";
  static constexpr auto remarks =
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
      "  softland tune my.toml --by-hand --wafer device-17 --wafer device-18 --out device-19";
};

Outcome TuneVerb::shown_again(const nlohmann::json& json) {
  const auto report = std::make_shared<const TuningReport>(read_tuning(json));
  return {.json = json_of(*report),
          .text = terminal_text(tuning_document(*report)),
          .files = {{"tune.html", [report] { return page_html(tuning_document(*report)); }, "tune.html"}}};
}

void read_touch(const std::string& option, const std::string& text, std::optional<Criterion>& touch) {
  try {
    touch = parse_criterion(text, all_figures);
  } catch (const InvalidInput& error) {
    throw InvalidRequest(fmt::format("{}: {}", option, error.what()));
  }
}

void read_patience(const std::string& option, const std::string& text, std::chrono::milliseconds& patience) {
  constexpr double longest = 1e6;  // [s]
  const double seconds = told_quantity(option, text, dimension::time);
  require_request(seconds > 0 && seconds <= longest,
                  [&] { return fmt::format("{} {}: must be above 0 s and at most {} s", option, text, number_text(longest)); });
  patience = std::chrono::milliseconds(std::max<long>(1, std::lround(1000 * seconds)));
}

template <class Archive>
void options(Archive& a, TuneVerb& r) {
  TunerOptions& t = r.tuner;
  a.program().text("device", r.device, "COMMAND",
                   "what fires the shots: the shell runs it, it reads one JSON object a line and answers each by one");
  a.program().flag("by-hand", r.by_hand, "write each waveform to a file, and ask what the oscilloscope showed");
  a.program().text("format", r.format, "NAME",
                   "of these files: csv (default), spice-pwl, codes, keysight-arb, siglent-csv, tektronix-csv, rigol-csv or "
                   "digilent-csv, as export writes them; a file for a generator holds one drive, shot-1-main.arb");
  a.program().text(
      "sample-rate", r.sampling.rate, "RATE",
      "samples at this rate, by hand, instead of what [driver] says: \"27 MHz\"; they are what the belief expects, too");
  a.program().text("bits", r.sampling.bits, "N",
                   "by hand, rounded to 2^N voltages between the limits of [driver], instead of what it says");
  a.program().text("amplifier", r.sampling.amplifier, "K",
                   "by hand, an amplifier between generator and switch, instead of the amplifier of [driver]: volts of the files "
                   "are those at the switch over K");
  a.program().repeated(
      "contact", r.contact, "KEY=VALUE",
      "how the voltage of the contact is read from files of an oscilloscope, by hand: threshold=\"1.5 V\", closed=below, "
      "hysteresis=\"0.2 V\", merge=\"100 ns\", and column, shift and the like (docs/files.md); may be repeated");
  a.program().whole("closings", r.closings, {.least = 1},
                    fmt::format("closings at most (default: {}); it ends before where {} in a row were without a bounce",
                                usual_closings, Tuner::enough_in_a_row));
  a.flag("resume", r.resume,
         "go on with the closings in the folder of --out, none of which is fired again; scene and options as before");
  a.as({.type = "Sequence[str | os.PathLike[str]]", .told = "_paths({})"})
      .repeated("wafer", r.wafer, "FOLDER",
                "tuning of another device of the same wafer, in the folder that its --out named: what they all tell of the next "
                "device is known before its first closing; may be repeated");
  a.choice("actuator", t.actuator, actuators, "drives that are shaped");
  a.as({.value = "\"\"", .told = "_text({})"})
      .parsed("constrain", t.touch, read_touch, "CONDITION",
              "when the contact is to touch, such as \"initial_contact_time < 33 us\", or beside a plain step on the drawing, "
              "\"initial_contact_time < 1.1 step\"",
              "constrain", "str");
  a.object("errors", "Mapping[str, float | str] | None", "None",
           "one standard deviation of the errors of instruments, by name: edge_error [s], unseen [s], gain_error, shot_error, "
           "and trigger_delay [s], by which records may begin later or earlier than the drives; default: the usual ones "
           "(docs/tune.md)");
  laboratory_options(a, r.laboratory);
  a.program().quantity("trigger-delay", r.laboratory.trigger_delay, {dimension::time}, "TIME",
                       "by how much records may begin later or earlier than the drives, constant but unknown, one standard "
                       "deviation (default: 2 us, at most a 48th of that period); \"0 s\": t = 0 of a record is that of the "
                       "drives");
  a.whole("recipes", t.most_recipes, {.least = 1},
          fmt::format("waveforms that are searched before the first closing, each for devices of another pull-in voltage, 1 to 5 "
                      "(default: {})",
                      TunerOptions{}.most_recipes));
  a.quantity("effort", t.effort, {dimension::none}, "FACTOR",
             "evaluations of every search, over the usual (default: 1); less of it is sooner, and lands less surely");
  a.program().parsed("timeout", r.patience, read_patience, "TIME", "how long the command may take for an answer (default: 60 s)",
                     "timeout", "str");
  seed_option(a, t.seed, "same records, same proposals, whatever --jobs is");
  jobs_option(a, t.jobs);
  a.object("out", "str | os.PathLike[str] | None", "None",
           "folder for closings.jsonl, where each closing is before the next is fired, and for the files of the program, which "
           "may go on with the tuning");
}

}  // namespace

TuningSession TuneRequest::session(const SceneFile& file) const {
  TunerOptions options = tuner;
  options.laboratory = laboratory.errors(file);
  check(options);
  return {file, std::move(options), wafer};
}

TuneRequest tune_request(const Told& told) { return read_options<TuneVerb>(told); }

Study tune_study() { return described<TuneVerb>(); }

}  // namespace softland::verbs
