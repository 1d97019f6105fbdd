// The drives of a scene as what leaves softland for generators and simulators of circuits.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "studies/closing/prepared.h"
#include "waveforms/signal.h"

namespace softland {

/// Voltages of the scene as its sources give them: the factor of the dispersion force is none.
[[nodiscard]] std::map<std::string, Signal> named_signals(const PreparedScene& prepared);

/// What goes to generators and simulators of circuits: what sources are told, of those that take samples these, or what they
/// make of it.
enum class Sent { told, output };
struct SentSignals {
  std::map<std::string, Signal> signals;
  std::map<std::string, double> sample_rates = {};  ///< of those that are samples [Hz]
  std::map<std::string, double> amplifiers =
      {};  ///< of those that have one: volts at the switch, as signals are, per volt of the source
};
/// Of one waveform per drive in the order of Switch::drives().
[[nodiscard]] SentSignals sent_signals(const PreparedScene& prepared, const std::vector<Waveform>& waveforms,
                                       Sent sent = Sent::told);
/// What the sources of the scene are told, as CSV: read back under the same drivers it gives the same closing.
[[nodiscard]] std::string told_csv(const PreparedScene& prepared);

}  // namespace softland
