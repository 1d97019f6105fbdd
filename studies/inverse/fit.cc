#include "studies/inverse/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <filesystem>
#include <limits>
#include <memory>
#include <numeric>
#include <set>
#include <utility>

#include "base/decompositions.h"
#include "base/engineering.h"
#include "base/require.h"
#include "base/standard_normal.h"
#include "config/assumed_spread.h"
#include "config/edited_scene.h"
#include "config/schema.h"
#include "model/constants.h"
#include "sampling/points.h"
#include "studies/closing/actuator.h"
#include "studies/closing/auto_settings.h"
#include "studies/inverse/trace_windows.h"

namespace softland {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double unset = Metrics::unset;
constexpr double scale_without_prior = 0.1;  // scale over the value
constexpr double quantile_95 = 1.959963984540054;

// A measured number of the bench file.
struct Datum {
  std::size_t device = 0, instrument = 0;  // indices of the device, and of its instrument
  Index row = 0;                           // index of the value in the reading
  double measured = 0, error = 0;
  std::size_t measurement = 0;
  double time = unset;  // time of the row, for a trace [s]
};

struct FitDevice {
  std::string name;
  PreparedScene nominal;
  std::vector<Instrument> instruments = {};
};

// An unknown: a variable of the spread, of one device or shared by all.
struct Parameter {
  std::size_t variable = 0;
  std::optional<std::size_t> device = {};  // none if shared by all
  double mean = 0, scale = 1;              // value = mean + scale z
  bool has_prior = true;
};

struct Setup {
  std::vector<FitDevice> devices;
  std::vector<Datum> data;
  std::vector<Parameter> parameters;
  std::vector<std::vector<std::size_t>> of_device;  // for each device, the indices of the parameters of its variables
  MatrixXd prior;                                   // information P of the prior
  MatrixXd prior_root;                              // residuals of the prior are prior_root z
  Loss loss = Loss::huber;
};

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Returns the entry of the spread that has this key; the name itself if there is none.
std::string entry_of(const DeviceSpread& spread, const std::string& name) {
  for (const SpreadVariable& v : spread.variables) {
    if (v.name == name) return v.name;
  }
  for (const SpreadVariable& v : spread.variables) {
    if (v.keys.size() == 1 && v.keys.front().name() == name) return v.name;
  }
  return name;
}

// Returns the scene in volts, with the unknowns as its spread. Unknowns without an entry in [spread] get one that does not act
// as a prior.
PreparedScene with_unknowns(const PreparedScene& given, std::vector<std::string>& unknowns,
                            std::vector<std::string>& without_prior) {
  const DeviceSpread& spread = given.scene.spread;
  SceneFile file = given.resolved();
  if (unknowns.empty()) {
    for (const SpreadVariable& v : spread.variables) {
      if (!v.is_drawn_per_edge) unknowns.push_back(v.name);
    }
  }
  for (std::string& name : unknowns) {
    name = entry_of(spread, name);
    if (std::ranges::any_of(spread.variables, [&](const SpreadVariable& v) { return v.name == name; })) continue;
    for (const SpreadVariable& v : spread.variables) {
      const bool follows = std::ranges::any_of(v.keys, [&](const VariedKey& key) { return key.name() == name; });
      require_request(!follows, [&] {
        return fmt::format("{} {}: give the entry '{}' of [spread] instead, by which it varies together with others",
                           requested("unknown"), name, v.name);
      });
    }
    try {
      SceneFile tried = file;
      tried.set(fmt::format("spread.\"{}\"={{distribution=\"normal\",cov=\"{} %\"}}", name, 100 * scale_without_prior));
      static_cast<void>(read_scene(tried));
      file = std::move(tried);
    } catch (const InvalidInput& error) {
      throw InvalidRequest(fmt::format("{} {}: {}", requested("unknown"), name, error.what()));
    }
    without_prior.push_back(name);
  }
  PreparedScene p = prepare(file);
  DeviceSpread& own = p.scene.spread;
  for (std::size_t i = own.variables.size(); i-- > 0;) {
    require_request(!(own.variables[i].is_drawn_per_edge && has(unknowns, own.variables[i].name)), [&] {
      return fmt::format("{} {}: must have one value per device, but it is random for every edge", requested("unknown"),
                         own.variables[i].name);
    });
    if (!has(unknowns, own.variables[i].name)) own.leave_out(i);
  }
  require(!own.variables.empty(), [&] { return fmt::format("{}: a fit needs at least one unknown", given.scene.file.name()); });
  return p;
}

// ---- measurements

class Instruments {
 public:
  explicit Instruments(const FitDevice& device) : device_(device) {}

  // Returns the instrument that reads row `i` of a measurement, or all of its rows.
  [[nodiscard]] Instrument of(const BenchMeasurement& m, std::size_t i) const {
    const PreparedScene& p = device_.nominal;
    Instrument one{.what = quantity_of(m), .drive = drive_of(m), .mode = static_cast<std::size_t>(m.mode - 1)};
    require(m.mode <= p.model.modes(), [&] { return wrong(m, fmt::format("the scene has {} modes", p.model.modes())); });
    if (m.waveform) one.waveforms = waveforms_of(m);
    if (!m.levels.empty()) one.level = m.levels[i];
    const bool closes = one.what != Measurable::pull_in && one.what != Measurable::release && one.what != Measurable::frequency &&
                        one.what != Measurable::capacitance;
    if (closes && !m.waveform && m.levels.empty()) one.waveforms = p.waveforms();
    one.times = m.times;
    one.edges = m.values.size();
    const bool needs_contact = closes && one.what != Measurable::position && one.what != Measurable::velocity;
    require(p.model.has_contact() || (!needs_contact && one.what != Measurable::release),
            [&] { return wrong(m, "the scene has no [contact]"); });
    return one;
  }

 private:
  [[nodiscard]] std::string wrong(const BenchMeasurement& m, std::string_view rule) const {
    return fmt::format("{}: {}: {}", m.place, m.quantity, rule);
  }
  [[nodiscard]] Measurable quantity_of(const BenchMeasurement& m) const {
    const auto found = std::ranges::find(measurables, m.quantity, &MeasurableRow::name);
    return found->value;
  }
  [[nodiscard]] std::size_t drive_of(const BenchMeasurement& m) const {
    const PreparedScene& p = device_.nominal;
    const std::vector<std::string> names = p.drive_names();
    if (!m.drive.empty()) {
      const auto found = std::find(names.begin(), names.end(), m.drive);
      require(found != names.end(),
              [&] { return wrong(m, fmt::format("the scene has no drive '{}' (it has {})", m.drive, fmt::join(names, ", "))); });
      const auto k = static_cast<std::size_t>(found - names.begin());
      require(p.model.drive_kind(k) == DriveKind::electrode || m.quantity == "frequency" || m.quantity == "closing_time",
              [&] { return wrong(m, "must be measured on an electrode"); });
      return k;
    }
    require(has_pulling_electrode(p.scene.device) || m.quantity == "frequency",
            [&] { return wrong(m, "the scene has no electrode that pulls in: give the drive"); });
    return has_pulling_electrode(p.scene.device) ? searched_drive(p.scene.device) : 0;
  }
  [[nodiscard]] std::vector<Waveform> waveforms_of(const BenchMeasurement& m) const {
    const PreparedScene& p = device_.nominal;
    if (*m.waveform == "scene") return p.waveforms();
    DriveWaveforms all;
    std::string first_fault;
    for (const std::string& name : p.drive_names()) {
      try {
        all.emplace(name, read_table(*m.waveform, name));
      } catch (const InvalidInput& error) {
        if (first_fault.empty()) first_fault = error.what();
      }
    }
    require(!all.empty(), [&] { return wrong(m, first_fault); });
    return p.in_drive_order(all);
  }

  const FitDevice& device_;
};

void add_data(Setup& setup, const Bench& bench) {
  for (std::size_t n = 0; n < bench.measurements.size(); ++n) {
    const BenchMeasurement& m = bench.measurements[n];
    const auto device =
        static_cast<std::size_t>(std::ranges::find(setup.devices, m.device, &FitDevice::name) - setup.devices.begin());
    FitDevice& own = setup.devices[device];
    const Instruments instruments(own);
    const Instrument first = instruments.of(m, 0);
    const bool reads_all = first.size() > 1;
    for (std::size_t i = 0; i < m.values.size(); ++i) {
      if (i == 0 || (!reads_all && !m.levels.empty() && m.levels[i] != m.levels[i - 1]))
        own.instruments.push_back(instruments.of(m, i));
      if (!reads_all) own.instruments.back().edges = 1;
      setup.data.push_back({.device = device,
                            .instrument = own.instruments.size() - 1,
                            .row = reads_all ? static_cast<Index>(i) : 0,
                            .measured = m.values[i],
                            .error = m.errors[i],
                            .measurement = n,
                            .time = m.times.empty() ? unset : m.times[i]});
    }
  }
}

// ---- unknowns and priors

void add_parameters(Setup& setup, const std::vector<std::string>& shared, const std::vector<std::string>& without_prior) {
  const DeviceSpread& spread = setup.devices.front().nominal.scene.spread;
  setup.of_device.assign(setup.devices.size(), std::vector<std::size_t>(spread.variables.size()));
  for (std::size_t v = 0; v < spread.variables.size(); ++v) {
    const SpreadVariable& variable = spread.variables[v];
    const bool is_shared = setup.devices.size() == 1 || has(shared, variable.name);
    for (std::size_t d = 0; d < setup.devices.size(); ++d) {
      if (d == 0 || !is_shared) {
        setup.parameters.push_back({.variable = v,
                                    .device = is_shared ? std::nullopt : std::optional(d),
                                    .mean = variable.distribution.mean(),
                                    .scale = variable.distribution.standard_deviation(),
                                    .has_prior = !has(without_prior, variable.name)});
      }
      setup.of_device[d][v] = setup.parameters.size() - 1;
    }
  }
}

// The unknowns of one device, or the shared ones, have the correlations of the spread.
void add_prior(Setup& setup) {
  const auto n = static_cast<Index>(setup.parameters.size());
  setup.prior = setup.prior_root = MatrixXd::Zero(n, n);
  std::set<std::optional<std::size_t>> owners;
  for (const Parameter& p : setup.parameters) owners.insert(p.device);
  const MatrixXd& correlation = setup.devices.front().nominal.scene.spread.correlation;
  for (const std::optional<std::size_t>& owner : owners) {
    std::vector<Index> places, variables;
    for (Index i = 0; i < n; ++i) {
      const Parameter& p = setup.parameters[static_cast<std::size_t>(i)];
      if (p.device == owner && p.has_prior) places.push_back(i), variables.push_back(static_cast<Index>(p.variable));
    }
    if (places.empty()) continue;
    const MatrixXd factor = cholesky_factor(correlation(variables, variables));
    MatrixXd root(places.size(), places.size());
    for (Index k = 0; k < root.cols(); ++k) root.col(k) = solve_linear(factor, VectorXd::Unit(root.rows(), k));
    setup.prior_root(places, places) = root;
    setup.prior(places, places) = root.transpose() * root;
  }
}

// ---- residuals

// Computes the readings of all devices at z. Each search has its own object, so that searches can run in parallel.
class Model {
 public:
  explicit Model(const Setup& setup) : setup_(setup) {
    for (const FitDevice& device : setup.devices) readers_.emplace_back(device.nominal);
  }

  // Computes the readings. Returns false if a device is impossible or cannot be read.
  [[nodiscard]] bool read(std::span<const double> z, VectorXd& values, MatrixXd* slopes) {
    const auto n = static_cast<Index>(setup_.parameters.size());
    values.resize(static_cast<Index>(setup_.data.size()));
    if (slopes != nullptr) slopes->setZero(values.size(), n);
    std::size_t next = 0;
    std::vector<std::vector<DeviceReader::Reading>> all(setup_.devices.size());
    for (std::size_t d = 0; d < setup_.devices.size(); ++d) {
      if (!readers_[d].move_to(values_of(d, z))) return false;
      for (const Instrument& instrument : setup_.devices[d].instruments) {
        all[d].push_back(readers_[d].read(instrument, slopes != nullptr));
        const DeviceReader::Reading& last = all[d].back();
        if (!last.values.allFinite() || (slopes != nullptr && !last.slopes.allFinite())) return false;
      }
    }
    for (const Datum& datum : setup_.data) {
      const DeviceReader::Reading& reading = all[datum.device][datum.instrument];
      const auto i = static_cast<Index>(next++);
      values[i] = reading.values[datum.row];
      if (slopes == nullptr) continue;
      for (std::size_t v = 0; v < setup_.of_device[datum.device].size(); ++v) {
        const std::size_t p = setup_.of_device[datum.device][v];
        (*slopes)(i, static_cast<Index>(p)) += reading.slopes(datum.row, static_cast<Index>(v)) * setup_.parameters[p].scale;
      }
    }
    return true;
  }

  // Returns the reading of one instrument on a device at z, in its own unit, and the derivatives by z.
  [[nodiscard]] std::optional<std::pair<double, VectorXd>> read_one(std::size_t device, std::span<const double> z,
                                                                    const Instrument& instrument) {
    if (!readers_[device].move_to(values_of(device, z))) return std::nullopt;
    const DeviceReader::Reading reading = readers_[device].read(instrument, true);
    if (!reading.values.allFinite() || reading.slopes.size() == 0 || !reading.slopes.allFinite()) return std::nullopt;
    VectorXd slopes = VectorXd::Zero(static_cast<Index>(setup_.parameters.size()));
    for (std::size_t v = 0; v < setup_.of_device[device].size(); ++v) {
      const std::size_t p = setup_.of_device[device][v];
      slopes[static_cast<Index>(p)] += reading.slopes(0, static_cast<Index>(v)) * setup_.parameters[p].scale;
    }
    return std::pair{reading.values[0], slopes};
  }

 private:
  [[nodiscard]] std::vector<double> values_of(std::size_t device, std::span<const double> z) const {
    std::vector<double> values;
    for (const std::size_t p : setup_.of_device[device])
      values.push_back(setup_.parameters[p].mean + setup_.parameters[p].scale * z[p]);
    return values;
  }

  const Setup& setup_;
  std::deque<DeviceReader> readers_;
};

LeastSquares problem_of(const Setup& setup) {
  const auto model = std::make_shared<Model>(setup);
  const std::size_t n = setup.parameters.size(), data = setup.data.size();
  return {.unknowns = n,
          .residuals = data + n,
          .robust = data,
          .loss = setup.loss,
          .evaluate = [&setup, model, n, data](std::span<const double> z, std::span<double> residuals, double* jacobian) {
            VectorXd values;
            MatrixXd slopes;
            if (!model->read(z, values, jacobian != nullptr ? &slopes : nullptr)) return false;
            for (std::size_t i = 0; i < data; ++i) {
              const Datum& datum = setup.data[i];
              residuals[i] = (values[static_cast<Index>(i)] - datum.measured) / datum.error;
              for (std::size_t k = 0; jacobian != nullptr && k < n; ++k)
                jacobian[i * n + k] = slopes(static_cast<Index>(i), static_cast<Index>(k)) / datum.error;
            }
            const VectorXd prior = setup.prior_root * Eigen::Map<const VectorXd>(z.data(), static_cast<Index>(n));
            for (std::size_t i = 0; i < n; ++i) {
              residuals[data + i] = prior[static_cast<Index>(i)];
              for (std::size_t k = 0; jacobian != nullptr && k < n; ++k)
                jacobian[(data + i) * n + k] = setup.prior_root(static_cast<Index>(i), static_cast<Index>(k));
            }
            return true;
          }};
}

std::vector<std::vector<double>> starts_of(const Setup& setup, const FitOptions& options) {
  const std::size_t n = setup.parameters.size();
  std::vector<std::vector<double>> all{std::vector<double>(n, 0.0)};
  const SamplePoints points(PointSet::sobol, n, options.seed, Stream::fit, std::max<std::size_t>(1, options.starts));
  for (std::size_t k = 1; k < options.starts; ++k) {
    std::vector<double>& z = all.emplace_back(n);
    points.point(k - 1, z);
    for (double& one : z) one = standard_normal_quantile(one);
  }
  return all;
}

// Returns J^T W J for data with these residuals and slopes, both in units of the errors.
MatrixXd information(const MatrixXd& slopes, const VectorXd& residuals, Loss loss) {
  const VectorXd weights = residuals.unaryExpr([&](double r) { return loss_weight(loss, r); });
  return slopes.transpose() * weights.asDiagonal() * slopes;
}

// ---- results of the end

class EndOfFit {
 public:
  EndOfFit(const Setup& setup, Fit& fit) : setup_(setup), fit_(fit), model_(setup) {}

  void add(const LeastSquaresEnd& end) {
    z_ = Eigen::Map<const VectorXd>(end.x.data(), static_cast<Index>(end.x.size()));
    VectorXd values;
    MatrixXd slopes;
    require(model_.read(end.x, values, &slopes), "the fitted device cannot be read");
    VectorXd errors(values.size()), residuals(values.size());
    for (Index i = 0; i < values.size(); ++i) {
      const Datum& datum = setup_.data[static_cast<std::size_t>(i)];
      errors[i] = datum.error;
      residuals[i] = (values[i] - datum.measured) / datum.error;
    }
    slopes_ = errors.cwiseInverse().asDiagonal() * slopes;
    residuals_ = residuals;
    add_residuals(values);
    fit_.estimate = estimate(information(slopes_, residuals_, setup_.loss), setup_.prior);
    if (setup_.devices.size() > 1) fit_.estimate.weak = weak_of_a_device();
    add_unknowns();
  }

  void add_next(const Watch& watch);
  void add_population();
  // Throws if no datum depends on an unknown without a prior: its value would be the one at which the search started.
  void require_all_seen(const std::string& bench) const {
    for (std::size_t i = 0; i < setup_.parameters.size(); ++i) {
      const Parameter& p = setup_.parameters[i];
      require_request(p.has_prior || !slopes_.col(static_cast<Index>(i)).isZero(0), [&] {
        return fmt::format(
            "{} {}: no measurement of {} depends on it: leave it out, or give it an entry of [spread] as its prior",
            requested("unknown"), fit_.scene.scene.spread.variables[p.variable].name, bench);
      });
    }
  }

 private:
  void add_residuals(const VectorXd& values) {
    VectorXd before;
    const std::vector<double> nominal(setup_.parameters.size(), 0.0);
    const bool known = model_.read(nominal, before, nullptr);
    for (Index i = 0; i < values.size(); ++i) {
      const Datum& datum = setup_.data[static_cast<std::size_t>(i)];
      const FitDevice& device = setup_.devices[datum.device];
      const Instrument& instrument = device.instruments[datum.instrument];
      FitResidual one{.measurement = datum.measurement,
                      .device = device.name,
                      .what = instrument.what,
                      .drive = device.nominal.drive_names()[instrument.drive],
                      .level = {},
                      .time = {},
                      .measured = datum.measured,
                      .error = datum.error,
                      .before = known ? before[i] : unset,
                      .after = values[i]};
      if (instrument.level != 0) one.level = instrument.level;
      if (!instrument.times.empty()) one.time = instrument.times[static_cast<std::size_t>(datum.row)];
      fit_.residuals.push_back(one);
    }
  }

  // Weak directions of the mean device. A direction that is weak for one device is weak for all, but each has other weak
  // directions.
  [[nodiscard]] std::vector<WeakDirection> weak_of_a_device() const {
    const auto n = static_cast<Index>(setup_.parameters.size());
    const std::vector<std::size_t>& first = setup_.of_device.front();
    MatrixXd together = MatrixXd::Zero(n, static_cast<Index>(first.size()));
    for (const std::vector<std::size_t>& own : setup_.of_device) {
      for (std::size_t v = 0; v < own.size(); ++v) together(static_cast<Index>(own[v]), static_cast<Index>(v)) = 1;
    }
    std::vector<WeakDirection> all =
        weak_directions(together.transpose() * fit_.estimate.data * together / static_cast<double>(setup_.devices.size()));
    for (WeakDirection& weak : all) {
      const VectorXd by_variable = weak.direction;
      weak.direction = VectorXd::Zero(n);
      for (std::size_t v = 0; v < first.size(); ++v)
        weak.direction[static_cast<Index>(first[v])] = by_variable[static_cast<Index>(v)];
      for (std::size_t& unknown : weak.unknowns) unknown = first[unknown];
    }
    return all;
  }

  void add_unknowns() {
    const DeviceSpread& spread = fit_.scene.scene.spread;
    for (std::size_t i = 0; i < setup_.parameters.size(); ++i) {
      const Parameter& p = setup_.parameters[i];
      const SpreadVariable& variable = spread.variables[p.variable];
      FittedUnknown one{.name = variable.name,
                        .device = p.device ? setup_.devices[*p.device].name : "",
                        .unit = variable.is_factor ? "" : variable.keys.front().unit};
      // A factor of a single key is shown as the value of that key.
      const bool as_value = variable.is_factor && variable.keys.size() == 1;
      const double unit = as_value ? variable.keys.front().nominal : 1;
      if (as_value) one.unit = variable.keys.front().unit;
      one.nominal = as_value ? unit : variable.nominal();
      one.scale = std::abs(unit) * p.scale;
      one.value = unit * (p.mean + p.scale * z_[static_cast<Index>(i)]);
      one.standard_error = one.scale * fit_.estimate.deviation(i);
      one.low = one.value - quantile_95 * one.standard_error;
      one.high = one.value + quantile_95 * one.standard_error;
      if (p.has_prior) one.prior_mean = unit * p.mean, one.prior_deviation = one.scale;
      fit_.unknowns.push_back(std::move(one));
    }
  }

  const Setup& setup_;
  Fit& fit_;
  Model model_;
  VectorXd z_, residuals_;
  MatrixXd slopes_;
};

// A possible further measurement, with its typical error.
struct Candidate {
  std::string name;
  Instrument instrument;
  double error = 0;           // absolute error [SI unit]; 0 if relative
  double relative_error = 0;  // error over the value; 0 if absolute
};

std::vector<Candidate> candidates(const PreparedScene& p) {
  constexpr double of_volts = 0.005, of_frequency = 1e-3, of_capacitance = 0.01;
  std::vector<Candidate> all;
  const auto add = [&](std::string name, const Instrument& instrument, double error, double relative) {
    all.push_back({.name = std::move(name), .instrument = instrument, .error = error, .relative_error = relative});
  };
  for (int mode = 0; mode < std::min(2, p.model.modes()); ++mode)
    add(mode == 0 ? "resonance" : "second resonance", {.what = Measurable::frequency, .mode = static_cast<std::size_t>(mode)}, 0,
        of_frequency);
  const std::vector<std::string> names = p.drive_names();
  for (std::size_t k = 0; k < p.scene.device.electrodes.size(); ++k) {
    if (!pulls_in(p.scene.device, k)) continue;
    const std::string of = p.scene.device.electrodes.size() > 1 ? fmt::format(" of '{}'", names[k]) : "";
    const double volts = static_pull_in(p.model, k, bias_of(p.scene, k)).voltage;
    add("pull-in voltage" + of, {.what = Measurable::pull_in, .drive = k}, 0, of_volts);
    add("capacitance at 0 V" + of, {.what = Measurable::capacitance, .drive = k}, 0, of_capacitance);
    if (p.model.has_contact()) add("release voltage" + of, {.what = Measurable::release, .drive = k}, 0, of_volts);
    if (!std::isfinite(volts)) continue;
    const auto rounded = [](double v) { return std::stod(fmt::format("{:.3g}", v)); };
    const double half = rounded(0.8 * volts);
    add(fmt::format("capacitance at {}{}", engineering(half, "V", 4), of),
        {.what = Measurable::capacitance, .drive = k, .level = half}, 0, of_capacitance);
    add(fmt::format("resonance at {}{}", engineering(half, "V", 4), of),
        {.what = Measurable::frequency, .drive = k, .level = half}, 0, of_frequency);
    if (!p.model.has_contact()) continue;
    for (const double over : {1.1, 1.5, 2.0, 3.0}) {
      const double level = rounded(over * volts);
      add(fmt::format("closing time at {}{}", engineering(level, "V", 4), of),
          {.what = Measurable::closing_time, .drive = k, .level = level}, usual_time_error, 0);
    }
  }
  return all;
}

void EndOfFit::add_next(const Watch& watch) {
  const std::vector<Candidate> all = candidates(fit_.scene);
  const std::span<const double> z(z_.data(), static_cast<std::size_t>(z_.size()));
  for (std::size_t k = 0; k < all.size(); ++k) {
    watch.throw_if_stopped();
    watch.tell("further measurements", static_cast<double>(k) / static_cast<double>(all.size()));
    std::vector<VectorXd> slopes;
    double error = all[k].error;
    for (std::size_t d = 0; d < setup_.devices.size(); ++d) {
      const auto reading = model_.read_one(d, z, all[k].instrument);
      if (!reading) continue;
      if (all[k].relative_error > 0) error = all[k].relative_error * std::abs(reading->first);
      slopes.push_back(reading->second / error);
    }
    if (slopes.empty()) continue;
    NextMeasurement next{.name = all[k].name, .what = all[k].instrument.what, .level = {}, .error = error};
    if (all[k].instrument.level != 0) next.level = all[k].instrument.level;
    next.reduction = fit_.estimate.reduction(slopes);
    fit_.next.push_back(std::move(next));
  }
  std::ranges::stable_sort(fit_.next, [](const auto& a, const auto& b) { return a.reduction > b.reduction; });
}

// Adds the population of the unknowns that belong to single devices, at the fitted values of the shared ones.
void EndOfFit::add_population() {
  if (setup_.devices.size() < 2) return;
  FittedPopulation found{.variables = {}, .names = {}, .mean = {}, .deviation = {}, .correlation = {}};
  const DeviceSpread& spread = fit_.scene.scene.spread;
  for (std::size_t v = 0; v < spread.variables.size(); ++v) {
    if (setup_.parameters[setup_.of_device[0][v]].device)
      found.variables.push_back(v), found.names.push_back(spread.variables[v].name);
  }
  if (found.variables.empty()) return;
  const auto n = static_cast<Index>(found.variables.size());
  std::vector<KnownDevice> devices;
  Population begin{.mean = VectorXd::Zero(n), .covariance = MatrixXd::Identity(n, n)};
  for (std::size_t d = 0; d < setup_.devices.size(); ++d) {
    std::vector<Index> places;
    for (const std::size_t v : found.variables) places.push_back(static_cast<Index>(setup_.of_device[d][v]));
    const VectorXd weights = residuals_.unaryExpr([&](double r) { return loss_weight(setup_.loss, r); });
    const MatrixXd own = slopes_(Eigen::all, places);
    const MatrixXd weighted = own.transpose() * weights.asDiagonal();
    devices.push_back({.data = weighted * own, .target = weighted * (own * z_(places) - residuals_)});
  }
  const Population population = population_of(devices, begin);
  const VectorXd deviations = population.covariance.diagonal().cwiseSqrt();
  found.correlation = deviations.cwiseInverse().asDiagonal() * population.covariance * deviations.cwiseInverse().asDiagonal();
  for (Index i = 0; i < n; ++i) {
    const Parameter& p = setup_.parameters[setup_.of_device[0][found.variables[static_cast<std::size_t>(i)]]];
    found.mean.push_back(p.mean + p.scale * population.mean[i]);
    found.deviation.push_back(p.scale * deviations[i]);
  }
  fit_.population = std::move(found);
}

SceneFile with_changes(SceneFile file, const std::string& device, const std::vector<std::string>& changes) {
  for (const std::string& change : changes) {
    try {
      file.set(change);
    } catch (const InvalidInput& error) {
      throw InvalidInput(fmt::format("[device.{}]: {}", device, error.what()));
    }
  }
  return file;
}

Setup setup_of(const SceneFile& file, const Bench& bench, const FitOptions& options, const Watch& watch) {
  Setup setup{.devices = {}, .data = {}, .parameters = {}, .of_device = {}, .prior = {}, .prior_root = {}, .loss = options.loss};
  std::vector<std::string> names;
  for (const BenchMeasurement& m : bench.measurements) {
    if (!has(names, m.device)) names.push_back(m.device);
  }
  require(names.size() == 1 || !has(names, ""),
          [&] { return fmt::format("{}: either all measurements must name their device, or none", bench.name); });
  require_open_start(read_scene(file), "fit closes the switch");
  std::vector<std::string> without_prior;
  std::optional<PreparedScene> plain;
  for (const std::string& name : names) {
    const auto changes = bench.changes.find(name);
    const bool differs = changes != bench.changes.end();
    std::vector<std::string> unknowns = options.unknowns;
    without_prior.clear();
    if (differs || !plain) {
      PreparedScene own = with_unknowns(
          prepare_and_choose(differs ? with_changes(file, name, changes->second) : file, false, watch), unknowns, without_prior);
      if (!differs) plain = own;
      setup.devices.push_back({.name = name, .nominal = std::move(own)});
    } else {
      setup.devices.push_back({.name = name, .nominal = *plain});
      static_cast<void>(with_unknowns(*plain, unknowns, without_prior));
    }
  }
  for (const std::string& name : options.shared) {
    const auto& variables = setup.devices.front().nominal.scene.spread.variables;
    require_request(std::ranges::any_of(variables, [&](const SpreadVariable& v) { return v.name == name; }),
                    [&] { return fmt::format("{} {}: must be one of the unknowns", requested("shared"), name); });
  }
  add_parameters(setup, options.shared, without_prior);
  add_prior(setup);
  return setup;
}

// Returns the setup with these measurements.
Setup with_data(Setup setup, const Bench& bench) {
  for (FitDevice& device : setup.devices) device.instruments.clear();
  setup.data.clear();
  add_data(setup, bench);
  return setup;
}

}  // namespace

double Fit::chi_squared() const {
  return std::accumulate(residuals.begin(), residuals.end(), 0.0,
                         [](double sum, const FitResidual& r) { return sum + r.normalized() * r.normalized(); });
}

double Fit::chi_squared_before() const {
  return std::accumulate(residuals.begin(), residuals.end(), 0.0,
                         [](double sum, const FitResidual& r) { return sum + r.normalized_before() * r.normalized_before(); });
}

std::vector<Fit::FittedKey> Fit::keys(const std::string& device) const {
  std::vector<FittedKey> all;
  for (const SpreadVariable& variable : scene.scene.spread.variables) {
    const auto one = std::ranges::find_if(
        unknowns, [&](const FittedUnknown& u) { return u.name == variable.name && (u.device.empty() || u.device == device); });
    if (one == unknowns.end()) continue;
    for (const VariedKey& key : variable.keys) {
      const bool is_value_already = variable.is_factor && variable.keys.size() == 1;
      const double value = is_value_already ? one->value : DeviceSpread::value(variable, key, one->value);
      all.push_back({.path = key.path, .element = key.element, .value = {.value = value, .dimension = key.measured_in}});
    }
  }
  return all;
}

void set_spread(SceneFile& file, const Fit& fit) {
  if (!fit.population) return;
  const FittedPopulation& all = *fit.population;
  std::vector<std::string> pairs;
  for (std::size_t i = 0; i < all.names.size(); ++i) {
    const SpreadVariable& variable = fit.scene.scene.spread.variables[all.variables[i]];
    std::vector<std::string> keys, weights;
    for (const VariedKey& key : variable.keys) {
      keys.push_back('"' + key.name() + '"');
      weights.push_back(number_text(key.weight));
    }
    // The width is relative to the mean, which is now the scene's value.
    const std::string width =
        variable.is_factor
            ? fmt::format("cov=\"{:.4g} %\"", 100 * all.deviation[i] / all.mean[i])
            : fmt::format("standard_deviation=\"{}\"", quantity_text(all.deviation[i], variable.keys.front().measured_in));
    const std::string added = variable.is_added ? fmt::format("weights=[{}],", fmt::join(weights, ",")) : "";
    file.set(fmt::format("spread.\"{}\"={{keys=[{}],{}distribution=\"normal\",{}}}", all.names[i], fmt::join(keys, ","), added,
                         width));
    for (std::size_t j = 0; j < i; ++j) {
      constexpr double most = 0.999;  // at a correlation of 1 two variables would be one
      const double correlation = all.correlation(static_cast<Index>(i), static_cast<Index>(j));
      pairs.push_back(fmt::format("[\"{}\",\"{}\",{:.4f}]", all.names[j], all.names[i], std::clamp(correlation, -most, most)));
    }
  }
  if (!pairs.empty()) file.set(fmt::format("spread.correlation=[{}]", fmt::join(pairs, ",")));
}

namespace {

// Returns the reasons to doubt a fit.
std::vector<std::string> doubts_of(const Fit& fit, const ManyEnds& all, const LeastSquaresEnd& best) {
  constexpr double far = 4;              // in standard deviations of the prior
  constexpr double largest_rms = 3;      // in errors of the data
  constexpr double as_good = 2;          // largest excess of the cost (half a sum of squares): two standard deviations
  constexpr double standard_errors = 4;  // least distance of another minimum, in standard errors
  std::vector<std::string> doubts;
  for (const FittedUnknown& u : fit.unknowns) {
    const double off = std::abs(u.value - u.prior_mean) / u.prior_deviation;
    const std::string device = u.device.empty() ? "" : " of " + u.device;
    if (off > far) doubts.push_back(fmt::format("{}{} is {:.3g} standard deviations away from its prior", u.name, device, off));
  }
  const double rms = std::sqrt(fit.chi_squared() / static_cast<double>(std::max<std::size_t>(1, fit.residuals.size())));
  if (rms > largest_rms) doubts.push_back(fmt::format("the fit does not describe the data: RMS residual {:.3g} sigma", rms));
  const auto differs = [&](const LeastSquaresEnd& end) {
    if (!end.converged || end.x.size() != best.x.size() || !(end.cost <= best.cost + as_good)) return false;
    for (std::size_t i = 0; i < std::min(fit.unknowns.size(), end.x.size()); ++i) {
      const FittedUnknown& u = fit.unknowns[i];
      if (std::abs(end.x[i] - best.x[i]) * u.scale > standard_errors * u.standard_error) return true;
    }
    return false;
  };
  if (std::ranges::any_of(all.ends, differs)) doubts.emplace_back("another minimum describes the data as well");
  return doubts;
}

// Returns the fit with the mean of the population in place of the values of single devices.
Fit of_population(Fit fit) {
  if (!fit.population) return fit;
  for (std::size_t i = 0; i < fit.population->names.size(); ++i) {
    const SpreadVariable& variable = fit.scene.scene.spread.variables[fit.population->variables[i]];
    const double unit = variable.is_factor && variable.keys.size() == 1 ? variable.keys.front().nominal : 1;
    for (FittedUnknown& u : fit.unknowns) {
      if (u.name == fit.population->names[i]) u.value = unit * fit.population->mean[i];
    }
  }
  return fit;
}

}  // namespace

std::string fitted_text(const Fit& fit, std::string_view text, const std::string& path, const std::string& device) {
  std::vector<SceneEdit> edits;
  for (const Fit::FittedKey& key : of_population(fit).keys(device))
    edits.push_back({.path = key.path, .element = key.element, .value = key.value, .remark = "fitted"});
  std::string fitted = edited_scene(text, path, edits);
  if (!fit.population) return fitted;
  SceneFile with_spread = SceneFile::parse(fitted, path, std::filesystem::path(path).parent_path());
  set_spread(with_spread, fit);
  return with_spread_of(fitted, path, with_spread);
}

namespace {

// The data in use, and the ends of the searches from several starts.
struct Stage {
  std::unique_ptr<const Setup> setup;
  ManyEnds all = {};
};

// True if two ends are one minimum: their distance is far below the errors from data and prior.
bool is_one_minimum(const LeastSquaresEnd& a, const LeastSquaresEnd& b) {
  constexpr double apart = 0.1;  // largest difference of an unknown in standard deviations, and of the cost
  double largest = 0;
  for (std::size_t i = 0; i < a.x.size(); ++i) largest = std::max(largest, std::abs(a.x[i] - b.x[i]));
  return largest <= apart && std::abs(a.cost - b.cost) <= apart;
}

Stage solved(Setup setup, const std::vector<std::vector<double>>& starts, const FitOptions& options, const Watch& watch) {
  Stage stage{.setup = std::make_unique<const Setup>(std::move(setup))};
  stage.all = solve_from([&] { return problem_of(*stage.setup); }, starts, options.jobs, is_one_minimum, watch);
  return stage;
}

// Returns distinct ends, the best first. With more rows of the traces another one of them may become the best.
std::vector<std::vector<double>> best_ends(const ManyEnds& all) {
  constexpr std::size_t most = 5;
  std::vector<const LeastSquaresEnd*> ranked;
  for (const LeastSquaresEnd& end : all.ends) {
    if (!end.x.empty()) ranked.push_back(&end);
  }
  std::ranges::stable_sort(ranked, {}, [](const LeastSquaresEnd* end) { return end->cost; });
  std::vector<const LeastSquaresEnd*> distinct;
  for (const LeastSquaresEnd* end : ranked) {
    if (distinct.size() < most &&
        std::ranges::none_of(distinct, [&](const LeastSquaresEnd* other) { return is_one_minimum(*end, *other); }))
      distinct.push_back(end);
  }
  std::vector<std::vector<double>> starts;
  for (const LeastSquaresEnd* end : distinct) starts.push_back(end->x);
  return starts;
}

// Returns the time of the first touch of the nominal design for each measurement; NaN for a measurement that is not a trace.
std::vector<double> nominal_touches(const Setup& setup, std::size_t measurements) {
  std::vector<double> touches(measurements, unset);
  for (const Datum& datum : setup.data) {
    const FitDevice& device = setup.devices[datum.device];
    if (std::isnan(datum.time) || !std::isnan(touches[datum.measurement]) || !device.nominal.model.has_contact()) continue;
    Instrument clock = device.instruments[datum.instrument];
    clock.what = Measurable::closing_time;
    clock.times.clear();
    DeviceReader reader(device.nominal);
    std::vector<double> middle;
    for (const std::size_t p : setup.of_device[datum.device]) middle.push_back(setup.parameters[p].mean);
    if (reader.move_to(middle)) touches[datum.measurement] = reader.read(clock, false).values[0];
  }
  return touches;
}

// The residuals of each trace in units of the errors, over all rows in use or over the newest ones.
struct TraceMisfit {
  std::vector<double> rms;  // root mean square for each measurement; infinite if the device cannot be read
  std::vector<double> rows;
};

TraceMisfit misfit(const Stage& stage, std::size_t measurements, const TraceWindows* newest = nullptr) {
  TraceMisfit of{.rms = std::vector<double>(measurements, 0), .rows = std::vector<double>(measurements, 0)};
  VectorXd values;
  const bool known = stage.all.found() && Model(*stage.setup).read(stage.all.ends[stage.all.best].x, values, nullptr);
  for (std::size_t i = 0; i < stage.setup->data.size(); ++i) {
    const Datum& datum = stage.setup->data[i];
    if (std::isnan(datum.time) || (newest != nullptr && !newest->is_new(datum.measurement, datum.time))) continue;
    const double off = (known ? values[static_cast<Index>(i)] - datum.measured : HUGE_VAL) / datum.error;
    of.rms[datum.measurement] += off * off;
    of.rows[datum.measurement] += 1;
  }
  for (std::size_t m = 0; m < measurements; ++m) of.rms[m] = of.rows[m] > 0 ? std::sqrt(of.rms[m] / of.rows[m]) : 0;
  return of;
}

// For each measurement, true if the scene describes the newest rows as well as those before, within chance.
std::vector<bool> described(const TraceMisfit& newest, const TraceMisfit& before) {
  constexpr double least = 0.15, deviations = 3;
  std::vector<bool> all;
  for (std::size_t m = 0; m < newest.rms.size(); ++m) {
    const double chance = std::max(least, deviations / std::sqrt(2 * std::max(1.0, newest.rows[m])));
    all.push_back(newest.rms[m] <= (1 + chance) * std::max(1.0, before.rms[m]));
  }
  return all;
}

// True if the data are linear in the unknowns within their standard errors. After some bounces they are not: the slopes of a
// chaotic motion are valid for tiny steps only, and give standard errors that are far too small.
bool is_linear(const Stage& stage) {
  constexpr double largest = 0.5;  // largest deviation from linear, in standard deviations
  const Setup& setup = *stage.setup;
  const LeastSquaresEnd& end = stage.all.ends[stage.all.best];
  Model model(setup);
  VectorXd values, moved;
  MatrixXd slopes;
  if (!model.read(end.x, values, &slopes)) return false;
  VectorXd weights(values.size());  // root of the weight of each residual, over its error
  for (Index i = 0; i < values.size(); ++i) {
    const Datum& datum = setup.data[static_cast<std::size_t>(i)];
    weights[i] = std::sqrt(loss_weight(setup.loss, (values[i] - datum.measured) / datum.error)) / datum.error;
  }
  const MatrixXd weighted = weights.asDiagonal() * slopes;
  const MatrixXd covariance = estimate(weighted.transpose() * weighted, setup.prior).covariance;
  if (!covariance.allFinite()) return true;
  const MatrixXd steps = cholesky_factor(covariance);
  for (Index k = 0; k < steps.cols(); ++k) {
    const VectorXd z = Eigen::Map<const VectorXd>(end.x.data(), steps.rows()) + steps.col(k);
    if (!model.read({z.data(), static_cast<std::size_t>(z.size())}, moved, nullptr)) return false;
    if (weights.cwiseProduct(moved - values - slopes * steps.col(k)).norm() > largest) return false;
  }
  return true;
}

}  // namespace

Fit fit(const SceneFile& given, const Bench& bench, const FitOptions& options, const Watch& watch) {
  require(options.starts >= 1 && options.starts <= most_starts,
          [&] { return fmt::format("{} starts: must be from 1 to {}", options.starts, most_starts); });
  require(!bench.measurements.empty(), [&] { return fmt::format("{}: a fit needs at least one measurement", bench.name); });
  SceneFile file = given;
  const bool assumed = options.unknowns.empty() && assume_spread(file);
  const std::size_t measurements = bench.measurements.size();
  const Setup whole = with_data(setup_of(file, bench, options, watch), bench);
  TraceWindows windows(bench, nominal_touches(whole, measurements));
  Stage stage = solved(with_data(whole, windows.inside()), starts_of(whole, options), options, watch);
  Fit found{.scene = stage.setup->devices.front().nominal, .spread_assumed = assumed};
  found.loss = options.loss;
  found.seed = options.seed;
  for (const FitDevice& device : stage.setup->devices) found.devices.push_back(device.name);
  found.starts = stage.all.ends.size();
  found.minima = stage.all.minima;
  for (const LeastSquaresEnd& end : stage.all.ends) {
    found.converged += end.converged;
    found.costs.push_back(end.x.empty() ? unset : end.cost);
  }
  found.found = stage.all.found();
  if (!found.found) return found;
  const TraceMisfit before_touch = misfit(stage, measurements);
  while (windows.grow()) {
    Stage next = solved(with_data(whole, windows.inside()), best_ends(stage.all), options, watch);
    std::vector<bool> goes_on = described(misfit(next, measurements, &windows), before_touch);
    if (!next.all.found() || !is_linear(next)) goes_on.assign(measurements, false);
    if (windows.keep(goes_on)) stage = std::move(next);
  }
  for (std::size_t m = 0; m < measurements; ++m) {
    const BenchMeasurement& one = bench.measurements[m];
    if (!one.times.empty())
      found.traces.push_back({.measurement = m,
                              .what = std::ranges::find(measurables, one.quantity, &MeasurableRow::name)->value,
                              .until = windows.end(m),
                              .recorded = one.times.back()});
  }
  EndOfFit end(*stage.setup, found);
  end.add(stage.all.ends[stage.all.best]);
  end.require_all_seen(bench.name);
  end.add_population();
  if (options.suggest) end.add_next(watch);
  found.doubts = doubts_of(found, stage.all, stage.all.ends[stage.all.best]);
  if (found.doubts.empty()) return found;
  for (FittedUnknown& u : found.unknowns) u.standard_error = u.low = u.high = unset;
  return found;
}

}  // namespace softland
