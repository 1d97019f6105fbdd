// The signals of a scene's drives for export to generators and circuit simulators.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "studies/closing/prepared.h"
#include "waveforms/signal.h"

namespace softland {

/// Returns the applied voltages of the scene by name of the drive. A dispersion force is left out: its drive is not a voltage.
[[nodiscard]] std::map<std::string, Signal> named_signals(const PreparedScene& prepared);

/// The kind of exported signals: commanded signals (samples for sources that take samples), or outputs of the voltage sources.
enum class Sent { commanded, output };
struct SentSignals {
  std::map<std::string, Signal> signals;
  std::map<std::string, double> sample_rates = {};  ///< sample rates of sampled signals, by drive [Hz]
  /// Gains of the amplifiers between voltage sources and switch, by drive. `signals` are voltages at the switch, behind the
  /// amplifiers.
  std::map<std::string, double> amplifiers = {};
};
/// Returns the exported signals for one waveform per drive, in the order of Switch::drives().
[[nodiscard]] SentSignals sent_signals(const PreparedScene& prepared, const std::vector<Waveform>& waveforms,
                                       Sent sent = Sent::commanded);
/// Returns the commanded signals of the scene's voltage sources as CSV. A scene with the same sources that plays this file has
/// the same closing.
[[nodiscard]] std::string commanded_csv(const PreparedScene& prepared);

}  // namespace softland
