// Verb `export`: writes the waveforms of a result for a generator or a circuit simulator, or the states of the contact.
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
                        about = "write the waveforms of a result, or the states of its contact, for other programs",
                        python = "export", returns = "str", progress = "False", subject = "RESULT",
                        scene = "result folder (the --out of an earlier run), result.json, or a scene file";
  static constexpr auto in_python = "Warns if the switch closes less well under the samples than under the waveform itself.";
  static constexpr Takes takes{.set = false, .quiet = false, .json = false};
  static constexpr auto remarks =
      "Examples:\n  softland export softland-out --format spice-pwl > drive.cir\n"
      "  softland export softland-out --drive piezo --format keysight-arb --sample-rate \"25 MHz\" --bits 14 --amplifier 20 > "
      "piezo.arb\n"
      "  softland export softland-out --measured \"Vdp=22.6 V,frequency=15.5 kHz\" > device-17.csv\n"
      "  softland export softland-out --measured \"Vdp=22.6 V,frequency=15.5 kHz,piezo=107 %/V\" > device-17.csv\n"
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
            "spice-bench or verilog-a; codes are the samples as integers from 0 to 2^bits - 1. "
            "With a file for a generator, the closing under its samples is simulated and reported. "
            "spice-model and verilog-a are the switch as a circuit element; "
            "spice-bench is a run of ngspice with the switch and its drives");
  a.object("waveforms", "Mapping[str, Waveform] | None", "None",
           "waveforms of some drives in volts, instead of those of the scene; own waveforms are written as tables");
  a.as({.type = "float | str | None", .conversion = "_quantity({}, \"Hz\")"})
      .text("sample-rate", r.sampling.rate, "RATE", "sample rate, such as \"27 MHz\" (default: that of [driver])");
  a.as({.type = "int | None", .conversion = "_whole({})"})
      .text("bits", r.sampling.bits, "N",
            "round the samples to 2^N voltages between the limits of [driver] (default: the bits of [driver])");
  a.as({.type = "float | str | None", .conversion = "_quantity({}, \"\")"})
      .text("amplifier", r.sampling.amplifier, "K",
            "gain of the amplifier between generator and switch (default: that of [driver]); "
            "a file for a generator holds the voltages at the switch divided by K");
  a.as({.type = "float | str | None", .conversion = "_quantity({}, \"s\")"})
      .text("marker", r.sampling.marker, "TIME", "time at which the sync output of the generator falls (keysight-arb)");
  a.text("drive", r.sampling.drive, "DRIVE", "export this drive only");
  a.as({.type = "Literal[\"told\", \"output\"]"})
      .text("signal", r.signal, "NAME",
            "signal to export: told (default) or output; told is the commanded voltage, as samples if the source takes samples, "
            "and output is the voltage that the source applies");
  a.as({.type = "Mapping[str, float | str] | None", .value = "None", .conversion = "_pairs({}, \"=\")"})
      .text("measured", r.measured, "WHAT",
            "scale the waveform for one device by its measurements, "
            "such as \"Vdp=54.2 V,frequency=10.2 kHz\" or only one of these. "
            "Voltages scale with the dynamic pull-in voltage Vdp, times with the period of the first mode. "
            "\"time=36.1 us\", the closing time under a step to 1.2 times the nominal Vdp, "
            "also gives the scale of the voltages. "
            "\"piezo=1.6 %/V\" gives the scale of the piezo voltages, which otherwise stay nominal. "
            "It is the static deflection of the contact point per volt, divided by the contact gap: "
            "31 nm/V over the 2 um by which the closed switch is deflected, both read by one instrument");
  a.program().text("device-vdp", r.device_pull_in, "VOLTAGE", "the same as --measured \"Vdp=VOLTAGE\"");
  a.program().text("device-frequency", r.device_frequency, "FREQUENCY",
                   "the same as --measured \"frequency=FREQUENCY\": the first natural frequency");
  a.text("contact-record", r.record.format, "NAME",
         "write the times at which the contact closes and opens, and its resistance, instead of the waveforms: csv, "
         "vcd (value change dump) or pwl (SPICE sources)");
  a.whole("devices", r.record.devices, {.least = 1, .most = 10'000},
          "write the contact record of N devices varied by [spread], one channel each, instead of the nominal design");
  seed_option(a, r.record.seed, "the same devices");
  jobs_option(a.python(), r.jobs, "number of threads (default: one per core)");
}

bool is_of_waveforms(const ExportVerb& r) {
  const Sampling& s = r.sampling;
  return r.format != ExportRequest{}.format || r.signal != ExportRequest{}.signal || !r.measured.empty() || r.device_pull_in ||
         r.device_frequency || s.rate || s.bits || !s.drive.empty() || s.amplifier || s.marker;
}

Outcome contact_record(const Setting& setting, const ExportVerb& request) {
  require_field(!is_of_waveforms(request), "contact-record", request.record.format,
                [] { return "exports states of the contact: omit the options for waveforms"; });
  ContactStatesRequest record = request.record;
  record.jobs = request.jobs;
  return {.text = contact_states_text(
              setting.scene, record, setting.progress, setting.note ? setting.note : [](const std::string&) {})};
}

Outcome run(const Setting& setting, const ExportVerb& request) {
  if (!request.record.format.empty()) return contact_record(setting, request);
  require_request(!request.record.devices && !request.record.seed, [] {
    return fmt::format("{}, {}: must be given together with {}", requested("devices"), requested("seed"),
                       requested("contact-record"));
  });
  std::error_code ignored;
  if (setting.note && std::filesystem::exists(std::filesystem::path(setting.name) / "tune.json", ignored))
    setting.note(
        "this waveform was tuned on one device (tune.json holds its expected figures); the nominal design may bounce under it");
  return {.text = exported_text(setting.scene, request, setting.progress, setting.note)};
}

}  // namespace

Study export_study() { return study_of<ExportVerb>(); }

}  // namespace softland::verbs
