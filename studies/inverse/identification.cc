#include "studies/inverse/identification.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <mutex>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "base/decompositions.h"
#include "base/executor.h"
#include "base/random.h"
#include "base/require.h"
#include "config/assumed_spread.h"
#include "model/constants.h"
#include "optimizers/problem.h"
#include "sampling/confidence.h"
#include "sampling/statistics.h"
#include "studies/closing/plain_step.h"
#include "studies/devices/instruments.h"
#include "studies/search/robust_cost.h"

namespace softland {
namespace {

constexpr double widest_change = 0.25;  // largest change of the logarithm of a factor (of voltages or times) in a search
// First step of the search for the best factors (of voltages or times), in the logarithm of a factor.
constexpr double first_step = 0.005;
constexpr long closings_of_a_factor = 40;
constexpr double probability = 0.95;

constexpr double unknown = Metrics::unset;

// Runs `task` for every device, and reports the progress.
template <class Task>
void over_devices(std::size_t devices, int jobs, const char* what, const Progress& progress, const Task& task) {
  std::atomic<std::size_t> done = 0;
  std::mutex telling;
  run_tasks(
      devices, jobs,
      [&](std::size_t k) {
        if (progress.stopped()) return;
        task(k);
        const std::scoped_lock lock(telling);
        progress.tell(what, static_cast<double>(++done) / static_cast<double>(devices));
      },
      progress.stop);
}

// A figure to measure, its measurement error, and the function that reads it.
struct FigureMeter {
  std::string name, unit;
  double error;
  std::function<double(const Switch&)> read;
};

std::vector<FigureMeter> instruments(const PreparedScene& nominal, const PullInMeter& meter,
                                     const IdentificationOptions& options) {
  const std::size_t electrode = meter.electrode();
  const std::vector<double> bias = bias_of(nominal.scene, electrode);
  std::vector<FigureMeter> all{
      {"Vdp", "V", options.pull_in_error, [&meter](const Switch& m) { return meter.exact(m).volts * meter.pull_in(); }}};
  const double duration = periods_to_close / meter.frequency();
  const auto add = [&](std::string name, double error, const Instrument& instrument) {
    all.push_back({std::move(name), std::string(row_of(instrument.what).unit), error,
                   [=](const Switch& m) { return read(instrument, m, bias, duration); }});
  };
  add("Vsp", options.static_pull_in_error, {.what = Measurable::pull_in, .drive = electrode});
  add("release", options.release_error, {.what = Measurable::release, .drive = electrode});
  add("frequency", options.frequency_error, {.what = Measurable::frequency, .drive = electrode});
  for (const double step : options.steps)
    add(fmt::format("time at {:g} Vdp", step), options.time_error,
        {.what = Measurable::closing_time, .drive = electrode, .level = step * meter.pull_in()});
  all.push_back({std::string(measured_piezo), "1/V", options.piezo_error, PullInMeter::piezo_unit});
  return all;
}

// False for a figure that is equal for all devices, or that does not exist on the nominal device: it tells nothing about a
// device.
bool tells(const MeasurableFigure& figure) {
  if (!(figure.nominal > 0)) return false;
  return std::any_of(figure.values.begin(), figure.values.end(),
                     [&](double v) { return std::isfinite(v) && std::abs(v / figure.nominal - 1) > 1e-9; });
}

std::vector<MeasurableFigure> measure(const std::vector<FigureMeter>& all, const Switch& nominal, const RobustCost& cost,
                                      int jobs, const Progress& progress) {
  std::vector<MeasurableFigure> figures;
  for (const FigureMeter& one : all) {
    figures.push_back({.name = one.name,
                       .unit = one.unit,
                       .nominal = one.read(nominal),
                       .error = one.error,
                       .values = std::vector<double>(cost.devices(), unknown)});
  }
  over_devices(cost.devices(), jobs, "figures of the devices", progress, [&](std::size_t k) {
    const SampledDevice& device = cost.device(k);
    for (std::size_t f = 0; f < figures.size() && device.model && !progress.stopped(); ++f)
      figures[f].values[k] = all[f].read(*device.model);
  });
  progress.throw_if_stopped();
  std::erase_if(figures, [](const MeasurableFigure& f) { return !tells(f); });
  return figures;
}

// A factor of the waveform for a device: for voltages, times or the piezo's voltages.
using Factor = double DeviceUnits::*;
constexpr std::array all_factors{&DeviceUnits::volts, &DeviceUnits::time, &DeviceUnits::piezo};
// Returns the list of the waveform's factors; the factor of a piezo is the last, and only if the piezo is driven.
std::span<const Factor> factors_of(bool drives_piezo) { return std::span(all_factors).first(drives_piezo ? 3 : 2); }

constexpr DeviceUnits no_factors{.volts = unknown, .time = unknown};

// Searches the factors of the waveform (of voltages and times) that are best for device k. The search starts from `own`, the
// factors that its pull-in voltage, period and piezo give.
DeviceUnits best_factors(const RobustCost& cost, const std::vector<Waveform>& recipe, std::size_t k, const DeviceUnits& own,
                         std::span<const Factor> factors) {
  const auto units_at = [&](std::span<const double> x) {
    DeviceUnits units;
    for (std::size_t i = 0; i < factors.size(); ++i) units.*factors[i] = std::exp(x[i]);
    return units;
  };
  std::vector<double> start;
  for (const Factor factor : factors) start.push_back(std::log(own.*factor));
  double least = std::numeric_limits<double>::infinity();
  Problem problem{.variables = {{.name = "volts"}, {.name = "time"}, {.name = "piezo"}},
                  .objective =
                      [&](std::span<const double> x) {
                        const double score = std::min(cost.score(cost.close(recipe, k, units_at(x))), RobustCost::not_closed);
                        least = std::min(least, score);
                        double changes = 0;
                        for (const double change : x) changes += change * change;
                        return score + changes;
                      },
                  .starts = {start}};
  problem.variables.resize(factors.size());
  for (Variable& variable : problem.variables) variable.lower = -widest_change, variable.upper = widest_change;
  const OptimizerResult found = minimize(problem, {.optimizer = "nelder-mead",
                                                   .max_evaluations = closings_of_a_factor * static_cast<long>(factors.size()),
                                                   .step = first_step / (2 * widest_change)});
  return found.x.empty() || least >= RobustCost::not_closed ? no_factors : units_at(found.x);
}

// Returns the regressors 1, ln x_1, ... of the measured figures x_i, one row per device; NaN for a figure that is missing.
Eigen::MatrixXd regressors(const std::vector<MeasurableFigure>& figures, const std::vector<std::size_t>& used,
                           std::uint64_t seed) {
  const auto devices = static_cast<Eigen::Index>(figures.empty() ? 0 : figures.front().values.size());
  Eigen::MatrixXd x = Eigen::MatrixXd::Ones(devices, static_cast<Eigen::Index>(used.size()) + 1);
  for (std::size_t i = 0; i < used.size(); ++i) {
    const MeasurableFigure& f = figures[used[i]];
    for (Eigen::Index k = 0; k < devices; ++k) {
      constexpr std::uint64_t room = 64;  // number of random numbers reserved for the measurement errors of a device
      const double error = f.error * random_normal(seed, Stream::measurement, static_cast<std::uint64_t>(k) * room + used[i]);
      x(k, static_cast<Eigen::Index>(i) + 1) = std::log(f.values[static_cast<std::size_t>(k)] / f.nominal * (1 + error));
    }
  }
  return x;
}

// Predicts the factors of the waveform for every device. The prediction is fitted to the half of the devices that does not
// contain the device.
std::vector<DeviceUnits> predicted_factors(const Eigen::MatrixXd& x, const std::vector<DeviceUnits>& best,
                                           std::span<const Factor> factors) {
  const Eigen::Index devices = x.rows(), middle = devices / 2, count = static_cast<Eigen::Index>(factors.size());
  Eigen::MatrixXd predicted = Eigen::MatrixXd::Constant(devices, count, unknown);
  for (const bool first : {true, false}) {
    const Eigen::Index begin = first ? 0 : middle, end = first ? middle : devices;
    std::vector<Eigen::Index> fitted;
    for (Eigen::Index k = 0; k < devices; ++k) {
      const bool inside = k >= begin && k < end;
      if (!inside && x.row(k).allFinite() && std::isfinite(best[static_cast<std::size_t>(k)].volts)) fitted.push_back(k);
    }
    // Skip this half: too few devices are left for fitting the prediction.
    if (static_cast<Eigen::Index>(fitted.size()) < x.cols() + 2) continue;
    Eigen::MatrixXd logarithms(fitted.size(), count);
    for (std::size_t i = 0; i < fitted.size(); ++i) {
      const DeviceUnits& units = best[static_cast<std::size_t>(fitted[i])];
      for (Eigen::Index f = 0; f < count; ++f)
        logarithms(static_cast<Eigen::Index>(i), f) = std::log(units.*factors[static_cast<std::size_t>(f)]);
    }
    const Eigen::MatrixXd rows = x(fitted, Eigen::all);
    const Eigen::MatrixXd slopes = least_squares(rows, logarithms);
    predicted.middleRows(begin, end - begin) = x.middleRows(begin, end - begin) * slopes;
  }
  std::vector<DeviceUnits> units(best.size());
  for (Eigen::Index k = 0; k < devices; ++k) {
    for (Eigen::Index f = 0; f < count; ++f)
      units[static_cast<std::size_t>(k)].*factors[static_cast<std::size_t>(f)] = std::exp(predicted(k, f));
  }
  return units;
}

// Returns the root mean square error of the logarithm of a predicted factor, and the square of this error divided by the
// variance of the best factor's logarithm.
std::pair<double, double> misses(const std::vector<DeviceUnits>& predicted, const std::vector<DeviceUnits>& best, Factor factor) {
  std::vector<double> wanted;
  double square = 0;
  for (std::size_t k = 0; k < predicted.size(); ++k) {
    const double miss = std::log(predicted[k].*factor / best[k].*factor);
    if (!std::isfinite(miss)) continue;
    wanted.push_back(std::log(best[k].*factor));
    square += miss * miss;
  }
  if (wanted.size() < 2) return {unknown, unknown};
  const double mean_square = square / static_cast<double>(wanted.size()), deviation = sample_standard_deviation(wanted);
  return {std::sqrt(mean_square), deviation > 0 ? mean_square / (deviation * deviation) : unknown};
}

// A prediction, and the factors of the waveform that it gives each device.
struct GivenUnits {
  Prediction prediction;
  std::vector<DeviceUnits> units;
};

GivenUnits fitted(const IdentificationStudy& study, std::uint64_t seed, std::string name, std::vector<std::size_t> figures) {
  GivenUnits given_units{.prediction = {.name = std::move(name), .figures = std::move(figures)}, .units = {}};
  Prediction& p = given_units.prediction;
  given_units.units = predicted_factors(regressors(study.figures, p.figures, seed), study.best, factors_of(study.drives_piezo));
  std::tie(p.volts_miss, p.volts_unexplained) = misses(given_units.units, study.best, &DeviceUnits::volts);
  std::tie(p.time_miss, p.time_unexplained) = misses(given_units.units, study.best, &DeviceUnits::time);
  if (study.drives_piezo)
    std::tie(p.piezo_miss, p.piezo_unexplained) = misses(given_units.units, study.best, &DeviceUnits::piezo);
  return given_units;
}

// Returns predictions for comparison: no factors, the best factors, factors fitted to all figures, and factors computed
// directly from Vdp, frequency and piezo (the device's own units).
std::vector<GivenUnits> reference_predictions(const IdentificationStudy& study, std::uint64_t seed) {
  std::vector<GivenUnits> all;
  const auto given = [&](std::string name, std::vector<DeviceUnits> units) {
    all.push_back({.prediction = {.name = std::move(name), .figures = {}}, .units = std::move(units)});
  };
  const auto number_of = [&](std::string_view name) {
    const auto found = std::find_if(study.figures.begin(), study.figures.end(), [&](const auto& f) { return f.name == name; });
    return static_cast<std::size_t>(found - study.figures.begin());
  };
  const std::size_t count = study.figures.size();
  given("nothing", std::vector<DeviceUnits>(study.devices));
  given("the best factors themselves", study.best);
  std::vector<std::size_t> every(count);
  std::iota(every.begin(), every.end(), std::size_t{0});
  all.push_back(fitted(study, seed, "all of them", every));
  const std::size_t v = number_of(measured_pull_in), f = number_of(measured_frequency), p = number_of(measured_piezo);
  if (v == count || f == count) return all;
  const auto in_own_units = [&](const std::string& name, const std::vector<std::size_t>& measured) {
    const Eigen::MatrixXd x = regressors(study.figures, measured, seed);
    std::vector<DeviceUnits> own(study.devices);
    for (Eigen::Index k = 0; k < x.rows(); ++k) {
      DeviceUnits& units = own[static_cast<std::size_t>(k)];
      units = {.volts = std::exp(x(k, 1)), .time = std::exp(-x(k, 2))};
      if (x.cols() > 3) units.piezo = std::exp(-x(k, 3));
    }
    given("own units: " + name, std::move(own));
  };
  in_own_units("Vdp, frequency", {v, f});
  if (study.drives_piezo && p < count) in_own_units("Vdp, frequency, piezo", {v, f, p});
  return all;
}

// Returns the predictions of the waveform's factors from every measurable figure, and from every pair of figures.
std::vector<GivenUnits> predictions_by_figures(const IdentificationStudy& study, std::uint64_t seed) {
  std::vector<GivenUnits> all;
  const std::vector<MeasurableFigure>& figures = study.figures;
  for (std::size_t a = 0; a < figures.size(); ++a) {
    all.push_back(fitted(study, seed, figures[a].name, {a}));
    for (std::size_t b = a + 1; b < figures.size(); ++b)
      all.push_back(fitted(study, seed, figures[a].name + " and " + figures[b].name, {a, b}));
  }
  return all;
}

void judge_prediction(GivenUnits& given_units, const RobustCost& cost, const std::vector<Waveform>& recipe, int jobs,
                      const Progress& progress) {
  std::vector<DeviceOutcome> outcomes(cost.devices());
  run_tasks(outcomes.size(), jobs, [&](std::size_t k) {
    if (progress.stopped()) return;
    const DeviceUnits& units = given_units.units[k];
    if (units.are_known() && std::isfinite(units.time)) {
      outcomes[k] = cost.close(recipe, k, units);
    } else {
      outcomes[k].failure = "its factors cannot be told";
    }
  });
  if (progress.stopped()) return;
  std::vector<double> scores, speeds, heights;
  std::size_t bounce_free = 0;
  for (const DeviceOutcome& o : outcomes) {
    scores.push_back(std::min(cost.score(o), RobustCost::not_closed));
    speeds.push_back(o.of(figure_of(&Metrics::largest_impact_velocity)));
    heights.push_back(o.of(figure_of(&Metrics::major_bounce_height)));
    bounce_free += is_bounce_free(o);
  }
  Prediction& p = given_units.prediction;
  p.is_judged = true;
  p.score = sample_quantile(scores, probability);
  p.bounce_free = yield_of(bounce_free, outcomes.size());
  p.impact_speed = estimated_quantile(speeds, probability);
  p.rebound_height = estimated_quantile(heights, probability);
}

}  // namespace

IdentificationStudy identify(SceneFile file, const IdentificationOptions& options, const Progress& progress) {
  require(options.samples >= fewest_measured && options.samples <= most_measured, [&] {
    return fmt::format("{} devices: there must be from {} to {}", options.samples, fewest_measured, most_measured);
  });
  const bool spread_assumed = assume_spread(file);
  const Scene scene = read_scene(file);
  require_open_start(scene, "calibrate closes every device");
  const Device& device = scene.device;
  require(device.has_contact(), "calibrate needs a [contact] section: without contact there is nothing to land on");
  require(has_pulling_electrode(device), "calibrate needs an electrode that pulls in: its voltage is what devices differ in");
  const SearchSetting setting = search_setting(file, Target::bounce, Actuator::electrostatic, "pulse", progress);
  const PreparedScene& nominal = setting.given;
  const std::vector<Waveform> recipe = nominal.waveforms();
  require(!same_drives(nominal.commanded(recipe), setting.baseline_scene.signals()), [&] {
    return fmt::format(
        "{}: its drive is the plain step, which lands no device softly: there is no waveform to calibrate. Give what "
        "softland optimize has found",
        nominal.scene.file.name());
  });
  const PullInMeter meter(nominal, {.pull_in = true});
  const RobustAim aim;
  const Ensemble ensemble(nominal, options.samples, options.seed);
  const RobustCost cost(setting, aim, build_all(ensemble, {}, options.seed, options.jobs, progress));

  IdentificationStudy study{.devices = cost.devices(), .spread_assumed = spread_assumed};
  study.drives_piezo = nominal.model.has_piezo() && nominal.commanded(recipe).back().peak() > 0;
  study.figures = measure(instruments(nominal, meter, options), nominal.model, cost, options.jobs, progress);
  study.best.assign(study.devices, no_factors);
  over_devices(study.devices, options.jobs, "best factors of the devices", progress, [&](std::size_t k) {
    if (!cost.device(k).model) return;
    DeviceUnits own = meter.exact(*cost.device(k).model);
    if (!std::isfinite(own.volts)) own.volts = 1;
    study.best[k] = best_factors(cost, recipe, k, own, factors_of(study.drives_piezo));
  });
  progress.throw_if_stopped();

  std::vector<GivenUnits> all = reference_predictions(study, options.seed);
  const std::size_t references = all.size();
  for (GivenUnits& given_units : predictions_by_figures(study, options.seed)) all.push_back(std::move(given_units));
  for (std::size_t i = 0; i < all.size() && !progress.stopped(); ++i) {
    judge_prediction(all[i], cost, recipe, options.jobs, progress);
    progress.tell("evaluating sets of measurements", static_cast<double>(i + 1) / static_cast<double>(all.size()));
  }
  study.interrupted = progress.stopped();
  for (std::size_t i = 0; i < all.size(); ++i)
    (i < references ? study.references : study.predictions).push_back(std::move(all[i].prediction));
  std::stable_sort(study.predictions.begin(), study.predictions.end(), [](const Prediction& a, const Prediction& b) {
    return a.is_judged != b.is_judged ? a.is_judged : a.is_judged && a.score < b.score;
  });
  return study;
}

}  // namespace softland
