#include "waveforms/waveform.h"

#include <type_traits>

namespace softland {
namespace {

double factor_of(Meaning meaning, double volts, double time) {
  switch (meaning) {
    case Meaning::level:
    case Meaning::swing:
      return volts;
    case Meaning::time:
    case Meaning::end_time:
      return time;
    case Meaning::angular_frequency:
      return 1 / time;
    case Meaning::angle:
    case Meaning::ratio:
      break;
  }
  return 1;
}

template <class Family>
void scale(Family& family, double volts, double time) {
  for (const Parameter<Family>& parameter : FamilyOf<Family>::parameters) {
    const double factor = factor_of(parameter.meaning, volts, time);
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

Waveform scaled(Waveform waveform, double volts, double time) {
  std::visit([&](auto& family) { scale(family, volts, time); }, waveform);
  return waveform;
}

std::string_view family(const Waveform& waveform) {
  if (const Own* own = std::get_if<Own>(&waveform)) return own->waveform->name();
  return std::visit([](const auto& member) { return FamilyOf<std::decay_t<decltype(member)>>::name; }, waveform);
}

}  // namespace softland
