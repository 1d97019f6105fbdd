// The command to open: the instant from which on the drives of a run no longer keep a closed switch closed.
#pragma once

#include <optional>
#include <vector>

#include "model/closing.h"
#include "studies/closing/prepared.h"
#include "waveforms/signal.h"

namespace softland {

struct OpenCommand {
  double time = 0;  ///< time of the command to open [s]
  /// Drive signals unchanged until the command; from then on constant at their levels just before the command.
  std::vector<Signal> held;
};

/// Finds the command to open that these drive signals, one per drive of the switch, give. The command is the beginning of the
/// last fall of the drives to levels under which no closed state is stable and the open state is stable. If the switch starts
/// closed, the first such fall is the command. Levels after the simulated time, up to the end of the waveforms, count as well.
/// A fall is a time span in which the voltages of the electrodes that cause the opening approach 0 V without interruption; a
/// downward jump always begins a new fall. None if the hold levels keep the switch closed or collapse it, or if the drives
/// never kept it closed.
[[nodiscard]] std::optional<OpenCommand> open_command(const Switch& model, const std::vector<Signal>& signals, StartState start);

/// Finds the command to open that these drive signals give; its time is simulate.open_at if the scene has this key. The command
/// may come after the simulated time.
[[nodiscard]] std::optional<OpenCommand> open_command(const PreparedScene& prepared, const std::vector<Signal>& signals);

/// Returns the drive signals unchanged until their command to open, and constant at their levels just before the command from
/// then on. Returns all signals unchanged if there is no command, and if the scene starts closed.
[[nodiscard]] std::vector<Signal> until_command(const PreparedScene& prepared, std::vector<Signal> signals);

/// Returns the scene without its opening: the simulated time ends at the command to open at the latest, and the drives stay at
/// their levels just before the command. Returns the scene unchanged if there is no command, and if the scene starts closed.
[[nodiscard]] PreparedScene closing_of(const PreparedScene& prepared);

/// Returns the deflection of the connection in the state q [m]: the contact gap less the separation of the contact that decides
/// the connection. This is the contact farthest from its contact plane if the connection needs all contacts, else the nearest.
[[nodiscard]] double connection_deflection(const Switch& model, const Eigen::VectorXd& q);

/// Returns the options of metrics() for a run that opens on command under these drive signals. The options contain the time of
/// the command, and the deflection of the connection at rest in the open switch.
[[nodiscard]] MetricsOptions with_opening(MetricsOptions options, const Switch& model, const std::vector<Signal>& signals,
                                          const std::optional<OpenCommand>& command);

}  // namespace softland
