#include "waveforms/waveform.h"

#include <type_traits>

namespace softland {
Signal signal(const Waveform& waveform) {
  return std::visit([](const auto& member) { return signal(member); }, waveform);
}

std::string_view family(const Waveform& waveform) {
  return std::visit([](const auto& member) { return FamilyOf<std::decay_t<decltype(member)>>::name; }, waveform);
}

}  // namespace softland
