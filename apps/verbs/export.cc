// The waveforms of a result, for a generator or a simulator of circuits.
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>

#include "apps/exit_status.h"
#include "apps/progress.h"
#include "apps/scenes.h"
#include "apps/streams.h"
#include "apps/values.h"
#include "apps/verbs/verbs.h"
#include "reports/scene_export.h"

namespace softland::apps {
namespace {

struct ExportedResult {
  std::string result;
  ExportRequest how;
};

int export_verb(const Common& c, const ExportedResult& request) {
  const SceneFile file = scene_of_result(request.result);
  std::error_code ignored;
  if (!c.quiet && std::filesystem::exists(std::filesystem::path(request.result) / "tune.json", ignored))
    say("this waveform was tuned on one device, of which tune.json has what is expected; it need not land the nominal design");
  ExportRequest how = request.how;
  how.jobs = job_count({});
  std::string text;
  {
    const WatchedWork work(c.quiet, c.stop);
    text = exported_text(file, how, work.watch(), [](const std::string& line) { say(with_fields(line, "--")); });
  }
  print(text);
  return exit_done;
}

}  // namespace

void add_export(Verb& verb) {
  const auto request = std::make_shared<ExportedResult>();
  verb.positional("RESULT", request->result, "folder that --out named, result.json, or a scene file");
  verb.option(
      "--format", request->how.format, "NAME",
      "csv (default), spice-pwl, codes, keysight-arb, siglent-csv, tektronix-csv, rigol-csv, digilent-csv, spice-model, "
      "spice-bench or verilog-a; codes are the samples as integers 0 to 2^bits - 1; files for a generator come with how the "
      "switch closes under these samples; the last three are the switch itself for a circuit, spice-bench with its drives: "
      "a run of ngspice");
  verb.optional("--sample-rate", request->how.sampling.rate, "RATE",
                "samples at this rate, instead of what [driver] says: \"27 MHz\"");
  verb.optional("--bits", request->how.sampling.bits, "N",
                "rounded to 2^N voltages between the limits of [driver], instead of what it says");
  verb.optional(
      "--amplifier", request->how.sampling.amplifier, "K",
      "an amplifier between generator and switch, instead of the amplifier of [driver]: volts of a generator's file are those "
      "at the switch over K");
  verb.optional("--marker", request->how.sampling.marker, "TIME", "where the sync output of the generator falls (keysight-arb)");
  verb.option("--drive", request->how.sampling.drive, "DRIVE", "of several drives this one alone");
  verb.option("--signal", request->how.signal, "NAME",
              "told (default) or output: what the source is told, the samples of one that takes some, or what it makes of that");
  verb.option(
      "--measured", request->how.measured, "WHAT",
      "measured on a device, \"Vdp=54.2 V,frequency=10.2 kHz\" or one of them: its own waveform, with voltages in "
      "proportion to the dynamic pull-in voltage, and times to the period; \"time=36.1 us\", the closing time under a step "
      "to 1.2 Vdp of the nominal device, tells the voltages as well; \"piezo=1.6 %/V\", the static deflection of the contact "
      "point per volt on the piezo over the contact gap (31 nm/V over the 2 um that the closed switch is deflected by: one "
      "instrument reads both), tells those of the piezo, which else are the nominal device's");
  verb.optional("--device-vdp", request->how.device_pull_in, "VOLTAGE", "the same as --measured \"Vdp=VOLTAGE\"");
  verb.optional("--device-frequency", request->how.device_frequency, "FREQUENCY",
                "the same as --measured \"frequency=FREQUENCY\": the first natural frequency");
  verb.footer(
      "Examples:\n  softland export softland-out --format spice-pwl > drive.cir\n"
      "  softland export softland-out --drive piezo --format keysight-arb --sample-rate \"25 MHz\" --bits 14 --amplifier 20 > "
      "piezo.arb\n"
      "  softland export softland-out --measured \"Vdp=14.6 V,frequency=10.2 kHz\" > device-17.csv\n"
      "  softland export softland-out --measured \"Vdp=14.6 V,frequency=10.2 kHz,piezo=1.6 %/V\" > device-17.csv");
  verb.runs([request](const Common& common) { return export_verb(common, *request); });
}

}  // namespace softland::apps
