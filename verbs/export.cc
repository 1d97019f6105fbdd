// Verb `export`: writes the waveforms of a result for a generator or a circuit simulator, or the states of its contact.
#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <system_error>

#include "reports/contact_states_file.h"
#include "reports/scene_export.h"
#include "verbs/study.h"

namespace softland::verbs {
namespace {

struct ExportVerb : Usual, ExportRequest {
  static constexpr auto name = "export",
                        about = "print the waveforms of a result, or the states of its contact, for other programs",
                        python = "export", returns = "str", progress = "False", subject = "RESULT",
                        scene = "folder that --out named, result.json, or a scene file";
  static constexpr auto in_python =
      "Warns where the switch does not close under the samples as well as under the waveform itself.";
  static constexpr Takes takes{.set = false, .quiet = false, .json = false};
  static constexpr auto remarks =
      "Examples:\n  softland export softland-out --format spice-pwl > drive.cir\n"
      "  softland export softland-out --drive piezo --format keysight-arb --sample-rate \"25 MHz\" --bits 14 --amplifier 20 > "
      "piezo.arb\n"
      "  softland export softland-out --measured \"Vdp=14.6 V,frequency=10.2 kHz\" > device-17.csv\n"
      "  softland export softland-out --measured \"Vdp=14.6 V,frequency=10.2 kHz,piezo=1.6 %/V\" > device-17.csv\n"
      "  softland export softland-out --contact-record vcd > contact.vcd\n"
      "  softland export softland-out --contact-record pwl --devices 20 > contacts.cir";

  ContactStatesRequest record;

  ExportVerb() { jobs = one_per_core(); }
};

template <class Archive>
void options(Archive& a, ExportVerb& r) {
  a.as({.is_positional = true})
      .text("format", r.format, "NAME",
            "csv (default), spice-pwl, codes, keysight-arb, siglent-csv, tektronix-csv, rigol-csv, digilent-csv, spice-model, "
            "spice-bench or verilog-a; codes are the samples as integers 0 to 2^bits - 1; files for a generator come with how "
            "the switch closes under these samples; the last three are the switch itself for a circuit, spice-bench with its "
            "drives: a run of ngspice");
  a.object("waveforms", "Mapping[str, Waveform] | None", "None",
           "waveforms of some drives in the place of the scene's, in volts; own waveforms as tables");
  a.as({.type = "float | str | None", .told = "_quantity({}, \"Hz\")"})
      .text("sample-rate", r.sampling.rate, "RATE", "samples at this rate, instead of what [driver] says: \"27 MHz\"");
  a.as({.type = "int | None", .told = "_whole({})"})
      .text("bits", r.sampling.bits, "N", "rounded to 2^N voltages between the limits of [driver], instead of what it says");
  a.as({.type = "float | str | None", .told = "_quantity({}, \"\")"})
      .text("amplifier", r.sampling.amplifier, "K",
            "an amplifier between generator and switch, instead of the amplifier of [driver]: volts of a generator's file are "
            "those at the switch over K");
  a.as({.type = "float | str | None", .told = "_quantity({}, \"s\")"})
      .text("marker", r.sampling.marker, "TIME", "where the sync output of the generator falls (keysight-arb)");
  a.text("drive", r.sampling.drive, "DRIVE", "of several drives this one alone");
  a.as({.type = "Literal[\"told\", \"output\"]"})
      .text("signal", r.signal, "NAME",
            "told (default) or output: what the source is told, the samples of one that takes some, or what it makes of that");
  a.as({.type = "Mapping[str, float | str] | None", .value = "None", .told = "_pairs({}, \"=\")"})
      .text("measured", r.measured, "WHAT",
            "measured on a device, \"Vdp=54.2 V,frequency=10.2 kHz\" or one of them: its own waveform, with voltages in "
            "proportion to the dynamic pull-in voltage, and times to the period; \"time=36.1 us\", the closing time under a step "
            "to 1.2 Vdp of the nominal device, tells the voltages as well; \"piezo=1.6 %/V\", the static deflection of the "
            "contact point per volt on the piezo over the contact gap (31 nm/V over the 2 um that the closed switch is deflected "
            "by: one instrument reads both), tells those of the piezo, which else are the nominal device's");
  a.program().text("device-vdp", r.device_pull_in, "VOLTAGE", "the same as --measured \"Vdp=VOLTAGE\"");
  a.program().text("device-frequency", r.device_frequency, "FREQUENCY",
                   "the same as --measured \"frequency=FREQUENCY\": the first natural frequency");
  a.text(
      "contact-record", r.record.format, "NAME",
      "csv, vcd (a value change dump) or pwl (sources of SPICE): when the contact is closed and open, and its resistance, in the "
      "place of the waveforms");
  a.whole("devices", r.record.devices, {.least = 1, .most = 10'000},
          "contact record of N devices of [spread], each a channel, in the place of the nominal design");
  seed_option(a, r.record.seed, "same devices");
  jobs_option(a.python(), r.jobs, "threads (default: one per core)");
}

bool is_of_waveforms(const ExportVerb& r) {
  const Sampling& s = r.sampling;
  return r.format != ExportRequest{}.format || r.signal != ExportRequest{}.signal || !r.measured.empty() || r.device_pull_in ||
         r.device_frequency || s.rate || s.bits || !s.drive.empty() || s.amplifier || s.marker;
}

Outcome contact_record(const Setting& setting, const ExportVerb& request) {
  require_field(!is_of_waveforms(request), "contact-record", request.record.format,
                [] { return "is of the contact, and takes no option of waveforms"; });
  ContactStatesRequest record = request.record;
  record.jobs = request.jobs;
  return {.text = contact_states_text(
              setting.scene, record, setting.watch, setting.note ? setting.note : [](const std::string&) {})};
}

Outcome run(const Setting& setting, const ExportVerb& request) {
  if (!request.record.format.empty()) return contact_record(setting, request);
  require_request(!request.record.devices && !request.record.seed, [] {
    return fmt::format("{}, {}: belong to {}", requested("devices"), requested("seed"), requested("contact-record"));
  });
  std::error_code ignored;
  if (setting.note && std::filesystem::exists(std::filesystem::path(setting.name) / "tune.json", ignored))
    setting.note(
        "this waveform was tuned on one device, of which tune.json has what is expected; it need not land the nominal design");
  return {.text = exported_text(setting.scene, request, setting.watch, setting.note)};
}

}  // namespace

Study export_study() { return study_of<ExportVerb>(); }

}  // namespace softland::verbs
