#include "waveforms/waveform.h"

namespace softland {
namespace {

constexpr std::string_view name(const Step&) { return "step"; }
constexpr std::string_view name(const Harmonic&) { return "harmonic"; }
std::string_view name(const Pulse&) { return "pulse"; }
std::string_view name(const Table&) { return "table"; }

}  // namespace

Signal signal(const Waveform& waveform) {
  return std::visit([](const auto& member) { return signal(member); }, waveform);
}

std::string_view family(const Waveform& waveform) {
  return std::visit([](const auto& member) { return name(member); }, waveform);
}

}  // namespace softland
