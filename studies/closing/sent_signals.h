// The drives of a scene for export to generators and circuit simulators.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "studies/closing/prepared.h"
#include "waveforms/signal.h"

namespace softland {

/// Voltages of the scene as its sources apply them, without the factor of the dispersion force.
[[nodiscard]] std::map<std::string, Signal> named_signals(const PreparedScene& prepared);

/// Signals for export: the commanded signals (the samples of sources that take these), or the outputs of the sources.
enum class Sent { told, output };
struct SentSignals {
  std::map<std::string, Signal> signals;
  std::map<std::string, double> sample_rates = {};  ///< rates of sampled signals [Hz]
  /// Gains of the amplifiers: volts at the switch, as signals are, per volt of the source.
  std::map<std::string, double> amplifiers = {};
};
/// Returns the signals for one waveform per drive in the order of Switch::drives().
[[nodiscard]] SentSignals sent_signals(const PreparedScene& prepared, const std::vector<Waveform>& waveforms,
                                       Sent sent = Sent::told);
/// The commanded signals of the scene's sources, as CSV: read back under the same drivers they give the same closing.
[[nodiscard]] std::string told_csv(const PreparedScene& prepared);

}  // namespace softland
