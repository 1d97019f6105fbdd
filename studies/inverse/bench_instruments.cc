#include "studies/inverse/bench_instruments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "base/require.h"
#include "studies/closing/actuator.h"

namespace softland {
namespace {

std::string wrong(const BenchMeasurement& m, std::string_view rule) {
  return fmt::format("{}: {}: {}", m.place, m.quantity, rule);
}

std::size_t drive_of(const PreparedScene& p, const BenchMeasurement& m) {
  const std::vector<std::string> names = p.drive_names();
  if (!m.drive.empty()) {
    const auto found = std::find(names.begin(), names.end(), m.drive);
    require(found != names.end(),
            [&] { return wrong(m, fmt::format("the scene has no drive '{}' (it has {})", m.drive, fmt::join(names, ", "))); });
    const auto k = static_cast<std::size_t>(found - names.begin());
    require(p.model.drive_kind(k) == DriveKind::electrode || m.quantity == "frequency" || m.quantity == "closing_time",
            [&] { return wrong(m, "must be measured on an electrode"); });
    return k;
  }
  require(has_pulling_electrode(p.scene.device) || m.quantity == "frequency",
          [&] { return wrong(m, "the scene has no electrode that pulls in: give the drive"); });
  return has_pulling_electrode(p.scene.device) ? searched_drive(p.scene.device) : 0;
}

std::vector<Waveform> waveforms_of(const PreparedScene& p, const BenchMeasurement& m) {
  if (*m.waveform == "scene") return p.waveforms();
  DriveWaveforms all;
  std::string first_fault;
  for (const std::string& name : p.drive_names()) {
    try {
      all.emplace(name, read_table(*m.waveform, name));
    } catch (const InvalidInput& error) {
      if (first_fault.empty()) first_fault = error.what();
    }
  }
  require(!all.empty(), [&] { return wrong(m, first_fault); });
  return p.in_drive_order(all);
}

}  // namespace

Instrument instrument_of(const PreparedScene& p, const BenchMeasurement& m, std::size_t i) {
  Instrument one{.what = std::ranges::find(measurables, m.quantity, &MeasurableRow::name)->value,
                 .drive = drive_of(p, m),
                 .mode = static_cast<std::size_t>(m.mode - 1)};
  require(m.mode <= p.model.modes(), [&] { return wrong(m, fmt::format("the scene has {} modes", p.model.modes())); });
  if (m.waveform) one.waveforms = waveforms_of(p, m);
  if (!m.levels.empty()) one.level = m.levels[i];
  const bool closes = one.what != Measurable::pull_in && one.what != Measurable::release && one.what != Measurable::frequency &&
                      one.what != Measurable::capacitance;
  if (closes && !m.waveform && m.levels.empty()) one.waveforms = p.waveforms();
  one.times = m.times;
  one.edges = m.values.size();
  const bool needs_contact = closes && one.what != Measurable::position && one.what != Measurable::velocity;
  require(p.model.has_contact() || (!needs_contact && one.what != Measurable::release),
          [&] { return wrong(m, "the scene has no [contact]"); });
  return one;
}

}  // namespace softland
