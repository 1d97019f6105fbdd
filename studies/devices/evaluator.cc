#include "studies/devices/evaluator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <set>
#include <utility>
#include <variant>

#include "base/executor.h"
#include "base/require.h"
#include "config/schema.h"
#include "config/units.h"
#include "model/constants.h"
#include "studies/closing/auto_settings.h"
#include "studies/devices/derivatives.h"
#include "studies/devices/evaluator_keys.h"
#include "studies/devices/row_status.h"
#include "waveforms/limits.h"

namespace softland {
namespace {

// Number of rows of one task: enough to fill the SIMD lanes, few enough to notice an interruption soon.
constexpr std::size_t rows_of_task = 64;

}  // namespace

struct Evaluator::Row {
  SampledDevice own;                      // device that the row of the input describes, unless it is the nominal device
  const SampledDevice* device = nullptr;  // device to close for the row: `own` or the nominal device
  std::vector<Signal> signals;            // drive signals of the row, if they differ from those of the scene
  std::string refusal = {};
  double duration = 0;
  bool has_signals = false;
};

bool Evaluator::measured(const Figure& figure) {
  const auto is = [&](Figure::Member member) { return figure.member == member; };
  return figure.of_devices || is(&Metrics::bounce_time) || is(&Metrics::first_rebound_time) || is(&Metrics::drive_energy) ||
         is(&Metrics::settled);
}

Evaluator::Evaluator(const SceneFile& file, std::vector<std::string> keys, std::vector<Figure> figures,
                     const EvaluatorOptions& options, const Progress& progress)
    : keys_(std::move(keys)), figures_(std::move(figures)), options_(options) {
  require_open_start(read_scene(file), "evaluator closes the switch");
  require(!keys_.empty(), "evaluator: needs at least one key");
  require(!figures_.empty(), "evaluator: needs at least one figure");
  require(options.tolerance > 0 && options.tolerance <= 0.1, "evaluator: the tolerance must be above 0 and at most 0.1");
  for (const Figure& figure : figures_)
    require(measured(figure),
            [&] { return fmt::format("evaluator: {} is not available in lanes; simulate() gives it", figure.quantity()); });
  for (std::size_t i = 0; i < keys_.size(); ++i)
    require(std::find(keys_.begin(), keys_.begin() + static_cast<std::ptrdiff_t>(i), keys_[i]) ==
                keys_.begin() + static_cast<std::ptrdiff_t>(i),
            [&] { return fmt::format("evaluator: the key '{}' occurs twice", keys_[i]); });
  units_.resize(keys_.size());
  values_.assign(keys_.size(), Metrics::unset);
  vary_device(file, progress);
  waveforms_ = nominal_->waveforms();
  if (options_.volts == VoltsOf::nominal) {
    for (std::size_t i = 0; i < keys_.size(); ++i) {
      if (waveform_key(key_and_element(keys_[i]).first)) read_waveform_key(i);
    }
  }
  signals_ = nominal_->applied(waveforms_);
  closed_ = closed_equilibrium(nominal_->model, hold_levels(signals_));
  drives_ = std::make_unique<DeviceDrives>(*nominal_);
}

// Finds the columns of the input that vary the device, and prepares the scene with these columns in [spread].
void Evaluator::vary_device(const SceneFile& file, const Progress& progress) {
  if (options_.volts == VoltsOf::each) {
    SceneFile scene = file;
    scene.erase("spread");
    scene.erase("calibration");
    nominal_ = std::make_unique<PreparedScene>(prepare_and_choose(scene, false, progress));
    for (std::size_t i = 0; i < keys_.size(); ++i) {
      const auto [path, element] = key_and_element(keys_[i]);
      require(!path.starts_with("metrics."),
              [&] { return fmt::format("evaluator: {} cannot vary: it applies to all rows", keys_[i]); });
      const std::optional<Quantity> given = written_quantity(scene, path, element);
      require(given.has_value(), [&] {
        return fmt::format("{}: {} must be a number in the scene to vary: write it there first", scene.name(), keys_[i]);
      });
      values_[i] = given->value;
      units_[i] = unit_symbol(given->dimension);
    }
    return;
  }
  std::vector<std::string> of_device;
  for (const std::string& key : keys_) {
    if (!waveform_key(key_and_element(key).first)) of_device.push_back(key);
  }
  nominal_ = std::make_unique<PreparedScene>(prepare_and_choose(scene_that_varies(file, of_device), false, progress));
  if (of_device.empty()) return;
  for (const SpreadVariable& variable : nominal_->scene.spread.variables) {
    const auto column = static_cast<std::size_t>(std::find(keys_.begin(), keys_.end(), variable.name) - keys_.begin());
    of_device_.push_back(column);
    units_[column] = variable.keys.front().unit;
    values_[column] = variable.keys.front().nominal;
  }
  ensemble_ = std::make_unique<Ensemble>(*nominal_, 1);
}

void Evaluator::read_waveform_key(std::size_t column) {
  const auto [path, element] = key_and_element(keys_[column]);
  const auto [drive, name] = *waveform_key(path);
  const std::vector<std::string> drives = nominal_->drive_names();
  const auto found = std::find(drives.begin(), drives.end(), drive);
  require(found != drives.end(), [&] {
    return fmt::format("{}: '{}' is not a key of this scene: no drive '{}'{}", nominal_->scene.file.name(), keys_[column], drive,
                       internal::hint(drive, {drives.begin(), drives.end()}));
  });
  WaveformKey key{.column = column,
                  .drive = static_cast<std::size_t>(found - drives.begin()),
                  .parameter = name == "frequency" ? "angular_frequency" : name,
                  .element = element,
                  .factor = name == "frequency" ? 2 * pi : 1};
  std::vector<std::string_view> names;
  ParameterKind kind{};
  const double* const number = waveform_parameter(waveforms_[key.drive], key.parameter, element, names, kind);
  require(number != nullptr, [&] {
    return fmt::format("{}: '{}' is not a number of the waveform there, which is a {}{}", nominal_->scene.file.name(),
                       keys_[column], family(waveforms_[key.drive]), internal::hint(name, names));
  });
  units_[column] = name == "frequency" ? "Hz" : unit_of_parameter(kind, drive);
  values_[column] = *number / key.factor;
  of_waveforms_.push_back(std::move(key));
}

std::vector<Waveform> Evaluator::waveforms_of(std::span<const double> values) const {
  std::vector<Waveform> all = waveforms_;
  for (const WaveformKey& key : of_waveforms_) {
    std::vector<std::string_view> names;
    ParameterKind kind{};
    *waveform_parameter(all[key.drive], key.parameter, key.element, names, kind) = key.factor * values[key.column];
  }
  return all;
}

// Returns the reason why a voltage source cannot apply the waveforms of a row; empty if it can.
std::string Evaluator::violation_of(const std::vector<Waveform>& own) const {
  for (const WaveformKey& key : of_waveforms_) {
    const std::optional<DriverLimits>& limits = nominal_->drives[key.drive].limits;
    if (!limits) continue;
    const std::string why = violation(nominal_->commanded(key.drive, own[key.drive]), *limits);
    if (!why.empty()) return why;
  }
  return {};
}

SceneFile Evaluator::scene_of(std::span<const double> values) const {
  SceneFile file = nominal_->scene.file;
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    const auto [path, element] = key_and_element(keys_[i]);
    const std::optional<Quantity> given = written_quantity(file, path, element);
    file.assign(path, Quantity{.value = values[i], .dimension = given->dimension}, element);
  }
  return file;
}

void Evaluator::build_anew(Row& row, std::span<const double> values) const {
  PreparedScene prepared = prepare_and_choose(scene_of(values));
  row.signals = prepared.signals();
  row.has_signals = true;
  row.duration = prepared.duration;
  row.own.model.emplace(std::move(prepared.model));
  row.device = &row.own;
}

void Evaluator::build_device(Row& row, std::span<const double> values, DeviceBuilder& builder) const {
  row.duration = nominal_->duration;
  std::vector<double> varied(of_device_.size());
  for (std::size_t i = 0; i < varied.size(); ++i) {
    const SpreadVariable& variable = nominal_->scene.spread.variables[i];
    varied[i] = values[of_device_[i]] / (variable.is_factor ? variable.keys.front().nominal : 1);
  }
  row.own = builder.device(std::move(varied));
  row.device = &row.own;
  row.refusal = row.own.refusal;
}

std::unique_ptr<DeviceBuilder> Evaluator::take_builder() const {
  const std::scoped_lock lock(builders_lock_);
  if (builders_.empty()) return std::make_unique<DeviceBuilder>(*ensemble_);
  std::unique_ptr<DeviceBuilder> one = std::move(builders_.back());
  builders_.pop_back();
  return one;
}

std::vector<Evaluator::Row> Evaluator::built(std::span<const double> rows, std::size_t first, std::size_t count) const {
  std::vector<Row> all(count);
  std::unique_ptr<DeviceBuilder> builder = ensemble_ ? take_builder() : nullptr;
  for (std::size_t i = 0; i < count; ++i) {
    Row& row = all[i];
    const std::span<const double> values = rows.subspan((first + i) * keys_.size(), keys_.size());
    if (!std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); })) {
      row.refusal = "a number of the row is not finite";
      continue;
    }
    try {
      if (options_.volts == VoltsOf::each) {
        build_anew(row, values);
        continue;
      }
      if (builder) {
        build_device(row, values, *builder);
      } else {
        row.duration = nominal_->duration;
        row.own.model.emplace(nominal_->model);
        row.device = &row.own;
      }
      if (!row.refusal.empty() || (of_waveforms_.empty() && !drives_->differ({}))) continue;
      const std::vector<Waveform> own = waveforms_of(values);
      row.refusal = violation_of(own);
      if (!row.refusal.empty()) continue;
      row.signals = drives_->signals(own, {}, row.own.values);
      row.has_signals = true;
    } catch (const InvalidInput& error) {
      row.refusal = error.what();
    }
  }
  if (builder) {
    const std::scoped_lock lock(builders_lock_);
    builders_.push_back(std::move(builder));
  }
  return all;
}

void Evaluator::evaluate(std::span<const double> rows, std::span<double> figures, std::span<RowEnd> ends, int jobs,
                         const Progress& progress) const {
  const std::size_t count = ends.size();
  require(rows.size() == count * keys_.size() && figures.size() == count * figures_.size(), [&] {
    return fmt::format("evaluator: `rows`, `figures` and `ends` must have as many rows, of {} numbers and {} figures",
                       keys_.size(), figures_.size());
  });
  const bool measures_energy = std::any_of(
      figures_.begin(), figures_.end(), [](const Figure& one) { return one.member == Figure::Member(&Metrics::drive_energy); });
  std::atomic<std::size_t> done = 0;
  std::mutex telling;
  const auto task = [&](std::size_t c) {
    const std::size_t first = c * rows_of_task, size = std::min(rows_of_task, count - first);
    const std::vector<Row> built_rows = built(rows, first, size);
    std::vector<DrivenDevice> driven;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < size; ++i) {
      const Row& row = built_rows[i];
      if (!row.refusal.empty()) {
        ends[first + i] = {.status = std::string(infeasible), .reason = row.refusal};
        std::fill_n(figures.begin() + static_cast<std::ptrdiff_t>((first + i) * figures_.size()), figures_.size(),
                    Metrics::unset);
        continue;
      }
      places.push_back(first + i);
      driven.push_back({.device = row.device, .signals = row.has_signals ? &row.signals : &signals_, .duration = row.duration});
    }
    const std::vector<DeviceOutcome> closed = close_driven(
        driven, nominal_->scene.metrics, {.duration = nominal_->duration, .tolerance = options_.tolerance, .stop = progress.stop},
        options_.volts == VoltsOf::nominal ? closed_ : std::nullopt, measures_energy, vectors_in_use());
    for (std::size_t n = 0; n < places.size(); ++n) {
      const DeviceOutcome& outcome = closed[n];
      ends[places[n]] = {.status = std::string(to_string(outcome.metrics.status)), .reason = outcome.failure};
      for (std::size_t f = 0; f < figures_.size(); ++f)
        figures[places[n] * figures_.size() + f] = figures_[f].value(outcome.metrics);
    }
    done += size;
    const std::scoped_lock lock(telling);
    progress.tell("rows", static_cast<double>(done) / static_cast<double>(count));
  };
  run_tasks((count + rows_of_task - 1) / rows_of_task, jobs, task, progress.stop);
  progress.throw_if_stopped();
}

namespace {

// The units in which the scene file gives the voltages of the electrodes' waveforms. Voltages in Vdp scale with the device.
struct WrittenVolts {
  bool in_volts = false, in_pull_in = false, in_other_units = false;
};
WrittenVolts written_volts(const SceneFile& file, const PreparedScene& there) {
  WrittenVolts found;
  for (const auto& [drive, waveform] : there.drives.waveforms()) {
    if (drive == dispersion_drive || drive == piezo_drive) continue;
    const auto look = [&, &drive = drive](std::string_view name, std::size_t element) {
      const std::optional<Quantity> given = written_quantity(file, fmt::format("waveform.{}.{}", drive, name), element);
      if (!given || given->value == 0) return;
      bool& of_unit = given->dimension == dimension::voltage           ? found.in_volts
                      : given->dimension == dimension::dynamic_pull_in ? found.in_pull_in
                                                                       : found.in_other_units;
      of_unit = true;
    };
    std::visit(
        [&]<class Family>(const Family& family) {
          for (const Parameter<Family>& one : FamilyOf<Family>::parameters) {
            if (one.kind != ParameterKind::level && one.kind != ParameterKind::swing) continue;
            if (std::get_if<double Family::*>(&one.member) != nullptr) {
              look(one.name, 0);
            } else {
              for (std::size_t k = 1; k <= (family.*std::get<std::vector<double> Family::*>(one.member)).size(); ++k)
                look(one.name, k);
            }
          }
        },
        waveform);
  }
  return found;
}

// Returns the derivatives of a figure by the varied quantities; throws InvalidInput if the figure has none.
const FigureDerivatives& derived(const Derivatives& found, const Figure& figure) {
  require(found.why_none.empty(), [&] { return "jacobian: no derivatives here: " + found.why_none; });
  const auto of = std::find_if(found.figures.begin(), found.figures.end(),
                               [&](const FigureDerivatives& one) { return one.key == figure.key; });
  require(of != found.figures.end(), [&] { return fmt::format("jacobian: {} has no derivative: it jumps", figure.quantity()); });
  require(of->is_known(),
          [&] { return fmt::format("jacobian: {} has no derivative here: {}", figure.quantity(), of->why_none); });
  return *of;
}

void require_derived(const Derivatives::Variable& variable) {
  require(variable.why_none.empty(),
          [&] { return fmt::format("jacobian: no derivative by {}: {}", variable.name, variable.why_none); });
}

}  // namespace

// The scene that a row of the input describes, in volts, with the data for derivatives of its figures by the input columns.
struct Evaluator::Place {
  PreparedScene scene;                 ///< scene whose [spread] has the input columns that vary the device
  std::vector<std::size_t> of_device;  ///< index of the input column for each varied quantity of the [spread] of `scene`
  std::vector<WaveformKey> of_waveforms;
  MeasuredUnits known;  ///< scale factors of the waveforms' voltages if they scale with the Vdp of a device; else empty
};

Evaluator::Place Evaluator::place_of(std::span<const double> row, const Progress& progress) const {
  std::vector<std::string> device_keys;
  for (const std::string& key : keys_) {
    if (!waveform_key(key_and_element(key).first)) device_keys.push_back(key);
  }
  const auto with_columns = [&](PreparedScene scene, std::vector<WaveformKey> of_waveforms, MeasuredUnits known) {
    Place place{.scene = std::move(scene), .of_waveforms = std::move(of_waveforms), .known = std::move(known)};
    for (const SpreadVariable& variable : place.scene.scene.spread.variables)
      place.of_device.push_back(static_cast<std::size_t>(std::find(keys_.begin(), keys_.end(), variable.name) - keys_.begin()));
    return place;
  };
  if (options_.volts == VoltsOf::nominal) {
    SceneFile file = nominal_->resolved();
    file.erase("spread");
    for (std::size_t i = 0; i < of_device_.size(); ++i) {
      const VariedKey& key = nominal_->scene.spread.variables[i].keys.front();
      file.assign(key.path, Quantity{.value = row[of_device_[i]], .dimension = key.measured_in}, key.element);
    }
    PreparedScene there = prepare(scene_that_varies(file, device_keys), false, progress);
    const std::vector<Waveform> own = waveforms_of(row);
    const std::string why = violation_of(own);
    require(why.empty(), [&] { return "jacobian: " + why; });
    for (std::size_t k = 0; k < own.size(); ++k) there.drives[k].waveform = own[k];
    return with_columns(std::move(there), of_waveforms_, {});
  }
  const SceneFile file = scene_of(row);
  const PreparedScene in_volts = prepare_and_choose(file, false, progress);
  MeasuredUnits known;
  if (!device_keys.empty()) {
    const WrittenVolts volts = written_volts(file, in_volts);
    require(!volts.in_other_units && !(volts.in_volts && volts.in_pull_in),
            "jacobian: volts that follow the pull-in voltage of each row have an exact derivative where all of them are written "
            "in Vdp, or none");
    const std::vector<std::string> drives = in_volts.drive_names();
    const auto electrodes =
        std::ranges::count_if(drives, [](const std::string& name) { return name != piezo_drive && name != dispersion_drive; });
    require(!volts.in_pull_in || electrodes == 1, "jacobian: volts in Vdp of several electrodes have no exact derivative");
    if (volts.in_pull_in) known = MeasuredUnits({.pull_in_error = 0.0});
  }
  PreparedScene there = prepare(scene_that_varies(in_volts.resolved(), device_keys), false, progress);
  return with_columns(std::move(there), keys_of_row(in_volts, row), std::move(known));
}

// Returns the input columns that are parameters of waveforms, with the factors from their units to those of the parameters.
std::vector<Evaluator::WaveformKey> Evaluator::keys_of_row(const PreparedScene& in_volts, std::span<const double> row) const {
  std::vector<WaveformKey> all;
  std::vector<Waveform> waveforms = in_volts.waveforms();
  const std::vector<std::string> drives = in_volts.drive_names();
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    const auto [path, element] = key_and_element(keys_[i]);
    const auto named = waveform_key(path);
    if (!named) continue;
    const auto& [drive, name] = *named;
    WaveformKey key{.column = i,
                    .drive = static_cast<std::size_t>(std::find(drives.begin(), drives.end(), drive) - drives.begin()),
                    .parameter = name == "frequency" ? "angular_frequency" : name,
                    .element = element};
    std::vector<std::string_view> names;
    ParameterKind kind{};
    const double* const number =
        key.drive < drives.size() ? waveform_parameter(waveforms[key.drive], key.parameter, element, names, kind) : nullptr;
    require(number != nullptr, [&] { return fmt::format("jacobian: {} must be a number of a waveform in volts", keys_[i]); });
    require(row[i] != 0,
            [&] { return fmt::format("jacobian: {} must differ from 0, since its unit follows from its value", keys_[i]); });
    key.factor = *number / row[i];
    all.push_back(std::move(key));
  }
  return all;
}

// Computes the derivatives of figures by the input columns that are parameters of waveforms.
void Evaluator::derive_by_waveforms(const Place& place, std::span<const double> row, Eigen::MatrixXd& all,
                                    const Progress& progress) const {
  const std::vector<Waveform> here = place.scene.waveforms();
  std::vector<WaveformParameter> parameters;
  for (const WaveformKey& key : place.of_waveforms) {
    require(!place.scene.drives[key.drive].source.bits, [&] {
      return fmt::format("jacobian: no derivative by {}: its source rounds to bits, so that the voltage jumps",
                         keys_[key.column]);
    });
    const Signal commanded = place.scene.commanded(key.drive, here[key.drive]);
    Waveform one = here[key.drive];
    std::vector<std::string_view> names;
    ParameterKind kind{};
    const double number = std::abs(*waveform_parameter(one, key.parameter, key.element, names, kind));
    const bool is_time = kind == ParameterKind::time || kind == ParameterKind::end_time;
    const bool is_voltage = kind == ParameterKind::level || kind == ParameterKind::swing;
    const double size = std::max(number, is_voltage ? commanded.peak() : is_time ? commanded.pieces().back().begin : 0);
    parameters.push_back({.name = keys_[key.column], .value = row[key.column], .size = size > 0 ? size / key.factor : 1});
  }
  const auto signals = [&](std::span<const double> x) {
    std::vector<Waveform> moved = here;
    for (std::size_t k = 0; k < x.size(); ++k) {
      const WaveformKey& key = place.of_waveforms[k];
      std::vector<std::string_view> names;
      ParameterKind kind{};
      *waveform_parameter(moved[key.drive], key.parameter, key.element, names, kind) = key.factor * x[k];
    }
    return place.scene.applied(moved);
  };
  const Derivatives found = derivatives_by_waveforms(place.scene, parameters, signals, {}, progress);
  progress.throw_if_stopped();
  for (std::size_t f = 0; f < figures_.size(); ++f) {
    const FigureDerivatives& of = derived(found, figures_[f]);
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      require_derived(found.variables[k]);
      all(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(place.of_waveforms[k].column)) = of.by_variable[k];
    }
  }
}

Eigen::MatrixXd Evaluator::jacobian(std::span<const double> row, const Progress& progress) const {
  require(row.size() == keys_.size(), [&] { return fmt::format("jacobian: a row must have {} numbers", keys_.size()); });
  const Place place = place_of(row, progress);
  Eigen::MatrixXd all(static_cast<Eigen::Index>(figures_.size()), static_cast<Eigen::Index>(keys_.size()));
  if (!place.of_waveforms.empty()) derive_by_waveforms(place, row, all, progress);
  if (place.of_device.empty()) return all;
  const PreparedScene& there = place.scene;
  const Derivatives found = derivatives(there, {.waveforms = there.waveforms(), .known = place.known}, {}, progress);
  progress.throw_if_stopped();
  for (std::size_t f = 0; f < figures_.size(); ++f) {
    const FigureDerivatives& of = derived(found, figures_[f]);
    for (std::size_t i = 0; i < place.of_device.size(); ++i) {
      const SpreadVariable& variable = there.scene.spread.variables[i];
      require_derived(found.variables[i]);
      all(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(place.of_device[i])) =
          of.by_variable[i] / (variable.is_factor ? variable.keys.front().nominal : 1);
    }
  }
  return all;
}

}  // namespace softland
