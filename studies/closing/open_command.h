// The command to open: the instant from which the drives of a run leave a closed switch no state to stay in.
#pragma once

#include <optional>
#include <vector>

#include "model/closing.h"
#include "studies/closing/prepared.h"
#include "waveforms/signal.h"

namespace softland {

struct OpenCommand {
  double time = 0;           ///< [s]
  std::vector<Signal> held;  ///< the drives until then, and from then on what they stood at
};

/// The command of these drives, one per drive of the switch, to the end of their waveforms: where their last fall begins into
/// levels under which no closed state is stable and the open one is. A switch that starts closed has it in the first such fall. A
/// fall lasts as long as the voltages of the electrodes that make it only go towards 0 V; that of a jump begins there. None where
/// the hold levels keep the switch closed, or pull it through, and where the drives never would have held it.
[[nodiscard]] std::optional<OpenCommand> open_command(const Switch& model, const std::vector<Signal>& signals, StartState start);

/// The command of these drives of a scene: that of simulate.open_at where the scene has it. It may come after the window.
[[nodiscard]] std::optional<OpenCommand> open_command(const PreparedScene& prepared, const std::vector<Signal>& signals);

/// These drives until they command the switch to open, and from then on at what they stood at; as they are where they do not.
[[nodiscard]] std::vector<Signal> until_command(const PreparedScene& prepared, std::vector<Signal> signals);

/// The scene until its drives command it to open: its window ends there at the latest, and its drives stay at what they are just
/// before. The
/// scene itself where they do not, and where it starts closed.
[[nodiscard]] PreparedScene closing_of(const PreparedScene& prepared);

/// The place of the connection in a state of the beam, as observers of a closing are told of it (model/closing/connection.h) [m].
[[nodiscard]] double connection_deflection(const Switch& model, const Eigen::VectorXd& q);

/// The same options for a run that opens on command, whose drives are these: with the place at which the connection comes to
/// rest.
[[nodiscard]] MetricsOptions with_opening(MetricsOptions options, const Switch& model, const std::vector<Signal>& signals,
                                          const std::optional<OpenCommand>& command);

}  // namespace softland
