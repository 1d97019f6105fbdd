// Sensitivities of the figures of the nominal device to the varied quantities, to first order: exact derivatives of its
// closing.
//
//   df/dx_i of every figure f by every varied quantity x_i
//   sigma_f^2 = sum over i, j of df/dx_i sigma_i rho_ij sigma_j df/dx_j
//
// x_i is as in SpreadVariable: a factor, or the value of a key [SI unit]; sigma_i its standard deviation; rho_ij the
// correlation of the normal numbers beneath. The derivatives go through make and break, impacts and dents
// (model/linearized_closing.h), with all parts of a device (model/switch_slopes.h). Volts are those of the nominal device or,
// with a per-device calibration, follow each device's own units without error; errors of sources count too. Source of the
// second formula: propagation of uncertainty, JCGM 100:2008, eq. 13.
//
// Derivatives hold as long as no touch comes or goes: an added rebound is not a small change. If a touch nearly comes or goes
// (grazing), they hold for much smaller changes than those of a spread. After many rebounds they become too large to use, and
// too large for an integrator to resolve. A figure whose derivatives change by a twentieth with the tolerance has none.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/watch.h"
#include "studies/devices/ensemble.h"
#include "waveforms/signal_slopes.h"

namespace softland {

struct FigureDerivatives {
  std::string_view key;               ///< key of device_figures
  double value = Metrics::unset;      ///< value of the nominal device
  std::vector<double> by_variable;    ///< [unit of the figure over that of the variable]; NaN: no derivative
  double deviation = Metrics::unset;  ///< sigma_f, over the variables with derivatives
  double error = Metrics::unset;      ///< relative error of the derivatives: difference to a looser run, over the largest
  std::string why_none = {};          ///< empty if derivatives exist

  [[nodiscard]] bool is_known() const { return !by_variable.empty(); }
};

struct Derivatives {
  struct Variable {
    std::string name;           ///< name in the spread
    double nominal = 0;         ///< nominal value; 1 for a factor
    double deviation = 0;       ///< sigma_i
    std::string why_none = {};  ///< empty if figures have derivatives by it
  };
  std::vector<Variable> variables;         ///< variables in the order of the spread
  std::vector<FigureDerivatives> figures;  ///< figures of device_figures with slopes
  double grazing = 1;                      ///< CostSlopes::grazing
  std::string why_none = {};               ///< empty if derivatives exist

  [[nodiscard]] bool grazes() const;
};

struct DerivativeOptions {
  double tolerance = 0;  ///< tolerance of the integrator; 0: the scene's, or 1e-8 if that is looser
  int refinement = 4;    ///< parts of a step: see LinearizedClosing
};

/// Returns derivatives under these waveforms, in the known units of each device, without errors of these. None for a
/// compressible film, for devices that are sorted into classes, if the nominal device does not close, and after a stop.
[[nodiscard]] Derivatives derivatives(const PreparedScene& scene, const EnsembleDrive& drive,
                                      const DerivativeOptions& options = {}, const Watch& watch = {});

/// A number that determines waveforms.
struct WaveformParameter {
  std::string name;
  double value = 0;
  double size = 0;  ///< size of a large change, above 0
};
/// Returns derivatives by such numbers, for the nominal device under the signals that they determine. Each is a variable whose
/// deviation is a hundredth of its size. A number has none if the signals have other pieces on either side of it.
[[nodiscard]] Derivatives derivatives_by_waveforms(const PreparedScene& scene, const std::vector<WaveformParameter>& parameters,
                                                   const SignalSlopes::SignalsOf& signals, const DerivativeOptions& options = {},
                                                   const Watch& watch = {});

}  // namespace softland
