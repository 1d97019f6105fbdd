// How the figures of the nominal device change with what varies, to first order: exact derivatives of its closing.
//
//   df/dx_i of every figure f by every varying quantity x_i     sigma_f^2 = sum over i, j of df/dx_i sigma_i rho_ij sigma_j
//   df/dx_j
//
// x_i as in SpreadVariable: a factor, or the value of a key [SI unit]; sigma_i its standard deviation; rho_ij the correlation of
// the normal numbers beneath. The derivatives go through make and break, impacts and dents (model/linearized_closing.h), with all
// that a device is made of (model/switch_slopes.h). Volts are those of the nominal device or, where devices are calibrated,
// follow each device's own units without error; errors of sources count too. Source of the second formula: propagation of
// uncertainty, JCGM 100:2008, eq. 13.
//
// They hold as long as no touch comes or goes: a rebound that is added is no small change. Where a touch nearly comes or goes
// (grazing) they hold for much smaller changes than those of a spread. After many rebounds they grow beyond all use, and beyond
// what an integrator can tell: a figure whose derivatives change by a twentieth with the tolerance has none.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/watch.h"
#include "studies/devices/ensemble.h"
#include "waveforms/signal_slopes.h"

namespace softland {

struct FigureDerivatives {
  std::string_view key;               ///< of device_figures
  double value = Metrics::unset;      ///< of the nominal device
  std::vector<double> by_variable;    ///< [unit of the figure over that of the variable]; NaN where there is none
  double deviation = Metrics::unset;  ///< sigma_f, of the variables that have derivatives
  double error = Metrics::unset;      ///< of the derivatives, over the largest: difference to a looser run
  std::string why_none = {};          ///< empty where there are derivatives

  [[nodiscard]] bool is_known() const { return !by_variable.empty(); }
};

struct Derivatives {
  struct Variable {
    std::string name;           ///< of the spread
    double nominal = 0;         ///< 1 of a factor
    double deviation = 0;       ///< sigma_i
    std::string why_none = {};  ///< empty where figures have derivatives by it
  };
  std::vector<Variable> variables;         ///< as in the spread
  std::vector<FigureDerivatives> figures;  ///< those of device_figures that have slopes
  double grazing = 1;                      ///< CostSlopes::grazing
  std::string why_none = {};               ///< empty where there are derivatives

  [[nodiscard]] bool grazes() const;
};

struct DerivativeOptions {
  double tolerance = 0;  ///< of the integrator; 0: the scene's, or 1e-8 if that is looser
  int refinement = 4;    ///< parts of a step: see LinearizedClosing
};

/// Under these waveforms, in the units that are known of each device where these do not err. There are none for a compressible
/// film, where devices are sorted into classes, where the nominal device does not close, and when asked to stop.
[[nodiscard]] Derivatives derivatives(const PreparedScene& scene, const EnsembleDrive& drive,
                                      const DerivativeOptions& options = {}, const Watch& watch = {});

/// A number that waveforms are made from.
struct WaveformParameter {
  std::string name;
  double value = 0;
  double size = 0;  ///< of what counts as a large change of it, above 0
};
/// The same by such numbers, of the nominal device under the signals that are made of them: a variable each, whose deviation is a
/// hundredth of its size. Those on either side of which the signals have other pieces have none.
[[nodiscard]] Derivatives derivatives_by_waveforms(const PreparedScene& scene, const std::vector<WaveformParameter>& parameters,
                                                   const SignalSlopes::SignalsOf& signals, const DerivativeOptions& options = {},
                                                   const Watch& watch = {});

}  // namespace softland
