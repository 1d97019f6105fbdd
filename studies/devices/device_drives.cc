#include "studies/devices/device_drives.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "waveforms/export.h"

namespace softland {
namespace {

// Returns a number for an edge (jump or ramp) of a drive's waveform, unique over all drives, from which its jitter is drawn.
std::uint64_t number_of_edge(std::size_t drive, std::size_t edge) {
  // Largest number of edges (jumps or ramps) in the waveform of one drive, so that numbers of different drives differ.
  constexpr std::uint64_t most_edges = std::uint64_t{1} << 32;
  return drive * most_edges + edge;
}

// Returns the signal of a drive as a table of voltages over time up to `window` [s]; straight pieces are exact.
Waveform as_table(const Signal& signal, double window) {
  const bool ends_on_sine = signal.pieces().back().oscillates();
  const double last = signal.pieces().back().begin;
  Table table;
  for (const auto& [time, voltage] : polyline(signal, ends_on_sine ? std::max(last, window) : last, 1e-4 * signal.peak(), 0)) {
    table.time.push_back(time);
    table.voltage.push_back(voltage);
  }
  return table;
}

// Returns the member of `errors` that holds the kind `error`; null for jitter, which is not a single number.
double* member_of(SourceErrors& errors, DriveError error) {
  switch (error) {
    case DriveError::gain:
      return &errors.gain;
    case DriveError::offset:
      return &errors.offset;
    case DriveError::delay:
      return &errors.delay;
    case DriveError::jitter:
      break;
  }
  return nullptr;
}

}  // namespace

std::vector<Waveform> in_units(const std::vector<Waveform>& waveforms, const Device& device, const DeviceUnits& units) {
  std::vector<Waveform> own = waveforms;
  const std::size_t piezo = device.piezo ? own.size() - 1 : own.size();
  for (std::size_t k = 0; k < own.size(); ++k) {
    const double factor = k < device.electrodes.size() ? units.volts : k == piezo ? units.piezo : 1;
    own[k] = scaled(std::move(own[k]), factor, units.time);
  }
  return own;
}

// The commanded waveforms of a device, and the errors of its voltage sources. In a source that takes samples, jitter shifts the
// edges before they are sampled, and the other errors act on the samples. Other sources apply all errors together. A varied
// gain scales the waveform, which is possible for every waveform family.
struct DeviceDrives::Driven {
  std::vector<Waveform> waveforms;
  std::vector<Signal> signals;  // commanded voltages of the drives
  std::vector<SourceErrors> errors;
  // Time of the waveforms at which the device's time axis begins [s]: 0, or the first edge that errors move before 0.
  double origin = 0;

  // Returns the commanded signal of drive k with jitter, and the time of the waveform at which the signal begins [s]: 0, or the
  // first edge if jitter moves this edge before 0.
  [[nodiscard]] std::pair<Signal, double> jittered(std::size_t k) const {
    const SourceErrors jitter{.edges = errors[k].edges};
    const double begin = std::min(0.0, first_edge(signals[k], jitter));
    return {jitter.are_none() ? signals[k] : with_errors(signals[k], jitter, begin), begin};
  }
  // Returns the errors of the source of drive k that act after sampling, for a source that takes samples.
  [[nodiscard]] SourceErrors after_samples(std::size_t k) const {
    return {.gain = errors[k].gain, .offset = errors[k].offset, .delay = errors[k].delay - origin + jittered(k).second};
  }
};

DeviceDrives::DeviceDrives(const PreparedScene& nominal) : nominal_(&nominal) {
  const std::vector<std::string> names = nominal.drive_names();
  sources_.resize(names.size());
  const std::vector<SpreadVariable>& variables = nominal.scene.spread.variables;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    for (std::size_t j = 0; j < variables[i].keys.size(); ++j) {
      const VariedKey& key = variables[i].keys[j];
      if (!key.drive) continue;
      const auto drive = static_cast<std::size_t>(std::find(names.begin(), names.end(), key.drive->name) - names.begin());
      sources_[drive].push_back({.variable = i, .key = j, .error = key.drive->error});
      has_errors_ = true;
    }
  }
}

std::vector<double> DeviceDrives::shown(std::vector<double> values) const {
  const std::vector<SpreadVariable>& variables = nominal_->scene.spread.variables;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!variables[i].is_drawn_per_edge) continue;
    const auto has_it = [&](const std::vector<Source>& sources) {
      return std::any_of(sources.begin(), sources.end(), [&](const Source& source) { return source.variable == i; });
    };
    const auto drive = std::find_if(sources_.begin(), sources_.end(), has_it) - sources_.begin();
    values[i] = DeviceSpread::jitter(variables[i], values[i], number_of_edge(static_cast<std::size_t>(drive), 0));
  }
  return values;
}

// Returns the value of an error of a voltage source, other than jitter [SI unit].
double DeviceDrives::value(const Source& source, const std::vector<double>& values) const {
  const SpreadVariable& variable = nominal_->scene.spread.variables[source.variable];
  return DeviceSpread::value(variable, variable.keys[source.key], values[source.variable]);
}

SourceErrors DeviceDrives::errors(std::size_t k, const std::vector<double>& values) const {
  SourceErrors errors = nominal_->drives[k].errors;
  for (const Source& source : sources_[k]) {
    if (double* const member = member_of(errors, source.error)) *member = value(source, values);
  }
  return errors;
}

SourceErrors DeviceDrives::errors_by(std::size_t k, std::size_t i) const {
  SourceErrors slopes{.gain = 0};
  const SpreadVariable& variable = nominal_->scene.spread.variables[i];
  for (const Source& source : sources_[k]) {
    if (source.variable != i) continue;
    if (double* const member = member_of(slopes, source.error))
      *member = variable.is_factor ? variable.keys[source.key].nominal : 1;
  }
  return slopes;
}

DeviceDrives::Driven DeviceDrives::driven(const std::vector<Waveform>& nominal, const DeviceUnits& units,
                                          const std::vector<double>& values) const {
  const std::vector<SpreadVariable>& variables = nominal_->scene.spread.variables;
  Driven all{.waveforms = in_units(nominal, nominal_->scene.device, units), .signals = {}, .errors = {}};
  all.errors.resize(nominal.size());
  for (std::size_t k = 0; k < nominal.size(); ++k) {
    SourceErrors& errors = all.errors[k] = nominal_->drives[k].errors;
    for (const Source& source : sources_[k]) {
      if (source.error == DriveError::gain) errors.gain = value(source, values);
    }
    if (has_errors(k) && !nominal_->drives[k].source.sample_rate)
      all.waveforms[k] = scaled(std::move(all.waveforms[k]), std::exchange(errors.gain, 1), 1);
    all.signals.push_back(nominal_->commanded(k, all.waveforms[k]));
    for (const Source& source : sources_[k]) {
      switch (source.error) {
        case DriveError::gain:
          break;
        case DriveError::offset:
          errors.offset = value(source, values);
          break;
        case DriveError::delay:
          errors.delay = value(source, values);
          break;
        case DriveError::jitter:
          errors.edges.resize(edge_count(all.signals[k]));
          for (std::size_t edge = 0; edge < errors.edges.size(); ++edge)
            errors.edges[edge] =
                DeviceSpread::jitter(variables[source.variable], values[source.variable], number_of_edge(k, edge));
          break;
      }
    }
    all.origin = std::min(all.origin, first_edge(all.signals[k], errors));
  }
  return all;
}

std::vector<Signal> DeviceDrives::signals(const std::vector<Waveform>& nominal, const DeviceUnits& units,
                                          const std::vector<double>& values) const {
  const Driven all = driven(nominal, units, values);
  std::vector<Signal> own;
  for (std::size_t k = 0; k < all.signals.size(); ++k) {
    own.push_back(nominal_->drives[k].source.sample_rate
                      ? nominal_->applied(k, all.jittered(k).first, all.after_samples(k))
                      : nominal_->applied(k, with_errors(all.signals[k], all.errors[k], all.origin), SourceErrors{}));
  }
  return own;
}

std::optional<std::vector<double>> DeviceDrives::gains(const DeviceUnits& units, const std::vector<double>& values) const {
  if (units.volts != 1 || units.piezo != 1 || units.time != 1) return std::nullopt;
  std::vector<double> all;
  for (std::size_t k = 0; k < sources_.size(); ++k) {
    const SourceErrors own = errors(k, values);
    all.push_back(own.gain);
    // A delay below 0 shifts the time axis of all drives: the signals differ from those without errors by more than a factor.
    if (own.delay < 0) return std::nullopt;
    if (sources_[k].empty() && own.gain == 1) continue;
    const bool is_gain = std::ranges::all_of(sources_[k], [](const Source& one) { return one.error == DriveError::gain; });
    // A gain of a voltage source scales neither the voltage before t = 0 nor an offset: the signals with and without the gain
    // then differ by more than a factor.
    if (!is_gain || own.offset != 0 || nominal_->values_before()[k] != 0) return std::nullopt;
  }
  return all;
}

std::vector<Signal> DeviceDrives::without_gains(const std::vector<Waveform>& nominal) const {
  std::vector<Signal> own = nominal_->commanded(nominal);
  for (std::size_t k = 0; k < own.size(); ++k) {
    SourceErrors errors = nominal_->drives[k].errors;
    errors.gain = 1;
    own[k] = nominal_->applied(k, own[k], errors);
  }
  return own;
}

std::vector<DeviceDrives::Written> DeviceDrives::written(const std::vector<Waveform>& nominal, const DeviceUnits& units,
                                                         const std::vector<double>& values) const {
  const Driven all = driven(nominal, units, values);
  std::vector<Written> drives;
  for (std::size_t k = 0; k < all.signals.size(); ++k) {
    Written& one = drives.emplace_back(Written{.waveform = all.waveforms[k]});
    const auto write = [&](const Signal& own) {
      if (own.pieces() != all.signals[k].pieces()) one.waveform = as_table(own, nominal_->duration);
    };
    if (nominal_->drives[k].source.sample_rate) {
      write(all.jittered(k).first);
      one.errors = all.after_samples(k);
      one.errors.delay = std::max(0.0, one.errors.delay);
    } else if (has_errors(k) || all.errors[k].are_none()) {
      write(with_errors(all.signals[k], all.errors[k], all.origin));
    } else {
      one.errors = all.errors[k];
      one.errors.delay -= all.origin;
    }
  }
  return drives;
}

}  // namespace softland
