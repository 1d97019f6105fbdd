// Figures of merit as a function of numbers of a scene: evaluates many rows at once, in SIMD lanes and on all cores, with a
// scene that is prepared once. For optimizers, samplers and surrogate models outside of softland.
//
// A column of the input is a number of the scene, and a row is a set of values for all columns.
// - A column that varies the device, or an error of a drive, has a name as in [spread]: "gap.contact",
// "electrode.main.span[2]", "driver.main.gain". A row describes the device that [spread] would give with these values. The
// figures are bit for bit those of `robustness`.
// - A column that varies a waveform is one of its parameters: "waveform.main.level", "waveform.main.times[1]" [V], [s],
// [rad/s], [rad]. Voltages are those of the nominal scene, or scale with the pull-in voltages of each row (VoltsOf).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/progress.h"
#include "config/scene.h"
#include "objectives/figures.h"
#include "studies/devices/ensemble.h"

namespace softland {

/// Selects the device whose pull-in voltages are the units Vsp and Vdp.
enum class VoltsOf {
  nominal,  ///< the nominal device: every row has the same voltages
  each      ///< the device of the row: any key of the scene may vary; every row is prepared anew, which takes several closings
};

struct EvaluatorOptions {
  VoltsOf volts = VoltsOf::nominal;
  double tolerance = EnsembleRun{}.tolerance;  ///< relative tolerance of the integrator
};

/// The status of a row of the input after its evaluation.
struct RowEnd {
  /// "done" or another status of the row's closing, or "infeasible" if the device or the waveform is impossible.
  std::string status;
  std::string reason = {};  ///< reason why the row lacks figures
};

class Evaluator {
 public:
  /// Throws InvalidInput for a scene that cannot be run, for a key that cannot vary or occurs twice, and for a figure that
  /// closings in SIMD lanes do not compute: see measured().
  Evaluator(const SceneFile& file, std::vector<std::string> keys, std::vector<Figure> figures,
            const EvaluatorOptions& options = {}, const Progress& progress = {});
  Evaluator(const Evaluator&) = delete;
  Evaluator& operator=(const Evaluator&) = delete;

  /// True if closings in SIMD lanes compute this figure.
  [[nodiscard]] static bool measured(const Figure& figure);

  [[nodiscard]] const std::vector<std::string>& keys() const { return keys_; }
  [[nodiscard]] const std::vector<std::string>& units() const { return units_; }  ///< SI units of the input columns
  /// Values of the scene itself at the keys of the columns [SI unit].
  [[nodiscard]] const std::vector<double>& nominal() const { return values_; }
  [[nodiscard]] const std::vector<Figure>& figures() const { return figures_; }
  [[nodiscard]] const PreparedScene& scene() const { return *nominal_; }

  /// Evaluates rows. `rows` contains the rows one after another, with a number for each key [SI unit]. `figures` receives the
  /// figures of each row in the same order, NaN if missing, and `ends` one entry per row. The results depend neither on `jobs`,
  /// the number of threads, nor on the other rows. Throws InvalidInput if the sizes do not match, and Interrupted if `progress`
  /// asks to stop. May be called by several threads at once.
  void evaluate(std::span<const double> rows, std::span<double> figures, std::span<RowEnd> ends, int jobs,
                const Progress& progress = {}) const;

  /// Returns the derivatives of the figures by the keys at a row, figures x keys [unit of the figure over that of the key]. The
  /// derivatives are exact (studies/devices/derivatives.h). With VoltsOf::each, either all voltages or no voltages must be
  /// written as multiples of Vdp of one electrode. Throws InvalidInput with the reason if a derivative is missing.
  [[nodiscard]] Eigen::MatrixXd jacobian(std::span<const double> row, const Progress& progress = {}) const;

 private:
  /// A parameter of a waveform that a column of the input sets.
  struct WaveformKey {
    std::size_t column, drive;
    std::string parameter;
    std::size_t element = 0;  ///< element of the parameter's list, counted from 1; 0 for a parameter that is not a list
    double factor = 1;        ///< factor from the unit of the column to the unit of the parameter
  };
  struct Row;
  struct Place;

  void read_waveform_key(std::size_t column);
  void vary_device(const SceneFile& file, const Progress& progress);
  [[nodiscard]] std::vector<Row> built(std::span<const double> rows, std::size_t first, std::size_t count) const;
  void build_device(Row& row, std::span<const double> values, DeviceBuilder& builder) const;
  void build_anew(Row& row, std::span<const double> values) const;
  [[nodiscard]] std::vector<Waveform> waveforms_of(std::span<const double> values) const;
  [[nodiscard]] std::string violation_of(const std::vector<Waveform>& own) const;
  [[nodiscard]] SceneFile scene_of(std::span<const double> values) const;
  [[nodiscard]] Place place_of(std::span<const double> row, const Progress& progress) const;
  [[nodiscard]] std::vector<WaveformKey> keys_of_row(const PreparedScene& in_volts, std::span<const double> row) const;
  void derive_by_waveforms(const Place& place, std::span<const double> row, Eigen::MatrixXd& all, const Progress& progress) const;
  [[nodiscard]] std::unique_ptr<DeviceBuilder> take_builder() const;

  std::vector<std::string> keys_, units_;
  std::vector<double> values_;
  std::vector<Figure> figures_;
  EvaluatorOptions options_;
  std::vector<WaveformKey> of_waveforms_;
  /// Indices of the columns that vary the device, in the order of the varied quantities of [spread].
  std::vector<std::size_t> of_device_;
  std::unique_ptr<PreparedScene> nominal_;  ///< prepared scene, whose [spread] has the input columns that vary the device
  std::unique_ptr<Ensemble> ensemble_;      ///< devices that the rows describe; none if no column varies the device
  std::unique_ptr<DeviceDrives> drives_;
  std::vector<Waveform> waveforms_;  ///< waveforms of the scene, in the order of the drives
  std::vector<Signal> signals_;      ///< applied voltages of the scene's waveforms
  std::optional<ClosedEquilibrium> closed_;
  mutable std::mutex builders_lock_;
  /// Device builders that no thread uses at present, for later rows.
  mutable std::vector<std::unique_ptr<DeviceBuilder>> builders_;
};

}  // namespace softland
