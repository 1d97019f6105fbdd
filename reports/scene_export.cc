#include "reports/scene_export.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "base/choice.h"
#include "base/require.h"
#include "base/shortened.h"
#include "base/split.h"
#include "config/assumed_spread.h"
#include "config/quantity_argument.h"
#include "config/units.h"
#include "document/quantity.h"
#include "exchange/generator.h"
#include "reports/circuit_model.h"
#include "studies/closing/auto_settings.h"
#include "studies/closing/sent_signals.h"
#include "studies/devices/device_drives.h"
#include "studies/devices/ensemble.h"
#include "waveforms/export.h"
#include "waveforms/limits.h"

namespace softland {
namespace {

using internal::plain_number;
using NoteSink = std::function<void(const std::string&)>;

constexpr double usual_error = 0.01;  // relative error of a measurement on a device for which the scene gives no error

// Formats for other programs than waveform generators.
constexpr std::array<std::string_view, 6> other_formats{"csv", "spice-pwl", "codes", "spice-model", "spice-bench", "verilog-a"};

// Returns the format of a waveform generator; null for any other format. Throws InvalidInput for an unknown format.
const GeneratorFormat* generator_format(const std::string& name) {
  if (std::ranges::find(other_formats, name) != other_formats.end()) return nullptr;
  std::vector<std::string_view> names(other_formats.begin(), other_formats.end());
  for (const GeneratorFormat& format : generator_formats()) {
    if (format.name == name) return &format;
    names.push_back(format.name);
  }
  throw InvalidRequest(fmt::format("{} {}: must be one of {}", requested("format"), visible(name), fmt::join(names, ", ")));
}

struct SentRow {
  Sent value;
  std::string_view name;
};
constexpr auto sent_names = std::to_array<SentRow>({{Sent::commanded, "told"}, {Sent::output, "output"}});
static_assert(is_complete<sent_names>());

// A quantity measured on a device.
struct Measured {
  std::string_view name;
  Dimension due;
  std::string said = {};  // text of the measured quantity as the user gave it
  std::optional<double> value = {};

  void read(const std::string& option, const std::string& text) {
    require_request(!value, [&] { return fmt::format("{} {}: {} is given twice", option, visible(text), name); });
    Quantity q;
    try {
      q = quantity_with_unit(text, due);
    } catch (const InvalidInput& error) {
      throw InvalidRequest(fmt::format("{} {}: {}", option, visible(text), error.what()));
    }
    require_request(q.dimension == due && q.value > 0, [&] {
      return fmt::format("{} {}: must be {} above 0, such as \"{}\"", option, visible(text), describe(due), example(due));
    });
    value = q.value;
    said = fmt::format("{} {}", option, visible(text));
  }
};

// The measurements on the device for which the waveforms are exported.
struct Measurements {
  Measured pull_in{.name = measured_pull_in, .due = dimension::voltage};
  Measured frequency{.name = measured_frequency, .due = dimension::frequency};
  // Measured deflection of the contact per volt of the piezo, divided by the contact gap.
  Measured piezo{.name = measured_piezo, .due = dimension::inverse_voltage};
  // Measured closing time under a voltage step to closing_step times Vdp, the dynamic pull-in voltage.
  Measured time{.name = measured_time, .due = dimension::time};

  explicit Measurements(const ExportRequest& request) {
    if (request.device_pull_in) pull_in.read(requested("device-vdp"), *request.device_pull_in);
    if (request.device_frequency) frequency.read(requested("device-frequency"), *request.device_frequency);
    if (request.measured.empty()) return;
    for (const std::string& one : split(request.measured, ',')) {
      const std::size_t sign = one.find('=');
      const std::string name = one.substr(0, sign);
      Measured* const known = sign == std::string::npos ? nullptr
                              : name == pull_in.name    ? &pull_in
                              : name == frequency.name  ? &frequency
                              : name == piezo.name      ? &piezo
                              : name == time.name       ? &time
                                                        : nullptr;
      require_field(known != nullptr, "measured", visible(request.measured), [&] {
        return fmt::format("unknown measurement '{}'; choose from {}, such as \"{}=54.2 V\"", visible(one),
                           in_words(measurement_names), pull_in.name);
      });
      known->read(fmt::format("{} {} =", requested("measured"), name), one.substr(sign + 1));
    }
    require_request(!time.value || !pull_in.value, [] {
      return requested("measured") + ": a closing time and Vdp both set the voltage scale of a device: give one of them";
    });
  }
  [[nodiscard]] bool are_none() const { return !pull_in.value && !frequency.value && !piezo.value && !time.value; }
  [[nodiscard]] const std::string& said() const {
    return pull_in.value ? pull_in.said : time.value ? time.said : piezo.value ? piezo.said : frequency.said;
  }
};

// Returns the relative error of a measurement on a device: that of the scene's section [calibration], or a default, with a
// remark.
double error_of(const Measured& measured, const std::optional<double>& given, const NoteSink& note) {
  if (given && *given > 0) return *given;
  note(fmt::format("{}: its error is taken to be {}, because [calibration] gives none for {}", measured.said,
                   plain_number(100 * usual_error) + " %", measured.name));
  return usual_error;
}

// Warns if the measured device differs from the nominal device by much more than devices with the process variation of [spread]
// do, whose standard deviation is `deviation`. The argument `ratio` is the voltage or time unit from the measurement divided by
// that of the nominal device; `own` is the measured value divided by the nominal value.
void warn_if_strange(const Measured& measured, double own, double ratio, double deviation, const std::optional<double>& error,
                     const NoteSink& note) {
  constexpr double strange = 4;
  const double off = std::abs(ratio - 1), sigma = std::hypot(deviation, error_of(measured, error, note));
  if (off <= strange * sigma) return;
  note(
      fmt::format("warning: {}: it differs from the nominal device by {} %, {} times the standard deviation of devices and "
                  "measurement; check that it was measured on this switch",
                  measured.said, plain_number(100 * std::abs(own - 1), 3), plain_number(off / sigma, 2)));
}

// Returns the scene as it is, or with the usual process variation if the scene gives none.
PreparedScene with_spread(const PreparedScene& p) {
  SceneFile file = p.scene.file;
  return assume_spread(file) ? prepare(file) : p;
}

// Returns the factors by which the voltages and times of a waveform are scaled for the device with these measurements.
DeviceUnits units_of(const PreparedScene& p, const Measurements& measured, int jobs, const Progress& progress,
                     const NoteSink& note) {
  const PullInMeter meter(p, {.pull_in = measured.pull_in.value.has_value(),
                              .closing_time = measured.time.value.has_value(),
                              .piezo = measured.piezo.value.has_value()});
  const Calibration& calibration = p.scene.calibration;
  require_request(!calibration.classes || (measured.pull_in.value.has_value() == calibration.pull_in_error.has_value() &&
                                           measured.frequency.value.has_value() == calibration.frequency_error.has_value() &&
                                           measured.piezo.value.has_value() == calibration.piezo_error.has_value() &&
                                           measured.time.value.has_value() == calibration.time_error.has_value()),
                  [] {
                    return fmt::format(
                        "{}, {}, {}: the scene sorts devices into classes; give the measurements that [calibration] names",
                        requested("measured"), requested("device-vdp"), requested("device-frequency"));
                  });
  const DeviceUnits told = measured.time.value ? meter.units_by_time(*measured.time.value) : DeviceUnits{};
  const double volts = measured.pull_in.value ? *measured.pull_in.value / meter.pull_in() : told.volts,
               time = meter.frequency() / measured.frequency.value.value_or(meter.frequency()),
               piezo = measured.piezo.value ? PullInMeter::piezo_unit(p.model) / *measured.piezo.value : 1;
  const bool by_volts = measured.pull_in.value || measured.time.value;
  const DeviceUnits deviation = deviation_of_units(with_spread(p), by_volts, jobs, progress);
  if (measured.time.value)
    warn_if_strange(measured.time, *measured.time.value / meter.closing_time(), volts, deviation.volts,
                    told.volts_by_time * calibration.time_error.value_or(usual_time_error), note);
  if (measured.pull_in.value) warn_if_strange(measured.pull_in, volts, volts, deviation.volts, calibration.pull_in_error, note);
  if (measured.frequency.value)
    warn_if_strange(measured.frequency, 1 / time, 1 / time, deviation.time, calibration.frequency_error, note);
  if (measured.piezo.value) warn_if_strange(measured.piezo, 1 / piezo, 1 / piezo, deviation.piezo, calibration.piezo_error, note);
  const MeasuredUnits known = measured_units(p, std::array{calibration}, jobs, progress).front();
  return known.of({.volts = volts, .time = time, .piezo = piezo, .volts_by_time = told.volts_by_time});
}

// Returns the waveforms scaled for the device with these measurements. Throws InvalidInput if a voltage source cannot produce
// them.
std::vector<Waveform> waveforms_of(const PreparedScene& p, const Measurements& measured, int jobs, const Progress& progress,
                                   const NoteSink& note) {
  const std::vector<Waveform> own = in_units(p.waveforms(), p.scene.device, units_of(p, measured, jobs, progress, note));
  const std::vector<std::string> names = p.drive_names();
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (!p.drives[k].limits) continue;
    const std::string broken = violation(p.commanded(k, own[k]), p.limits(k));
    const std::string& said = measured.said();
    require_request(broken.empty(),
                    [&] { return fmt::format("{}: the waveform of this device: drive '{}': {}", said, names[k], broken); });
  }
  return own;
}

// Returns the waveforms of electrodes and piezos whose voltage source has a number of bits, for export as integers; `note`
// receives the names of the others.
std::map<std::string, Coded> coded(const PreparedScene& p, const SentSignals& sent, const NoteSink& note) {
  std::map<std::string, Coded> all;
  const std::vector<std::string> names = p.drive_names();
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto signal = sent.signals.find(names[k]);
    if (signal == sent.signals.end()) continue;
    const DriverModel& source = p.drives[k].source;
    if (!source.bits) {
      note(fmt::format("drive '{}' is left out: [driver.{}] has no sample_rate and bits", names[k], names[k]));
      continue;
    }
    const DriverLimits limits = p.limits(k);
    all.emplace(names[k], Coded{.held = signal->second,
                                .sample_rate = *source.sample_rate,
                                .bits = *source.bits,
                                .minimum = limits.min_voltage,
                                .maximum = limits.max_voltage});
  }
  require_field(!all.empty(), "format", "codes", [] {
    return "no driver takes samples: give [driver.NAME] a sample_rate and bits, or use --sample-rate and --bits";
  });
  return all;
}

double last_breakpoint(const std::map<std::string, Signal>& signals) {
  double last = 0;
  for (const auto& [name, signal] : signals) last = std::max(last, signal.pieces().back().begin);
  return last;
}

// The exported scene, with the sampling that the request specifies.
struct Exported {
  PreparedScene sampled;
  // Scene with the original waveforms, without sampling; set only if the request specifies samples.
  std::optional<PreparedScene> drawn;
  std::vector<std::string> drives;
};
Exported exported(SceneFile file, const ExportRequest& request, bool need_pull_in, const Progress& progress) {
  PreparedScene drawn = prepare_and_choose(file, need_pull_in, progress);
  std::vector<std::string> drives = exported_drives(drawn, request.sampling.drive);
  if (!request.sampling.rate && !request.sampling.bits) return {std::move(drawn), std::nullopt, std::move(drives)};
  set_sampling(file, drives, request.sampling);
  return {prepare_and_choose(file, need_pull_in, progress), std::move(drawn), std::move(drives)};
}

// Writes the signals of the electrodes and piezos as a file of the given format; the file of a generator has a single signal.
std::string sent_text(const std::string& format, const PreparedScene& p, const std::vector<std::string>& drives,
                      const SentSignals& sent, double end, const Sampling& sampling, const NoteSink& note) {
  if (format == "csv") return csv(sent.signals, end, sent.sample_rates);
  if (format == "spice-pwl") return spice_pwl(sent.signals, end);
  const GeneratorFormat* const generator = generator_format(format);
  if (generator == nullptr) return codes(coded(p, sent, note));
  require_field(drives.size() == 1, "format", format, [&] {
    return fmt::format("a file holds one drive: choose it with {}, one of {}", requested("drive"), fmt::join(drives, ", "));
  });
  return generator_text(*generator, p, drives.front(), sent.signals.at(drives.front()), sampling);
}

constexpr std::array<std::string_view, 3> circuits{"spice-model", "spice-bench", "verilog-a"};

// Returns the file name ending of a format, such as ".arb".
std::string_view ending_of(const std::string& format) {
  return format == "spice-pwl" ? ".cir" : format == "keysight-arb" ? ".arb" : ".csv";
}

// Returns the circuit model if `format` is one; none for other formats. Throws InvalidInput for a switch without a circuit
// model.
std::optional<std::string> circuit(const std::string& format, const PreparedScene& p) {
  if (format == "spice-model") return spice_model(p);
  if (format == "spice-bench") return spice_bench(p);
  if (format == "verilog-a") return verilog_a(p);
  return std::nullopt;
}

}  // namespace

std::string exported_text(const SceneFile& file, const ExportRequest& request, const Progress& progress, const NoteSink& told) {
  const NoteSink note = [&](const std::string& line) {
    if (told) told(line);
  };
  const GeneratorFormat* const generator = generator_format(request.format);
  const SentRow* const row = find_named(sent_names, request.signal);
  require_field(row != nullptr, "signal", visible(request.signal), [] { return "must be told or output"; });
  const Sent sent_as = row->value;
  require_request((request.format != "codes" && generator == nullptr) || sent_as == Sent::commanded, [&] {
    return fmt::format("{} {} {} output: a generator takes the commanded samples, not the output of its source",
                       requested("format"), request.format, requested("signal"));
  });
  require_request(generator != nullptr || (!request.sampling.amplifier && !request.sampling.marker), [&] {
    return fmt::format("{}, {}: belong to the file of a generator, which {} {} is not", requested("amplifier"),
                       requested("marker"), requested("format"), request.format);
  });
  const Measurements measured(request);
  const Exported what = exported(file, request, !measured.are_none(), progress);
  const PreparedScene& p = what.sampled;
  if (std::optional<std::string> model = circuit(request.format, p)) {
    require_field(measured.are_none(), "format", request.format,
                  [] { return "belongs to the nominal design, not to a measured device"; });
    for (const std::string& line : renamed_pins(p.drive_names())) note(line);
    return *std::move(model);
  }
  SentSignals sent =
      sent_signals(p, measured.are_none() ? p.waveforms() : waveforms_of(p, measured, request.jobs, progress, note), sent_as);
  if (const SceneFile& scene = p.scene.file; sent.signals.empty()) {
    constexpr std::string_view none = "there is no waveform to export";
    for (const std::string& drive : scene.keys("waveform"))
      scene.refuse("waveform." + drive, fmt::format("{}: '{}' is a factor of the model, not a voltage of a source", none, drive));
    throw InvalidInput(fmt::format("{}: {}; there must be at least one", scene.name(), none));
  }
  if (!request.sampling.drive.empty())
    std::erase_if(sent.signals, [&](const auto& one) { return one.first != request.sampling.drive; });
  if (generator == nullptr && request.format != "codes") {
    for (const auto& [name, amplifier] : sent.amplifiers) {
      if (sent.signals.contains(name))
        note(fmt::format(
            "amplifier of drive '{}': voltages are those at the switch, {} V for each volt of its source ([driver.{}])", name,
            plain_number(amplifier, 6), name));
    }
  }
  // Export at least until the last change of any waveform, so that the file contains the hold levels.
  const double end = std::max(p.duration, last_breakpoint(sent.signals));
  std::string text = sent_text(request.format, p, what.drives, sent, end, request.sampling, note);
  if (generator == nullptr) return text;
  const Drive& drive = p.drives.at(what.drives.front());
  if (const std::string words = amplifier_prose(drive, amplification(drive, request.sampling)); !words.empty()) note(words);
  if (measured.are_none()) {
    for (const std::string& line : sampled_prose(p, what.drawn ? &*what.drawn : nullptr, what.drives.front(), progress))
      note(line);
  }
  return text;
}

std::vector<SentFile> sent_files(const std::string& format, const PreparedScene& p, const SentSignals& sent, double end) {
  const auto text = [&](const std::vector<std::string>& drives, const SentSignals& signals) {
    return sent_text(format, p, drives, signals, end, {}, [](const std::string&) {});
  };
  const std::string ending(ending_of(format));
  if (generator_format(format) == nullptr) {
    SentSignals before = sent;
    for (const auto& [drive, amplifier] : sent.amplifiers) {
      Signal& signal = before.signals.at(drive);
      if (format != "codes") signal = scaled(signal, 1 / amplifier);
    }
    return {{.ending = ending, .text = text({}, before)}};
  }
  std::vector<SentFile> files;
  for (const auto& [drive, signal] : sent.signals) {
    if (!signal.is_zero()) files.push_back({.ending = "-" + drive + ending, .text = text({drive}, sent)});
  }
  return files;
}

std::vector<std::string> sent_endings(const PreparedScene& p) {
  std::vector<std::string> all{".csv", ".cir"};
  for (const std::string& drive : p.drive_names()) {
    for (const char* ending : {".csv", ".arb"}) all.push_back("-" + drive + ending);
  }
  return all;
}

void require_shots(const std::string& format, const PreparedScene& p, const std::vector<std::string>& drives) {
  const bool is_for_generator = generator_format(format) != nullptr;
  require_field(std::ranges::find(circuits, format) == circuits.end(), "format", format,
                [] { return "is a model of the switch, not a waveform for a generator"; });
  for (const std::string& drive : drives) {
    const DriverModel& source = p.drives.at(drive).source;
    if (is_for_generator || format == "codes") require_samples(format, drive, source);
    require_field(format != "codes" || source.bits.has_value(), "format", format, [&] {
      return fmt::format("drive '{}' has no integers: give {}, or [driver.{}] bits", drive, requested("bits"), drive);
    });
  }
}

}  // namespace softland
