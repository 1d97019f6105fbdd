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
// (model/switch_slopes.h). The voltages are those of the nominal device or, with a per-device calibration, scale with each
// device's own units, which are taken as exact. Errors of sources are included.
//
// Derivatives are valid as long as no touch is added or removed: a further rebound is not a small change. If a touch is nearly
// added or removed (grazing), they are valid for much smaller changes than those of a spread. After many rebounds they become
// too large to use, and too large for an integrator to resolve. A figure whose derivatives change by more than a twentieth with
// the tolerance gets none.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/progress.h"
#include "studies/devices/ensemble.h"
#include "waveforms/signal_slopes.h"

namespace softland {

struct FigureDerivatives {
  std::string_view key;           ///< key of device_figures
  double value = Metrics::unset;  ///< value of the nominal device
  std::vector<double>
      by_variable;  ///< derivative by each variable [unit of the figure over that of the variable]; NaN if it does not exist
  double deviation = Metrics::unset;  ///< sigma_f, from the variables with derivatives
  double error = Metrics::unset;  ///< largest difference of the derivatives to those of a looser run, over the largest derivative
  std::string why_none = {};      ///< reason for missing derivatives; empty if they exist

  [[nodiscard]] bool is_known() const { return !by_variable.empty(); }
};

struct Derivatives {
  struct Variable {
    std::string name;           ///< name in the spread
    double nominal = 0;         ///< nominal value; 1 for a factor
    double deviation = 0;       ///< sigma_i
    std::string why_none = {};  ///< reason for missing derivatives by this variable; empty if they exist
  };
  std::vector<Variable> variables;         ///< variables in the order of the spread
  std::vector<FigureDerivatives> figures;  ///< the device_figures that have slopes
  double grazing = 1;                      ///< CostSlopes::grazing of the nominal closing
  std::string why_none = {};               ///< reason for missing derivatives; empty if they exist

  [[nodiscard]] bool grazes() const;
};

struct DerivativeOptions {
  double tolerance = 0;  ///< tolerance of the integrator; 0 for the scene's, or 1e-8 if that is looser
  int refinement = 4;    ///< parts of an integrator step (LinearizedClosing)
};

/// Returns derivatives under these waveforms, in the known units of each device, which are taken as exact. None for a
/// compressible film, for devices that are sorted into classes, if the nominal device does not close, and after a stop.
[[nodiscard]] Derivatives derivatives(const PreparedScene& scene, const EnsembleDrive& drive,
                                      const DerivativeOptions& options = {}, const Progress& progress = {});

/// A number on which waveforms depend.
struct WaveformParameter {
  std::string name;
  double value = 0;
  double size = 0;  ///< size of a large change of the number, above 0
};
/// Returns derivatives by these numbers, for the nominal device under the signals that they determine. Each number is a
/// variable whose deviation is a hundredth of its size. A number has no derivatives if the signals have other pieces at
/// slightly smaller and larger values.
[[nodiscard]] Derivatives derivatives_by_waveforms(const PreparedScene& scene, const std::vector<WaveformParameter>& parameters,
                                                   const SignalSlopes::SignalsOf& signals, const DerivativeOptions& options = {},
                                                   const Progress& progress = {});

}  // namespace softland
