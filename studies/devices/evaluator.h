// Figures of merit as a function of numbers of a scene: many rows at once, in lanes and on all cores, with a scene that is
// prepared once. It serves optimizers, samplers and surrogates from outside.
//
// A column is a number of the scene. A column of the device, or of an error of a drive, has a name of [spread]: "gap.contact",
// "electrode.main.span[2]", "driver.main.gain". A row is then the device that a spread would have with these values, and its
// figures have the bits that `robustness` gives such a device. A column of a waveform is a parameter: "waveform.main.level",
// "waveform.main.times[1]" [V], [s], [rad/s], [rad]. Volts are those of the nominal scene, or follow the pull-in voltages of
// each row (VoltsOf).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/watch.h"
#include "config/scene.h"
#include "objectives/figures.h"
#include "studies/devices/ensemble.h"

namespace softland {

/// The device whose pull-in voltages Vsp and Vdp stand for.
enum class VoltsOf {
  nominal,  ///< the scene's: every row gets the same volts
  each      ///< the row's: any key of the scene may vary, and every row is prepared anew, which takes several closings
};

struct EvaluatorOptions {
  VoltsOf volts = VoltsOf::nominal;
  double tolerance = EnsembleRun{}.tolerance;  ///< tolerance of the integrator
};

/// The status of a row.
struct RowEnd {
  std::string status;       ///< "done", as in results, or "infeasible": the device, or the waveform, is impossible
  std::string reason = {};  ///< reason for missing figures
};

class Evaluator {
 public:
  /// Throws InvalidInput for a scene that cannot be run, for a key that cannot vary or occurs twice, and for a figure that is
  /// not measured on devices: see measured().
  Evaluator(const SceneFile& file, std::vector<std::string> keys, std::vector<Figure> figures,
            const EvaluatorOptions& options = {}, const Watch& watch = {});
  Evaluator(const Evaluator&) = delete;
  Evaluator& operator=(const Evaluator&) = delete;

  /// True if closings in lanes give this figure.
  [[nodiscard]] static bool measured(const Figure& figure);

  [[nodiscard]] const std::vector<std::string>& keys() const { return keys_; }
  [[nodiscard]] const std::vector<std::string>& units() const { return units_; }  ///< SI units of the columns
  [[nodiscard]] const std::vector<double>& nominal() const { return values_; }    ///< values of the scene itself [SI unit]
  [[nodiscard]] const std::vector<Figure>& figures() const { return figures_; }
  [[nodiscard]] const PreparedScene& scene() const { return *nominal_; }

  /// Evaluates rows. `rows` holds them one after another, a number for each key [SI unit]; `figures` likewise, NaN for a
  /// missing one; `ends` has one entry per row. The results do not depend on `jobs`, nor on the other rows. Throws InvalidInput
  /// if the sizes do not fit, Interrupted if `watch` asks to stop. May be called by several threads at once.
  void evaluate(std::span<const double> rows, std::span<double> figures, std::span<RowEnd> ends, int jobs,
                const Watch& watch = {}) const;

  /// The derivatives of the figures by the keys at a row, figures x keys [unit of the figure over that of the key]: exact ones
  /// of the closing (studies/devices/derivatives.h). Volts that follow each row have them if all are written in Vdp of one
  /// electrode, or none. Throws InvalidInput with the reason if a figure has none there.
  [[nodiscard]] Eigen::MatrixXd jacobian(std::span<const double> row, const Watch& watch = {}) const;

 private:
  /// A parameter of a waveform that a column sets.
  struct WaveformKey {
    std::size_t column, drive;
    std::string parameter;
    std::size_t element = 0;  ///< element of a list, counted from 1; 0: not a list
    double factor = 1;        ///< factor of the parameter for one unit of the column
  };
  struct Row;
  struct Place;

  void read_waveform_key(std::size_t column);
  void vary_device(const SceneFile& file, const Watch& watch);
  [[nodiscard]] std::vector<Row> built(std::span<const double> rows, std::size_t first, std::size_t count) const;
  void build_device(Row& row, std::span<const double> values, DeviceBuilder& builder) const;
  void build_anew(Row& row, std::span<const double> values) const;
  [[nodiscard]] std::vector<Waveform> waveforms_of(std::span<const double> values) const;
  [[nodiscard]] std::string violation_of(const std::vector<Waveform>& own) const;
  [[nodiscard]] SceneFile scene_of(std::span<const double> values) const;
  [[nodiscard]] Place place_of(std::span<const double> row, const Watch& watch) const;
  [[nodiscard]] std::vector<WaveformKey> keys_of_row(const PreparedScene& in_volts, std::span<const double> row) const;
  void derive_by_waveforms(const Place& place, std::span<const double> row, Eigen::MatrixXd& all, const Watch& watch) const;
  [[nodiscard]] std::unique_ptr<DeviceBuilder> take_builder() const;

  std::vector<std::string> keys_, units_;
  std::vector<double> values_;
  std::vector<Figure> figures_;
  EvaluatorOptions options_;
  std::vector<WaveformKey> of_waveforms_;
  std::vector<std::size_t> of_device_;      ///< columns of the device, in the order of the spread's variables
  std::unique_ptr<PreparedScene> nominal_;  ///< its spread is that of the columns
  std::unique_ptr<Ensemble> ensemble_;      ///< none if no column is of the device
  std::unique_ptr<DeviceDrives> drives_;
  std::vector<Waveform> waveforms_;  ///< waveforms of the scene, in the order of the drives
  std::vector<Signal> signals_;      ///< their signals
  std::optional<ClosedEquilibrium> closed_;
  mutable std::mutex builders_lock_;
  mutable std::vector<std::unique_ptr<DeviceBuilder>> builders_;  ///< idle builders: a row does not wait for a new one
};

}  // namespace softland
