// Sensitivities of the figures of the nominal device to the varied quantities, to first order, by exact derivatives of its
// closing.
//
//   df/dx_i of every figure f by every varied quantity x_i
//   sigma_f^2 = sum over i, j of df/dx_i sigma_i rho_ij sigma_j df/dx_j
//
// x_i is a factor or the value of a key [SI unit], as in SpreadVariable; sigma_i is its standard deviation; rho_ij is the
// correlation of the normal numbers from which the x_i are made. Source of the second formula: propagation of uncertainty, JCGM
// 100:2008, eq. 13.
//
// The derivatives contain make and break of contact, impacts and dents (model/linearized_closing.h), and all parts of a device
// (model/switch_slopes.h). The voltages are those of the nominal device. With a per-device calibration they are scaled by each
// device's measured factors, which count as exact. Errors of sources are included.
//
// Derivatives are valid as long as no touch is added or removed: a further rebound is not a small change. If a touch is nearly
// added or removed (grazing), derivatives are valid only for much smaller changes than those of a [spread]. After many rebounds
// derivatives become too large to use, and too large for an integrator to resolve. A figure whose derivatives change by more
// than a twentieth with the tolerance gets none.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/progress.h"
#include "studies/devices/ensemble.h"
#include "waveforms/signal_slopes.h"

namespace softland {

struct FigureDerivatives {
  std::string_view key;           ///< key of the figure, one of device_figures
  double value = Metrics::unset;  ///< value of the figure for the nominal device
  /// Derivative of the figure by each varied quantity [unit of figure over unit of quantity]; NaN if it does not exist.
  std::vector<double> by_variable;
  /// Sigma_f, standard deviation of the figure, from the varied quantities with derivatives.
  double deviation = Metrics::unset;
  /// Largest change of the figure's derivatives with a looser integrator tolerance, divided by the largest derivative.
  double error = Metrics::unset;
  std::string why_none = {};  ///< reason why the figure has no derivatives; empty if they exist

  [[nodiscard]] bool is_known() const { return !by_variable.empty(); }
};

struct Derivatives {
  struct Variable {
    std::string name;           ///< name of the varied quantity in [spread]
    double nominal = 0;         ///< value of the quantity for the nominal device; 1 for a factor
    double deviation = 0;       ///< sigma_i, standard deviation of the quantity over the devices
    std::string why_none = {};  ///< reason for missing derivatives by this quantity; empty if they exist
  };
  std::vector<Variable> variables;         ///< varied quantities in the order of [spread]
  std::vector<FigureDerivatives> figures;  ///< figures among device_figures that have derivatives
  /// Smallest speed at which the contact point crosses the contact plane in the nominal closing, as a share of that at first
  /// contact. Near 0 a small change of the device adds or removes a touch.
  double grazing = 1;
  std::string why_none = {};  ///< reason why no figure has derivatives; empty if some exist

  [[nodiscard]] bool grazes() const;
};

struct DerivativeOptions {
  double tolerance = 0;  ///< relative tolerance of the integrator; 0: the scene's tolerance, but at most 1e-8
  int refinement = 4;    ///< number of parts into which an integrator step is divided (LinearizedClosing)
};

/// Returns derivatives of the figures under the waveforms of `drive`. The scale factors that a calibration measures on each
/// device count as exact. There are no derivatives for a compressible film, for devices that are sorted into classes, if the
/// nominal device does not close, and after an interruption.
[[nodiscard]] Derivatives derivatives(const PreparedScene& scene, const EnsembleDrive& drive,
                                      const DerivativeOptions& options = {}, const Progress& progress = {});

/// A parameter of the drive waveforms by which derivatives of figures are taken.
struct WaveformParameter {
  std::string name;
  double value = 0;
  double size = 0;  ///< scale of the waveform parameter, for example the width of its range; must be above 0
};
/// Returns derivatives of the figures by these waveform parameters, for the nominal device under the drive signals that the
/// parameters determine. Each parameter is a variable whose standard deviation is a hundredth of its `size`. A parameter has no
/// derivatives if the signals consist of other pieces at slightly smaller and larger values of the parameter.
[[nodiscard]] Derivatives derivatives_by_waveforms(const PreparedScene& scene, const std::vector<WaveformParameter>& parameters,
                                                   const SignalSlopes::SignalsOf& signals, const DerivativeOptions& options = {},
                                                   const Progress& progress = {});

}  // namespace softland
