#include "studies/inverse/tuning_model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/decompositions.h"
#include "base/engineering.h"
#include "base/executor.h"
#include "base/require.h"
#include "base/standard_normal.h"
#include "config/assumed_spread.h"
#include "objectives/rebounds.h"
#include "studies/closing/auto_settings.h"
#include "studies/closing/plain_step.h"
#include "studies/devices/stable_approach.h"
#include "studies/inverse/capacitance_edges.h"
#include "studies/search/search_setting.h"

namespace softland {
namespace {

constexpr double belief_accuracy = 1e-4;  // relative accuracy of the closings that are simulated for the belief about a device
constexpr double viscosity_deviation = 0.05, contact_deviation = 0.1;
// Error of the model in time, as a share of the closing time of the plain step.
constexpr double delay_share = 0.003;

// Simulated times as shares of the closing time of the plain step: after first contact, without contact, and after the last
// breakpoint of the waveforms.
constexpr double after_touch = 1.8, longest_wait = 7.4, tail = 0.75;

bool varies(const DeviceSpread& spread, const std::string& path) {
  return std::ranges::any_of(spread.variables, [&](const SpreadVariable& variable) {
    return std::ranges::any_of(variable.keys, [&](const VariedKey& key) { return key.path == path; });
  });
}

bool varies_any(const DeviceSpread& spread, const std::vector<std::string>& paths) {
  return std::ranges::any_of(paths, [&](const std::string& path) { return varies(spread, path); });
}

void vary(SceneFile& file, const std::string& name, const std::vector<std::string>& keys, const char* kind, double deviation) {
  file.set(
      fmt::format("spread.\"{}\"={{keys=[\"{}\"],distribution=\"{}\",cov={}}}", name, fmt::join(keys, "\",\""), kind, deviation));
}

std::vector<std::string> shaped_drives_of(const PreparedScene& prepared, Actuator actuator) {
  std::vector<std::string> names;
  for (const auto& [name, waveform] : plain_step(prepared, actuator)) {
    if (prepared.drives.at(name).limits) names.push_back(name);
  }
  return names;
}

// Returns the keys with the name `key` in the sections of all near-side contacts that make the connection, if the scene has
// them: "contact.KEY", or "contact.NAME.KEY" for several contacts.
std::vector<std::string> contact_keys(const SceneFile& file, const Device& device, std::string_view key) {
  std::vector<std::string> keys;
  for (const Contact& contact : device.contacts) {
    const std::string own = fmt::format("{}.{}", path_of(contact), key);
    if (contact.connects && contact.side == Side::near && file.written(own)) keys.push_back(own);
  }
  return keys;
}

// Returns the keys of the contact gaps in the scene; none if the contact is the face of a dielectric.
std::vector<std::string> contact_gaps(const PreparedScene& prepared) {
  if (prepared.scene.file.written("gap.contact")) return {"gap.contact"};
  return contact_keys(prepared.scene.file, prepared.scene.device, "gap");
}

// Returns the name of the quantity in [spread] that varies these contact gaps.
std::string gap_name(const std::vector<std::string>& gaps) { return gaps.size() == 1 ? gaps.front() : "contact gaps"; }

// Returns the scene in volts, with every default written out, and with the further quantities that a belief varies.
SceneFile with_nuisances(const PreparedScene& prepared, const TunerOptions& options) {
  SceneFile file = prepared.resolved();
  const DeviceSpread& spread = prepared.scene.spread;
  for (const std::string& drive : shaped_drives_of(prepared, options.actuator)) {
    const std::string key = fmt::format("driver.{}.gain", drive);
    if (!varies(spread, key) && options.laboratory.gain_error > 0)
      vary(file, key, {key}, "normal", options.laboratory.gain_error);
  }
  if (file.written("gas.viscosity") && !varies(spread, "gas.viscosity"))
    vary(file, "gas.viscosity", {"gas.viscosity"}, "lognormal", viscosity_deviation);
  std::vector<std::string> stiffness;
  for (const char* name : {"stiffness", "unloading_stiffness", "effective_modulus"}) {
    for (const std::string& key : contact_keys(file, prepared.scene.device, name)) {
      if (!varies(spread, key)) stiffness.push_back(key);
    }
  }
  if (!stiffness.empty()) vary(file, "contact stiffness", stiffness, "lognormal", contact_deviation);
  const std::vector<std::string> gaps = contact_gaps(prepared);
  if (!gaps.empty() && !varies_any(spread, gaps)) vary(file, gap_name(gaps), gaps, "normal", TuningModel::gap_ratio_deviation);
  file.assign("simulate.accuracy", belief_accuracy);
  return file;
}

// Records the closing of one device, one of the SIMD lanes that are simulated together.
class LaneClosing final : public LandingObserver {
 public:
  void touch(const Touch& touch) override {
    if (std::isnan(closing.touch)) closing.touch = touch.begin, closing.speed = closing.fastest = touch.impact_velocity;
    closing.fastest = std::max(closing.fastest, touch.impact_velocity);
  }
  void rebound(double begin, double end, double height) override {
    closing.openings.push_back({.begin = begin, .end = end});
    closing.highest = std::max(closing.highest, height);
  }
  PredictedClosing closing = {};
};

// Records a closing that is simulated alone (not in SIMD lanes), and its capacitance if an instrument records it.
class SingleClosing final : public ClosingObserver {
 public:
  SingleClosing(const Switch& model, double threshold, double speed_per_rate)
      : finder_(model.contact_gap()), speed_per_rate_(speed_per_rate) {
    if (!std::isnan(threshold)) edges_.emplace(model, searched_drive(model.device()), threshold);
  }
  [[nodiscard]] bool follows_motion() const override { return edges_.has_value(); }
  void step(const Knot& begin, const Knot& end, const ContactState& contact) override { edges_->step(begin, end, contact); }
  void knot(const TrajectoryPoint& point) override {
    finder_.knot(point, [&](const Rebound& rebound) { add(rebound, rebound.end); });
  }
  void touch(const Touch& touch) override { closing.fastest = std::fmax(closing.fastest, touch.impact_velocity); }
  PredictedClosing ended(const Trajectory& run) {
    closing.followed = finder_.usable() && run.status == Status::done;
    closing.touch = finder_.first_touch().time, closing.speed = finder_.first_touch().velocity;
    if (const auto& last = finder_.under_way()) add(*last, std::numeric_limits<double>::infinity());
    if (edges_) closing.by_capacitance = seen(edges_->rises());
    return std::move(closing);
  }
  PredictedClosing closing = {};

 private:
  void add(const Rebound& rebound, double end) {
    closing.openings.push_back({.begin = rebound.begin, .end = end});
    closing.highest = std::max(closing.highest, rebound.height);
  }
  [[nodiscard]] SeenClosing<std::vector<ContactOpening>> seen(const std::vector<CapacitanceRise>& rises) const {
    SeenClosing<std::vector<ContactOpening>> own;
    if (rises.empty()) return own;
    own.touch = rises.front().begin;
    own.speed = speed_per_rate_ * rises.front().rate;
    for (std::size_t k = 0; k < rises.size(); ++k) {
      if (std::isnan(rises[k].end)) break;
      own.openings.push_back(
          {.begin = rises[k].end, .end = k + 1 < rises.size() ? rises[k + 1].begin : std::numeric_limits<double>::infinity()});
    }
    return own;
  }
  ReboundFinder finder_;
  double speed_per_rate_;  // ratio of the impact velocity to the time derivative of the capacitance [m/F]
  std::optional<CapacitanceEdges> edges_;
};

}  // namespace

// Gives the contact gaps a variable of their own if they share a variable with other gaps. The two variables are correlated
// normal factors: the contact gaps vary with the other gaps, with an additional deviation gap_ratio_deviation.
void TuningModel::loosen_contact_gap(DeviceSpread& spread, const std::vector<std::string>& gaps) {
  for (std::size_t i = 0; i < spread.variables.size(); ++i) {
    SpreadVariable& shared = spread.variables[i];
    const auto is_of_contact = [&](const VariedKey& key) { return std::ranges::find(gaps, key.path) != gaps.end(); };
    const auto count = std::ranges::count_if(shared.keys, is_of_contact);
    const auto* normal = std::get_if<Normal>(&shared.distribution.parameters());
    const Truncation& truncation = shared.distribution.truncation();
    const bool is_free = !(truncation.low > -std::numeric_limits<double>::infinity()) &&
                         !(truncation.high < std::numeric_limits<double>::infinity());
    if (count == 0 || std::cmp_equal(count, shared.keys.size()) || !shared.is_factor || normal == nullptr || !is_free) continue;
    const double own = std::hypot(normal->standard_deviation, gap_ratio_deviation);
    const double correlation = normal->standard_deviation / own;
    SpreadVariable contact{.name = gap_name(gaps),
                           .keys = {},
                           .distribution = Distribution(Normal{.mean = normal->mean, .standard_deviation = own})};
    std::ranges::copy_if(shared.keys, std::back_inserter(contact.keys), is_of_contact);
    std::erase_if(shared.keys, is_of_contact);
    const Eigen::Index n = spread.correlation.rows();
    Eigen::MatrixXd all = Eigen::MatrixXd::Identity(n + 1, n + 1);
    all.topLeftCorner(n, n) = spread.correlation;
    all.row(n).head(n) = correlation * spread.correlation.row(static_cast<Eigen::Index>(i));
    all.col(n).head(n) = all.row(n).head(n).transpose();
    spread.correlation = all;
    gap_ratio_ = {.contact = spread.variables.size(), .shared = i};
    spread.variables.push_back(std::move(contact));
    return;
  }
}

PreparedScene TuningModel::prepared(const SceneFile& given, const Progress& progress) {
  SceneFile file = given;
  spread_is_assumed_ = assume_spread(file);
  const PreparedScene chosen = prepare_and_choose(file, true, progress);
  require_open_start(chosen.scene, "tune closes the device");
  require(chosen.model.has_contact(),
          [&] { return fmt::format("{}: needs a [contact] section: a record has the states of the contact", given.name()); });
  PreparedScene p = prepare(with_nuisances(chosen, options_), true, progress);
  DeviceSpread& spread = p.scene.spread;
  for (std::size_t i = spread.variables.size(); i-- > 0;) {
    if (spread.variables[i].is_drawn_per_edge) spread.leave_out(i);
  }
  const std::vector<std::string> gaps = contact_gaps(chosen);
  const auto contact = std::ranges::find(spread.variables, gap_name(gaps), &SpreadVariable::name);
  if (contact != spread.variables.end() && !varies_any(chosen.scene.spread, gaps))
    gap_ratio_ = {.contact = static_cast<std::size_t>(contact - spread.variables.begin()), .shared = {}};
  loosen_contact_gap(spread, gaps);
  spread.correlate(spread.correlation);
  return p;
}

TuningModel::TuningModel(const SceneFile& file, const TunerOptions& options, const Progress& progress)
    : options_(options), nominal_(prepared(file, progress)) {
  const DeviceSpread& spread = nominal_.scene.spread;
  for (const SpreadVariable& variable : spread.variables)
    nuisances_.push_back(variable.name == "gas.viscosity" || variable.name == "contact stiffness");
  nuisances_.push_back(true);
  ensemble_ = std::make_unique<const Ensemble>(nominal_, 1);
  drives_ = std::make_unique<const DeviceDrives>(nominal_);
  const std::vector<Signal> signals = nominal_.applied(nominal_.waveforms(plain_step(nominal_, options.actuator)));
  const double longest = periods_to_close * 2 * std::numbers::pi / nominal_.model.basis().angular_frequencies()[0];
  const double closing_time =
      first_closing(nominal_.model, signals, {.duration = longest, .tolerance = nominal_.tolerance, .stop = progress.stop});
  progress.throw_if_stopped();
  require(std::isfinite(closing_time),
          [&] { return fmt::format("{}: the hold levels must close the switch, but do not", file.name()); });
  scales_ = {.closing_time = closing_time,
             .gap = nominal_.scene.device.contact_gap(),
             .rebound = nominal_.scene.metrics.significant_rebound};
  if (stable_approach(nominal_, options.actuator)) {
    const Metrics step = metrics(simulate_closing(
        nominal_.model, signals, {.duration = nominal_.duration, .tolerance = nominal_.tolerance, .stop = progress.stop}));
    step_stays_from_ = std::isfinite(step.permanent_contact_time) ? step.permanent_contact_time : scales_.closing_time;
  }
  if (options.touch) scales_.latest_touch = beside_step(*options.touch, scales_.closing_time).limit;
  // Largest permitted error of a recorded contact time, as a share of the closing time of the plain step.
  constexpr double coarsest = 0.1;
  require(options.laboratory.edge_error < coarsest * scales_.closing_time, [&] {
    return fmt::format("the error of edges, {}, must be below a tenth of the closing time of the plain step, {}",
                       engineering(options.laboratory.edge_error, "s", 3), engineering(scales_.closing_time, "s", 3));
  });
  if (options.laboratory.sees_capacitance()) scales_.rise = capacitance_rise(nominal_, options.laboratory.capacitance);
  find_units(progress);
}

void TuningModel::choose(Approach approach) {
  require(approach == Approach::fast || has_stable_path(),
          "no drive that is shaped can carry the switch to its contact through stable equilibria");
  approach_ = approach;
  scales_.permanent_contact = approach == Approach::quasi_static ? step_stays_from_ : Metrics::unset;
}

double TuningModel::delay_deviation() const {
  return std::hypot(delay_share * scales_.closing_time, options_.laboratory.trigger_delay);
}
double TuningModel::hold_time() const { return (longest_wait + after_touch) * scales_.closing_time; }

void TuningModel::begin_with(const NormalBelief& prior) {
  prior_ = prior;
  prior_factor_ = cholesky_factor(prior.covariance);
}

NormalBelief TuningModel::in_spread(const NormalBelief& belief) const {
  return prior_ ? belief.mapped(prior_->mean, prior_factor_) : belief;
}

std::vector<double> TuningModel::values(const Eigen::VectorXd& point) const {
  constexpr double furthest = 8;  // limit of z in standard deviations, for finite values of the varied quantities
  const Eigen::VectorXd z = spread_point(point);
  std::vector<double> u(static_cast<std::size_t>(size() - 1));
  for (std::size_t k = 0; k < u.size(); ++k)
    u[k] = standard_normal_cdf(std::clamp(z[static_cast<Eigen::Index>(k)], -furthest, furthest));
  nominal_.scene.spread.to_values(u);
  return u;
}

std::optional<double> TuningModel::gap_ratio(std::span<const double> values) const {
  if (!gap_ratio_) return {};
  const double contact = values[gap_ratio_->contact];
  return gap_ratio_->shared ? contact / values[*gap_ratio_->shared] : contact;
}

std::optional<double> TuningModel::gap_ratio_coordinate(const Eigen::VectorXd& z) const {
  if (!gap_ratio_) return {};
  return spread_point(z)[static_cast<Eigen::Index>(gap_ratio_->contact)];
}

Eigen::VectorXd TuningModel::with_gap_ratio_of_scene(const Eigen::VectorXd& z) const {
  const std::optional<double> off = gap_ratio_coordinate(z);
  if (!off) return z;
  const auto k = static_cast<Eigen::Index>(gap_ratio_->contact);
  const Eigen::VectorXd slope = prior_ ? Eigen::VectorXd(prior_factor_.row(k)) : Eigen::VectorXd::Unit(size(), k);
  return z - *off / slope.squaredNorm() * slope;
}

std::vector<Particle> TuningModel::devices(std::span<const Eigen::VectorXd> points, const Progress& progress) const {
  constexpr std::size_t together = 16;
  std::vector<Particle> all(points.size());
  run_tasks((points.size() + together - 1) / together, options_.jobs,
            [&](std::size_t task) {
              DeviceBuilder builder(*ensemble_);
              for (std::size_t k = task * together; k < std::min(points.size(), (task + 1) * together); ++k)
                all[k] = {.z = points[k], .sampled = builder.device(values(points[k])), .delay = delay(points[k])};
            },
            progress.stop);
  progress.throw_if_stopped();
  return all;
}

std::vector<Signal> TuningModel::signals(const PredictedShot& shot) const {
  std::vector<Signal> own = drives_->signals(*shot.waveforms, {}, shot.device->sampled.values);
  if (shot.gain != 1) {
    for (Signal& signal : own) signal = scaled(signal, shot.gain);
  }
  return own;
}

std::vector<PredictedClosing> TuningModel::close(std::span<const PredictedShot> shots, const Progress& progress) const {
  // Choose the number of devices of a task so that all threads are busy and SIMD lanes are filled.
  constexpr std::size_t lanes = 8, most_in_lanes = 64, most_by_itself = 4;
  const auto jobs = static_cast<std::size_t>(options_.jobs);
  const std::size_t share = (shots.size() + jobs - 1) / jobs;
  const std::size_t together =
      is_in_lanes() ? std::clamp(share, lanes, most_in_lanes) : std::clamp<std::size_t>(share, 1, most_by_itself);
  std::vector<PredictedClosing> all(shots.size());
  const double t0 = scales_.closing_time;
  const auto task = [&](std::size_t n) {
    const std::size_t begin = n * together, count = std::min(shots.size(), begin + together) - begin;
    std::vector<std::vector<Signal>> own(count);
    std::vector<LaneClosing> landings(count);
    std::vector<EnsembleClosing> ensemble;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < count; ++i) {
      const PredictedShot& shot = shots[begin + i];
      if (!shot.device->sampled.model) continue;
      own[i] = signals(shot);
      const double last = last_breakpoint(own[i]);
      places.push_back(i);
      ensemble.push_back({.model = &*shot.device->sampled.model,
                          .drives = own[i],
                          .duration = last + hold_time(),
                          .after_contact = after_touch * t0,
                          .no_end_before = last + tail * t0,
                          .no_contact_before = approach_ == Approach::quasi_static ? last + longest_wait * t0 : longest_wait * t0,
                          .observer = &landings[i]});
    }
    std::vector<EnsembleEnd> ends(ensemble.size());
    const LaboratoryErrors& laboratory = options_.laboratory;
    if (options_.vectors != Vectors::none && !laboratory.sees_capacitance())
      ends = close_in_lanes(ensemble, nominal_.tolerance, options_.vectors);
    for (std::size_t k = 0; k < ensemble.size(); ++k) {
      PredictedClosing& closing = all[begin + places[k]];
      if (ends[k].followed) {
        closing = std::move(landings[places[k]].closing);
        closing.followed = true;
      } else {
        SingleClosing single(*ensemble[k].model, laboratory.capacitance, scales_.gap / scales_.rise);
        const Trajectory run = observe_closing(*ensemble[k].model, ensemble[k].drives,
                                               {.duration = ensemble[k].duration,
                                                .tolerance = nominal_.tolerance,
                                                .after_contact = ensemble[k].after_contact,
                                                .no_end_before = ensemble[k].no_end_before,
                                                .no_contact_before = ensemble[k].no_contact_before},
                                               single);
        closing = single.ended(run);
      }
      closing.delay = shots[begin + places[k]].device->delay;
      for (ContactOpening& opening : closing.openings) {
        if (std::isnan(opening.end)) opening.end = std::numeric_limits<double>::infinity();
      }
    }
  };
  run_tasks((shots.size() + together - 1) / together, options_.jobs, task, progress.stop);
  progress.throw_if_stopped();
  return all;
}

namespace {

// Returns the gain of the voltage source of a drive.
double gain_of(const DeviceSpread& spread, const std::string& drive, const std::vector<double>& values) {
  double gain = 1;
  for (std::size_t i = 0; i < spread.variables.size(); ++i) {
    for (const VariedKey& key : spread.variables[i].keys) {
      if (key.drive && key.drive->name == drive && key.drive->error == DriveError::gain)
        gain *= DeviceSpread::value(spread.variables[i], key, values[i]);
    }
  }
  return gain;
}

}  // namespace

void TuningModel::find_units(const Progress& progress) {
  const PreparedScene& p = nominal_;
  volts_slope_ = time_slope_ = pulled_through_slope_ = Eigen::VectorXd::Zero(size());
  if (options_.actuator != Actuator::pzt && has_pulling_electrode(p.scene.device)) electrode_ = searched_drive(p.scene.device);
  constexpr double apart = 0.5;  // step of the finite differences in the coordinates z, in standard deviations
  std::vector<double> levels = hold_levels(p.signals()), bias;
  if (electrode_) bias = bias_of(p.scene, *electrode_);
  struct Found {
    double volts, period, pulled_through;
  };
  const auto found = [&](const Eigen::VectorXd& z) -> std::optional<Found> {
    DeviceBuilder builder(*ensemble_);
    const SampledDevice device = builder.device(values(z));
    if (!device.model) return {};
    Found own{.volts = 1, .period = 1 / device.model->basis().angular_frequencies()[0], .pulled_through = Metrics::unset};
    if (!electrode_) return own;
    const double gain = gain_of(p.scene.spread, p.drive_names()[*electrode_], device.values);
    own.volts = static_pull_in(*device.model, *electrode_, bias).voltage / gain;
    own.pulled_through = pull_through_voltage(*device.model, *electrode_, levels, 1e-4) / gain;
    return own;
  };
  const std::optional<Found> nominal = found(Eigen::VectorXd::Zero(size()));
  if (!nominal) return;
  if (std::isfinite(nominal->pulled_through)) pulled_through_ = nominal->pulled_through;
  std::vector<std::optional<Found>> all(static_cast<std::size_t>(size() - 1));
  run_tasks(
      all.size(), options_.jobs,
      [&](std::size_t k) { all[k] = found(apart * Eigen::VectorXd::Unit(size(), static_cast<Eigen::Index>(k))); }, progress.stop);
  progress.throw_if_stopped();
  const auto slope = [&](double own, double of_nominal) {
    const double change = std::log(own / of_nominal) / apart;
    return std::isfinite(change) ? change : 0;
  };
  for (Eigen::Index k = 0; k + 1 < size(); ++k) {
    const std::optional<Found>& one = all[static_cast<std::size_t>(k)];
    if (!one) continue;
    volts_slope_[k] = slope(one->volts, nominal->volts);
    time_slope_[k] = slope(one->period, nominal->period);
    pulled_through_slope_[k] = slope(one->pulled_through, nominal->pulled_through);
  }
}

TuningModel::Units TuningModel::units(const Eigen::VectorXd& z) const {
  const Eigen::VectorXd own = spread_point(z);
  return {.volts = std::exp(volts_slope_.dot(own)), .time = std::exp(time_slope_.dot(own))};
}

double TuningModel::safe_level(const NormalBelief& belief) const {
  // 0.999 quantile of the standard normal distribution: one in a thousand devices collapses onto the electrode below the level.
  constexpr double one_in_a_thousand = 3.0902;
  const NormalBelief own = in_spread(belief);
  const double deviation = std::sqrt(std::max(0.0, pulled_through_slope_.dot(own.covariance * pulled_through_slope_)));
  return pulled_through_ * std::exp(pulled_through_slope_.dot(own.mean) - one_in_a_thousand * deviation);
}

}  // namespace softland
