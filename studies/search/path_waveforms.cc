#include "studies/search/path_waveforms.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace softland {

DriveWaveforms tables_of(const FirstTouchProblem& flight, const ControlledCourse& course) {
  const double end = course.time * flight.time_unit();
  std::map<std::string, Table> tables;
  const auto add = [&](double time, const std::map<std::string, double>& volts) {
    for (const auto& [name, value] : volts) {
      Table& table = tables[name];
      table.time.push_back(time);
      table.voltage.push_back(value);
    }
  };
  const auto columns = course.controls.cols();
  const auto at = [&](Eigen::Index column) { return flight.volts(course.controls.col(column)); };
  if (flight.ramps()) {
    for (Eigen::Index k = 0; k < columns; ++k) add(course.knots[static_cast<std::size_t>(k)] * end, at(k));
  } else {
    // Controls of neighbouring intervals that differ by less than the error of the optimal control become one constant level.
    constexpr double same = 1e-9;
    Eigen::Index level = 0;
    add(0, at(0));
    for (Eigen::Index k = 1; k < columns; ++k) {
      if ((course.controls.col(k) - course.controls.col(level)).cwiseAbs().maxCoeff() < same) continue;
      const double time = course.knots[static_cast<std::size_t>(k)] * end;
      add(time, at(level));
      add(time, at(k));
      level = k;
    }
    add(end, at(level));
  }
  DriveWaveforms waveforms;
  for (auto& [name, table] : tables) waveforms.emplace(name, std::move(table));
  return waveforms;
}

DriveWaveforms with_catch(const FirstTouchProblem& flight, const LeastTime& found, const Catch& pulled,
                          const DriveWaveforms& held) {
  DriveWaveforms caught = found.waveforms;
  const std::map<std::string, double> pull = flight.volts(flight.pull());
  const double touch = found.course.time * flight.time_unit();
  for (auto& [name, waveform] : caught) {
    auto& table = std::get<Table>(waveform);
    const auto hold_of = held.find(name);
    const double hold = hold_of == held.end() ? 0 : signal(hold_of->second).hold_level();
    const auto pass_to = [&](double time, double volts) {
      const double begin = std::max(time, table.time.back()), from = table.voltage.back();
      table.time.insert(table.time.end(), {begin, begin + std::abs(volts - from) / flight.max_slew(name)});
      table.voltage.insert(table.voltage.end(), {from, volts});
    };
    if (pulled.end > pulled.begin) pass_to(touch + pulled.begin, pull.at(name));
    pass_to(touch + pulled.end, hold);
  }
  return caught;
}

std::vector<Signal> applied(const PreparedScene& prepared, DriveWaveforms searched, const DriveWaveforms& plain) {
  searched.insert(plain.begin(), plain.end());
  return prepared.applied(prepared.waveforms(searched));
}

}  // namespace softland
