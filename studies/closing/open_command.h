// The command to open: the instant from which on the drives of a run keep a closed switch in no closed state.
#pragma once

#include <optional>
#include <vector>

#include "model/closing.h"
#include "studies/closing/prepared.h"
#include "waveforms/signal.h"

namespace softland {

struct OpenCommand {
  double time = 0;           ///< [s]
  std::vector<Signal> held;  ///< the drives until then, and constant at their levels from then on
};

/// Finds the command of these drives, one per drive of the switch: the begin of their last fall to levels under which no closed
/// state is stable and the open one is. The levels up to the end of their waveforms count. A switch that starts closed has it
/// in the first such fall. A fall lasts as long as the voltages of the electrodes that make it only go towards 0 V; that of a
/// jump begins at the jump. None if the hold levels keep the switch closed, or collapse it, and if the drives would never have
/// held it.
[[nodiscard]] std::optional<OpenCommand> open_command(const Switch& model, const std::vector<Signal>& signals, StartState start);

/// Finds the command of these drives of a scene: simulate.open_at if the scene has it. It may come after the window.
[[nodiscard]] std::optional<OpenCommand> open_command(const PreparedScene& prepared, const std::vector<Signal>& signals);

/// Returns these drives until they command the switch to open, and constant at their levels from then on; unchanged without a
/// command.
[[nodiscard]] std::vector<Signal> until_command(const PreparedScene& prepared, std::vector<Signal> signals);

/// Returns the scene until its drives command it to open: its window ends there at the latest, and its drives stay at their
/// levels just before. Unchanged without a command, and if it starts closed.
[[nodiscard]] PreparedScene closing_of(const PreparedScene& prepared);

/// The place of the connection in a state of the beam, as observers of a closing get it (model/closing/connection.h) [m].
[[nodiscard]] double connection_deflection(const Switch& model, const Eigen::VectorXd& q);

/// Returns the options for a run that opens on command under these drives: with the place at which the connection comes to
/// rest.
[[nodiscard]] MetricsOptions with_opening(MetricsOptions options, const Switch& model, const std::vector<Signal>& signals,
                                          const std::optional<OpenCommand>& command);

}  // namespace softland
