// The waveforms of a result, for a generator or a simulator of circuits.
#include "waveforms/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/exit_status.h"
#include "apps/progress.h"
#include "apps/scenes.h"
#include "apps/streams.h"
#include "apps/values.h"
#include "apps/verbs/verbs.h"
#include "base/require.h"
#include "config/units.h"
#include "studies/choices.h"
#include "studies/ensemble.h"

namespace softland::apps {
namespace {

struct ExportRequest {
  std::string result, format = "csv";
  std::optional<std::string> device_pull_in, device_frequency;  ///< measured on the device that gets the waveform
};

// What was measured on a device.
std::optional<double> measured(const char* option, const std::optional<std::string>& text, const Dimension& due) {
  if (!text) return std::nullopt;
  Quantity q;
  try {
    q = parse_quantity(*text);
  } catch (const InvalidInput& error) {
    throw InvalidInput(fmt::format("{} {}: {}", option, shown(*text), error.what()));
  }
  require(q.dimension == due && q.value > 0, [&] {
    return fmt::format("{} {}: must be {} above 0, such as \"{}\"", option, shown(*text), describe(due), example(due));
  });
  return q.value;
}

double last_breakpoint(const std::map<std::string, Signal>& signals) {
  double last = 0;
  for (const auto& [name, signal] : signals) last = std::max(last, signal.pieces().back().begin);
  return last;
}

int export_verb(const Common& c, const ExportRequest& request) {
  SceneFile file = scene_of_result(request.result);
  require(request.format == "csv" || request.format == "spice-pwl",
          fmt::format("--format {}: must be csv or spice-pwl", request.format));
  const std::optional<double> pull_in = measured("--device-vdp", request.device_pull_in, dimension::voltage),
                              frequency = measured("--device-frequency", request.device_frequency, dimension::frequency);
  const bool is_own = pull_in || frequency;
  std::optional<WatchedWork> work(std::in_place, c.quiet, c.stop);
  Prepared p = prepare_and_choose(file, is_own, work->watch());
  std::map<std::string, Signal> signals = named_signals(p);
  if (is_own) {
    const DeviceMeter meter(p, pull_in.has_value());
    const Calibration& calibration = p.scene.calibration;
    require(!calibration.classes || (pull_in.has_value() == calibration.pull_in_error.has_value() &&
                                     frequency.has_value() == calibration.frequency_error.has_value()),
            "--device-vdp, --device-frequency: the scene sorts devices into classes: give what [calibration] measures");
    const KnownUnits known = known_units(p, std::array{calibration}, job_count({}), work->watch()).front();
    const DeviceUnits units =
        known.of({.volts = pull_in ? *pull_in / meter.pull_in() : 1, .time = frequency ? meter.frequency() / *frequency : 1});
    p.duration *= std::max(1.0, units.time);  // the window of a slow device
    const std::vector<std::string> names = p.drive_names();
    const std::vector<Waveform> waveforms = in_units(p.in_drive_order(p.drives.waveforms), p.scene.device, units);
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (names[k] != dispersion_drive) signals[names[k]] = p.driven(k, p.told(k, waveforms[k]));
    }
  }
  work.reset();
  const double end = std::max(p.duration, last_breakpoint(signals));  // the hold level belongs to the waveform
  print(request.format == "csv" ? csv(signals, end) : spice_pwl(signals, end));
  return exit_done;
}

}  // namespace

void add_export(Verb& verb) {
  const auto request = std::make_shared<ExportRequest>();
  verb.positional("RESULT", request->result, "folder that --out named, result.json, or a scene file");
  verb.option("--format", request->format, "NAME", "csv (default) or spice-pwl");
  verb.optional("--device-vdp", request->device_pull_in, "VOLTAGE",
                "dynamic pull-in voltage measured on a device: its own waveform, with voltages in proportion");
  verb.optional("--device-frequency", request->device_frequency, "FREQUENCY",
                "first natural frequency measured on a device, with times in proportion to its period");
  verb.footer(
      "Examples:\n  softland export softland-out --format spice-pwl > drive.cir\n"
      "  softland export softland-out --device-vdp \"14.6 V\" --device-frequency \"10.2 kHz\" > device-17.csv");
  verb.runs([request](const Common& common) { return export_verb(common, *request); });
}

}  // namespace softland::apps
