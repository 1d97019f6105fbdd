#include "studies/closing/accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/engineering.h"
#include "objectives/figure_values.h"
#include "studies/closing/open_command.h"

namespace softland {
namespace {

constexpr double enough_seconds = 0.03;     // a setting is run again until its runs have taken this time in total [s]
constexpr double reference_tighter = 1e-4;  // ratio of the reference run's tolerance to the tightest tolerance of the study
// Ratio of the tolerances of two successive reference runs, and of the run that checks the reference to the reference.
constexpr double reference_looser = 100;
// Expected ratio of the computing times of two successive reference runs: 100^(1/5) for an integrator of fifth order. The next
// reference run starts only if it is expected to end within the time limit.
constexpr double reference_growth = 2.5;
// Least ratio of a studied tolerance to that of the reference run, which cannot show smaller errors: ten, less rounding.
constexpr double told_apart = 9.9;
constexpr CloudOptions cloud_options{.runs = 8};

bool touched(const Metrics& m) { return std::isfinite(m.initial_contact_time); }

class Study {
 public:
  Study(const PreparedScene& prepared, const AccuracyOptions& options)
      : prepared_(prepared), options_(options), signals_(prepared.signals()) {
    own_modes_ = prepared.model.modes();
    own_integrator_ = automatic_integrator(prepared.model);
    if (!prepared.scene.device.structure.is_rigid()) {
      own_points_ = prepared_.quadrature.points_per_length;
      for (const double points : options.points) {
        if (points != *own_points_) other_points_.push_back(points);
      }
      for (const int modes : {own_modes_ - 1, own_modes_ + 1, own_modes_ + 2}) {
        if (modes >= 1 && modes <= most_modes_of(prepared.scene.device.structure)) other_modes_.push_back(modes);
      }
    }
    const std::size_t tolerances = options.tolerances.size();
    // Each of the two reference runs, and the cloud of perturbed runs, counts as one step of the progress.
    all_ = 3 + (all_integrators.size() + other_points_.size()) * tolerances + other_modes_.size();
    found_.why_always_restarted = prepared.model.has_contact() ? why_always_restarted(prepared.model) : "there is no contact";
    if (found_.why_always_restarted.empty()) all_ += all_integrators.size() * tolerances;
  }

  AccuracyStudy run() {
    if (!find_reference()) return std::move(found_);
    const Switch& own = prepared_.model;
    gather_cloud(own);
    start_ = options_.clock();
    sweep(own, setting(own_integrator_, own_points_), found_.rows);
    for (const double points : other_points_) {
      sweep(Switch(prepared_.scene.device, {.points_per_length = points}), setting(own_integrator_, points), found_.rows);
    }
    for (const int modes : other_modes_) {
      Device device = prepared_.scene.device;
      device.structure.modes = modes;
      AccuracyRow row = setting(own_integrator_, own_points_, tightest_);
      row.modes = modes;
      try_out(Switch(device), row);
      found_.modes.push_back(std::move(row));
    }
    go_through(own, own_integrator_);
    for (const Integrator integrator : all_integrators) {
      if (integrator != own_integrator_) sweep(own, setting(integrator, own_points_), found_.rows);
    }
    for (const Integrator integrator : all_integrators) {
      if (integrator != own_integrator_) go_through(own, integrator);
    }
    if (stopped()) found_.status = Status::interrupted;
    recommend();
    return std::move(found_);
  }

 private:
  [[nodiscard]] bool stopped() const { return options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed); }
  [[nodiscard]] double seconds_since(double start) const { return options_.clock() - start; }
  void progress() {
    ++done_;
    if (options_.on_progress) options_.on_progress(done_, all_);
  }
  [[nodiscard]] AccuracyRow setting(Integrator integrator, std::optional<double> points, double tolerance = 0) const {
    return {.integrator = integrator, .tolerance = tolerance, .points_per_length = points, .modes = own_modes_};
  }

  [[nodiscard]] ClosingOptions closing(const AccuracyRow& row) const {
    return {.duration = prepared_.duration,
            .tolerance = row.tolerance,
            .integrator = row.integrator,
            .restart_at_contact = row.restart,
            .stop = options_.stop};
  }

  // Repeats the closing with one setting (integrator, tolerance, quadrature points) `runs` times, or until the runs have taken
  // `enough_seconds`. Stops a run after `most_seconds`.
  void measure(const Switch& model, AccuracyRow& row, int runs, double most_seconds) {
    if (stopped()) {
      row.missing = "interrupted";
      return;
    }
    ClosingOptions closing_options = closing(row);
    constexpr int steps_per_look = 64;  // number of integrator steps between two readings of the clock
    int steps = 0;
    bool cut = false;
    double start = 0;
    closing_options.observer = [&](double, const double*, const double*) {
      if (++steps % steps_per_look == 0) cut = seconds_since(start) > most_seconds;
      return cut;
    };
    std::vector<double> seconds;
    for (double spent = 0; row.runs < runs && spent < enough_seconds; ++row.runs) {
      start = options_.clock();
      const double begin = processor_seconds();
      const Trajectory t = simulate_closing(model, signals_, closing_options);
      seconds.push_back(processor_seconds() - begin);
      if (cut) {
        row.missing = fmt::format("cut after {:.2g} s of processor time", most_seconds);
        return;
      }
      spent += seconds.back();
      if (row.runs > 0) continue;
      row.work = t.work;
      row.figures = figures(t);
      if (t.status != Status::done) {
        row.missing = t.message.empty() ? std::string(to_string(t.status)) : t.message;
        return;
      }
    }
    row.seconds = spread(seconds).median;
    row.errors = relative_errors(row.figures, found_.reference.figures, prepared_.scene.metrics);
  }

  // Returns the figures of a run. A run of a switch without a contact law ends at first contact, so that rebound and contact
  // force stay unset.
  [[nodiscard]] Metrics figures(const Trajectory& t) const {
    Metrics m = metrics(t, prepared_.scene.metrics);
    if (!prepared_.model.has_contact()) m.major_bounce_height = m.peak_contact_force = Metrics::unset;
    return m;
  }

  // Measures error and computing time of one setting, unless the time limit of all runs is over.
  void try_out(const Switch& model, AccuracyRow& row) {
    if (seconds_since(start_) < options_.all_seconds) {
      measure(model, row, options_.runs, options_.most_seconds);
    } else {
      row.missing =
          fmt::format("not tried: the time limit of the study, {:g} s of processor time, is over", options_.all_seconds);
    }
    progress();
  }

  // Measures error and computing time at every tolerance of the study. `given` has the integrator and the quadrature points.
  void sweep(const Switch& model, const AccuracyRow& given, std::vector<AccuracyRow>& rows) {
    bool cut = false;
    for (const double tolerance : options_.tolerances) {
      AccuracyRow row = given;
      row.tolerance = tolerance;
      if (cut) {
        progress();
        row.missing = fmt::format("not tried: a looser tolerance took more than {:g} s of processor time", options_.most_seconds);
      } else if (tolerance < tightest_ ||
                 (row.points_per_length && 2 * *row.points_per_length > found_.reference.points_per_length)) {
        progress();
        row.missing = "not tried: the reference is too loose to judge it";
      } else {
        try_out(model, row);
        cut = row.missing.starts_with("cut");
      }
      rows.push_back(std::move(row));
    }
  }

  // Measures error and computing time of an integrator that is not restarted at make and break of contact, at every tolerance.
  void go_through(const Switch& model, Integrator integrator) {
    if (!found_.why_always_restarted.empty()) return;
    AccuracyRow row = setting(integrator, own_points_);
    row.restart = false;
    sweep(model, row, found_.through);
  }

  [[nodiscard]] Switch with_points(std::optional<double> points) const {
    return points ? Switch(prepared_.scene.device, {.points_per_length = *points}) : prepared_.model;
  }

  // Tightens the reference run step by step to reference_tighter times the tightest tolerance of the study. Ends earlier at the
  // time limit, or if a tighter run fails.
  void tighten_reference(const Switch& fine, std::optional<double> points, double& seconds_left) {
    const double planned = reference_tighter * options_.tolerances.back();
    int steps = 0;
    while (planned * std::pow(reference_looser, steps + 1) * told_apart <= options_.tolerances.front()) ++steps;
    AccuracyRow& best = found_.reference;
    double growth = reference_growth, best_seconds = 0;
    for (; steps >= 0 && !stopped(); --steps) {
      const bool found = best.missing.empty();
      if (found && (!touched(best.figures) || growth * best_seconds > seconds_left)) return;
      AccuracyRow next = setting(own_integrator_, points, planned * std::pow(reference_looser, steps));
      const double start = options_.clock();
      // Share of the time limit that the first reference run may take. If this run takes longer, the remaining time is for a
      // reference run with fewer quadrature points.
      constexpr double first_share = 1.0 / 3;
      measure(fine, next, 1, found ? seconds_left : first_share * seconds_left);
      const double seconds = seconds_since(start);
      seconds_left = std::max(0.0, seconds_left - seconds);
      if (found && !next.missing.empty()) return;
      if (found) growth = std::max(reference_growth, seconds / best_seconds);
      best = std::move(next);
      best_seconds = seconds;
      if (best.missing.starts_with("cut")) return;
    }
  }

  bool find_reference() {
    AccuracyRow& reference = found_.reference;
    double seconds_left = options_.reference_seconds;
    std::optional<double> points;
    if (own_points_) points = 2 * options_.points.back();
    do {
      reference.missing = "not tried";
      tighten_reference(with_points(points), points, seconds_left);
      if (points) *points /= 2;
    } while (reference.missing.starts_with("cut") && points && *points >= options_.points.front() && !stopped());
    progress();
    if (!reference.missing.empty() || !touched(reference.figures)) {
      found_.status = reference.missing.starts_with("cut") ? Status::numerical_failure : reference.figures.status;
      found_.message = reference.missing;
      return false;
    }
    found_.status = Status::done;
    reference.errors = {};
    if (const double planned = reference_tighter * options_.tolerances.back(); reference.tolerance > told_apart * planned) {
      found_.message = fmt::format(
          "a tolerance of {} would take more than {:g} s of processor time, or fails: settings that this one cannot judge are not tried",
          engineering(reference.tolerance / reference_looser, "", 1), options_.reference_seconds);
    }
    tightest_ = options_.tolerances.back();
    for (auto t = options_.tolerances.rbegin(); t != options_.tolerances.rend() && tightest_ < told_apart * reference.tolerance;
         ++t)
      tightest_ = *t;
    points = reference.points_per_length;
    if (points) *points /= 2;
    AccuracyRow second = setting(own_integrator_, points, reference_looser * reference.tolerance);
    measure(with_points(points), second, 1, options_.reference_seconds);
    found_.resolution = second.errors;
    if (!second.missing.empty()) found_.resolution.fill(Metrics::unset);
    progress();
    return true;
  }

  void gather_cloud(const Switch& model) {
    const ClosingOptions options = closing(setting(own_integrator_, own_points_, tightest_));
    std::vector<Metrics> runs;
    for (const Trajectory& t : perturbed_closings(model, signals_, options, cloud_options)) {
      if (t.status == Status::done) runs.push_back(figures(t));
    }
    const auto over = [&](auto&& value) {
      std::vector<double> values;
      for (const Metrics& m : runs) values.push_back(value(m));
      return spread(std::move(values));
    };
    for (std::size_t i = 0; i < studied_figures.size(); ++i) {
      const Figure& figure = studied_figures[i];
      const Spread& s = found_.cloud[i] = over([&](const Metrics& m) { return figure.value(m); });
      const bool in_all = !runs.empty() && s.runs == static_cast<int>(runs.size());
      const auto counted = [&](const Metrics& m) { return figure.counted(m, prepared_.scene.metrics); };
      found_.conditioned[i] = std::isfinite(figure.value(found_.reference.figures)) && in_all && !ill_conditioned(over(counted));
    }
    const auto over_all = [&](Figure::Member member) {
      return over([&](const Metrics& m) { return figure_of(member).value(m); });
    };
    found_.permanent_contact_time = over_all(&Metrics::permanent_contact_time);
    found_.bounce_count = over_all(&Metrics::bounce_count);
    progress();
  }

  void recommend() {
    for (const double accuracy : options_.wanted) {
      Recommendation r{.accuracy = accuracy, .row = {}};
      for (std::size_t i = 0; i < found_.rows.size(); ++i) {
        if (within(i, accuracy) && !(r.row && found_.rows[*r.row].seconds <= found_.rows[i].seconds)) r.row = i;
      }
      found_.recommendations.push_back(r);
    }
  }

  // True if the errors of a row of the study, and those of the following rows with the same setting and tighter tolerances, are
  // at most `accuracy`.
  [[nodiscard]] bool within(std::size_t index, double accuracy) const {
    const AccuracyRow& first = found_.rows[index];
    if (!first.missing.empty()) return false;
    for (std::size_t i = index; i < found_.rows.size(); ++i) {
      const AccuracyRow& row = found_.rows[i];
      if (row.integrator != first.integrator || row.points_per_length != first.points_per_length) break;
      if (row.missing.empty() && !(found_.worst_error(row) <= accuracy)) return false;
    }
    return true;
  }

  const PreparedScene& prepared_;
  const AccuracyOptions& options_;
  std::vector<Signal> signals_;
  // Quadrature points over the length of the beam that simulate() uses; none for a rigid plate.
  std::optional<double> own_points_;
  std::vector<double> other_points_;
  double tightest_ = 0;  // tightest tolerance whose errors the reference run can resolve
  int own_modes_ = 0;
  Integrator own_integrator_ = Integrator::automatic;
  std::vector<int> other_modes_;
  std::size_t done_ = 0, all_ = 0;
  double start_ = 0;
  AccuracyStudy found_;
};

}  // namespace

FigureErrors relative_errors(const Metrics& value, const Metrics& reference, const MetricsOptions& options) {
  FigureErrors errors{};
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double truth = studied_figures[i].counted(reference, options);
    errors[i] = std::isnan(truth) ? Metrics::unset : relative_difference(studied_figures[i].counted(value, options), truth);
  }
  return errors;
}

double AccuracyStudy::worst_error(const AccuracyRow& row) const {
  if (!row.missing.empty()) return Metrics::unset;
  double worst = Metrics::unset;
  for (std::size_t i = 0; i < row.errors.size(); ++i) {
    if (conditioned[i]) worst = std::fmax(worst, row.errors[i]);
  }
  return worst;
}

AccuracyStudy study_accuracy(const PreparedScene& prepared, const AccuracyOptions& options) {
  require_open_start(prepared.scene, "accuracy closes the switch");
  const PreparedScene closing = closing_of(prepared);
  return Study(closing, options).run();
}

}  // namespace softland
