#include "waveforms/waveform.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace softland {
namespace {

double factor_of(ParameterKind kind, double volts, double time) {
  switch (kind) {
    case ParameterKind::level:
    case ParameterKind::swing:
      return volts;
    case ParameterKind::time:
    case ParameterKind::end_time:
      return time;
    case ParameterKind::angular_frequency:
      return 1 / time;
    case ParameterKind::angle:
    case ParameterKind::ratio:
      break;
  }
  return 1;
}

template <class Family>
void scale(Family& family, double volts, double time) {
  for (const Parameter<Family>& parameter : FamilyOf<Family>::parameters) {
    const double factor = factor_of(parameter.kind, volts, time);
    if (const auto* one = std::get_if<double Family::*>(&parameter.member)) {
      family.** one *= factor;
    } else {
      for (double& value : family.*std::get<std::vector<double> Family::*>(parameter.member)) value *= factor;
    }
  }
}

void scale(Own& own, double volts, double time) {
  own.volts *= volts;
  own.time *= time;
}

}  // namespace

Signal signal(const Waveform& waveform, double before) {
  return std::visit([&](const auto& member) { return signal(member, before); }, waveform);
}

std::vector<Signal> signals_of(const std::vector<Waveform>& waveforms) {
  std::vector<Signal> signals;
  for (const Waveform& waveform : waveforms) signals.push_back(signal(waveform));
  return signals;
}

DriverLimits limits_for(const Waveform& waveform, DriverLimits limits) {
  if (!std::holds_alternative<Own>(waveform)) return limits;
  constexpr double of_slew = 1e-3;
  const double missed = own_waveform_accuracy * std::max(std::abs(limits.min_voltage), std::abs(limits.max_voltage));
  return {.min_voltage = limits.min_voltage - missed,
          .max_voltage = limits.max_voltage + missed,
          .max_slew = limits.max_slew * (1 + of_slew)};
}

Waveform scaled(Waveform waveform, double volts, double time) {
  std::visit([&](auto& family) { scale(family, volts, time); }, waveform);
  return waveform;
}

std::string_view family(const Waveform& waveform) {
  if (const Own* own = std::get_if<Own>(&waveform)) return own->waveform->name();
  return std::visit([](const auto& member) { return FamilyOf<std::decay_t<decltype(member)>>::name; }, waveform);
}

}  // namespace softland
