#include "studies/closing/sent_signals.h"

#include <cstddef>

#include "waveforms/export.h"

namespace softland {

std::map<std::string, Signal> named_signals(const PreparedScene& p) {
  std::map<std::string, Signal> all;
  const std::vector<std::string> names = p.drive_names();
  const std::vector<Signal> signals = p.signals();
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] != dispersion_drive) all.emplace(names[k], signals[k]);
  }
  return all;
}

SentSignals sent_signals(const PreparedScene& p, const std::vector<Waveform>& waveforms, Sent sent) {
  SentSignals all;
  const std::vector<std::string> names = p.drive_names();
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] == dispersion_drive) continue;
    const Signal commanded = p.commanded(k, waveforms[k]);
    all.signals.emplace(names[k], sent == Sent::output ? p.applied(k, commanded) : p.commanded_samples(k, commanded));
    if (const auto rate = p.drives[k].source.sample_rate; rate && sent == Sent::commanded)
      all.sample_rates.emplace(names[k], *rate);
    if (p.drives[k].amplifier) all.amplifiers.emplace(names[k], *p.drives[k].amplifier);
  }
  return all;
}

std::string commanded_csv(const PreparedScene& p) {
  const SentSignals sent = sent_signals(p, p.waveforms());
  return csv(sent.signals, p.duration, sent.sample_rates);
}

}  // namespace softland
