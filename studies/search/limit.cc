#include "studies/search/limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "base/require.h"
#include "model/closing.h"
#include "model/constants.h"
#include "studies/closing/auto_settings.h"
#include "studies/closing/plain_step.h"
#include "studies/search/first_touch_problem.h"
#include "studies/search/path_waveforms.h"
#include "studies/search/search_setting.h"

namespace softland {
namespace {

// Relative tolerance of the integrator in simulations that compare catches (pulls after first contact that keep the switch
// closed).
constexpr double catch_tolerance = 1e-6;
// Delays between first contact and the pull that then keeps the switch closed (catch), as shares of the time of first contact.
// Without a delay, the drives would pull while the modes still swing back from the contact.
constexpr std::array catch_delays = {0.0, 0.005, 0.01, 0.015, 0.02, 0.03, 0.04};

// The catches (pulls after first contact) that can follow the waveforms of `path`, which end at first contact, and their
// simulated closings.
class AfterTouch {
 public:
  AfterTouch(const PreparedScene& prepared, const LeastTime& path, Actuator actuator)
      : prepared_(prepared),
        first_touch_(prepared, actuator, std::isfinite(path.peak) ? path.peak : std::numeric_limits<double>::infinity()),
        plain_(plain_step(prepared, actuator)),
        path_(path),
        until_touch_(path) {
    until_touch_.waveforms = tables_of(first_touch_, path.course);
  }

  // Returns the catch (pull after first contact) under which the switch rebounds least, among catches that begin `delay` after
  // first contact. `delay` and the durations are multiples of the time of first contact.
  [[nodiscard]] Catch best_catch(double delay, const Progress& progress) const {
    // Longest catch, and difference between two tried durations of a catch, as multiples of the time of first contact.
    constexpr double longest = 3, step = 0.1;
    const double period = 2 * pi / prepared_.model.basis().angular_frequencies()[0];
    Catch best;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k * step <= longest && !progress.stopped() && least > 0; ++k) {
      const Catch other{.begin = delay * path_.time, .end = (delay + k * step) * path_.time};
      const std::vector<Signal> signals = applied(prepared_, with_catch(first_touch_, until_touch_, other, plain_), plain_);
      const ClosingOptions options{.duration = path_.time + other.end + period, .tolerance = catch_tolerance};
      const Metrics m = metrics(simulate_closing(prepared_.model, signals, options), prepared_.scene.metrics);
      if (m.major_bounce_height < least) best = other, least = m.major_bounce_height;
    }
    return best;
  }

  [[nodiscard]] LimitLanding landing(const Catch& pulled) const {
    DriveWaveforms all = with_catch(first_touch_, until_touch_, pulled, plain_);
    all.insert(plain_.begin(), plain_.end());
    PreparedScene scene = read_back(with_waveforms(prepared_, all), "best.toml", prepared_);
    Closing closing = simulate(scene, false);
    const auto soft = [](const Metrics& m) { return m.status == Status::done && m.is_bounce_free(); };
    LimitLanding landing{.path = path_,
                         .catch_delay = pulled.begin,
                         .catch_time = pulled.end,
                         .scene = std::move(scene),
                         .closing = std::move(closing)};
    if (!soft(landing.closing.metrics)) return landing;
    landing.checks = run_checks(landing.scene);
    landing.bounce_free =
        std::ranges::all_of(landing.checks, [&](const CheckingRun& c) { return c.varied == Varied::gas || soft(c.metrics); });
    return landing;
  }

 private:
  const PreparedScene& prepared_;
  FirstTouchProblem first_touch_;
  DriveWaveforms plain_;
  const LeastTime& path_;
  LeastTime until_touch_;  // the solution `path_`, with waveforms that end at first contact
};

bool goes_before(const LimitLanding& a, const std::optional<LimitLanding>& b) {
  if (!b) return true;
  if (a.bounce_free != b->bounce_free) return a.bounce_free;
  const Metrics &own = a.closing.metrics, &other = b->closing.metrics;
  return a.bounce_free ? own.permanent_contact_time < other.permanent_contact_time
                       : own.major_bounce_height < other.major_bounce_height;
}

// All least times and closings of one limit() call; progress is reported as each begins.
class LimitStudy {
 public:
  LimitStudy(Limit& result, const Progress& progress)
      : result_(result),
        progress_(progress),
        usual_{.actuator = result.options.actuator,
               .impact_velocity = result.impact_velocity,
               .start = result.options.start,
               .progress = progress},
        parts_(static_cast<double>(3 + (may_be_quicker() ? quicker.size() : 0) + (result.options.curves ? speeds.size() : 0) +
                                   (has_peaks() ? peaks.size() : 0))) {}

  void run() {
    if (next("least time of a touch")) result_.touch = at_speed(1, LimitGoal::touch);
    if (next("a landing after it")) land(result_.touch, true);
    for (const double more : quicker) {
      if (may_be_quicker() && next("quicker landings")) land(at_speed(more, LimitGoal::quicker_landing), true);
    }
    if (next("least time at rest")) {
      LeastTimeOptions at_rest = usual_;
      at_rest.at_rest = true;
      result_.rest = sought(LimitGoal::rest, at_rest);
      land(result_.rest, false);
    }
    if (result_.options.curves) {
      for (const double share : speeds) {
        if (next("over the permitted speed")) result_.over_velocity.push_back(at_speed(share, LimitGoal::over_velocity));
      }
    }
    if (has_peaks()) over_peaks();
  }

 private:
  // Multiples of the permitted impact velocity at which least times are computed, too, since a harder first contact may allow a
  // quicker bounce-free closing.
  static constexpr std::array quicker = {10.0, 3.0};
  static constexpr std::array speeds = {0.3, 1.0, 3.0, 10.0, 30.0, 100.0};
  static constexpr std::array peaks = {0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95};

  // True if closings with a faster first contact may be tried: the user gave no permitted impact velocity.
  [[nodiscard]] bool may_be_quicker() const { return !result_.options.impact_velocity; }
  [[nodiscard]] bool has_peaks() const { return result_.options.curves && result_.options.actuator != Actuator::pzt; }

  bool next(std::string_view what) {
    progress_.tell(what, done_++ / parts_);
    return !progress_.stopped();
  }

  // Returns the least time under `options`, and adds its searches to the log.
  LeastTime sought(LimitGoal goal, const LeastTimeOptions& options) {
    std::vector<LeastTime> found = least_time_by_start(result_.given, options);
    const std::size_t least = place_of_least(found);
    for (std::size_t k = 0; k < found.size(); ++k) {
      LeastTime& logged = result_.attempts.emplace_back(goal, found[k], k == least && found[k].status == Status::done).found;
      logged.waveforms = {};
      logged.course = {};
    }
    return std::move(found[least]);
  }

  const LeastTime& at_speed(double share, LimitGoal goal) {
    const auto found = known_.find(share);
    if (found != known_.end()) return found->second;
    LeastTimeOptions other = usual_;
    other.impact_velocity *= share;
    return known_.emplace(share, sought(goal, other)).first->second;
  }

  // Simulates closings with the waveforms of the least-time solution `path`. If `catches`, pulls after first contact (catches)
  // are tried with several delays until a closing is bounce-free. Stores the best closing in the result.
  void land(const LeastTime& path, bool catches) {
    if (path.status != Status::done) return;
    const AfterTouch after(result_.given, path, result_.options.actuator);
    for (const double delay : catch_delays) {
      if (progress_.stopped()) return;
      LimitLanding landing = after.landing(catches ? after.best_catch(delay, progress_) : Catch{});
      const bool is_last = !catches || landing.bounce_free;
      if (goes_before(landing, result_.landing)) result_.landing = std::move(landing);
      if (is_last) return;
    }
  }

  void over_peaks() {
    for (const double share : peaks) {
      if (!next("over the peak voltage")) return;
      LeastTimeOptions lower = usual_;
      lower.peak = share * result_.touch.peak;
      result_.over_peak.push_back(sought(LimitGoal::over_peak, lower));
    }
    if (!progress_.stopped()) result_.over_peak.push_back(result_.touch);
  }

  Limit& result_;
  const Progress& progress_;
  LeastTimeOptions usual_;
  double parts_, done_ = 0;
  std::map<double, LeastTime> known_;  // least times by permitted impact velocity, as a multiple of the default
};

}  // namespace

namespace {

// Throws InvalidInput for an electrode with faces on both sides of the beam if the far face is nearer: any voltage would pull
// the switch away from its contact.
void refuse_what_pulls_away(const PreparedScene& given, Actuator actuator) {
  if (actuator == Actuator::pzt || !has_pulling_electrode(given.scene.device)) return;
  const std::size_t k = searched_drive(given.scene.device);
  if (static_pull_in(given.model, k, bias_of(given.scene, k)).status != Status::no_contact) return;
  given.scene.file.refuse("electrode." + given.scene.device.electrodes[k].name + ".gap", pulls_away);
}

}  // namespace

Limit limit(const SceneFile& file, const LimitOptions& options, const Progress& progress) {
  PreparedScene given = prepare_and_choose(file, true, progress);
  require_open_start(given.scene, "limit closes the switch");
  require(given.model.has_contact(), "limit needs a [contact] section: without contact there is nothing to land on");
  refuse_what_pulls_away(given, options.actuator);
  const std::vector<std::string> names = given.drive_names();
  for (const auto& [name, waveform] : options.start) {
    require(std::find(names.begin(), names.end(), name) != names.end(),
            fmt::format("the waveform to start with is of a drive \"{}\", which the switch does not have", name));
  }
  const std::string elsewhere = initial_state_difference(options.start, options.before, given);
  require(elsewhere.empty(), [&] { return "the waveform to start with: " + elsewhere; });
  Limit result{.given = std::move(given), .options = options};
  const PreparedScene& prepared = result.given;
  result.closed_state = closed_state(prepared, prepared.signals());
  result.hold_warning = hold_warning(prepared.model, prepared.signals(), result.closed_state);
  result.step = simulate(read_back(with_waveforms(prepared, plain_step(prepared, options.actuator)), "step.toml", prepared),
                         false, progress)
                    .metrics;
  progress.throw_if_stopped();
  if (!prepared.scene.spread.empty()) result.approach = stable_approach(prepared, options.actuator);
  if (result.approach) result.quasi_static = quasi_static_speed(*result.approach, prepared, result.step.steady_force_time);
  constexpr double soft = 0.01;  // default permitted impact velocity, as a share of the plain step's
  require_request(options.impact_velocity || std::isfinite(result.step.impact_velocity),
                  [] { return "the plain step does not touch: give " + requested("impact-velocity"); });
  result.impact_velocity = options.impact_velocity.value_or(soft * result.step.impact_velocity);

  LimitStudy(result, progress).run();
  result.interrupted = progress.stopped();
  return result;
}

}  // namespace softland
