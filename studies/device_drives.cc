#include "studies/device_drives.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "waveforms/export.h"

namespace softland {
namespace {

// Over all drives.
std::uint64_t number_of_edge(std::size_t drive, std::size_t edge) {
  constexpr std::uint64_t most_edges = std::uint64_t{1} << 32;  // of one drive
  return drive * most_edges + edge;
}

// Straight pieces come out exact.
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

}  // namespace

std::vector<Waveform> in_units(const std::vector<Waveform>& waveforms, const Device& device, const DeviceUnits& units) {
  std::vector<Waveform> own = waveforms;
  for (std::size_t k = 0; k < own.size(); ++k)
    own[k] = scaled(std::move(own[k]), k < device.electrodes.size() ? units.volts : 1, units.time);
  return own;
}

// The waveforms with units and gain, which every family can express, and what is left.
struct DeviceDrives::Driven {
  std::vector<Waveform> waveforms;
  std::vector<Signal> signals;  // of those
  std::vector<SourceErrors> errors;
  double origin = 0;  // of the clock [s]

  [[nodiscard]] Signal signal(std::size_t k) const { return with_errors(signals[k], errors[k], origin); }
};

DeviceDrives::DeviceDrives(const Prepared& nominal) : nominal_(&nominal) {
  const std::vector<std::string> names = nominal.drive_names();
  sources_.resize(names.size());
  const std::vector<SpreadVariable>& variables = nominal.scene.spread.variables;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    for (const VariedKey& key : variables[i].keys) {
      if (!key.drive) continue;
      const auto drive = static_cast<std::size_t>(std::find(names.begin(), names.end(), key.drive->name) - names.begin());
      sources_[drive].push_back({.variable = i, .error = key.drive->error});
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

DeviceDrives::Driven DeviceDrives::driven(const std::vector<Waveform>& nominal, const DeviceUnits& units,
                                          const std::vector<double>& values) const {
  const std::vector<SpreadVariable>& variables = nominal_->scene.spread.variables;
  Driven all{.waveforms = in_units(nominal, nominal_->scene.device, units), .signals = {}, .errors = {}};
  all.errors.resize(nominal.size());
  for (std::size_t k = 0; k < nominal.size(); ++k) {
    SourceErrors& errors = all.errors[k];
    for (const Source& source : sources_[k]) {
      if (source.error == DriveError::gain) all.waveforms[k] = scaled(std::move(all.waveforms[k]), values[source.variable], 1);
    }
    all.signals.push_back(nominal_->told(k, all.waveforms[k]));
    for (const Source& source : sources_[k]) {
      const double value = values[source.variable];
      switch (source.error) {
        case DriveError::gain:
          break;
        case DriveError::offset:
          errors.offset = value;
          break;
        case DriveError::delay:
          errors.delay = value;
          break;
        case DriveError::jitter:
          errors.edges.resize(edge_count(all.signals[k]));
          for (std::size_t edge = 0; edge < errors.edges.size(); ++edge)
            errors.edges[edge] = DeviceSpread::jitter(variables[source.variable], value, number_of_edge(k, edge));
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
  for (std::size_t k = 0; k < all.signals.size(); ++k) own.push_back(nominal_->driven(k, all.signal(k)));
  return own;
}

std::vector<Waveform> DeviceDrives::waveforms(const std::vector<Waveform>& nominal, const DeviceUnits& units,
                                              const std::vector<double>& values) const {
  Driven all = driven(nominal, units, values);
  for (std::size_t k = 0; k < all.signals.size(); ++k) {
    const Signal own = all.signal(k);
    if (own.pieces() != all.signals[k].pieces()) all.waveforms[k] = as_table(own, nominal_->duration);
  }
  return std::move(all.waveforms);
}

}  // namespace softland
