// The waveforms of a result, for a generator or a simulator of circuits.
#include "waveforms/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
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
#include "base/choice.h"
#include "base/require.h"
#include "config/assumed_spread.h"
#include "config/units.h"
#include "reports/quantity.h"
#include "studies/choices.h"
#include "studies/ensemble.h"

namespace softland::apps {
namespace {

using internal::plain_number;

constexpr double usual_error = 0.01;  // of a measurement whose error nobody gives, relative

struct ExportRequest {
  std::string result, format = "csv", signal = "told";
  std::string measured;                                         ///< "Vdp=54.2 V,frequency=10.2 kHz,piezo=1.6 %/V"
  std::optional<std::string> device_pull_in, device_frequency;  ///< the same, each by itself
};

struct SentRow {
  Sent value;
  std::string_view name;
};
constexpr auto sent_names = std::to_array<SentRow>({{Sent::told, "told"}, {Sent::output, "output"}});
static_assert(is_complete<sent_names>());

// A quantity that was measured on a device.
struct Measured {
  std::string_view name;
  Dimension due;
  std::string said = {};  // how it was given
  std::optional<double> value = {};

  void read(const std::string& option, const std::string& text) {
    require(!value, [&] { return fmt::format("{} {}: {} stands twice", option, shown(text), name); });
    Quantity q;
    try {
      q = parse_quantity(text);
    } catch (const InvalidInput& error) {
      throw InvalidInput(fmt::format("{} {}: {}", option, shown(text), error.what()));
    }
    require(q.dimension == due && q.value > 0, [&] {
      return fmt::format("{} {}: must be {} above 0, such as \"{}\"", option, shown(text), describe(due), example(due));
    });
    value = q.value;
    said = fmt::format("{} {}", option, shown(text));
  }
};

// What was measured on the device that gets the waveform.
struct Measurements {
  Measured pull_in{.name = measured_pull_in, .due = dimension::voltage};
  Measured frequency{.name = measured_frequency, .due = dimension::frequency};
  Measured piezo{.name = measured_piezo, .due = dimension::inverse_voltage};  // its deflection per volt over the contact gap
  Measured time{.name = measured_time, .due = dimension::time};               // of closing under a step to closing_step Vdp

  explicit Measurements(const ExportRequest& request) {
    if (request.device_pull_in) pull_in.read("--device-vdp", *request.device_pull_in);
    if (request.device_frequency) frequency.read("--device-frequency", *request.device_frequency);
    if (request.measured.empty()) return;
    for (const std::string& one : parts_of(request.measured)) {
      const std::size_t sign = one.find('=');
      const std::string name = one.substr(0, sign);
      Measured* const known = sign == std::string::npos ? nullptr
                              : name == pull_in.name    ? &pull_in
                              : name == frequency.name  ? &frequency
                              : name == piezo.name      ? &piezo
                              : name == time.name       ? &time
                                                        : nullptr;
      require(known != nullptr, [&] {
        return fmt::format("--measured {}: '{}' is no measurement; there are {}, such as \"{}=54.2 V\"", shown(request.measured),
                           shown(one), in_words(measurement_names), pull_in.name);
      });
      known->read(fmt::format("--measured {} =", name), one.substr(sign + 1));
    }
    require(!time.value || !pull_in.value,
            "--measured: a closing time tells the volts of a device, as Vdp does: give one of them");
  }
  [[nodiscard]] bool are_none() const { return !pull_in.value && !frequency.value && !piezo.value && !time.value; }
  [[nodiscard]] const std::string& said() const {
    return pull_in.value ? pull_in.said : time.value ? time.said : piezo.value ? piezo.said : frequency.said;
  }
};

// Of a measurement, relative: what [calibration] says, or the usual one, which is told.
double error_of(const Measured& measured, const std::optional<double>& given) {
  if (given && *given > 0) return *given;
  say(fmt::format("{}: taken to be right to {}: [calibration] gives no error of {}", measured.said,
                  plain_number(100 * usual_error) + " %", measured.name));
  return usual_error;
}

// Warns of a device that hardly any is like; `deviation`: of the spread, `ratio`: what is measured over the nominal, relative.
void warn_if_strange(const Measured& measured, double ratio, double deviation, const std::optional<double>& error) {
  constexpr double strange = 4;
  const double off = std::abs(ratio - 1), sigma = std::hypot(deviation, error_of(measured, error));
  if (off <= strange * sigma) return;
  say(
      fmt::format("warning: {}: {} % from the nominal device, {} times the standard deviation of devices and measurement: is "
                  "it this switch?",
                  measured.said, plain_number(100 * off, 3), plain_number(off / sigma, 2)));
}

// The scene, whose devices differ in the usual way where it does not say how.
Prepared with_spread(const Prepared& p) {
  SceneFile file = p.scene.file;
  return assume_spread(file) ? prepare(file) : p;
}

// The units of the device on which this was measured.
DeviceUnits units_of(const Prepared& p, const Measurements& measured, const Watch& watch) {
  const DeviceMeter meter(p, {.pull_in = measured.pull_in.value.has_value(),
                              .closing_time = measured.time.value.has_value(),
                              .piezo = measured.piezo.value.has_value()});
  const Calibration& calibration = p.scene.calibration;
  require(!calibration.classes || (measured.pull_in.value.has_value() == calibration.pull_in_error.has_value() &&
                                   measured.frequency.value.has_value() == calibration.frequency_error.has_value() &&
                                   measured.piezo.value.has_value() == calibration.piezo_error.has_value() &&
                                   measured.time.value.has_value() == calibration.time_error.has_value()),
          "--measured, --device-vdp, --device-frequency: the scene sorts devices into classes: give what [calibration] measures");
  const DeviceUnits told = measured.time.value ? meter.told_by(*measured.time.value) : DeviceUnits{};
  const double volts = measured.pull_in.value ? *measured.pull_in.value / meter.pull_in() : told.volts,
               time = meter.frequency() / measured.frequency.value.value_or(meter.frequency()),
               piezo = measured.piezo.value ? DeviceMeter::piezo_unit(p.model) / *measured.piezo.value : 1;
  const bool by_volts = measured.pull_in.value || measured.time.value;
  const DeviceUnits deviation = deviation_of_units(with_spread(p), by_volts, job_count({}), watch);
  if (measured.time.value)
    warn_if_strange(measured.time, volts, deviation.volts,
                    told.volts_by_time * calibration.time_error.value_or(usual_time_error));
  if (measured.pull_in.value) warn_if_strange(measured.pull_in, volts, deviation.volts, calibration.pull_in_error);
  if (measured.frequency.value) warn_if_strange(measured.frequency, 1 / time, deviation.time, calibration.frequency_error);
  if (measured.piezo.value) warn_if_strange(measured.piezo, 1 / piezo, deviation.piezo, calibration.piezo_error);
  const KnownUnits known = known_units(p, std::array{calibration}, job_count({}), watch).front();
  return known.of({.volts = volts, .time = time, .piezo = piezo, .volts_by_time = told.volts_by_time});
}

// The waveforms of that device. Throws InvalidInput where a source cannot give them.
std::vector<Waveform> waveforms_of(const Prepared& p, const Measurements& measured, const Watch& watch) {
  const std::vector<Waveform> own = in_units(p.in_drive_order(p.drives.waveforms), p.scene.device, units_of(p, measured, watch));
  const std::vector<std::string> names = p.drive_names();
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (!p.drives.limits.contains(names[k])) continue;
    const std::string broken = violation(p.told(k, own[k]), p.limits(k));
    const std::string& said = measured.said();
    require(broken.empty(),
            [&] { return fmt::format("{}: the waveform of this device: drive '{}': {}", said, names[k], broken); });
  }
  return own;
}

// Of the drives that are samples of so many bits; tells which are not.
std::map<std::string, Coded> coded(const Prepared& p, const SentSignals& sent) {
  std::map<std::string, Coded> all;
  const std::vector<std::string> names = p.drive_names();
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto signal = sent.signals.find(names[k]);
    if (signal == sent.signals.end()) continue;
    const DriverModel source = p.source(k);
    if (!source.bits) {
      say(fmt::format("drive '{}' is left out: [driver.{}] has no sample_rate and bits", names[k], names[k]));
      continue;
    }
    const DriverLimits limits = p.limits(k);
    all.emplace(names[k], Coded{.held = signal->second,
                                .sample_rate = *source.sample_rate,
                                .bits = *source.bits,
                                .minimum = limits.min_voltage,
                                .maximum = limits.max_voltage});
  }
  require(!all.empty(), "--format codes: no driver takes samples: give [driver.NAME] a sample_rate and bits");
  return all;
}

double last_breakpoint(const std::map<std::string, Signal>& signals) {
  double last = 0;
  for (const auto& [name, signal] : signals) last = std::max(last, signal.pieces().back().begin);
  return last;
}

int export_verb(const Common& c, const ExportRequest& request) {
  const SceneFile file = scene_of_result(request.result);
  require(request.format == "csv" || request.format == "spice-pwl" || request.format == "codes",
          fmt::format("--format {}: must be csv, spice-pwl or codes", request.format));
  const SentRow* const row = find_named(sent_names, request.signal);
  require(row != nullptr, [&] { return fmt::format("--signal {}: must be told or output", shown(request.signal)); });
  const Sent sent_as = row->value;
  require(request.format != "codes" || sent_as == Sent::told,
          "--format codes --signal output: codes are the samples that a source is told, not its output");
  const Measurements measured(request);
  std::optional<WatchedWork> work(std::in_place, c.quiet, c.stop);
  Prepared p = prepare_and_choose(file, !measured.are_none(), work->watch());
  const SentSignals sent = sent_signals(
      p, measured.are_none() ? p.in_drive_order(p.drives.waveforms) : waveforms_of(p, measured, work->watch()), sent_as);
  work.reset();
  const double end = std::max(p.duration, last_breakpoint(sent.signals));  // the hold level belongs to the waveform
  print(request.format == "csv"         ? csv(sent.signals, end, sent.sample_rates)
        : request.format == "spice-pwl" ? spice_pwl(sent.signals, end)
                                        : codes(coded(p, sent)));
  return exit_done;
}

}  // namespace

void add_export(Verb& verb) {
  const auto request = std::make_shared<ExportRequest>();
  verb.positional("RESULT", request->result, "folder that --out named, result.json, or a scene file");
  verb.option("--format", request->format, "NAME",
              "csv (default), spice-pwl or codes; these are the samples as integers 0 to 2^bits - 1");
  verb.option("--signal", request->signal, "NAME",
              "told (default) or output: what the source is told, the samples of one that takes some, or what it makes of that");
  verb.option(
      "--measured", request->measured, "WHAT",
      "measured on a device, \"Vdp=54.2 V,frequency=10.2 kHz\" or one of them: its own waveform, with voltages in "
      "proportion to the dynamic pull-in voltage, and times to the period; \"time=36.1 us\", the closing time under a step "
      "to 1.2 Vdp of the nominal device, tells the voltages as well; \"piezo=1.6 %/V\", the static deflection of the contact "
      "point per volt on the piezo over the contact gap (31 nm/V over the 2 um that the closed switch is deflected by: one "
      "instrument reads both), tells those of the piezo, which else are the nominal device's");
  verb.optional("--device-vdp", request->device_pull_in, "VOLTAGE", "the same as --measured \"Vdp=VOLTAGE\"");
  verb.optional("--device-frequency", request->device_frequency, "FREQUENCY",
                "the same as --measured \"frequency=FREQUENCY\": the first natural frequency");
  verb.footer(
      "Examples:\n  softland export softland-out --format spice-pwl > drive.cir\n"
      "  softland export softland-out --measured \"Vdp=14.6 V,frequency=10.2 kHz\" > device-17.csv\n"
      "  softland export softland-out --measured \"Vdp=14.6 V,frequency=10.2 kHz,piezo=1.6 %/V\" > device-17.csv");
  verb.runs([request](const Common& common) { return export_verb(common, *request); });
}

}  // namespace softland::apps
